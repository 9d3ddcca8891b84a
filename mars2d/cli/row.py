"""One row of a study run again: ``mars2d sweep --row N``."""

from __future__ import annotations

import argparse
from pathlib import Path

from mars2d.cli.arguments import preferences_of
from mars2d.cli.outputs import conclude, run_and_save
from mars2d.cli.runs import opens_window, run_headless, source_of
from mars2d.core.errors import InputError, shown
from mars2d.core.terminal import aligned, tell, warn
from mars2d.output.formats import log_to
from mars2d.scenario.experiment import open_experiment
from mars2d.study.job import code_of
from mars2d.study.measures import measure_named, measured
from mars2d.study.table import Result, Table
from mars2d.window import show
from mars2d.world.record import Record


def show_row(arguments: argparse.Namespace, path: Path) -> None:
    """Run a row of a study's file again, and print its measures then and now.

    An error of a law is raised, as by ``mars2d run``.
    """
    table = Table.load(path)
    results = {result.row: result for result in table.results}
    if arguments.row not in results:
        known = f"it has rows up to {max(results)}" if results else "it has no rows"
        raise InputError(f"--row {arguments.row}: is not in {path}; {known}")
    then = results[arguments.row]
    source = source_of(table.experiment, path)
    experiment = open_experiment(source, dict(then.options), seed=then.seed)
    options = "".join(f"{name} = {shown(value)}, " for name, value in then.options.items())
    tell(f"row {then.row} of {path}: {table.experiment}, {options}seed {then.seed}")
    if then.error:
        tell(f"then: {then.error}")
    if then.code and code_of(experiment, then.code) != then.code:
        warn(f"{table.experiment}, what it reads, or MARS2D has changed")
    view = opens_window(arguments.view)
    arguments.video = arguments.at = None

    def run() -> Record:
        if view:
            speed, look = experiment.scenario.animation.playback_speed, preferences_of(arguments)
            return show.show_experiment(experiment, speed, preferences=look, log=log, asks=True)
        return run_headless(experiment, log=log).record

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
    conclude(made, troubles)


def _compared(then: Result, now: dict[str, float | str | None], digest: str) -> str:
    """Return a table of the measures then and now, and a line that compares the digests."""
    rows = [("", "then", "now")]
    for name, value in now.items():
        old, new = ("-" if each is None else str(each) for each in (then.measures.get(name), value))
        rows.append((name, old, new))
    verdict = f"then {then.digest[:16]}: this is another run" if then.digest else "then none"
    same = "the same" if digest == then.digest else verdict
    return "\n".join([*aligned(rows, left=1), f"digest {digest[:16]}, {same}"])
