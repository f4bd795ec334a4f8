"""Points in three dimensions as shaded spheres, in numpy alone: no graphics
card, no display (VTK as Debian packages it needs an X server even off screen). An
orthographic camera, a depth buffer that is smoothed to the surface the points
stand for, light from the upper left with a highlight, dimmer where neighbours
stand closer to the eye, and a soft shadow on the floor."""

from charts import np


class Camera:
    """Looks at a box from @p azimuth and @p elevation, in degrees; @p up is the
    axis that points upwards in the picture. Azimuth 0 looks along one of
    the other two axes; right, up and towards the eye are right-handed."""

    def __init__(self, lower, upper, azimuth, elevation, up, pixels):
        right0 = {1: (1., 0, 0), 2: (1., 0, 0), 0: (0, 1., 0)}[up]
        eye0 = {1: (0, 0, 1.), 2: (0, -1., 0), 0: (0, 0, -1.)}[up]
        top0 = np.eye(3)[up]
        a, e = np.radians((azimuth, elevation))
        right = np.cos(a) * np.array(right0) - np.sin(a) * np.array(eye0)
        level = np.sin(a) * np.array(right0) + np.cos(a) * np.array(eye0)
        self.eye = np.cos(e) * level + np.sin(e) * top0
        top = -np.sin(e) * level + np.cos(e) * top0
        self.turn = np.stack([right, top, self.eye])  # rows: right, up, depth
        corners = self.project(np.array(
            [[(lower, upper)[i >> d & 1][d] for d in range(3)]
             for i in range(8)]))
        self.low = corners[:, :2].min(axis=0)
        self.high = corners[:, :2].max(axis=0)
        width, height = self.high - self.low
        self.scale = pixels / width  # pixels per metre
        self.shape = int(np.ceil(height * self.scale)) + 1, pixels + 1

    def project(self, places):
        """Right and up in metres, and the depth towards the eye."""
        return places @ self.turn.T


LIGHT = np.array([-0.45, 0.6, 0.66])
SOLID = 0.74  # grey of obstacles


def render(camera, places, colours, radius, solid=None, kinds=None):
    """RGBA picture, (rows, columns, 4), row 0 at the top, transparent where
    there is nothing. colours: RGB of each point; radius in metres; solid: depth
    of obstacles in metres for each pixel, -inf where there are none; kinds:
    numbers of points; colours of different kinds do not run into each other."""
    rows, columns = camera.shape
    seen = camera.project(places)
    x = (seen[:, 0] - camera.low[0]) * camera.scale
    y = (camera.high[1] - seen[:, 1]) * camera.scale
    depth = seen[:, 2] * camera.scale
    r = max(radius * camera.scale, 0.8)

    order = np.argsort(depth)  # of points on the same pixel the nearest wins
    x, y, depth = x[order], y[order], depth[order]
    column0, row0 = np.round(x).astype(int), np.round(y).astype(int)
    buffer = np.full(rows * columns, -np.inf)
    owner = np.full(rows * columns, -1)
    reach = int(np.ceil(r))
    winner = np.empty(rows * columns, int)
    for i in range(-reach, reach + 1):
        for j in range(-reach, reach + 1):
            if i * i + j * j > r * r:
                continue
            bump = np.sqrt(r * r - i * i - j * j)
            row, column = row0 + i, column0 + j
            inside = np.flatnonzero((row >= 0) & (row < rows) & (column >= 0) &
                                    (column < columns))
            pixel = row[inside] * columns + column[inside]
            winner[pixel] = inside  # the last, nearest one stays
            pixel = np.unique(pixel)
            point = winner[pixel]
            nearer = depth[point] + bump > buffer[pixel]
            pixel, point = pixel[nearer], point[nearer]
            buffer[pixel] = depth[point] + bump
            owner[pixel] = point
    buffer = buffer.reshape(rows, columns)
    owner = owner.reshape(rows, columns)
    buffer, owner = _closed(buffer, owner, r)
    cover = _rim(owner >= 0, r)
    buffer, owner = _filled(buffer, owner, cover > 0)
    covered = (owner >= 0) & (cover > 0)
    buffer[~covered] = -np.inf

    flat = np.ones((rows, columns, 3))
    flat[covered] = colours[order][owner[covered]]
    kind = np.zeros((rows, columns), int)
    if kinds is not None:
        kind[covered] = np.asarray(kinds, int)[order][owner[covered]]
    smooth, flat = _smoothed(buffer, flat, covered, kind, r)
    if solid is None:
        solid = np.full((rows, columns), -np.inf)
    solid = solid * camera.scale
    has_solid = np.isfinite(solid)
    seen_points = covered & ~(solid > smooth)
    sky = _open_sky(np.where(seen_points, smooth, solid),
                    seen_points | has_solid, r)
    picture = np.ones((rows, columns, 4))
    picture[..., 3] = has_solid
    if has_solid.any():
        picture[has_solid, :3] = _lit(np.full_like(flat, SOLID), solid, has_solid,
                                      sky)[has_solid]
    share = np.where(has_solid, cover, 1.)[seen_points, None]
    picture[seen_points, :3] = (
        share * _lit(flat, smooth, covered, sky)[seen_points] +
        (1 - share) * picture[seen_points, :3])
    picture[seen_points, 3] = np.where(has_solid, 1, cover)[seen_points]
    return np.clip(picture, 0, 1)


