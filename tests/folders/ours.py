#!/usr/bin/env python3
"""Whose files are whose: what runs, references, studies and comparisons
refuse to touch, who may work in a folder, and how they end when it fails.

    ours.py --limber build/release/limber [name of a test ...]
"""

import argparse
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
SCENE = TOP / "tests/folders/block.prm"
EXACT = TOP / "prm/verification/manufactured_solution.prm"
LONG = TOP / "tests/restart/two_dimensions.prm"
BEAM = TOP / "prm/verification/free_soft_beam.prm"
ENVIRONMENT = {"OMPI_MCA_pml": "ob1",
               "OMPI_MCA_btl": "self,vader",
               "OMPI_ALLOW_RUN_AS_ROOT": "1",
               "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1",
               "OMPI_MCA_hwloc_base_binding_policy": "none",
               "LIMBER_PYTHON": "/bin/false"}

STUDY = """
set Scene = {scene}
set Methods = {methods}
set Variations = cells
set Measures = displacement
set Settings = {settings}
subsection Variation cells
  set Entry = Grid/Cells
  set Values = 4, 4
end
subsection Measure displacement
  set Name = u
end
"""


def files_below(folder):
    """Names and contents; links as links."""
    return {str(path.relative_to(folder)):
            os.readlink(path) if path.is_symlink() else path.read_bytes()
            for path in Path(folder).rglob("*")
            if path.is_symlink() or path.is_file()}


