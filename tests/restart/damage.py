#!/usr/bin/env python3
"""Damages the checkpoints of a run in every way, and resumes it.

    damage.py --limber build/release/limber \\
        --scene tests/restart/two_dimensions.prm --count 25

A run to step 14 is resumed and ends at step 17, so that its slots hold these
two steps. In a copy, single bits are flipped (--count times in each array, in
HDF5's tables, in the seal and in the note), files are cut, lost, exchanged, or
forged with valid checksums; then the copy is resumed. Three things may happen:
exactly the results of a run that is resumed from the step that the program
names, with a warning where that is not what the note asked for; or an error
message that names the file. What is flipped follows from --seed.
"""

import argparse
import collections
import os
import random
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from compare_parts import read_series
from failures import SINGLETON

CHANGES = ["Grid/Cells=20, 20", "Method/Transfer=apic", "Checkpoint/Steps=7",
           "Output/Time interval=0.008", "Output/Statistics interval=1"]
OLDER, NEWER, END = 14, 17, 20
LONGEST = 60  # words of a message


class Sealed:
    """A slot: the seal in front of it, taken to pieces and put together."""

    def __init__(self, path):
        self.path = path
        self.bytes = bytearray(path.read_bytes())
        start = re.match(rb"Limber checkpoint, format (\d+)\n"
                         rb"seal ([0-9a-f]{8}) of (\d+) bytes\n", self.bytes)
        if not start:
            sys.exit(f"{path} has no seal")
        self.seal, self.room = start.start(2), int(start.group(3))
        text = bytes(self.bytes[:self.room]).decode()
        self.arrays = {}
        for line in re.finditer(r"^([0-9a-f]{8}) (\d+) (\d+) (.*)$", text,
                                re.MULTILINE):
            self.arrays[line.group(4)] = (int(line.group(2)),
                                          int(line.group(3)), line.start(1))

    def checksums(self):
        return {name: bytes(self.bytes[place:place + 8])
                for name, (_, _, place) in self.arrays.items()
                if name.startswith("body")}

    def regions(self):
        """Name, and the ranges of bytes that have it."""
        result = {name: [(begin, begin + size)]
                  for name, (begin, size, _) in self.arrays.items() if size}
        tables, begin = [], self.room
        for ranges in sorted(result.values()):
            if ranges[0][0] > begin:
                tables.append((begin, ranges[0][0]))
            begin = ranges[0][1]
        if len(self.bytes) > begin:
            tables.append((begin, len(self.bytes)))
        result["HDF5's tables"] = tables
        text = len(self.bytes[:self.room].rstrip())
        result["the seal"] = [(0, text)]
        result["the room behind the seal"] = [(text, self.room)]
        return result

    def forge(self, name, offset, content):
        """Other bytes in an array, with a seal that fits them."""
        begin, size, line = self.arrays[name]
        self.bytes[begin + offset:begin + offset + len(content)] = content
        self.bytes[line:line + 8] = b"%08x" % zlib.crc32(
            self.bytes[begin:begin + size])
        self.write()

    def write(self):
        """Seal it anew, and tell the note, which is right then."""
        self.bytes[self.seal:self.seal + 8] = b"00000000"
        own = b"%08x" % zlib.crc32(self.bytes[:self.room])
        self.bytes[self.seal:self.seal + 8] = own
        self.path.write_bytes(self.bytes)
        note = self.path.parent / "good_slot.txt"
        text = re.sub(rb"seal \w+", b"seal " + own, note.read_bytes())
        text = text[:text.index(b"checksum")]
        note.write_bytes(text + b"checksum %08x\n" % zlib.crc32(text))


