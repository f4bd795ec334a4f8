#!/usr/bin/env python3
"""Measures the sliding block: time per point and step, ranks, memory.

    block.py [--laws] [LIMBER] [RUNS]
    block.py --table [--steps N] [--only WORD] [LIMBER] [RUNS]

Prints best and median over the runs (default 5) of CPU time in ns per point
and step for both treatments in 2D and 3D, with splines and cubic ones, with
splines and FMPM, with CPDI, in the initial frame, in a box with 16 times the
cells, the laws at finite strain with two kernels, the speed-up of two ranks in
wall time, and bytes per point (peak resident set, program included) for a finer
block. With --laws only the laws are measured, with fewer steps.

--table prints instead one Markdown table of every kernel, transfer and frame,
without a cure for locking and with each that it has, with the ratios to linear
functions without a cure of the same series; then, with --parts, the ns that the
parts of a step take. --steps shortens the runs, --only takes the rows with this
word (and linear functions).

Variants take turns, so that a drift of the machine's speed meets all alike.
"""

import argparse
import json
import os
import statistics
import subprocess
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
# all points do in every step. Clay does where it is pressed by its weight.
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
        "drucker prager, flowing": law("drucker prager", "Friction angle=5"),
        "j2 with saturation, flowing": law("j2", "Yield stress=1e-3",
                                           "Saturation hardening=1e-3"),
        "Bingham, flowing": law("j2", "Yield stress=1e-3", "Viscosity=1"),
        "Herschel-Bulkley, flowing": law("j2", "Yield stress=1e-3",
                                         "Viscosity=1", "Flow exponent=0.5"),
        "mu(I), flowing": law("drucker prager", "Friction angle=5",
                              "Limit friction angle=30")}
CLAY = ["Body block/Material=cam clay", *(f"Body block/Cam clay/{entry}" for entry in (
    "Density=1000", "Shear modulus=4e5", "Compression index=0.002",
    "Swelling index=0.0012", "Critical state slope=1.2"))]
LAWS |= {"cam clay, elastic": [
             *CLAY, "Body block/Cam clay/Preconsolidation pressure=1e9"],
         "cam clay, flowing": [
             *CLAY, "Body block/Cam clay/Preconsolidation pressure=1"]}
SHORT = {"2d": ["End time=0.0125"], "3d": ["End time=0.006"]}
FINE = {"2d": ["Grid/Cells=1984, 1984", "End time=0.00025"],
        "3d": ["Grid/Cells=160, 160, 160", "End time=0.001"]}


def run(limber, scene, settings=(), ranks=1, may_fail=False):
    """The summary of a run; of one that fails, if it may, at least 'failure'."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["mpirun", "-np", str(ranks), limber,
                   str(TOP / "prm/benchmarks" / f"{scene}.prm"),
                   "--output-directory", folder + "/run"]
        for setting in settings:
            command += ["--set", setting]
        done = subprocess.run(command, env=ENVIRONMENT, check=not may_fail,
                              stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL if may_fail else None)
        summary = Path(folder, "run/summary.json")
        if done.returncode and not summary.exists():
            return {"failure": "refused"}
        result = json.loads(summary.read_text())
        return result if done.returncode else {**result, "failure": None}


# ---- the table ------------------------------------------------------------------

REFERENCE = "`linear`", "`none`"
TIME_STEP = {"2d": 5e-5, "3d": 2e-4}  # s, of the scenes


def rows_of_table():
    """{(what, treatment): settings}: kernels, then transfers, then frames."""
    rows = {}

    def add(name, treatments, *settings):
        for treatment in treatments:
            rows[name, f"`{treatment}`"] = [
                *settings, f"Body block/Locking treatment={treatment}"]

    for kernel in ("linear", "quadratic", "cubic", "gimp", "cpgimp", "cpdi",
                   "cpdi2", "ddmp"):
        cures = ["assumed strain"] if kernel == "linear" else []
        add(f"`{kernel}`", ["none", "cell", "node", *cures],
            f"Method/Kernel={kernel}")
    for kernel in ("linear", "quadratic"):
        for transfer in ("apic", "aflip"):
            add(f"`{kernel}`, `{transfer}`", ["none", "cell"],
                f"Method/Kernel={kernel}", f"Method/Transfer={transfer}")
    for transfer, order in (("fmpm", 2), ("fmpm", 4), ("xpic", 2),
                            ("xpic", 4)):
        add(f"`quadratic`, `{transfer}` of order {order}", ["none", "cell"],
            SPLINES, f"Method/Transfer={transfer}",
            f"Method/Transfer order={order}", "Method/Stress update=usl")
    add("`quadratic`, `usl`", ["none"], SPLINES, "Method/Stress update=usl")
    add("initial frame, `linear`", ["none", "cell", "assumed strain"], INITIAL)
    add("initial frame, `quadratic`", ["none", "cell"], INITIAL, SPLINES)
    add("initial frame, `cubic`", ["none", "cell"], INITIAL, CUBIC)
    return rows


def machine():
    """Model of the processor, as Linux names it."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        return next(line.split(":")[1].strip() for line in lines
                    if line.startswith("model name"))
    except (OSError, StopIteration):
        return "unknown processor"


