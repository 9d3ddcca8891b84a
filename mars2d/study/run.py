"""Run a study: do its jobs, and write each row as soon as its run is done."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Generator, Iterator
from concurrent.futures import Executor
from contextlib import closing
from pathlib import Path
from typing import cast

from mars2d.core.errors import InputError, Mars2dError, shown
from mars2d.core.files import writing
from mars2d.core.interrupt import interrupts
from mars2d.core.progress import Progress
from mars2d.scenario.scenario import Scenario
from mars2d.study.job import Job, run_job
from mars2d.study.kept import records_beside
from mars2d.study.known import known_rows, table_of
from mars2d.study.prepare import Study
from mars2d.study.table import Result, Table, cells_of
from mars2d.study.work import Failure, each_done, worker_count

TRIALS = 5
"""How many runs, evenly spaced over the study, are made first; if all fail, no others are made."""


class StudyFailedError(Mars2dError):
    """Each run of a study failed, or a measure did so in the first; `table` holds these runs."""

    def __init__(self, message: str, table: Table) -> None:
        super().__init__(message)
        self.table = table


class StudyInterrupted(KeyboardInterrupt):
    """Ctrl-C during a study; `table` holds the runs that were done by then."""

    def __init__(self, message: str, table: Table) -> None:
        super().__init__(message)
        self.table = table


def run_study(
    study: Study,
    out: Path | None = None,
    *,
    executor: Executor | None = None,
    workers: int | None = None,
    retry: bool = False,
    keep: bool = False,
    show_progress: bool = True,
) -> Table:
    """Do the runs of a study that its file `out` does not hold, and return all rows in order.

    executor, workers, retry, keep, show_progress: see `mars2d.sweep`. Raises InputError for a file
    of another study, and if a file of the experiment changes meanwhile; StudyFailedError as soon as
    the first `TRIALS` runs have all failed, or a measure in the first; StudyInterrupted after
    Ctrl-C.
    """
    if executor is None:
        worker_count(workers)
    if out is not None and out.suffix.lower() != ".csv":
        raise InputError(f"{out}: expected a name that ends in .csv")
    if keep:
        study = _keeping(study, out)
    with known_rows(study, out, retry) as (known, file):
        run = _Run(study, known)
        run.refuse_hopeless()
        try:
            todo = run.results(executor, workers, show_progress)
            with interrupts() as check, closing(todo) as results:
                for result in results:
                    if file is not None:
                        file.add(result)
                    run.refuse_hopeless()
                    check()
        except KeyboardInterrupt:
            table = run.table()
            where = "were made" if out is None else f"are in {out}; the same command goes on"
            said = f"{len(table)} of {len(study.plan)} runs {where}"
            raise StudyInterrupted(said, table) from None
        table = run.table()
        if file is not None:
            file.put_in_order(table)
    return table


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


class _Run:
    """A study that is running, and the rows that it has so far."""

    def __init__(self, study: Study, known: dict[int, Result]) -> None:
        self._study, self._rows = study, known
        self._trials = _trials(study)

    def table(self) -> Table:
        """Return the rows in order."""
        return table_of(self._study, self._rows)

    def refuse_hopeless(self) -> None:
        """Raise StudyFailedError if all trials have failed, or a measure in the first of them."""
        rows = self._rows
        first = rows.get(self._trials[0])
        if first is None:
            return
        if first.error and first.digest:
            raise self._failed("the first run can't be measured", first)
        if rows.keys() >= {*self._trials} and all(result.error for result in rows.values()):
            raise self._failed(f"{len(rows)} of {len(rows)} runs failed", first)

    def _failed(self, what: str, result: Result) -> StudyFailedError:
        left = len(self._study.plan) - len(self._rows)
        others = f", so the other {left} are not made" if left else ""
        point = ", ".join(f"{name} = {shown(value)}" for name, value in result.options.items())
        where = ", ".join(filter(None, [f"row {result.row}", point, f"seed {result.seed}"]))
        return StudyFailedError(f"{what}{others}; {where}: {result.error}", self.table())

    def results(
        self, executor: Executor | None, workers: int | None, show_progress: bool
    ) -> Generator[Result, None, None]:
        """Do the runs that are missing; yield each result as it comes."""
        todo = [job for job in self._jobs() if job.row not in self._rows]
        todo.sort(key=lambda job: job.row not in self._trials)
        if not todo:
            return
        failed = sum(bool(result.error) for result in self._rows.values())
        total, done_before = len(self._study.plan), len(self._rows)
        progress = CountingBar(total, done_before, failed) if show_progress else None
        try:
            limit = self._study.blank.time_limit
            made_by = each_done(run_job, todo, executor, workers, limit)
            with closing(cast("Generator[tuple[int, Result | Failure]]", made_by)) as done:
                for index, made in done:
                    result = _result(todo[index], made, self._study)
                    self._refuse_changed(result)
                    self._rows[result.row] = result
                    if progress is not None:
                        progress.add(failed=bool(result.error))
                    yield result
        finally:
            if progress is not None:
                progress.close()

    def _jobs(self) -> Iterator[Job]:
        for row, (options, seed) in enumerate(self._study.plan.runs(), 1):
            yield dataclasses.replace(self._study.blank, row=row, options=options, seed=seed)

    def _refuse_changed(self, result: Result) -> None:
        """Raise InputError for a row that was made after a file of the experiment had changed."""
        study = self._study
        file = study.watched.changed()
        if file is not None:
            raise InputError(
                f"{file} has changed while the study was running: put it back and go on, or begin "
                "another study, with another --out"
            )
        if result.code:
            code = study.codes.setdefault(cells_of(result.options), result.code)
            if code != result.code:
                raise InputError(
                    f"row {result.row}: the experiment's files differ between the machines that "
                    "ran the rows of its point"
                )


def _trials(study: Study) -> tuple[int, ...]:
    """Return the rows that are made first: the first that can be opened, and `TRIALS` in all."""
    plan = study.plan
    points = (cells_of(point) for point in plan.points())
    first = next((k for k, point in enumerate(points) if point in study.codes), 0)
    total = len(plan)
    spaced = [1 + k * (total - 1) // (TRIALS - 1) for k in range(TRIALS)]
    return tuple(dict.fromkeys([1 + first * len(plan.seeds), *spaced]))


def _result(job: Job, made: Result | Failure, study: Study) -> Result:
    if isinstance(made, Result):
        return made
    nothing = dict.fromkeys(study.measures)
    return Result(job.row, job.options, job.seed, nothing, " ".join(made.error.split()))


class CountingBar:
    """A progress bar that counts runs and failures, and estimates the time that is left."""

    def __init__(self, total: int, done: int = 0, failed: int = 0) -> None:
        """Take the number of all runs, and of those that are done and failed already."""
        self._bar = Progress(total)
        self._total, self._before, self._done, self._failed = total, done, done, failed
        self._start = time.monotonic()

    def add(self, *, failed: bool = False) -> None:
        """Count one more run."""
        self._done += 1
        self._failed += failed
        pace = (time.monotonic() - self._start) / (self._done - self._before)
        failures = f", {self._failed} failed" if self._failed else ""
        left = duration(pace * (self._total - self._done))
        self._bar.update(self._done, f"{self._done}/{self._total}{failures}, {left} left")

    def close(self) -> None:
        """Remove the bar from the terminal."""
        self._bar.close()


def duration(seconds: float) -> str:
    """Return a duration as text, in at most two units.

    >>> [duration(seconds) for seconds in (8, 150, 9000, 200000)]
    ['8 s', '2 min 30 s', '2 h 30 min', '2 d 7 h']
    """
    whole = round(seconds)
    for unit, size, smaller, part in (
        ("d", 86400, "h", 3600),
        ("h", 3600, "min", 60),
        ("min", 60, "s", 1),
    ):
        if whole >= size:
            rest = whole % size // part
            return f"{whole // size} {unit} {rest} {smaller}" if rest else f"{whole // size} {unit}"
    return f"{whole} s"
