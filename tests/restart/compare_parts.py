#!/usr/bin/env python3
"""Runs a scene in parts, each resumed from the one before, and at one go.

    compare_parts.py --limber build/release/limber \\
        --scene tests/restart/two_dimensions.prm --parts 1:limit 2:kill 3

A part is a number of ranks and what ends it: the wall time limit of the
scene ('limit'), a signal ('terminate', 'interrupt'; for one rank), or the loss
of the machine ('kill', all ranks at once). The last part runs to the end. All
rows of the statistics have to agree with those of the run at one go, within
the tolerance of tests/mpi/compare_ranks.py; so have the series of pictures and
the lines of health.
"""

import argparse
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "mpi"))
from compare_ranks import ENVIRONMENT, TOLERANCE, differences  # noqa: E402

SIGNALS = {"terminate": signal.SIGTERM, "interrupt": signal.SIGINT,
           "kill": signal.SIGKILL}
ENDS = {"terminate": 143, "interrupt": 130, "kill": -9, "limit": 143, "": 0}
ATTEMPTS = 10


def read_table(folder):
    names, rows = [], []
    for line in (folder / "statistics").read_text().splitlines():
        if line.startswith("#"):
            names.append(line.split(":", 1)[1].strip())
        else:
            rows.append([float(word) for word in line.split()])
    return names, rows


def read_series(folder):
    """Times and files of the pictures, and whether no others are there."""
    listed = []
    for series in "points", "grid":
        path = folder / (series + ".pvd")
        if path.exists():
            listed += re.findall(r'timestep="(.*?)".*file="(.*?)"',
                                 path.read_text())
    present = [path for name in ("points", "grid")
               for path in (folder / name).glob("*")]
    return listed, len(present) == len(listed)


def saved_step(folder):
    note = folder / "checkpoint" / "good_slot.txt"
    try:
        return int(re.search(r"step (\d+)", note.read_text()).group(1))
    except (OSError, AttributeError):
        return 0


def descendants(number):
    """Process numbers of all that a process has started, itself included."""
    children = Path(f"/proc/{number}/task/{number}/children")
    try:
        found = [int(word) for word in children.read_text().split()]
    except OSError:
        found = []
    return [number] + [each for child in found for each in descendants(child)]


def is_running(number):
    """A process that has ended but was not waited for holds no lock."""
    try:
        state = Path(f"/proc/{number}/stat").read_text().rpartition(")")[2]
    except OSError:
        return False
    return state.split()[0] not in "ZX"


def lose_the_machine(process):
    """Kills mpirun and its ranks; these would outlive it for a moment."""
    numbers = descendants(process.pid)
    for number in numbers:
        try:
            os.kill(number, signal.SIGKILL)
        except ProcessLookupError:
            pass
    while any(is_running(number) for number in numbers):
        time.sleep(0.002)


def run(arguments, folder, ranks, resume=False, end="", limit=0):
    """Returns the exit code; a part that is to be stopped makes ten steps."""
    command = [arguments.limber, arguments.scene,
               "--output-directory", str(folder)]
    for setting in arguments.set:
        command += ["--set", setting]
    if ranks > 1:
        command = ["mpirun", "-np", str(ranks)] + command
    if resume:
        command.append("--resume")
    if end == "limit":
        command += ["--set", f"Checkpoint/Wall time limit={limit}"]
    elif end:
        command += ["--set", "Checkpoint/Steps=7"]
    before = saved_step(folder)
    with open(folder.with_suffix(".txt"), "w") as output:
        process = subprocess.Popen(command, env={**os.environ, **ENVIRONMENT},
                                   stdout=output, stderr=subprocess.STDOUT)
        if end in SIGNALS:
            while process.poll() is None and saved_step(folder) < before + 10:
                time.sleep(0.002)
            if end == "kill":
                lose_the_machine(process)
            else:
                process.send_signal(SIGNALS[end])
        return process.wait()


def run_part(arguments, folder, number, part, seconds):
    """A part that ends before it could be stopped is done once more."""
    ranks, _, end = part.partition(":")
    former = folder.with_suffix(".former")
    if number > 0:
        shutil.copytree(folder, former)
    for attempt in range(ATTEMPTS):
        limit = seconds / len(arguments.parts) / 2 ** attempt
        code = run(arguments, folder, int(ranks), number > 0, end, limit)
        if code == ENDS[end]:
            break
        if code != 0:
            sys.exit(f"part {part}: exit code {code}\n"
                     + folder.with_suffix(".txt").read_text())
        shutil.rmtree(folder)
        if number > 0:
            shutil.copytree(former, folder)
    else:
        sys.exit(f"part {part} was never stopped before its end")
    shutil.rmtree(former, ignore_errors=True)


def compare_health(whole, parts):
    """Lines that differ: what is counted since the start counts on."""
    read = [json.loads((folder / "summary.json").read_text())["health"]
            for folder in (whole, parts)]
    for one, other in zip(*read, strict=True):
        bound = 1e-3 * abs(one["value"]) + 1e-9
        if one["name"] != other["name"] or one["verdict"] != other["verdict"] \
                or not abs(one["value"] - other["value"]) <= bound:
            yield f"health: {other} instead of {one}"


def compare(arguments, whole, parts):
    names, reference = read_table(whole)
    other_names, rows = read_table(parts)
    if other_names != names or len(rows) != len(reference):
        yield f"other columns, or {len(rows)} rows instead of {len(reference)}"
        return
    for row, name, difference in differences(names, reference, rows,
                                             arguments.tolerance):
        yield f"row {row}, {name}: {difference:.1e}"
    yield from compare_health(whole, parts)
    if read_series(parts) != read_series(whole):
        yield "another series of pictures"
    if (parts / "log.txt").read_text().count("Resumed after step") != \
            len(arguments.parts) - 1:
        yield "the log does not tell of each time"


def main():
    parser = argparse.ArgumentParser(
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limber", required=True)
    parser.add_argument("--scene", required=True)
    parser.add_argument("--tolerance", type=float, default=TOLERANCE,
                        help="instead of 1e-10, where a solver iterates")
    parser.add_argument("--parts", nargs="+", required=True)
    parser.add_argument("--set", action="append", default=[])
    arguments = parser.parse_args()

    with tempfile.TemporaryDirectory() as top:
        whole, parts = Path(top) / "whole", Path(top) / "parts"
        if run(arguments, whole, 1) != 0:
            sys.exit(whole.with_suffix(".txt").read_text())
        seconds = json.loads((whole / "summary.json").read_text())[
            "wall_seconds"]
        for number, part in enumerate(arguments.parts):
            run_part(arguments, parts, number, part, seconds)
        problems = list(compare(arguments, whole, parts))
        n_rows = len(read_table(whole)[1])
    for problem in problems[:20]:
        print(problem)
    print(f"{n_rows} rows of {' '.join(arguments.parts)}"
          + (" differ" if problems else " agree"))
    sys.exit(bool(problems))


if __name__ == "__main__":
    main()
