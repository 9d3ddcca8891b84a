"""The verb ``sweep``."""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path
from typing import Any

from mars2d.cli.arguments import add_preferences, add_workers, workers_of
from mars2d.cli.outputs import OUTPUTS, add_html, check_outputs, naming_lost_letters
from mars2d.cli.row import show_row
from mars2d.core.errors import InputError, nearest
from mars2d.core.terminal import tell, warn
from mars2d.output.figures.style import STYLES, style_of
from mars2d.study.kept import records_beside
from mars2d.study.plan import Plan, parse_all, seeds_of, settings_of
from mars2d.study.run import run_study
from mars2d.study.study import prepared
from mars2d.study.table import Table, is_table, load_table
from mars2d.study.units import checked_units, parse_units

TABLE = Path("sweep.csv")
"""The default file of the rows."""

RUN_ARGUMENTS = (
    "set", "stop_time", "seeds", "first_seed", "measure", "out", "time_limit", "retry", "keep",
)  # fmt: skip
"""The arguments that choose the runs; they don't apply to an existing table."""

WORKER_ARGUMENTS = ("workers", "cluster")

TABLE_ARGUMENTS = ("compare", "unit", "style")

ROW_ARGUMENTS = ("view", "record", "html")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add = parser.add_argument
    add("experiment", nargs="?", metavar="EXPERIMENT",
        help="a .py or .toml file, an example's name, or a study's .csv")  # fmt: skip
    add("--set", action="append", default=[], metavar="KEY=VALUES",
        help="a setting's values: 4,8,16; or 0.1:1.0:10, ten from 0.1 to 1.0; or one")  # fmt: skip
    add("--stop-time", type=float, metavar="S", help="seconds to simulate")
    add(
        "--seeds",
        type=int,
        metavar="N",
        help="number of seeds, the same at each point (default 1)",
    )
    add("--first-seed", type=int, metavar="K", help="the first seed (default: 0)")
    add("--measure", action="append", default=[], metavar="NAME",
        help="a function of the record in the experiment's file, or a built-in one")  # fmt: skip
    add("--unit", action="append", default=[], metavar="NAME=UNIT",
        help="the unit of a setting or a measure, such as spread=m")  # fmt: skip
    add("--out", type=Path, metavar="OUT.csv", help=f"file of the rows (default: {TABLE})")
    add("--figure", type=Path, metavar="OUT", help="draw the measures: .png, .pdf, .svg")
    add("--style", metavar="STYLE", help=f"of the figure: {', '.join(STYLES)}")
    add("--compare", metavar="KEY", help="compare a setting's values, seed by seed")
    add("--confidence", type=_confidence, default=0.95, metavar="P",
        help="of intervals (default: 0.95)")  # fmt: skip
    add("--time-limit", type=float, metavar="S", help="seconds that a run may take")
    add("--retry", action="store_true", help="run rows with an error again")
    add("--keep", action="store_true",
        help="keep the records beside the table; other measures then need no run")  # fmt: skip
    add_workers(parser)
    add("--row", type=int, metavar="N", help="run one row of a study again")
    add("--view", action="store_true", help="with --row: show it in a window")
    add("--record", type=Path, metavar="OUT", help="with --row: save all data of the run")
    add_html(parser)
    add_preferences(parser)


