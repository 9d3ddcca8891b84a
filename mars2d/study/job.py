"""One run of a study: the job that a worker is sent, and the result that it returns."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from queue import Empty, SimpleQueue
from threading import Thread
from typing import Any, TypeVar

from mars2d.core.errors import LawError, Mars2dError
from mars2d.core.usercode import name_of
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.scenario.scenario import Scenario
from mars2d.study.code import code_of
from mars2d.study.kept import recorded
from mars2d.study.measures import Measure, measure_named, measured
from mars2d.study.table import Result
from mars2d.world.loop import open_world

T = TypeVar("T")


class TooLong(LawError):  # noqa: N818 - like the other errors of laws
    """A run took longer than its time limit."""


@dataclass(frozen=True)
class Job:
    """A run of a study, as it is sent to a worker.

    row, options, seed: as in a `Result`. source: a file by its whole path, the name of an example,
    or a Scenario. folder: the one that relative file names refer to. measures: names, or functions
    of a record. control: the law of the team, in place of the experiment's. time_limit: seconds, or
    None. code: that of the run, if the experiment has no files to derive it from. records: the
    whole path of the folder that keeps records, or empty.
    """

    row: int
    source: str | Scenario
    options: Mapping[str, Any]
    seed: int
    measures: tuple[str | Measure, ...]
    folder: str = ""
    control: Callable[[Any], Any] | None = None
    time_limit: float | None = None
    code: str = ""
    records: str = ""


def run_job(job: Job) -> Result:
    """Do one run and measure it; errors are reported in the result's `error`."""
    progress = _Progress()
    try:
        _within(job.time_limit, lambda: progress.make(job))
    except Mars2dError as error:
        progress.errors.append(str(error))
    found = {name_in(measure): None for measure in job.measures} | progress.measures
    said = "; ".join(" ".join(text.split()) for text in progress.errors)
    return Result(job.row, job.options, job.seed, found, said, progress.digest, progress.code)


class _Progress:
    """The results of a run so far, which remain if it is broken off."""

    def __init__(self) -> None:
        self.code = self.digest = ""
        self.measures: dict[str, float | str | None] = {}
        self.errors: list[str] = []

    def make(self, job: Job) -> None:
        """Do a run and take all measures, even if some of them raise."""
        experiment = opened(job)
        self.code = code_of(experiment, job.code)
        record = recorded(experiment, job.records)
        self.digest = record.digest
        for name, measure in measures_of(job.measures, experiment).items():
            try:
                self.measures[name] = measured(name, measure, record)
            except Mars2dError as error:
                self.errors.append(str(error))


def opened(job: Job) -> Experiment:
    """Return the experiment of a job; raise InputError as `open_experiment` does."""
    if job.folder and job.folder != os.getcwd():  # noqa: PTH109
        # A worker on another machine starts in a folder of its own; relative names must agree.
        os.chdir(job.folder)
    return open_experiment(job.source, dict(job.options), job.control, job.seed)


def probed(job: Job) -> Experiment:
    """Return the experiment of a job after building its world; raise InputError if it can't be."""

    def probe() -> Experiment:
        experiment = opened(job)
        open_world(experiment)
        return experiment

    return _within(job.time_limit, probe)


def measures_of(
    measures: tuple[str | Measure, ...], experiment: Experiment, scenario: Scenario | None = None
) -> dict[str, Measure]:
    """Return measures by name; those given by name come from the file, or are built in.

    scenario: if given, it is checked for what the built-in measures need.
    """
    return {
        name_in(measure): measure_named(measure, experiment.source.functions, scenario)
        if isinstance(measure, str)
        else measure
        for measure in measures
    }


def name_in(measure: str | Measure) -> str:
    """Return the name of a measure, which is a name already or a function."""
    return measure if isinstance(measure, str) else name_of(measure)


def _within(seconds: float | None, work: Callable[[], T]) -> T:
    """Return the result of `work`; raise TooLong, which names the line, if it takes longer.

    The work is done in a thread. A thread that waits for the operating system can't be broken off:
    it is left behind, and ends when it wakes up.
    """
    if seconds is None:
        return work()
    from mars2d.core.deadline import Deadline
    from mars2d.core.errors import Late

    outcome: SimpleQueue[Callable[[], T]] = SimpleQueue()
    limit = Deadline(seconds, lambda where: outcome.put(partial(_raise, late(where))))

    def late(where: str) -> TooLong:
        said = f"took longer than {seconds:g} s"
        return TooLong(f"{said}, in {where}" if where else said)

    def watched() -> None:
        try:
            with limit:
                value = work()
        except Late:
            outcome.put(partial(_raise, late(limit.where)))
        except BaseException as error:
            outcome.put(partial(_raise, error))
        else:
            outcome.put(lambda: value)

    Thread(target=watched, daemon=True).start()
    while True:
        with suppress(Empty):
            return outcome.get(timeout=0.5)()  # on Windows, Ctrl-C arrives only between waits


def _raise(error: BaseException) -> Any:
    raise error
