#!/usr/bin/python3
"""limber plot RUN [RUN ...] [options]

Draws runs, references and studies. Of one run without options: snapshots of the
pressure (or of the first field there is), the energies, and the observables, as
snapshots.png, energies.png and observables.png in its folder; of a study its chart.
Several runs are drawn one below the other, or side by side, with the same colours
and at the same times, and their tables in the same charts: comparison_snapshots.png
and so on in the folder of the first one.

A field is what pictures hold ('Output/Fields', all of a reference), a component of
it ('velocity x', 'stress xy'), 'speed', 'equivalent stress', or 'body'. A field,
body or column that is not there ends with exit code 1 and no picture is touched.
"""

import argparse
import difflib
import re
import sys
import textwrap
from pathlib import Path

import charts
import fields
import panels
import run_folder
from charts import np, plt


class Parser(argparse.ArgumentParser):
    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        # '-5e7' is a number, too, not the name of an option.
        self._negative_number_matcher = re.compile(
            r"-(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$")

    def error(self, message):
        _, _, unknown = message.partition("unrecognized arguments: ")
        meant = difflib.get_close_matches(
            unknown.split(" ")[0],
            [name for action in self._actions for name in action.option_strings],
            1)
        charts.fail(f"{message}." + (f" Did you mean '{meant[0]}'?" if meant
                                     else "")
                    + f" See '{self.prog} --help'.")


def finite(text):
    value = float(text)
    if not np.isfinite(value):
        raise argparse.ArgumentTypeError(f"'{text}' is not a finite number")
    return value


def parser_for(word, description):
    """The options that 'limber plot' and 'limber animate' have in common."""
    parser = Parser(
        prog=f"limber {word}", description=description,
        usage=argparse.SUPPRESS,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", metavar="RUN",
                        help="folder of a run, a reference or a study")
    parser.add_argument("--field", help="what the colours show")
    parser.add_argument("--body", help="only the points of this body")
    parser.add_argument("--others", action="store_true",
                        help="with '--body': the other bodies in grey")
    parser.add_argument("--side-by-side", action="store_true",
                        help="several runs in columns, their times below each "
                        "other")
    parser.add_argument("--enlarge", type=finite, default=1., metavar="FACTOR",
                        help="draw displacements this many times as large")
    parser.add_argument("--range", type=finite, nargs=2, metavar=("LOW", "HIGH"),
                        help="ends of the colours, in the SI unit of the field")
    parser.add_argument("--view", type=finite, nargs=2, default=(30., 20.),
                        metavar=("AZIMUTH", "ELEVATION"),
                        help="of the camera in three dimensions, in degrees")
    parser.add_argument("--grid", action="store_true",
                        help="draw the lines of the grid's cells, of all their "
                        "sizes; in two dimensions")
    parser.add_argument("--labels", nargs="+", metavar="NAME",
                        help="names of the runs, instead of their folders'")
    parser.add_argument("--output", type=Path, metavar="PATH",
                        help="the picture; its ending says what is written")
    return parser


def checked(arguments):
    """Sources and labels of the runs; ends with a message if they do not fit."""
    if arguments.range and arguments.range[0] >= arguments.range[1]:
        charts.fail("'--range' takes the lower end of the colours first, and a "
                    "higher one.")
    if arguments.others and not arguments.body:
        charts.fail("'--others' are those beside the one behind '--body'; name "
                    "that, too.")
    sources = [fields.Source(folder) for folder in arguments.folders]
    if arguments.side_by_side and len(sources) == 1:
        charts.fail("'--side-by-side' is for several runs.")
    if len({source.dimension for source in sources}) > 1:
        charts.fail("Runs in two and in three dimensions cannot be drawn side by "
                    "side.")
    labels = arguments.labels or [source.name for source in sources]
    if len(labels) != len(sources):
        charts.fail(f"There are {len(labels)} names behind '--labels', but "
                    f"{len(sources)} runs.")
    return sources, labels


