#!/usr/bin/env python3
"""Mutates scenes, studies, run folders and meshes and runs the program on them.

    fuzz.py --limber build/release/limber --count 60 --seed 1
    fuzz.py --limber build/release/limber --seed 1 --only 17

Whatever the input is, the program must end in time with a documented exit
code and a short message of its own (verdict.py). A mutant follows from seed
and number alone, and from the scenes of the tree; one that fails is kept with
the command that runs it again.
"""

import argparse
import multiprocessing
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import folder_damage
import mutants
import sandbox
import sources
import verdict


def healthy_run(limber, folder):
    """A run folder with checkpoints, to be damaged."""
    here = folder / "healthy"
    here.mkdir()
    subprocess.run(
        [limber, str(sources.TOP / folder_damage.SCENE),
         *mutants.settings(folder_damage.CHANGES),
         "--output-directory", "run"],
        cwd=here, env=sandbox.environment(), capture_output=True, check=False)
    if not list((here / "run/checkpoint").glob("*")):
        sys.exit(f"'{limber}' writes no checkpoint for {folder_damage.SCENE}")
    return here / "run"


def write(mutant, box, healthy):
    """The files of the mutant, and what was done to them, in words."""
    here = box / "here"
    here.mkdir(parents=True)
    for name, text in mutant.files.items():
        (here / name).parent.mkdir(parents=True, exist_ok=True)
        (here / name).write_bytes(text)
    if mutant.damage is None:
        return mutant.done
    shutil.copytree(healthy, here / "run")
    return mutant.damage(here / "run")


class Fuzzer:
    def __init__(self, arguments, work, healthy):
        self.arguments = arguments
        self.work = work
        self.healthy = healthy
        self.limits = (sandbox.SANITIZED if arguments.sanitized
                       else sandbox.Limits())

    def __call__(self, number):
        """Runs one mutant: number, what it is, outcome, complaints."""
        limber, seed = self.arguments.limber, self.arguments.seed
        mutant = mutants.make(limber, seed, number)
        box = self.work / f"{seed}_{number}"
        done = write(mutant, box, self.healthy)
        command = [limber, *mutant.words]
        (box / "command").write_text(
            f"# {mutant.kind} of {mutant.source}: {', '.join(done)}\n"
            f"cd here && {shlex.join(command)}\n")
        outcome = sandbox.run(command, box, self.limits)
        found = verdict.complaints(outcome, self.limits)
        if found:
            (box / "complaints").write_text("\n".join(found) + "\n")
        elif not self.arguments.keep:
            shutil.rmtree(box, ignore_errors=True)
        what = f"{mutant.kind} of {mutant.source}: {', '.join(done)}"
        return number, mutant.kind, what, command, outcome, found


def report(arguments, work, result):
    number, _, what, command, outcome, found = result
    if not found:
        if arguments.verbose:
            print(f"{number}: code {outcome.code}, {outcome.seconds:.1f} s, "
                  f"{what[:120]}", flush=True)
        return
    box = work / f"{arguments.seed}_{number}"
    print(f"\nmutant {number} of seed {arguments.seed}, {what[:300]}")
    for complaint in found:
        print(f"  FAILED: {complaint}")
    print(f"  kept in {box}; again by\n"
          f"    {sys.argv[0]} --limber {arguments.limber} --seed "
          f"{arguments.seed} --only {number}\n"
          f"    cd {box}/here && {shlex.join(command)[:500]}", flush=True)


def parse():
    parser = argparse.ArgumentParser(
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limber", required=True,
                        type=lambda path: str(Path(path).resolve()))
    parser.add_argument("--count", type=int, default=60,
                        help="how many mutants, from --first on")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, help="this mutant alone")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--work", type=Path,
                        help="where the mutants live and failing ones stay")
    parser.add_argument("--sanitized", action="store_true",
                        help="the program is built with sanitizers, which "
                             "take time and no end of addresses")
    parser.add_argument("--keep", action="store_true",
                        help="keep mutants that pass, too")
    parser.add_argument("--verbose", action="store_true")
    return parser.parse_args()


def main():
    arguments = parse()
    start = time.monotonic()
    work = Path(tempfile.mkdtemp(prefix="limber-fuzz-", dir=arguments.work))
    numbers = (range(arguments.first, arguments.first + arguments.count)
               if arguments.only is None else [arguments.only])
    fuzzer = Fuzzer(arguments, work, healthy_run(arguments.limber, work))
    codes, kinds, slowest, failed = Counter(), Counter(), (0, None), []
    with multiprocessing.Pool(arguments.jobs) as pool:
        for result in pool.imap_unordered(fuzzer, numbers):
            report(arguments, work, result)
            number, kind, _, _, outcome, found = result
            codes[outcome.code] += 1
            kinds[kind] += 1
            slowest = max(slowest, (outcome.seconds, number))
            if found:
                failed.append(number)
    print(f"{len(numbers)} mutants of seed {arguments.seed} in "
          f"{time.monotonic() - start:.0f} s: {len(failed)} failed "
          f"{sorted(failed) if failed else ''}\n"
          f"kinds {dict(sorted(kinds.items()))}, exit codes "
          f"{dict(sorted(codes.items()))}, slowest {slowest[0]:.1f} s "
          f"(mutant {slowest[1]})")
    if not failed and not arguments.keep:
        shutil.rmtree(work, ignore_errors=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
