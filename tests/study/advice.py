#!/usr/bin/env python3
"""`limber advise` on scenes that are wasteful on purpose, and on lean ones.

    advice.py --limber PROGRAM --prm FOLDER

FOLDER is prm of the project.
"""

import argparse
import re
import subprocess
import unittest
from pathlib import Path

FLUID = "Body water/Newtonian fluid/Bulk modulus="


class Advice(unittest.TestCase):
    def advise(self, scene, *settings, error="0.01", code=0):
        command = [ARGUMENTS.limber, "advise", str(Path(ARGUMENTS.prm) / scene),
                   "--for-error", error]
        for setting in settings:
            command += ["--set", setting]
        done = subprocess.run(command, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT)
        self.assertEqual(done.returncode, code, done.stdout)
        found = {}
        for line in done.stdout.splitlines():
            factor = re.search(r"factor of (\S+) in CPU", line)
            found[line.split(":")[0]] = (float(factor.group(1)) if factor else 1,
                                         line)
        return found

    def factor(self, found, what, lower, upper):
        self.assertIn(what, found)
        self.assertGreaterEqual(found[what][0], lower, found[what][1])
        self.assertLessEqual(found[what][0], upper, found[what][1])

    def test_stiff_water(self):
        found = self.advise("dam_break.prm")
        self.factor(found, "Bulk modulus", 20, 25)
        self.factor(found, "Points per cell edge", 2.7, 2.85)
        self.assertNotIn("Grid", found)

    def test_soft_water_is_left_alone(self):
        found = self.advise("dam_break.prm", FLUID + "auto",
                            "Body water/Points per cell edge=3",
                            "Output/Statistics interval=1")
        self.assertEqual(set(found), {"Nothing to spare was found for an error "
                                      "of 1 %."})

    def test_three_dimensions_for_two(self):
        found = self.advise("benchmarks/dam_break_3d.prm")
        self.assertIn("along z", found["Dimension"][1])
        self.assertGreater(found["Dimension"][0], 5)
        found = self.advise("benchmarks/dam_break_3d.prm",
                            "Body water/Initial velocity=0; 0; 0.1*sin(z)")
        self.assertNotIn("Dimension", found)
        found = self.advise("benchmarks/dam_break_3d.prm",
                            "Boundaries/front=no slip")
        self.assertNotIn("Dimension", found)

    def test_many_points(self):
        found = self.advise("cantilever.prm", "Body beam/Points per cell edge=4")
        self.factor(found, "Points per cell edge", 3.99, 4.01)

    def test_treatment_without_effect(self):
        rubber = self.advise("cantilever.prm", "Grid/Cells=72, 40")
        self.assertNotIn("Locking treatment", rubber)
        cork = self.advise("cantilever.prm", "Grid/Cells=144, 80",
                           "Body beam/Neo hookean/Poisson's ratio=0")
        self.assertIn("none", cork["Locking treatment"][1])
        alone = self.advise("cantilever.prm", "Body beam/Points per cell edge=1")
        self.assertIn("one point per cell", alone["Locking treatment"][1])
        inviscid = self.advise("dam_break.prm", "Body water/Newtonian fluid/"
                               "Viscosity=0", "Body water/Locking treatment="
                               "cell full")
        self.assertIn("inviscid", inviscid["Locking treatment"][1])

    def test_large_box(self):
        found = self.advise("cantilever.prm", "Grid/Upper corner=90, 50",
                            "Grid/Cells=360, 200")
        self.assertIn("MB", found["Grid"][1])
        self.assertNotIn("Grid", self.advise("cantilever.prm"))

    def test_pictures_finer_than_steps(self):
        found = self.advise("cantilever.prm", "Output/Time interval=1e-4")
        self.assertIn("finer than a step", found["Output"][1])
        self.assertGreater(found["Output"][0], 2)
        self.assertNotIn("Output", self.advise("cantilever.prm",
                                               "Output/Time interval=1"))

    def test_short_steps(self):
        found = self.advise("cantilever.prm", "Method/Courant number=0.1")
        self.factor(found, "Courant number", 3.9, 4.1)
        self.assertNotIn("Courant number",
                         self.advise("cantilever.prm",
                                     "Method/Courant number=0.1",
                                     "Method/Stress update=last"))

    def test_wrong_input(self):
        self.advise("missing.prm", code=1)
        self.advise("cantilever.prm", "Method/Curant number=1", code=1)
        self.advise("cantilever.prm", error="none", code=1)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limber", required=True)
    parser.add_argument("--prm", required=True)
    ARGUMENTS, rest = parser.parse_known_args()
    unittest.main(argv=[__file__, *rest])
