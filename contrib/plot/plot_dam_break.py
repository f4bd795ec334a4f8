#!/usr/bin/python3
"""Draws the dam break and holds it against the literature.

    plot_dam_break.py <run folder> [<run folder of the locked column>]

The picture goes into the first folder: dam_break.png. Lengths are counted in
widths l0 = 1 m of the column, times as T = t sqrt(2 g / l0).

Martin and Moyce (1952): experiment, n^2 = 2, a = 2.25 in, tables 2 and 6.
Mast et al. (2012): read off the snapshots, to within 0.02.
"""

import sys
from pathlib import Path

import charts
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


def draw_snapshots(axes, folder, parameters, largest_pressure):
    times, files = run_folder.series(folder)
    scaled = scaled_time(times, parameters)
    for axis, wanted in zip(axes, SNAPSHOTS):
        nearest = np.argmin(abs(scaled - wanted))
        cloud = run_folder.points(files[nearest])
        x, y = cloud["position"][:, 0], cloud["position"][:, 1]
        dots = axis.scatter(x, y, c=cloud["pressure"] / 1e3, s=3, linewidths=0,
                            vmin=-largest_pressure / 1e3,
                            vmax=largest_pressure / 1e3, cmap="RdBu_r")
        axis.set_title(f"T = {scaled[nearest]:.2f}, "
                       f"t = {times[nearest]:.2f} s")
        axis.set_aspect("equal")
        axis.set_xlim(0, 4.5)
        axis.set_ylim(0, 2.1)
        axis.set_xlabel("x [m]")
    return dots


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
    folders = {"Limber": Path(sys.argv[1])}
    if len(sys.argv) == 3:
        folders["Limber, locked"] = Path(sys.argv[2])

    rows = len(folders)
    figure = plt.figure(figsize=(12, 1.9 * rows + 3.6), layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=[1.9 * rows, 3.6])
    grid = above.subplots(rows, len(SNAPSHOTS), squeeze=False)
    for axes, (name, folder) in zip(grid, folders.items()):
        parameters = run_folder.parameters(folder)
        gravity = -run_folder.numbers(parameters["Loads/Gravity"])[1]
        # The colours end at the weight of the column upon the floor.
        dots = draw_snapshots(axes, folder, parameters, 1000 * gravity * HEIGHT)
        axes[0].set_ylabel(f"{name}\ny [m]")
    above.colorbar(dots, ax=grid, label="pressure [kPa]", extend="both")

    left, right = below.subplots(1, 2)
    draw_curve(left, folders, "front", WIDTH, MARTIN_MOYCE_FRONT, MAST_FRONT,
               "front $x/l_0$")
    draw_curve(right, folders, "height", HEIGHT, MARTIN_MOYCE_HEIGHT,
               MAST_HEIGHT, "height at the wall $y/h_0$")

    charts.legend_outside(right)

    path = folders["Limber"] / "dam_break.png"
    charts.save(figure, path)


if __name__ == "__main__":
    main()
