#!/usr/bin/env python3
"""Tests `limber plot` and `limber animate` on small runs of their own: what is
drawn, what is refused, and that a refused picture leaves the old one alone.

    plots.py --limber build/release/limber
"""

import argparse
import contextlib
import importlib
import io
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
SCRIPTS = TOP / "contrib/plot"
SYSTEM = os.environ.get("LIMBER_PYTHON") or (
    "/usr/bin/python3" if Path("/usr/bin/python3").exists() else "python3")
LIMBER = None

SHORT = ["--set", "End time=0.004", "--set", "Output/Time interval=0.002",
         "--set", "Grid/Cells=16, 16"]
SHORT_3D = ["--set", "End time=0.002", "--set", "Output/Time interval=0.001",
            "--set", "Grid/Cells=10, 10, 10",
            "--set", "Output/Fields=velocity, stress"]


def limber(*words, expected=0, environment=None):
    done = subprocess.run([LIMBER, *map(str, words)], text=True,
                          capture_output=True,
                          env={**os.environ, **(environment or {})})
    if done.returncode != expected:
        raise AssertionError(f"{words}: exit code {done.returncode}\n"
                             + done.stdout + done.stderr)
    return done.stdout + done.stderr


def draw(word, *words, expected=0):
    """As `limber plot` or `limber animate`, by their scripts but within this
    process: matplotlib takes longer to start than most pictures."""
    script = importlib.import_module(word)
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        try:
            code = script.main([str(one) for one in words])
        except SystemExit as end:
            code = end.code
    importlib.import_module("charts").plt.close("all")
    if isinstance(code, str):
        said.write(code)
        code = 1
    if (code or 0) != expected:
        raise AssertionError(f"{word} {words}: {code}\n" + said.getvalue())
    return said.getvalue()


def png_size(path):
    data = Path(path).read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    return struct.unpack(">II", data[16:24])


