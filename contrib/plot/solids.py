"""Rigid obstacles in three dimensions, as a camera of spheres.py sees them: the
depth of the first surface along the ray of each pixel. Balls, boxes, cylinders,
blocks, STL files, formulas and unions of these; half-spaces as the polygon in
which their plane cuts the box that is seen."""

import re
import struct
import sys
from pathlib import Path

from charts import np

import obstacles
import run_folder

SAMPLES = 96  # along a ray, where a formula is looked for
HIDDEN = ("mesh", "image", "point list")  # shapes that are not drawn
SECTIONS = {"stl": "STL"}


class Motion:
    """Where an obstacle is at a time: place = turn (start - centre) + shift."""

    def __init__(self, parameters, section, constants, time):
        def values(name, default, separator):
            text = parameters.get(f"{section}/{name}") or default
            return [obstacles.Formula(part, constants)(t=time)
                    for part in text.split(separator)]
        self.centre = run_folder.numbers(
            parameters.get(f"{section}/Centre") or "0, 0, 0")
        moved = np.array(values("Displacement", "0; 0; 0", ";"), float)
        self.shift = self.centre + moved
        angle = float(values("Rotation", "0", "\n")[0])
        axis = run_folder.numbers(parameters.get(f"{section}/Axis") or "0, 0, 1")
        self.turn = rotation_about(axis / np.linalg.norm(axis), angle)

    def back(self, places):
        """Where places of now were at the start."""
        return (places - self.shift) @ self.turn + self.centre

    def now(self, places):
        return (places - self.centre) @ self.turn.T + self.shift


def rotation_about(axis, angle):
    """Rodrigues' formula."""
    c, s = np.cos(angle), np.sin(angle)
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]],
                      [-axis[1], axis[0], 0]])
    return c * np.eye(3) + s * cross + (1 - c) * np.outer(axis, axis)


def drawn_shape(parameters, section):
    """Its shape, and the section of its measures."""
    shape = parameters.get(f"{section}/Shape", "box")
    return shape, f"{section}/{SECTIONS.get(shape, shape.capitalize())}"


# ---- facets ----------------------------------------------------------------------


def facets_of_stl(path):
    """(n, 3, 3): corners of the facets of a binary or ASCII file."""
    data = Path(path).read_bytes()
    number = struct.unpack("<I", data[80:84])[0] if len(data) > 84 else 0
    if len(data) == 84 + 50 * number:
        kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)),
                         ("rest", "<u2")])
        return np.frombuffer(data[84:], kind)["corners"].astype(float)
    rows = re.findall(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", data)
    return np.array(rows, float).reshape(-1, 3, 3)


def _placed_facets(parameters, section):
    def numbers(name, default):
        return run_folder.numbers(parameters.get(f"{section}/{name}") or default)
    facets = facets_of_stl(parameters[f"{section}/File"])
    turn = np.eye(3)
    for axis, angle in zip(np.eye(3), numbers("Rotation", "0, 0, 0")):
        turn = rotation_about(axis, np.radians(angle)) @ turn
    return (numbers("Scale", "1")[0] * facets @ turn.T +
            numbers("Translation", "0, 0, 0"))


def _facets_of_block(parameters, section):
    corners = np.array([run_folder.numbers(corner) for corner in
                        parameters[f"{section}/Corners"].split(";")])
    faces = [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5),
             (2, 3, 7, 6), (3, 0, 4, 7)]
    return np.array([corners[list(half)] for a, b, c, d in faces
                     for half in ((a, b, c), (a, c, d))])


def _facets(parameters, section, shape):
    return (_placed_facets if shape == "stl" else _facets_of_block)(
        parameters, section)


# ---- rays --------------------------------------------------------------------------


