"""Points in two dimensions as the material that they stand for, in numpy alone:
each is a square, and what lies between squares that have moved apart, but not as
far as where a crack opens, belongs to the nearest point."""

from charts import np

FINEST = 40  # pixels a square; more cost time and show nothing
GAP = 1.9  # edges of squares: a cell of 2 x 2 points without any is a crack


def owners(places, sizes, lower, upper, box, pixels):
    """Which point each pixel shows, (rows, columns), row 0 at the lower corner; -1
    where there is no material. sizes: edges of the squares; box: corners of the
    grid; at its sides material goes on; pixels: columns, less for few points."""
    pixels = int(np.ceil(min(pixels, FINEST * (upper[0] - lower[0]) /
                             sizes.max())))
    scale = pixels / (upper[0] - lower[0])
    reach = _reach(sizes.max() * scale)
    border = 2 * reach  # what is out of sight fills gaps, too
    shape = (max(int(np.ceil((upper[1] - lower[1]) * scale)), 1) + 2 * border,
             pixels + 2 * border)
    owner = np.full(shape, -1)
    distance = np.full(shape, np.inf)  # to the owner, squared, in pixels
    covered = np.zeros(shape, bool)
    at = (places - lower) * scale + border - 0.5  # whole at the centre of a pixel
    near = np.all((at > reach) & (at < np.array(shape)[::-1] - 1 - reach), axis=1)
    classes = [(size, np.flatnonzero(near & (sizes == size)))
               for size in np.unique(sizes)]
    for size, points in classes:
        _paint(owner, distance, covered, points, at[points], size * scale)
    material = covered.copy()
    for d, seen in enumerate((covered.T, covered)):
        mirrored = np.pad(seen[border:-border], ((border, border), (0, 0)),
                          mode="symmetric")
        if lower[d] == box[0][d]:
            seen[:border] = mirrored[:border]
        if upper[d] == box[1][d]:
            seen[-border:] = mirrored[-border:]
    for size, points in classes:
        material |= (_closed(covered, GAP / 2 * size * scale) & (owner >= 0) &
                     (sizes[owner] == size))
    return np.where(material, owner, -1)[border:-border, border:-border]


def _reach(size):
    """How far from its point a square and the gap beside it go, in pixels."""
    return int(np.ceil((1 + GAP) / 2 * size)) + 1


def _paint(owner, distance, covered, points, at, size):
    """Squares of one size, and the places around them that they may own."""
    column, row = np.round(at).astype(int).T
    width = owner.shape[1]
    # Of several points in one pixel one is seen.
    pixel, first = np.unique(row * width + column, return_index=True)
    points, (x, y) = points[first], (at - np.round(at))[first].T
    owner, distance, covered = (a.reshape(-1) for a in (owner, distance, covered))
    reach = _reach(size)
    for i in range(-reach, reach + 1):
        for j in range(-reach, reach + 1):
            there = pixel + i * width + j
            away = (j - x)**2 + (i - y)**2
            nearer = away < distance[there]
            distance[there[nearer]] = away[nearer]
            owner[there[nearer]] = points[nearer]
            if max(abs(i), abs(j)) <= size / 2 + 1:
                covered[there[np.maximum(abs(j - x), abs(i - y)) <=
                              size / 2]] = True


def _closed(covered, radius):
    """Without the gaps in which neither a disc nor a square of this radius finds
    room; the square leaves corners of the grid's directions sharp."""
    y, x = np.meshgrid(*(np.minimum(np.arange(n), n - np.arange(n))
                         for n in covered.shape), indexing="ij")
    closed = np.ones_like(covered)
    for away in (np.hypot(y, x), np.maximum(y, x)):
        shape = np.fft.rfft2(away <= radius)

        def grown(seen):
            return np.fft.irfft2(np.fft.rfft2(seen) * shape,
                                 covered.shape) > 0.5
        closed &= ~grown(~grown(covered))
    return closed
