#!/usr/bin/env python3
"""Installs the build into a folder, moves it, and works from there.

    install.py --build build/release [--cmake cmake]
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
ARGUMENTS = None

# bash hands the word on without the quote that it begins with
COMPLETE = r"""
source "$1"
program=$2
limber() { "$program" "$@"; }
COMP_WORDS=("${@:3}") COMP_CWORD=$(($# - 3))
compopt() { :; }
word=${COMP_WORDS[COMP_CWORD]}
[[ $word != [\"\']* ]] || word=${word:1}
_limber limber "$word" "${COMP_WORDS[COMP_CWORD - 1]}"
printf '%s\n' "${COMPREPLY[@]}"
"""


def run(*words, expected=0, **options):
    done = subprocess.run([str(word) for word in words], text=True,
                          capture_output=True, **options)
    if done.returncode != expected:
        raise AssertionError(f"{words}: exit code {done.returncode}\n"
                             + done.stdout + done.stderr)
    return done.stdout


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        home = Path(cls.scratch.name)
        run(ARGUMENTS.cmake, "--install", ARGUMENTS.build, "--prefix",
            home / "first")
        os.rename(home / "first", home / "moved")
        cls.home, cls.prefix = home, home / "moved"
        cls.limber = cls.prefix / "bin/limber"

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def test_a_run_and_its_picture(self):
        scene = self.prefix / "share/limber/prm/dam_break.prm"
        run(self.limber, scene, "--set", "End step=3", "--output-directory",
            self.home / "run", expected=4)
        said = run(self.limber, "plot", self.home / "run", "--field", "speed",
                   "--output", self.home / "speed.png")
        self.assertIn("speed.png", said)
        self.assertEqual((self.home / "speed.png").read_bytes()[:4], b"\x89PNG")

    def test_the_scripts_are_the_installed_ones(self):
        script = self.prefix / "share/limber/plot/plot.py"
        kept = script.read_text()
        script.write_text("print('the installed one')\n")
        try:
            self.assertIn("the installed one", run(self.limber, "plot"))
        finally:
            script.write_text(kept)

    def test_man_page(self):
        page = (self.prefix / "share/man/man1/limber.1").read_text()
        self.assertIn(run(self.limber, "--version").split()[1], page)

    def test_links_of_pages_and_files_of_scenes(self):
        """What the sources have beside their pages and scenes is installed."""
        share = self.prefix / "share"
        for page in [share / "limber/prm/README.md",
                     *(share / "doc/limber").rglob("*.md")]:
            for link in re.findall(r"\]\(([^)#\s]+)", page.read_text()):
                self.assertTrue(":" in link or (page.parent / link).exists(),
                                f"{page}: {link}")
        for path in (TOP / "prm/data").iterdir():
            self.assertTrue((share / "limber/prm/data" / path.name).is_file())

    def complete(self, *words):
        script = self.prefix / "share/bash-completion/completions/limber"
        return run("bash", "-c", COMPLETE, "bash", script, self.limber,
                   "limber", *words, cwd=self.prefix / "share/limber"
                   ).splitlines()

    def test_completion(self):
        self.assertEqual(self.complete("stu"), ["study"])
        self.assertIn("--enlarge", self.complete("plot", "x", "--"))
        self.assertIn("--frequencies", self.complete("reference", "--f"))
        self.assertEqual(self.complete("--list", "ker"), ["kernels"])
        self.assertIn("prm/dam_break.prm", self.complete("prm/"))
        self.assertIn("Method/Courant\\ number=",
                      self.complete("a.prm", "--set", "Method/Cou"))
        self.assertEqual(["Method/Stress update="], self.complete(
            "a.prm", "--set", '"Method/Stress u'))
        scene = "prm/cantilever.prm"
        self.assertIn("Body\\ beam/Material=",
                      self.complete(scene, "--set", "Body\\ beam/Mat"))
        for typed, entry in (
                ("Body\\ beam/Neo\\ hookean/Yo",
                 "Body\\ beam/Neo\\ hookean/Young\\'s\\ modulus="),
                ('"Body beam/Neo hookean/Yo',
                 "Body beam/Neo hookean/Young's modulus="),
                ("'Body beam/Neo hookean/Yo",
                 "Body beam/Neo hookean/Young'\\''s modulus=")):
            self.assertEqual([entry], self.complete(scene, "--set", typed))
        self.assertEqual(["Error\\ levels="], self.complete(
            "study", "prm/studies/cantilever.prm", "--set", "Error"))
        self.assertEqual(["equivalent\\ stress"],
                         self.complete("plot", "x", "--field", "eq"))


def main():
    global ARGUMENTS
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", required=True)
    parser.add_argument("--cmake", default="cmake")
    ARGUMENTS, rest = parser.parse_known_args()
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
