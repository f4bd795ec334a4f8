#!/usr/bin/env python3
"""What the program is given and cannot take: it says so, and nothing else.

    door.py --limber build/release/limber --case sizes
"""

import argparse
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import xml.etree.ElementTree
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
SINGLETON = {"OMPI_MCA_pml": "ob1",
             "OMPI_MCA_btl": "self,vader"}
SEVERAL_RANKS = {"OMPI_ALLOW_RUN_AS_ROOT": "1",
                 "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                 "OMPI_MCA_rmaps_base_oversubscribe": "1",
                 "OMPI_MCA_hwloc_base_binding_policy": "none"}
BLOCK = TOP / "prm/benchmarks/block_2d.prm"
SCENE = """set Bodies = {name}
set Observables = {name}
set End step = 2
subsection Body {name}
  subsection Box
    set Upper corner = 1, 1
  end
  set Material = newtonian fluid
  set Locking treatment = cell
end
subsection Grid
  set Upper corner = 2, 2
  set Cells = 4, 4
end
subsection Boundaries
  set left = no slip
end
subsection Output
  set Time interval = 0.5
end
subsection Observable {name}
  set Type = pressure
  set Body = {name}
  set Location = 0.5, 0.5
end
"""
FAILED = []


def limber(*words, changes=(), limit=None, ranks=1):
    """Exit code, what was said, and what went to the error stream."""
    command = [PROGRAM, *map(str, words)]
    if ranks > 1:
        command = ["mpirun", "-np", str(ranks)] + command
    for change in changes:
        command += ["--set", change]

    def set_limits():
        if limit:
            resource.setrlimit(resource.RLIMIT_AS, (int(limit), int(limit)))
    result = subprocess.run(
        command, env={**os.environ, **(SINGLETON if ranks == 1 else
                                       SEVERAL_RANKS)},
        text=True, errors="replace", stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, preexec_fn=set_limits, timeout=120)
    return result.returncode, result.stdout, result.stderr


def expect(condition, text, *said):
    print(("passed: " if condition else "FAILED: ") + text)
    if not condition:
        print(*[str(part)[-2000:] for part in said])
        FAILED.append(text)


def expect_refused(answer, *fragments, code=1):
    """One message of our own, on the error stream, with these fragments."""
    found, _, said = answer
    messages = [line for line in said.splitlines()
                if line.startswith("Error: ")]
    text = messages[0] if messages else ""
    expect(found == code and len(messages) == 1 and
           len(text.split()) <= 60 and len(text) < 700 and
           all(fragment in text for fragment in fragments),
           f"code {code}: " + text[:160], found, said)


def sizes(folder):
    """Scenes that fit nowhere are refused before they take memory."""
    out = ("--output-directory", folder / "run")
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    for words in ((BLOCK, "--validate"), (BLOCK, *out), ("advise", BLOCK)):
        for cells in ("100000, 100000", "1e9, 1e9"):
            expect_refused(limber(*words, changes=("Grid/Cells=" + cells,)),
                           "cells", "Set")
    points = "Body block/Points per cell edge=100000"
    expect_refused(limber(BLOCK, "--validate", changes=(points,)), "points")
    cantilever = TOP / "prm/cantilever.prm"
    for change in ("Output/Time interval=1e-9",
                   "Reference/Elements over depth=100000",
                   "Reference/Refinements=15", "Reference/Time step=1e-12"):
        expect_refused(limber("reference", cantilever, *out,
                              changes=(change,)))
    expect_refused(limber(cantilever, *out,
                          changes=("Output/Time interval=1e-9",)), "pictures")
    values = "1e6, 1e6 | 36, 20 | 72, 40 | 144, 80"
    answer = limber("study", TOP / "prm/studies/cantilever.prm", "--validate",
                    changes=("Variation cells over the depth/Values=" + values,
                             f"Directory={folder / 'study'}"))
    expect_refused(answer, "cells")
    expect(not (folder / "run").exists(), "nothing was written")
    after = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    expect(max(before, after) < 500e3, f"{after / 1e3:.0f} MB were enough")


def memory(folder):
    """An allocation that fails ends all ranks with our message."""
    changes = ("Memory limit=1000", "Grid/Cells=2000, 2000")
    for ranks in (1, 2):
        answer = limber(BLOCK, "--output-directory", folder / "run",
                        changes=changes, limit=1.2e9, ranks=ranks)
        expect_refused(answer, "Memory is exhausted", "Grid/Cells", code=2)
    expect_refused(limber(BLOCK, "--validate", changes=changes[1:],
                          limit=1.2e9), "1.2 GB")


