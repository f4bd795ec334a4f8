#!/usr/bin/python3
"""Measures the treatments of locking and prints the table of
doc/theory/treatments.md.

    treatments.py [path of limber] [--quick] [--liquids] [--only="node;hybrid"]

Runs the free soft beam, the cantilever, Cook's membrane, the dam break, the
tank and the sliding block with every treatment; --quick leaves out the slow
beams, --liquids all but the dam break and the tank. Takes some 25 minutes on one
core; --only takes the treatments that it names.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "contrib/plot"))
from charts import np  # noqa: E402
import run_folder  # noqa: E402

TREATMENTS = {
    "none": {"Locking treatment": "none"},
    "cell": {"Locking treatment": "cell"},
    "cell, replaced": {"Locking treatment": "cell", "History": "replace"},
    "cell shear": {"Locking treatment": "cell shear"},
    "cell full": {"Locking treatment": "cell full"},
    "assumed strain": {"Locking treatment": "assumed strain"},
    "node": {"Locking treatment": "node"},
    "hybrid": {"Locking treatment": "hybrid"},
    "cell shear, shear replaced": {"Locking treatment": "cell shear",
                                   "Deviatoric history": "replace"},
    "cell full, deviator replaced": {"Locking treatment": "cell full",
                                     "Deviatoric history": "replace"},
}
LIQUIDS = ("none", "cell", "cell, replaced", "node")
SPLINES = ("none", "cell", "node")  # of liquids, with quadratic functions
EXPLICIT = "Method/Time integration=explicit"  # also where 'auto' is not
SEMI_IMPLICIT = "Method/Time integration=semi-implicit"
ORDER = "musl"  # of the beam; or "usavg"
FREE_BEAM = {"0.3": 3.3990, "0.499": 3.6963}  # Hz, fine Q2 finite elements


class Runner:
    def __init__(self, limber):
        self.limber = limber
        self.scratch = tempfile.TemporaryDirectory()
        self.count = 0

    def run(self, scene, body, treatment, settings=()):
        """Returns the folder and the summary; None where the run failed."""
        self.count += 1
        folder = Path(self.scratch.name) / str(self.count)
        command = [self.limber, str(TOP / "prm" / scene),
                   "--output-directory", str(folder)]
        for entry, value in TREATMENTS[treatment].items():
            command += ["--set", f"Body {body}/{entry}={value}"]
        for setting in settings:
            command += ["--set", setting]
        done = subprocess.run(command, stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True)
        if done.returncode not in (0, 4):
            return None
        return folder, json.loads((folder / "summary.json").read_text())


def free_beam(runner, treatment, poisson, speed, end_time):
    """Frequency error and E/E0 - 1 at the end."""
    result = runner.run(
        "verification/free_soft_beam.prm", "beam", treatment,
        [f"Body beam/Neo hookean/Poisson's ratio={poisson}",
         "Body beam/Constants=b = 0.7883401241, s = 0.98250221, "
         f"v0 = {speed}", f"End time={end_time}",
         f"Method/Stress update={ORDER}"])
    if result is None:
        return ["failed", "failed"]
    values, _ = run_folder.statistics(result[0])
    energy = values["kinetic energy"] + values["strain energy"]
    frequency = result[1]["checks"][0]["value"]
    return [f"{100 * (frequency / FREE_BEAM[poisson] - 1):+.2f}",
            f"{100 * (energy[-1] / energy[0] - 1):+.2f}"]


def shear_scatter(runner, treatment):
    """Rms of what the shear stress of points differs from its mean in the
    cell, over the largest stress along the beam: the cantilever with
    Poisson's ratio 0.3 at its first largest deflection."""
    result = runner.run("cantilever.prm", "beam", treatment,
                        ["Body beam/Neo hookean/Poisson's ratio=0.3",
                         "End time=3", "Output/Time interval=3",
                         "Output/Fields=stress"])
    if result is None:
        return "failed"
    _, files = run_folder.series(result[0])
    data = run_folder.points(files[-1])
    stress = data["stress"]
    _, cell, number = np.unique(np.floor(data["position"][:, :2] / 0.25),
                                axis=0, return_inverse=True,
                                return_counts=True)
    cell = cell.ravel()
    scatter = stress[:, 1] - (np.bincount(cell, stress[:, 1]) / number)[cell]
    share = np.sqrt(np.mean(scatter**2)) / abs(stress[:, 0]).max()
    return f"{100 * share:.2g}"


