#!/usr/bin/python3
"""Draws the pressure of Cook's membrane at the end, the runs side by side.

    plot_cook.py <run folder> [<run folder> ...]

The runs need pictures with the fields 'displacement' and 'pressure'. The
displacements are drawn twenty times as large as they are; the colours end at
what 98 % of the points of the last run stay within. For each run the script
prints the rms of the pressure and the rms of what neighbouring cells differ by.
The picture goes into the last folder: pressure.png.
"""

import sys
from pathlib import Path

import charts
import fields
import panels
import run_folder
from charts import np, plt

ENLARGED = 20


def cell_means(place, values, edge):
    """The means over cells, as an array with NaN where there is no point."""
    index = np.floor(place / edge).astype(int)
    index -= index.min(axis=0)
    total, count = (np.zeros(index.max(axis=0) + 1) for _ in range(2))
    np.add.at(total, tuple(index.T), values)
    np.add.at(count, tuple(index.T), 1)
    with np.errstate(invalid="ignore"):
        return total / np.where(count > 0, count, np.nan)


def rms_of_jumps(means):
    jumps = np.concatenate([np.diff(means, axis=d).ravel() for d in (0, 1)])
    return np.sqrt(np.nanmean(jumps**2))


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folders = [Path(name) for name in sys.argv[1:]]
    sources = [fields.Source(folder) for folder in folders]
    clouds = [source.at(-1) for source in sources]
    largest = np.quantile(abs(clouds[-1]["pressure"]), 0.98)
    look = panels.Look("pressure", enlarge=ENLARGED, limits=(-largest, largest),
                       zoom=(np.array([-2, -2]), np.array([50, 68])))
    states = [panels.State(source, len(source.times) - 1, look)
              for source in sources]
    look.fix(states)

    figure, axes = plt.subplots(1, len(folders), squeeze=False, sharey=True,
                                figsize=(3.4 * len(folders) + 1, 4.4),
                                layout="constrained")
    for axis, state, cloud in zip(axes[0], states, clouds):
        parameters = state.source.parameters
        treatment = parameters["Body panel/Locking treatment"]
        lower, upper, cells = (
            run_folder.numbers(parameters["Grid/" + name])[:2]
            for name in ("Lower corner", "Upper corner", "Cells"))
        pressure = cloud["pressure"]
        means = cell_means(cloud["position"][:, :2], pressure,
                           (upper - lower) / cells)
        print(f"{treatment}: rms of the pressure "
              f"{np.sqrt(np.mean(pressure**2)):.3g} Pa, of jumps between "
              f"cells {rms_of_jumps(means):.3g} Pa")

        panels.draw(axis, state, look)
        axis.plot([0, 48, 48, 0, 0], [0, 44, 60, 44, 0], color="0.6", lw=0.6)
        axis.set_title(f"{treatment}, displacements × {ENLARGED}")
        axis.set_xlabel("x [m]")
    axes[0, 0].set_ylabel("y [m]")
    look.bar(figure, axes)

    path = folders[-1] / "pressure.png"
    charts.save(figure, path)


if __name__ == "__main__":
    main()