class Plots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.home = Path(cls.scratch.name)
        scenes = TOP / "prm/benchmarks"
        limber(scenes / "block_2d.prm", *SHORT, "--output-directory",
               cls.home / "flat", "--set", "Output/Fields=velocity, pressure")
        limber(scenes / "block_2d.prm", *SHORT, "--output-directory",
               cls.home / "arrays", "--set", "Output/Fields=pressure",
               "--set", "Output/Point arrays=true")
        limber(scenes / "block_3d.prm", *SHORT_3D, "--output-directory",
               cls.home / "solid")
        limber(TOP / "tests/mpi/two_bodies.prm", "--set", "End step=4",
               "--set", "Output/Time interval=1e-3", "--set",
               "Output/Fields=pressure, body", "--output-directory",
               cls.home / "two")

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def test_default_pictures_of_a_run(self):
        limber("plot", self.home / "flat")
        for name in ("snapshots", "energies"):
            self.assertEqual(png_size(self.home / f"flat/{name}.png")[0], 1600)

    def test_endings(self):
        for ending, begin in ((".png", b"\x89PNG"), (".pdf", b"%PDF"),
                              (".svg", b"<?xml")):
            path = self.home / f"picture{ending}"
            draw("plot", self.home / "flat", "--field", "velocity x",
                   "--time", 0, "--output", path)
            self.assertEqual(path.read_bytes()[:len(begin)], begin)
        said = draw("plot", self.home / "flat", "--field", "pressure",
                      "--output", self.home / "a.jpg", expected=1)
        self.assertIn(".png", said)
        self.assertFalse((self.home / "a.jpg").exists())

    def test_three_dimensions_and_components(self):
        path = self.home / "solid.png"
        for field in ("speed", "equivalent stress"):
            draw("plot", self.home / "solid", "--field", field, "--snapshots",
                   2, "--output", path)
            self.assertEqual(png_size(path)[0], 1600)

    def test_fields_of_point_arrays(self):
        draw("plot", self.home / "arrays", "--field", "displacement y",
               "--enlarge", 3, "--output", self.home / "arrays.png")

    def test_runs_side_by_side(self):
        path = self.home / "both.png"
        draw("plot", self.home / "flat", self.home / "arrays", "--field",
               "pressure", "--time", 0.004, "--labels", "one", "another",
               "--output", path)
        wide, high = png_size(path)
        draw("plot", self.home / "flat", "--field", "pressure", "--time",
               0.004, "--output", path)
        self.assertGreater(high / wide, 1.5 * png_size(path)[1] / 1600)
        self.refused("Runs in two and in three dimensions",
                     "plot", self.home / "flat", self.home / "solid")

    def test_runs_in_columns(self):
        path = self.home / "columns.png"
        runs = self.home / "flat", self.home / "arrays"
        words = ["plot", *runs, "--field", "pressure", "--time", 0.004, "--output",
                 path]
        draw(*words)
        wide, high = png_size(path)
        draw(*words, "--side-by-side")
        self.assertLess(png_size(path)[1], 0.7 * high)
        self.refused("is for several runs", "plot", runs[0], "--side-by-side")

    def test_ends_of_the_colours_may_be_negative(self):
        path = self.home / "range.svg"
        draw("plot", self.home / "flat", "--field", "pressure", "--time", 0.004,
               "--range", "-5e7", "5E+7", "--output", path)
        self.assertIn("pressure [MPa]", path.read_text())
        self.refused("a higher one", "plot", self.home / "flat", "--range", "5e7",
                     "-5e7")

    def test_other_bodies_in_grey(self):
        path = self.home / "others.svg"
        words = ["plot", self.home / "two", "--body", "jelly", "--field",
                 "pressure", "--time", 0, "--output", path]
        draw(*words)
        alone = path.read_text()
        draw(*words, "--others")
        self.assertNotEqual(path.read_text(), alone)
        self.refused("'--others' are those beside", "plot", self.home / "two",
                     "--others")

    def test_cells_and_points_of_several_sizes(self):
        """Lines of the cells of all sizes; a point is as large as its cell says."""
        folder = self.home / "levels"
        limber(TOP / "prm/adaptive_dam_break.prm", "--set", "End time=0.01",
               "--set", "Output/Time interval=0.01", "--set",
               "Check front at T=3/At time=0.01", "--set",
               "Check front at T=3/Tolerance=9",
               "--set", "Output/Fields=pressure", "--output-directory", folder)
        path = self.home / "levels.svg"
        sizes = {}
        for words in ((), ("--grid",)):
            draw("plot", folder, "--field", "pressure", "--time", 0, *words,
                   "--output", path)
            sizes[words] = path.read_text().count("<path")
        said = subprocess.run([SYSTEM, "-B", "-c", LEVELS, str(SCRIPTS), str(
            folder)], text=True, capture_output=True)
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        # two lines a cell
        self.assertEqual(sizes[("--grid",)] - sizes[()], 2 * int(said.stdout))
        self.refused("lines are drawn in two dimensions only", "plot",
                     self.home / "solid", "--field", "speed", "--grid")

    def test_pictures_of_several_runs_leave_those_of_the_first_alone(self):
        kept = self.home / "arrays/snapshots.png"
        kept.write_bytes(b"as it was")
        draw("plot", self.home / "arrays", self.home / "flat", "--field",
               "pressure")
        self.assertEqual(kept.read_bytes(), b"as it was")
        self.assertTrue((kept.parent / "comparison_snapshots.png").is_file())

    def test_what_the_titles_say(self):
        path = self.home / "titles.svg"
        draw("plot", self.home / "arrays", "--field", "pressure", "--time", 0,
               0.004, "--enlarge", 3, "--output", path)
        text = path.read_text()
        self.assertIn("t = 4 ms, displacements × 3</text>", text)

    def test_bodies(self):
        path = self.home / "two.png"
        draw("plot", self.home / "two", "--field", "body", "--output", path)
        draw("plot", self.home / "two", "--body", "jelly", "--field",
               "pressure", "--output", path)
        self.refused("There is no body 'jello'", "plot", self.home / "two",
                     "--body", "jello")

    def test_points_are_as_far_apart_as_the_program_chose(self):
        for kernel, number in (("linear", 2), ("quadratic", 3)):
            folder = self.home / kernel
            limber(TOP / "prm/benchmarks/block_2d.prm", *SHORT,
                   "--output-directory", folder, "--set",
                   f"Method/Kernel={kernel}", "--set", "Body block/Points per "
                   "cell edge=auto", "--set", "Body block/Frame=current")
            said = subprocess.run(
                [SYSTEM, "-c", f"import sys; sys.path.append('{SCRIPTS}'); "
                 f"import fields; print(fields.Source('{folder}').spacing())"],
                text=True, capture_output=True, check=True).stdout
            self.assertAlmostEqual(float(said), 1.24 / 16 / number)

    def refused(self, expected, *words, call=draw):
        said = call(*words, expected=1)
        self.assertIn(expected, said)
        self.assertNotIn("Traceback", said)

    def test_what_is_refused_leaves_the_picture_alone(self):
        path = self.home / "kept.png"
        path.write_bytes(b"as it was")
        run = self.home / "flat"
        self.refused("There is no field 'presure'", "plot", run, "--field",
                     "presure", "--output", path)
        self.refused("There is no column 'mas'", "plot", run, "--columns",
                     "mas", "--output", path)
        self.refused("There is no folder", "plot", run / "none")
        self.refused("there is no folder", "plot", run, "--output",
                     self.home / "none/picture.png")
        self.refused("is not that of a run", "plot", self.home)
        self.refused("Did you mean '--field'?", "plot", run, "--filed", "mass",
                     call=limber)
        self.refused("there is no picture of 1 s", "plot", run, "--time", 0, 1,
                     "--output", path)
        scene = TOP / "prm/dam_break.prm"
        self.refused("is a scene. Run it", "plot", scene)
        self.refused("is a scene. Run it", "plot", scene, "--columns", "mass")
        self.assertEqual(path.read_bytes(), b"as it was")
        self.assertEqual(sorted(self.home.glob("tmp*")), [])

    def test_columns(self):
        path = self.home / "columns.svg"
        draw("plot", self.home / "flat", self.home / "arrays", "--columns",
               "kinetic energy", "mass", "--output", path)
        text = path.read_text()
        self.assertIn("mass [kg]", text)
        self.assertIn("kinetic energy", text)

    def test_film(self):
        path = self.home / "film.gif"
        draw("animate", self.home / "flat", "--field", "pressure", "--output",
               path)
        self.assertEqual(path.read_bytes()[:4], b"GIF8")
        done = subprocess.run(
            [SYSTEM, "-B", str(SCRIPTS / "animate.py"), str(self.home / "flat"),
             "--output", str(self.home / "film.mp4")], text=True,
            capture_output=True, env={**os.environ, "PATH": str(self.home)})
        self.assertEqual(done.returncode, 1)
        self.assertIn("needs ffmpeg", done.stderr)
        self.assertFalse((self.home / "film.mp4").exists())

    def test_help(self):
        for word in ("plot", "animate"):
            for option in ("--help", "-h"):
                said = limber(word, option)
                self.assertIn(f"limber {word} RUN", said)
                self.assertIn("--enlarge", said)

    def test_a_python_that_is_not_there(self):
        said = limber("plot", self.home / "flat", expected=3,
                      environment={"LIMBER_PYTHON": "/no/such/python"})
        self.assertIn("cannot be started", said)

    def test_a_study(self):
        folder = self.home / "study"
        folder.mkdir()
        columns = ["method", "cells", "outcome", "tip value", "tip error",
                   "tip Pareto", "closed form", "beyond", "CPU seconds"]
        rows = [["none", 2, "finished", 1.5, 0.5, 1, "nan", "", 1],
                ["none", 4, "finished", 1.2, 0.2, 1, "nan", "", 4],
                ["cell", 2, "finished", 1.1, 1e-14, 1, "nan", "", 1.1],
                ["cell", 4, "lost points", "nan", "nan", 0, "nan", "", 2]]
        (folder / "study.csv").write_text("\n".join(
            ",".join(map(str, row)) for row in [columns, *rows]) + "\n")
        (folder / "study.json").write_text(json.dumps({
            "title": "Tip", "caption": "by hand", "measures": ["tip"],
            "variations": ["cells"], "horizontal": "CPU seconds",
            "horizontal label": "CPU seconds", "vertical label": "",
            "against cost": True, "logarithmic": "both",
            "error levels": [0.1], "closed forms": {}}))
        draw("plot", folder)
        self.assertEqual(png_size(folder / "study.png")[0], 1600)
        text = (folder / "study.svg").read_text()
        for words in ("error of the tip", "4: lost points", "1e-14", "none"):
            self.assertIn(f"{words}</text>", text)
        self.refused("A study is drawn alone", "plot", folder, "--field", "a")
        self.refused("is a study", "animate", folder)