def estimate(folder):
    """What is estimated is needed, within a factor of 1.5."""
    for name, words, changes in (
            ("block_2d", (BLOCK,), ("End step=2",)),
            ("block_3d", (TOP / "prm/benchmarks/block_3d.prm",),
             ("End step=2",)),
            ("fine grid", (BLOCK,), ("End step=2", "Grid/Cells=1000, 1000")),
            ("pictures", (BLOCK,),
             ("End step=2", "Output/Time interval=1",
              "Body block/Points per cell edge=6")),
            ("no common factors", (BLOCK,),
             ("End step=2", "Grid/Cells=401, 403"))):
        run = folder / name
        code, _, refused = limber(*words, "--validate",
                                  changes=(*changes, "Memory limit=1e-3"))
        estimated = float(refused.split("needs some ")[1].split()[0])
        limber(*words, "--output-directory", run, changes=changes)
        needed = json.loads((run / "summary.json").read_text())[
            "memory_bytes"] / 1e9
        expect(code == 1 and 1 / 1.5 < estimated / needed < 1.5,
               f"{name}: {estimated} GB estimated, {needed:.3f} GB needed",
               refused)


def texts(folder):
    """Binary, deep and long scenes."""
    scene = folder / "bad.prm"
    scene.write_bytes(b"set End time = 1\0\n")
    expect_refused(limber(scene, "--validate"), "'\\x00'", "line 1")
    scene = folder / "deep.json"
    scene.write_text('{"a":' * 100000)
    expect_refused(limber(scene, "--validate"), "16 deep")
    scene.write_text("[" * 100000)
    expect_refused(limber(scene, "--validate"), "16 deep")
    scene = folder / "long.prm"
    for text in ("set End time = " + "9" * 1000000 + "x", "x" * 1000000,
                 "set Bodies = " + "b" * 1000000):
        scene.write_text(text)
        expect_refused(limber(scene, "--validate"), "...")
    study = folder / "deep_study.json"
    study.write_text('{"a":' * 100000)
    expect_refused(limber("study", study), "16 deep")


def names(folder):
    """Names with signs of XML, and folders with signs of everything."""
    for number, name in enumerate(("soil & rock", '<a> "b" \'c\'', "a=b; ä")):
        scene = folder / "scene.prm"
        scene.write_text(SCENE.format(name=name))
        run = folder / f"names {number}"
        code, _, said = limber(scene, "--output-directory", run)
        found = set()
        for path in [*run.glob("*.pvd"), *run.glob("*/*.vtu")]:
            tree = xml.etree.ElementTree.parse(path)
            found |= {array.get("Name") for array in tree.iter("DataArray")}
        expect(code == 0 and "pressure of " + name in found,
               name + " in pictures", code, said, found)
        expect(": " + name + " [" in (run / "statistics").read_text(),
               name + " in the table")
        json.loads((run / "summary.json").read_text())
    for folder_name in ("a b", "a;b", "a\\b", "a\"b'c", "ä €", "a=b, c", "$x"):
        run = folder / folder_name
        limber(scene, "--output-directory", run)
        former = {name: (run / name).read_bytes()
                  for name in ("parameters.prm", "parameters.json")}
        for name, text in former.items():
            copy = folder / name
            copy.write_bytes(text)
            code, _, said = limber(copy, changes=("Output/Replace=true",))
            again = {name: (run / name).read_bytes().replace(
                b"Replace       = true # default: false",
                b"Replace       = false") for name in former}
            same = json.loads(again["parameters.json"])
            same["Output"]["Replace"] = "false"
            expect(code == 0 and
                   same == json.loads(former["parameters.json"]),
                   f"{name} of {folder_name!r} repeats the run", code, said)
    for bad in ("a#b", "a\\", "a\nb", " a", ""):
        expect_refused(limber(scene, "--output-directory", bad), "Usually"
                       if bad.strip() != bad or not bad else "parameters.prm")


