"""Sweeps: an experiment is run at each point of a grid of settings, with the same seeds."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Generator, Iterable, Mapping
from concurrent.futures import Executor
from contextlib import closing
from pathlib import Path
from types import ModuleType
from typing import Any, cast

from mars2d.core.checks import items_of
from mars2d.core.description import wrong
from mars2d.core.errors import InputError, Mars2dError
from mars2d.core.files import writing
from mars2d.core.interrupt import interrupts
from mars2d.core.progress import progress
from mars2d.core.terminal import warn
from mars2d.scenario.scenario import Scenario
from mars2d.study.job import run_job
from mars2d.study.kept import records_beside
from mars2d.study.measures import Measure
from mars2d.study.plan import Plan, seeds_of, settings_of
from mars2d.study.results import Results
from mars2d.study.study import Study, prepared
from mars2d.study.table import Result, Table, cells_of
from mars2d.study.work import Failure, each_done, leave_if_imported_again, worker_count


class StudyFailedError(Mars2dError):
    """Each run of a study failed; `table` holds them."""

    def __init__(self, message: str, table: Table) -> None:
        super().__init__(message)
        self.table = table


class StudyInterrupted(KeyboardInterrupt):
    """Ctrl-C during a study; `table` holds the runs that were done by then."""

    def __init__(self, message: str, table: Table) -> None:
        super().__init__(message)
        self.table = table


def sweep(
    experiment: str | Path | ModuleType | Scenario,
    settings: Mapping[str, Any] | None = None,
    seeds: int | Iterable[int] = 1,
    measures: str | Measure | Iterable[str | Measure] = (),
    *,
    control: Callable[[Any], Any] | None = None,
    stop_time: float | None = None,
    out: str | Path | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    time_limit: float | None = None,
    retry: bool = False,
    keep: bool = False,
    show_progress: bool = True,
) -> Table:
    """Run an experiment at each point of a grid, with each seed, and return the table of results.

    experiment: a file, the name of a shipped example, a module that has a file, or a Scenario.
    settings: options by their dotted names, or parameters of a scenario function. A list, range or
    array holds several values, anything else is one value; a point has one value of each setting.
    seeds: how many, from 0 on, or a list; the same at all points, to be compared seed by seed.
    measures: names of built-in measures or of functions in the experiment's file, or functions of
    the record; by default the end time, the collisions and, in a game, the capture time. control:
    the law of the team, in place of the experiment's. stop_time: seconds, as another setting.

    out: a .csv file to which each row is added when its run is done. Runs whose rows it holds are
    not repeated, except, with `retry`, those with an error. executor: any of concurrent.futures, or
    a Client of Dask; by default processes are started, `workers` of them, one a core. With
    processes, call this under ``if __name__ == "__main__":``. time_limit: seconds that a run may
    take; a call in C is only broken off in processes. keep: whether the runs' records are kept in a
    folder beside `out`, from which a later sweep with `keep` and other measures takes these,
    without a run. show_progress: whether a terminal or a notebook shows a bar.

    A run that fails is a row with its `error`. The rows depend neither on the workers nor on the
    order in which runs end, and each has the digest of ``mars2d.run`` with the same options.

    Raises InputError, before the first run, for anything that can't be run, if the file holds
    another study, and if a file of the experiment changes meanwhile; `StudyFailedError` if all
    runs fail; `StudyInterrupted` after Ctrl-C. Both have the rows as their `table`.
    """
    leave_if_imported_again()
    if executor is None:
        worker_count(workers)
    if not isinstance(out, (str, Path, type(None))):
        raise wrong("out", out, "the name of a file, such as 'results.csv'")
    path = None if out is None else Path(out)
    if path is not None and path.suffix.lower() != ".csv":
        raise InputError(f"{path}: expected a name that ends in .csv")
    if stop_time is not None and isinstance(settings, (Mapping, type(None))):
        if settings and "stop_time" in settings:
            raise InputError("stop_time is given twice, once among the settings")
        settings = {**(settings or {}), "stop_time": stop_time}
    plan, listed = Plan(settings_of(settings), seeds_of(seeds)), _listed(measures)
    study = prepared(experiment, plan, listed, control=control, time_limit=time_limit)
    for trouble in study.troubles[:3]:
        warn(trouble)
    if study.troubles:
        warn("such runs are rows with their error; the others are made")
    if keep:
        study = _keeping(study, path)
    with Results(study, path, retry=retry) as results:
        try:
            made = _missing(study, results, executor, workers, show_progress)
            with interrupts() as check, closing(made) as rows:
                for row in rows:
                    _refuse_changed(study, row)
                    results.add(row)
                    check()
        except KeyboardInterrupt:
            table = results.table()
            where = "were made" if out is None else f"are in {out}; the same command goes on"
            said = f"{len(table)} of {len(plan)} runs {where}"
            raise StudyInterrupted(said, table) from None
        results.put_in_order()
        table = results.table()
        if len(table.failed) == len(table):
            raise StudyFailedError(f"all runs failed: {table.failed[0].error}", table)
        return table


def _listed(measures: str | Measure | Iterable[str | Measure]) -> tuple[str | Measure, ...]:
    if isinstance(measures, str) or callable(measures):
        return (measures,)
    expected = "names of measures, or functions of a record"
    listed = tuple(items_of("measures", measures, expected))
    for measure in listed:
        if not isinstance(measure, str) and not callable(measure):
            raise wrong("measures", measure, expected)
    return listed


def _keeping(study: Study, out: Path | None) -> Study:
    """Return a study that keeps its records beside its table."""
    if out is None:
        raise InputError("keep: expected out as well: records are kept beside the table's file")
    if isinstance(study.blank.source, Scenario) or study.blank.control is not None:
        raise InputError(
            "keep: expected an experiment that is a file, without control: in a file it shows "
            "whether a law has changed since a record was made"
        )
    folder = records_beside(out).absolute()
    with writing(folder):
        folder.mkdir(exist_ok=True)
    return dataclasses.replace(study, blank=dataclasses.replace(study.blank, records=str(folder)))


def _missing(
    study: Study,
    results: Results,
    executor: Executor | None,
    workers: int | None,
    show_progress: bool,
) -> Generator[Result, None, None]:
    """Do the runs that have no row; yield each as it comes."""
    todo = [
        dataclasses.replace(study.blank, row=row, options=options, seed=seed)
        for row, (options, seed) in enumerate(study.plan.runs(), 1)
        if row not in results.rows
    ]
    failed = sum(bool(result.error) for result in results.rows.values())
    done_by = each_done(run_job, todo, executor, workers, study.blank.time_limit)
    with (
        progress(len(study.plan), "run", len(results.rows), show=show_progress) as update,
        closing(cast("Generator[tuple[int, Result | Failure]]", done_by)) as done,
    ):
        for count, (index, made) in enumerate(done, len(results.rows) + 1):
            job, nothing = todo[index], dict.fromkeys(study.measures)
            failed += bool(made.error)
            update(count, f"{failed} failed" if failed else "")
            if isinstance(made, Failure):
                yield Result(job.row, job.options, job.seed, nothing, made.error)
            else:
                yield made


def _refuse_changed(study: Study, row: Result) -> None:
    """Raise InputError for a row that was made after a file of the experiment had changed."""
    for file, written in study.written.items():
        if not file.is_file() or file.stat().st_mtime_ns != written:
            raise InputError(
                f"{file} has changed while the study was running: put it back and go on, or begin "
                "another study, with another --out"
            )
    if row.code and study.codes.setdefault(cells_of(row.options), row.code) != row.code:
        raise InputError(
            f"row {row.row}: the experiment's files differ between the machines that ran the rows "
            "of its point"
        )