def cell_pressures(path, edge):
    """Pressures of the cells that hold at least half the points of a full
    one, as an array with NaN elsewhere."""
    data = run_folder.points(path)
    index = np.floor(data["position"][:, :2] / edge).astype(int)
    shape = index.max(axis=0) + 1
    total, count = np.zeros(shape), np.zeros(shape)
    np.add.at(total, tuple(index.T), data["pressure"])
    np.add.at(count, tuple(index.T), 1)
    full = count.max() if count.size else 1
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(count >= 0.5 * min(full, 25), total / count, np.nan)


def roughness(pressure):
    """Rms of the second differences between neighbouring cells over four times
    the range of the pressure: 1/2 for a checkerboard, 0 for a linear field."""
    second = np.concatenate([
        (pressure[:-2] - 2 * pressure[1:-1] + pressure[2:]).ravel(),
        (pressure[:, :-2] - 2 * pressure[:, 1:-1] + pressure[:, 2:]).ravel()])
    second = second[np.isfinite(second)] / 4
    return np.sqrt(np.mean(second**2)) / (np.nanmax(pressure) -
                                          np.nanmin(pressure))


def jump(pressure):
    """Rms of the difference between neighbouring cells over the range."""
    first = np.concatenate([(pressure[1:] - pressure[:-1]).ravel(),
                            (pressure[:, 1:] - pressure[:, :-1]).ravel()])
    first = first[np.isfinite(first)]
    return np.sqrt(np.mean(first**2)) / (np.nanmax(pressure) -
                                         np.nanmin(pressure))


def dam_break(runner, treatment, settings=()):
    """Front and height at T = 3, roughness of the pressure and its jumps at
    T = 1, 2, 3."""
    result = runner.run("dam_break.prm", "water", treatment,
                        ["Output/Time interval=0.2258",
                         "Output/Fields=pressure", *settings])
    if result is None:
        return ["failed"] * 4
    folder, summary = result
    checks = {check["name"]: check["value"] for check in summary["checks"]}
    _, files = run_folder.series(folder)
    pressures = [cell_pressures(f, 0.125) for f in files[1:4]]
    return [f"{checks['front at T=3']:.2f}",
            f"{checks['height at T=3'] / 2:.3f}",
            " / ".join(f"{100 * roughness(p):.1f}" for p in pressures),
            " / ".join(f"{100 * jump(p):.1f}" for p in pressures)]


def tank(runner, treatment, settings=()):
    """Kinetic energy over rho g H^2 W / 2 and relative L2 error of pressure
    at 4 s, with three points per cell edge."""
    result = runner.run("verification/hydrostatic_tank.prm", "water",
                        treatment,
                        ["Output/Time interval=4", "Output/Fields=pressure",
                         "Body water/Points per cell edge=3", *settings])
    if result is None:
        return ["failed", "failed"]
    folder, _ = result
    values, _ = run_folder.statistics(folder)
    _, files = run_folder.series(folder)
    data = run_folder.points(files[-1])
    exact = 9810 * (1 - data["position"][:, 1])
    error = np.sqrt(((data["pressure"] - exact)**2).sum() / (exact**2).sum())
    return [f"{values['kinetic energy'][-1] / 4905:.1e}", f"{100*error:.1f}"]


def cook(runner, treatment):
    """Rise of the tip of Cook's membrane with cells of 2 m and 1 m, and the
    rms of the pressure of the points with the latter."""
    row = []
    for cells in ("26, 33", "52, 66"):
        result = runner.run("benchmarks/cook.prm", "panel", treatment,
                            [f"Grid/Cells={cells}", "Output/Time interval=150",
                             "Output/Fields=pressure"])
        if result is None:
            return ["failed"] * 3
        folder, summary = result
        row.append(f"{summary['checks'][0]['value']:.4f}")
    _, files = run_folder.series(folder)
    pressure = run_folder.points(files[-1])["pressure"]
    return row + [f"{np.sqrt(np.mean(pressure**2)):.3f}"]