def look_of(arguments, sources):
    field = arguments.field
    if field is None:
        names = fields.names_of(sources[0].at(0))
        if not names:
            charts.fail(f"The pictures in '{sources[0].folder}' hold no fields. "
                        "Set 'Output/Fields' in the scene.")
        field = "pressure" if "pressure" in names else names[0]
    return panels.Look(field, arguments.body, arguments.enlarge,
                       arguments.range, tuple(arguments.view),
                       grid=arguments.grid, others=arguments.others,
                       side_by_side=arguments.side_by_side)


def check_times(sources, latest):
    """A time that a run has not reached is not drawn as its last picture."""
    for source in sources:
        last, interval = source.times[-1], np.diff(source.times).max(initial=0)
        if latest > last + interval:
            charts.fail(f"The run in '{source.folder}' ends at {last:.4g} s; "
                        f"there is no picture of {latest:.4g} s.")


def snapshots(arguments, sources, labels):
    wanted = arguments.time
    if wanted:
        check_times(sources, max(wanted))
    else:
        times = sources[0].times
        wanted = [times[i] for i in np.unique(np.linspace(
            0, len(times) - 1, arguments.snapshots).round().astype(int))]
    look = look_of(arguments, sources)
    states = [[panels.State(source, source.nearest(time), look)
               for time in wanted] for source in sources]
    return panels.figure_of(states, look, labels)


# ---- columns of the statistics over time -----------------------------------------

ENERGIES = ("kinetic energy", "strain energy", "gravitational energy",
            "dissipated energy", "plastic work", "friction heat",
            "contact loss")
ENERGY_COLOURS = {"kinetic energy": "#0072B2", "strain energy": "#D55E00",
                  "gravitational energy": "#009E73",
                  "dissipated energy": "#CC79A7", "plastic work": "#E69F00",
                  "friction heat": "#8C6D31", "contact loss": "#56B4E9",
                  "total energy": "#000000"}
LINES = ("-", "--", ":", "-.")  # one for each run


def with_total(table):
    """Kinetic, strain and gravitational energy together."""
    if "total energy" in table:
        return table
    parts = [table[name] for name in ENERGIES[:3] if name in table]
    return {**table, "total energy": sum(parts)} if parts else table


def observables_of(source):
    listed = run_folder.words(source.parameters.get("Observables", ""))
    return lambda table: [name for name in table if any(
        name == o or name.startswith(o + " ") for o in listed)]


def columns_figure(sources, labels, names_in, wanted=None):
    """One panel for each unit, a colour for each column, a line for each run;
    a colour for each run where a panel has one column."""
    tables = []
    for source in sources:
        table, units = run_folder.statistics(source.folder)
        table, units = with_total(table), {**units, "total energy": "J"}
        for name in wanted or ():
            if name not in table:
                charts.fail(f"There is no column '{name}' in the statistics of "
                            f"'{source.folder}'. It has: "
                            + ", ".join(table) + ".")
        tables.append((table, units))
    groups = {}
    for table, units in tables:
        for name in names_in(table):
            group = groups.setdefault(units[name], [])
            if name not in group:
                group.append(name)
    if not groups:
        return None
    figure, axes = plt.subplots(
        len(groups), 1, sharex=True, squeeze=False, layout="constrained",
        figsize=(8.5, 0.9 + 2.6 * len(groups)))
    second, seconds = charts.scaled_unit(
        "s", max(table["time"][-1] for table, _ in tables))
    for axis, (unit, names) in zip(axes[:, 0], groups.items()):
        largest = max((np.nanmax(abs(table[name]), initial=0)
                       for table, _ in tables for name in names
                       if name in table), default=0)
        factor, short = charts.scaled_unit(unit, largest)
        by_run = len(names) == 1 and len(tables) > 1
        for k, name in enumerate(names):
            colour = ENERGY_COLOURS.get(name, f"C{k}")
            for i, (table, _) in enumerate(tables):
                if name in table:
                    axis.plot(table["time"] / second, table[name] / factor,
                              "-" if by_run else LINES[i % len(LINES)],
                              color=f"C{i}" if by_run else colour,
                              linewidth=1.2, label=labels[i] if by_run
                              else name if len(tables) == 1
                              else f"{name}, {labels[i]}")
        name = "energy" if unit == "J" and len(names) > 1 else textwrap.shorten(
            ", ".join(names), 28, placeholder=" ...")
        axis.set_ylabel(charts.with_unit(name, short))
        axis.grid(alpha=0.25)
        charts.legend_outside(axis)
    axes[-1, 0].set_xlabel(charts.with_unit("time", seconds))
    return figure


