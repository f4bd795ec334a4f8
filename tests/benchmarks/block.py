#!/usr/bin/env python3
"""Measures the sliding block: time per point and step, ranks, memory.

    block.py [path of limber] [runs]

Prints best and median over the runs (default 5) of CPU time in ns per point
and step for both treatments in 2D and 3D, with splines and cubic ones, with
splines and FMPM, with CPDI, in the initial frame, in a box with 16 times the
cells, the laws at finite strain with two kernels, the speed-up of two ranks in
wall time, and bytes per point (peak resident set, program included) for a finer
block. Variants take turns, so that a drift of the
machine's speed meets all alike.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
ENVIRONMENT = {**os.environ,
               "OMPI_ALLOW_RUN_AS_ROOT": "1",
               "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_hwloc_base_binding_policy": "core"}
BIG_BOX = {"2d": ["Grid/Upper corner=4.96, 4.96", "Grid/Cells=496, 496"],
           "3d": ["Grid/Upper corner=5.3333333333, 2.6666666667, 2.6666666667",
                  "Grid/Cells=160, 80, 80"]}
NONE = "Body block/Locking treatment=none"
SPLINES = "Method/Kernel=quadratic"
CUBIC = "Method/Kernel=cubic"
CPDI = "Method/Kernel=cpdi"
INITIAL = "Body block/Frame=initial"
ASSUMED = "Body block/Locking treatment=assumed strain"
FMPM = ["Method/Transfer=fmpm", "Method/Stress update=usl", NONE]
# Laws at finite strain; those that flow once where nothing does and once where
# all points do in every step
MODULI = ["Density=1000", "Young's modulus=1e6", "Poisson's ratio=0.3"]


def law(name, *entries):
    section = name[0].upper() + name[1:]
    return [f"Body block/Material={name}",
            *(f"Body block/{section}/{entry}" for entry in [*MODULI, *entries])]


LAWS = {"neo hookean": law("neo hookean"),
        "j2, elastic": law("j2", "Yield stress=1e9"),
        "j2, flowing": law("j2", "Yield stress=1e-3"),
        "drucker prager, elastic": law("drucker prager", "Friction angle=30",
                                       "Cohesion=1e9", "Tensile strength=1e9"),
        "drucker prager, flowing": law("drucker prager", "Friction angle=5")}
FINE = {"2d": ["Grid/Cells=1984, 1984", "End time=0.00025"],
        "3d": ["Grid/Cells=160, 160, 160", "End time=0.001"]}


def run(limber, scene, settings=(), ranks=1):
    with tempfile.TemporaryDirectory() as folder:
        command = ["mpirun", "-np", str(ranks), limber,
                   str(TOP / "prm/benchmarks" / f"{scene}.prm"),
                   "--output-directory", folder + "/run"]
        for setting in settings:
            command += ["--set", setting]
        subprocess.run(command, env=ENVIRONMENT, check=True,
                       stdout=subprocess.DEVNULL)
        return json.loads(Path(folder, "run/summary.json").read_text())


def main():
    limber = sys.argv[1] if len(sys.argv) > 1 else str(
        TOP / "build/release/limber")
    runs = int(sys.argv[2]) if len(sys.argv) > 2 else 5
    for scene in ("2d", "3d"):
        variants = {"cell": ([], 1),
                    "none": ([NONE], 1),
                    "splines, cell": ([SPLINES], 1),
                    "splines, none": ([SPLINES, NONE], 1),
                    "cubic, cell": ([CUBIC], 1),
                    "cubic, none": ([CUBIC, NONE], 1),
                    "splines, none, FMPM(4)": ([SPLINES, *FMPM], 1),
                    "CPDI, none": ([CPDI, NONE], 1),
                    "CPDI, none, USL": ([CPDI, NONE,
                                         "Method/Stress update=usl"], 1),
                    "assumed strain": ([ASSUMED], 1),
                    "initial frame, none": ([INITIAL, NONE], 1),
                    "initial frame, assumed strain": ([INITIAL, ASSUMED], 1),
                    "initial frame, splines": ([INITIAL, NONE, SPLINES], 1),
                    "cell, 16 times the box": (BIG_BOX[scene], 1),
                    "cell, two ranks": ([], 2)}
        for kernel, settings in {"cell": [], "splines, node": [
                SPLINES, "Body block/Locking treatment=node"]}.items():
            for name, entries in LAWS.items():
                variants[f"{name}, {kernel}"] = ([*entries, *settings], 1)
        found = {name: [] for name in variants}
        for _ in range(runs):
            for name, (settings, ranks) in variants.items():
                found[name].append(run(limber, f"block_{scene}", settings, ranks))
        for name, summaries in found.items():
            cost = [s["ns_per_point_step"] for s in summaries]
            wall = [s["wall_seconds"] for s in summaries]
            print(f"{scene} {name:30s} ns per point and step: best "
                  f"{min(cost):6.1f} median {statistics.median(cost):6.1f}"
                  f"   wall s: best {min(wall):.3f} "
                  f"median {statistics.median(wall):.3f}", flush=True)
        memory = run(limber, f"block_{scene}", FINE[scene])
        print(f"{scene} {memory['points']} points: "
              f"{memory['bytes_per_point']:.0f} bytes per point", flush=True)


if __name__ == "__main__":
    main()
