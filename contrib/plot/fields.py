"""The fields of a run or of a finite element reference, at the times of its
pictures: places, values, unit, bodies by name."""

import difflib
import re
from pathlib import Path

from charts import fail, need, np
import run_folder

COMPONENTS = ("xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz")
UNITS = {"displacement": "m", "velocity": "m/s", "speed": "m/s",
         "pressure": "Pa",
         "stress": "Pa", "equivalent stress": "Pa", "mass": "kg",
         "point pressure": "Pa", "point stress": "Pa"}


def refuse_scene(folder):
    if Path(folder).suffix in (".prm", ".json") and Path(folder).is_file():
        fail(f"'{folder}' is a scene. Run it ('limber {folder}'), then plot its "
             "folder.")


class Source:
    """A run folder that fields are drawn from.

    times: of the pictures, in s. bodies: their names, in the order of the scene.
    at(i): {'position': (n, 3), ...} with the arrays of picture i.
    """

    def __init__(self, folder):
        self.folder = Path(folder)
        refuse_scene(folder)
        if (self.folder / "study.csv").is_file():
            fail(f"'{folder}' is a study; pictures and films of a field are made "
                 f"of its runs in '{self.folder / 'runs'}'.")
        if not self.folder.is_dir():
            fail(f"There is no folder '{folder}'. Usually the path is misspelt, "
                 "or the run was written elsewhere ('--output-directory').")
        if not (self.folder / "parameters.prm").is_file():
            fail(f"The folder '{folder}' is not that of a run, a reference or a "
                 "study: it holds neither 'parameters.prm' nor 'study.csv'. "
                 "Usually a folder above or below it is meant.")
        self.parameters = run_folder.parameters(self.folder)
        self.dimension = int(self.parameters["Dimension"])
        self.bodies = run_folder.words(self.parameters.get("Bodies", ""))
        self.is_reference = run_folder.is_reference(self.folder)
        if self.is_reference:
            need("h5py")
            self.times, self.files = run_folder.node_series(self.folder)
        else:
            self.times, self.files = run_folder.series(self.folder)
        if not len(self.times):
            fail(f"The run in '{folder}' has no pictures. 'Output/Time interval' "
                 "is 0 there; repeat it with --set \"Output/Time interval=...\".")

    @property
    def name(self):
        return self.folder.resolve().name

    def nearest(self, time):
        return int(np.argmin(abs(self.times - time)))

    def at(self, index):
        path = self.files[index]
        if self.is_reference:
            return run_folder.node_arrays(path)
        cloud = run_folder.points(path)
        arrays = Path(path).with_suffix(".h5")
        if arrays.is_file():
            cloud["arrays"] = arrays  # read only if a field is not here
        return cloud

    def cells(self, index):
        """Lower and upper corners (n, 2) of the grid's cells in picture i, in two
        dimensions; where cells have levels, those of each, coarsest first."""
        times, files = run_folder.series(self.folder, "grid")
        if not len(times) or self.dimension != 2 or self.is_reference:
            fail(f"The grid of '{self.folder}' cannot be drawn: "
                 + ("lines are drawn in two dimensions only."
                    if self.dimension != 2 else "there is no 'grid.pvd', as runs "
                    "write it."))
        arrays = run_folder.points(
            files[int(np.argmin(abs(times - self.times[index])))])
        corners = arrays["position"][:, :2].reshape(-1, 4, 2)
        level = arrays.get("level", np.zeros(4 * len(corners)))[::4].round()
        order = np.argsort(level, kind="stable")
        return corners[order].min(axis=1), corners[order].max(axis=1)

    @property
    def has_levels(self):
        return not self.is_reference and int(
            self.parameters.get("Grid/Levels", "0")) > 0

    def shrinking(self, index, places):
        """For each place the edge of its cell over that of a coarse one, in two
        dimensions; elsewhere 1."""
        if not self.has_levels or self.dimension != 2:
            return np.ones(len(places))
        p = self.parameters
        low, high, cells = (run_folder.numbers(p[f"Grid/{name}"])[:2] for name in
                            ("Lower corner", "Upper corner", "Cells"))
        fine = (high - low) / cells / 2**int(p["Grid/Levels"])
        lower, upper = (((corner - low) / fine).round().astype(int)
                        for corner in self.cells(index))
        width = np.ones(((high - low) / fine).round().astype(int))
        for (i, j), (k, l) in zip(lower, upper):
            width[i:k, j:l] = (k - i) * fine[0] * cells[0] / (high - low)[0]
        at = ((places[:, :2] - low) / fine).astype(int)
        return width[tuple(np.clip(at, 0, np.array(width.shape) - 1).T)]

    def spacing(self, body=None):
        """Distance of neighbouring points at the start in a cell of the largest
        size that the body fills, in m."""
        p = self.parameters
        lower, upper, cells = (
            run_folder.numbers(p[f"Grid/{name}"])[:self.dimension]
            for name in ("Lower corner", "Upper corner", "Cells"))
        edge = (upper - lower) / cells
        per_edge = p.get(
            f"Body {body or (self.bodies or [''])[0]}/Points per cell edge", "2")
        if re.match(r"[\d.,; ]+$", per_edge):
            number = run_folder.numbers(per_edge).mean()
        elif self.is_reference:
            number = 2.
        else:
            number = self._points_per_edge(body, lower, edge)
        return float(np.prod(edge)**(1 / self.dimension) / number)

    def flows(self, body=None):
        """Whether a body, or else all of them, is a liquid."""
        return all(self.parameters.get(f"Body {name}/Material") ==
                   "newtonian fluid" for name in ([body] if body else self.bodies))

    def _points_per_edge(self, body, lower, edge):
        """What 'auto' has become: by the fuller half of the cells at the start."""
        cloud = of_body(self.at(0), self, body)
        place = np.array(cloud["position"], float)
        cell = ((place[:, :self.dimension] - lower) / edge).astype(int)
        share = self.shrinking(0, place)**self.dimension  # of a large cell
        _, of = np.unique(cell, axis=0, return_inverse=True)
        counts = np.bincount(of.ravel(), weights=share)
        fuller = counts[counts >= np.median(counts)]
        return max(1., np.round(np.median(fuller)**(1 / self.dimension)))


