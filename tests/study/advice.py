#!/usr/bin/env python3
"""`limber advise` on scenes that are wasteful on purpose, and on those that are
not; what it advises is held against runs with and without it.

    advice.py --limber PROGRAM --prm FOLDER

FOLDER is prm of the project; contrib/studies/advice_table.py does the same for
all scenes.
"""

import argparse
import os
import pty
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "contrib/studies"))
import advice_table  # noqa: E402  pylint: disable=wrong-import-position

FLUID = "Body water/Newtonian fluid/Bulk modulus="
EXPLICIT = "Method/Time integration=explicit"
QUICK_DAM = (EXPLICIT, "Body water/Points per cell edge=2", "End time=0.1",
             "Check front at T=3/At time=0.1", "Check height at T=3/At time=0.1")
BEAM = "Body beam/"

LINEAR_BALL = ("Body ball/Frame=current", "Method/Kernel=linear",
               "Check first rebound/At time=0.1")


class Advice(unittest.TestCase):
    def advise(self, scene, *settings, error=0.01, seconds=60):
        found = {}
        for piece in advice_table.advise(ARGUMENTS.limber,
                                         Path(ARGUMENTS.prm) / scene, settings,
                                         error, seconds):
            found[piece.what] = piece
        return found

    def hold(self, scene, piece, *settings):
        """Runs with and without it: as quick as promised, checks unchanged."""
        path = Path(ARGUMENTS.prm) / scene
        base = advice_table.run(ARGUMENTS.limber, path, settings, 60)
        changed = advice_table.run(ARGUMENTS.limber, path,
                                   (*settings, *piece.settings), 60)
        checks, wrong = advice_table.hold(piece, base, changed, 0.01)
        self.assertEqual(wrong, "", checks)

    def test_fewer_points_for_a_solid_that_crosses_cells(self):
        piece = self.advise("benchmarks/fixed_soft_beam.prm",
                            "End time=0.15", "Check tip at 0.3 s/At time=0.15",
                            "Check tip at 0.4 s/At time=0.15"
                            )["Points per cell edge"]
        self.assertNotEqual(piece.judgement, "Advised", piece.line)
        self.assertGreater(piece.change, 0.05, piece.line)

    def test_fewer_points_are_a_trade_where_they_creep_later(self):
        # This early nothing is seen of it.
        piece = self.advise("cantilever.prm", BEAM + "Points per cell edge=4",
                            "End time=10", "Check first mode/Observable=tip",
                            "Check first mode/Tolerance=1e9",
                            error=0.2)["Points per cell edge"]
        self.assertEqual(piece.judgement, "A trade", piece.line)
        self.assertIn("creep", piece.ground)

    def test_points_that_do_not_move_are_spared(self):
        scene = "verification/manufactured_solution.prm"
        settings = ("Body square/Points per cell edge=4",)
        piece = self.advise(scene, *settings)["Points per cell edge"]
        self.assertEqual(piece.judgement, "Advised", piece.line)
        self.assertGreater(piece.factor, 1.5, piece.line)
        self.hold(scene, piece, *settings)

    def test_stiff_water(self):
        piece = self.advise("dam_break.prm", FLUID + "2e8", *QUICK_DAM,
                            error=1e-6)["Bulk modulus"]
        self.assertGreater(piece.factor, 1.3, piece.line)
        self.assertEqual(piece.judgement, "A trade", piece.line)

    def test_soft_water_is_left_alone(self):
        found = self.advise("dam_break.prm", FLUID + "auto", *QUICK_DAM)
        self.assertNotIn("Bulk modulus", found)
        self.assertNotIn("Points per cell edge", found)

    def test_three_dimensions_for_two(self):
        quick = ("End time=0.1", "Check front at T=3/At time=0.1",
                 "Check height at T=3/At time=0.1")
        scene = "benchmarks/dam_break_3d.prm"
        piece = self.advise(scene, *quick)["Dimension"]
        self.assertIn("along z", piece.line)
        self.assertIn("Grid/Cells=40, 24, 1", piece.settings)
        self.assertGreater(piece.factor, 3, piece.line)
        self.assertLess(piece.change, 0.02, piece.line)
        for setting in ("Body water/Initial velocity=0; 0; 0.1*sin(z)",
                        "Boundaries/front=no slip"):
            self.assertNotIn("Dimension", self.advise(scene, setting, *quick))

    def test_treatment(self):
        short = ("End time=2", "Check first mode/Observable=tip")
        rubber = self.advise("cantilever.prm", "Grid/Cells=72, 40", *short)
        self.assertNotIn("Locking treatment", rubber)
        alone = self.advise("cantilever.prm", BEAM + "Points per cell edge=1",
                            *short)["Locking treatment"]
        self.assertIn("one point per cell", alone.line)

    def test_large_box(self):
        settings = ("Grid/Upper corner=90, 50", "Grid/Cells=360, 200",
                    "End time=4", "Check first mode/Observable=tip",
                    "Check first mode/Tolerance=1e9")
        piece = self.advise("cantilever.prm", *settings)["Grid"]
        self.assertEqual(piece.judgement, "Advised", piece.line)
        self.assertIn("MB", piece.line)
        self.assertLess(piece.change, 1e-6, piece.line)
        self.hold("cantilever.prm", piece, *settings)

    def test_empty_room_is_coarse(self):
        settings = ("Grid/Upper corner=16, 16", "Grid/Cells=320, 320",
                    "End time=0.1", *LINEAR_BALL)
        scene = "verification/bouncing_ball.prm"
        piece = self.advise(scene, *settings)["Levels"]
        self.assertEqual(piece.judgement, "Advised", piece.line)
        self.assertIn("Grid/Levels=4", piece.settings)
        self.assertIn("Grid/Cells=20, 20", piece.settings)
        self.assertIn("MB", piece.line)
        self.assertLess(piece.change, 1e-6, piece.line)
        # a box that is full, and functions that levels do not have
        self.assertNotIn("Levels", self.advise(scene, "End time=0.1", *LINEAR_BALL))
        self.assertNotIn("Levels", self.advise(scene, *settings,
                                               "Method/Kernel=quadratic"))

    def test_a_box_that_is_built_slowly_is_answered_at_once(self):
        # Sixteen times the cells of the block, which take twenty seconds to build
        # and half a minute per run; what is said first must not wait for them.
        command = [ARGUMENTS.limber, "advise",
                   str(Path(ARGUMENTS.prm) / "benchmarks/empty_room.prm"),
                   "--set", "Grid/Cells=120, 120, 120",
                   "--set", "Grid/Upper corner=2.9, 2.9, 2.9"]
        screen, terminal = pty.openpty()
        with subprocess.Popen(command, text=True, stdout=subprocess.PIPE,
                              stderr=terminal) as child:
            begin = time.monotonic()
            first = child.stdout.readline()
            waited = time.monotonic() - begin
            rest = child.stdout.read()
            self.assertEqual(child.wait(), 0, rest)
        os.close(terminal)
        said = os.read(screen, 4096).decode()
        os.close(screen)
        self.assertLess(waited, 10, first)
        piece = advice_table.Piece(first.rstrip("\n"))
        self.assertEqual((piece.judgement, piece.what), ("Advised", "Levels"))
        self.assertIn("Grid/Cells=15, 15, 15", piece.settings)
        self.assertIn("Grid/Levels=3", piece.settings)
        self.assertIn("MB", first)
        # the others are weighed against the scene with coarse cells
        self.assertIn("Advised: Grid.", rest)
        self.assertNotIn("Levels.", rest)
        for text in ("Building the scene", "Running the scene as it is",
                     "Running it with the advice on 'Grid'"):
            self.assertIn(text, said)

    def test_levels_that_no_point_sees(self):
        scene = "adaptive_throw.prm"
        self.assertNotIn("Levels", self.advise(scene))
        piece = self.advise(scene, "Grid/Refine ball/Level=3")["Levels"]
        self.assertEqual(piece.settings, ["Grid/Levels=3"])
        # 2.6 m/s for 0.3 s do not lead there
        away = ("Grid/Upper corner=16, 16", "Grid/Cells=320, 320",
                "Grid/Refine ball/Criterion=region",
                "Grid/Refine ball/Bodies=", "Grid/Levels=1",
                "Grid/Refine ball/Lower corner=14, 14")
        piece = self.advise(scene, *away)["Levels"]
        self.assertEqual(piece.settings, ["Grid/Levels=0", "Grid/Refine="])

    def test_pictures_finer_than_steps(self):
        found = self.advise("cantilever.prm", "Output/Time interval=1e-4",
                            "End time=1")
        self.assertIn("shorten the steps from", found["Output"].line)
        self.assertGreater(found["Output"].factor, 2)
        self.assertNotIn("Output", self.advise("cantilever.prm", "End time=1",
                                               "Output/Time interval=0.5"))

    def test_short_steps(self):
        settings = ("Method/Courant number=0.1", "End time=4",
                    "Check first mode/Observable=tip",
                    "Check first mode/Tolerance=1e9")
        piece = self.advise("cantilever.prm", *settings)["Courant number"]
        self.assertGreater(piece.factor, 2, piece.line)
        self.assertNotIn("Courant number",
                         self.advise("cantilever.prm", *settings,
                                     "Method/Stress update=usl"))

    def test_a_beginning_is_no_ground(self):
        # One second of wall time holds no run of this.
        command = [ARGUMENTS.limber, "advise",
                   str(Path(ARGUMENTS.prm) / "dam_break.prm"), "--set", EXPLICIT,
                   "--seconds", "1"]
        done = subprocess.run(command, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT)
        self.assertNotIn("Advised: Points", done.stdout)
        self.assertNotIn("Advised: Bulk", done.stdout)

    def test_a_signal_stops_the_run_and_leaves_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            child = subprocess.Popen(
                [ARGUMENTS.limber, "advise",
                 str(Path(ARGUMENTS.prm) / "dam_break.prm"), "--set", EXPLICIT],
                env={**os.environ, "TMPDIR": folder}, text=True,
                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            log = f"{folder}/limber-advise-{child.pid}/run/log.txt"
            while not os.path.exists(log) and child.poll() is None:
                time.sleep(0.05)
            child.send_signal(signal.SIGTERM)
            said = child.communicate(timeout=60)[1]
            self.assertEqual(child.returncode, 128 + signal.SIGTERM, said)
            self.assertIn("Stopped by signal 15", said)
            self.assertEqual([name for name in os.listdir(folder)
                              if name.startswith("limber")], [])
            # nor the run of the scene, known by its folder
            commands = []
            for path in Path("/proc").glob("[0-9]*/cmdline"):
                try:
                    commands.append(path.read_bytes())
                except OSError:
                    pass
            self.assertFalse(any(folder.encode() in command
                                 for command in commands))

    def test_wrong_input(self):
        for words in (("missing.prm",),
                      ("cantilever.prm", "--set", "Method/Curant number=1"),
                      ("cantilever.prm", "--for-error", "none"),
                      ("cantilever.prm", "--seconds", "0")):
            command = [ARGUMENTS.limber, "advise",
                       str(Path(ARGUMENTS.prm) / words[0]), *words[1:]]
            done = subprocess.run(command, stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE)
            self.assertEqual(done.returncode, 1, command)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limber", required=True)
    parser.add_argument("--prm", required=True)
    ARGUMENTS, rest = parser.parse_known_args()
    unittest.main(argv=[__file__, *rest])
