"""One row of a study run again: ``mars2d sweep --row N``."""

from __future__ import annotations

import argparse
from pathlib import Path

from mars2d.cli.arguments import preferences_of
from mars2d.cli.outputs import run_and_save, say, tell_files
from mars2d.cli.runs import has_display, run_headless, show
from mars2d.core.errors import InputError, shown
from mars2d.core.terminal import tell, warn
from mars2d.output.formats import log_to
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment
from mars2d.study.job import code_of
from mars2d.study.measures import measure_named, measured
from mars2d.study.table import Result, Table
from mars2d.world.record import Record


def show_row(arguments: argparse.Namespace, path: Path) -> None:
    """Run a row of a study's file again, and print its measures then and now.

    An error of a law is raised, as by ``mars2d run``.
    """
    table = Table.load(path)
    then = _row(table, arguments.row, path)
    experiment = open_experiment(_source(table, path), dict(then.options), seed=then.seed)
    options = "".join(f"{name} = {shown(value)}, " for name, value in then.options.items())
    tell(f"row {then.row} of {path}: {table.experiment}, {options}seed {then.seed}")
    if then.error:
        tell(f"then: {then.error}")
    if then.code and code_of(experiment, then.code) != then.code:
        warn(f"{table.experiment}, what it reads, or MARS2D has changed")
    view = arguments.view and has_display()
    if arguments.view and not view:
        warn("there is no display, so this runs without a window")
    arguments.video = arguments.at = None

    def run() -> tuple[Record, None]:
        if view:
            return show(experiment, None, preferences_of(arguments), log=log), None
        return run_headless(experiment, log=log).record, None

    log = log_to(arguments.record)
    record, made, troubles = run_and_save(arguments, run)
    if not record.finished or record.interventions:
        what = "changed by hand" if record.interventions else "cut short"
        tell(f"the run was {what}, so there is nothing to compare")
    else:
        functions = experiment.source.functions
        measures = {name: measure_named(name, functions) for name in table.measures}
        now = {name: measured(name, measure, record) for name, measure in measures.items()}
        tell(_compared(then, now, record.digest))
    tell_files(made)
    if troubles:
        say(troubles[:-1])
        raise troubles[-1]


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


def _compared(then: Result, now: dict[str, float | str | None], digest: str) -> str:
    """Return a table of the measures then and now, and a line that compares the digests."""
    rows = [("", "then", "now")]
    for name, value in now.items():
        before = then.measures.get(name)
        rows.append(
            (name, "-" if before is None else str(before), "-" if value is None else str(value))
        )
    names, olds, news = (max(map(len, column)) for column in zip(*rows, strict=True))
    lines = [f"{name:<{names}}  {old:>{olds}}  {new:>{news}}" for name, old, new in rows]
    verdict = f"then {then.digest[:16]}: this is another run" if then.digest else "then none"
    same = "the same" if digest == then.digest else verdict
    return "\n".join([*lines, f"digest {digest[:16]}, {same}"])