class Scripts(unittest.TestCase):
    def test_without_numpy_there_is_a_message(self):
        """A Python without the modules: one line, no traceback."""
        with tempfile.TemporaryDirectory() as folder:
            for module in ("numpy", "matplotlib", "scipy"):
                (Path(folder) / f"{module}.py").write_text(
                    "raise ModuleNotFoundError('hidden')\n")
            scripts = [*SCRIPTS.glob("*.py"),
                       *(TOP / "contrib/studies").glob("*.py")]
            no_modules = {"advice_table.py", "all_studies.py",
                          "cut_positions.py", "make_bracket.py",
                          "make_sphere.py", "oedometer_reference.py"}
            libraries = {"run_folder.py"}
            self.assertGreater(len(scripts), 15)
            for script in scripts:
                if script.name in no_modules | libraries:
                    continue
                done = subprocess.run(
                    [SYSTEM, "-B", str(script), "x"], text=True,
                    capture_output=True,
                    env={**os.environ, "PYTHONPATH": folder})
                self.assertEqual(done.returncode, 1, script)
                self.assertIn("has no numpy", done.stderr, script)
                self.assertNotIn("Traceback", done.stderr, script)

    def test_palette(self):
        """In every study that comes along methods can be told apart, and look
        the same wherever they occur."""
        self.run_python(PALETTE, *sorted((TOP / "prm/studies").glob("*.prm")))

    def run_python(self, program, *words):
        """A program that asserts; its words begin with the scripts' folder."""
        kept = sys.argv
        sys.argv = ["-c", *map(str, (SCRIPTS, *words))]
        try:
            exec(program, {"__name__": "__main__"})
        except SystemExit as end:
            self.fail(end.code)
        finally:
            sys.argv = kept

    def test_gaps_between_points_that_were_pulled_apart(self):
        self.run_python(GAPS)

    def test_squares_join_but_cracks_of_a_cell_stay(self):
        self.run_python(SQUARES)

    def test_short_units(self):
        self.run_python(UNITS)

    def test_charts_say_what_failed(self):
        self.run_python(FAILED)

    def test_flat_bodies_stand_in_rows(self):
        self.run_python(ROWS)

    def test_lines_of_a_chart_differ(self):
        self.run_python(STYLES)

    def test_pictures_in_space_are_no_mirror_images(self):
        self.run_python(HANDED)

    def test_a_shadow_lies_beside_what_throws_it(self):
        self.run_python(SHADOW)

    def test_kernels_without_and_with_a_treatment(self):
        self.run_python(RIVALS)

    def test_lines_and_panels_that_coincide(self):
        self.run_python(COINCIDE)

    def test_a_study_names_what_is_drawn(self):
        self.run_python(DRAWN)

    def test_texts_beside_points_cover_nothing(self):
        self.run_python(TEXTS)

    def test_lines_with_common_ends(self):
        self.run_python(ENDS)

    def test_obstacles_in_three_dimensions(self):
        self.run_python(OBSTACLES)