def names_of(cloud):
    """What can be drawn of a cloud, components included."""
    names = []
    for name, values in _all(cloud).items():
        if name in ("position", "arrays") or name.startswith("initial place"):
            continue
        names.append(name)
        if values.ndim > 1:
            names += [f"{name} {c}" for c in (
                "xyz" if values.shape[1] == 3 else COMPONENTS)]
    if any(name.startswith("stress") for name in names):
        names += [n for n in ("equivalent stress", "pressure")
                  if n not in names]
    return names


def unit_of(name):
    words = name.split()
    for end in range(len(words), 0, -1):
        if " ".join(words[:end]) in UNITS:
            return UNITS[" ".join(words[:end])]
    return ""


def _arrays(path):
    """The arrays of single components as vectors and matrices."""
    need("h5py")
    import h5py
    with h5py.File(path) as file:
        return {name: values[()] for name, values in file.items()
                if name != "time"}


def _joined(arrays):
    """'velocity x', 'velocity y' as one 'velocity' of three components."""
    result = dict(arrays)
    for name in ("displacement", "velocity"):
        parts = [arrays[f"{name} {d}"] for d in "xyz" if f"{name} {d}" in arrays]
        if parts:
            while len(parts) < 3:
                parts.append(np.zeros_like(parts[0]))
            result[name] = np.stack(parts, axis=1)
            for d in "xyz":
                result.pop(f"{name} {d}", None)
    if "stress xx" in arrays:
        zero = np.zeros_like(arrays["stress xx"])

        def part(a, b):
            return arrays.get(f"stress {a}{b}", arrays.get(f"stress {b}{a}",
                                                           zero))
        result["stress"] = np.stack([part(c[0], c[1]) for c in COMPONENTS],
                                    axis=1)
        for c in COMPONENTS:
            result.pop(f"stress {c}", None)
    return result