def _lit(flat, depth, covered, sky):
    """Colours in the light. A little white light shows the shape of dark ones,
    too."""
    diffuse, highlight = _light(depth, covered)
    return (flat * (0.66 + 0.42 * diffuse)[..., None] +
            (0.07 * diffuse + 0.14 * highlight)[..., None]) * sky[..., None]


def _rim(covered, r):
    """How much of each pixel is covered, 0 to 1: the outline of the material, not
    of its spheres, which is a mean over somewhat more than the distance of two.
    What stands alone, as a drop does, stays a sphere."""
    reach = max(int(round(r)), 1)
    share = _blurred(covered.astype(float), reach)
    smooth = np.clip(0.5 + (share - 0.5) * 2 * reach, 0, 1)
    # 0.5 at a straight edge, 0.25 at a corner, 0.2 in a sphere alone
    company = _blurred(covered.astype(float), 2 * reach)
    weight = np.clip((company - 0.25) / 0.15, 0, 1)
    return weight * smooth + (1 - weight) * covered


def _filled(depth, owner, wanted):
    """Pixels in the notches between spheres take what is beside them."""
    for _ in range(64):
        if not (wanted & (owner < 0)).any():
            break
        before = owner
        for i, j in ((0, 1), (0, -1), (1, 0), (-1, 0)):
            missing = wanted & (owner < 0)
            other = _shifted(before, i, j, -1)
            take = missing & (other >= 0)
            depth = np.where(take, _shifted(depth, i, j, -np.inf), depth)
            owner = np.where(take, other, owner)
        if (owner == before).all():
            break
    return depth, owner


def shadow(camera, places, radius, floor, up):
    """Soft shadow on the plane @p floor across the axis @p up, from a light
    above and at the left of the camera: its darkness, 0 to 1, for the pixels of
    render()."""
    rows, columns = camera.shape
    away = 0.35 * camera.turn[0]  # from the light, along the floor
    slope = np.where(np.arange(3) == up, 0., away)
    fallen = places + (places[:, up] - floor)[:, None] * slope
    fallen[:, up] = floor
    seen = camera.project(fallen)
    x = np.round((seen[:, 0] - camera.low[0]) * camera.scale).astype(int)
    y = np.round((camera.high[1] - seen[:, 1]) * camera.scale).astype(int)
    inside = (x >= 0) & (x < columns) & (y >= 0) & (y < rows)
    dark = np.zeros((rows, columns))
    dark[y[inside], x[inside]] = 1
    r = max(int(np.ceil(radius * camera.scale)), 1)
    dark = np.minimum(_blurred(dark, r) * 4 * r, 1)  # joins the dots
    return np.clip(_blurred(_blurred(dark, 3 * r), 2 * r), 0, 1)


def _blurred(values, r):
    """Means over boxes of 2 r + 1 pixels."""
    for axis in (0, 1):
        width = [(0, 0), (0, 0)]
        width[axis] = (r + 1, r)
        total = np.cumsum(np.pad(values, width, mode="edge"), axis=axis)
        n = values.shape[axis]
        values = (np.take(total, np.arange(2 * r + 1, 2 * r + 1 + n), axis) -
                  np.take(total, np.arange(n), axis)) / (2 * r + 1)
    return values