# Spheres that stand 1.7 diameters apart make a surface; a slot of five spacings stays.
GAPS = """
import sys
sys.path.insert(0, sys.argv[1])
from charts import np
import spheres
x, y = np.meshgrid(np.arange(20.), np.arange(20.))
places = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
slot = abs(places[:, 0] - 9.5) > 2
camera = spheres.Camera(np.zeros(3), np.array([19, 19, 1.]), 0, 0, 1, 380)
red = np.tile([1., 0, 0], (len(places), 1))
for wanted, kept in ((1, slot | True), (0, slot)):
    picture = spheres.render(camera, places[kept], red[kept], 0.3)
    middle = picture[40:-40, 184:196, 3] if not wanted else picture[
        20:-40, 20:-20, 3]
    assert (middle == wanted).all(), (wanted, middle.mean())
"""

# A block of 20 x 20 squares: its outline is its own, also where it stands at the side
# of the grid; a gap of one row is filled by its neighbours, one of two rows stays.
SQUARES = """
import sys
sys.path.insert(0, sys.argv[1])
from charts import np
import squares
x, y = np.meshgrid(np.arange(20) + 0.5, np.arange(20) + 0.5)
places = np.stack([x.ravel(), y.ravel()], axis=1)
low, high = np.array([0., -2]), np.array([22., 22])
def seen(missing):
    kept = places[~np.isin(places[:, 1], missing)]
    owner = squares.owners(kept, np.ones(len(kept)), low, high, (low, high), 440)
    assert owner.shape == (480, 440), owner.shape
    return kept, owner
kept, owner = seen([])
assert (owner[40:440, :400] >= 0).all() and (owner >= 0).sum() == 400**2
assert (kept[owner[50, 30]] == [1.5, 0.5]).all()
kept, owner = seen([9.5])
assert (owner[40:440, :390] >= 0).all()  # its mouth is rounded
assert kept[owner[225, 30]][1] == 8.5 and kept[owner[235, 30]][1] == 10.5
_, owner = seen([9.5, 10.5])
assert (owner[222:258, :399] < 0).all()
"""

UNITS = """
import sys
sys.path.insert(0, sys.argv[1])
import charts
assert charts.scaled_unit("Pa", 2e6) == (1e6, "MPa")
assert charts.scaled_unit("Pa", 0.2) == (1, "Pa")
assert charts.scaled_unit("s", 0.) == (1, "s")
assert charts.with_time(0.2, 0.3) == "t = 0.2 s"
assert charts.with_time(0, 0.02) == "t = 0 ms"
assert charts.with_time(2e-5, 2e-5) == "t = 20 µs"
"""

