#!/usr/bin/env python3
"""Draws the chart of a study: study.svg and study.png.

    plot_study.py <folder of the study>

Reads study.csv and study.json, as `limber study` and `limber stability` write
them. One panel for each measure and one line for each method, where the axis is a
variation and there are others also one panel for each of their values; on charts of
error against cost the Pareto front is ringed, variants that have failed stand
as crosses at the upper edge, each with what went wrong. On maps of stability an
open triangle means that no limit was found below it.
"""

import argparse
import csv
import json
import math
import textwrap
from pathlib import Path

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

COLOURS = plt.rcParams["axes.prop_cycle"].by_key()["color"]
LINES = ["-", "--", ":"]  # one for each round of colours
MARKERS = "osD^v<>pPXh8"


def number(text):
    return float(text) if text not in ("", "nan") else math.nan


def methods_of(rows):
    return list(dict.fromkeys(row["method"] for row in rows))


def label_of(row, variations):
    return ", ".join(row[name] for name in variations)


def draw_line(axis, rows, measure, meta, style):
    """One method: its points, joined in the order of the horizontal axis. Of
    several variations against cost only the last one goes along a line."""
    vertical = measure + " error"
    points = [(number(row[meta["horizontal"]]), number(row[vertical]), row)
              for row in rows if row["outcome"] == "finished"]
    points = [p for p in points if np.isfinite(p[0]) and np.isfinite(p[1])]
    points.sort(key=lambda p: p[0])
    joined = {}
    for x, y, row in points:
        others = meta["variations"][:-1] if meta["against cost"] else []
        joined.setdefault(tuple(row[name] for name in others), []).append((x, y))
    label = rows[0]["method"]
    for line in joined.values():
        axis.plot(*zip(*line), label=label, **style)
        label = None
    for x, y, row in points:
        if row["beyond"].startswith("stable up to"):  # no limit was found
            axis.plot(x, y, "^", markersize=9, fillstyle="none",
                      color=style["color"])
        if meta["against cost"]:
            axis.annotate(label_of(row, meta["variations"]), (x, y), fontsize=6,
                          textcoords="offset points", xytext=(4, 3),
                          color=style["color"])
            if row[measure + " Pareto"] == "1":
                axis.plot(x, y, "o", markersize=11, fillstyle="none",
                          color="black", markeredgewidth=0.8)
    return bool(points)


def draw_failed(axis, rows, meta, colour):
    """Crosses at the upper edge; a failed run may have no cost at all."""
    transform = axis.get_xaxis_transform()
    for row in rows:
        if row["outcome"] == "finished":
            continue
        x = number(row[meta["horizontal"]])
        if np.isfinite(x):
            axis.plot(x, 0.97, "x", color=colour, transform=transform,
                      clip_on=False)
            axis.annotate(f"{label_of(row, meta['variations'])}: "
                          f"{row['outcome']}", (x, 0.97), fontsize=6,
                          xycoords=transform, rotation=90, color=colour,
                          textcoords="offset points", xytext=(3, -3),
                          verticalalignment="top")


def draw_closed_forms(axis, methods, meta):
    for index, method in enumerate(methods):
        line = meta["closed forms"].get(method)
        if line:
            y = [math.nan if v is None else v for v in line["y"]]
            axis.plot(line["x"], y, "--", linewidth=1,
                      color=COLOURS[index % len(COLOURS)])


def draw_panel(axis, rows, measure, meta):
    methods = methods_of(rows)
    if not meta["against cost"]:
        values = sorted({number(row[meta["horizontal"]]) for row in rows})
        if len(values) <= 4:
            axis.set_xticks(values, [f"{value:g}" for value in values])
            axis.set_xmargin(0.2)
    for index, method in enumerate(methods):
        own = [row for row in rows if row["method"] == method]
        style = {"color": COLOURS[index % len(COLOURS)],
                 "linestyle": LINES[index // len(COLOURS) % len(LINES)],
                 "marker": MARKERS[index % len(MARKERS)], "markersize": 4,
                 "linewidth": 1}
        # where formulas are drawn, measured values stand alone, and can be
        # told apart where they coincide
        if meta["closed forms"]:
            style.update(linestyle="none", fillstyle="none",
                         markersize=4 + 2 * index)
        if not draw_line(axis, own, measure, meta, style) and any(
                row["outcome"] != "finished" for row in own):
            axis.plot([], [], "x", color=style["color"], label=method)
        draw_failed(axis, own, meta, style["color"])
    draw_closed_forms(axis, methods, meta)
    if meta["logarithmic"] in ("both", "horizontal"):
        axis.set_xscale("log")
    if meta["logarithmic"] in ("both", "vertical"):
        axis.set_yscale("log")
    if meta["against cost"]:
        for level in meta["error levels"]:
            axis.axhline(level, color="grey", linewidth=0.5, linestyle=":")
    axis.set_xlabel(meta["horizontal label"])
    axis.set_ylabel(meta["vertical label"] or
                    ("error: " + measure if meta["against cost"] else measure))
    lower, upper = axis.get_ylim()
    if axis.get_yscale() == "log" and lower < 1e-10 * upper:
        axis.set_ylim(bottom=1e-10 * upper)  # what is zero up to round-off
    axis.grid(alpha=0.25)


def panels_of(rows, meta):
    """Titles and rows of the panels beside each other: for a chart against one of
    several variations one for each combination of the others, else one."""
    others = [name for name in meta["variations"] if name != meta["horizontal"]]
    if meta["against cost"] or not others:
        return {"": rows}
    panels = {}
    for row in rows:
        title = ", ".join(f"{name} {row[name]}" for name in others)
        panels.setdefault(title, []).append(row)
    return panels


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    with open(folder / "study.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    meta = json.loads((folder / "study.json").read_text())

    measures = meta["measures"]
    panels = panels_of(rows, meta)
    width = 6 if len(panels) == 1 else 3
    figure, axes = plt.subplots(
        1, len(measures) * len(panels), squeeze=False, layout="constrained",
        figsize=(2.5 + width * len(measures) * len(panels), 5.2))
    for index, measure in enumerate(measures):
        row_of_axes = axes[0][index * len(panels):(index + 1) * len(panels)]
        for axis, (title, own) in zip(row_of_axes, panels.items()):
            draw_panel(axis, own, measure, meta)
            title = ", ".join(([measure] if len(measures) > 1 else []) +
                              ([title] if title else []))
            if title:
                axis.set_title(title, fontsize=9)
            if axis is not row_of_axes[0]:
                axis.set_ylabel("")
        limits = [axis.get_ylim() for axis in row_of_axes]
        for axis in row_of_axes:
            axis.set_ylim(min(low for low, _ in limits),
                          max(high for _, high in limits))
    handles, labels = max((axis.get_legend_handles_labels() for axis in axes[0]),
                          key=lambda found: len(found[1]))
    if handles:
        axes[0][-1].legend(handles, labels, fontsize=7, loc="upper left",
                           bbox_to_anchor=(1.01, 1))
    figure.suptitle(meta["title"])
    letters = 17 * width * len(measures) * len(panels)
    figure.supxlabel("\n".join(textwrap.wrap(meta["caption"], letters)),
                     fontsize=6, color="grey")
    for ending in ("svg", "png"):
        figure.savefig(folder / f"study.{ending}", dpi=150)


if __name__ == "__main__":
    main()
