#!/usr/bin/env python3
"""Runs 'limber reference' and 'limber compare' and looks at what they find.

    references.py --limber build/release/limber --case frequencies
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
SINGLETON = {"OMPI_MCA_pml": "ob1",
             "OMPI_MCA_btl": "self,vader"}
CANTILEVER = TOP / "prm/cantilever.prm"
CANTILEVER_3D = TOP / "prm/verification/cantilever_3d.prm"
FREE_BEAM = TOP / "prm/verification/free_soft_beam.prm"
SLOPE = TOP / "prm/benchmarks/slope_stability.prm"
OEDOMETER = TOP / "prm/verification/oedometer.prm"
TUBE = TOP / "prm/verification/plastic_tube.prm"
STRIP = TOP / "prm/verification/strip_load.prm"
STRETCHED = TOP / "prm/studies/scenes/strip.prm"
MANUFACTURED = TOP / "prm/verification/manufactured_solution.prm"
FAILED = []


def limber(*words, changes=(), code=0):
    """Runs the program, says what it said if the exit code is another."""
    command = [PROGRAM, *map(str, words)]
    for change in changes:
        command += ["--set", change]
    result = subprocess.run(command, env={**os.environ, **SINGLETON}, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if result.returncode != code:
        print(result.stdout)
        sys.exit(f"FAILED: exit code {result.returncode}, not {code}: "
                 + " ".join(command))
    return " ".join(result.stdout.split())


def expect(condition, text):
    print(("passed: " if condition else "FAILED: ") + text)
    if not condition:
        FAILED.append(text)


def frequencies(folder):
    """Plane-strain elasticity by fine Q2 meshes, to 0.1 %."""
    nu = "Body beam/Neo hookean/Poisson's ratio="
    for name, scene, poisson, first in (
            ("clamped", CANTILEVER, "0.3", (0.082812, 0.48377, 1.03878)),
            ("clamped, nu = 0.49", CANTILEVER, "0.49", (0.091135,)),
            ("free", FREE_BEAM, "0.3", (3.3990,)),
            ("free, nu = 0.45", FREE_BEAM, "0.45", (3.6006,)),
            ("free, nu = 0.499", FREE_BEAM, "0.499", (3.6963,))):
        run = folder / name
        limber("reference", "--frequencies", 3, scene, "--output-directory",
               run, changes=(nu + poisson, "Reference/Elements over depth=8"))
        found = [float(line.split()[1])
                 for line in (run / "frequencies").read_text().splitlines()
                 if not line.startswith("#")]
        for mode, (value, known) in enumerate(zip(found, first), start=1):
            expect(abs(value / known - 1) < 1e-3,
                   f"{name}, mode {mode}: {value:.6g} Hz, known {known} Hz")


def comparison(folder):
    """A run against elements, elements against finer ones, a finer run."""
    common = ("End time=3", "Output/Time interval=1.5",
              "Body beam/Neo hookean/Poisson's ratio=0.3")
    reference, coarse, fine = folder / "fem", folder / "run", folder / "fine"
    words = ("reference", CANTILEVER, "--output-directory", reference)
    # The checks are of a longer run.
    limber(*words, changes=common, code=4)
    expect("in " + str(reference) + " already" in
           limber(*words, changes=common, code=4), "a reference is used again")
    limber(*words, changes=(*common, "Reference/Element=Q1"), code=1)
    for run, cells in ((coarse, "36, 20"), (fine, "72, 40")):
        limber(CANTILEVER, "--output-directory", run, code=4,
               changes=(*common, "Output/Point arrays=true",
                        "Grid/Cells=" + cells))

    errors = {}
    for name, run, other in (("coarse", coarse, reference),
                             ("fine", fine, reference),
                             ("runs", coarse, fine),
                             ("itself", coarse, coarse),
                             ("elements", reference, reference)):
        limber("compare", run, other)
        errors[name] = json.loads((run / "comparison.json").read_text())
        print(name, json.dumps(errors[name]["fields"]))

    def error(name, field="displacement"):
        return errors[name]["fields"][field]["relative_l2"]

    expect(error("coarse") < 0.02, "four cells over the depth: 2 %")
    expect(error("fine") < 0.5 * error("coarse"), "twice as many: half of it")
    expect(error("runs") < 0.02, "coarse against fine run: 2 %")
    expect(max(error("itself"), error("itself", "stress")) < 1e-6,
           "a run against itself: interpolation only")
    expect(error("elements") < 1e-12, "elements against themselves")
    expect(error("elements", "stress") < 0.04, "nodal stress against that within")
    tip = errors["coarse"]["observables"]["tip"]["relative_l2"]
    expect(tip < 0.03, f"tip over time: {tip:.2g}")


def exact(folder):
    """The manufactured solution: points and elements against its formula."""
    changes = ("Output/Time interval=0.25",)
    limber(MANUFACTURED, "--output-directory", folder / "run",
           changes=(*changes, "Output/Point arrays=true"))
    limber("reference", MANUFACTURED, "--output-directory", folder / "fem",
           changes=(*changes, "Reference/Elements over depth=16",
                    "Reference/Time step=0.01"))
    # velocities of points are noisier, as FLIP never smoothes them
    for name, limits in (("run", (3e-3, 3e-2)), ("fem", (2e-4, 3e-4))):
        limber("compare", folder / name, "exact")
        fields = json.loads((folder / name / "comparison.json")
                            .read_text())["fields"]
        for field, limit in zip(("displacement", "velocity"), limits):
            error = fields[field]["relative_l2"]
            expect(error < limit, f"{name}, {field}: {error:.2g}")
        expect(fields["pressure"]["relative_l2"] is None,
               "what the scene does not give is not compared")


def levels(folder):
    """Cells of two sizes against elements and an exact solution: an error between
    those of coarse and of fine cells, also of points that were split on the way,
    and that of fine cells where all that holds points is fine."""
    part = ("Grid/Levels=1", "Grid/Refine=part")
    root = (*part, "Grid/Refine part/Where=8/3 - x")
    grows = (*part, "Grid/Refine part/Where=1 + 2.5*t - x")
    whole = (*part, "Grid/Refine part/Criterion=body",
             "Grid/Refine part/Bodies=beam")
    common = ("End time=3", "Output/Time interval=1.5",
              "Body beam/Frame=current", "Body beam/Locking treatment=cell",
              "Body beam/Neo hookean/Poisson's ratio=0.3", "Method/Kernel=linear")
    for scene, coarse, fine in (
            (CANTILEVER, "36, 20", "72, 40"),
            (CANTILEVER_3D, "18, 6, 6", "36, 12, 12")):
        reference = folder / scene.stem / "fem"
        limber("reference", scene, "--output-directory", reference, code=4,
               changes=(*common, "Reference/Elements over depth=2"))
        errors, split = {}, {}
        for name, changes in (
                ("coarse", ("Grid/Cells=" + coarse,)),
                ("fine", ("Grid/Cells=" + fine,)),
                ("root", ("Grid/Cells=" + coarse, *root)),
                ("grows", ("Grid/Cells=" + coarse, *grows)),
                ("whole", ("Grid/Cells=" + coarse, *whole))):
            run = folder / scene.stem / name
            limber(scene, "--output-directory", run, code=4,
                   changes=(*common, "Output/Point arrays=true", *changes))
            limber("compare", run, reference)
            found = json.loads((run / "comparison.json").read_text())
            expect(found["left_out"] == 0, f"{name}: every point is compared")
            errors[name] = {field: found["fields"][field]["relative_l2"]
                            for field in ("displacement", "stress")}
            split[name] = json.loads((run / "summary.json").read_text()).get(
                "adaptation", {}).get("points split", 0)
            print(scene.stem, name, errors[name])
        for field in ("displacement", "stress"):
            coarse_one, fine_one = (errors["coarse"][field],
                                    errors["fine"][field])
            expect(abs(errors["whole"][field] / fine_one - 1) < 1e-6,
                   f"{scene.stem}, {field}: fine where there are points")
            for name in ("root", "grows"):
                share = errors[name][field] / coarse_one
                expect(share < 0.75, f"{scene.stem}, {field}: fine at the root, "
                       f"'{name}', {share:.3g} of the error of coarse cells")
        expect(split["grows"] > 200, "points are split on the way")

    # Parts of points were where the exact displacement says.
    changes = ("Grid/Cells=16, 16", "Output/Time interval=0.125",
               "Output/Point arrays=true")
    moving = "Grid/Refine part/Where=0.2 - abs(x - 0.1 - 1.6*t)"
    errors = {}
    for name, more in (("square", ()), ("moving", (*part, moving))):
        limber(MANUFACTURED, "--output-directory", folder / name, code=4,
               changes=(*changes, "Check u/Tolerance=0", *more))
        limber("compare", folder / name, "exact")
        errors[name] = json.loads(
            (folder / name / "comparison.json").read_text())["fields"][
                "displacement"]["relative_l2"]
    expect(errors["moving"] < errors["square"],
           f"fine cells that pass: {errors['moving']:.3g}, without them "
           f"{errors['square']:.3g}")

    # Likewise where points are divided as they become longer, here ten times.
    run = folder / "strip"
    limber(STRETCHED, "--output-directory", run,
           changes=("End time=9", "Output/Time interval=9",
                    "Output/Point arrays=true",
                    "Body strip/Split stretched points=true",
                    "Exact solution/Displacement=x*t; 0"))
    limber("compare", run, "exact")
    error = json.loads((run / "comparison.json").read_text())[
        "fields"]["displacement"]["relative_l2"]
    expect(error < 0.015, f"points that were divided: {error:.3g}")


def ramp(folder):
    """A load that grows from zero on a body at rest is no instability."""
    loaded = folder / "loaded.prm"
    loaded.write_text(CANTILEVER.read_text() + """
