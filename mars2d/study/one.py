"""One run of a study: what a worker is given, and what it returns."""

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
from mars2d.study.measures import Measure, measure_named, measured
from mars2d.study.table import Result
from mars2d.world.loop import open_world, simulate

__all__ = ["One", "TooLong", "measures_of", "name_in", "opened", "probed", "run_one"]

T = TypeVar("T")


class TooLong(LawError):  # noqa: N818 - as the others of what a law may do wrong
    """A run took longer than it may."""


@dataclass(frozen=True)
class One:
    """A run of a study, as it is sent to a worker.

    row, options, seed: as in a `Result`. source: a file by its whole path, the name of an example,
    or a Scenario. folder: where relative names of files begin. measures: names, or functions of a
    record. control: the law of the team, in place of the experiment's. time_limit: seconds that it
    may take, or None. code: of the run, where no files tell it.
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


def run_one(one: One) -> Result:
    """Do one run and measure it; what goes wrong in it stands in the result's `error`."""
    made = _Made()
    try:
        _within(one.time_limit, lambda: made.make(one))
    except Mars2dError as error:
        made.errors.append(str(error))
    found = {name_in(measure): None for measure in one.measures} | made.measures
    said = "; ".join(" ".join(text.split()) for text in made.errors)
    return Result(one.row, one.options, one.seed, found, said, made.digest, made.code)


class _Made:
    """What is known of a run so far."""

    def __init__(self) -> None:
        self.code = self.digest = ""
        self.measures: dict[str, float | str | None] = {}
        self.errors: list[str] = []

    def make(self, one: One) -> None:
        """Do a run and measure it, whatever single measures raise."""
        experiment = opened(one)
        self.code = code_of(experiment, one.code)
        record = simulate(experiment, one.seed).record
        self.digest = record.digest
        for name, measure in measures_of(one.measures, experiment).items():
            try:
                self.measures[name] = measured(name, measure, record)
            except Mars2dError as error:
                self.errors.append(str(error))


def opened(one: One) -> Experiment:
    """Return the experiment of a run; raise InputError as `open_experiment` does."""
    if one.folder and one.folder != os.getcwd():  # noqa: PTH109
        # A worker elsewhere was started in a folder of its own; all that it is sent names the same.
        os.chdir(one.folder)
    return open_experiment(one.source, dict(one.options), one.control, one.seed)


def probed(one: One) -> Experiment:
    """Return the experiment of a run once its world could be built; raise InputError if not."""

    def probe() -> Experiment:
        experiment = opened(one)
        open_world(experiment, one.seed)
        return experiment

    return _within(one.time_limit, probe)


def measures_of(
    measures: tuple[str | Measure, ...], experiment: Experiment, scenario: Scenario | None = None
) -> dict[str, Measure]:
    """Return measures by their names, those given by name from the file or built in.

    scenario: if given, it is asked whether it has what they need.
    """
    return {
        name_in(measure): measure_named(measure, experiment.functions, scenario)
        if isinstance(measure, str)
        else measure
        for measure in measures
    }


def name_in(measure: str | Measure) -> str:
    """Return what a measure is called, that was given by name or as a function."""
    return measure if isinstance(measure, str) else name_of(measure)


def _within(seconds: float | None, work: Callable[[], T]) -> T:
    """Return what some work returns; raise TooLong, which names the line, if it takes longer.

    It is done in a thread, which is left behind where it waits for the system and can't be broken
    off: it ends when it wakes.
    """
    if seconds is None:
        return work()
    from mars2d.core.deadline import Deadline, Late

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
            return outcome.get(timeout=0.5)()  # Ctrl-C waits for it, on Windows


def _raise(error: BaseException) -> Any:
    raise error
