"""One row of a study run again: ``mars2d sweep --row N``."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from mars2d.cli.arguments import preferences_of
from mars2d.cli.outputs import run_and_save, say, tell_files
from mars2d.cli.runs import has_display, run_headless, show
from mars2d.core.errors import InputError, shown
from mars2d.core.terminal import tell, warn
from mars2d.output.formats import log_to
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.study.job import code_of
from mars2d.study.measures import measure_named, measured
from mars2d.study.table import Result, Table, load_table
from mars2d.world.record import Record


def show_row(arguments: argparse.Namespace, path: Path) -> None:
    """Run a row of a study's file again, and print its measures then and now.

    An error of a law is raised, as by ``mars2d run``.
    """
    table = load_table(path)
    then = _row(table, arguments.row, path)
    experiment = open_experiment(_source(table, path), dict(then.options), seed=then.seed)
    tell(f"row {then.row} of {path}: {table.experiment}, {_said(then)}")
    if then.error:
        tell(f"then: {then.error}")
    if then.code and code_of(experiment, then.code) != then.code:
        warn(f"{table.experiment}, what it reads, or MARS2D has changed")
    arguments.video = arguments.at = None

    def run() -> tuple[Record, None]:
        if arguments.view and _has_window():
            return show(experiment, None, preferences_of(arguments), log=log), None
        return run_headless(experiment, log=log).record, None

    log = log_to(arguments.record)
    record, made, troubles = run_and_save(arguments, run)
    _report(record, table, then, experiment)
    tell_files(made)
    if troubles:
        say(troubles[:-1])
        raise troubles[-1]


def _report(record: Record, table: Table, then: Result, experiment: Experiment) -> None:
    """Print a comparison of the run with the row."""
    if not record.finished or record.interventions:
        what = "changed by hand" if record.interventions else "cut short"
        tell(f"the run was {what}, so there is nothing to compare")
        return
    now = {name: _measure(name, experiment.source.functions, record) for name in table.measures}
    tell(_compared(then, now, record))


def _row(table: Table, number: int, path: Path) -> Result:
    for result in table.results:
        if result.row == number:
            return result
    last = max((result.row for result in table.results), default=0)
    known = f"it has rows up to {last}" if last else "it has no rows"
    raise InputError(f"--row {number}: is not in {path}; {known}")


def _source(table: Table, path: Path) -> str:
    """Return the experiment's name, as seen from the current folder or from the table's folder."""
    beside = path.parent / table.experiment
    for place in (Path(table.experiment), beside):
        if place.is_file():
            return str(place)
    if table.experiment in examples():
        return table.experiment
    raise InputError(
        f"{path}: its experiment {table.experiment} is neither in this folder nor beside it"
    )


def _said(result: Result) -> str:
    options = [f"{name} = {shown(value)}" for name, value in result.options.items()]
    return ", ".join([*options, f"seed {result.seed}"])


def _has_window() -> bool:
    if has_display():
        return True
    warn("there is no display, so this runs without a window")
    return False


def _measure(name: str, functions: Any, record: Record) -> float | str | None:
    return measured(name, measure_named(name, functions), record)


def _compared(then: Result, now: dict[str, float | str | None], record: Record) -> str:
    """Return a table of the measures then and now, and a line that compares the digests."""
    rows = [("", "then", "now")]
    rows += [(name, _text(then.measures.get(name)), _text(value)) for name, value in now.items()]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        f"{name:<{widths[0]}}  {old:>{widths[1]}}  {new:>{widths[2]}}" for name, old, new in rows
    ]
    digest = record.digest
    if not then.digest:
        verdict = f"digest {digest[:16]}; then there was none"
    elif digest == then.digest:
        verdict = f"digest {digest[:16]}, the same"
    else:
        verdict = f"digest {digest[:16]}, then {then.digest[:16]}: this is another run"
    return "\n".join([*lines, verdict])


def _text(value: float | str | None) -> str:
    return "-" if value is None else str(value)