def energies(sources, labels):
    return columns_figure(sources, labels, lambda table: [
        name for name in (*ENERGIES, "total energy")
        if name in table and np.any(table[name])])


def main(words=None):
    parser = parser_for("plot", __doc__)
    parser.add_argument("--time", type=finite, nargs="+", metavar="T",
                        help="the pictures nearest to these times, in s")
    parser.add_argument("--snapshots", type=int, default=4, metavar="N",
                        help="so many pictures, evenly over the run (4)")
    parser.add_argument("--columns", nargs="+", metavar="NAME",
                        help="columns of the statistics over time; 'energies' "
                        "and 'observables' stand for theirs")
    arguments = parser.parse_args(words)

    if any(Path(folder, "study.csv").is_file()
           for folder in arguments.folders):
        import plot_study
        if len(arguments.folders) > 1 or arguments.field or arguments.columns:
            charts.fail("A study is drawn alone and as a whole: 'limber plot "
                        "FOLDER'. Its runs are in the folder 'runs' below it.")
        return plot_study.draw_folder(Path(arguments.folders[0]),
                                      arguments.output)
    if arguments.output:
        charts.check_ending(arguments.output)
    if arguments.snapshots < 1:
        charts.fail("'--snapshots' must be 1 or more.")

    if arguments.columns and not arguments.field:
        sources, labels = run_tables(arguments)
    else:
        sources, labels = checked(arguments)
    home = sources[0].folder
    # What the folder holds of its own run stays.
    about = "comparison_" if len(sources) > 1 else ""
    output = arguments.output
    drawn = []
    if arguments.columns:
        names = [n for n in arguments.columns
                 if n not in ("energies", "observables")]

        def chosen(table):
            return [name for word in arguments.columns for name in (
                [e for e in (*ENERGIES, "total energy") if e in table]
                if word == "energies" else observables_of(sources[0])(table)
                if word == "observables" else [word])]
        drawn.append((output or home / f"{about}columns.png",
                      columns_figure(sources, labels, chosen, names)))
        if drawn[0][1] is None:
            charts.fail(f"There is nothing to draw in '{home}': the scene has "
                        "no observables.")
    if arguments.field or not arguments.columns:
        drawn.append((output or home / f"{about}snapshots.png",
                      snapshots(arguments, sources, labels)))
    if not arguments.field and not arguments.columns and not output:
        drawn.append((home / f"{about}energies.png",
                      energies(sources, labels)))
        drawn.append((home / f"{about}observables.png",
                      columns_figure(sources, labels,
                                     observables_of(sources[0]))))
    if output and len(drawn) > 1:
        charts.fail("'--field' and '--columns' make two pictures, '--output' "
                    "names one. Draw them one after the other.")
    for path, figure in drawn:
        if figure:
            charts.save(figure, path)


class TableOnly:
    """A run without pictures, of which only the table is drawn."""

    def __init__(self, folder):
        self.folder = Path(folder)
        fields.refuse_scene(folder)
        if not (self.folder / "statistics").is_file():
            charts.fail(f"The folder '{folder}' holds no table 'statistics'.")
        self.parameters = run_folder.parameters(self.folder)
        self.name = self.folder.resolve().name


def run_tables(arguments):
    sources = [TableOnly(folder) for folder in arguments.folders]
    labels = arguments.labels or [source.name for source in sources]
    if len(labels) != len(sources):
        charts.fail(f"There are {len(labels)} names behind '--labels', but "
                    f"{len(sources)} runs.")
    return sources, labels


if __name__ == "__main__":
    sys.exit(main())
