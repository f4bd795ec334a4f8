"""What is mutated: the scenes and studies of the tree, and their entries."""

import functools
import re
import subprocess
from pathlib import Path
from typing import NamedTuple

from sandbox import environment

TOP = Path(__file__).resolve().parents[2]


class Entry(NamedTuple):
    section: tuple  # names of the sections around it, outermost first
    name: str
    value: str
    admissible: str  # in the words of the program, "" if not known

    @property
    def path(self):
        return "/".join((*self.section, self.name))


@functools.lru_cache(maxsize=None)
def all_files():
    """Paths from the top of the tree, in the same order everywhere."""
    return sorted(path.relative_to(TOP).as_posix()
                  for folder in ("prm", "tests")
                  for path in (TOP / folder).glob("**/*.prm"))


def is_study(path):
    return path.startswith("prm/studies/") and "/scenes/" not in path


def scenes():
    return [path for path in all_files() if not is_study(path)]


def studies():
    return [path for path in all_files() if is_study(path)]


def read(path):
    return (TOP / path).read_bytes()


def parse(text):
    """Entries of a prm text; comments that precede them say the range."""
    entries, section, comment = [], [], ""
    for line in text.splitlines():
        line = line.strip()
        if line.startswith("#"):
            comment += " " + line[1:].strip()
            continue
        line = re.sub(r"\s#.*$", "", line).strip()
        if line.startswith("subsection "):
            section.append(line[len("subsection "):].strip())
        elif line == "end":
            section.pop()
        elif line.startswith("set "):
            name, _, value = line[len("set "):].partition("=")
            _, _, admissible = comment.partition("Range: ")
            entries.append(Entry(tuple(section), name.strip(), value.strip(),
                                 admissible.rstrip(".")))
        comment = ""
    return entries


@functools.lru_cache(maxsize=None)
def printed_entries(limber, scene):
    """All entries of a scene with values and ranges, as the program says."""
    printed = subprocess.run([limber, "--print-parameters", "prm",
                              str(TOP / scene)],
                             env=environment(), capture_output=True, text=True,
                             timeout=60, check=True)
    return parse(printed.stdout)
