#!/usr/bin/python3
"""Draws the pressure of a bent beam, the runs side by side at the same time.

    plot_beam_pressure.py <time> <folder> [<folder> ...]

Runs need pictures with the field 'pressure'. For each the script prints the rms
over the points of their pressure and of its mean over the block of 2 x 2 cells
that they are in. Folders of 'limber reference' are drawn as well. The picture
goes into the last folder: pressure.png.
"""

import sys
from pathlib import Path

import charts
import fields
import panels
import run_folder
from charts import np, plt

LARGEST = 3e6  # Pa, end of the colours


def rms(values):
    return np.sqrt(np.mean(values**2))


def block_means(values, blocks):
    _, inverse, number = np.unique(blocks, axis=0, return_inverse=True,
                                   return_counts=True)
    inverse = inverse.ravel()
    return (np.bincount(inverse, values) / number)[inverse]


def report(state, treatment):
    lower, upper, cells = (
        run_folder.numbers(state.source.parameters["Grid/" + name])[:2]
        for name in ("Lower corner", "Upper corner", "Cells"))
    pressure = state.values / 1e6
    blocks = np.floor((state.place[:, :2] - lower) /
                      (2 * (upper - lower) / cells))
    print(f"{treatment}: t = {state.time:.3g} s, rms of the pressure "
          f"{rms(pressure):.3g} MPa, of its means over 2 x 2 cells "
          f"{rms(block_means(pressure, blocks)):.3g} MPa")


def main():
    if len(sys.argv) < 3 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    wanted = float(sys.argv[1])
    folders = [Path(name) for name in sys.argv[2:]]

    figure, axes = plt.subplots(1, len(folders), squeeze=False, sharey=True,
                                figsize=(3.4 * len(folders) + 1, 4),
                                layout="constrained")
    look = panels.Look("pressure", limits=(-LARGEST, LARGEST))
    sources = [fields.Source(folder) for folder in folders]
    states = [panels.State(source, source.nearest(wanted), look)
              for source in sources]
    look.fix(states)
    for axis, state in zip(axes[0], states):
        panels.draw(axis, state, look)
        name = "finite elements"
        if not state.source.is_reference:
            name = state.source.parameters["Body beam/Locking treatment"]
            report(state, name)
        axis.set_title(f"{name}, {look.title(state)}")
        axis.set_xlabel("x [m]")
    axes[0, 0].set_ylabel("y [m]")
    look.bar(figure, axes)

    path = folders[-1] / "pressure.png"
    charts.save(figure, path)


if __name__ == "__main__":
    main()
