#!/usr/bin/python3
"""Draws the scenes of prm/verification beside their exact solutions and prints
the numbers of doc/gallery/verification.

    verification.py [path of limber] [folder for the pictures] [scene ...]

Takes a minute on one core.
"""

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

SCENES = TOP / "prm/verification"


class Runner:
    def __init__(self, limber, pictures):
        self.limber, self.pictures = limber, Path(pictures)
        self.pictures.mkdir(parents=True, exist_ok=True)
        self.scratch = tempfile.TemporaryDirectory()
        self.count = 0

    def run(self, scene, *settings):
        """Returns the folder of the run."""
        self.count += 1
        folder = Path(self.scratch.name) / str(self.count)
        command = [self.limber, str(SCENES / f"{scene}.prm"),
                   "--output-directory", str(folder)]
        for setting in settings:
            command += ["--set", setting]
        done = subprocess.run(command, stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True)
        if done.returncode not in (0, 4):
            sys.exit(f"{scene}: {done.stderr.strip()}")
        return folder

    def save(self, figure, name):
        figure.tight_layout()
        charts.save(figure, self.pictures / f"{name}.png")


def last_points(folder):
    return run_folder.points(run_folder.series(folder)[1][-1])


def checks(folder):
    summary = json.loads((folder / "summary.json").read_text())
    return {check["name"]: check["value"] for check in summary["checks"]}


def tank(runner):
    """Pressure over depth after 4 s, and how the motion grows."""
    # Each line is thinner than the one below it, as they coincide.
    widths = dict(zip(("none", "cell without control", "cell",
                       "cell, Blend time = 0.16 s"), (6, 4, 2.2, 0.8)))
    variants = {"none": ["Body water/Locking treatment=none"],
                "cell without control": ["Body water/Hourglass control=0",
                                         "Body water/Checkerboard control=0"],
                "cell": [],
                "cell, Blend time = 0.16 s": ["Method/Blend time=0.16"]}
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    print("| hydrostatic tank, 4 s | largest kinetic energy over rho g H^2 W/2"
          " | error of the pressure (%) |\n| --- | --: | --: |")
    for name, settings in variants.items():
        folder = runner.run("hydrostatic_tank", "Output/Time interval=4",
                            "Output/Fields=pressure", *settings)
        values, _ = run_folder.statistics(folder)
        energy = values["kinetic energy"] / 4905
        right.semilogy(values["time"], np.maximum.accumulate(
            np.maximum(energy, 1e-33)), label=name,
                       **{**charts.line_of(name), "linestyle": "-",
                          "linewidth": widths[name]})
        data = last_points(folder)
        exact = 9810 * (1 - data["position"][:, 1])
        error = np.sqrt(((data["pressure"] - exact)**2).sum() /
                        (exact**2).sum())
        print(f"| {name} | {energy.max():.1e} | {100 * error:.1f} |")
        left.plot(data["pressure"] / 1e3, data["position"][:, 1], ".",
                  ms=2 * widths[name], mew=0,
                  color=charts.style_of(name)["color"])
    left.plot([9.81, 0], [0, 1], "k-")
    right.plot([], [], "k-", label="exact pressure")
    left.set(xlabel="pressure [kPa]", ylabel="y [m]")
    right.set(xlabel="time [s]", ylabel="largest kinetic energy so far\n/ (ρ g H² W/2)",
              ylim=(1e-18, 1e-8))
    charts.legend_outside(right)
    runner.save(figure, "hydrostatic_tank")


