#!/usr/bin/python3
"""Draws the dam break in three dimensions beside the one in two.

    plot_dam_break_3d.py <run folder> <run folder in two dimensions>

The first run needs pictures with the field 'velocity'. Prints front and height
of both at T = t sqrt(2 g / 1 m) = 1, 2, 3. The picture goes into the first
folder: dam_break_3d.png; the front wall is nearest to the eye.
"""

import sys
from pathlib import Path

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import run_folder

SCALE = np.sqrt(2 * 9.81)  # of time
SNAPSHOTS = (1, 3)  # T


def main():
    if len(sys.argv) != 3 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folders = {"3D": Path(sys.argv[1]), "2D": Path(sys.argv[2])}

    figure, axes = plt.subplots(1, 3, figsize=(12, 3.2), layout="constrained",
                                width_ratios=[1.5, 4.5, 3])
    times, files = run_folder.series(folders["3D"])
    for axis, wanted in zip(axes, SNAPSHOTS):
        nearest = np.argmin(abs(times * SCALE - wanted))
        cloud = run_folder.points(files[nearest])
        back_first = np.argsort(cloud["position"][:, 2])
        x, y, z = cloud["position"][back_first].T
        dots = axis.scatter(x - 0.6 * z, y - 0.4 * z, s=2, linewidths=0,
                            c=run_folder.magnitude(cloud["velocity"])[back_first],
                            vmin=0, vmax=8)
        axis.set_title(f"T = {times[nearest] * SCALE:.2f}")
        axis.set_aspect("equal")
        axis.set_ylim(-0.25, 2.1)
        axis.set_axis_off()
    figure.colorbar(dots, ax=axes[1], label="speed [m/s]", shrink=0.7)

    axis = axes[2]
    for (name, folder), line in zip(folders.items(), ("-", "k--")):
        table, _ = run_folder.statistics(folder)
        scaled = table["time"] * SCALE
        for column in ("front", "height"):
            axis.plot(scaled, table[column], line, label=f"{column}, {name}")
            values = np.interp((1, 2, 3), scaled, table[column])
            print(name, column, "at T = 1, 2, 3:",
                  *(f"{value:.3f}" for value in values), "m")
    axis.set_xlabel(r"$T = t\sqrt{2g/l_0}$")
    axis.set_ylabel("[m]")
    axis.grid(alpha=0.3)
    axis.legend(fontsize=8)

    path = folders["3D"] / "dam_break_3d.png"
    figure.savefig(path, dpi=80)
    print(path)


if __name__ == "__main__":
    main()
