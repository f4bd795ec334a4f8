"""Panels of a field: one picture of one run each, with the same colours and the
same size for all of them."""

import charts
from charts import np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.tri import Triangulation

import fields
import obstacles
import run_folder
import solids
import spheres
import squares

OTHERS = 0.74  # grey of other bodies
SLENDER = 0.15  # height over width of what stands in one column


class State:
    """What one panel shows: places, values and, for a body, its name."""

    def __init__(self, source, index, look):
        self.source, self.index = source, index
        self.time = source.times[index]
        cloud = fields.of_body(source.at(index), source,
                               None if look.others else look.body)
        self.values = fields.value(cloud, look.field, source.folder)
        self.others = np.zeros(len(self.values), bool)
        if look.others and len(source.bodies) > 1:
            mine = fields.mask_of_body(cloud, source, look.body)
            self.others = ~mine
            self.values = np.where(mine, self.values, np.nan)
        self.place = np.array(cloud["position"], float)
        self.start = None
        if look.enlarge != 1 or source.is_reference:
            move = np.stack([fields.value(cloud, f"displacement {d}",
                                          source.folder) for d in "xyz"], axis=1)
            self.start = self.place - move
            self.place = self.start + look.enlarge * move
        self.cells = source.cells(index) if look.grid else None
        self.spacing = self._size(look.body)
        self.sizes = np.full(len(self.place), self.spacing)  # one a point
        if "body" in cloud and (look.body is None or look.others):
            own = [self._size(name) for name in source.bodies]
            self.sizes = np.array(own)[np.round(cloud["body"]).astype(int)]
        # Points of fine cells are small.
        self.sizes = self.sizes * source.shrinking(
            index, np.array(cloud["position"], float))

    def _size(self, body):
        """Of what is drawn for a point. A liquid parts its points, and would be
        full of gaps."""
        return self.source.spacing(body) * (
            1.5 if self.source.flows(body) else 1)


class Look:
    """What is drawn and how: the same for all panels of a picture.

    field, body: names; enlarge: factor of displacements; limits: lower and upper
    end of the colours, in the unit of the field, or nothing; view: azimuth and
    elevation in degrees; zoom: (lower, upper) corner of what is seen, or nothing;
    grid: whether the lines of the cells are drawn; others: whether the other
    bodies are drawn in grey; side_by_side: a column for each run.
    """

    def __init__(self, field, body=None, enlarge=1., limits=None,
                 view=(30., 20.), zoom=None, grid=False, others=False,
                 side_by_side=False):
        self.grid, self.others, self.side_by_side = grid, others, side_by_side
        self.field, self.body, self.enlarge = field, body, enlarge
        self.limits, self.view, self.zoom = limits, view, zoom
        self.is_body = field == "body"
        self.pixels = 1100  # of the width of a panel

    def fix(self, states):
        """Colours, unit and corners for good, from all states that are seen."""
        values = np.concatenate([state.values for state in states])
        finite = values[np.isfinite(values)]
        if not len(finite):
            charts.fail(f"The field '{self.field}' has no finite value.")
        # Without the two hundredths at either end: one point that splashes
        # would take all colours. The arrows of the bar stand for what is left.
        low, high = self.limits or np.percentile(finite, [0.5, 99.5])
        if low == high:
            low, high = low - 0.5 * abs(low or 1), high + 0.5 * abs(high or 1)
        self.factor, self.unit = charts.scaled_unit(
            fields.unit_of(self.field), max(abs(low), abs(high)))
        both_signs = low < 0 < high and min(-low, high) > 0.15 * max(-low, high)
        if both_signs and not self.limits:
            low, high = -max(-low, high), max(-low, high)
        # Grey at zero: a body at rest stands out from the paper.
        self.map = charts.plt.get_cmap("coolwarm" if both_signs else "viridis")
        self.norm = Normalize(low, high)
        self.longest = max(state.source.times[-1] for state in states)
        self.beyond = {(False, False): "neither", (True, False): "min",
                       (False, True): "max", (True, True): "both"}[
            bool(finite.min() < low), bool(finite.max() > high)]
        if self.is_body:
            names = states[0].source.bodies
            self.map = ListedColormap([
                charts.COLOURS[i % len(charts.COLOURS)]
                for i in range(len(names))])
            self.norm = Normalize(-0.5, len(names) - 0.5)
        if self.zoom:
            self.lower, self.upper = self.zoom
        else:
            margin = max(state.spacing for state in states)
            self.lower = np.min([s.place.min(axis=0) for s in states],
                                axis=0) - margin
            self.upper = np.max([s.place.max(axis=0) for s in states],
                                axis=0) + margin
            if states[0].source.dimension == 3:
                self._see_obstacles(states)
            if self.enlarge == 1:
                self._keep_to_the_grid(states[0].source)

    def _see_obstacles(self, states):
        """Room for those parts of bounded obstacles that are in the grid."""
        for state in states:
            low, high = _box_of(state)
            for one, other in solids.around(state.source.parameters, state.time):
                one, other = np.maximum(one, low), np.minimum(other, high)
                if (one < other).all():
                    self.lower = np.minimum(self.lower, one)
                    self.upper = np.maximum(self.upper, other)

    def _keep_to_the_grid(self, source):
        """The margin ends at the sides of the grid."""
        for d in range(source.dimension):
            grid = [run_folder.numbers(source.parameters[f"Grid/{name}"])[d]
                    for name in ("Lower corner", "Upper corner")]
            self.lower[d] = max(self.lower[d], grid[0])
            self.upper[d] = min(self.upper[d], grid[1])

    def colours(self, values):
        return self.map(self.norm(values))[:, :3]

    def title(self, state):
        shape = {1: "", 0: ", undeformed"}.get(
            self.enlarge, f", displacements × {self.enlarge:g}")
        return charts.with_time(state.time, self.longest) + shape

    @property
    def aspect(self):
        """Height over width of a panel."""
        extent = self.upper - self.lower
        return extent[1] / extent[0]

    def bar(self, figure, axes):
        """The scale of colours, or the names of bodies."""
        scale = ScalarMappable(Normalize(self.norm.vmin / self.factor,
                                         self.norm.vmax / self.factor),
                               self.map)
        if self.is_body:
            bar = figure.colorbar(scale, ax=axes, shrink=0.6, label="body")
            bar.set_ticks(range(len(self.names)), labels=self.names)
        else:
            figure.colorbar(scale, ax=axes, extend=self.beyond, shrink=0.85,
                            label=fields.label_of(self.field, self.unit))


