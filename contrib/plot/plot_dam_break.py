#!/usr/bin/python3
"""Draws the dam break and holds it against the literature.

    plot_dam_break.py <run folder> [<run folder of the locked column>]

The picture goes into the first folder: dam_break.png. Lengths are counted in
widths l0 = 1 m of the column, times as T = t sqrt(2 g / l0).

Martin and Moyce (1952): experiment, n^2 = 2, a = 2.25 in, tables 2 and 6.
Mast et al. (2012): read off the snapshots, to within 0.02.
"""

import re
import sys
from pathlib import Path

import charts
import fields
import panels
import run_folder
from charts import np, plt

WIDTH, HEIGHT = 1, 2  # of the column, m
SNAPSHOTS = (1, 2, 3)  # T

MARTIN_MOYCE_FRONT = np.array([
    (0.41, 1.11), (0.84, 1.22), (1.19, 1.44), (1.43, 1.67), (1.63, 1.89),
    (1.83, 2.11), (1.98, 2.33), (2.20, 2.56), (2.32, 2.78), (2.51, 3.00),
    (2.65, 3.22), (2.83, 3.44), (2.98, 3.67), (3.11, 3.89), (3.33, 4.11)]).T

# Tabulated over t sqrt(g / l0), hence the root.
MARTIN_MOYCE_HEIGHT = np.array([
    (0.56, 0.94), (0.77, 0.89), (0.93, 0.83), (1.08, 0.78), (1.28, 0.72),
    (1.46, 0.67), (1.66, 0.61), (1.84, 0.56), (2.00, 0.50), (2.21, 0.44)]).T
MARTIN_MOYCE_HEIGHT[0] *= np.sqrt(2)

MAST_FRONT = np.array([(1, 1.52), (2, 2.55), (3, 4.14)]).T
MAST_HEIGHT = np.array([(1, 0.888), (2, 0.673), (3, 0.458)]).T


def scaled_time(time, parameters):
    gravity = -run_folder.numbers(parameters["Loads/Gravity"])[1]
    return time * np.sqrt(2 * gravity / WIDTH)


def draw_snapshots(figure, folders):
    grid = figure.subplots(len(folders), len(SNAPSHOTS), squeeze=False,
                           sharex=True, sharey=True)
    sources = [fields.Source(folder) for folder in folders.values()]
    # The colours end at the weight of the column upon the floor.
    gravity = -run_folder.numbers(sources[0].parameters["Loads/Gravity"])[1]
    weight = 1000 * gravity * HEIGHT
    look = panels.Look("pressure", limits=(-weight, weight),
                       zoom=(np.zeros(2), np.array([4.5, 2.1])))
    scaled = [scaled_time(source.times, source.parameters) for source in sources]
    states = [[panels.State(source, np.argmin(abs(times - wanted)), look)
               for wanted in SNAPSHOTS] for source, times in zip(sources, scaled)]
    look.fix([state for row in states for state in row])
    for axes, row, name in zip(grid, states, folders):
        for axis, state in zip(axes, row):
            panels.draw(axis, state, look)
            time = scaled_time(state.time, state.source.parameters)
            axis.set_title(f"T = {time:.2f}, t = {state.time:.2f} s")
        axes[0].set_ylabel(f"{name}\ny [m]")
    for axis in grid[-1]:
        axis.set_xlabel("x [m]")
    look.bar(figure, grid)


def name_of(folder):
    """Treatment and kind of steps, 'cell, semi-implicit'."""
    parameters = run_folder.parameters(folder)
    steps = parameters["Method/Time integration"]
    if steps == "auto":
        chosen = re.search("Time integration 'auto' is '(.*?)'",
                           (folder / "log.txt").read_text())
        steps = chosen[1]
    return f"{parameters['Body water/Locking treatment']}, {steps}"


def draw_curve(axis, folders, column, scale, experiment, mast, label):
    for name, folder in folders.items():
        parameters = run_folder.parameters(folder)
        table, _ = run_folder.statistics(folder)
        treatment = parameters["Body water/Locking treatment"]
        axis.plot(scaled_time(table["time"], parameters), table[column] / scale,
                  label=name, **charts.line_of(treatment))
    axis.plot(*experiment, "k^", markersize=4, label="Martin and Moyce (1952)")
    axis.plot(*mast, "kx", label="Mast et al. (2012)")
    axis.set_xlabel(r"$T = t\sqrt{2g/l_0}$")
    axis.set_ylabel(label)
    axis.set_xlim(0, 3.2)
    axis.grid(alpha=0.3)


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folders = {name_of(Path(name)): Path(name) for name in sys.argv[1:]}

    rows = len(folders)
    figure = plt.figure(figsize=(12, 1.9 * rows + 3.6), layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=[1.9 * rows, 3.6])
    draw_snapshots(above, folders)

    left, right = below.subplots(1, 2)
    draw_curve(left, folders, "front", WIDTH, MARTIN_MOYCE_FRONT, MAST_FRONT,
               "front $x/l_0$")
    draw_curve(right, folders, "height", HEIGHT, MARTIN_MOYCE_HEIGHT,
               MAST_HEIGHT, "height at the wall $y/h_0$")

    charts.legend_outside(right)

    path = Path(sys.argv[1]) / "dam_break.png"
    charts.save(figure, path)


if __name__ == "__main__":
    main()
