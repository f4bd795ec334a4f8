#!/usr/bin/env python3
"""How `limber study` behaves: failing variants, resuming, interruption, wrong
input.

    behaviour.py --limber PROGRAM --scene SCENE

SCENE is prm/verification/manufactured_solution.prm, which takes milliseconds.
"""

import argparse
import csv
import json
import os
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

STUDY = """
set Title = {title}
set Scene = {scene}
set Methods = good, unstable
set Variations = cells
set Measures = displacement
set Error levels = 0.5
{extra}
subsection Method unstable
  set Settings = Method/Courant number=5 | End time=50
end
subsection Variation cells
  set Entry = Grid/Cells
  set Values = {cells}
end
subsection Measure displacement
  set Name = u
end
"""


class Behaviour(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory(prefix="limber-")
        self.folder = Path(self.scratch.name)
        self.addCleanup(self.scratch.cleanup)

    def write(self, text=None, **changes):
        values = {"title": "A test", "scene": ARGUMENTS.scene, "extra": "",
                  "cells": "4, 4 | 8, 8", **changes}
        path = self.folder / "test.prm"
        path.write_text(text or STUDY.format(**values))
        return path

    def run_study(self, path, *words, chart=False):
        # drawing takes longer than all the rest
        environment = dict(os.environ, LIMBER_PYTHON="/bin/false")
        if chart:
            del environment["LIMBER_PYTHON"]
        done = subprocess.run(
            [ARGUMENTS.limber, "study", str(path), "--output-directory",
             str(self.folder / "out"), *words], text=True,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment)
        return done.returncode, " ".join(done.stdout.split())

    def rows(self):
        with open(self.folder / "out/study.csv", newline="") as file:
            return list(csv.DictReader(file))

    def test_a_variant_that_fails_is_a_result(self):
        code, said = self.run_study(self.write())
        self.assertEqual(code, 0, said)
        rows = self.rows()
        self.assertEqual([row["method"] for row in rows],
                         ["good"] * 2 + ["unstable"] * 2)
        self.assertEqual({row["outcome"] for row in rows[:2]}, {"finished"})
        for row in rows[2:]:
            self.assertIn(row["outcome"], ("growing energy", "not finite",
                                           "inverted point", "lost points"))
            self.assertEqual(row["exit code"], "2")
            self.assertEqual(row["displacement value"], "nan")
        self.assertIn("unstable: not reached", said)

    def test_error_on_command_line(self):
        code, said = self.run_study(self.write(), "--for-error", "1e-9",
                                    chart=True)
        self.assertEqual(code, 0, said)
        self.assertIn("error 1e-09: reached by no variant", said)

    def test_an_error_of_the_study_is_told_once(self):
        """Also if the command line names it again, with other digits."""
        code, said = self.run_study(self.write(), "--for-error", "0.50",
                                    "--for-error", "0.25")
        self.assertEqual(code, 0, said)
        self.assertEqual(said.count("error 0.5:"), 1, said)
        self.assertEqual(said.count("error 0.25:"), 1, said)
        table = (self.folder / "out/study.md").read_text()
        self.assertEqual(table.count("error 0.5:"), 1, table)

    def test_resume_repeats_only_what_changed(self):
        self.run_study(self.write())
        kept = self.folder / "out/runs/good_4_4/summary.json"
        written = kept.stat().st_mtime_ns
        code, said = self.run_study(self.write(), "--resume")
        self.assertEqual(code, 0, said)
        self.assertEqual(said.count("(kept)"), 4)
        code, said = self.run_study(self.write(cells="4, 4 | 6, 6"), "--resume")
        self.assertEqual(said.count("(kept)"), 2)
        self.assertEqual(kept.stat().st_mtime_ns, written)
        # what the run depends on has changed: it is done again
        code, said = self.run_study(
            self.write(extra="set Settings = End time=0.5|Method/Courant "
                       "number=0.1|Check u/Tolerance=1"), "--resume")
        self.assertEqual(said.count("(kept)"), 0)

    def test_a_half_written_run_is_repeated(self):
        self.run_study(self.write())
        (self.folder / "out/runs/good_4_4.done").unlink()
        code, said = self.run_study(self.write(), "--resume")
        self.assertEqual(said.count("(kept)"), 3)

    def test_a_folder_with_a_study_is_refused(self):
        self.run_study(self.write())
        code, said = self.run_study(self.write())
        self.assertEqual(code, 1)
        self.assertIn("--resume", said)
        code, said = self.run_study(self.write(), "--set", "Replace=true")
        self.assertEqual(code, 0, said)

    def test_interrupted_and_resumed(self):
        path = self.write(extra="set Settings = End time=300")
        process = subprocess.Popen(
            [ARGUMENTS.limber, "study", str(path), "--output-directory",
             str(self.folder / "out")], stdout=subprocess.PIPE, text=True,
            start_new_session=True)
        runs = self.folder / "out/runs"
        for _ in range(200):  # until the first variant is at work
            time.sleep(0.05)
            if (runs / "good_4_4/statistics").exists():
                break
        os.killpg(process.pid, signal.SIGINT)
        said, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, said)
        self.assertIn("--resume", said)
        self.assertFalse((self.folder / "out/study.csv").exists())
        code, said = self.run_study(
            self.write(extra="set Settings = End time=0.5"), "--resume")
        self.assertEqual(code, 0, said)

    def test_time_limit(self):
        code, said = self.run_study(
            self.write(cells="64, 64",
                       extra="set Settings = End time=1000\n"
                       "set Time limit = 1\nset Short methods = good"),
            "--short")
        self.assertEqual(code, 0, said)
        self.assertEqual([row["outcome"] for row in self.rows()],
                         ["time limit"])

    def test_without_python_the_table_is_there(self):
        code, said = self.run_study(self.write())
        self.assertEqual(code, 0, said)
        self.assertIn("No chart was drawn", said)
        self.assertIn("plot_study.py", said)
        self.assertEqual(len(self.rows()), 4)

    def test_validate_lists_and_runs_nothing(self):
        code, said = self.run_study(self.write(), "--validate")
        self.assertEqual(code, 0, said)
        self.assertIn("unstable, 8, 8", said)
        self.assertFalse((self.folder / "out").exists())

    def refused(self, expected, *words, **changes):
        code, said = self.run_study(self.write(**changes), *words)
        self.assertEqual(code, 1, said)
        self.assertIn(expected, said)
        self.assertFalse((self.folder / "out").exists())

    def test_wrong_input(self):
        self.refused("Did you mean 'Measures'?", extra="set Mesures = a")
        self.refused("Did you mean 'Courant number'?",
                     extra="set Settings = Method/Curant number=0.1")
        self.refused("The variant 'good, 8, 8x'", cells="4, 4 | 8, 8x")
        self.refused("cannot be read", scene="missing.prm")
        self.refused("has no '='", extra="set Settings = Method/Transfer")
        self.refused("There is no method 'god'", "--short",
                     extra="set Short methods = god")
        self.refused("'--for-eror'", "--for-eror", "0.1")
        self.refused("no number greater than 0", "--for-error", "-1")
        self.refused("stands twice", cells="4, 4 | 4, 4")

    def compare(self, settings, comparison, name="displacement"):
        return self.run_study(self.write(text=f"""
set Scene        = {ARGUMENTS.scene}
set Methods      = good
set Variations   = cells
set Measures     = field
set Error levels = 0.5
{settings}
subsection Variation cells
  set Entry  = Grid/Cells
  set Values = 8, 8 | 16, 16
end
subsection Measure field
  set Source = comparison
  set Name   = {name}
end
subsection Comparison
  {comparison}
end
"""), "--resume")

    ARRAYS = ("set Settings = Output/Point arrays=true|"
              "Output/Time interval=0.25")

    def test_comparison_with_an_exact_solution(self):
        code, said = self.compare(self.ARRAYS, "set With = exact")
        self.assertEqual(code, 0, said)
        coarse, fine = (float(row["field error"]) for row in self.rows())
        self.assertGreater(coarse / fine, 3.2)  # second order
        self.assertLess(fine, 0.02)
        self.assertIn("field, error 0.5: cheapest is", said)
        written = self.folder / "out/runs/good_16_16/comparison.json"
        before = written.stat().st_mtime_ns
        self.compare(self.ARRAYS, "set With = exact")
        self.assertEqual(written.stat().st_mtime_ns, before)

    def test_comparison_with_another_run(self):
        code, said = self.compare(
            self.ARRAYS, "set With = points\n"
            "set Settings = Grid/Cells=16, 16")
        self.assertEqual(code, 0, said)
        coarse, same = (float(row["field error"]) for row in self.rows())
        self.assertGreater(coarse, 0.01)
        self.assertLess(same, 1e-6)

    def test_comparison_that_cannot_be_made(self):
        code, said = self.compare("", "set With = exact")
        self.assertEqual(code, 1, said)
        self.assertIn("Output/Point arrays", said)
        code, said = self.compare(self.ARRAYS, "set With = exact", name="stres")
        self.assertEqual(code, 1, said)
        self.assertIn("Did you mean 'stress'?", said)
        code, said = self.compare(
            self.ARRAYS, "set With = points\n"
            "set Settings = Method/Courant number=5|End time=50")
        self.assertEqual(code, 1, said)
        self.assertIn("'Comparison/Settings'", said)

    def test_measure_of_nothing(self):
        text = STUDY.format(title="A test", scene=ARGUMENTS.scene, extra="",
                            cells="4, 4").replace("set Name = u",
                                                  "set Name = uu")
        self.refused("no check 'uu'", text=text)
        self.refused("no column 'kinetic'", text=text.replace(
            "set Name = uu", "set Source = column\nset Name = kinetic"))

    def limber(self, *words):
        done = subprocess.run([ARGUMENTS.limber, *map(str, words)], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        return done.returncode, done.stdout

    def test_stability_is_drawn_against_the_only_numbers(self):
        study = f"""
set Scene      = {ARGUMENTS.scene}
set Methods    = good
set Variations = cells, density
subsection Variation cells
  set Entry  = Grid/Cells
  set Values = 8, 8 | 16, 16
  {{labels}}
end
subsection Variation density
  set Entry  = Body square/Neo hookean/Density
  set Values = {{densities}}
end
subsection Bisection
  set Entry = Method/Courant number
  set Lower = 0.1
  set Upper = 2
end
"""
        def validated(labels="", densities="1 | 2"):
            return self.limber("stability", "--validate", self.write(
                text=study.format(labels=labels, densities=densities)))

        self.assertEqual(validated()[0], 0)
        code, said = validated(labels="set Labels = 8 | 16")
        self.assertEqual(code, 1)
        self.assertIn("has 2 variations (cells, density)", said)

    def test_entries_of_a_study_are_printed_with_its_values(self):
        code, said = self.limber("study", "--print-parameters", "json",
                                 self.write(), "--set", "Time limit=17")
        self.assertEqual(code, 0, said)
        entries = json.loads(said)
        self.assertEqual(entries["Title"], "A test")
        self.assertEqual(entries["Time limit"], "17")
        self.assertIn("Method unstable", entries)

    def test_usage(self):
        code, said = self.limber("study")
        self.assertEqual(code, 1)
        self.assertIn("limber study [options] study.prm", said)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limber", required=True)
    parser.add_argument("--scene", required=True)
    ARGUMENTS, rest = parser.parse_known_args()
    unittest.main(argv=[__file__, *rest])
