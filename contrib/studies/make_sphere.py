#!/usr/bin/python3
"""Writes an STL file of a sphere: an icosahedron whose facets are divided by four.

    make_sphere.py FILE [DIVISIONS]

Radius 1, centre at the origin; binary STL, normals outward. Three divisions, the
default, are 1280 facets.
"""

import itertools
import struct
import sys
from pathlib import Path


def unit(v):
    length = sum(x * x for x in v)**0.5
    return tuple(x / length for x in v)


def cross(a, b):
    return tuple(a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3))


def facets(divisions):
    g = (1 + 5**0.5) / 2
    corners = [unit(p) for a, b in itertools.product((-1, 1), (-g, g))
               for p in ((0, a, b), (b, 0, a), (a, b, 0))]
    edge = min(sum((x - y)**2 for x, y in zip(a, b))
               for a, b in itertools.combinations(corners, 2))
    near = 1.01 * edge
    result = []
    for a, b, c in itertools.combinations(corners, 3):
        if all(sum((x - y)**2 for x, y in zip(p, q)) < near
               for p, q in ((a, b), (b, c), (c, a))):
            outward = sum(x * y for x, y in zip(a, cross(b, c))) > 0
            result.append((a, b, c) if outward else (a, c, b))
    for _ in range(divisions):
        finer = []
        for a, b, c in result:
            ab, bc, ca = (unit([x + y for x, y in zip(p, q)])
                          for p, q in ((a, b), (b, c), (c, a)))
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        result = finer
    return result


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    surface = facets(int(sys.argv[2]) if len(sys.argv) > 2 else 3)
    data = struct.pack("<80xI", len(surface))
    for a, b, c in surface:
        normal = unit([sum(p) for p in zip(a, b, c)])
        data += struct.pack("<12fH", *normal, *a, *b, *c, 0)
    Path(sys.argv[1]).write_bytes(data)


if __name__ == "__main__":
    main()
