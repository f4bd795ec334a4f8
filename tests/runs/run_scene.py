#!/usr/bin/env python3
"""Runs one scene in a temporary folder and checks what came of it.

    run_scene.py --limber build/release/limber --scene prm/dam_break.prm \\
        --set "End time=0.1" --ranks 2 \\
        --expect "summary.steps<=5000" "checks.front at T=3.passed"

An expectation is a path into summary.json and, unless the value itself is
true or false, a comparison with ==, !=, <=, >=, < or >. 'summary.' leads to
the top of that file, 'checks.NAME.' into the check of this name. Names may
hold blanks and dots. What the program says, but does not write into that file,
is compared with --expect-said: words of it with # in the place of the number,
and a comparison.

    --expect-said "iterations a step, at most #<=5"
"""

import argparse
import json
import operator
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

NUMBER = r"([-+]?[0-9]+(?:[.][0-9]+)?(?:e[-+]?[0-9]+)?)"
OPERATORS = {"==": operator.eq, "!=": operator.ne, "<=": operator.le,
             ">=": operator.ge, "<": operator.lt, ">": operator.gt}

SINGLETON = {"OMPI_MCA_pml": "ob1",
             "OMPI_MCA_btl": "self,vader"}
MPIRUN = {"OMPI_ALLOW_RUN_AS_ROOT": "1",
          "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
          "OMPI_MCA_rmaps_base_oversubscribe": "1",
          "OMPI_MCA_hwloc_base_binding_policy": "none"}


def look_up(node, path):
    """Follows a dotted path; lists are searched for a matching 'name'."""
    if not path:
        return node
    if isinstance(node, list):
        node = {str(item["name"]): item for item in node
                if isinstance(item, dict) and "name" in item}
    if isinstance(node, dict):
        # The longest key first: 'a.b' before 'a', as names may hold dots.
        for key in sorted(node, key=len, reverse=True):
            if path == key:
                return node[key]
            if path.startswith(key + "."):
                return look_up(node[key], path[len(key) + 1:])
    raise KeyError(path)


def check_expectation(text, summary):
    """Returns what is wrong, or nothing."""
    parts = re.split(r"(==|!=|<=|>=|<|>)", text, maxsplit=1)
    path = parts[0].strip().removeprefix("summary.")
    try:
        value = look_up(summary, path)
    except KeyError:
        return f"{text}: summary.json has no '{path}'"
    if len(parts) == 1:
        return None if value is True else f"{text}: it is {json.dumps(value)}"
    wanted = parts[2].strip()
    try:
        wanted = json.loads(wanted)
    except ValueError:
        pass  # a word without quotes
    try:
        if OPERATORS[parts[1]](value, wanted):
            return None
    except TypeError:
        pass  # a word cannot be smaller than a number
    return f"{text}: it is {json.dumps(value)}"


def check_said(text, words):
    """Returns what is wrong with a number in the output, or nothing."""
    said, comparison, wanted = re.split(r"(==|!=|<=|>=|<|>)", text, maxsplit=1)
    pattern = re.escape(" ".join(said.split())).replace(r"\#", NUMBER)
    found = re.findall(pattern, words)
    if not found:
        return f"nowhere said: {said}"
    for value in found:
        if not OPERATORS[comparison](float(value), float(wanted)):
            return f"{text}: it is {value}"
    return None


def run(arguments, folder):
    """Returns the exit code, all output, and summary.json if there is one."""
    command = [str(Path(arguments.limber).resolve()),
               str(Path(arguments.scene).resolve()),
               "--output-directory", str(folder / "run")]
    for change in arguments.set:
        command += ["--set", change]
    environment = dict(os.environ)
    if arguments.ranks > 1:
        command = ["mpirun", "-np", str(arguments.ranks)] + command
        environment.update(MPIRUN)
    else:
        environment.update(SINGLETON)

    result = subprocess.run(command, cwd=folder, env=environment, text=True,
                            errors="replace", stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
    path = folder / "run" / "summary.json"
    summary = json.loads(path.read_text()) if path.exists() else None
    return result.returncode, result.stdout, summary


def problems(arguments, code, output, summary):
    if code != arguments.expect_code:
        yield f"exit code {code} instead of {arguments.expect_code}"
    words = " ".join(output.split())  # the program breaks its lines
    for message in arguments.expect_message:
        if " ".join(message.split()) not in words:
            yield f"nowhere said: {message}"
    for text in arguments.expect_said:
        problem = check_said(text, words)
        if problem:
            yield problem
    if arguments.expect and summary is None:
        yield "no summary.json was written"
    elif arguments.expect:
        for text in arguments.expect:
            problem = check_expectation(text, summary)
            if problem:
                yield problem


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    several = {"action": "extend", "nargs": "+", "default": []}
    parser.add_argument("--limber", required=True, help="the program")
    parser.add_argument("--scene", required=True)
    parser.add_argument("--set", metavar="NAME=VALUE", **several)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--expect-code", type=int, default=0)
    parser.add_argument("--expect-message", metavar="TEXT", **several)
    parser.add_argument("--expect-said", metavar="WORDS", **several)
    parser.add_argument("--expect", metavar="CONDITION", **several)
    arguments = parser.parse_args()

    with tempfile.TemporaryDirectory(prefix="limber-") as folder:
        code, output, summary = run(arguments, Path(folder))
    found = list(problems(arguments, code, output, summary))
    if found:
        print(output)
        print("summary.json:", json.dumps(summary, indent=2))
    for problem in found:
        print("FAILED:", problem)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