subsection Loads
  set Face loads = shear
  subsection Face load shear
    set Body     = beam
    set Face     = right
    set Traction = 0; t
  end
end
""")
    scene = (loaded, "--output-directory")
    rest = ("Body beam/Initial velocity=0; 0", "Output/Replace=true",
            "Check first mode/Observable=tip", "Check first mode/Tolerance=1e9")

    def drifts(name, words, *changes, code=0):
        limber(*words, *scene, folder / name, changes=(*rest, *changes),
               code=code)
        rows = (folder / name / "statistics").read_text().splitlines()
        heads = [row for row in rows if row.startswith("#")]
        column = next(i for i, head in enumerate(heads) if "drift" in head)
        return [float(row.split()[column])
                for row in rows if not row.startswith("#")]

    for traction in ("0; t", "0; 1000*t", "0; 1e-3*t", "0; 100*t^3",
                     "0; if(t < 0.4, 0, t - 0.4)"):
        load = "Loads/Face load shear/Traction=" + traction
        for method in ("implicit", "explicit"):
            found = drifts("fem", ("reference",), load, "End time=1",
                           "Reference/Method=" + method)
            expect(abs(found[-1]) < 1e-3,
                   f"{method}, {traction}: drift {found[-1]:.2g} at the end")
            # Steps are not cut because round-off is taken for a force.
            expect(method == "explicit" or len(found) < 120,
                   f"{method}, {traction}: {len(found) - 1} steps")
        for order in ("usf", "usavg"):
            found = drifts("run", (), load, "End time=0.8",
                           "Method/Stress update=" + order)
            worst = max(map(abs, found))
            expect(worst < 0.3, f"run, {order}, {traction}: {worst:.2g} of 1")

    # Steps beyond the limit grow from the same load, and are stopped.
    load = "Loads/Face load shear/Traction=0; 1000*t"
    for step in ("0.004", "0.01"):
        found = drifts("fem", ("reference",), load, "End time=20",
                       "Reference/Method=explicit",
                       "Reference/Time step=" + step, code=2)
        expect(len(found) < 30, f"explicit, {step} s: after {len(found)} steps")
    found = drifts("run", (), load, "Method/Courant number=2.5", code=2)
    expect(len(found) < 60, f"run, unstable: after {len(found)} steps")


def flow(folder):
    """Limit loads of a tube and of a strip, and points against elements."""
    where = ("--output-directory", folder / "run")

    def limit(words, entry, below, above, *changes):
        """The body bears one load, which its check does not expect, no more."""
        for load, code in ((below, 4), (above, 2)):
            limber(*words, *where, code=code,
                   changes=("Output/Replace=true", f"{entry}={load}", *changes))
        expect(True, f"{entry} between {below} and {above} {changes}")

    # 2 k ln(b / a) = 1.3863 k
    pressure = "Loads/Face load pressure/Constants=p"
    for words, changes in ((("reference", TUBE), ()),
                           (("reference", TUBE), ("Reference/Element=Q1-P0-P0",)),
                           ((TUBE,), ())):
        limber(*words, *where, changes=("Output/Replace=true", *changes))
        limit(words, pressure, 1.372, 1.400, *changes)
    limber("reference", TUBE, *where, code=4,
           changes=("Output/Replace=true", pressure + "=2",
                    "Reference/Element=Q1"))
    expect(True, "Q1 locks and bears 2 k")

    # (2 + pi) c = 5.14 c
    limit(("reference", STRIP), "Loads/Face load strip/Constants=q", 5.1, 5.3)

    # clay between walls: all elements strain as one point (height 1 - 0.12116 m)
    reference = folder / "clay"
    limber("reference", OEDOMETER, "--output-directory", reference, code=4,
           changes=("End time=2.5", "Loads/Face load weight/Traction=0; -p",
                    "Check centre at the end/At time=2.5",
                    "Check wall at the end/At time=2.5",
                    "Reference/Method=quasi-static", "Reference/Elements=2, 2",
                    "Reference/Load steps=100"))
    summary = json.loads((reference / "summary.json").read_text())
    found = {check["name"]: check["value"] for check in summary["checks"]}
    expect(abs(found["centre"] - 0.43942) < 5e-5, "clay: height")
    expect(abs(found["wall"] - 115104) < 60, "clay: force on the wall")

    # strength over F: the slope stands at 1.35, not at 1.4
    soil = "Body soil/Drucker prager/"
    for c, phi, code in ((7407.4, 15.0886, 4), (7142.9, 14.5731, 2)):
        limber("reference", SLOPE, *where, code=code,
               changes=("Output/Replace=true", f"{soil}Cohesion={c}",
                        f"{soil}Friction angle={phi}"))
    expect(True, "a slope stands at F = 1.35 and fails at 1.4")

    reference = folder / "fem"
    limber("reference", STRIP, "--output-directory", reference,
           changes=("Reference/Elements=40, 40", "Reference/Load steps=10"))
    errors = []
    for cells in ("20, 22", "40, 44"):
        limber(STRIP, *where, changes=("Output/Replace=true", "Grid/Cells=" + cells,
                               "Method/Time step=0.1", "Output/Time interval=1",
                               "Output/Point arrays=true"))
        limber("compare", folder / "run", reference)
        found = json.loads((folder / "run/comparison.json").read_text())
        errors.append({field: found["fields"][field]["relative_l2"]
                       for field in ("displacement", "pressure", "stress")})
        print(cells, json.dumps(errors[-1]))
    expect(errors[0]["displacement"] < 0.13, "cells of 1/4 m: 13 %")
    expect(errors[1]["displacement"] < 0.6 * errors[0]["displacement"],
           "half the cells: half the error")
    expect(max(errors[1]["pressure"], errors[1]["stress"]) < 0.06,
           "pressure and stress: 6 %")


def refusals(folder):
    """What references cannot do is said."""
    water = TOP / "prm/dam_break.prm"
    for words, changes, message in (
            ((water,), (), "has no finite element reference"),
            ((CANTILEVER,), ("Boundaries/left=friction",
                             "Boundaries/Side left/Friction coefficient=0.3"),
             "knows no friction"),
            ((CANTILEVER,), ("Body beam/Shape=formula",
                             "Body beam/Formula/Inside=1",
                             "Body beam/Formula/Lower corner=0, 2",
                             "Body beam/Formula/Upper corner=8, 3"),
             "Mesh file"),
            ((CANTILEVER,), ("Reference/Mesh file=nowhere.msh",),
             "cannot be read")):
        said = limber("reference", *words, "--output-directory",
                      folder / "refused", changes=changes,
                      code=3 if "nowhere" in str(changes) else 1)
        expect(message in said, message)
    expect("two" in limber("compare", folder, code=1), "compare wants two")
    expect("limber reference" in
           limber("--frequencies", 3, CANTILEVER, code=1),
           "frequencies belong to references")


def main():
    global PROGRAM
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--limber", required=True)
    parser.add_argument("--case", required=True)
    arguments = parser.parse_args()
    PROGRAM = arguments.limber
    with tempfile.TemporaryDirectory(prefix="limber-") as folder:
        globals()[arguments.case](Path(folder))
    sys.exit(1 if FAILED else 0)


if __name__ == "__main__":
    main()