def _all(cloud):
    fields = _joined({k: v for k, v in cloud.items() if k != "arrays"})
    if "arrays" in cloud:
        # HDF5 keeps an order of its own, so places say which point is which.
        extra = _joined(_arrays(cloud["arrays"]))
        fields = {**_in_order_of(fields, extra), **fields}
    return fields


def _in_order_of(fields, extra):
    """The arrays of the same points, in the order of the picture."""
    start = [extra[f"initial place {d}"] for d in "xyz"
             if f"initial place {d}" in extra]
    place = np.stack(start, axis=1) + extra["displacement"][:, :len(start)]
    seen = fields["position"][:, :len(start)]
    size = max(np.ptp(seen, axis=0).max(), 1e-300)
    if len(seen) != len(place):
        return {}
    if abs(seen - place).max() < 1e-4 * size:
        return extra
    orders = [np.lexsort(np.round(x / size, 5).T) for x in (seen, place)]
    if abs(seen[orders[0]] - place[orders[1]]).max() > 1e-4 * size:
        return {}
    back = np.empty(len(place), int)
    back[orders[0]] = orders[1]
    return {name: values[back] for name, values in extra.items()}


def value(cloud, name, folder):
    """The values of a field, a component or a magnitude, one a point."""
    fields = {k: v for k, v in cloud.items() if k != "arrays"}
    for known in (lambda: _joined(fields), lambda: _all(cloud)):
        found = _find(known(), name)
        if found is not None:
            return found
    known = names_of(cloud)
    base, _, last = name.rpartition(" ")
    base = base if last in ("x", "y", "z", *COMPONENTS) else name
    meant = difflib.get_close_matches(name, known + list(UNITS), 1)
    fail(f"There is no field '{name}' in '{folder}'. It has: "
         + ", ".join(known) + "." + (
             f" Pictures carry it with --set \"Output/Fields={base}\" of the run."
             if base in UNITS else
             f" Did you mean '{meant[0]}'?" if meant else ""))


def _find(fields, name):
    if name == "speed":
        name = "velocity"
    if name in fields:
        values = fields[name]
        if values.ndim == 1:
            return values
        if values.shape[1] == 3:
            return run_folder.magnitude(values)
        return _von_mises(values)  # of a stress as a whole
    base, _, component = name.rpartition(" ")
    if base in fields and fields[base].ndim > 1:
        parts = "xyz" if fields[base].shape[1] == 3 else COMPONENTS
        if component in parts:
            return fields[base][:, list(parts).index(component)]
    if "stress" in fields:
        stress = fields["stress"]
        if name == "pressure":
            return -(stress[:, 0] + stress[:, 4] + stress[:, 8]) / 3
        if name == "equivalent stress":
            return _von_mises(stress)
    return None


def _von_mises(stress):
    pressure = (stress[:, 0] + stress[:, 4] + stress[:, 8]) / 3
    deviator = stress.copy()
    for k in (0, 4, 8):
        deviator[:, k] -= pressure
    return np.sqrt(1.5 * (deviator**2).sum(axis=1))


def label_of(name, unit):
    if name in ("velocity", "speed"):
        name = "speed"
    elif name in ("stress", "point stress"):
        name = name.replace("stress", "equivalent stress")
    return f"{name} [{unit}]" if unit else name


def of_body(cloud, source, body):
    """The points of one body, all arrays alike."""
    if body is None:
        return cloud
    if body not in source.bodies:
        fail(f"There is no body '{body}' in '{source.folder}'. It has: "
             + ", ".join(source.bodies) + ".")
    if len(source.bodies) == 1:
        return cloud
    mine = mask_of_body(cloud, source, body)
    return {name: values[mine] for name, values in _all(cloud).items()}


def mask_of_body(cloud, source, body):
    """Which points are of a body."""
    if body not in source.bodies:
        fail(f"There is no body '{body}' in '{source.folder}'. It has: "
             + ", ".join(source.bodies) + ".")
    fields = _all(cloud)
    if "body" not in fields:
        fail(f"The pictures in '{source.folder}' do not say which point is of "
             f"which body. Add 'body' to 'Output/Fields' of the scene.")
    return np.round(fields["body"]) == source.bodies.index(body)
