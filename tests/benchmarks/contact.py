#!/usr/bin/env python3
"""Measures what contact costs where a tenth of the nodes touch.

    contact.py [path of limber ...] [--runs N] [--scene NAME ...] [--verbs]

Two slabs that slide on each other (prm/benchmarks/layers_2d.prm and
layers_3d.prm), parting and stuck together, by kernels and orders of the stress
update. With splines the face lies on a grid line, so that two rows of nodes
touch as with linear functions. Prints for each program the best and median CPU
time in ns per point and step over the runs (default 5), and the ratio of best
and of medians. Variants and programs take turns, so that a drift of the
machine's speed meets all alike. With --verbs the verbs are printed as well, in
ns per point and step, of the run that took least.
"""

import argparse
import statistics
from pathlib import Path

from block import TOP, run

ALONE = ["Contact/Pair interface/Law=stick",
         "Contact/Pair interface/Friction coefficient="]
FACES = {"layers_2d": ["Body lower/Box/Upper corner=5.1, 0.1",
                       "Body upper/Box/Lower corner=0.1, 0.1"],
         "layers_3d": ["Body lower/Box/Upper corner=0.22, 0.1, 0.16",
                       "Body upper/Box/Lower corner=0.02, 0.1, 0"]}
ORDERS = ("musl", "usavg")
KERNELS = ("linear", "quadratic")


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("programs", nargs="*",
                           default=[str(TOP / "build/release/limber")])
    arguments.add_argument("--runs", type=int, default=5)
    arguments.add_argument("--scene", action="append", choices=sorted(FACES))
    arguments.add_argument("--verbs", action="store_true")
    arguments = arguments.parse_args()
    for scene in arguments.scene or FACES:
        for kernel in KERNELS:
            for order in ORDERS:
                measure(arguments, scene, kernel, order)


def measure(arguments, scene, kernel, order):
    settings = [f"Method/Kernel={kernel}", f"Method/Stress update={order}",
                *(FACES[scene] if kernel != "linear" else [])]
    variants = [(program, pair) for program in arguments.programs
                for pair in (False, True)]
    found = {variant: [] for variant in variants}
    for _ in range(arguments.runs):
        for program, pair in variants:
            found[program, pair].append(
                run(program, scene, settings + ([] if pair else ALONE)))
    for program in arguments.programs:
        costs = {pair: [s["ns_per_point_step"] for s in found[program, pair]]
                 for pair in (False, True)}
        best, median = ({pair: of(values) for pair, values in costs.items()}
                        for of in (min, statistics.median))
        print(f"{scene} {kernel} {order} {program}: one field "
              f"{best[False]:.1f} / {median[False]:.1f} ns, contact "
              f"{best[True]:.1f} / {median[True]:.1f}, ratio "
              f"{best[True] / best[False]:.3f} / "
              f"{median[True] / median[False]:.3f}", flush=True)
        if arguments.verbs:
            for pair in (False, True):
                summary = min(found[program, pair],
                              key=lambda s: s["ns_per_point_step"])
                total = sum(summary["verbs"].values())
                print("   ", {verb: round(summary["ns_per_point_step"]
                                          * seconds / total, 2)
                              for verb, seconds in summary["verbs"].items()
                              if seconds > 0})


if __name__ == "__main__":
    main()
