#!/usr/bin/python3
"""How evenly the points of a liquid fill the grid, in the pictures of a run.

    density_excess.py FOLDER ...

For each picture: the mean filling of cells that have liquid or a side all around,
the share of the mass in nodes that hold more than 1.05 of their room, and the
fullest node. Two dimensions, cells of one size, one liquid whose volume ratios are
close to one; the run needs 'Output/Time interval'.
"""

import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "contrib/plot"))
from charts import np  # noqa: E402
import run_folder  # noqa: E402


def fillings(position, volume, lower, upper, cells):
    """Of the inner cells, and of all nodes with their volumes."""
    edge = (upper - lower) / cells
    x = (position - lower) / edge
    index = np.clip(np.floor(x).astype(int), 0, cells - 1)
    x -= index
    count = np.zeros(cells)
    np.add.at(count, tuple(index.T), 1)
    occupied = np.pad(count > 0, 1, constant_values=True)
    inside = np.ones(cells, bool)
    held, room = np.zeros(cells + 1), np.zeros(cells + 1)
    for a in range(3):
        for b in range(3):
            inside &= occupied[a:a + cells[0], b:b + cells[1]]
    for a in range(2):
        for b in range(2):
            weight = np.abs(1 - a - x[:, 0]) * np.abs(1 - b - x[:, 1])
            np.add.at(held, (index[:, 0] + a, index[:, 1] + b), weight * volume)
            room[a:a + cells[0], b:b + cells[1]] += edge.prod() / 4
    return count[inside] * volume / edge.prod(), held / room, held


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for folder in sys.argv[1:]:
        entries = run_folder.parameters(folder)
        lower, upper, cells = (run_folder.numbers(entries["Grid/" + name])
                               for name in ("Lower corner", "Upper corner",
                                            "Cells"))
        _, files = run_folder.series(folder)
        first = run_folder.points(files[0])
        box = [name for name in entries if name.endswith("Box/Upper corner")][0]
        volume = np.prod(run_folder.numbers(entries[box]) - run_folder.numbers(
            entries[box.replace("Upper", "Lower")])) / len(first["position"])
        for path in files:
            position = run_folder.points(path)["position"][:, :2]
            inner, nodes, held = fillings(position, volume, lower[:2],
                                          upper[:2], cells[:2].astype(int))
            dense = held[nodes > 1.05].sum() / held.sum()
            print(f"{path}: inner cells {inner.mean():.4f}, mass in nodes "
                  f"above 1.05 {100 * dense:.1f} %, fullest {nodes.max():.3f}")


if __name__ == "__main__":
    main()
