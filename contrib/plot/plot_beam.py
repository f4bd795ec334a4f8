#!/usr/bin/python3
"""Draws a swinging beam beside the same beam without a treatment of locking.

    plot_beam.py <run folder> <run folder of the locked beam> <observable>

The observable is a displacement of the end, 'tip' for instance. The runs need pictures
with the fields 'displacement' and 'pressure'. Above: both beams at the time of
the first one's first largest deflection, displacements enlarged. Below: the observable over
time. The picture goes into the first folder: beam.png.
"""

import sys
from pathlib import Path

import charts
import run_folder
from charts import np, plt

LARGEST_DRAWN = 0.12  # displacement as a share of the length


def largest_deflection(folder, observable):
    """Time of the first extreme of the observable."""
    table, _ = run_folder.statistics(folder)
    value = table[observable]
    crossings = np.flatnonzero(value[1:-1] * value[2:] < 0) + 1
    end = crossings[0] if len(crossings) else len(value)
    return table["time"][np.argmax(abs(value[:end]))]


def state_at(folder, wanted):
    """Time and points of the picture nearest to a time."""
    times, files = run_folder.series(folder)
    nearest = np.argmin(abs(times - wanted))
    return times[nearest], run_folder.points(files[nearest])


def draw_beam(axis, name, time, cloud, factor, largest_pressure):
    place = (cloud["position"][:, :2] +
             (factor - 1) * cloud["displacement"][:, :2])
    dots = axis.scatter(place[:, 0], place[:, 1], c=cloud["pressure"], s=20,
                        linewidths=0, vmin=-largest_pressure,
                        vmax=largest_pressure, cmap="RdBu_r")
    axis.set_xlabel("x [m]")
    axis.set_title(f"{name}, t = {time:.3g} s, displacements x {factor:.0f}",
                   fontsize=10)
    axis.set_aspect("equal")
    return dots


def main():
    if len(sys.argv) != 4 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folders = {"cell": Path(sys.argv[1]), "none": Path(sys.argv[2])}
    observable = sys.argv[3]
    extreme = largest_deflection(folders["cell"], observable)
    states = {name: state_at(folder, extreme)
              for name, folder in folders.items()}

    largest = abs(states["cell"][1]["pressure"]).max()
    unit_factor, unit = charts.scaled_unit("Pa", largest)
    for _, cloud in states.values():
        cloud["pressure"] = cloud["pressure"] / unit_factor
    treated = states["cell"][1]
    length = np.ptp(treated["position"][:, 0])
    factor = LARGEST_DRAWN * length / abs(treated["displacement"]).max()
    pressure = abs(treated["pressure"]).max()

    figure = plt.figure(figsize=(10, 5), layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=[3, 4])
    axes = above.subplots(1, 2, sharey=True)
    for axis, (name, (time, cloud)) in zip(axes, states.items()):
        dots = draw_beam(axis, f"Locking treatment = {name}", time, cloud,
                         factor, pressure)
    axes[0].set_ylabel("y [m]")
    above.colorbar(dots, ax=axes, label=f"pressure [{unit}]", extend="both")

    axis = below.subplots()
    for name, folder in folders.items():
        table, units = run_folder.statistics(folder)
        axis.plot(table["time"], table[observable], label=name,
                  **charts.line_of(name))
    axis.set_xlabel("time [s]")
    axis.set_ylabel(f"displacement of the {observable} [{units[observable]}]")
    axis.grid(alpha=0.3)
    charts.legend_outside(axis)

    path = folders["cell"] / "beam.png"
    charts.save(figure, path)


if __name__ == "__main__":
    main()
