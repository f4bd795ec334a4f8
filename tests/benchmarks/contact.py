#!/usr/bin/env python3
"""Measures what contact costs where a tenth of the nodes touch.

    contact.py [path of limber ...] [--runs N] [--verbs]

Two slabs that slide on each other (prm/benchmarks/layers_2d.prm), parting
and stuck together, by orders of the stress update. Prints for each program the best and
median CPU time in ns per point and step over the runs (default 5), and the
ratio of best and of medians. Variants and programs take turns, so that a drift
of the machine's speed meets all alike. With --verbs the verbs are printed as
well, in ns per point and step, of the run that took least.
"""

import argparse
import statistics
from pathlib import Path

from block import TOP, run

ALONE = ["Contact/Pair interface/Law=stick",
         "Contact/Pair interface/Friction coefficient="]
ORDERS = ("musl", "usavg")


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("programs", nargs="*",
                           default=[str(TOP / "build/release/limber")])
    arguments.add_argument("--runs", type=int, default=5)
    arguments.add_argument("--verbs", action="store_true")
    arguments = arguments.parse_args()
    variants = [(program, order, pair) for order in ORDERS
                for program in arguments.programs for pair in (False, True)]
    found = {variant: [] for variant in variants}
    for _ in range(arguments.runs):
        for program, order, pair in variants:
            settings = [f"Method/Stress update={order}", *([] if pair else ALONE)]
            found[program, order, pair].append(
                run(program, "layers_2d", settings))
    for order in ORDERS:
        for program in arguments.programs:
            costs = {pair: [s["ns_per_point_step"]
                            for s in found[program, order, pair]]
                     for pair in (False, True)}
            best, median = (
                {pair: of(values) for pair, values in costs.items()}
                for of in (min, statistics.median))
            print(f"{order:6s} {program}: one field {best[False]:.1f} / "
                  f"{median[False]:.1f} ns, contact {best[True]:.1f} / "
                  f"{median[True]:.1f}, ratio {best[True] / best[False]:.3f} / "
                  f"{median[True] / median[False]:.3f}", flush=True)
            if arguments.verbs:
                for pair in (False, True):
                    summary = min(found[program, order, pair],
                                  key=lambda s: s["ns_per_point_step"])
                    print("   ", {verb: round(seconds * 1e9 / summary["points"]
                                              / summary["steps"], 2)
                                  for verb, seconds in summary["verbs"].items()
                                  if seconds > 0})


if __name__ == "__main__":
    main()