def column(runner):
    folder = runner.run("column", "Output/Time interval=5",
                        "Output/Fields=displacement, stress")
    data = last_points(folder)
    place = data["position"][:, 1] - data["displacement"][:, 1]
    stress = data["stress"].reshape(len(place), -1)
    yy = stress[:, 4 if stress.shape[1] == 9 else 1]
    exact = -80 * 10 * (50 - place)
    figure, axes = plt.subplots(figsize=(7, 4.4))
    axes.plot(exact / 1e3, place, "k-", label="exact")
    axes.plot(yy / 1e3, place, ".", ms=4, label="points",
              color=charts.TREATMENTS["cell"])
    axes.set(xlabel="vertical stress [kPa]",
             ylabel="height in the initial state [m]")
    charts.legend_outside(axes)
    runner.save(figure, "column")
    error = np.abs(yy - exact).mean() / (80 * 10 * 50)
    print(f"\ncolumn: mean error of the stress over rho g L: {error:.2e}")


def bar(runner):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    time = np.linspace(0, 32.5, 500)
    omega = 0.2 * np.pi
    for order in ("musl", "usavg"):
        folder = runner.run("bar", f"Method/Stress update={order}",
                            "Output/Statistics interval=1")
        values, _ = run_folder.statistics(folder)
        left.plot(values["time"], values["end"] / (1e-4 / omega),
                  label=order.upper(), lw=4 if order == "musl" else 1.5,
                  color=charts.style_of(order.upper())["color"])
        energy = values["total energy"] if "total energy" in values else (
            values["kinetic energy"] + values["strain energy"])
        right.plot(values["time"], 100 * (energy / energy[0] - 1),
                   color=charts.style_of(order.upper())["color"])
        print(f"bar, {order}: largest swing of the energy "
              f"{np.abs(energy / energy[0] - 1).max():.1e}, " +
              ", ".join(f"{n} {v:.6g}" for n, v in checks(folder).items()))
    left.plot(time, np.sin(omega * time), "k:", lw=1.5, label="exact")
    left.set(xlabel="time [s]", ylabel="displacement of the end / amplitude")
    right.set(xlabel="time [s]", ylabel="change of the total energy [%]")
    handles, labels = left.get_legend_handles_labels()
    right.legend(handles, labels, loc="upper left", bbox_to_anchor=(1.01, 1))
    runner.save(figure, "bar")


def manufactured_solution(runner):
    """Largest error of the displacement at t = 0.5 s against the edge."""
    figure, axes = plt.subplots(figsize=(7, 4.4))
    cells = np.array([8, 16, 32, 64])
    for name, settings in {
            "cell": [], "assumed strain": ["treatment=assumed strain"],
            "none": ["treatment=none"]}.items():
        errors = []
        for n in cells:
            folder = runner.run(
                "manufactured_solution", f"Grid/Cells={n}, {n}",
                "Output/Time interval=0.5", "Output/Fields=displacement",
                "Method/Stress update=usavg",
                *["Body square/Locking " + s for s in settings])
            data = last_points(folder)
            place = data["position"][:, :2] - data["displacement"][:, :2]
            x, y = np.pi * place.T
            exact = 1e-6 * np.array([np.sin(x) * np.cos(y),
                                     0.5 * np.cos(x) * np.sin(y)]).T
            errors.append(np.sqrt(((data["displacement"][:, :2] - exact)**2)
                                  .sum(axis=1).mean()) / 1e-6)
        axes.loglog(1 / cells, errors, label=name,
                    **charts.style_of(name))
        ratios = [a / b for a, b in zip(errors, errors[1:])]
        print(f"manufactured solution, {name}: errors "
              + ", ".join(f"{e:.2e}" for e in errors) + "; ratios "
              + ", ".join(f"{r:.2f}" for r in ratios))
    axes.loglog(1 / cells, 0.5 * errors[0] * (cells[0] / cells)**2, "k:",
                label="second order")
    axes.set_xticks(1 / cells, [f"1/{n}" for n in cells])
    axes.minorticks_off()
    axes.set(xlabel="edge of a cell [m]",
             ylabel="rms error of the displacement / its amplitude")
    charts.legend_outside(axes)
    runner.save(figure, "manufactured_solution")


