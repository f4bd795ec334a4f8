#!/usr/bin/python3
"""The rivals in one chart: every kernel and the initial frame, without and with a
treatment of locking, on four kinds of scene. From the tables of doc/studies, which
`all_studies.py kernels_vibration kernels_bending kernels_flow kernels_cook` makes.

    rivals.py [--target FOLDER]

Full lines have a treatment, pale ones have none; the grey band joins what no other
material points beat in both error and cost (finite elements, black, left aside).
"""

import argparse
import sys
from pathlib import Path

import redraw
from redraw import TOP, charts, plot_study

np, plt = charts.np, charts.plt

# Page, measure, and what stands over the panel.
PANELS = (
    ("kernels_vibration", "frequency", "small vibration, nu = 0.499: frequency"),
    ("kernels_bending", "tip", "slow bending by half the length, nu = 0.3: tip"),
    ("kernels_cook", "tip", "Cook's membrane at rest, nu = 0.499: corner"),
    ("kernels_flow", "front over time", "dam break, soft water: front over time"))


def lines_of(name, measure):
    """Cost and error of each method's variants, in the order of the page."""
    text = (TOP / f"doc/studies/{name}.md").read_text()
    header, cells = redraw.table_of(text)
    meta = redraw.meta_of(name, text, header)
    lines = {}
    for row in redraw.rows_of(header, cells, meta):
        cost, error = (plot_study.number(row[key]) for key in
                       (meta["horizontal"], f"{measure} error"))
        if np.isfinite(cost) and np.isfinite(error):
            lines.setdefault(row["method"], []).append((cost, error))
    return {method: np.array(points) for method, points in lines.items()}


def front_of(lines):
    """What no other material points beat, by rising cost."""
    points = sorted(tuple(p) for method, line in lines.items()
                    if not method.startswith("FEM ") for p in line)
    front = []
    for cost, error in points:
        if not front or error < front[-1][1]:
            front.append((cost, error))
    return np.array(front)


def draw_panel(axis, lines, title):
    axis.plot(*front_of(lines).T, color="0.85", linewidth=9, zorder=0,
              solid_capstyle="round", solid_joinstyle="round",
              label="best of the points")
    for method, points in lines.items():
        known = charts.kernel_and_treatment(method)
        bare = known is not None and known[1] == "none"
        style = charts.style_of(method)
        axis.plot(*points.T, **style, linewidth=0.8 if bare else 1.6,
                  markersize=3 if bare else 5.5, alpha=0.4 if bare else 1,
                  label=None if bare else method)
    axis.set(xscale="log", yscale="log", xlabel="CPU seconds", ylabel="error")
    axis.set_title(title)
    axis.grid(alpha=0.25)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--target", type=Path, default=TOP / "doc/studies")
    arguments = parser.parse_args()
    figure, axes = plt.subplots(2, 2, figsize=(13, 9), layout="constrained")
    entries = {}
    for axis, (name, measure, title) in zip(axes.flat, PANELS):
        draw_panel(axis, lines_of(name, measure), title)
        for handle, label in zip(*axis.get_legend_handles_labels()):
            entries.setdefault(label, handle)
    axes[0][1].legend(entries.values(), entries.keys(), fontsize=9,
                      title="pale: no treatment", loc="upper left",
                      bbox_to_anchor=(1.01, 1))
    figure.suptitle("Error against cost: every kernel on four kinds of scene")
    charts.save(figure, arguments.target / "rivals.png")


if __name__ == "__main__":
    sys.exit(main())
