#!/usr/bin/python3
"""Draws a run: snapshots of its points, energies and probes over time.

    plot_run.py <run folder> [--field pressure|velocity] [--snapshots 4]

The pictures go into the run folder: snapshots.png, energies.png, probes.png.
Three-dimensional points are seen from the front.
"""

import argparse
from pathlib import Path

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import MaxNLocator

import run_folder

LABELS = {"pressure": "pressure [Pa]", "velocity": "speed [m/s]"}


def draw_snapshots(folder, parameters, field, number):
    times, files = run_folder.series(folder)
    if not files:
        return None
    chosen = np.unique(np.linspace(0, len(files) - 1, number).round().astype(int))
    figure, axes = plt.subplots(1, len(chosen), figsize=(4 * len(chosen), 4),
                                squeeze=False, layout="constrained")
    for axis, index in zip(axes[0], chosen):
        cloud = run_folder.points(files[index])
        axis.set_title(f"t = {times[index]:.4g} s")
        axis.set_aspect("equal")
        if "Grid/Lower corner" in parameters:
            lower = run_folder.numbers(parameters["Grid/Lower corner"])
            upper = run_folder.numbers(parameters["Grid/Upper corner"])
            axis.set_xlim(lower[0], upper[0])
            axis.set_ylim(lower[1], upper[1])
        if field not in cloud:
            continue
        colour = cloud[field]
        if colour.ndim > 1:
            colour = run_folder.magnitude(colour)
        x, y = cloud["position"][:, 0], cloud["position"][:, 1]
        # Without the hundredth at either end: a single point that splashes
        # would take all colours. The arrows of the bar stand for what is left.
        low, high = np.percentile(colour, [1, 99])
        dots = axis.scatter(x, y, c=colour, s=3, linewidths=0,
                            vmin=low, vmax=high)
        figure.colorbar(dots, ax=axis, label=LABELS.get(field, field),
                        orientation="horizontal", ticks=MaxNLocator(4),
                        extend="both")
    return figure


def draw_columns(table, units, names):
    """All columns of one unit share one plot."""
    groups = {}
    for name in names:
        groups.setdefault(units[name], []).append(name)
    if not groups:
        return None
    figure, axes = plt.subplots(len(groups), 1, sharex=True, squeeze=False,
                                figsize=(7, 1 + 3 * len(groups)),
                                layout="constrained")
    for axis, (unit, names) in zip(axes[:, 0], groups.items()):
        for name in names:
            axis.plot(table["time"], table[name], label=name)
        axis.set_ylabel(f"[{unit}]" if unit else "")
        axis.legend()
        axis.grid(alpha=0.3)
    axes[-1, 0].set_xlabel("time [s]")
    return figure


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--field", default="pressure")
    parser.add_argument("--snapshots", type=int, default=4)
    arguments = parser.parse_args()

    folder = arguments.folder
    parameters = run_folder.parameters(folder)
    table, units = run_folder.statistics(folder)
    energies = [name for name in table if "energy" in name]
    observables = run_folder.words(parameters.get("Observables", ""))
    probes = [name for name in table if any(
        name == probe or name.startswith(probe + " ") for probe in observables)]

    for name, figure in (
            ("snapshots", draw_snapshots(folder, parameters, arguments.field,
                                         arguments.snapshots)),
            ("energies", draw_columns(table, units, energies)),
            ("probes", draw_columns(table, units, probes))):
        if figure:
            path = folder / f"{name}.png"
            figure.savefig(path, dpi=120)
            print(path)


if __name__ == "__main__":
    main()
