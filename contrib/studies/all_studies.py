#!/usr/bin/python3
"""Runs the shipped studies and puts their tables and charts into doc/studies.

    all_studies.py [--limber PROGRAM] [--short] [--results FOLDER] [NAME ...]

Without names all of prm/studies; an hour and a half on a quiet machine, --short
some minutes. Runs that are there and have not changed are kept. After a study of
kernels rivals.py draws the chart of all four. Errors do not depend on the machine;
CPU times do, so nothing else should be running.
"""

import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
STABILITY = {"cut_cell", "free_cell", "courant_number", "stability_contact",
             "stability_friction", "stability_hardening"}
INF_SUP = {
    "inf_sup": ["--cells", "4,8,12,16,20"],
    "inf_sup_random": ["--cells", "4,8,12,16,20", "--fill", "0.5",
                       "--samples", "20"],
}


def command_for(name, arguments):
    # relative paths, so that captions say nothing of the machine's folders
    folder = ["--output-directory", str(Path(arguments.results) / name)]
    if name in INF_SUP:
        return [arguments.limber, "inf-sup", *INF_SUP[name], *folder,
                "--replace"]
    kind = "stability" if name in STABILITY else "study"
    command = [arguments.limber, kind, f"prm/studies/{name}.prm", *folder,
               "--resume"]
    return command + (["--short"] if arguments.short else [])


def publish(results, target, name):
    """Table and chart of a study, as a page of the manual."""
    target.mkdir(parents=True, exist_ok=True)
    text = (results / "study.md").read_text()
    title, rest = text.split("\n", 1)
    chart = results / "study.png"
    if chart.exists():
        shutil.copy(chart, target / f"{name}.png")
        rest = f"\n![{title.lstrip('# ')}]({name}.png)\n" + rest
    (target / f"{name}.md").write_text(title + "\n" + rest)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limber", default="build/release/limber")
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--results", default="studies")
    parser.add_argument("--target", default="doc/studies", type=Path)
    parser.add_argument("names", nargs="*")
    arguments = parser.parse_args()
    os.chdir(TOP)
    names = arguments.names or [
        *sorted(path.stem for path in Path("prm/studies").glob("*.prm")),
        *INF_SUP]
    failed = []
    for name in names:
        if subprocess.run(command_for(name, arguments)).returncode != 0:
            failed.append(name)
            continue
        publish(Path(arguments.results) / name, arguments.target, name)
    if any(name.startswith("kernels_") for name in set(names) - set(failed)):
        subprocess.run([sys.executable, "-B", "contrib/studies/rivals.py",
                        "--target", arguments.target], check=True)
    if failed:
        sys.exit("These studies have failed: " + ", ".join(failed))


if __name__ == "__main__":
    main()
