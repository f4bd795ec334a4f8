#!/usr/bin/python3
"""Draws the chart of a study: study.svg and study.png.

    plot_study.py <folder of the study>

Reads study.csv and study.json, as `limber study`, `limber stability` and `limber
inf-sup` write them. One panel for each measure and one line for each method;
where the axis is a variation and there are others, also one panel for each of
their values. On charts of error against cost the Pareto front is ringed, and the
ends of lines, or the caption, say which variant they are; where several kernels
stand there with and without a treatment of locking ('quadratic none', 'quadratic
node'), one panel shows them without and one with it, in the same colours. Variants
that have failed stand as crosses at the upper edge, and the legend says what went
wrong; open triangles at the lower edge are values too small for the axis, with the
value beside. On maps of stability an open triangle means that no limit was found
below it.
"""

import argparse
import csv
import json
import math
import textwrap
from pathlib import Path

import charts
from charts import np, plt
from matplotlib.ticker import LogFormatterSciNotation, NullLocator

DECADES = 10  # of a logarithmic axis at most


def number(text):
    try:
        return float(text)
    except ValueError:  # empty, or the reason why there is none
        return math.nan


def methods_of(rows):
    return list(dict.fromkeys(row["method"] for row in rows))


def label_of(row, variations):
    return ", ".join(row[name] for name in variations)


def is_error(rows, measure):
    """Whether the column of errors says something else than that of values."""
    return any(number(row[measure + " value"]) != number(row[measure + " error"])
               for row in rows
               if np.isfinite(number(row[measure + " error"])))


def points_of(rows, measure, meta):
    points = [(number(row[meta["horizontal"]]), number(row[measure + " error"]),
               row) for row in rows if row["outcome"] == "finished"]
    points = [p for p in points if np.isfinite(p[0]) and np.isfinite(p[1])]
    return sorted(points, key=lambda p: p[0])


def is_logarithmic(meta, direction):
    return meta["logarithmic"] in ("both", direction)


def floor_of(rows, measure, meta):
    """The smallest value that a logarithmic axis reaches; nothing: any."""
    values = [y for _, y, _ in points_of(rows, measure, meta)]
    if not is_logarithmic(meta, "vertical") or not values:
        return None
    lowest, largest = min(values), max(values)
    if lowest >= largest * 10.**-DECADES:
        return None
    return 0.3 * min((y for y in values if y > largest * 10.**-DECADES))


def draw_line(axis, rows, measure, meta, style, floor, marks, grown=1.):
    """One method: its points, joined in the order of the horizontal axis. Of
    several variations against cost only the last one goes along a line. Marks and
    line are @p grown times as large."""
    points = points_of(rows, measure, meta)
    joined = {}
    for x, y, row in points:
        others = meta["variations"][:-1] if meta["against cost"] else []
        key = tuple(row[name] for name in others)
        joined.setdefault(key, []).append((x, y, row))
    label = rows[0]["method"]
    if meta["rivals"] and label.endswith(" none"):
        label = None  # the colour is named in the other panel
    for line in joined.values():
        seen = [p for p in line if floor is None or p[1] >= floor]
        axis.plot([p[0] for p in seen], [p[1] for p in seen], label=label,
                  markersize=grown * (7 if style["marker"] == "*" else 4.5),
                  linewidth=grown, **style)
        label = None
        for p in line:
            if p not in seen:
                axis.plot(p[0], floor, "v", color=style["color"], markersize=7,
                          fillstyle="none")
                marks.append((2, p[0], floor, f"{p[1]:.0e}" if p[1] else "0",
                              style["color"]))
        if meta["against cost"]:
            for k, (x, y, row) in enumerate(seen):
                if k in (0, len(seen) - 1):
                    marks.append((1, x, y, label_of(row, meta["variations"]),
                                  style["color"]))
    for x, y, row in points:
        if row["beyond"].startswith("stable up to"):  # no limit was found
            axis.plot(x, y, "^", markersize=9, fillstyle="none",
                      color=style["color"])
        if (meta["against cost"] and row[measure + " Pareto"] == "1" and
                (floor is None or y >= floor)):
            axis.plot(x, y, "o", markersize=11, fillstyle="none",
                      color="black", markeredgewidth=0.8)