class Rays:
    """The pixels of a camera, and the part of each ray within a box; depths are
    distances towards the eye."""

    def __init__(self, camera, lower, upper):
        rows, columns = camera.shape
        self.camera, self.lower, self.upper = camera, lower, upper
        right = camera.low[0] + np.arange(columns) / camera.scale
        up = camera.high[1] - np.arange(rows) / camera.scale
        self.start = (right[None, :, None] * camera.turn[0] +
                      up[:, None, None] * camera.turn[1]).reshape(-1, 3)
        self.towards = camera.turn[2]
        self.near, self.far = 0., 0.
        self.far, self.near = slabs(self.start, self.towards, lower, upper)

    def first(self, enters, leaves):
        """Depth at which rays that are inside a convex solid between two depths
        meet it within the box; -inf where they do not."""
        low, high = np.maximum(enters, self.far), np.minimum(leaves, self.near)
        return np.where(low < high, high, -np.inf)


def slabs(start, along, lower, upper):
    """Depths between which rays are within a box; the first is larger where they
    miss it."""
    low = np.full(len(start), -np.inf)
    high = np.full(len(start), np.inf)
    for d in range(3):
        if abs(along[d]) < 1e-12:
            outside = (start[:, d] < lower[d]) | (start[:, d] > upper[d])
            low[outside], high[outside] = np.inf, -np.inf
            continue
        one, other = ((end[d] - start[:, d]) / along[d]
                      for end in (lower, upper))
        low = np.maximum(low, np.minimum(one, other))
        high = np.minimum(high, np.maximum(one, other))
    return low, high


def _of_circle(start, along, centre, radius):
    """Depths between which rays are within a ball, or, without one component, an
    infinite cylinder."""
    away = start - centre
    a = along @ along
    b, c = away @ along, (away**2).sum(axis=1) - radius**2
    if a < 1e-24:
        return np.where(c < 0, -np.inf, np.inf), np.where(c < 0, np.inf, -np.inf)
    root = b**2 - a * c
    with np.errstate(invalid="ignore"):
        half = np.sqrt(root) / a
    return (np.where(root > 0, -b / a - half, np.inf),
            np.where(root > 0, -b / a + half, -np.inf))


def _hits(parameters, section, constants, motion, rays):
    """First depth of each ray within one shape; nothing if it is not drawn."""
    shape, inner = drawn_shape(parameters, section)

    def numbers(name):
        return run_folder.numbers(parameters[f"{inner}/{name}"])
    if shape == "union":
        parts = [_hits(parameters, f"{inner}/Shape {part}", constants, motion,
                       rays)
                 for part in run_folder.words(parameters[f"{inner}/Shapes"])]
        parts = [part for part in parts if part is not None]
        return np.max(parts, axis=0) if parts else None
    if shape in HIDDEN or shape == "half-space":
        return None
    if shape in ("stl", "block"):
        return _first_facets(motion.now(_facets(parameters, inner, shape)), rays)
    start = motion.back(rays.start)
    along = rays.towards @ motion.turn
    if shape == "ball":
        return rays.first(*_of_circle(start, along, numbers("Centre"),
                                      numbers("Radius")[0]))
    if shape == "cylinder":
        axis = "xyz".index(parameters[f"{inner}/Axis"].strip())
        across = [d for d in range(3) if d != axis]
        centre = numbers("Centre")
        centre = centre[across] if len(centre) == 3 else centre
        low, high = _of_circle(start[:, across], along[across], centre,
                               numbers("Radius")[0])
        ends = [np.full(3, -np.inf), np.full(3, np.inf)]
        ends[0][axis], ends[1][axis] = numbers("Lower end"), numbers("Upper end")
        one, other = slabs(start, along, *ends)
        return rays.first(np.maximum(low, one), np.minimum(high, other))
    box = [run_folder.numbers(parameters[f"{inner}/{name}"])
           if parameters.get(f"{inner}/{name}") else np.full(3, sign * np.inf)
           for name, sign in (("Lower corner", -1), ("Upper corner", 1))]
    low, high = slabs(start, along, *box)
    if shape == "box":
        return rays.first(low, high)
    formula = obstacles.Formula(parameters[f"{inner}/Inside"], constants)
    return _first_of_formula(formula, start, along, np.maximum(low, rays.far),
                             np.minimum(high, rays.near))


