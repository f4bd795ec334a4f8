#!/usr/bin/env python3
"""Kills a run at random moments and goes on with it.

    kills.py --limber build/release/limber --count 25 --seed 1

Each case is a run with checkpoints and pictures every few steps that SIGKILL
ends, two times out of three while a file is being written. It is resumed, or
begun anew where there was no checkpoint yet, and has to end with the table
and the pictures of an undisturbed run; the count is of those that are resumed.
Which moments they are follows from the seed, up to how fast the machine is.
"""

import argparse
import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
for folder in "restart", "mpi":
    sys.path.insert(0, str(TOP / "tests" / folder))
from compare_parts import read_series, read_table  # noqa: E402
from compare_ranks import differences  # noqa: E402

SINGLETON = {"OMPI_MCA_pml": "ob1",
             "OMPI_MCA_btl": "self,vader"}
CHANGES = ["End time=0.08", "Output/Time interval=0.004",
           "Output/Point arrays=true", "Checkpoint/Steps=4"]


def start(arguments, folder, *words):
    command = [arguments.limber, str(TOP / "tests/restart/two_dimensions.prm"),
               "--output-directory", str(folder), *words]
    for change in CHANGES:
        command += ["--set", change]
    return subprocess.Popen(command, env={**os.environ, **SINGLETON}, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def finish(process):
    said, _ = process.communicate()
    return process.returncode, said


def being_written(folder):
    return [path.name for name in ("checkpoint", "points", "grid")
            for path in (folder / name).glob("*.part")]


def kill_at_some_moment(process, folder, dice, seconds):
    """Says when. A third of them whenever it happens, else during a file; one
    in six from the start, else after the first checkpoint."""
    note = folder / "checkpoint" / "good_slot.txt"
    early = dice.random() < 1 / 6
    while not early and process.poll() is None and not note.exists():
        time.sleep(0.002)
    moment = time.time() + 0.6 * seconds * dice.random()
    during_file = dice.random() < 2 / 3
    seen = []
    while process.poll() is None:
        if time.time() > moment:
            seen = being_written(folder)
            if seen or not during_file:
                break
    process.kill()
    process.communicate()
    return seen[0] if seen else "no file"


def problems(whole, folder):
    names, reference = read_table(whole)
    others, rows = read_table(folder)
    if others != names or len(rows) != len(reference):
        yield f"other columns, or {len(rows)} rows instead of {len(reference)}"
        return
    for row, name, difference in differences(names, reference, rows):
        yield f"row {row}, {name}: {difference:.1e}"
    if read_series(folder)[0] != read_series(whole)[0]:
        yield "another series of pictures"
    if sorted(path.name for path in (folder / "points").iterdir()) != sorted(
            path.name for path in (whole / "points").iterdir()):
        yield "other files of points"


def one_case(arguments, whole, folder, dice, seconds):
    process = start(arguments, folder)
    when = kill_at_some_moment(process, folder, dice, seconds)
    if process.returncode != -9:
        return "ended before", []
    how = "resumed"
    code, said = finish(start(arguments, folder, "--resume"))
    if code == 1 and "has no checkpoint to go on from" in said:
        how = "begun anew"
        code, said = finish(start(arguments, folder, "--set",
                                  "Output/Replace=true"))
    if code != 0:
        return f"during {when}, not {how}: code {code}", [said]
    return f"during {when}, {how}", list(problems(whole, folder))


def main():
    parser = argparse.ArgumentParser(
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limber", required=True)
    parser.add_argument("--count", type=int, default=6)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    dice = random.Random(arguments.seed)

    failed = resumed = anew = 0
    with tempfile.TemporaryDirectory() as top:
        whole = Path(top) / "whole"
        begin = time.time()
        code, said = finish(start(arguments, whole))
        if code != 0:
            sys.exit(said)
        seconds = time.time() - begin
        while resumed + failed < arguments.count:
            folder = Path(top) / f"killed_{dice.random()}"
            text, found = one_case(arguments, whole, folder, dice, seconds)
            if text == "ended before":
                continue
            wrong = bool(found)
            failed += wrong
            resumed += not wrong and text.endswith("resumed")
            anew += not wrong and text.endswith("begun anew")
            print(f"killed {text}", *found[:5], sep="\n   ", flush=True)
    print(f"{resumed} resumed with the same table and pictures, {anew} begun "
          f"anew before a first checkpoint, {failed} failed")
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