def block(runner, treatment, scene):
    """Cost relative to no treatment: best of five, taking turns."""
    costs = {treatment: [], "none": []}
    for _ in range(5):
        for name in ("none", treatment):
            result = runner.run(f"benchmarks/{scene}.prm", "block", name)
            costs[name].append(result[1]["ns_per_point_step"])
    return f"{min(costs[treatment]) / min(costs['none']):.2f}"


def solids(runner, chosen, quick):
    print("| treatment | f, nu .3 (%) | E (%) | f, nu .499 (%) | E (%) | "
          "E, v0 = 3, nu .3 (%) | E, v0 = 3, nu .499 (%) | shear (%) | "
          "cost 2D | cost 3D |")
    print("| --- " + "| --: " * 9 + "|")
    for treatment in chosen:
        row = free_beam(runner, treatment, "0.3", 1, 1.5)
        row += (["-"] * 2 if quick else
                free_beam(runner, treatment, "0.499", 1, 1.5))
        row += free_beam(runner, treatment, "0.3", 3, 2)[1:]
        row += (["-"] if quick else
                free_beam(runner, treatment, "0.499", 3, 2)[1:])
        row += [shear_scatter(runner, treatment)]
        row += [block(runner, treatment, scene)
                for scene in ("block_2d", "block_3d")]
        print("| " + " | ".join([treatment, *row]) + " |", flush=True)

    print("\n| Cook's membrane | tip, h = 2 m (m) | tip, h = 1 m (m) | "
          "rms of the pressure (Pa) |")
    print("| --- " + "| --: " * 3 + "|")
    for treatment in chosen:
        print("| " + " | ".join([treatment, *cook(runner, treatment)]) + " |",
              flush=True)


def main():
    arguments = [a for a in sys.argv[1:] if not a.startswith("--")]
    quick = "--quick" in sys.argv
    only = [a[len("--only="):].split(";") for a in sys.argv[1:]
            if a.startswith("--only=")]
    chosen = [t for t in TREATMENTS if not only or t in only[0]]
    runner = Runner(arguments[0] if arguments else
                    str(TOP / "build/release/limber"))

    if "--liquids" not in sys.argv:
        solids(runner, chosen, quick)
    print("\n| liquid | chi | checkerboard control | Z(3) | H(3) | "
          "roughness at T = 1 / 2 / 3 (%) | jumps (%) | "
          "tank, kinetic energy | tank, pressure error (%) |")
    print("| --- " + "| --: " * 8 + "|")
    for treatment in (t for t in LIQUIDS if t in chosen):
        controls = [("0", "0")]
        if treatment != "none":
            controls += [("0.1", "0"), ("0.2", "0")]
        if treatment == "cell":
            controls += [("0.2", "0.5")]
        for chi, checkerboard in controls:
            control = [EXPLICIT, f"Body water/Hourglass control={chi}",
                       f"Body water/Checkerboard control={checkerboard}"]
            row = dam_break(runner, treatment, control)
            row += tank(runner, treatment, control)
            print("| " + " | ".join([treatment, chi, checkerboard, *row]) +
                  " |", flush=True)
    if "cell" in chosen:
        for checkerboard in "0", "0.1", "0.5":
            settings = [SEMI_IMPLICIT, "Body water/Hourglass control=0.2",
                        f"Body water/Checkerboard control={checkerboard}"]
            row = dam_break(runner, "cell", settings)
            row += tank(runner, "cell", settings)
            print("| " + " | ".join(["cell, semi-implicit", "0.2", checkerboard,
                                     *row]) + " |", flush=True)
    for treatment in (t for t in SPLINES if t in chosen):
        for checkerboard in ("0", "0.5") if treatment == "cell" else ("0",):
            settings = [EXPLICIT, "Method/Kernel=quadratic",
                        f"Body water/Checkerboard control={checkerboard}"]
            row = dam_break(runner, treatment, settings)
            row += tank(runner, treatment, settings)
            print("| " + " | ".join(["quadratic " + treatment, "-", checkerboard,
                                     *row]) + " |", flush=True)


if __name__ == "__main__":
    main()
