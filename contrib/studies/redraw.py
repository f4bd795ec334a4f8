#!/usr/bin/python3
"""Draws the charts of doc/studies anew from the tables of their pages: nothing is
computed, only colours, names and marks change.

    redraw.py [NAME ...] [--target FOLDER]

Without NAME all pages of doc/studies that `limber study`, `limber stability` or
`limber inf-sup` wrote, and column_stress.
"""

import argparse
import re
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "contrib/plot"))
import charts  # noqa: E402
import column_and_ball  # noqa: E402
import plot_study  # noqa: E402

COSTS = ("CPU seconds", "wall seconds", "memory", "steps")
SWEEPS = {"inf_sup", "inf_sup_random"}  # without a file of a study


def table_of(text):
    """Names of the columns and rows of the first table of a page."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    cells = [[cell.strip() for cell in line.strip("|").split("|")]
             for line in lines]
    return cells[0], cells[2:]


def study_entries(name):
    """Entries of the study's file that a chart depends on."""
    entries, section = {}, []
    path = TOP / f"prm/studies/{name}.prm"
    for line in path.read_text().splitlines() if path.exists() else ():
        line = line.split("#")[0].strip()
        if line.startswith("subsection "):
            section.append(line[len("subsection "):].strip())
        elif line == "end":
            section.pop()
        elif line.startswith("set "):
            key, value = line[4:].split("=", 1)
            entries["/".join(section + [key.strip()])] = value.strip()
    return entries


def meta_of(name, text, header):
    """study.json, as far as charts read it."""
    entries = study_entries(name)
    words = [word.strip() for word in header]
    variations = [v.strip() for v in entries.get("Variations", "").split(",")]
    variations = [v for v in variations if v in words]
    chart = {key.split("/")[1]: value for key, value in entries.items()
             if key.startswith("Chart/")}
    if name in SWEEPS:
        variations = ["cells per edge"]
        chart = {"Horizontal axis": "cells per edge", "Vertical label": "beta"}
    rest = words[1 + len(variations):]
    measures = [word for word in rest if word not in
                ("error", "closed form", "beyond", "CPU seconds")]
    cost = entries.get("Cost", "CPU seconds")
    axis = chart.get("Horizontal axis", "cost")
    caption = [line for line in text.splitlines() if "Limber " in line][-1]
    return {
        "title": text.splitlines()[0].lstrip("# "), "caption": caption,
        "measures": measures, "variations": variations,
        "horizontal": cost if axis == "cost" else axis,
        "horizontal label": chart.get("Horizontal label") or (
            cost if axis == "cost" else axis),
        "vertical label": chart.get("Vertical label", ""),
        "against cost": axis == "cost",
        "logarithmic": chart.get("Logarithmic", "both"),
        "error levels": sorted({float(level) for level in re.findall(
            r", error ([\d.e-]+):", text)}),
        "closed forms": {}}


def rows_of(header, cells, meta):
    """Rows as study.csv has them."""
    rows = []
    for line in cells:
        row = {"outcome": "finished", "beyond": "", "method": line[0]}
        for k, (name, cell) in enumerate(zip(header, line)):
            if name in meta["measures"]:
                has_error = header[k + 1:k + 2] == ["error"]
                row[f"{name} value"] = cell
                row[f"{name} error"] = line[k + 1] if has_error else cell
                row[f"{name} Pareto"] = "0"
                if cell and plot_study.number(cell) != plot_study.number(cell):
                    row["outcome"] = cell  # the reason instead of a number
            elif name != "error":
                row[name] = cell
        rows.append(row)
    return rows


def mark_fronts(rows, meta, problems):
    """Who errs less costs more: the Pareto front of each problem."""
    for measure in meta["measures"]:
        known = [(plot_study.number(row[f"{measure} error"]),
                  plot_study.number(row[meta["horizontal"]]),
                  tuple(row[p] for p in problems), row)
                 for row in rows if row["outcome"] == "finished"]
        known = [k for k in known if k[0] == k[0] and k[1] == k[1]]
        for error, cost, problem, row in known:
            if not any(e <= error and c <= cost and (e < error or c < cost)
                       for e, c, p, _ in known if p == problem):
                row[f"{measure} Pareto"] = "1"


def add_closed_forms(rows, header, meta):
    if "closed form" not in header:
        return
    for row in rows:
        y = plot_study.number(row["closed form"])
        if y == y:
            line = meta["closed forms"].setdefault(row["method"],
                                                   {"x": [], "y": []})
            line["x"].append(float(row[meta["horizontal"]]))
            line["y"].append(y)


def problems_of(name):
    """Variations that change the problem instead of the effort."""
    return [key.split("/")[0][len("Variation "):]
            for key, value in study_entries(name).items()
            if key.startswith("Variation ") and key.endswith("/Another problem") and
            value == "true"]


def redraw_column(text, target):
    """The chart of column_and_ball.py, which has panels of its own."""
    _, cells = table_of(text)
    column_and_ball.draw_column(
        {(modulus, method): [plot_study.number(word) for word in words]
         for modulus, method, *words in (line[:6] for line in cells)}, target)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--target", type=Path, default=TOP / "doc/studies")
    arguments = parser.parse_args()
    pages = TOP / "doc/studies"
    names = arguments.names or sorted(
        path.stem for path in pages.glob("*.md")
        if (TOP / f"prm/studies/{path.stem}.prm").exists()
        or path.stem in SWEEPS | {"column_stress"})
    for name in names:
        text = (pages / f"{name}.md").read_text()
        if name == "column_stress":
            redraw_column(text, arguments.target)
            continue
        header, cells = table_of(text)
        meta = meta_of(name, text, header)
        rows = rows_of(header, cells, meta)
        if meta["against cost"]:
            mark_fronts(rows, meta, problems_of(name))
        add_closed_forms(rows, header, meta)
        charts.save(plot_study.draw(rows, meta), arguments.target / f"{name}.png")


if __name__ == "__main__":
    main()