# A ball at the height of 2 over the floor, seen from above: lit disc of its own size,
# shadow to the right of it by 0.35 of the height, nothing far away.
SHADOW = """
import sys
sys.path.insert(0, sys.argv[1])
from charts import np
import spheres
place = np.array([[5., 2., 5.]])
camera = spheres.Camera(np.zeros(3), np.array([10, 4, 10.]), 0, 90, 1, 400)
picture = spheres.render(camera, place, np.array([[1., 1, 0]]), 0.5)
disc = np.argwhere(picture[..., 3] > 0)
assert abs(len(disc) / (np.pi * 20**2) - 1) < 0.1, len(disc)
assert abs(disc.mean(axis=0) - 200).max() < 2
lit = picture[picture[..., 3] > 0][:, :3].mean(axis=0)
assert lit[0] > 0.7 and lit[1] > 0.7 and lit[2] < 0.2, lit
dark = spheres.shadow(camera, place, 0.5, 0., 1)
row, column = np.unravel_index(dark.argmax(), dark.shape)
assert abs(row - 200) < 3 and abs(column - 228) < 3, (row, column)
assert dark.max() <= 1 and dark[:79].max() < 1e-9  # six radii off
"""

# What is named alike but differs is told apart; others look as in any chart.
STYLES = """
import sys
sys.path.insert(0, sys.argv[1])
import charts
names = ["lin none", "cell", "quad none", "new none"]
styles = charts.styles_of(names)
assert styles["cell"] == charts.style_of("cell")
assert styles["lin none"] == charts.style_of("lin none")
looks = {tuple(map(str, style.values())) for style in styles.values()}
assert len(looks) == 4, styles
"""

# Right, up and towards the eye are right-handed, whatever points upwards.
HANDED = """
import sys
sys.path.insert(0, sys.argv[1])
from charts import np
import spheres
for up in range(3):
    for view in (0, 0), (30, 20), (200, 50):
        camera = spheres.Camera(np.zeros(3), np.ones(3), *view, up, 100)
        assert abs(np.linalg.det(camera.turn) - 1) < 1e-12, (up, view)
        assert camera.turn[1] @ np.eye(3)[up] > 0, (up, view)
"""

# Two panels, the same colour for a kernel in both, finite elements in both; a chart
# with fewer kernels stays one.
RIVALS = """
import sys
sys.path.insert(0, sys.argv[1])
import charts, plot_study
meta = {"title": "t", "caption": "c", "measures": ["tip"], "variations": ["cells"],
        "horizontal": "CPU seconds", "horizontal label": "CPU seconds",
        "vertical label": "", "against cost": True, "logarithmic": "both",
        "error levels": [], "closed forms": {}}
methods = ["linear none", "linear cell", "GIMP none", "GIMP node", "CPDI none",
           "CPDI node", "FEM Q1"]
rows = [{"method": m, "cells": str(n), "outcome": "finished", "beyond": "",
         "tip value": str(k + n), "tip error": str(k + n), "tip Pareto": "0",
         "CPU seconds": str(n * (k + 1))}
        for k, m in enumerate(methods) for n in (1, 2)]
figure = plot_study.draw(rows, meta)
bare, cured = figure.axes
assert [len(axis.lines) for axis in (bare, cured)] == [4, 4]
colours = [{line.get_color() for line in axis.lines} for axis in (bare, cured)]
assert colours[0] == colours[1] and len(colours[0]) == 4, colours
assert bare.get_xlim() == cured.get_xlim() and bare.get_ylim() == cured.get_ylim()
few = [row for row in rows if not row["method"].startswith("CPDI")]
assert len(plot_study.draw(few, meta).axes) == 1
assert charts.kernel_and_treatment("initial assumed strain") == ("initial",
                                                                 "assumed strain")
assert charts.kernel_and_treatment("CPDI node with USL") is None
"""

# What repeats a measure has no panel; of lines that coincide the first is wider.
COINCIDE = """
import sys
sys.path.insert(0, sys.argv[1])
import plot_study
rows = [{"method": m, "outcome": "finished", "beyond": "", "n": str(n),
         "a value": str(v), "a error": str(v), "b value": str(v),
         "b error": str(v)}
        for m, v in (("none", 1), ("cell", 1.001), ("node", 2))
        for n in (1, 2)]
meta = {"title": "", "caption": "", "measures": ["a", "b"], "variations": ["n"],
        "horizontal": "n", "horizontal label": "n", "vertical label": "",
        "against cost": False, "logarithmic": "none", "error levels": [],
        "closed forms": {}}
figure = plot_study.draw(rows, meta)
assert len(figure.axes) == 1, figure.axes
widths = [line.get_linewidth() for line in figure.axes[0].lines]
assert widths[0] > widths[1] == widths[2], widths
"""