def draw(axis, state, look):
    """One state into one panel."""
    look.names = state.source.bodies
    if state.source.dimension == 3:
        _draw_spheres(axis, state, look)
        return
    if state.source.is_reference:
        _draw_elements(axis, state, look)
    else:
        _draw_squares(axis, state, look)
    axis.set_xlim(look.lower[0], look.upper[0])
    axis.set_ylim(look.lower[1], look.upper[1])
    axis.set_aspect("equal")
    if state.cells is not None:
        _draw_cells(axis, *state.cells)
    _draw_box(axis, state, look)
    obstacles.draw(axis, state.source.parameters, state.time, look.lower,
                   look.upper)


def _box_of(state):
    return [run_folder.numbers(state.source.parameters[f"Grid/{name}"])
            for name in ("Lower corner", "Upper corner")]


def _draw_squares(axis, state, look):
    lower, upper = look.lower[:2], look.upper[:2]
    owner = squares.owners(state.place[:, :2], state.sizes, lower, upper,
                           _box_of(state), look.pixels)
    colours = look.map(look.norm(state.values))
    colours[state.others] = OTHERS, OTHERS, OTHERS, 1
    picture = colours[owner]
    picture[owner < 0, 3] = 0
    height = owner.shape[0] / owner.shape[1] * (upper[0] - lower[0])
    axis.imshow(picture, origin="lower", interpolation="antialiased", extent=(
        lower[0], upper[0], lower[1], lower[1] + height))


def _draw_box(axis, state, look):
    """The sides of the grid's box, grey, where they are in sight."""
    lower, upper = _box_of(state)
    axis.plot([lower[0], upper[0], upper[0], lower[0], lower[0]],
              [lower[1], lower[1], upper[1], upper[1], lower[1]],
              color="0.6", linewidth=0.8, zorder=0, scalex=False, scaley=False)