def _shifted(values, i, j, outside):
    result = np.full_like(values, outside)
    rows, columns = values.shape
    if abs(i) >= rows or abs(j) >= columns:
        return result
    result[max(i, 0):rows + min(i, 0), max(j, 0):columns + min(j, 0)] = (
        values[max(-i, 0):rows + min(-i, 0), max(-j, 0):columns + min(-j, 0)])
    return result


def _closed(depth, owner, r):
    """Fills what is narrower than two spheres or so between points at about one
    depth: the gaps of a material whose points have been pulled apart."""
    for distance in (r, 1.5 * r, 2 * r):
        for angle in np.arange(4) * np.pi / 4:
            i, j = (int(round(distance * f(angle))) for f in (np.sin, np.cos))
            one, other = (_shifted(depth, s * i, s * j, -np.inf)
                          for s in (1, -1))
            level = np.minimum(one, other)
            with np.errstate(invalid="ignore"):
                gap = (np.isfinite(level) & (level > depth + r) &
                       (abs(one - other) < 4 * r))
            owner = np.where(gap, _shifted(owner, i, j, -1), owner)
            depth = np.where(gap, level, depth)
    return depth, owner


def _smoothed(depth, colours, covered, kind, r):
    """The surface that the spheres stand for, and its colours: means over
    neighbours at about the same depth, over ever shorter distances."""
    for step in (r, 0.7 * r, r, 0.5 * r, 0.7 * r, 0.3 * r):
        total = np.where(covered, depth, 0.)
        paint = colours.copy()
        count = covered.astype(float)
        alike = count.copy()
        near = max(int(round(step)), 1)
        across = max(int(round(0.7 * step)), 1)
        for i, j in ((0, near), (0, -near), (near, 0), (-near, 0),
                     (across, across), (-across, -across), (across, -across),
                     (-across, across)):
            other = _shifted(depth, i, j, -np.inf)
            with np.errstate(invalid="ignore"):
                same = covered & (abs(other - depth) < 4 * near)
            total += np.where(same, other, 0)
            count += same
            same &= _shifted(kind, i, j, -1) == kind
            alike += same
            for c in range(3):
                paint[..., c] += np.where(
                    same, _shifted(colours[..., c], i, j, 0), 0)
        count, alike = np.maximum(count, 1), np.maximum(alike, 1)
        depth = np.where(covered, total / count, -np.inf)
        colours = np.where(covered[..., None], paint / alike[..., None], colours)
    return depth, colours


def _light(depth, covered):
    """Diffuse light and highlight of each pixel, 0 to 1."""
    slopes = []
    for i, j in ((0, 1), (1, 0)):
        ahead, behind = (_shifted(depth, -i * s, -j * s, -np.inf)
                         for s in (1, -1))
        with np.errstate(invalid="ignore"):
            forward, backward = ahead - depth, depth - behind
        forward = np.where(np.isfinite(forward), forward, np.nan)
        backward = np.where(np.isfinite(backward), backward, np.nan)
        slope = np.where(np.isnan(forward), backward, np.where(
            np.isnan(backward), forward, (forward + backward) / 2))
        slopes.append(np.clip(np.nan_to_num(slope), -3, 3))
    normal = np.stack([-slopes[0], slopes[1], np.ones_like(depth)], axis=2)
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    towards = LIGHT / np.linalg.norm(LIGHT)
    half = towards + np.array([0, 0, 1.])  # the eye is along the last axis
    diffuse = np.clip(normal @ towards, 0, 1)
    highlight = np.clip(normal @ (half / np.linalg.norm(half)), 0, 1)**30
    return diffuse, highlight


def _open_sky(depth, covered, r):
    """Ambient occlusion: the share of neighbours that do not stand in front."""
    hidden, number = np.zeros_like(depth), 0
    for distance in (2 * r, 4 * r, 7 * r):
        for angle in np.arange(8) * np.pi / 4:
            i, j = (int(round(distance * f(angle))) for f in (np.sin, np.cos))
            other = _shifted(depth, i, j, -np.inf)
            with np.errstate(invalid="ignore"):
                rise = np.where(covered, other - depth, 0)
            hidden += np.clip(rise / distance - 0.1, 0, 1)
            number += 1
    return 1 - 0.65 * hidden / number