# Cells of three sizes at the start; squares of points are half a cell wide, those of
# liquids half as large again, and their areas are that of the water.
LEVELS = """
import sys
sys.path.insert(0, sys.argv[1])
from charts import np
import fields, panels
source = fields.Source(sys.argv[2])
lower, upper = source.cells(0)
edges = np.unique((upper - lower).round(9))
assert (edges == [0.0625, 0.125, 0.25]).all(), edges
state = panels.State(source, 0, panels.Look("pressure", grid=True))
assert set(np.unique((state.sizes / 1.5).round(9))) <= set(edges / 2), state.sizes
assert abs(((state.sizes / 1.5)**2).sum() - 2) < 1e-9
print(len(lower))
"""

# Three lines or more that lie on each other are one, which says so; the legend has
# all. Texts cover neither lines nor points nor each other.
TEXTS = """
import sys
sys.path.insert(0, sys.argv[1])
from charts import np
import plot_study
def study(lines, cost):
    rows = [{"method": m, "outcome": "finished", "beyond": "", "n": str(k),
             "CPU seconds": str(x), "a value": str(y), "a error": str(y),
             "a Pareto": "0"} for m, line in lines.items()
            for k, (x, y) in enumerate(line)]
    return plot_study.draw(rows, {
        "title": "", "caption": "", "measures": ["a"], "variations": ["n"],
        "horizontal": "CPU seconds" if cost else "n", "horizontal label": "n",
        "vertical label": "", "against cost": cost, "logarithmic": "both"
        if cost else "none", "error levels": [], "closed forms": {}})
same = [(1, 1.), (2, 2.), (3, 3.)]
figure = study({"none": same, "cell": same, "node": same, "hybrid": [(1, 3.)]},
               False)
texts = [text.get_text().replace("\\n", " ") for text in figure.axes[0].texts]
assert texts == ["none, cell, node coincide"], texts
names = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
assert names == ["none", "cell", "node", "hybrid"], names
seen = [line for line in figure.axes[0].lines if len(line.get_xdata())]
assert len(seen) == 2, seen
# two methods are still two lines
figure = study({"none": same, "cell": same}, False)
assert not figure.axes[0].texts

random = np.random.RandomState(3)
lines = {f"none with {k}": sorted((1 + 0.2 * random.rand(4 - k % 2, 2)).tolist())
         for k in range(8)}
figure = study(lines, True)
axis = figure.axes[0]
figure.canvas.draw()
boxes = [text.get_window_extent() for text in axis.texts if text.get_text()]
assert len(boxes) > 4, boxes
for k, box in enumerate(boxes):
    assert not any(box.overlaps(other) for other in boxes[:k]), axis.texts[k]
    for line in axis.lines:
        if line.get_transform() != axis.transData:
            continue
        corners = axis.transData.transform(np.column_stack(line.get_data()))
        for a, b in zip(corners, corners[1:]):
            along = a + np.linspace(0, 1, 500)[:, None] * (b - a)
            assert not any(box.x0 + 2 < x < box.x1 - 2 and
                           box.y0 + 2 < y < box.y1 - 2 for x, y in along), k
"""

# Where all lines begin and end alike the caption says it once.
ENDS = """
import sys
sys.path.insert(0, sys.argv[1])
import plot_study
meta = {"title": "", "caption": "", "measures": ["a"], "variations": ["cells"],
        "horizontal": "CPU seconds", "horizontal label": "CPU seconds",
        "vertical label": "", "against cost": True, "logarithmic": "both",
        "error levels": [], "closed forms": {}}
def captions(cells):
    rows = [{"method": m, "cells": str(n), "outcome": "finished", "beyond": "",
             "a value": str(1 / n), "a error": str(1 / n), "a Pareto": "0",
             "CPU seconds": str((k + 2) * n)}
            for k, m in enumerate(("none", "cell")) for n in cells[k]]
    figure = plot_study.draw(rows, meta)
    return figure._supxlabel.get_text(), [t.get_text() for t in
                                          figure.axes[0].texts if t.get_text()]
said, texts = captions([(3, 6), (3, 6)])
assert "Lines go from 3 at the left to 6 at the right (cells)." in said, said
assert not texts, texts
said, texts = captions([(3, 6), (3, 7)])
assert "Numbers at the ends of lines: cells." in said, said
assert sorted(texts) == ["3", "3", "6", "7"], texts
"""