def _draw_cells(axis, lower, upper):
    """The edges of cells, each line once; finer ones over coarser ones, and
    thinner where they would hide what is below them."""
    lines = np.concatenate([
        np.stack([lower, np.stack([upper[:, 0], lower[:, 1]], axis=1)], axis=1),
        np.stack([lower, np.stack([lower[:, 0], upper[:, 1]], axis=1)], axis=1)])
    points = 72 / axis.figure.dpi * axis.bbox.width / np.diff(axis.get_xlim())
    axis.add_collection(LineCollection(
        lines, colors="0.55", zorder=3, linewidths=np.tile(
            np.clip(0.06 * points * (upper - lower)[:, 0], 0.1, 0.45), 2)))


def _draw_elements(axis, state, look):
    """Values on nodes, linear between them; triangles outside of the body, which
    are longer than the distances of nodes around, are left out."""
    mesh = Triangulation(state.start[:, 0], state.start[:, 1])
    corners = np.stack([mesh.x, mesh.y], axis=1)[mesh.triangles]
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    nearest = np.full(len(mesh.x), np.inf)
    for k in range(3):
        for node in (mesh.triangles[:, k], mesh.triangles[:, k - 1]):
            np.minimum.at(nearest, node, edges[:, k])
    mesh.set_mask(edges.max(axis=1) >
                  3 * nearest[mesh.triangles].max(axis=1))
    moved = Triangulation(state.place[:, 0], state.place[:, 1],
                          mesh.triangles, mesh.mask)
    axis.tripcolor(moved, state.values, shading="gouraud", cmap=look.map,
                   norm=look.norm, rasterized=True)


def _draw_spheres(axis, state, look):
    camera = _camera_of(look, _upwards(state.source), look.pixels)
    radius = 0.75 * state.spacing
    left, right = camera.low[0], camera.high[0]
    bottom, top = camera.low[1], camera.high[1]
    solid = solids.depths(camera, state.source.parameters, state.time,
                          look.lower, look.upper)
    _draw_floor(axis, camera, look, state, radius, solid)
    _draw_planes(axis, camera, look, state)
    colours = look.colours(state.values)
    colours[state.others] = OTHERS
    axis.imshow(spheres.render(camera, state.place, colours, radius, solid,
                               state.others),
                extent=(left, right, bottom, top), zorder=2,
                interpolation="antialiased")
    margin = 0.03 * (right - left)
    axis.set_xlim(left - 2.5 * margin, right + margin)
    axis.set_ylim(bottom - 2.5 * margin, top + 0.3 * margin)
    axis.set_aspect("equal")
    axis.set_axis_off()


def _draw_planes(axis, camera, look, state):
    """The planes of half-spaces: pale behind what is drawn, their outline over
    it."""
    for corners in solids.polygons(state.source.parameters, state.time,
                                   look.lower, look.upper):
        seen = camera.project(corners)[:, :2]
        axis.fill(*seen.T, color="0.9", zorder=0.8, linewidth=0)
        axis.plot(*np.vstack([seen, seen[:1]]).T, color="0.5", linewidth=0.7,
                  zorder=0.9)


def _camera_of(look, up, pixels):
    """A camera that sees the box of the look and all of its floor."""
    lower, upper, _ = _floor_of(look, up)
    return spheres.Camera(lower, upper, *look.view, up, pixels)


def _floor_of(look, up):
    """The box that is seen, grown to whole squares of the floor that go a fifth
    of one beyond, and the edge of a square: a round number of metres."""
    extent = max(np.delete(look.upper - look.lower, up))
    edge = _round(extent / 9)
    lower, upper = look.lower.copy(), look.upper.copy()
    for d in range(3):
        if d != up:
            lower[d] = edge * np.floor(lower[d] / edge - 0.2)
            upper[d] = edge * np.ceil(upper[d] / edge + 0.2)
    return lower, upper, edge


def _round(length):
    """The next one of 1, 2, 5 times a power of ten that is not less."""
    power = 10.**np.floor(np.log10(length))
    return next(n * power for n in (1, 2, 5, 10) if n * power >= length * 0.999)


def _upwards(source):
    """The axis that gravity pulls against; y where there is none."""
    gravity = run_folder.numbers(source.parameters.get("Loads/Gravity", "0"))
    return int(np.argmax(abs(gravity))) if np.any(gravity) else 1