class Folders(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="limber-")
        self.addCleanup(scratch.cleanup)
        self.top = Path(scratch.name)
        self.folder = self.top / "out"

    def put(self, *names, text="mine\n"):
        for name in names:
            path = self.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)

    def command(self, *words, changes=(), folder=None):
        words = [*map(str, words or (SCENE,))]
        for change in changes:
            words += ["--set", change]
        return [PROGRAM, *words,
                "--output-directory", str(folder or self.folder)]

    def limber(self, code, *words, changes=(), command=None, **more):
        """Runs the program; returns what it said on both its outputs."""
        done = subprocess.run(
            command or self.command(*words, changes=changes), text=True,
            env={**os.environ, **ENVIRONMENT}, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, timeout=120, **more)
        said = " ".join((done.stdout + done.stderr).split())
        self.assertEqual(done.returncode, code, said)
        errors = re.findall("Error: .*", done.stderr)
        self.assertEqual(len(errors), int(0 < code < 4), done.stderr)
        for error in errors:
            self.assertLessEqual(len(error.split()), 62, error)
        return said

    def refused(self, expected, *words, changes=(), command=None):
        """Refused with code 1, in these words, and nothing is touched."""
        before = files_below(self.top)
        said = self.limber(1, *words, changes=changes, command=command)
        self.assertIn(expected, said)
        self.assertEqual(files_below(self.top), before)

    def start(self, *words, changes=(), wait_for="statistics", **more):
        """A run at work, which is stopped when the test ends."""
        process = subprocess.Popen(
            self.command(*words, changes=changes), text=True,
            env={**os.environ, **ENVIRONMENT}, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, **more)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        path = self.folder / wait_for
        for _ in range(6000):
            if path.exists() and path.stat().st_size > 0:
                return process
            if process.poll() is not None:
                break
            time.sleep(0.005)
        self.fail("no run at work: " + "".join(process.communicate()))

    def end(self, process, code):
        out, error = process.communicate(timeout=120)
        self.assertEqual(process.returncode, code, out + error)
        return out + error

    def study(self, methods="good", settings="End time=0.1", name="s.prm"):
        path = self.top / name
        path.write_text(STUDY.format(scene=EXACT, methods=methods,
                                     settings=settings))
        return path

    # ---- what is replaced, and what is not --------------------------------

    def test_replace_leaves_what_is_not_ours(self):
        mine = {"checkpoint/keys", "points/points_of_interest.txt", "notes.txt",
                "nodes/a/b", "grid/grid_1.vtu.bak"}
        self.put(*mine)
        changes = ("Output/Time interval=0.01", "Output/Point arrays=true",
                   "Checkpoint/Steps=2")
        self.limber(0, changes=changes)
        self.assertTrue((self.folder / "checkpoint/slot_1.h5").exists())
        self.limber(0, changes=("Output/Replace=true",
                                "Checkpoint/At the end=false"))
        left = set(files_below(self.folder))
        self.assertEqual(left - mine, {
            ".limber", "original.prm", "parameters.prm", "parameters.json",
            "log.txt", "statistics", "summary.json"})
        self.assertTrue(mine <= left)

    def test_replace_refuses_a_folder_that_nobody_of_ours_made(self):
        replace = ("Output/Replace=true",)
        for name in ("checkpoint/keys", "original.prm"):
            self.put(name)
            self.refused("is not replaced: no run made it", changes=replace)
            self.refused("is not replaced: no study made it", "study",
                         self.study(), changes=("Replace=true",))
            shutil.rmtree(self.folder)
        self.put("notes.txt")
        self.refused("is not replaced: no run made it", "reference", BEAM,
                     changes=replace)
        shutil.rmtree(self.folder)
        self.folder.mkdir()
        self.limber(0, changes=replace)  # an empty one has nothing to lose

    def test_replace_in_a_folder_of_an_earlier_version(self):
        self.put("original.prm", "parameters.prm", "parameters.json",
                 "statistics", "mine.txt")
        self.limber(0, changes=("Output/Replace=true",))
        self.assertEqual((self.folder / "mine.txt").read_text(), "mine\n")

    def test_names_that_are_taken_are_refused(self):
        for name in ("log.txt", "original.prm", "summary.json.part",
                     "points/points_00000.vtu", "checkpoint/good_slot.txt"):
            self.put(name)
            self.refused("which no run wrote and which would be overwritten")
            shutil.rmtree(self.folder)
        for name in ("study.csv", "study.png", "comparison.log"):
            self.put(name)
            self.refused("which no study wrote", "study", self.study())
            self.refused("which no study wrote", "inf-sup", "--cells", "2")
            shutil.rmtree(self.folder)
        for name in ("runs/good_4_4.log", "runs/good_4_4/statistics"):
            self.put(name)
            self.refused("is taken", "study", self.study())
            shutil.rmtree(self.folder)
        self.put("nodes/nodes_00000.h5")
        self.refused("which no run wrote", "reference", BEAM)

    def test_validation_warns_of_a_folder_that_is_taken(self):
        self.put("statistics")
        before = files_below(self.top)
        said = self.limber(0, SCENE, "--validate")
        self.assertIn("a run would be refused now", said)
        self.assertIn("holds 'statistics'", said)
        self.assertEqual(files_below(self.top), before)
        shutil.rmtree(self.folder)
        self.assertIn("The scene is valid.",
                      self.limber(0, SCENE, "--validate"))

    def test_a_run_or_study_of_before_is_refused(self):
        self.limber(0)
        self.refused("holds a run already")
        self.refused("holds a run already", "reference", BEAM)
        shutil.rmtree(self.folder)
        self.limber(0, "inf-sup", "--cells", "2")
        self.refused("holds a study already", "inf-sup", "--cells", "2")
        self.limber(0, "inf-sup", "--cells", "2", "--replace")

    def test_nothing_is_written_through_links(self):
        target = self.top / "target"
        target.write_text("mine\n")
        for name in ("log.txt", "study.csv", ".limber"):
            self.folder.mkdir()
            (self.folder / name).symlink_to(target)
            words = ("study", self.study()) if name == "study.csv" else ()
            self.refused("link" if name == ".limber" else "which no", *words)
            shutil.rmtree(self.folder)

        self.limber(0, changes=("Checkpoint/Steps=2",))
        elsewhere = self.top / "elsewhere"
        elsewhere.mkdir()
        for name in ("log.txt", "statistics"):
            path = self.folder / name
            path.unlink()
            path.symlink_to(target)
            self.refused("a symbolic link", SCENE, "--resume",
                         changes=("End time=2",))
            path.unlink()
            path.write_text("")
        (self.folder / "points").symlink_to(elsewhere)
        self.refused("a symbolic link", changes=("Output/Replace=true",))
        (self.folder / "points").unlink()
        (self.folder / "log.txt").unlink()
        (self.folder / "log.txt").symlink_to(target)
        self.limber(0, changes=("Output/Replace=true",))
        self.assertFalse((self.folder / "log.txt").is_symlink())
        self.assertEqual(target.read_text(), "mine\n")

    def test_a_folder_where_a_file_is_to_be_is_refused(self):
        self.limber(0)
        (self.folder / "frequencies").mkdir()
        self.refused("does not write", changes=("Output/Replace=true",))

    def test_studies_leave_what_is_not_theirs(self):
        self.limber(0, "study", self.study("good, other"))
        runs = self.folder / "runs"
        self.assertEqual(sorted(path.name for path in runs.glob("*.done")),
                         ["good_4_4.done", "other_4_4.done"])
        self.put("runs/mine.txt", "runs/good_4_4/notes", "runs/my/data",
                 "runs/my.log", "mine.txt")
        self.limber(0, command=self.command(folder=runs / "own"))
        own = files_below(runs / "own")
        self.refused("holds a study already", "study", self.study())
        self.limber(0, "study", self.study(), changes=("Replace=true",))
        for name in ("runs/mine.txt", "runs/good_4_4/notes", "runs/my/data",
                     "runs/my.log", "mine.txt"):
            self.assertEqual((self.folder / name).read_text(), "mine\n", name)
        self.assertEqual(files_below(runs / "own"), own)
        self.assertFalse((runs / "other_4_4").exists())
        self.assertFalse((runs / "other_4_4.done").exists())
        self.assertFalse((runs / "good_4_4/checkpoint").exists())
        self.limber(0, "study", self.study(settings="End time=0.2"), "--resume")
        self.assertTrue((runs / "good_4_4/notes").exists())

    def test_comparisons_overwrite_only_comparisons(self):
        arrays = ("Output/Point arrays=true", "Output/Time interval=0.5")
        self.limber(0, EXACT, changes=arrays)
        compare = [PROGRAM, "compare", str(self.folder), "exact"]
        self.limber(0, command=compare)
        self.limber(0, command=compare)
        for name in ("comparison", "comparison.json"):
            former = (self.folder / name).read_bytes()
            self.put(name)
            self.refused("no comparison wrote it", command=compare)
            (self.folder / name).unlink()
            (self.folder / name).symlink_to(self.top / "target")
            self.refused("no comparison wrote it", command=compare)
            (self.folder / name).unlink()
            (self.folder / name).write_bytes(former)

    # ---- one at a time ----------------------------------------------------

    def test_the_second_run_is_refused_and_the_first_unharmed(self):
        changes = ("End time=0.1", "Output/Statistics interval=1")
        lone = self.top / "lone"
        self.limber(0, command=self.command(LONG, changes=changes, folder=lone))
        first = self.start(LONG, changes=changes)
        first.send_signal(signal.SIGSTOP)  # so that it is there for certain
        before = files_below(self.folder)
        in_use = f"is in use by process {first.pid} on host '{os.uname()[1]}'"
        for words in ((LONG,), (LONG, "--resume"), ("reference", BEAM)):
            for replace in ("true", "false"):
                said = self.limber(1, *words,
                                   changes=(f"Output/Replace={replace}",))
                if replace == "true" or "--resume" in words:
                    self.assertIn(in_use, said)
        said = self.limber(1, command=[
            "mpirun", "-np", "2", *self.command(LONG, "--resume")])
        self.assertIn(in_use, said)
        self.assertEqual(files_below(self.folder), before)
        first.send_signal(signal.SIGCONT)
        self.end(first, 0)
        self.assertEqual((self.folder / "statistics").read_bytes(),
                         (lone / "statistics").read_bytes())
        # The mark of who has ended is no obstacle.
        self.limber(0, changes=("Output/Replace=true",))

    def test_two_studies_and_an_orphan(self):
        study = self.study(settings="End time=1e6")
        first = self.start("study", study,
                           wait_for="runs/good_4_4/statistics")
        in_use = f"is in use by process {first.pid}"
        for words in ((), ("--resume",)):
            said = self.limber(1, "study", study, *words,
                               changes=("Replace=true",))
            self.assertIn(in_use, said)
        first.kill()
        first.communicate()
        # Its child goes on alone, and nothing is taken away below it.
        mark = (self.folder / "runs/good_4_4/.limber").read_text()
        child = int(re.search(r"process (\d+)", mark).group(1))
        try:
            for words in ((), ("--resume",)):
                said = self.limber(1, "study", study, *words,
                                   changes=("Replace=true",))
                self.assertIn(f"is in use by process {child}", said)
            self.assertTrue((self.folder / "runs/good_4_4.log").exists())
        finally:
            os.kill(child, signal.SIGKILL)

    # ---- files that fail --------------------------------------------------

    def test_a_folder_that_is_removed(self):
        for interval in ("0", "0.02"):
            process = self.start(LONG, changes=(
                "End time=40", f"Output/Time interval={interval}"))
            process.send_signal(signal.SIGSTOP)
            shutil.rmtree(self.folder)
            process.send_signal(signal.SIGCONT)
            said = self.end(process, 3)
            self.assertEqual(said.count("Error:"), 1)
            self.assertFalse(self.folder.exists())

    def test_files_that_get_too_long(self):
        def small_files():
            # more than parameters.prm has
            resource.setrlimit(resource.RLIMIT_FSIZE, (80000, 80000))
        common = ("Output/Time interval=0", "End time=0.6")
        for name, changes in (
                ("statistics", ("Output/Statistics interval=1",)),
                ("log.txt", ("Output/Statistics interval=1000",
                             "Output/Progress interval=0"))):
            said = self.limber(3, LONG, changes=common + changes,
                               preexec_fn=small_files)
            self.assertIn(f"{name}' could not be written: File too large", said)
            text = (self.folder / name).read_bytes()
            self.assertEqual(text[-1:], b"\n")  # whole lines
            self.assertNotIn(b"\0", text)
            shutil.rmtree(self.folder)

        def no_big_checkpoint():
            resource.setrlimit(resource.RLIMIT_FSIZE, (100000, 100000))
        said = self.limber(3, LONG, changes=("Output/Time interval=0",),
                           preexec_fn=no_big_checkpoint)
        self.assertIn("its results are complete", said)
        self.assertIn('"verdict": "finished"',
                      (self.folder / "summary.json").read_text())

    # ---- signals ----------------------------------------------------------

    def test_signals_save_the_run(self):
        for number in (signal.SIGHUP, signal.SIGUSR1):
            process = self.start(LONG, changes=("End time=40",))
            process.send_signal(number)
            self.end(process, 128 + number)
            self.assertTrue((self.folder / "checkpoint/good_slot.txt").exists())
            self.limber(0, LONG, "--resume")
            shutil.rmtree(self.folder)

    def test_nohup(self):
        process = self.start(LONG, preexec_fn=lambda: signal.signal(
            signal.SIGHUP, signal.SIG_IGN), changes=("End time=0.1",))
        process.send_signal(signal.SIGHUP)
        self.end(process, 0)

    def test_a_study_passes_signals_on(self):
        process = self.start("study", self.study(settings="End time=1e6"),
                             wait_for="runs/good_4_4/statistics")
        process.send_signal(signal.SIGHUP)
        self.assertIn("Interrupted after 0 of 1",
                      self.end(process, 128 + signal.SIGHUP))
        self.assertIn('"stopped"', (self.folder / "runs/good_4_4/summary.json"
                                    ).read_text())

    # ---- longer runs ------------------------------------------------------

    def test_a_finished_run_is_extended(self):
        said = self.limber(0)
        self.assertTrue(said.endswith(
            'To extend this run: --resume --set "End time=0.04"'), said)
        before = (self.folder / "statistics").read_text()
        self.limber(0, SCENE, "--resume", changes=("End time=0.04",))
        after = (self.folder / "statistics").read_text()
        self.assertTrue(after.startswith(before))
        self.assertEqual(float(after.splitlines()[-1].split()[1]), 0.04)
        whole = self.top / "whole"
        self.limber(0, command=self.command(
            SCENE, changes=("Checkpoint/At the end=false",),
            folder=whole))
        self.assertFalse((whole / "checkpoint").exists())
        self.assertIn("has no checkpoint to go on from", self.limber(
            1, command=self.command(SCENE, "--resume", folder=whole)))

    def test_nothing_is_resumed_in_a_folder_of_others(self):
        self.put("notes.txt", "statistics")
        self.refused("has no checkpoint to go on from", SCENE, "--resume")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limber", required=True)
    ARGUMENTS, rest = parser.parse_known_args()
    PROGRAM = str(Path(ARGUMENTS.limber).resolve())
    unittest.main(argv=[__file__, *rest])
