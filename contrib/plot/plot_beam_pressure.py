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
import run_folder
from charts import np, plt

LARGEST = 3  # MPa, end of the colours


def rms(values):
    return np.sqrt(np.mean(values**2))


def block_means(values, blocks):
    _, inverse, number = np.unique(blocks, axis=0, return_inverse=True,
                                   return_counts=True)
    inverse = inverse.ravel()
    return (np.bincount(inverse, values) / number)[inverse]


def read_reference(folder, wanted):
    """Title, places, pressure in MPa, size of the dots."""
    _, fields = run_folder.nodes(folder, wanted)
    return ("finite elements", fields["position"], fields["pressure"] / 1e6, 30)


def read_run(folder, wanted):
    parameters = run_folder.parameters(folder)
    treatment = parameters["Body beam/Locking treatment"]
    lower, upper, cells = (
        run_folder.numbers(parameters["Grid/" + name])[:2]
        for name in ("Lower corner", "Upper corner", "Cells"))
    times, files = run_folder.series(folder)
    nearest = np.argmin(abs(times - wanted))
    cloud = run_folder.points(files[nearest])
    place, pressure = cloud["position"][:, :2], cloud["pressure"] / 1e6

    blocks = np.floor((place - lower) / (2 * (upper - lower) / cells))
    print(f"{treatment}: t = {times[nearest]:.3g} s, rms of the pressure "
          f"{rms(pressure):.3g} MPa, of its means over 2 x 2 cells "
          f"{rms(block_means(pressure, blocks)):.3g} MPa")
    return treatment, place, pressure, 2


def main():
    if len(sys.argv) < 3 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    wanted = float(sys.argv[1])
    folders = [Path(name) for name in sys.argv[2:]]

    figure, axes = plt.subplots(1, len(folders), squeeze=False, sharey=True,
                                figsize=(3.4 * len(folders) + 1, 4),
                                layout="constrained")
    for axis, folder in zip(axes[0], folders):
        read = read_reference if run_folder.is_reference(folder) else read_run
        title, place, pressure, size = read(folder, wanted)
        dots = axis.scatter(place[:, 0], place[:, 1], c=pressure, s=size,
                            linewidths=0, vmin=-LARGEST, vmax=LARGEST,
                            cmap="RdBu_r")
        axis.set_title(title)
        axis.set_aspect("equal")
        axis.set_xlabel("x [m]")
    axes[0, 0].set_ylabel("y [m]")
    figure.colorbar(dots, ax=axes, label="pressure [MPa]", extend="both")

    path = folders[-1] / "pressure.png"
    charts.save(figure, path)


if __name__ == "__main__":
    main()
