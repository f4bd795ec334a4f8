#!/usr/bin/python3
"""Draws the dam break in three dimensions beside the one in two.

    plot_dam_break_3d.py <run folder> <run folder in two dimensions>

The first run needs pictures with the field 'velocity'. Prints front and height
of both at T = t sqrt(2 g / 1 m) = 1, 2, 3. The picture goes into the first
folder: dam_break_3d.png.
"""

import sys
from pathlib import Path

import charts
import fields
import panels
import run_folder
from charts import np, plt

SCALE = np.sqrt(2 * 9.81)  # of time
SNAPSHOTS = (1, 2, 3)  # T
COLOURS = {"front": "#0072B2", "height": "#D55E00"}


def main():
    if len(sys.argv) != 3 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folders = {"3D": Path(sys.argv[1]), "2D": Path(sys.argv[2])}

    figure = plt.figure(figsize=(13, 7.2), layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=[3.6, 3])
    axes = above.subplots(1, len(SNAPSHOTS))
    source = fields.Source(folders["3D"])
    look = panels.Look("speed", view=(38., 22.))
    states = [panels.State(source, source.nearest(wanted / SCALE), look)
              for wanted in SNAPSHOTS]
    look.fix(states)
    for axis, state in zip(axes, states):
        panels.draw(axis, state, look)
        axis.set_title(f"T = {state.time * SCALE:.2f}, t = {state.time:.2f} s")
    look.bar(above, axes)

    axis = below.subplots()
    for (name, folder), line in zip(folders.items(), ("-", "--")):
        table, _ = run_folder.statistics(folder)
        scaled = table["time"] * SCALE
        for column in ("front", "height"):
            label = f"{column}, 3D" if line == "-" else {
                "front": "both in 2D"}.get(column)  # one entry for both
            axis.plot(scaled, table[column], line, label=label,
                      color=COLOURS[column] if line == "-" else "black",
                      linewidth=3 if line == "-" else 1)
            values = np.interp((1, 2, 3), scaled, table[column])
            print(name, column, "at T = 1, 2, 3:",
                  *(f"{value:.3f}" for value in values), "m")
    axis.set_xlabel(r"$T = t\sqrt{2g/l_0}$")
    axis.set_ylabel("front, height [m]")
    axis.grid(alpha=0.3)
    charts.legend_outside(axis)

    path = folders["3D"] / "dam_break_3d.png"
    charts.save(figure, path)


if __name__ == "__main__":
    main()