def _confidence(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < 1:
        why = "expected a number between 0 and 1, such as 0.95"
        raise argparse.ArgumentTypeError(f"{text!r}: {why}")
    return value


def execute(arguments: argparse.Namespace) -> None:
    """Run an experiment over settings and seeds into a table, or one of its rows again."""
    check_outputs(arguments, {name: OUTPUTS[name] for name in ("record", "figure", "html")})
    if arguments.row is not None:
        others = (*RUN_ARGUMENTS, *WORKER_ARGUMENTS, *TABLE_ARGUMENTS)
        _refuse(arguments, others, "--row N runs one row as it was")
        show_row(arguments, _table_here(arguments))
        return
    if arguments.figure is None:
        _refuse(arguments, ("style",), "it is of a figure: give --figure OUT as well")
    arguments.style = style_of(arguments.style or "screen")
    _refuse(arguments, ROW_ARGUMENTS, "it is of one run: give --row N")
    if arguments.experiment is None:
        raise InputError("an EXPERIMENT is needed, or --row N of a study that is there")
    if arguments.experiment.lower().endswith(".csv"):
        why = f"{arguments.experiment} is there already"
        _refuse(arguments, (*RUN_ARGUMENTS, *WORKER_ARGUMENTS), why)
        table = load_table(arguments.experiment)
        stated = checked_units(parse_units(arguments.unit), [*table.settings, *table.measures])
        table = dataclasses.replace(table, units={**table.units, **stated})
        _report(arguments, table, Path(arguments.experiment))
        return
    _run(arguments)


def _refuse(arguments: argparse.Namespace, names: tuple[str, ...], why: str) -> None:
    for name in names:
        if getattr(arguments, name) not in (None, False, []):
            raise InputError(f"--{name.replace('_', '-')}: {why}")


def _table_here(arguments: argparse.Namespace) -> Path:
    """Return the file with the row: as given, or the newest study in this folder."""
    if arguments.experiment is not None:
        if not arguments.experiment.lower().endswith(".csv"):
            raise InputError(
                f"--row {arguments.row}: expected the .csv of a study, not {arguments.experiment}"
            )
        return Path(arguments.experiment)
    tables = [path for path in Path().glob("*.csv") if path.is_file() and is_table(path)]
    if not tables:
        raise InputError(
            f"--row {arguments.row}: there is no study in this folder; name its file, as "
            f"mars2d sweep results.csv --row {arguments.row}"
        )
    return max(tables, key=lambda path: path.stat().st_mtime_ns)


# -- a study ---------------------------------------------------------------------------------------


def _run(arguments: argparse.Namespace) -> None:
    out = TABLE if arguments.out is None else arguments.out
    check_outputs(argparse.Namespace(out=out), {"out": (".csv",)})
    count = 1 if arguments.seeds is None else arguments.seeds
    plan = Plan(_settings(arguments), seeds_of(count, arguments.first_seed or 0))
    if arguments.compare is not None:
        _check_compared(arguments.compare, {k: len(v) for k, v in plan.settings.items()})
    names = [name.strip() for given in arguments.measure for name in given.split(",")]
    with workers_of(arguments) as (executor, workers):
        study = prepared(
            arguments.experiment,
            plan,
            tuple(names),
            time_limit=arguments.time_limit,
            units=parse_units(arguments.unit),
        )
        for trouble in study.troubles[:3]:
            warn(trouble)
        if study.troubles:
            warn("such runs are rows with their error; the others are made")
        table = run_study(
            study,
            out,
            executor=executor,
            workers=workers,
            retry=arguments.retry,
            keep=arguments.keep,
        )
    _report(arguments, table, out)
    if arguments.keep:
        tell(f"records: {records_beside(out)}")


def _settings(arguments: argparse.Namespace) -> dict[str, Any]:
    given = parse_all(arguments.set)
    if arguments.stop_time is not None:
        if "stop_time" in given:
            raise InputError("--stop-time: is given twice, with --set as well")
        given["stop_time"] = [arguments.stop_time]
    return settings_of(given)


def _check_compared(name: str, counts: dict[str, int]) -> None:
    if name not in counts:
        raise InputError(f"--compare {name}: there is no such setting{nearest(name, counts)}")
    if counts[name] < 2:
        raise InputError(f"--compare {name}: it has one value; two or more can be compared")


def _report(arguments: argparse.Namespace, table: Table, path: Path) -> None:
    """Print the summary of a study, and the paths of its files."""
    from mars2d.study.summary import comparison, summary

    if arguments.compare is not None:
        points = table.points()
        counts = {n: len({p[k] for p in points}) for k, n in enumerate(table.settings)}
        _check_compared(arguments.compare, counts)
    tell(summary(table, arguments.confidence))
    if arguments.compare is not None:
        tell("", comparison(table, arguments.compare, arguments.confidence), sep="\n")
    tell(f"\ntable:  {path}")
    if arguments.figure is not None:
        from mars2d.study.figure import save_study_figure

        with naming_lost_letters():
            save_study_figure(
                table,
                arguments.figure,
                confidence=arguments.confidence,
                style=arguments.style,
            )
        tell(f"figure: {arguments.figure}")
