#!/usr/bin/python3
"""The advice of `limber advise` on the scenes that come with the program, held
against runs with and without it.

    advice_table.py [SCENE...] [--limber PROGRAM] [--seconds S] [--table FILE]

Without SCENE all of prm, prm/benchmarks and prm/verification. Every run, those
of advise and those of this script, may take S seconds of wall time (60); what
takes longer is compared as far as it came, which the table says. Ends with an
error where something is advised that makes a check fail or changes a checked
value by more than the admitted error (--for-error, 0.01).
"""

import argparse
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
LINE = re.compile(r"^(Advised|A trade|Not advised): ([^.]+)\. .*?Set ('.*')\. "
                  r"Saves: (?:a factor of (\S+) in CPU time)?.*?\. "
                  r"Changes: (.*)\. Reason: (.*)\.$")
MEASURED = re.compile(r"measured until (\S+) s, (.*) by (\S+) %$")


class Piece:
    """One line of advice."""

    def __init__(self, line):
        found = LINE.match(line)
        if not found:
            sys.exit("This line of advice is not understood: " + line)
        self.line = line
        self.judgement, self.what, entries, factor, changes, self.ground = (
            found.groups())
        self.settings = re.findall(r"'((?:[^']|'s )*)'", entries)
        self.factor = float(factor or 1)  # of memory alone there is none
        measured = MEASURED.search(changes)
        self.until = float(measured.group(1)) if measured else None
        self.quantity = measured.group(2) if measured else ""
        self.change = float(measured.group(3)) / 100 if measured else 0.


def advise(program, scene, settings=(), error=0.01, seconds=60.):
    """All pieces of advice on a scene."""
    command = [program, "advise", str(scene), "--for-error", str(error),
               "--seconds", str(seconds)]
    for setting in settings:
        command += ["--set", setting]
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE)
    if done.returncode != 0:
        sys.exit(done.stdout + done.stderr + "FAILED: " + " ".join(command))
    return [Piece(line) for line in done.stdout.splitlines()
            if not line.startswith("Nothing to spare")]


def run(program, scene, settings, seconds):
    """The summary of a run, cut off after so many seconds."""
    with tempfile.TemporaryDirectory(prefix="limber-") as folder:
        command = [program, str(scene), "--output-directory", folder + "/run",
                   "--set", "Output/Time interval=0"]
        for setting in settings:
            command += ["--set", setting]
        with open(os.devnull, "w", encoding="utf-8") as nothing:
            child = subprocess.Popen(command, stdout=nothing, stderr=nothing)
            try:
                child.wait(timeout=seconds)
            except subprocess.TimeoutExpired:
                child.send_signal(signal.SIGTERM)
                child.wait()
        return json.loads((Path(folder) / "run/summary.json").read_text())


def cost(summary):
    return summary["cpu_seconds"] / summary["end_time"]


def hold(piece, base, changed, error):
    """What a run says of the checks; the worst change, and what is wrong."""
    cells, wrong = [], ""
    if "finished" not in base["verdict"] and base["verdict"] != "check missed":
        return "cut off: none", wrong
    others = {check["name"]: check for check in changed["checks"]}
    for own in base["checks"]:
        name, other = own["name"], others[own["name"]]
        if own["value"] is None or other["value"] is None:
            continue
        change = abs(other["value"] - own["value"])
        cells.append(f"{name} {own['value']:.4g} to {other['value']:.4g} "
                     f"({change / own['tolerance']:.2g} of its tolerance)")
        if piece.judgement != "Advised":
            continue
        if own["passed"] and not other["passed"]:
            wrong = f"check '{name}' is missed"
        if own["reference"] and change > error * abs(own["reference"]):
            wrong = f"check '{name}' changes by {change:.3g}"
    return "; ".join(cells) or "none", wrong


def rows_of(program, scene, arguments, settings=()):
    """Rows of the table, and what is wrong with the advice."""
    rows, wrong, base = [], [], None
    name = Path(scene).resolve().relative_to(TOP / "prm")
    for piece in advise(program, scene, settings, arguments.for_error,
                        arguments.seconds):
        base = base or run(program, scene, settings, arguments.seconds)
        changed = run(program, scene, (*settings, *piece.settings),
                      arguments.seconds)
        checks, fault = hold(piece, base, changed, arguments.for_error)
        if fault:
            wrong.append(f"{name}, {piece.what}: {fault}")
        largest = (f"{piece.quantity} {100 * piece.change:.3g} % until "
                   f"{piece.until:.3g} s" if piece.until else "")
        rows.append(f"| `{name}` | {', '.join(f'`{s}`' for s in piece.settings)}"
                    f" | {piece.judgement.lower()}: {piece.ground} "
                    f"| {piece.factor:.2g} | {cost(base) / cost(changed):.2g} "
                    f"| {largest} | {checks} |")
        print(rows[-1], flush=True)
    if not rows:
        rows.append(f"| `{name}` | nothing | | | | | |")
        print(rows[-1], flush=True)
    return rows, wrong


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", type=Path)
    parser.add_argument("--limber", default=str(TOP / "build/release/limber"))
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--for-error", type=float, default=0.01)
    parser.add_argument("--table", type=Path)
    arguments = parser.parse_args()
    scenes = arguments.scenes or [
        scene for folder in ("", "benchmarks", "verification")
        for scene in sorted((TOP / "prm" / folder).glob("*.prm"))]
    table = ["| scene | set | advice | factor in CPU time, advise | factor, run "
             "| largest change that advise measures | checks without to with it |",
             "| --- | --- | --- | --: | --: | --- | --- |"]
    wrong = []
    for scene in scenes:
        rows, faults = rows_of(arguments.limber, scene, arguments)
        table += rows
        wrong += faults
    if arguments.table:
        arguments.table.write_text("\n".join(table) + "\n")
    sys.exit(("FAILED: " + "; ".join(wrong)) if wrong else 0)


if __name__ == "__main__":
    main()