def pressurised_ring(runner):
    """Radial displacement and stress over the radius, against Lame."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    a, b, young, nu = 1, 2, 1000, 0.499
    stress_scale = a**2 / (b**2 - a**2)  # for a pressure of 1 Pa
    exact_radius = np.linspace(a, b, 100)

    def lame(r):
        return 1e3 * ((1 + nu) / young * stress_scale *
                      ((1 - 2 * nu) * r + b**2 / r))

    for name in ("assumed strain", "cell", "none"):
        folder = runner.run("pressurised_ring", "Output/Time interval=2",
                            "Output/Fields=displacement, stress",
                            f"Body ring/Locking treatment={name}")
        data = last_points(folder)
        displacement = data["displacement"][:, :2]
        place = data["position"][:, :2] - displacement
        radius = np.linalg.norm(place, axis=1)
        normal = place / radius[:, None]
        radial = 1e3 * (displacement * normal).sum(axis=1)
        stress = data["stress"].reshape(len(radius), 3, 3)[:, :2, :2]
        radial_stress = np.einsum("pi,pij,pj->p", normal, stress, normal)
        exact = lame(radius)
        error = np.sqrt(((radial - exact)**2).sum() / (exact**2).sum())
        print(f"pressurised ring, {name}: error of the displacement "
              f"{100 * error:.2f} %")
        left.plot(radius, radial, ".", label=name,
                  ms=5 if name == "assumed strain" else 2,
                  color=charts.style_of(name)["color"])
        if name != "none":
            right.plot(radius, radial_stress, ".", ms=2,
                       color=charts.style_of(name)["color"])
    left.plot(exact_radius, lame(exact_radius), "k-", lw=1)
    right.plot(exact_radius, stress_scale * (1 - b**2 / exact_radius**2),
               "k-", lw=1)
    left.set(xlabel="radius [m]", ylabel="radial displacement [mm]")
    right.set(xlabel="radius [m]", ylabel="radial stress / pressure")
    handles, labels = left.get_legend_handles_labels()
    handles.append(right.lines[-1])
    right.legend(handles, labels + ["Lamé, exact"], loc="upper left",
                 markerscale=3, bbox_to_anchor=(1.01, 1))
    runner.save(figure, "pressurised_ring")


def cantilever_3d(runner):
    figure, axes = plt.subplots(figsize=(8, 4))
    settings = ["Body beam/Neo hookean/Poisson's ratio=0.49",
                "Check first mode/Reference=0.07891"]
    amplitude = None
    for name in ("assumed strain", "cell", "none"):
        folder = runner.run("cantilever_3d", *settings,
                            f"Body beam/Locking treatment={name}")
        values, _ = run_folder.statistics(folder)
        axes.plot(values["time"], 1e3 * values["tip"], label=name,
                  linewidth=4 if name == "assumed strain" else 1.5,
                  **charts.line_of(name))  # the first two coincide
        frequency = checks(folder)["first mode"]
        amplitude = amplitude or np.abs(values["tip"]).max()
        print(f"cantilever in 3d, nu = 0.49, {name}: {frequency:.4f} Hz "
              f"({100 * (frequency / 0.07891 - 1):+.1f} %)")
    time = np.linspace(0, 20, 400)
    axes.plot(time, 1e3 * amplitude * np.sin(2 * np.pi * 0.07891 * time),
              "k:", label="Timoshenko")
    axes.set(xlabel="time [s]", ylabel="deflection of the tip [mm]")
    charts.legend_outside(axes)
    runner.save(figure, "cantilever_3d")


def main():
    limber = sys.argv[1] if len(sys.argv) > 1 else str(
        TOP / "build/release/limber")
    pictures = sys.argv[2] if len(sys.argv) > 2 else str(
        TOP / "doc/gallery/verification")
    runner = Runner(limber, pictures)
    for scene in (tank, column, bar, manufactured_solution, pressurised_ring,
                  cantilever_3d):
        if not sys.argv[3:] or scene.__name__ in sys.argv[3:]:
            scene(runner)


if __name__ == "__main__":
    main()
