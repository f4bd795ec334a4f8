#!/usr/bin/env python3
"""Checks the pages of the project: links, pictures and commands.

    check_pages.py [project folder] [--limber PROGRAM]
    check_pages.py --self-test

A link of a page must lead to a file, its anchor to a heading or an id there. What
stands in backquotes and looks like a file of the project must be there. In blocks of
shell commands scripts and scenes must be there, and options must be known. With
--limber, commands on scenes that come along are tried with --validate.
"""

import argparse
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"`([^`\n]+)`")
FILE = re.compile(r"(?:contrib|doc|include|prm|source|tests)/[\w./-]*[\w]")
PROGRAMS = {"contrib/limber", "build/release/limber", "limber"}
COMMANDS = {"reference", "compare", "study", "stability", "inf-sup", "advise",
            "plot", "animate"}
# What pages name as examples, or what a build or a run makes
MADE_UP = re.compile(r"^(runs|output|studies|build)/|scene\.prm$|study\.prm$|"
                     r"(disc|sill)\.prm$|ROOM|NAME|^X|my_")


def pages_of(root):
    return sorted([*root.glob("*.md"), *root.glob("doc/**/*.md"),
                   *root.glob("prm/**/*.md"), *root.glob("contrib/**/*.md")])


def slug(heading):
    """The anchor that a heading gets."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.strip().lower())
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def anchors_of(path):
    text = FENCE.sub("", path.read_text())
    headings = re.findall(r"^#+ +(.+)$", text, re.MULTILINE)
    return {slug(heading) for heading in headings} | set(
        re.findall(r'id="([^"]+)"', text))


def link_offences(page, text):
    for target in LINK.findall(FENCE.sub("", text)):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        path = (page.parent / name).resolve() if name else page
        if not path.exists():
            yield f"the link to '{target}' leads nowhere"
        elif anchor and path.suffix == ".md" and anchor not in anchors_of(path):
            yield f"'{name or page.name}' has no heading '#{anchor}'"


def name_offences(root, text):
    """Files in backquotes; sources may be named without their top folder."""
    for code in CODE.findall(FENCE.sub("", text)):
        if not FILE.fullmatch(code) or MADE_UP.search(code):
            continue
        if not (root / code).exists() and not list(
                (root / code).parent.glob(Path(code).name + ".*")):
            yield f"there is no '{code}'"


def commands_of(text):
    """The commands of the blocks of shell, each as a list of words."""
    for kind, block in FENCE.findall(text):
        if kind != "sh":
            continue
        for line in block.replace("\\\n", " ").splitlines():
            line = line.strip()
            if not line or line.startswith("#"):
                continue
            try:
                words = shlex.split(line, comments=True)
            except ValueError:
                continue  # a quotation over several lines
            while words and re.match(r"^\w+=", words[0]):
                words.pop(0)  # variables of the environment
            if words[:1] == ["mpirun"]:
                first = next((i for i, w in enumerate(words)
                              if w in PROGRAMS), None)
                words = words[first:] if first else []
            if words:
                yield words


def options_in(root):
    """All options that the program or its scripts read."""
    known = set()
    for path in [*root.glob("source/**/*.cc"), *root.glob("contrib/plot/*.py")]:
        known |= set(re.findall(r'"(--?[a-z][a-z-]*)[="]', path.read_text()))
    return known | {"-h", "--"}


def command_offences(root, words, known):
    program, alone = words[0], True
    if program in ("python3", "/usr/bin/python3"):
        words = words[1:]
        while words and words[0].startswith("-"):
            words = words[1:]
        program, alone = (words[0] if words else ""), False
    if program.startswith(("contrib/", "tests/")):
        path = root / program
        if not path.is_file():
            yield f"the command '{program}' is not there"
        elif alone and not path.stat().st_mode & 0o100:
            yield f"the command '{program}' is not executable"
    for word in words[1:]:
        if word.startswith(("prm/", "tests/")) and "$" not in word and (
                not MADE_UP.search(word)) and not (root / word).exists():
            yield f"the command '{program}' names '{word}', which is not there"
    if program in PROGRAMS:
        for word in words[1:]:
            option = word.split("=")[0]
            if word.startswith("-") and not re.match(r"-?[\d.]", word) and (
                    option not in known):
                yield f"the option '{option}' of '{program}' is not known"


def trial_of(root, words):
    """A command that shows whether the words would be taken; None: no such."""
    if words[0] not in PROGRAMS or any("$" in word for word in words):
        return None
    words = words[1:]
    if words and words[0] in COMMANDS - {"reference", "study", "stability"}:
        return None
    scenes = [w for w in words if w.endswith(".prm") and (root / w).exists()]
    if len(scenes) != 1 or "--resume" in words or "--frequencies" in words:
        return None
    return [*words, "--validate"]


def offences(root, limber=None):
    known = options_in(root)
    tried = 0
    for page in pages_of(root):
        text = page.read_text()
        name = page.relative_to(root)
        for offence in [*link_offences(page, text), *name_offences(root, text)]:
            yield f"{name}: {offence}"
        for words in commands_of(text):
            for offence in command_offences(root, words, known):
                yield f"{name}: {offence}"
            trial = trial_of(root, words) if limber else None
            if trial:
                tried += 1
                done = subprocess.run([limber, *trial], text=True, cwd=root,
                                      capture_output=True)
                if done.returncode != 0:
                    yield (f"{name}: '{shlex.join(words)}' is refused: "
                           f"{done.stderr.strip()}")
    if limber and tried < 20:
        yield f"only {tried} commands were tried: the pages are not understood"


def self_test():
    good = ("# A b\n[x](b.md#c-d) `source/a.cc`\n```sh\n"
            "contrib/limber prm/a.prm --set x\n```\n")
    cases = [
        ("good", good, None),
        ("file", "[x](none.md)", "leads nowhere"),
        ("anchor", "[x](b.md#none)", "no heading"),
        ("own anchor", "# A\n[x](#b)", "no heading"),
        ("name", "`source/none.cc`", "there is no"),
        ("script", "```sh\ncontrib/none x\n```", "is not there"),
        ("rights", "```sh\ncontrib/plain\n```", "not executable"),
        ("scene", "```sh\ncontrib/limber prm/b.prm\n```", "names 'prm/b.prm'"),
        ("option", "```sh\nlimber a.prm --non\n```", "'--non'"),
        ("in code", "```\n[x](none.md)\n```", None),
    ]
    for title, text, expected in cases:
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for name, content in (("a.md", text), ("b.md", "# C: d\n"),
                                  ("prm/a.prm", ""), ("contrib/plain", ""),
                                  ("contrib/limber", ""),
                                  ("source/a.cc", '"--set"')):
                path = root / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(content)
            (root / "contrib/limber").chmod(0o755)
            found = list(offences(root))
        right = not found if expected is None else (
            len(found) == 1 and expected in found[0])
        if not right:
            sys.exit(f"self-test '{title}' expected {expected}, found {found}")
    print(f"{len(cases)} cases as expected")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", nargs="?", type=Path,
                        default=Path(__file__).resolve().parents[2])
    parser.add_argument("--limber")
    parser.add_argument("--self-test", action="store_true")
    arguments = parser.parse_args()
    if arguments.self_test:
        self_test()
        return
    root = arguments.root.resolve()
    if not (root / "doc/index.md").is_file():
        sys.exit(f"check_pages: {root} holds no doc/index.md")
    found = list(offences(root, arguments.limber))
    for offence in found:
        print(offence)
    sys.exit(f"{len(found)} offences" if found else 0)


if __name__ == "__main__":
    main()