def _first_of_formula(formula, start, along, far, near):
    """Samples from the near end of rays on, then bisection."""
    def inside(which, depth):
        place = start[which] + depth[:, None] * along
        value = formula(x=place[:, 0], y=place[:, 1], z=place[:, 2], t=0.)
        return value + 0 * depth > 0
    first = np.full(len(start), -np.inf)
    open_rays = np.flatnonzero(near > far)
    step = (near - far)[open_rays] / SAMPLES
    found = inside(open_rays, near[open_rays])
    first[open_rays[found]] = near[open_rays[found]]
    open_rays, step = open_rays[~found], step[~found]
    for k in range(1, SAMPLES + 1):
        depth = near[open_rays] - k * step
        found = inside(open_rays, depth)
        which, low, high = open_rays[found], depth[found], (depth + step)[found]
        for _ in range(12):
            middle = (low + high) / 2
            within = inside(which, middle)
            low, high = np.where(within, middle, low), np.where(within, high,
                                                                middle)
        first[which] = low
        open_rays, step = open_rays[~found], step[~found]
    return first


def _first_facets(facets, rays):
    """The nearest facet of each pixel. A solid that reaches beyond the box is cut
    there: where a ray crosses an odd number of facets in front of the box."""
    camera = rays.camera
    rows, columns = camera.shape
    seen = camera.project(facets.reshape(-1, 3)).reshape(-1, 3, 3)
    at = np.stack([(seen[..., 0] - camera.low[0]) * camera.scale,
                   (camera.high[1] - seen[..., 1]) * camera.scale], axis=-1)
    depth = np.full((rows, columns), -np.inf)
    in_front = np.zeros((rows, columns), bool)
    near, far = (end.reshape(rows, columns) for end in (rays.near, rays.far))
    for corners, heights in zip(at, seen[..., 2]):
        low = np.maximum(np.ceil(corners.min(axis=0)), 0).astype(int)
        high = np.minimum(np.floor(corners.max(axis=0)),
                          (columns - 1, rows - 1)).astype(int)
        edges = corners[1:] - corners[0]
        area = edges[0, 0] * edges[1, 1] - edges[0, 1] * edges[1, 0]
        if (low > high).any() or area == 0:
            continue
        x, y = np.meshgrid(np.arange(low[0], high[0] + 1) - corners[0, 0],
                           np.arange(low[1], high[1] + 1) - corners[0, 1])
        one = (x * edges[1, 1] - y * edges[1, 0]) / area
        other = (y * edges[0, 0] - x * edges[0, 1]) / area
        # Half open, so that the common edge of two facets counts once.
        within = (one >= 0) & (other >= 0) & (one + other < 1)
        height = (heights[0] + one * (heights[1] - heights[0]) +
                  other * (heights[2] - heights[0]))
        part = np.s_[low[1]:high[1] + 1, low[0]:high[0] + 1]
        before = within & (height > near[part])
        in_front[part] ^= before
        within &= ~before & (height > far[part])
        depth[part] = np.where(within, np.maximum(height, depth[part]),
                               depth[part])
    depth = np.where(in_front & (near > far), near, depth)
    return depth.ravel()


# ---- all obstacles of a scene ------------------------------------------------------


def each(parameters, time):
    """Section, constants and motion of each obstacle."""
    for name in run_folder.words(parameters.get("Obstacles", "")):
        section = f"Obstacle {name}"
        constants = obstacles.constants_of(parameters, section)
        yield section, constants, Motion(parameters, section, constants, time)


