#!/usr/bin/env python3
"""The fuzzer itself: programs that misbehave in one way each are found out,
those that behave are not, and mutants follow from seed and number alone.

    self_test.py
"""

import sys
import tempfile
from pathlib import Path

import mutants
import sandbox
import sources
import verdict
from draws import Draws

LIMITS = sandbox.Limits(asked_to_stop=1.5, stopped=1, memory=120 << 20,
                        file_size=1 << 20)
GOOD = ("Error: The value 'a' of entry 'b' is not admissible. Usually a digit "
        "is mistyped. Write 1, for instance.")


def says(text, code, stream="stderr"):
    return (f"import sys; sys.{stream}.write({text!r} + chr(10)); "
            f"sys.exit({code})")


BEHAVES = {
    "success": "print('2 steps')",
    "refusal": says(GOOD, 1),
    "warnings": says("Warning: " + 20 * "word ", 0, "stdout"),
    "check missed": "import sys; sys.exit(4)",
    "its own folder": "import os; os.mkdir('run'); open('run/log', 'w')",
    "stops when asked": "import signal, sys, time; signal.signal("
                        "signal.SIGTERM, lambda *_: sys.exit(143)); "
                        "time.sleep(60)"}

MISBEHAVES = {
    "SIGSEGV": "import os; os.kill(os.getpid(), 11)",
    "SIGABRT": "import os; os.abort()",
    "died of SIGTERM": "import time; time.sleep(60)",
    "had to be killed": "import signal, time; signal.signal(signal.SIGTERM, "
                        "signal.SIG_IGN); time.sleep(60)",
    "exit code 7": says(GOOD, 7),
    "exit code 134": says(GOOD, 134),
    "raw words: bad_alloc": says("Error: " + 8 * "a " + "std::bad_alloc", 2),
    "raw words: terminate called": says("terminate called after", 2),
    "raw words: dealii::": says(GOOD + " in dealii::Triangulation", 1),
    "rule of dashes": says("----------\nAn error", 1),
    "message of 60 words": says("Error:" + 60 * " word", 1),
    "warning: message of 60 words": says("Warning:" + 60 * " word", 0,
                                         "stdout"),
    "word of 300 letters": says(GOOD + " " + "a" * 300, 1),
    "several lines": says(GOOD + "\nand more", 1),
    "control byte": says(GOOD + " \x1b[2J", 1),
    "no UTF-8": "import sys; sys.stderr.buffer.write("
                + repr(GOOD.encode() + b"\xff") + "); sys.exit(1)",
    "exit code 3 with 0": says("all is well", 3, "stdout"),
    "exit code 1 with 2": says(GOOD + "\n" + GOOD, 1),
    "exit code 0 with an error": says(GOOD, 0),
    "hardly a message": says("Error: no", 1),
    "noise": says("libfabric: cannot open", 0),
    "MiB of memory": "a = bytearray(200 << 20)",
    "SIGXFSZ": "import signal; signal.signal(signal.SIGXFSZ, "
               "signal.SIG_DFL); open('run', 'wb').write(bytes(2 << 20))",
    "outside its folder: here/other": "open('other', 'w')",
    "outside its folder: neighbour": "open('../neighbour', 'w')",
    "outside its folder: here/scene.prm": "open('scene.prm', 'w')"}


def found_in(program):
    with tempfile.TemporaryDirectory(prefix="limber-fuzz-") as folder:
        box = Path(folder)
        (box / "here").mkdir()
        (box / "here/scene.prm").write_text("set Dimension = 2\n")
        outcome = sandbox.run([sys.executable, "-c", program], box, LIMITS)
        return verdict.complaints(outcome, LIMITS)


def check_programs():
    failed = []
    for name, program in BEHAVES.items():
        found = found_in(program)
        if found:
            failed.append(f"'{name}' is well-behaved, but: {found}")
    for name, program in MISBEHAVES.items():
        found = found_in(program)
        if not any(name.replace("warning: ", "") in text for text in found):
            failed.append(f"'{name}' was not found out, but: {found}")
    return failed


def without_damage(mutant):
    return mutant._replace(damage=None)


def check_mutants():
    """Neither the order nor what was made before may change a mutant."""
    failed = []
    if [Draws("limber fuzz", 1, 0).below(1000)
            for _ in range(2)] != [FIRST_DRAW] * 2:
        failed.append("random choices are not those of other machines")
    sources.printed_entries = lambda _, scene: [
        entry._replace(admissible="a number")
        for entry in sources.parse(sources.read(scene).decode())]
    numbers = range(150)
    forward = [without_damage(mutants.make("", 5, n)) for n in numbers]
    backward = [without_damage(mutants.make("", 5, n))
                for n in reversed(numbers)]
    if forward != backward[::-1]:
        failed.append("mutants depend on the order in which they are made")
    if {mutant.kind for mutant in forward} != set(mutants.KINDS):
        failed.append("150 mutants are not of all kinds")
    other = [without_damage(mutants.make("", 6, n)) for n in numbers]
    if sum(one == two for one, two in zip(forward, other)) > 15:
        failed.append("another seed gives the same mutants")
    return failed


FIRST_DRAW = 313


def main():
    failed = check_programs() + check_mutants()
    for text in failed:
        print("FAILED:", text)
    print(f"{len(BEHAVES) + len(MISBEHAVES)} programs judged, "
          f"{len(failed)} failures")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
