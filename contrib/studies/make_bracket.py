#!/usr/bin/python3
"""Writes prm/data/bracket.stl: a bracket on two feet, in millimetres.

    make_bracket.py [FILE]

A profile of twelve corners, symmetric about x = 0, with its feet at y = 0,
drawn out by 20 mm along z, symmetric about z = 0; binary STL, normals outward.
"""

import struct
import sys
from pathlib import Path

# One half, from the inner edge of a foot to the top, anticlockwise around it
RIGHT = [(8, 6), (10, 0), (20, 0), (20, 10), (5, 14), (5, 40)]
DEPTH = 20


def cross(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def triangles_of(loop):
    """Cut ears off a polygon that is given anticlockwise."""
    rest, result = list(loop), []
    while len(rest) > 3:
        for k in range(len(rest)):
            a, b, c = rest[k - 1], rest[k], rest[(k + 1) % len(rest)]
            others = [p for p in rest if p not in (a, b, c)]
            if cross(a, b, c) > 0 and not any(
                    cross(a, b, p) >= 0 and cross(b, c, p) >= 0
                    and cross(c, a, p) >= 0 for p in others):
                result.append((a, b, c))
                del rest[k]
                break
    return [*result, tuple(rest)]


def facets():
    loop = RIGHT + [(-x, y) for x, y in reversed(RIGHT)]
    low, high = -DEPTH / 2, DEPTH / 2
    for a, b, c in triangles_of(loop):
        yield [(*a, high), (*b, high), (*c, high)]
        yield [(*a, low), (*c, low), (*b, low)]
    for a, b in zip(loop, loop[1:] + loop[:1]):
        yield [(*a, low), (*b, low), (*b, high)]
        yield [(*a, low), (*b, high), (*a, high)]


def main():
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else (
        Path(__file__).resolve().parents[2] / "prm/data/bracket.stl")
    found = list(facets())
    with target.open("wb") as file:
        file.write(b"bracket on two feet, mm".ljust(80) +
                   struct.pack("<I", len(found)))
        for corners in found:
            u, v = ([q - p for p, q in zip(corners[0], corner)]
                    for corner in corners[1:])
            n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                 u[0] * v[1] - u[1] * v[0]]
            length = sum(x * x for x in n) ** 0.5
            file.write(struct.pack("<12fH", *(x / length for x in n),
                                   *(x for corner in corners for x in corner),
                                   0))


if __name__ == "__main__":
    main()
