#!/usr/bin/env python3
"""Runs the short version of a study and checks its table.

    run_study.py --limber PROGRAM [--command stability] STUDY --expect "cell, 4:
        frequency error<=0.02" ...

A condition names a variant as the program does, a column of study.csv, and a
comparison with a number or, with '==', a word. Every variant must have been
run, and table, Markdown and what a chart needs must be there.
"""

import argparse
import csv
import json
import operator
import re
import subprocess
import sys
import tempfile
from pathlib import Path

COMPARE = {"<=": operator.le, ">=": operator.ge, "==": operator.eq}


def read_rows(folder):
    """The rows of study.csv by the names of their variants."""
    with open(folder / "study.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    meta = json.loads((folder / "study.json").read_text())
    return {", ".join([row["method"]] + [row[v] for v in meta["variations"]]): row
            for row in rows}


def check(text, rows):
    """What is wrong with a condition, or nothing."""
    match = re.fullmatch(r"(.+?): (.+?)(<=|>=|==)(.+)", text)
    variant, column, comparison, bound = match.groups()
    if variant not in rows or column not in rows[variant]:
        return f"{text}: no such variant or column"
    value = rows[variant][column]
    if comparison == "==":
        return None if value == bound else f"{text}: it is {value}"
    return (None if COMPARE[comparison](float(value), float(bound))
            else f"{text}: it is {value}")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study")
    parser.add_argument("--limber", required=True)
    parser.add_argument("--command", default="study")
    parser.add_argument("--full", action="store_true")
    parser.add_argument("--expect", nargs="+", action="extend", default=[])
    arguments = parser.parse_args()

    with tempfile.TemporaryDirectory(prefix="limber-") as name:
        folder = Path(name) / "study"
        command = [arguments.limber, arguments.command, arguments.study,
                   "--output-directory", str(folder)]
        if not arguments.full:
            command.append("--short")
        done = subprocess.run(command, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT)
        print(done.stdout)
        problems = []
        if done.returncode != 0:
            problems.append(f"exit code {done.returncode}")
        else:
            rows = read_rows(folder)
            problems += filter(None, (check(text, rows)
                                      for text in arguments.expect))
            table = (folder / "study.md").read_text()
            problems += [f"no chart: {name}" for name in ("study.svg",)
                         if not (folder / name).exists()
                         and "No chart was drawn" not in done.stdout]
            if table.count("\n|") < len(rows) + 1:
                problems.append("rows are missing in study.md")
    for problem in problems:
        print("FAILED:", problem)
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
