#!/usr/bin/python3
"""Draws the shear stress of a swinging beam, one row for each run.

    plot_beam_shear.py <run folder> [<run folder> ...]

The runs need pictures with the fields 'displacement' and 'stress'; the stress
is that of the points, nothing is averaged here. The picture nearest to the
first largest deflection 'tip' is drawn, at places in the reference state:
the field, and the points of one row above the middle. For each run the script
prints the rms of the shear stress less its mean in the cell, over the whole
beam, as a share of the largest bending stress at the root. The picture goes
into the first folder: shear.png.
"""

import sys
from pathlib import Path

import charts
import fields
import panels
import run_folder
from charts import np, plt
from matplotlib.cm import ScalarMappable


def largest_deflection(source):
    """Number of the picture nearest to the first extreme of the tip."""
    table, _ = run_folder.statistics(source.folder)
    tip = table["tip"]
    crossings = np.flatnonzero(tip[1:-1] * tip[2:] < 0) + 1
    end = crossings[0] if len(crossings) else len(tip)
    return source.nearest(table["time"][np.argmax(abs(tip[:end]))])


def less_cell_means(values, cells):
    _, inverse, number = np.unique(cells, axis=0, return_inverse=True,
                                   return_counts=True)
    inverse = inverse.ravel()
    means = np.bincount(inverse, values) / number
    return values - means[inverse]


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folders = [Path(name) for name in sys.argv[1:]]

    figure, axes = plt.subplots(len(folders), 2, squeeze=False, sharex=True,
                                figsize=(11, 1.4 * len(folders) + 0.7),
                                layout="constrained")
    # At places in the reference state, as shares of the bending stress.
    look = panels.Look("stress xy", enlarge=0, limits=(-12, 12))
    sources = [fields.Source(folder) for folder in folders]
    states = [panels.State(source, largest_deflection(source), look)
              for source in sources]
    look.fix(states)
    for row, state in zip(axes, states):
        parameters = state.source.parameters
        treatment = parameters["Body beam/Locking treatment"]
        lower, upper, cells = (
            run_folder.numbers(parameters["Grid/" + name])[:2]
            for name in ("Lower corner", "Upper corner", "Cells"))
        edge = (upper - lower) / cells

        cloud = state.source.at(state.index)
        shear, bending = cloud["stress"][:, 1], cloud["stress"][:, 0]
        start = state.place[:, :2]
        at_root = start[:, 0] < lower[0] + edge[0]
        root = abs(bending[at_root]).max()
        cell = np.floor((cloud["position"][:, :2] - lower) / edge)
        rms = np.sqrt(np.mean(less_cell_means(shear, cell)**2))
        print(f"{treatment}: rms within cells {rms:.4g} Pa, largest bending "
              f"stress at the root {root:.4g} Pa, ratio {rms / root:.3g}")

        share = state.values = 100 * shear / root
        panels.draw(row[0], state, look)
        row[0].set_title(f"{treatment}, {look.title(state)}", loc="left")
        row[0].set_ylabel("y [m]")

        middle = (start[:, 1].min() + start[:, 1].max()) / 2
        above = start[:, 1][start[:, 1] > middle].min()
        line = np.flatnonzero(abs(start[:, 1] - above) < 1e-4 * edge[1])
        line = line[np.argsort(start[line, 0])]
        row[1].plot(start[line, 0], share[line], ".-", markersize=4,
                    linewidth=0.8, color=charts.style_of(treatment)["color"])
        row[1].set_ylim(-8, 14)
        row[1].set_ylabel("share [%]")
        row[1].grid(alpha=0.3)
    axes[0, 1].set_title("along the row of points above the middle", loc="left")
    for axis in axes[-1]:
        axis.set_xlabel("x [m]")

    figure.colorbar(ScalarMappable(look.norm, look.map), ax=axes[:, 0],
                    extend="both",
                    label="shear stress / bending stress at the root [%]",
                    orientation="horizontal", shrink=0.6, aspect=40)

    path = folders[0] / "shear.png"
    charts.save(figure, path)


if __name__ == "__main__":
    main()