def coincide(rows, others, measure, meta):
    """Whether two methods have the same points, to what is seen: 1 %."""
    own, other = ({x: y for x, y, _ in points_of(r, measure, meta)}
                  for r in (rows, others))
    return bool(own) and own.keys() == other.keys() and all(
        abs(own[x] - other[x]) <= 0.01 * max(abs(own[x]), abs(other[x]))
        for x in own)


MANY = 3  # lines that lie on each other are drawn as one


def groups_that_coincide(rows, methods, measure, meta):
    """Lists of three methods or more whose lines lie on each other."""
    groups = []
    own = {method: [row for row in rows if row["method"] == method]
           for method in methods}
    for method in methods:
        group = next((g for g in groups if coincide(own[method], own[g[0]],
                                                    measure, meta)), None)
        if group:
            group.append(method)
        else:
            groups.append([method])
    return [group for group in groups if len(group) >= MANY]


def draw_group(axis, group, rows, methods, measure, meta, floor, marks):
    """One line for several methods, with their names beside."""
    style = {"color": "0.25", "marker": "o", "linestyle": "-",
             "fillstyle": "full"}
    draw_line(axis, [{**row, "method": ""} for row in rows], measure,
              {**meta, "rivals": False}, style, floor, marks)
    text = ("all lines coincide" if group == methods else
            ", ".join(group) + " coincide")
    points = points_of(rows, measure, meta)
    x, y, _ = points[len(points) // 2]
    marks.append((3, x, y, "\n".join(textwrap.wrap(text, 30)), "0.25"))


def draw_failed(axis, rows, meta, colour, taken):
    """Crosses at the upper edge, below those of other methods that failed at the
    same place; the reason goes into the legend. A failed run may have no cost at
    all. @p taken: how many crosses stand at a place so far."""
    transform = axis.get_xaxis_transform()
    reasons = {}
    for row in rows:
        x = number(row[meta["horizontal"]])
        if row["outcome"] != "finished" and np.isfinite(x):
            reasons.setdefault(row["outcome"], []).append((x, row))
    for reason, places in reasons.items():
        which = ("" if not meta["against cost"] else " at " + " / ".join(
            label_of(row, meta["variations"]) for _, row in places))
        label = f"{rows[0]['method']}{which}: {reason}"
        for x, _ in places:
            y = 0.98 - 0.04 * taken.get(x, 0)
            taken[x] = taken.get(x, 0) + 1
            axis.plot(x, y, "x", color=colour, transform=transform,
                      clip_on=False, markeredgewidth=1.5,
                      label="\n".join(textwrap.wrap(label, 26)))
            label = ""


def draw_closed_forms(axis, methods, meta):
    label = "formula"
    for method in methods:
        line = meta["closed forms"].get(method)
        if line:
            y = [math.nan if v is None else v for v in line["y"]]
            axis.plot(line["x"], y, "--", linewidth=1, zorder=1,
                      color=charts.styles_of(methods)[method]["color"],
                      label=f"{method}: {label}", scalex=False, scaley=False)


def boxes_of_points(axis):
    """What markers cover, in pixels: left, lower, right and upper ends."""
    boxes = []
    for line in axis.lines:
        if line.get_transform() == axis.transData and line.get_marker() not in (
                "None", "x"):
            reach = (line.get_markersize() / 2 + 1) * axis.figure.dpi / 72
            places = axis.transData.transform(
                np.column_stack(line.get_data()).astype(float))
            boxes += [(px - reach, py - reach, px + reach, py + reach)
                      for px, py in places]
    return boxes


def pixels_of_lines(axis):
    """Places along the lines of a panel, two pixels apart."""
    places = [np.zeros((0, 2))]
    for line in axis.lines:
        if (line.get_linestyle() != "None" and len(line.get_xdata()) > 1 and
                line.get_transform() == axis.transData):
            corners = axis.transData.transform(
                np.column_stack(line.get_data()).astype(float))
            for a, b in zip(corners, corners[1:]):
                if np.isfinite([*a, *b]).all():
                    number = int(np.hypot(*(b - a)) / 2) + 2
                    places.append(a + np.linspace(0, 1, number)[:, None] * (b - a))
    return np.concatenate(places)


# Directions in which a text stands off its point, and how far: what is farther gets
# a line to it.
SIDES = ((1, 1), (1, -1), (-1, 1), (-1, -1), (1, 0), (-1, 0), (0, 1), (0, -1))
DISTANCES = (6, 9, 14, 20)  # pixels
WITH_LINE = 14


def place_marks(axis, marks):
    """Small texts beside points, as many as there is room for: those that would
    cover another one, a point or a line move away or are left out."""
    axis.figure.canvas.draw()
    renderer = axis.figure.canvas.get_renderer()
    taken, lines = boxes_of_points(axis), pixels_of_lines(axis)
    inside = axis.get_window_extent()

    def is_free(box):
        return (box[0] > inside.x0 and box[2] < inside.x1 and
                box[1] > inside.y0 and box[3] < inside.y1 and
                all(box[0] > o[2] or box[2] < o[0] or box[1] > o[3] or
                    box[3] < o[1] for o in taken) and
                not ((lines > box[:2]) & (lines < box[2:])).all(axis=1).any())
    scale = 72 / axis.figure.dpi
    for _, x, y, text, colour in sorted(marks, key=lambda m: -m[0]):
        px, py = axis.transData.transform((x, y))
        note = axis.annotate(text, (x, y), fontsize=7, color=colour, va="bottom",
                             textcoords="offset points", xytext=(0, 0))
        size = note.get_window_extent(renderer)
        for distance, (right, up) in ((d, s) for d in DISTANCES for s in SIDES):
            dx = (right * distance - (right < 0) * size.width -
                  (right == 0) * size.width / 2)
            dy = (up * distance - (up < 0) * size.height -
                  (up == 0) * size.height / 2)
            box = np.array([px + dx, py + dy, px + dx + size.width,
                            py + dy + size.height])
            if is_free(box):
                taken.append(box)
                note.set_position((dx * scale, dy * scale))
                if distance >= WITH_LINE:
                    line_to(axis, (x, y), box, (px, py), colour)
                break
        else:
            note.remove()


def line_to(axis, place, box, pixel, colour):
    """From a text to the point it belongs to."""
    end = np.clip(pixel, box[:2], box[2:])
    axis.annotate("", place, xytext=(end - pixel) * 72 / axis.figure.dpi,
                  textcoords="offset points", arrowprops={
                      "arrowstyle": "-", "color": colour, "linewidth": 0.5,
                      "shrinkA": 0, "shrinkB": 3})


def common_ends(marks):
    """The labels of both ends where all lines of a chart have the same ones; the
    left end is the cheaper one. Nothing where they differ."""
    texts = [mark[3] for panel in marks for mark in panel if mark[0] == 1]
    firsts, lasts = set(texts[::2]), set(texts[1::2])
    if len(texts) > 2 and len(texts) % 2 == 0 and len(firsts) == len(lasts) == 1:
        return firsts.pop(), lasts.pop()
    return None


def draw_panel(axis, rows, measure, meta):
    """Returns the small texts that are still to be placed."""
    methods = methods_of(rows)
    if not meta["against cost"]:
        values = sorted({number(row[meta["horizontal"]]) for row in rows})
        if len(values) <= 5:
            axis.set_xticks(values, [f"{value:g}" for value in values])
            axis.set_xmargin(0.2)
            axis.xaxis.set_minor_locator(NullLocator())
    floor, marks, taken = floor_of(rows, measure, meta), [], {}
    together = ([] if meta["against cost"] or meta["closed forms"] else
                groups_that_coincide(rows, methods, measure, meta))
    counts = not meta["against cost"] and all(
        y == round(y) and y < 100 for _, y, _ in points_of(rows, measure, meta))
    if counts:  # zeros among them
        floor = None
    styles = charts.styles_of(methods)
    for index, method in enumerate(methods):
        own = [row for row in rows if row["method"] == method]
        style = styles[method]
        # where formulas are drawn, measured values stand alone, and can be
        # told apart where they coincide
        if meta["closed forms"]:
            style.update(linestyle="none", fillstyle="none",
                         markeredgewidth=1.2)
        group = next((g for g in together if method in g), None)
        if group:
            axis.plot([], [], label=method, **style)  # for the legend
            if method == group[0]:
                draw_group(axis, group, own, methods, measure, meta, floor, marks)
            draw_failed(axis, own, meta, style["color"], taken)
            continue
        # larger below those that would hide it
        grown = 1. if meta["against cost"] or meta["closed forms"] else (
            1 + 0.6 * min(2, sum(coincide(own, [row for row in rows
                                         if row["method"] == other],
                                   measure, meta)
                          for other in methods[index + 1:])))
        draw_line(axis, own, measure, meta, style, floor, marks, grown)
        draw_failed(axis, own, meta, style["color"], taken)
    if is_logarithmic(meta, "horizontal") and all(
            number(row[meta["horizontal"]]) > 0 for row in rows):
        axis.set_xscale("log")
    if is_logarithmic(meta, "vertical") and not counts:
        axis.set_yscale("log")
        axis.yaxis.set_minor_formatter(
            LogFormatterSciNotation(minor_thresholds=(1.5, 0.5)))
    if len(axis.get_xticks()) <= 5 and not meta["against cost"]:
        values = sorted({number(row[meta["horizontal"]]) for row in rows})
        if len(values) <= 5:
            axis.set_xticks(values, [f"{value:g}" for value in values])
            axis.xaxis.set_minor_locator(NullLocator())
    if floor is not None:
        axis.set_ylim(bottom=0.6 * floor)
    # of what was measured and a little more; formulas may leave the panel
    low, high = axis.get_ylim()
    if meta["closed forms"] and axis.get_yscale() == "linear":
        high += 0.15 * (high - low)
    draw_closed_forms(axis, methods, meta)
    axis.set_ylim(low, high)
    if meta["against cost"]:
        for level in meta["error levels"]:
            axis.axhline(level, color="grey", linewidth=0.5, linestyle=":")
        axis.set_ylim(low, high)
    axis.set_xlabel(meta["horizontal label"])
    one = len(meta["measures"]) == 1  # else the label fits one of them at most
    axis.set_ylabel(meta["vertical label"] if one and meta["vertical label"]
                    else "error of the " + measure
                    if meta["against cost"] or is_error(rows, measure)
                    else measure)
    axis.grid(alpha=0.25)
    return marks


RIVALS = 3  # kernels without a treatment that make two panels


def by_treatment(rows):
    """Titles and rows of the panels without and with a treatment of locking, or
    nothing. Finite elements are in both."""
    known = {method: charts.kernel_and_treatment(method)
             for method in methods_of(rows)}
    bare = [m for m, k in known.items() if k and k[1] == "none"]
    if len(bare) < RIVALS or len(bare) == len(known):
        return None
    return {
        "without a cure for locking": [
            row for row in rows if row["method"] in bare or
            row["method"].startswith("FEM ")],
        "with one": [row for row in rows if row["method"] not in bare]}


def panels_of(rows, meta):
    """Titles and rows of the panels beside each other: for a chart against one of
    several variations one for each combination of the others; against cost two if
    kernels are compared without and with a treatment, else one."""
    if meta["against cost"]:
        return by_treatment(rows) or {"": rows}
    others = [name for name in meta["variations"] if name != meta["horizontal"]]
    if not others:
        return {"": rows}
    panels = {}
    for row in rows:
        title = ", ".join(f"{name} {row[name]}" for name in others)
        panels.setdefault(title, []).append(row)
    return panels


def draw_measure(axes, panels, measure, meta):
    todo = []
    for axis, (title, own) in zip(axes, panels.items()):
        todo.append((axis, draw_panel(axis, own, measure, meta)))
        title = ", ".join(([measure] if len(meta["measures"]) > 1 else []) +
                          ([title] if title else []))
        if title:
            axis.set_title(title, fontsize=10)
    if meta["against cost"] and len(panels) > 1:
        ends = [axis.get_xlim() for axis in axes]
        for axis in axes:
            axis.set_xlim(min(low for low, _ in ends),
                          max(high for _, high in ends))
    limits = [axis.get_ylim() for axis in axes]
    for axis in axes:
        axis.set_ylim(min(low for low, _ in limits),
                      max(high for _, high in limits))
    return todo


def measures_of(rows, meta):
    """Those that are drawn: one that repeats another, as the mean over a single
    filling does, is not."""
    known = {}
    for measure in meta.get("drawn measures") or meta["measures"]:
        values = tuple(row[measure + " error"] for row in rows)
        known.setdefault(values, measure)
    return list(known.values())


def drawn_rows(rows, meta):
    """Those of the methods that are drawn; all where none is named, or none of
    those named was run, as in a short study."""
    drawn = meta.get("drawn methods")
    return [row for row in rows if row["method"] in drawn] if drawn else []


def key_of(meta, ends):
    """What the small marks of a chart of error against cost mean. @p ends: labels
    of both ends where all lines have the same ones."""
    names = ", ".join(meta["variations"])
    return ((f"Lines go from {ends[0]} at the left to {ends[1]} at the right "
             f"({names}). " if ends else f"Numbers at the ends of lines: {names}. ") +
            "Ringed: none is more exact at less cost (Pareto front)."
            + (" Dotted: errors named on the page."
               if meta["error levels"] else ""))


PER_ROW = 2  # panels; with more of them texts are too small on a page


def draw(rows, meta):
    """The chart of a study as a figure: rows of study.csv, study.json."""
    number_of_methods = len(methods_of(rows))
    rows = drawn_rows(rows, meta) or rows
    meta = {**meta, "measures": measures_of(rows, meta)}
    measures = meta["measures"]
    panels = panels_of(rows, meta)
    meta["rivals"] = meta["against cost"] and len(panels) > 1
    number_of_panels = len(panels) * len(measures)
    per_row = min(number_of_panels, PER_ROW)
    lines = -(-number_of_panels // per_row)
    total = 2.5 + (6.5 if per_row == 1 else 4.5 * per_row)
    more = number_of_methods - len(methods_of(rows))
    figure, axes = plt.subplots(
        lines, per_row, squeeze=False, layout="constrained",
        figsize=(total, 0.9 + (4.5 if per_row == 1 else 3.9) * lines))
    flat, marks = list(axes.flat), []
    for axis in flat[number_of_panels:]:
        axis.set_axis_off()
    flat = flat[:number_of_panels]
    for index, measure in enumerate(measures):
        marks += draw_measure(
            flat[index * len(panels):(index + 1) * len(panels)], panels,
            measure, meta)
    entries = {}
    for axis in flat:
        for handle, label in zip(*axis.get_legend_handles_labels()):
            entries.setdefault(label, handle)
    if entries:
        axes[0][-1].legend(entries.values(), entries.keys(), fontsize=8,
                           loc="upper left", bbox_to_anchor=(1.01, 1))
    ends = common_ends([texts for _, texts in marks])
    keys = ([key_of(meta, ends)] if meta["against cost"] else []) + (
        [f"{more} more method{'s are' if more > 1 else ' is'} in the table."]
        if more else [])
    caption = "\n".join(textwrap.wrap(" ".join(keys), int(16 * total)) +
                        textwrap.wrap(meta["caption"], int(16 * total)))
    figure.suptitle(meta["title"])
    figure.supxlabel(caption, fontsize=7, color="grey")
    for axis, texts in marks:
        place_marks(axis, [mark for mark in texts
                           if mark[0] != 1 or not ends])
    return figure


def draw_folder(folder, output=None):
    """The chart of a study's folder: study.svg and study.png, or @p output."""
    try:
        with open(folder / "study.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        meta = json.loads((folder / "study.json").read_text())
    except FileNotFoundError as error:
        charts.fail(f"The folder '{folder}' is not that of a study: there is no "
                    f"'{error.filename}'. 'limber study' writes it.")
    figure = draw(rows, meta)
    if output:
        charts.save(figure, charts.check_ending(output))
    else:
        charts.save(figure, folder / "study.svg", close=False)
        charts.save(figure, folder / "study.png")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    draw_folder(parser.parse_args().folder)


if __name__ == "__main__":
    main()
