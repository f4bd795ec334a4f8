#!/usr/bin/python3
"""How the kernels converge and what they keep: tables and charts of
doc/studies/column_stress.md and doc/studies/flying_ball.md.

    column_and_ball.py [--limber PROGRAM] [--target FOLDER] [--set ENTRY=VALUE]
                       [column] [ball]

column: the stress of prm/verification/column.prm at rest, against the exact
one, with 16 to 128 cells and at three sizes of strain. ball: energy, angular
momentum and shape of prm/studies/scenes/flying_ball.prm after two turns and a
hundred cells. Five minutes on one core.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "contrib/plot"))
import charts  # noqa: E402
from charts import np, plt  # noqa: E402
import run_folder  # noqa: E402


def run(arguments, scene, body, method, settings):
    """Folder and summary of a run in a new folder; the folder is None where
    the run has failed, and the summary then is what it ended with."""
    folder = Path(tempfile.mkdtemp(dir=arguments.scratch))
    command = [arguments.limber, str(TOP / "prm" / scene),
               "--output-directory", str(folder / "run")]
    for setting in [f"Body {body}/{s[1:]}" if s[0] == "." else s
                    for s in [*method, *settings, *arguments.set]]:
        command += ["--set", setting]
    done = subprocess.run(command, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True)
    folder = folder / "run"
    if done.returncode not in (0, 4):
        try:
            summary = json.loads((folder / "summary.json").read_text())
            return None, summary["failure"]
        except (OSError, KeyError, ValueError):
            sys.exit(f"{' '.join(command)}: {done.stderr.strip()}")
    return folder, json.loads((folder / "summary.json").read_text())


def caption(arguments, what):
    version = subprocess.run([arguments.limber, "--version"], text=True,
                             stdout=subprocess.PIPE).stdout.splitlines()[0]
    return f"{version}; `contrib/studies/column_and_ball.py {what}`\n"


# ---- the column ---------------------------------------------------------------

WEIGHT, LENGTH = 80 * 10, 50  # N/m^3, m

COLUMN_METHODS = {
    "linear, 2 x 2": ["Method/Kernel=linear", ".Points per cell edge=2"],
    "linear, 3 x 3": ["Method/Kernel=linear", ".Points per cell edge=3"],
    "quadratic, 2 x 2": ["Method/Kernel=quadratic", ".Points per cell edge=2"],
    "quadratic, 3 x 3": ["Method/Kernel=quadratic", ".Points per cell edge=3"],
    "CPDI, 2 x 2": ["Method/Kernel=cpdi", ".Points per cell edge=2"],
    "CPDI, 3 x 3": ["Method/Kernel=cpdi", ".Points per cell edge=3"],
    "initial frame, 2 x 2": ["Method/Kernel=linear", ".Frame=initial",
                             ".Points per cell edge=2"],
}
COLUMN_CELLS = (16, 32, 64, 128)
COLUMN_MODULI = {"1e7": 1, "1e6": 10, "1e5": 100}  # Pa, times softer


def column_error(arguments, method, cells, modulus):
    """Mean of |stress - exact| over the points, over the largest stress."""
    edge, slower = LENGTH / cells, COLUMN_MODULI[modulus]**0.5
    ramp = 6 * slower
    folder, summary = run(arguments, "verification/column.prm", "column",
                          method, [
        ".Locking treatment=none", f".Neo hookean/Young's modulus={modulus}",
        f".Box/Upper corner={edge}, {LENGTH}",
        f"Grid/Upper corner={edge}, {LENGTH + 2 * edge}",
        f"Grid/Cells=1, {cells + 2}", f"End time={2 * ramp}",
        f"Loads/Body force=0; -10*if(t < {ramp}, "
        f"0.5 - 0.5*cos(pi*t/{ramp}), 1)",
        f"Method/Damping rate={10 / slower}",
        f"Output/Time interval={2 * ramp}", "Output/Statistics interval=100",
        "Output/Fields=displacement, stress"])
    if folder is None:
        return np.nan, summary
    data = run_folder.points(run_folder.series(folder)[1][-1])
    place = data["position"][:, 1] - data["displacement"][:, 1]
    stress = data["stress"].reshape(len(place), -1)
    yy = stress[:, 4 if stress.shape[1] == 9 else 1]
    exact = -WEIGHT * (LENGTH - place)
    sinks = -data["displacement"][:, 1].min() / LENGTH
    return np.abs(yy - exact).mean() / (WEIGHT * LENGTH), sinks


def draw_column(curves, target):
    """The chart: errors for each (modulus, method) and COLUMN_CELLS."""
    figure, axes = plt.subplots(1, 3, figsize=(13, 4.4), sharey=True,
                                layout="constrained")
    for axis, modulus in zip(axes, COLUMN_MODULI):
        for name in COLUMN_METHODS:
            axis.loglog(COLUMN_CELLS, curves[modulus, name], markersize=5,
                        linewidth=1, label=name, **charts.style_of(name))
        begin = curves["1e7", "quadratic, 3 x 3"][0]
        for power in (1, 2):
            axis.loglog(COLUMN_CELLS, [begin * (COLUMN_CELLS[0] / n)**power
                                       for n in COLUMN_CELLS], "k:",
                        linewidth=power,
                        label=("first", "second")[power - 1] + " order")
        share = WEIGHT * LENGTH / float(modulus)
        axis.set_title(f"E = {modulus} Pa: stress over E up to {share:g}",
                       fontsize=9)
        axis.set_xticks(COLUMN_CELLS, COLUMN_CELLS)
        axis.minorticks_off()
        axis.set_xlabel("cells over the height")
        axis.grid(alpha=0.25)
    axes[0].set_ylabel("mean error of the stress over rho g l0")
    charts.legend_outside(axes[-1])
    charts.save(figure, target / "column_stress.png")


def column(arguments):
    rows, curves = [], {}
    for modulus in COLUMN_MODULI:
        for name, method in COLUMN_METHODS.items():
            errors, sinks = zip(*(column_error(arguments, method, n, modulus)
                                  for n in COLUMN_CELLS))
            curves[modulus, name] = errors
            order = [np.log2(a / b) for a, b in zip(errors, errors[1:])]
            words = [s if isinstance(s, str) else f"{e:.2e}"
                     for e, s in zip(errors, sinks)]
            rows.append(f"| {modulus} | {name} | " + " | ".join(words) + " | " +
                        " / ".join("-" if np.isnan(o) else f"{o:.1f}"
                                   for o in order) + " |")
            print(rows[-1], flush=True)
    draw_column(curves, arguments.target)
    text = ["# Column under its own weight: error of the stress", "",
            "![Column under its own weight](column_stress.png)", "",
            "An elastic column of 50 m without Poisson's effect comes to rest "
            "under its own weight;", "sigma_yy = - rho g (l0 - Y) at any "
            "deformation. Mean over the points of", "|sigma_yy - exact| / (rho g "
            "l0), with 16, 32, 64 and 128 cells, and the order from", "each to "
            "the next. No treatment. Dotted: first and second order.", "",
            "| E, Pa | method | 16 | 32 | 64 | 128 | order |",
            "| --- | --- | --: | --: | --: | --: | --- |", *rows, "",
            caption(arguments, "column")]
    (arguments.target / "column_stress.md").write_text("\n".join(text))


# ---- the ball -----------------------------------------------------------------

BALL_METHODS = {
    "linear, none": ["Method/Kernel=linear", ".Locking treatment=none",
                     ".Points per cell edge=2"],
    "linear, cell": ["Method/Kernel=linear", ".Locking treatment=cell",
                     ".Points per cell edge=2"],
    "linear, cell, 3 x 3": ["Method/Kernel=linear", ".Locking treatment=cell",
                            ".Points per cell edge=3"],
    "linear, assumed strain": ["Method/Kernel=linear",
                               ".Locking treatment=assumed strain",
                               ".Points per cell edge=2"],
    "quadratic, none, 3 x 3": ["Method/Kernel=quadratic",
                               ".Locking treatment=none",
                               ".Points per cell edge=3"],
    "quadratic, node, 3 x 3": ["Method/Kernel=quadratic",
                               ".Locking treatment=node",
                               ".Points per cell edge=3"],
    "quadratic, node, 2 x 2": ["Method/Kernel=quadratic",
                               ".Locking treatment=node",
                               ".Points per cell edge=2"],
    "quadratic, node, 3 x 3, APIC": ["Method/Kernel=quadratic",
                                     "Method/Transfer=apic",
                                     ".Locking treatment=node",
                                     ".Points per cell edge=3"],
    "quadratic, cell, 3 x 3": ["Method/Kernel=quadratic",
                               ".Locking treatment=cell",
                               ".Points per cell edge=3"],
    "CPDI, none, 2 x 2": ["Method/Kernel=cpdi", ".Locking treatment=none",
                          ".Points per cell edge=2"],
    "CPDI, node, 2 x 2": ["Method/Kernel=cpdi", ".Locking treatment=node",
                          ".Points per cell edge=2"],
    "CPDI, node, 3 x 3": ["Method/Kernel=cpdi", ".Locking treatment=node",
                          ".Points per cell edge=3"],
    "initial frame, assumed strain": ["Method/Kernel=linear",
                                      ".Frame=initial",
                                      ".Locking treatment=assumed strain",
                                      ".Points per cell edge=2"],
}
for name in ("linear, cell", "quadratic, node, 2 x 2",
             "initial frame, assumed strain"):
    BALL_METHODS[name + ", 20 cells"] = [*BALL_METHODS[name],
                                         "Grid/Cells=260, 74"]


def spin(data):
    """Angular momentum about the centre of mass."""
    mass = data["mass"]
    x, v = data["position"][:, :2], data["velocity"][:, :2]
    x = x - mass @ x / mass.sum()
    v = v - mass @ v / mass.sum()
    return (mass * (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0])).sum()


def radii(data):
    """Smallest and largest principal radius of inertia."""
    mass = data["mass"]
    x = data["position"][:, :2] - mass @ data["position"][:, :2] / mass.sum()
    return np.sqrt(np.linalg.eigvalsh((mass[:, None] * x).T @ x / mass.sum()))


def motion(first, last):
    """Angle of the best rigid motion with uniform stretch, in degrees, and the
    rms distance of the points from it over the radius of the ball, 1 m."""
    mass = first["mass"]
    a, b = (d["position"][:, :2] - mass @ d["position"][:, :2] / mass.sum()
            for d in (first, last))
    product = (mass[:, None] * a).T @ b
    angle = np.arctan2(product[0, 1] - product[1, 0], np.trace(product))
    turn = np.array([[np.cos(angle), np.sin(angle)],
                     [-np.sin(angle), np.cos(angle)]])
    stretch = (product * turn).sum() / (mass @ (a**2).sum(axis=1))
    distance = np.sqrt(mass @ ((b - stretch * a @ turn)**2).sum(axis=1) /
                       mass.sum())
    return np.degrees(angle), distance


def in_order(data, displacement):
    """The same points in the same order: by their initial places."""
    place = np.round(data["position"] - displacement, 5)
    order = np.lexsort(place.T)
    return {name: values[order] for name, values in data.items()}


def ball(arguments):
    rows, clouds = [], {}
    for name, method in BALL_METHODS.items():
        folder, summary = run(arguments, "studies/scenes/flying_ball.prm",
                              "ball", method, [])
        if folder is None:
            rows.append(f"| {name} | {summary} |" + " |" * 7)
            print(rows[-1], flush=True)
            continue
        first, last = (run_folder.points(f)
                       for f in run_folder.series(folder)[1][::len(
                           run_folder.series(folder)[1]) - 1])
        first, last = (in_order(d, d["displacement"]) for d in (first, last))
        table, _ = run_folder.statistics(folder)
        energy = table["kinetic energy"] + table["strain energy"]
        # of the spin alone: the flight of the centre is kept anyway
        flight = 0.5 * table["mass"][0] * (4**2 + 0.3**2)
        loss = energy[-1] - energy[0]
        small, large = radii(last)
        mean = np.hypot(small, large) / np.hypot(*radii(first)) - 1
        angle, distance = motion(first, last)
        cost = summary["cpu_seconds"]
        rows.append(
            f"| {name} | {100 * loss / (energy[0] - flight):+.2f} | "
            f"{100 * (spin(last) / spin(first) - 1):+.2f} | "
            f"{100 * mean:+.2f} | {100 * (large / small - 1):.2f} | "
            f"{100 * distance:.2f} | {angle:+.1f} | {cost:.1f} |")
        print(rows[-1], flush=True)
        clouds[name] = last
    names = [n for n in ("linear, cell", "quadratic, cell, 3 x 3",
                         "quadratic, node, 3 x 3", "CPDI, node, 3 x 3",
                         "initial frame, assumed strain") if n in clouds]
    figure, axes = plt.subplots(1, len(names), figsize=(3 * len(names), 3.3),
                                layout="constrained")
    for axis, name in zip(axes, names):
        x = clouds[name]["position"][:, :2]
        x = x - x.mean(axis=0)
        axis.add_patch(plt.Circle((0, 0), 1, fill=False, color="grey"))
        axis.plot(*x.T, ".", markersize=2)
        axis.set_title(name, fontsize=8)
        axis.set_aspect("equal")
        axis.set_xlim(-1.25, 1.25)
        axis.set_ylim(-1.25, 1.25)
        axis.set_xlabel("x from the centre of mass [m]", fontsize=8)
    axes[0].set_ylabel("y from the centre of mass [m]", fontsize=8)
    charts.save(figure, arguments.target / "flying_ball.png")
    text = ["# A rubber ball after two turns and a hundred cells", "",
            "![A rubber ball](flying_ball.png)", "",
            "What `prm/studies/scenes/flying_ball.prm` has gained at the end, in "
            "per cent: energy (kinetic", "and strain, over that of the spin), "
            "angular momentum, mean radius of inertia, the larger over", "the "
            "smaller principal radius of inertia less one, rms distance of the "
            "points from the best", "rigid motion with uniform stretch, over the "
            "radius; and the angle by which it is ahead of", "two turns, in "
            "degrees. Exact: nothing, as rubber in plane strain hardly yields to "
            "the spin.", "Ten cells over the radius, or as many as the method "
            "says. Grey in the picture: the circle at", "the start.", "",
            "| method | energy | angular momentum | radius | out of round | "
            "distance | angle | CPU seconds |",
            "| --- | --: | --: | --: | --: | --: | --: | --: |", *rows, "",
            caption(arguments, "ball")]
    (arguments.target / "flying_ball.md").write_text("\n".join(text))


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limber", default=str(TOP / "build/release/limber"))
    parser.add_argument("--target", type=Path, default=TOP / "doc/studies")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("what", nargs="*", choices=["column", "ball", []])
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        arguments.scratch = scratch
        for word in arguments.what or ("column", "ball"):
            {"column": column, "ball": ball}[word](arguments)


if __name__ == "__main__":
    main()
