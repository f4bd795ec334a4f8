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
import fields
import panels
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


def look_at(source, index):
    """Colours and enlargement that suit this picture."""
    cloud = source.at(index)
    length = np.ptp(cloud["position"][:, 0])
    pressure = abs(cloud["pressure"]).max()
    return panels.Look(
        "pressure", limits=(-pressure, pressure),
        enlarge=round(LARGEST_DRAWN * length / abs(cloud["displacement"]).max()))


def main():
    if len(sys.argv) != 4 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folders = {"cell": Path(sys.argv[1]), "none": Path(sys.argv[2])}
    observable = sys.argv[3]
    extreme = largest_deflection(folders["cell"], observable)
    sources = [fields.Source(folder) for folder in folders.values()]
    look = look_at(sources[0], sources[0].nearest(extreme))
    states = [panels.State(source, source.nearest(extreme), look)
              for source in sources]
    look.fix(states)

    figure = plt.figure(figsize=(10, 5), layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=[3, 4])
    axes = above.subplots(1, 2, sharey=True)
    for axis, name, state in zip(axes, folders, states):
        panels.draw(axis, state, look)
        axis.set_title(f"{name}, {look.title(state)}")
        axis.set_xlabel("x [m]")
    axes[0].set_ylabel("y [m]")
    look.bar(above, axes)

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
