#!/usr/bin/python3
"""Draws the standing wave in a tank and holds it against linear theory.

    plot_sloshing.py <run folder> [<run folder> ...]

The runs need pictures with the field 'pressure'; those of the first run are
drawn. Below, the centre of mass of each run and a cosine of the frequency
w^2 = g k tanh(k H), k = pi / L. For each run the script prints the frequency,
its error and the last swing as a share of the start. The picture goes into
the first folder: sloshing.png.
"""

import sys
from pathlib import Path

import charts
import fields
import panels
import run_folder
from charts import np, plt

GRAVITY, LENGTH, DEPTH = 9.81, 1, 0.5
PERIODS = (0, 0.5, 2, 2.5)  # of the pictures


def name_of(parameters):
    treatment = parameters["Body water/Locking treatment"]
    name = treatment
    if treatment != "none":
        name += ", " + parameters["Body water/History"]
    if parameters["Body water/Hourglass control"] == "0":
        name += ", no hourglass control"
    return name


def style_name(parameters):
    """What the palette calls this method."""
    treatment = parameters["Body water/Locking treatment"]
    if parameters["Body water/Hourglass control"] == "0":
        return treatment + " without control"
    if parameters["Body water/History"] == "replace":
        return treatment + " replaced"
    return treatment


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folders = [Path(name) for name in sys.argv[1:]]
    k = np.pi / LENGTH
    angular = np.sqrt(GRAVITY * k * np.tanh(k * DEPTH))
    period = 2 * np.pi / angular

    figure = plt.figure(figsize=(11, 5), layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=[4, 5])
    axes = above.subplots(1, len(PERIODS), sharey=True)
    source = fields.Source(folders[0])
    look = panels.Look("pressure", limits=(0, 5000),
                       zoom=(np.array([-LENGTH / 2, 0]),
                                              np.array([LENGTH / 2, 0.56])))
    states = [panels.State(source, source.nearest(periods * period), look)
              for periods in PERIODS]
    look.fix(states)
    for axis, state in zip(axes, states):
        panels.draw(axis, state, look)
        axis.set_title(look.title(state))
        axis.set_xlabel("x [m]")
        axis.set_xticks([-0.4, 0, 0.4])
    axes[0].set_ylabel("y [m]")
    look.bar(above, axes)

    axis = below.subplots()
    for folder in folders:
        name = name_of(run_folder.parameters(folder))
        table, _ = run_folder.statistics(folder)
        centre = table["centre"]
        start = abs(centre[0])
        style = charts.line_of(style_name(run_folder.parameters(folder)))
        axis.plot(table["time"], centre / start, label=name, **style)
        frequency = table["frequency"][-1]
        crossings = np.flatnonzero(centre[:-1] * centre[1:] < 0)
        swing = abs(centre[crossings[-1]:]).max() / start
        print(f"{name}: {frequency:.4f} Hz, "
              f"{100 * (frequency * period - 1):+.1f} %, last swing {swing:.2f}"
              f", largest kinetic energy {table['kinetic energy'].max():.3g} J")
    axis.plot(table["time"], -np.cos(angular * table["time"]), "k--",
              linewidth=1, label="linear theory")
    axis.set_xlabel("time [s]")
    axis.set_ylabel("x of the centre of mass / its start")
    axis.grid(alpha=0.3)
    charts.legend_outside(axis)

    path = folders[0] / "sloshing.png"
    charts.save(figure, path)


if __name__ == "__main__":
    main()