class Runs:
    def __init__(self, arguments, top):
        self.arguments, self.top = arguments, Path(top)

    def command(self, folder, end, *changes, resume=False):
        command = [self.arguments.limber, self.arguments.scene,
                   "--output-directory", str(folder)]
        for change in [*CHANGES, f"End step={end}", *changes]:
            command += ["--set", change]
        return command + (["--resume"] if resume else [])

    def environment(self, folder):
        """Two runs at a time must not remove each other's files of MPI."""
        folder = folder.with_suffix(".mpi")
        folder.mkdir(exist_ok=True)
        return {**os.environ, **SINGLETON,
                "OMPI_MCA_orte_tmpdir_base": str(folder)}

    def run(self, folder, *arguments, **options):
        return subprocess.run(self.command(folder, *arguments, **options),
                              env=self.environment(folder), text=True,
                              capture_output=True, timeout=300)

    def need(self, *arguments, **options):
        result = self.run(*arguments, **options)
        if result.returncode != 0:
            sys.exit(result.stdout + result.stderr)

    def prepare(self):
        """Folders with good checkpoints, and what comes out of them."""
        self.newer, older = self.top / "newer", self.top / "older"
        self.need(older, OLDER)
        shutil.copytree(older, self.newer)
        self.need(self.newer, NEWER, resume=True)
        self.older = older
        self.need(self.top / "stranger", NEWER)
        self.need(self.top / "other scene", NEWER, "Loads/Gravity=0, -5")
        self.expected = {}
        for folder, step in (older, OLDER), (self.newer, NEWER):
            shutil.copytree(folder, self.top / str(step))
            self.need(self.top / str(step), END, resume=True)
            self.expected[step] = outcome(self.top / str(step))

    def try_one(self, number, damage):
        """What comes of it: a word, or a text that tells what is wrong."""
        folder = self.top / f"case_{number}"
        shutil.copytree(self.newer, folder)
        damage(folder)
        try:
            result = self.run(folder, END, resume=True)
        except subprocess.TimeoutExpired:
            return "hangs"
        verdict = self.judge(folder, result)
        shutil.rmtree(folder)
        return verdict

    def judge(self, folder, result):
        text = result.stderr + result.stdout
        if re.search("HDF5-DIAG|boost|terminate called|bad_alloc|MPI_ABORT",
                     text) or result.returncode < 0:
            return f"raw: exit code {result.returncode}: {text}"
        told = re.findall(r"^Error: .*|^Warning: In .*", text, re.MULTILINE)
        for line in told if result.returncode in (0, 1, 3) else []:
            if len(line.split()) > LONGEST:
                return f"{len(line.split())} words: {line}"
        if result.returncode in (1, 3):
            named = told and "checkpoint" in told[0]
            return "refused" if named else "nothing is named: " + text
        if result.returncode != 0:
            return f"exit code {result.returncode}: {text}"
        warned = re.search(r"Warning: In '.*checkpoint', .*(?:slot|note).*"
                           r"goes on from slot_\d.h5, step (\d+)", text)
        step = int(re.search(r"Resumed after step (\d+)", text).group(1))
        if warned and int(warned.group(1)) != step:
            return "warns of another step: " + text
        try:
            same = outcome(folder) == self.expected.get(step)
        except ValueError:
            same = False  # files that are no text any more
        if not same:
            return f"other results from step {step}: {text}"
        if not warned and step != NEWER:
            return f"nothing said, from step {step}"
        return (f"warned, from step {step}" if warned else "harmless")


def outcome(folder):
    """All that a run leaves, but for its clock."""
    note = (folder / "checkpoint/good_slot.txt").read_text().split("\n")
    pictures, complete = read_series(folder)
    return ((folder / "statistics").read_bytes(), pictures, complete,
            Sealed(folder / "checkpoint" / note[0]).checksums())


def good_slot(folder):
    checkpoint = folder / "checkpoint"
    return checkpoint / (checkpoint / "good_slot.txt").read_text().split()[0]


def flip(path, begin, bit):
    content = bytearray(path.read_bytes())
    content[begin] ^= 1 << bit
    path.write_bytes(content)


def flips(runs, chance, count):
    """Single bits, in the slot that the note names and in the note."""
    regions = {name: (good_slot(runs.newer).name, ranges) for name, ranges
               in Sealed(good_slot(runs.newer)).regions().items()}
    note = (runs.newer / "checkpoint/good_slot.txt").stat().st_size
    regions["the note"] = ("good_slot.txt", [(0, note)])
    for name, (file, ranges) in regions.items():
        for _ in range(count):
            begin, end = chance.choices(
                ranges, [end - begin for begin, end in ranges])[0]
            place, bit = chance.randrange(begin, end), chance.randrange(8)
            yield f"bit of {name}", lambda folder, f=file, p=place, b=bit: \
                flip(folder / "checkpoint" / f, p, b)