def meshes(folder):
    """A mesh of triangles, and counts that are wrong."""
    mesh = folder / "panel.msh"
    right = ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n"
             "2 8 0 0\n3 8 1 0\n4 0 1 0\n$EndNodes\n$Elements\n2\n"
             "1 2 2 0 1 1 2 3\n2 2 2 0 1 1 3 4\n$EndElements\n")
    square = right.replace("1 2 2 0 1 1 2 3\n2 2 2 0 1 1 3 4",
                           "1 3 2 0 1 1 2 3 4").replace("ents\n2", "ents\n1")
    for text, said in (
            (right, "Element 1 is a triangle"),
            (square.replace("$Nodes\n4", "$Nodes\n-5"), "-5"),
            (square.replace("$Nodes\n4", "$Nodes\n999999999"), "999999999"),
            (square.replace("1 2 3 4\n$", "1 2 4 3\n$"), "twisted"),
            (square.replace("1 2 3 4\n$", "1 2 3 3\n$"), "twice")):
        mesh.write_text(text)
        for ranks in (1, 2) if "triangle" in said else (1,):
            expect_refused(
                limber("reference", TOP / "prm/cantilever.prm", "--validate",
                       changes=("Reference/Mesh file=" + str(mesh),),
                       ranks=ranks), said)


COMMANDS = ("", "reference", "compare", "study", "stability", "inf-sup", "advise",
            "plot", "animate")


def helps(folder):
    """Every command explains itself; what it takes is in the page of 'man' and is
    completed by bash."""
    page = (TOP / "contrib/packaging/limber.1").read_text().replace("\\-", "-")
    bash = (TOP / "contrib/packaging/completion.bash").read_text()
    code, overview, _ = limber("--help")
    for command in COMMANDS:
        words = (command,) if command else ()
        code, said, complaint = limber(*words, "--help")
        short = limber(*words, "-h")
        expect(code == 0 and not complaint and
               said.startswith(f"limber {command}".rstrip()) and
               short == (0, said, ""), f"'limber {command}' -h and --help",
               code, said, complaint, short)
        expect(not command or re.search(rf"^  {command} ", overview, re.M),
               f"'limber --help' lists {command}", overview)
        options = set(re.findall(r"^  (?:-h, )?(--[a-z-]+)", said, re.M))
        expect(len(options) > (0 if command in ("", "compare") else 2) or
               command == "compare", f"options of '{command}'", said)
        part = re.search(rf"^    {command or 'run'}\) options=\"(.*?)\"", bash,
                         re.M | re.S)[1].split()
        for option in options - {"--help"}:
            expect(re.search(rf"^\.B[IR]? \"?{option}\b", page, re.M),
                   f"{option} of '{command}' is in limber.1")
            expect(option in part, f"{option} of '{command}' is completed", part)
        for option in set(part) - {"--help"}:
            expect(option in said, f"'{command}' takes {option}", said)


def misused(folder):
    """Options that a command does not know and values that are none are wrong
    input, with a message that names them."""
    for command in COMMANDS:
        words = (command,) if command else ()
        for wrong in (("--wrong",), ("--wrong", "x")):
            code, said, complaint = limber(*words, *wrong)
            expect(code == 1 and not said and complaint.startswith("Error: ") and
                   (command in ("plot", "animate") or "'--wrong'" in complaint),
                   f"'limber {command} {' '.join(wrong)}'", code, said, complaint)
    for option, value in (("--cells", ""), ("--cells", "4,"), ("--points", "1.5"),
                          ("--fill", "0"), ("--output-directory", ""),
                          ("--pressure", "face"), ("--samples", "none")):
        expect_refused(limber("inf-sup", option, value), "command line")


def intended(folder):
    """Nothing is said about an entry that '--set' gives and the run uses; one that
    has no effect is told."""
    for changes in (("Method/Courant number=0.4",),
                    ("Output/Statistics interval=7",),
                    ("Body block/Locking treatment=cell",), ("End step=2",),
                    ("Body block/History=relax", "Body block/Relaxation time=0.1")):
        code, out, said = limber(BLOCK, "--validate", changes=changes)
        told = [line for line in (out + said).splitlines() if "--set" in line or
                "arning" in line or "no effect" in line]
        expect(code == 0 and not told, f"{changes}: no warning", told, said)
    expect_refused(limber(BLOCK, "--validate",
                          changes=("Body block/Relaxation time=0.1",)),
                   "has no effect", "History = relax")
    expect_refused(limber(BLOCK, "--validate",
                          changes=("Method/Courant numbr=0.4",)),
                   "Courant number")


def main():
    global PROGRAM
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--limber", required=True)
    parser.add_argument("--case", required=True)
    arguments = parser.parse_args()
    PROGRAM = str(Path(arguments.limber).resolve())
    with tempfile.TemporaryDirectory(prefix="limber-") as folder:
        os.chdir(folder)
        globals()[arguments.case](Path(folder))
    sys.exit(1 if FAILED else 0)


if __name__ == "__main__":
    main()
