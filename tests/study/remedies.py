#!/usr/bin/env python3
"""Follows what messages advise, in the situations in which they advise it.

    remedies.py --limber PROGRAM --prm FOLDER [--table FILE]

FOLDER is prm of the project. Each situation is a run that goes wrong; the
entries that its message names are set, to the values that it names, and the
run is done again: it has to end better. --table writes what was found.
"""

import argparse
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
WATER, BEAM = "Body water/", "Body beam/"
SMALL_DAM = (WATER + "Points per cell edge=3", "Output/Time interval=0",
             WATER + "Newtonian fluid/Bulk modulus=auto")
ENTRY = re.compile(r"'([A-Z][^'=]*/[^'=]*?) ?= ?([^']*)'")

# what, scene, entries that make it go wrong, words of the command
SITUATIONS = (
    ("small cut cell", "dam_break.prm",
     ("Method/Stress update=usl", *SMALL_DAM), ()),
    ("Courant number", "cantilever.prm", ("Method/Courant number=2.5",), ()),
    ("locking", "cantilever.prm", (BEAM + "Locking treatment=none",), ()),
    ("null space", "verification/hydrostatic_tank.prm",
     (WATER + "Hourglass control=0", WATER + "Particle shifting=0",
      "Check rest/Tolerance=1", "Check little motion/Tolerance=1",
      WATER + "Initial velocity="
      "0.01*sin(29*x+13*y*y); 0.01*cos(31*x*y-9*y)"), ()),
    ("null space", "bouncing_ball.prm", (), ()),
    ("checkerboard", "dam_break.prm",
     (WATER + "Points per cell edge=2", "Output/Time interval=0",
      WATER + "Newtonian fluid/Bulk modulus=auto",
      WATER + "Checkerboard control=0", WATER + "Particle shifting=0",
      "Check front at T=3/Reference=4.4"), ()),
    ("lost contact", "pulled_strip.prm", (), ()),
    ("reference, step too long", "cantilever.prm",
     ("Reference/Method=explicit", "Reference/Time step=0.01", "End time=0.5",
      "Check first mode/Observable=tip", "Check first mode/Tolerance=1e9"),
     ("reference",)),
)


class Run:
    """Exit code, what was said, the suspicion and the worst check of a run."""

    def __init__(self, program, words, scene, settings):
        with tempfile.TemporaryDirectory(prefix="limber-") as folder:
            command = [program, *words, str(scene), "--output-directory", folder]
            for setting in settings:
                command += ["--set", setting]
            done = subprocess.run(command, text=True, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT)
            self.code = done.returncode
            self.said = " ".join(done.stdout.split())
            summary = json.loads((Path(folder) / "summary.json").read_text())
        self.suspected = summary.get("suspected") or ""
        self.verdict = summary["verdict"]
        self.missed = max((abs(check["value"] - check["reference"])
                           / check["tolerance"]
                           if check["value"] is not None else float("inf")
                           for check in summary["checks"]), default=0)

    def __str__(self):
        return (f"{self.verdict}, {self.missed:.3g} of the tolerance"
                + (f", {self.suspected}" if self.suspected else ""))


def remedies(said):
    """The entries with values behind the last 'Set', not what stands behind 'or'."""
    first = re.split(r",? or ", said[said.rindex("Set '"):])[0]
    return tuple(f"{entry}={value}" for entry, value in ENTRY.findall(first))


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limber", required=True)
    parser.add_argument("--prm", required=True, type=Path)
    parser.add_argument("--table", type=Path)
    arguments = parser.parse_args()
    failed = []
    table = ["| what is named | scene | set | before | after |",
             "| --- | --- | --- | --- | --- |"]
    for what, name, settings, words in SITUATIONS:
        scene = arguments.prm / name
        if not scene.exists():
            scene = HERE / "scenes" / name
        before = Run(arguments.limber, words, scene, settings)
        set_now = remedies(before.said)
        after = Run(arguments.limber, words, scene, (*settings, *set_now))
        named = what in (before.suspected, "reference, step too long")
        # A checkerboard spoils the pressure and leaves the motion.
        most = before.missed * (1.05 if what == "checkerboard" else 1)
        better = (before.code != 0 and after.code in (0, 4)
                  and after.suspected != what
                  and (after.code == 0 or after.missed < most))
        row = (f"| {what} | `{name}` | {', '.join(f'`{s}`' for s in set_now)} "
               f"| {before} | {after} |")
        print(row)
        table.append(row)
        if not (named and set_now and better):
            failed.append(f"{what}, {name}")
            print("FAILED:", before.said[-400:], after.said[-400:])
    if arguments.table:
        arguments.table.write_text("\n".join(table) + "\n")
    sys.exit(("FAILED: " + "; ".join(failed)) if failed else 0)


if __name__ == "__main__":
    main()