def cuts(runs, chance, count):
    """Files that end too early or go on, are empty or not there."""
    def cut(name, length):
        def damage(folder):
            with open(folder / "checkpoint" / name, "r+b") as file:
                file.truncate(length)
        return damage

    for name in good_slot(runs.newer).name, "good_slot.txt":
        size = (runs.newer / "checkpoint" / name).stat().st_size
        for length in [0, 1, size - 1, size + 1] + [
                chance.randrange(size) for _ in range(count)]:
            yield f"length of {name}", cut(name, length)
        yield f"{name} is gone", lambda folder, n=name: \
            (folder / "checkpoint" / n).unlink()

    def becomes(name, make):
        def damage(folder):
            (folder / "checkpoint" / name).unlink()
            make(folder / "checkpoint" / name)
        return damage

    for name in good_slot(runs.newer).name, "good_slot.txt":
        yield f"refused: {name} is a folder", becomes(name, os.mkdir)
        yield f"refused: {name} is a pipe", becomes(name, os.mkfifo)

    def both(folder):
        for path in (folder / "checkpoint").glob("slot_*"):
            flip(path, path.stat().st_size // 2, 3)
    yield "refused: a bit of both slots", both


def exchanges(runs, chance, count):
    """Whole and sound files in the wrong place."""
    del chance, count
    good = good_slot(runs.newer).name
    other = good_slot(runs.older).name

    def swap(folder):
        checkpoint = folder / "checkpoint"
        (checkpoint / good).rename(checkpoint / "third")
        (checkpoint / other).rename(checkpoint / good)
        (checkpoint / "third").rename(checkpoint / other)
    yield "slots swapped", swap

    def copy(source, *names):
        def damage(folder):
            for name in names:
                shutil.copy(source / name, folder / "checkpoint" / name)
        return damage

    older = runs.older / "checkpoint"
    stranger = runs.top / "stranger/checkpoint"
    yield "slot of an earlier step", copy(older, good)
    yield "note of an earlier step", copy(older, "good_slot.txt")
    yield "slot of another run", copy(stranger, good)
    yield "refused: slots of another run", copy(stranger, good, other)
    yield "refused: note of another run", copy(stranger, "good_slot.txt")
    for what, names in (
            ("slot of another scene", [good]),
            ("refused: all of another scene", [good, other, "good_slot.txt"])):
        yield what, copy(runs.top / "other scene/checkpoint", *names)

    def same_twice(folder):
        shutil.copy(folder / "checkpoint" / other, folder / "checkpoint" / good)
    yield "the older slot twice", same_twice

    def without_note(folder):
        swap(folder)
        (folder / "checkpoint/good_slot.txt").unlink()
    yield "slots swapped without a note", without_note


def forgeries(runs, chance, count):
    """Contents that no run writes, with checksums that fit them."""
    def forge(name, offset, content):
        return lambda folder: Sealed(good_slot(folder)).forge(
            name, offset, content)

    def number(value):
        return struct.pack("d" if isinstance(value, float) else "Q", value)

    nan, many = number(float("nan")), number(10 ** 12)
    yield "not a number", forge("body 0/velocity x", 80, nan)
    yield "infinite", forge("body 1/pressure", 8, number(float("inf")))
    yield "no mass", forge("body 1/mass", 16, number(0.))
    yield "a cell beyond the grid", forge("body 0/cell", 8, many)
    yield "the wrong cell", forge("body 0/cell", 8, number(0))
    yield "a point that never was", forge("body 1/id", 0, many)
    size = Sealed(good_slot(runs.newer)).arrays["run"][1]
    for _ in range(count + 2):
        yield "told or not: forged state", forge(
            "run", chance.randrange(size - 8), chance.randbytes(8))

    def older_format(folder):
        for path in (folder / "checkpoint").glob("slot_*"):
            path.write_bytes(path.read_bytes()[Sealed(path).room:])
        note = folder / "checkpoint/good_slot.txt"
        note.write_text("".join(note.read_text().splitlines(True)[:2]))
    yield "refused: an older format", older_format

    def newer_format(folder):
        for path in (folder / "checkpoint").glob("slot_*"):
            slot = Sealed(path)
            slot.bytes[slot.bytes.index(b"\n") - 1] += 1
            slot.write()
    yield "refused: a newer format", newer_format


def left_overs(runs, chance, count):
    """What a run leaves that has been killed, and a table of another length."""
    del chance, count

    def part(folder):
        for name in "slot_0.h5.part", "slot_1.h5.part", "good_slot.txt.part":
            (folder / "checkpoint" / name).write_bytes(b"half")
    yield "partial files", part

    def shorten(length):
        def damage(folder):
            with open(folder / "statistics", "r+b") as file:
                file.truncate(length)
        return damage

    length = (runs.older / "statistics").stat().st_size
    yield "rows of the older slot only", shorten(length)
    yield "refused: too few rows", shorten(length - 1)


def kill(runs, number):
    """A run that writes in every step is killed, and goes on."""
    chance = random.Random(f"{runs.arguments.seed} {number}")
    folder = runs.top / f"killed {number}"
    process = subprocess.Popen(
        runs.command(folder, 10 ** 6, "Checkpoint/Steps=1", "End time=1000",
                     "Output/Time interval=0"),
        env=runs.environment(folder), stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL)
    note = folder / "checkpoint/good_slot.txt"
    while process.poll() is None and not note.exists():
        time.sleep(0.002)
    time.sleep(chance.uniform(0, 0.1))
    process.send_signal(signal.SIGKILL)
    process.wait()
    writing = any((folder / "checkpoint").glob("*.part"))
    step = int(re.search(r"step (\d+)", note.read_text()).group(1))
    result = runs.run(folder, step + 3, "End time=1000",
                      "Output/Time interval=0", resume=True)
    shutil.rmtree(folder)
    if result.returncode != 0 or "Warning: In" in result.stdout:
        return result.stdout + result.stderr
    return "killed while writing" if writing else "killed"


def wanted(verdict, what):
    if what.startswith("told or not: "):
        return not verdict.startswith(("hangs", "raw"))
    if what.startswith("refused: "):
        return verdict == "refused"
    return verdict.startswith(("warned", "harmless"))


def report(cases, verdicts):
    """One line per verdict; the number of those that must not be."""
    counts, bad = collections.Counter(), 0
    for (what, _), verdict in zip(cases, verdicts):
        if wanted(verdict, what):
            kind = ("bits" if what.startswith("bit") else
                    "forged" if what.startswith("told") else "others")
            counts[kind, verdict.split(":")[0]] += 1
        else:
            bad += 1
            print(f"{what}: {verdict}")
    for (kind, verdict), n in sorted(counts.items()):
        print(f"{kind:8}{n:6}  {verdict}")
    return bad


def main():
    parser = argparse.ArgumentParser(
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limber", required=True)
    parser.add_argument("--scene", required=True)
    parser.add_argument("--count", type=int, default=3)
    parser.add_argument("--kills", type=int, default=2)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    chance = random.Random(arguments.seed)
    with tempfile.TemporaryDirectory() as top:
        runs = Runs(arguments, top)
        runs.prepare()
        cases = [case for make in (flips, cuts, exchanges, forgeries,
                                   left_overs)
                 for case in make(runs, chance, arguments.count)]
        with ThreadPoolExecutor(2) as pool:
            verdicts = list(pool.map(
                lambda case: runs.try_one(case[0], case[1][1]),
                enumerate(cases)))
            killed = list(pool.map(lambda n: kill(runs, n),
                                   range(arguments.kills)))
        bad = report(cases, verdicts)
    for verdict, n in collections.Counter(killed).items():
        print(f"runs    {n:6}  {verdict}")
        bad += not verdict.startswith("killed")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