# Depths that a camera along z sees: tops of a ball, a box, a turned cylinder, a
# formula and facets, also where they reach out of the box; a plane as its outline.
OBSTACLES = """
import struct, sys, tempfile
sys.path.insert(0, sys.argv[1])
from charts import np
import solids, spheres
lower, upper = np.zeros(3), np.array([4., 4, 4])
camera = spheres.Camera(lower, upper, 0, 0, 1, 400)
def top(entries, x, y, time=0.):
    names = {"Obstacles": "a", **{f"Obstacle a/{k}": v for k, v in entries.items()}}
    depth = solids.depths(camera, names, time, lower, upper)
    return None if depth is None else depth[400 - int(100 * y), int(100 * x)]
def near(value, expected):
    assert abs(value - expected) < 1e-3, (value, expected)
ball = {"Shape": "ball", "Ball/Centre": "1, 1, 1", "Ball/Radius": "0.5",
        "Displacement": "t; 0; 2*t"}
near(top(ball, 1, 1), 1.5)
near(top(ball, 1.3, 1), 1.4)
assert top(ball, 1.6, 1) == -np.inf
near(top(ball, 2, 1, 1.), 3.5)
box = {"Shape": "box", "Box/Lower corner": "1, 1, 1", "Box/Upper corner": "2, 2, 9",
       "Centre": "1, 1, 1", "Rotation": "t", "Axis": "0, 0, 1"}
near(top(box, 1.5, 1.5), 4)  # cut at the side of what is seen
assert top(box, 0.5, 1.5) == -np.inf
near(top(box, 0.5, 1.5, np.pi / 2), 4)
cylinder = {"Shape": "cylinder", "Cylinder/Axis": "y", "Cylinder/Centre": "1, 0, 1",
            "Cylinder/Radius": "0.5", "Cylinder/Lower end": "1",
            "Cylinder/Upper end": "2"}
near(top(cylinder, 1.3, 1.5), 1.4)
assert top(cylinder, 1.3, 2.1) == -np.inf
formula = {"Shape": "formula", "Formula/Inside": "1 - (x - 2)^2 - (y - 2)^2 - z^2"}
near(top(formula, 2.6, 2), 0.8)
block = {"Shape": "block", "Block/Corners": "0,0,0; 1,0,0; 1,1,0; 0,1,0; "
         "0,0,1; 1,0,1; 1,1,1; 0,1,1"}
near(top(block, 0.5, 0.25), 1)
both = {"Shape": "union", "Union/Shapes": "one, two",
        **{f"Union/Shape one/{k}": v for k, v in ball.items()},
        **{f"Union/Shape two/{k}": v for k, v in block.items()}}
near(top(both, 1, 1.2), 1 + 0.21**0.5)
near(top(both, 0.5, 0.25), 1)
with tempfile.NamedTemporaryFile(suffix=".stl") as file:
    facets = solids._facets_of_block(
        {"a/Corners": block["Block/Corners"]}, "a")
    file.write(b" " * 80 + struct.pack("<I", len(facets)) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *facet.ravel(), 0) for facet in facets))
    file.flush()
    stl = {"Shape": "stl", "STL/File": file.name, "STL/Scale": "2",
           "STL/Rotation": "0, 0, 90", "STL/Translation": "2, 0, 3"}
    near(top(stl, 1.2, 0.7), 4)  # from z = 3 to 5
    stl["STL/Translation"] = "2, 0, 0"
    near(top(stl, 1.2, 0.7), 2)
    assert top(stl, 2.2, 0.7) == -np.inf
    low, high = next(solids.around({"Obstacles": "a", **{
        f"Obstacle a/{k}": v for k, v in stl.items()}}, 0.))
    assert abs(low - [0, 0, 0]).max() < 1e-6 and abs(high - 2).max() < 1e-6
plane = {"Obstacles": "a", "Obstacle a/Shape": "half-space",
         "Obstacle a/Half-space/Point": "0, 1, 0",
         "Obstacle a/Half-space/Normal": "-1, 1, 0"}
assert solids.depths(camera, plane, 0., lower, upper) is None
(corners,) = solids.polygons(plane, 0., lower, upper)
assert len(corners) == 4, corners
assert abs(corners[:, 1] - corners[:, 0] - 1).max() < 1e-12
edges = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1)
assert np.allclose(sorted(edges), [4, 4, 3 * 2**0.5, 3 * 2**0.5]), edges
# What is in front hides what is behind: a ball before and behind a point.
place, blue = np.array([[1., 1, 2]]), np.array([[0., 0, 1]])
names = {"Obstacles": "a", **{f"Obstacle a/{k}": v for k, v in ball.items()}}
for time, colour in ((0., True), (0.7, False)):
    depth = solids.depths(camera, {**names, "Obstacle a/Displacement": "0; 0; 2*t"},
                          time, lower, upper)
    pixel = spheres.render(camera, place, blue, 0.2, depth)[300, 100]
    assert (pixel[2] > 2 * pixel[0]) == colour, pixel
    assert pixel[3] == 1
"""

