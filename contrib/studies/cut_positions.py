#!/usr/bin/python3
"""Iterations of the linear solver while a bar moves through the grid.

    cut_positions.py [path of limber] [--positions=100] [--set NAME=VALUE ...]

One quasi-static step of prm/verification/cantilever_3d.prm under its weight, five
cells thick, with the bar at many places relative to the grid: the faces of the
bar cut cells anywhere, down to a hundredth of a cell. Prints the iterations per
correction, the Newton iterations, and the sag of the tip; a few minutes.
"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
EDGE = 0.2  # of cells
SETTINGS = [
    "Method/Time integration=quasi-static", "Method/Time step=1", "End time=1",
    "Body beam/Initial velocity=0; 0; 0", "Body beam/Placement=cut",
    "Loads/Gravity=0, -0.05, 0", "Output/Time interval=0",
    "Check first mode/Observable=tip"]


def place(n, positions):
    """Three shifts in [0, 1) of a cell that fill it evenly."""
    return n / positions, n * 0.6180339887 % 1, n * 0.4142135624 % 1


def run(limber, folder, shifts, settings):
    y, z, x = (EDGE * shift for shift in shifts)
    command = [limber, str(TOP / "prm/verification/cantilever_3d.prm"),
               "--output-directory", folder]
    for setting in [*SETTINGS, f"Grid/Lower corner=0, {-y}, {-z}",
                    f"Grid/Upper corner={9 + x}, {3 - y}, {3 - z}",
                    "Grid/Cells=45, 15, 15", "Output/Replace=true", *settings]:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 4):
        sys.exit(" ".join(command) + "\n" + done.stdout + done.stderr)
    words = " ".join(done.stdout.split())
    newton = re.search(r"Newton's method: ([0-9.]+) iterations", words)
    linear = re.search(r"([0-9.]+) iterations a correction", words)
    summary = json.loads((Path(folder) / "summary.json").read_text())
    return (float(linear[1]) if linear else 0, float(newton[1]),
            summary["checks"][0]["value"], summary["cpu_seconds"])


def main():
    arguments = iter(sys.argv[1:])
    limber, positions, settings = str(TOP / "build/release/limber"), 100, []
    for argument in arguments:
        if argument == "--set":
            settings.append(next(arguments))
        elif argument.startswith("--positions="):
            positions = int(argument.split("=")[1])
        else:
            limber = argument
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for n in range(positions):
            found.append(run(limber, folder, place(n, positions), settings))
    for name, column in zip(("iterations a correction", "Newton iterations",
                             "sag", "CPU seconds"), zip(*found)):
        print(f"{name}: {min(column):.6g} to {max(column):.6g}, mean "
              f"{sum(column) / len(column):.6g}; at the largest: "
              f"{place(max(range(positions), key=column.__getitem__), positions)}")


if __name__ == "__main__":
    main()