def depths(camera, parameters, time, lower, upper):
    """(rows, columns): depth of the first obstacle within the box, -inf where
    there is none; nothing if no obstacle is drawn so."""
    found = []
    rays = None
    for section, constants, motion in each(parameters, time):
        rays = rays or Rays(camera, lower, upper)
        hits = _hits(parameters, section, constants, motion, rays)
        if hits is not None:
            found.append(hits)
        elif drawn_shape(parameters, section)[0] != "half-space":
            print(f"'{section}' is not drawn: its shape is not one that is drawn "
                  "in three dimensions.", file=sys.stderr)
    return np.max(found, axis=0).reshape(camera.shape) if found else None


def _box_of_shape(parameters, section):
    """Corners around a bounded shape at the start, or nothing."""
    shape, inner = drawn_shape(parameters, section)

    def numbers(name):
        return run_folder.numbers(parameters[f"{inner}/{name}"])
    if shape == "union":
        boxes = [_box_of_shape(parameters, f"{inner}/Shape {part}")
                 for part in run_folder.words(parameters[f"{inner}/Shapes"])]
        boxes = [box for box in boxes if box is not None]
        return (np.min([b[0] for b in boxes], axis=0),
                np.max([b[1] for b in boxes], axis=0)) if boxes else None
    if shape in ("stl", "block"):
        corners = _facets(parameters, inner, shape).reshape(-1, 3)
        return corners.min(axis=0), corners.max(axis=0)
    if shape == "ball":
        centre, radius = numbers("Centre"), numbers("Radius")[0]
        return centre - radius, centre + radius
    if shape == "cylinder":
        axis = "xyz".index(parameters[f"{inner}/Axis"].strip())
        centre, radius = numbers("Centre"), numbers("Radius")[0]
        centre = np.insert(centre, axis, 0.) if len(centre) == 2 else centre
        low, high = centre - radius, centre + radius
        low[axis], high[axis] = numbers("Lower end")[0], numbers("Upper end")[0]
        return low, high
    names = "Lower corner", "Upper corner"
    if shape in ("box", "formula") and all(
            parameters.get(f"{inner}/{name}") for name in names):
        return tuple(numbers(name) for name in names)
    return None


def around(parameters, time):
    """Corners around each obstacle that is bounded, at a time."""
    for section, _, motion in each(parameters, time):
        box = _box_of_shape(parameters, section)
        if box is not None:
            corners = motion.now(np.array(
                [[box[i >> d & 1][d] for d in range(3)] for i in range(8)]))
            yield corners.min(axis=0), corners.max(axis=0)


def polygons(parameters, time, lower, upper):
    """The planes of half-spaces within a box: corners, in the order of the
    outline."""
    for section, _, motion in each(parameters, time):
        shape, inner = drawn_shape(parameters, section)
        if shape != "half-space":
            continue
        place = motion.now(run_folder.numbers(parameters[f"{inner}/Point"]))
        normal = motion.turn @ run_folder.numbers(parameters[f"{inner}/Normal"])
        corners = _cut_of_box(place, normal / np.linalg.norm(normal), lower,
                              upper)
        if len(corners) > 2:
            yield corners


def _cut_of_box(place, normal, lower, upper):
    """Where the edges of the box meet the plane, around their mean."""
    found = []
    for d in range(3):
        for i in range(4):
            one = np.array([(lower, upper)[i >> k & 1][e] if e != d else lower[d]
                            for e, k in zip(range(3), _bits(d))])
            other = one.copy()
            other[d] = upper[d]
            a, b = (one - place) @ normal, (other - place) @ normal
            if a * b <= 0 and a != b:
                found.append(one + a / (a - b) * (other - one))
    if len(found) < 3:
        return []
    found = np.array(found)
    across = np.linalg.svd(np.atleast_2d(normal))[2][1:]
    flat = (found - found.mean(axis=0)) @ across.T
    return found[np.argsort(np.arctan2(flat[:, 1], flat[:, 0]))]


def _bits(d):
    """Which bit of a number of four says where each other axis stands."""
    others = [e for e in range(3) if e != d]
    return [others.index(e) if e != d else 0 for e in range(3)]