def measured(limber, rows, runs, steps):
    """{(scene, row): summaries}; of each round, all rows of both scenes."""
    found = {(scene, row): [] for scene in TIME_STEP for row in rows}
    for _ in range(runs):
        for (scene, row), summaries in found.items():
            if summaries and summaries[-1]["failure"]:
                continue  # it would fail again
            short = [f"End time={steps * TIME_STEP[scene]}"] if steps else []
            summaries.append(run(limber, f"block_{scene}",
                                 [*rows[row], *short], may_fail=True))
    return found


def best_and_median(summaries, number):
    """Both, or the word for what went wrong."""
    failure = next((s["failure"] for s in summaries if s["failure"]), None)
    if failure:
        return failure
    values = [number(s) for s in summaries]
    return min(values), statistics.median(values)


def print_table(limber, runs, steps, only, parts):
    rows = {row: settings for row, settings in rows_of_table().items()
            if row == REFERENCE or only in " ".join(row)}
    found = measured(limber, rows, runs, steps)
    print("| functions | treatment | 2D, ns: best / median | ratio | "
          "3D, ns: best / median | ratio |\n"
          "| --- | --- | ---: | ---: | ---: | ---: |")
    for row in rows:
        cells = []
        for scene in TIME_STEP:
            cost, linear = (best_and_median(found[scene, r],
                                            lambda s: s["ns_per_point_step"])
                            for r in (row, REFERENCE))
            if isinstance(cost, str) or isinstance(linear, str):
                cells += [cost if isinstance(cost, str) else "{:.1f} / {:.1f}"
                          .format(*cost), ""]
            else:
                cells += ["{:.1f} / {:.1f}".format(*cost),
                          f"{cost[0] / linear[0]:.2f} / "
                          f"{cost[1] / linear[1]:.2f}"]
        print(f"| {' | '.join([*row, *cells])} |")
    version = subprocess.run([limber, "--version"], text=True,
                             stdout=subprocess.PIPE).stdout.splitlines()[0]
    many = f"{runs} alternating runs" if runs > 1 else "one run"
    print(f"\n{machine()}; {version}; {many}"
          f"{f' of {steps} steps' if steps else ''}; "
          "`tests/benchmarks/block.py --table`")
    if not parts:
        return
    for scene in TIME_STEP:
        names = []
        for row in rows:
            for summary in found[scene, row]:
                names += [v for v in summary.get("verbs", {})
                          if v not in names]
        print(f"\n| {scene.upper()}, ns, best | treatment | " +
              " | ".join(names) + " |\n| --- | --- |" + " ---: |" * len(names))
        for row in rows:
            cells = []
            for name in names:
                cost = best_and_median(
                    found[scene, row],
                    lambda s: s["verbs"].get(name, 0) * s["ns_per_point_step"])
                cells.append("" if isinstance(cost, str) else f"{cost[0]:.1f}")
            print(f"| {' | '.join([*row, *cells])} |")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("limber", nargs="?",
                        default=str(TOP / "build/release/limber"))
    parser.add_argument("runs", nargs="?", type=int, default=5)
    parser.add_argument("--laws", action="store_true")
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--parts", action="store_true")
    parser.add_argument("--steps", type=int, default=0)
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    limber, runs = arguments.limber, arguments.runs
    if arguments.table:
        return print_table(limber, runs, arguments.steps, arguments.only,
                           arguments.parts)
    for scene in ("2d", "3d"):
        variants = {} if arguments.laws else {
                    "cell": ([], 1),
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
                variants[f"{name}, {kernel}"] = (
                    [*entries, *settings, *(SHORT[scene] if arguments.laws else [])],
                    1)
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
        if arguments.laws:
            continue
        memory = run(limber, f"block_{scene}", FINE[scene])
        print(f"{scene} {memory['points']} points: "
              f"{memory['bytes_per_point']:.0f} bytes per point", flush=True)


if __name__ == "__main__":
    main()
