#!/usr/bin/env python3
"""Checks that the rooms of the house keep to their floors.

    check_floors.py [project folder]
    check_floors.py --self-test

Rooms are the folders of include/limber and source. A file may include files
of its own room and of rooms on lower floors: never of a higher floor, never
of another room on its own. No headers include each other in a circle. And
nothing the kernels are compiled from leads to a header of deal.II.
"""

import re
import sys
import tempfile
from pathlib import Path

FLOORS = [
    ["base"],
    ["materials"],
    ["problem"],
    ["grid", "fem"],
    ["points"],
    ["interpolation"],
    ["transfer"],
    ["stress"],
    ["state"],
    ["time", "output", "adaptation"],
    ["simulation"],
    ["study"],
]
FLOOR_OF = {room: floor for floor, rooms in enumerate(FLOORS) for room in rooms}

# Compiled into the kernels, by room and by single header.
KERNEL_ROOMS = {"materials", "interpolation", "transfer", "stress"}
KERNEL_HEADERS = {
    "points/point_view.h",
    "points/cell_batch.h",
    "grid/grid_view.h",
}

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)


def room_of(name):
    """'grid/cells.h' is in room 'grid'; 'main.cc' is in none."""
    return name.split("/")[0] if "/" in name else None


def read_tree(root):
    """Returns {name: [included names]}; a name begins with its room."""
    files = {}
    for folder in (root / "include" / "limber", root / "source"):
        for path in sorted(folder.rglob("*")):
            if path.suffix in (".h", ".cc"):
                name = path.relative_to(folder).as_posix()
                files[name] = INCLUDE.findall(path.read_text())
    return files


def ours(includes):
    return [i[len("limber/"):] for i in includes if i.startswith("limber/")]


def floor_offences(files):
    for name, includes in files.items():
        room = room_of(name)
        if room is None:
            continue  # main.cc stands on the roof and sees everything
        if room not in FLOOR_OF:
            yield f"{name}: the room '{room}' is on no floor of {Path(__file__).name}"
            continue
        for other in ours(includes):
            target = room_of(other)
            if target == room:
                continue
            if target not in FLOOR_OF:
                yield f"{name} includes {other}, which is in no known room"
            elif FLOOR_OF[target] > FLOOR_OF[room]:
                yield (f"{name} (floor {FLOOR_OF[room]}) includes {other} "
                       f"(floor {FLOOR_OF[target]}): upwards")
            elif FLOOR_OF[target] == FLOOR_OF[room]:
                yield (f"{name} includes {other}: a neighbour on floor "
                       f"{FLOOR_OF[room]}")


def cycle_offences(files):
    """Depth-first search; a header met again on its own path is a circle."""
    finished = set()

    def visit(name, path):
        if name in path:
            yield "a circle: " + " -> ".join(path[path.index(name):] + [name])
        elif name not in finished and name in files:
            for other in ours(files[name]):
                yield from visit(other, path + [name])
            finished.add(name)

    for name in files:
        yield from visit(name, [])


def way_to_deal_ii(files, start):
    """The shortest chain of includes from a file to deal.II, or nothing."""
    ways = [[start]]
    seen = {start}
    for way in ways:
        for header in files.get(way[-1], []):
            if header.startswith("deal.II/"):
                return way + [header]
        for other in ours(files.get(way[-1], [])):
            if other not in seen:
                seen.add(other)
                ways.append(way + [other])
    return None


def deal_ii_offences(files):
    for name in files:
        if room_of(name) in KERNEL_ROOMS or name in KERNEL_HEADERS:
            way = way_to_deal_ii(files, name)
            if way:
                yield "a kernel file reaches deal.II: " + " -> ".join(way)


def offences(root):
    files = read_tree(root)
    return [*floor_offences(files), *cycle_offences(files),
            *deal_ii_offences(files)]


def self_test():
    """Every rule must accept its good case and catch its bad one."""
    cases = [
        ("downwards", {"grid/a.h": "limber/base/b.h", "base/b.h": "vector"}, None),
        ("own room", {"grid/a.h": "limber/grid/b.h", "grid/b.h": "vector"}, None),
        ("main", {"main.cc": "limber/study/a.h", "study/a.h": "vector"}, None),
        ("host", {"points/material_points.h": "deal.II/base/point.h"}, None),
        ("upwards", {"grid/a.h": "limber/points/b.h"}, "upwards"),
        ("neighbour", {"grid/a.h": "limber/fem/b.h"}, "neighbour"),
        ("room", {"attic/a.h": "vector"}, "no floor"),
        ("circle", {"grid/a.h": "limber/grid/b.h",
                    "grid/b.h": "limber/grid/a.h"}, "circle"),
        ("deal.II", {"stress/a.h": "deal.II/base/point.h"}, "reaches deal.II"),
        ("by a header", {"grid/grid_view.h": "limber/base/b.h",
                         "base/b.h": "deal.II/base/point.h"}, "reaches deal.II"),
    ]
    for title, tree, expected in cases:
        with tempfile.TemporaryDirectory() as folder:
            for name, header in tree.items():
                place = "include/limber" if name.endswith(".h") else "source"
                path = Path(folder) / place / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(f"  #  include <{header}>\n")
            found = offences(Path(folder))
        good = not found if expected is None else (
            len(found) == 1 and expected in found[0])
        if not good:
            sys.exit(f"self-test '{title}' expected {expected}, found {found}")
    print(f"{len(cases)} cases as expected")


def main():
    if sys.argv[1:] == ["--self-test"]:
        self_test()
        return
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[2]
    if not (root / "include" / "limber").is_dir():
        sys.exit(f"check_floors: {root} holds no include/limber")
    found = offences(root)
    for offence in found:
        print(offence)
    sys.exit(f"{len(found)} offences" if found else 0)


if __name__ == "__main__":
    main()
