"""Outlines of the rigid obstacles of a scene in the plane, at any time."""

import re
from pathlib import Path

from charts import np

import run_folder

SIDE = 401  # places along either side of a picture, where an outline is looked for


class Formula:
    """A formula of a scene, in the words of its language."""

    FUNCTIONS = {name: getattr(np, numpy) for name, numpy in (
        ("sin", "sin"), ("cos", "cos"), ("tan", "tan"), ("asin", "arcsin"),
        ("acos", "arccos"), ("atan", "arctan"), ("atan2", "arctan2"),
        ("sinh", "sinh"), ("cosh", "cosh"), ("tanh", "tanh"), ("exp", "exp"),
        ("log", "log"), ("ln", "log"), ("log10", "log10"), ("sqrt", "sqrt"),
        ("abs", "abs"), ("min", "minimum"), ("max", "maximum"),
        ("floor", "floor"), ("ceil", "ceil"), ("choose", "where"))}

    def __init__(self, text, constants):
        text = re.sub(r"\bif\s*\(", "choose(", text)
        text = text.replace("^", "**").replace("&&", "*").replace("||", "+")
        self.code = compile(text.strip() or "0", "formula", "eval")
        self.names = {**self.FUNCTIONS, "pi": np.pi, **constants}

    def __call__(self, **variables):
        with np.errstate(all="ignore"):
            return eval(self.code, {"__builtins__": {}},
                        {**self.names, **variables})


def constants_of(parameters, section):
    result = {}
    for text in (parameters.get("Constants", ""),
                 parameters.get(f"{section}/Constants", "")):
        for definition in filter(None, text.split(",")):
            name, value = definition.split("=")
            result[name.strip()] = float(value)
    return result


def _edges_of_polygon(parameters, section):
    """Loops of a polygon from a file, as it stands in the scene."""
    def numbers(name, default):
        text = parameters.get(f"{section}/{name}", "")
        return run_folder.numbers(text) if text else np.array(default)
    path = Path(parameters.get(f"{section}/File", ""))
    if not path.is_file():
        return []
    loops, loop = [], []
    for line in path.read_text().splitlines() + [""]:
        words = re.split(r"[\s,;]+", line.split("#")[0].strip())
        try:
            loop.append([float(word) for word in words])
        except ValueError:
            if "#" not in line and len(loop) > 2:
                loops.append(np.array(loop))
            if not line.strip():
                loop = []
    angle = np.radians(numbers("Rotation", [0.])[0])
    turn = np.array([[np.cos(angle), -np.sin(angle)],
                     [np.sin(angle), np.cos(angle)]])
    return [numbers("Scale", [1.])[0] * one @ turn.T +
            numbers("Translation", [0., 0.])[:2] for one in loops]


def _inside_loops(loops, x, y):
    inside = np.zeros(x.shape, bool)
    for loop in loops:
        for a, b in zip(loop, np.roll(loop, -1, axis=0)):
            crosses = (a[1] <= y) != (b[1] <= y)
            with np.errstate(all="ignore"):
                at = a[0] + (y - a[1]) * (b[0] - a[0]) / (b[1] - a[1])
            inside ^= crosses & (x < at)
    return inside


def _depth(parameters, section, constants, x, y):
    """Positive inside a shape: a distance, or a formula, or +-1."""
    shape = parameters[f"{section}/Shape"]
    inner = f"{section}/{shape.capitalize()}"

    def numbers(name):
        return run_folder.numbers(parameters[f"{inner}/{name}"])
    if shape == "half-space":
        place, normal = numbers("Point"), numbers("Normal")
        return -((x - place[0]) * normal[0] + (y - place[1]) * normal[1])
    if shape == "ball":
        centre = numbers("Centre")
        return numbers("Radius")[0] - np.hypot(x - centre[0], y - centre[1])
    if shape == "formula":
        formula = Formula(parameters[f"{inner}/Inside"], constants)
        depth = formula(x=x, y=y, t=0.) + 0 * x
        return np.minimum(depth, _depth_of_box(parameters, inner, x, y))
    if shape == "box":
        return _depth_of_box(parameters, inner, x, y)
    if shape == "union":
        parts = run_folder.words(parameters[f"{inner}/Shapes"])
        return np.max([_depth(parameters, f"{inner}/Shape {part}", constants,
                              x, y) for part in parts], axis=0)
    if shape == "block":
        loops = [np.array([[float(word) for word in corner.split(",")]
                           for corner in
                           parameters[f"{inner}/Corners"].split(";")])]
    else:
        loops = _edges_of_polygon(parameters, inner)
    return np.where(_inside_loops(loops, x, y), 1., -1.)


def _depth_of_box(parameters, section, x, y):
    depth = np.full(x.shape, np.inf)
    for name, sign in (("Lower corner", 1), ("Upper corner", -1)):
        text = parameters.get(f"{section}/{name}", "")
        if text:
            corner = run_folder.numbers(text)
            depth = np.minimum(depth, np.minimum(sign * (x - corner[0]),
                                                 sign * (y - corner[1])))
    return np.where(np.isfinite(depth), depth, 1e300)


def depths(parameters, time, x, y):
    """For each obstacle: positive at the places inside it at this time."""
    for name in run_folder.words(parameters.get("Obstacles", "")):
        section = f"Obstacle {name}"
        constants = constants_of(parameters, section)
        centre = run_folder.numbers(parameters[f"{section}/Centre"])
        moved = [Formula(part, constants)(t=time) for part in
                 (parameters.get(f"{section}/Displacement") or "0; 0").split(
                     ";")]
        angle = Formula(parameters.get(f"{section}/Rotation") or "0",
                        constants)(t=time)
        u, v = x - centre[0] - moved[0], y - centre[1] - moved[1]
        c, s = np.cos(angle), np.sin(angle)
        yield _depth(parameters, section, constants,
                     centre[0] + c * u + s * v, centre[1] - s * u + c * v)


def draw(axis, parameters, time, lower, upper):
    """All of them, grey, where they are between two corners."""
    x, y = np.meshgrid(*(np.linspace(lower[d], upper[d], SIDE)
                         for d in range(2)))
    for depth in depths(parameters, time, x, y):
        if depth.max() <= 0:
            continue
        axis.contourf(x, y, np.minimum(depth, 1e30), levels=[0, np.inf],
                      colors=["0.85"], zorder=0.5)
        axis.contour(x, y, np.clip(depth, -1e30, 1e30), levels=[0],
                     colors=["0.3"], linewidths=0.9, zorder=3)
