"""The verb ``sweep``."""

from __future__ import annotations

import argparse
from pathlib import Path

from mars2d.cli.arguments import MANY, Output, option, refuse, shared
from mars2d.cli.outputs import conclude, produced
from mars2d.core.errors import InputError, nearest
from mars2d.core.terminal import tell
from mars2d.study.kept import records_beside
from mars2d.study.plan import parse_all, seeds_of
from mars2d.study.run import sweep
from mars2d.study.statistics import confident
from mars2d.study.summary import comparison, summary
from mars2d.study.table import Table

TABLE = Path("sweep.csv")
"""The default file of the rows."""

OF_RUNS = "set stop-time seeds first-seed measure out time-limit retry keep workers"
"""The arguments that choose the runs; they don't apply to an existing table."""

_FILE = "a .py or .toml file, an example's name, or a study's .csv"
_VALUES = "a setting's values: 4,8,16; or 0.1:1.0:10, ten from 0.1 to 1.0; or one"
_MEASURE = "a function of the record in the experiment's file, or a built-in one"
_KEEP = "keep the records beside the table; other measures then need no run"

ARGUMENTS = {
    "experiment": option("EXPERIMENT", _FILE),
    "--set": option("KEY=VALUES", _VALUES, **MANY),
    **shared("stop-time"),
    "--seeds": option("N", "number of seeds, the same at each point (1)", int),
    "--first-seed": option("K", "the first seed (default: 0)", int),
    "--measure": option("NAME", _MEASURE, **MANY),
    "--out": option("OUT.csv", f"file of the rows (default: {TABLE})", Path, action=Output),
    "--figure": option("OUT", "draw the measures: .png, .pdf, .svg", Path, action=Output),
    "--compare": option("KEY", "compare a setting's values, seed by seed"),
    "--confidence": option("P", "of intervals (default: 0.95)", float, default=0.95),
    "--time-limit": option("S", "seconds that a run may take", float),
    "--retry": option(None, "run rows with an error again"),
    "--keep": option(None, _KEEP),
    **shared("workers"),
}


def execute(arguments: argparse.Namespace) -> None:
    """Run an experiment over settings and seeds into a table."""
    given = arguments.experiment
    confident(arguments.confidence)
    if given.lower().endswith(".csv"):
        refuse(arguments, OF_RUNS, f"is for new runs: {given} is there already")
        _report(arguments, Table.load(given), Path(given))
    else:
        out = TABLE if arguments.out is None else arguments.out
        _report(arguments, _swept(arguments, out), out)
        if arguments.keep:
            tell(f"records: {records_beside(out)}")


def _swept(arguments: argparse.Namespace, out: Path) -> Table:
    """Do the runs that the file `out` does not hold, and return its table."""
    settings, name = parse_all(arguments.set), arguments.compare
    if name is not None and name not in settings:
        hint = nearest(name, settings)
        raise InputError(f"--compare {name}: there is no such setting{hint}")
    if name is not None and len(settings[name]) < 2:
        raise InputError(f"--compare {name}: it has one value; two or more can be compared")
    count = 1 if arguments.seeds is None else arguments.seeds
    return sweep(
        arguments.experiment,
        settings,
        seeds_of(count, arguments.first_seed or 0),
        [name.strip() for given in arguments.measure for name in given.split(",")],
        stop_time=arguments.stop_time,
        out=out,
        workers=arguments.workers,
        time_limit=arguments.time_limit,
        retry=arguments.retry,
        keep=arguments.keep,
    )


def _report(arguments: argparse.Namespace, table: Table, path: Path) -> None:
    """Print the summary of a study, and the paths of its files."""
    compared = arguments.compare and comparison(table, arguments.compare, arguments.confidence)
    tell(summary(table, arguments.confidence))
    if compared:
        tell("", compared, sep="\n")
    tell(f"\ntable:  {path}")

    def draw() -> None:
        from mars2d.study.figure import save_study_figure

        save_study_figure(table, arguments.figure, confidence=arguments.confidence)

    conclude(*produced(arguments, {"figure": draw}))