def _draw_floor(axis, camera, look, state, radius, solid):
    """Squares below the points with their shadow, and scales in metres along
    the two edges of the floor next to the eye and upwards at the left."""
    up = _upwards(state.source)
    lower, upper, edge = _floor_of(look, up)
    level = [d for d in range(3) if d != up]

    def seen(place):
        return camera.project(np.array(place))[..., :2]

    def point(**at):
        place = lower.copy()
        for d, value in at.items():
            place["xyz".index(d)] = value
        return place

    a, b = ("xyz"[d] for d in level)
    ends = {"xyz"[d]: (lower[d], upper[d]) for d in range(3)}
    corners = [point(**{a: ends[a][i], b: ends[b][j]})
               for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
    plane = axis.fill(*seen(corners).T, color="0.965", zorder=0, linewidth=0)[0]
    for one, other in ((a, b), (b, a)):
        for value in _marks(*ends[one], edge):
            line = [point(**{one: value, other: end}) for end in ends[other]]
            axis.plot(*seen(line).T, color="0.82", linewidth=0.6, zorder=0.5)
    places = state.place
    if solid is not None:
        places = np.concatenate([places, _seen_of(solid, camera)])
    dark = spheres.shadow(camera, places, radius, lower[up], up)
    shade = axis.imshow(
        np.dstack([np.zeros((*dark.shape, 3)), 0.38 * dark]), zorder=0.7,
        extent=(camera.low[0], camera.high[0], camera.low[1], camera.high[1]))
    shade.set_clip_path(plane)

    factor, unit = (1e3, "mm") if max(upper - lower) < 0.2 else (1, "m")
    centre = np.mean([seen(corner) for corner in corners], axis=0)
    shortest = 0.04 * (camera.high[0] - camera.low[0])  # of a scale that is seen
    nearest = min(corners, key=lambda c: seen(c)[1])  # has a number of one scale
    for one, other in ((a, b), (b, a)):
        # the one of the two edges that is lower in the picture
        end = min(ends[other], key=lambda e: seen(point(
            **{one: np.mean(ends[one]), other: e}))[1])
        values = [value for value in _marks(*ends[one], edge) if one == a or
                  abs(value - nearest["xyz".index(one)]) > edge / 2]
        places = [seen(point(**{one: value, other: end})) for value in values]
        if places and np.hypot(*(places[-1] - places[0])) > shortest:
            _scale(axis, places, np.array(values) * factor, f"{one} [{unit}]",
                   centre)
    corner = min(corners, key=lambda c: seen(c)[0])
    top = corner.copy()
    top[up] = upper[up]
    if np.hypot(*(seen(top) - seen(corner))) <= shortest:
        return  # seen from above
    axis.plot(*seen([corner, top]).T, color="0.5", linewidth=0.7, zorder=1)
    rise = _round((upper[up] - lower[up]) / 4)
    values = _marks(*ends["xyz"[up]], rise)
    places = []
    for value in values:
        corner[up] = value
        places.append(seen(corner))
        axis.plot(*(places[-1][:, None] + [[0, -0.006 * (
            camera.high[0] - camera.low[0])], [0, 0]]), color="0.5",
            linewidth=0.7, zorder=1)
    _scale(axis, places, values * factor, f"{'xyz'[up]} [{unit}]", None)


def _seen_of(solid, camera):
    """Places of the surface of obstacles, for their shadow."""
    i, j = np.nonzero(np.isfinite(solid[::3, ::3]))
    seen = np.stack([camera.low[0] + 3 * j / camera.scale,
                     camera.high[1] - 3 * i / camera.scale,
                     solid[::3, ::3][i, j]], axis=1)
    return seen @ camera.turn


def _marks(low, high, step):
    """Multiples of a step within an interval, its ends included."""
    return step * np.arange(int(np.ceil(low / step - 1e-6)),
                            int(np.floor(high / step + 1e-6)) + 1)


def _scale(axis, places, values, name, centre):
    """Numbers at places along an edge of the floor, outward from its centre, or
    at the left; some six of them. The name stands further
    out at the middle."""
    style = {"fontsize": 7, "color": "0.3", "textcoords": "offset points"}
    if len(places) == 0:
        return
    every = -(-len(places) // 6)
    step = values[1] - values[0] if len(values) > 1 else 1
    numbered = [(place, value) for place, value in zip(places, values)
                if round(value / step) % every == 0]
    middle = (places[0] + places[-1]) / 2
    if centre is None:
        for place, value in numbered:
            axis.annotate(f"{value:.4g}", place, xytext=(-5, 0), ha="right",
                          va="center", **style)
        axis.annotate(name, middle, xytext=(-24, 0), ha="center", va="center",
                      rotation=90, **style)
        return
    along = places[-1] - places[0]
    outward = np.array([along[1], -along[0]]) / np.hypot(*along)
    if outward @ (middle - centre) < 0:
        outward = -outward
    for place, value in numbered:
        axis.annotate(f"{value:.4g}", place, xytext=9 * outward, ha="center",
                      va="center", **style)
    axis.annotate(name, middle, xytext=24 * outward, ha="center", va="center",
                  **style)


def _below_each_other(states, aspect):
    """Pictures of one run in rows: what is flat, a beam or a slope, stands in one
    column or two, as it would be tiny side by side."""
    columns = len(states)
    if aspect < SLENDER or aspect < 0.4 and columns <= 3:
        columns = 1
    elif aspect < 0.6:
        columns = min(columns, 2)
    return [states[i:i + columns] for i in range(0, len(states), columns)]


TALL = 1.3  # height over width of pictures of which several stand side by side


def _stand_side_by_side(states, look, aspect):
    """Whether each run has a column: as asked for, else pictures of one time each
    that are tall."""
    return len(states) > 1 and (look.side_by_side or
                                len(states[0]) == 1 and aspect > TALL)


def figure_of(states, look, labels, width=None):
    """A figure with a row for each run and a column for each time, or the other
    way round; slender bodies in one column; @p states is a list of rows. Returns
    the figure."""
    look.fix([state for row in states for state in row])
    dimension = states[0][0].source.dimension
    aspect = look.aspect
    if dimension == 3:
        camera = _camera_of(look, _upwards(states[0][0].source), 100)
        aspect = camera.shape[0] / camera.shape[1]
    headings = None
    if _stand_side_by_side(states, look, aspect):
        headings, labels = labels, [""] * len(states[0])
        states = [list(row) for row in zip(*states)]
    elif len(states) == 1:
        labels = [""] * len(states[0])
        if dimension == 2:
            states = _below_each_other(states[0], aspect)
    elif dimension == 2 and aspect < SLENDER:
        labels = labels * len(states[0])
        states = [[state] for column in zip(*states) for state in column]
    rows, columns = len(states), max(len(row) for row in states)
    if dimension == 3:
        look.pixels = 1000 if width else 1500 if columns == 1 else 1100
    else:
        look.pixels = 1600 if columns == 1 else 1000
    panel = (width / (columns if headings else 1) if width else
             6.5 if columns == 1 else min(4.2, 13 / columns))
    height = np.clip(panel * aspect, 1, 6) + (0.75 if rows == 1 else 0.45)
    if headings:
        height += 0.25
    figure, axes = charts.plt.subplots(
        rows, columns, squeeze=False, sharex=dimension == 2,
        sharey=dimension == 2, layout="constrained",
        figsize=(panel * columns + 1.3, height * rows + 0.1))
    for i, (row, label) in enumerate(zip(states, labels)):
        for axis, state in zip(axes[i], row):
            draw(axis, state, look)
            if headings:
                heading = headings[row.index(state)] + "\n" if i == 0 else ""
                axis.set_title(heading + look.title(state))
            elif i == 0 or state.time != states[0][row.index(state)].time:
                axis.set_title(look.title(state))
            below = states[i + 1] if i + 1 < rows else []
            if dimension == 2 and len(below) <= row.index(state):
                axis.set_xlabel("x [m]")
                axis.tick_params(labelbottom=True)
        for axis in axes[i][len(row):]:
            axis.set_axis_off()
        if dimension == 2:
            axes[i][0].set_ylabel("y [m]")
        if label:
            # above the times where those have little room
            above = "\n" if columns > 1 and axes[i][0].get_title() else ""
            axes[i][0].set_title(label + above, loc="left", fontweight="bold")
    look.bar(figure, axes)
    return figure
