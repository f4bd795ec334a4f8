#!/usr/bin/env python3
"""What is left when a run with checkpoints fails, and what is refused.

    failures.py --limber build/release/limber \\
        --scene tests/restart/two_dimensions.prm

With --case only what is named; --set changes entries of the scene.
"""

import argparse
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

SINGLETON = {"OMPI_MCA_pml": "ob1",
             "OMPI_MCA_btl": "self,vader"}


def small_files_only():
    """As on a full disk: no file of this process gets beyond 100 kB."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))


class Runs:
    def __init__(self, arguments, folder):
        self.arguments = arguments
        self.folder = folder

    def expect(self, code, words, *changes, resume=False, disk_full=False):
        """Runs the scene; the code and the words of the message must fit."""
        command = [self.arguments.limber, self.arguments.scene,
                   "--output-directory", str(self.folder)]
        for change in (*self.arguments.set, *changes):
            command += ["--set", change]
        if resume:
            command.append("--resume")
        result = subprocess.run(
            command, env={**os.environ, **SINGLETON}, capture_output=True,
            text=True, preexec_fn=small_files_only if disk_full else None)
        if result.returncode != code or words not in result.stderr:
            sys.exit(f"{' '.join(command)}\nexit code {result.returncode} "
                     f"instead of {code}, or nowhere said: {words}\n"
                     + result.stdout + result.stderr)

    def checkpoint(self):
        return {path.name: path.read_bytes()
                for path in (self.folder / "checkpoint").glob("*")}


def check(holds, what):
    if not holds:
        sys.exit(f"does not hold: {what}")


def folder_is_taken(runs):
    runs.folder.mkdir()
    (runs.folder / "checkpoint").write_text("not a folder")
    runs.expect(1, "'checkpoint' belongs to something that a run does not "
                "write", "Checkpoint/Steps=5")


def disk_is_full(runs):
    runs.expect(143, "", "Checkpoint/Steps=20",
                "Checkpoint/Wall time limit=0.05")
    before = runs.checkpoint()
    runs.expect(3, "File too large", "Checkpoint/Steps=20",
                "Output/Time interval=0", resume=True, disk_full=True)
    check(runs.checkpoint() == before, "the former checkpoint is unharmed")
    runs.expect(0, "", resume=True)


def other_scene(runs):
    runs.expect(143, "", "Checkpoint/Wall time limit=0.05")
    runs.expect(1, "'Method/Courant number = 0.3', the checkpoint "
                "'Method/Courant number = 0.4'", "Method/Courant number=0.3",
                resume=True)
    runs.expect(0, "", "End time=0.21", "Output/Statistics interval=9",
                "Checkpoint/Steps=0", resume=True)
    before = runs.checkpoint()
    runs.expect(1, "'End time' is 0.2 s, but", "End time=0.2", resume=True)
    check(runs.checkpoint() == before, "the checkpoint of 0.21 s is unharmed")


def nothing_to_resume(runs):
    runs.expect(1, "has no checkpoint to go on from", resume=True)
    runs.expect(143, "", "Checkpoint/Wall time limit=0.05")
    for slot in (runs.folder / "checkpoint").glob("slot_*"):
        slot.write_bytes(slot.read_bytes()[:1000])
    runs.expect(3, "slot_0.h5 has 1000 bytes instead of", resume=True)


def unstable(runs):
    """No picture was asked for, but the last state is there."""
    runs.expect(2, "The last state is the last picture in",
                "Output/Time interval=0", "Checkpoint/Steps=1",
                "Method/Courant number=3")
    for series in "points", "grid":
        check((runs.folder / (series + ".pvd")).exists(), series)
        check(len(list((runs.folder / series).glob("*.vtu"))) == 1,
              f"one piece of {series}")
    summary = json.loads((runs.folder / "summary.json").read_text())
    check("The last checkpoint, of step" in summary["message"],
          "the summary names the checkpoint")


CASES = {case.__name__: case
         for case in (folder_is_taken, disk_is_full, other_scene,
                      nothing_to_resume, unstable)}


def main():
    parser = argparse.ArgumentParser(
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limber", required=True)
    parser.add_argument("--scene", required=True)
    parser.add_argument("--set", metavar="NAME=VALUE", action="append",
                        default=[])
    parser.add_argument("--case", choices=CASES, action="append")
    arguments = parser.parse_args()
    for name in arguments.case or CASES:
        print(name, flush=True)
        with tempfile.TemporaryDirectory() as folder:
            CASES[name](Runs(arguments, Path(folder) / "run"))


if __name__ == "__main__":
    main()