# Of many methods and measures those are drawn that the study names, and the
# caption says how many more there are; all where it names none that was run.
DRAWN = """
import sys
sys.path.insert(0, sys.argv[1])
import plot_study
rows = [{"method": m, "outcome": "finished", "beyond": "", "n": "1",
         "a value": str(v), "a error": str(v), "b value": str(v + 1),
         "b error": str(v + 1)}
        for m, v in (("none", 1), ("cell", 2), ("node", 3))]
meta = {"title": "", "caption": "", "measures": ["a", "b"], "variations": ["n"],
        "drawn methods": ["none", "node"], "drawn measures": ["b"],
        "horizontal": "n", "horizontal label": "n", "vertical label": "",
        "against cost": False, "logarithmic": "none", "error levels": [],
        "closed forms": {}}
def methods(figure):
    return [text.get_text() for text in
            figure.axes[-1].get_legend().get_texts()]
figure = plot_study.draw(rows, meta)
assert len(figure.axes) == 1, figure.axes
assert methods(figure) == ["none", "node"], methods(figure)
assert "1 more method is in the table" in figure._supxlabel.get_text()
figure = plot_study.draw(rows, {**meta, "drawn methods": ["hybrid"]})
assert methods(figure) == ["none", "cell", "node"], methods(figure)
assert "more" not in figure._supxlabel.get_text()
"""

# What has failed is a cross of its own, and the legend says why.
FAILED = """
import sys
sys.path.insert(0, sys.argv[1])
import plot_study
rows = [{"method": m, "outcome": outcome, "beyond": "", "n": "1",
         "cost": "1", "a value": v, "a error": v, "a Pareto": "0"}
        for m, outcome, v in (("none", "finished", "1"), ("cell", "lost points", ""),
                              ("node", "lost points", ""))]
meta = {"title": "", "caption": "", "measures": ["a"], "variations": ["n"],
        "horizontal": "cost", "horizontal label": "cost", "vertical label": "",
        "against cost": True, "logarithmic": "none", "error levels": [],
        "closed forms": {}}
axis = plot_study.draw(rows, meta).axes[0]
texts = [text.get_text().replace("\\n", " ") for text in
         axis.get_legend().get_texts()]
assert texts == ["none", "cell at 1: lost points", "node at 1: lost points"], texts
crosses = [float(line.get_ydata()[0]) for line in axis.lines
           if line.get_marker() == "x"]
assert len(set(crosses)) == 2, crosses
"""

# Pictures of a flat body stand in rows.
ROWS = """
import sys
sys.path.insert(0, sys.argv[1])
import panels
shape = [[len(row) for row in panels._below_each_other(list(range(n)), aspect)]
         for n, aspect in ((4, 1.), (4, 0.5), (4, 0.1), (3, 0.3), (3, 0.5),
                            (2, 0.1))]
assert shape == [[4], [2, 2], [1] * 4, [1] * 3, [2, 1], [1, 1]], shape
"""

PALETTE = """
import re, sys
sys.path.insert(0, sys.argv[1])
import charts
count = 0
for path in sys.argv[2:]:
    with open(path) as study:
        found = re.search(r"^set Methods *= *(.*)$", study.read(), re.M)
    methods = [m.strip() for m in found[1].split(",")]
    looks = {}
    for method in methods:
        look = tuple(charts.style_of(method).values())
        if look in looks:
            sys.exit(f"{path}: '{method}' looks like '{looks[look]}'")
        looks[look] = method
        count += 1
assert count > 100, count
"""


def main():
    global LIMBER
    parser = argparse.ArgumentParser()
    parser.add_argument("--limber", required=True)
    arguments, rest = parser.parse_known_args()
    if not os.path.samefile(sys.executable, shutil.which(SYSTEM)):
        os.execv(shutil.which(SYSTEM), [SYSTEM, "-B", *sys.argv])
    LIMBER = arguments.limber
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(SCRIPTS))
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
