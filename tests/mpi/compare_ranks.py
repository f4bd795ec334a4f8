#!/usr/bin/env python3
"""Runs a scene on several numbers of ranks and compares the statistics.

    compare_ranks.py --limber build/release/limber --scene prm/dam_break.prm \\
        --ranks 1 2 3 4 --set "End time=0.05"

Every column of every row has to agree with the first run to 1e-10 of the
largest magnitude in the column; columns that are relative already (energy
drift, momentum error) to 1e-10 as they are.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ENVIRONMENT = {"OMPI_ALLOW_RUN_AS_ROOT": "1",
               "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1",
               "OMPI_MCA_mpi_yield_when_idle": "1",
               "OMPI_MCA_hwloc_base_binding_policy": "none"}
TOLERANCE = 1e-10


def run(arguments, ranks, folder):
    command = ["mpirun", "-np", str(ranks), arguments.limber,
               *arguments.word, arguments.scene,
               "--output-directory", str(folder)]
    for setting in arguments.set:
        command += ["--set", setting]
    result = subprocess.run(command, env={**os.environ, **ENVIRONMENT},
                            capture_output=True, text=True)
    if result.returncode != arguments.expect_code:
        sys.exit(f"{ranks} ranks: exit code {result.returncode}\n"
                 + result.stdout + result.stderr)
    names, rows = [], []
    for line in (folder / "statistics").read_text().splitlines():
        if line.startswith("#"):
            names.append(line.split(":", 1)[1].strip())
        else:
            rows.append([float(word) for word in line.split()])
    return names, rows


def differences(names, reference, rows, tolerance=TOLERANCE):
    """Yields (row, column name, difference) of what does not agree."""
    def largest(c):
        return max((abs(row[c]) for row in reference if row[c] == row[c]),
                   default=0)

    for c, name in enumerate(names):
        scale = largest(c)
        if name in ("energy drift", "momentum error"):
            scale = 1
        # That of velocities w against each other: those of points differ by
        # tolerance * v, and so m w^2 / 2 by tolerance * m w v.
        if name.startswith("energy removed by adaptation"):
            kinetic = [n.startswith("kinetic energy") for n in names]
            scale = (scale * largest(kinetic.index(True))) ** 0.5
        for r, (a, b) in enumerate(zip(reference, rows)):
            both_nan = a[c] != a[c] and b[c] != b[c]
            if not both_nan and not abs(a[c] - b[c]) <= tolerance * scale:
                yield r, name, abs(a[c] - b[c]) / (scale or 1)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--limber", required=True)
    parser.add_argument("--scene", required=True)
    parser.add_argument("--expect-code", type=int, default=0,
                        help="4 where the checks are of a longer run")
    parser.add_argument("--word", action="append", default=[],
                        help="stands before the scene, as 'reference'")
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 3])
    parser.add_argument("--tolerance", type=float, default=TOLERANCE,
                        help="instead of 1e-10, where a solver iterates")
    parser.add_argument("--set", action="append", default=[])
    arguments = parser.parse_args()

    failed = False
    with tempfile.TemporaryDirectory() as top:
        results = [run(arguments, ranks, Path(top) / f"ranks_{ranks}")
                   for ranks in arguments.ranks]
    names, reference = results[0]
    for ranks, (other_names, rows) in zip(arguments.ranks, results):
        if other_names != names or len(rows) != len(reference):
            sys.exit(f"{ranks} ranks: other columns or another number of rows")
        for row, name, difference in differences(names, reference, rows,
                                                 arguments.tolerance):
            failed = True
            print(f"{ranks} ranks, row {row}, {name}: {difference:.1e}")
    print(f"{len(reference)} rows of {len(names)} columns on "
          f"{arguments.ranks} ranks" + (" differ" if failed else " agree"))
    sys.exit(failed)


if __name__ == "__main__":
    main()
