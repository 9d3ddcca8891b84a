"""One run of a study: the job that a worker is sent, and the result that it returns."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from mars2d.core.deadline import Deadline
from mars2d.core.errors import Late, LawError, Mars2dError
from mars2d.core.usercode import name_of
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.scenario.scenario import Scenario
from mars2d.study.kept import recorded
from mars2d.study.measures import Measure, measure_named, measured
from mars2d.study.table import Result
from mars2d.world.loop import open_world

T = TypeVar("T")

CODE_DIGITS = 8
"""How many digits of a hash tell the code of runs apart."""


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
    """Do one run and take all measures; errors are reported in the result's `error`.

    What a run that is broken off has measured by then remains.
    """
    found: dict[str, float | str | None] = {name_in(measure): None for measure in job.measures}
    errors, code, digest = list[Mars2dError](), "", ""

    def make() -> None:
        nonlocal code, digest
        experiment = opened(job)
        code = code_of(experiment, job.code)
        record = recorded(experiment, code, job.records)
        digest = record.digest
        for name, measure in measures_of(job.measures, experiment).items():
            try:
                found[name] = measured(name, measure, record)
            except Mars2dError as error:
                errors.append(error)

    try:
        _within(job.time_limit, make)
    except Mars2dError as error:
        errors.append(error)
    said = "; ".join(" ".join(str(error).split()) for error in errors)
    return Result(job.row, job.options, job.seed, found, said, digest, code)


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


def code_of(experiment: Experiment, otherwise: str = "") -> str:
    """Return the first digits of a hash of MARS2D's version and of all files of an experiment.

    Files count by name and content, wherever they lie. otherwise: returned if there are no files.
    """
    import mars2d

    if not experiment.source.written:
        return otherwise
    sha = hashlib.sha256(mars2d.__version__.encode())
    for file in sorted(experiment.source.written, key=lambda path: (path.name, str(path))):
        content = file.read_bytes() if file.is_file() else b""
        sha.update(f"\n{file.name} ".encode(errors="backslashreplace"))
        sha.update(hashlib.sha256(content).digest())
    return sha.hexdigest()[:CODE_DIGITS]


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
    """Return the result of `work`; raise LawError, which names the line, if it takes longer.

    A call that waits for the operating system, or in C, is not broken off.
    """
    if seconds is None:
        return work()
    limit = Deadline(seconds)
    try:
        with limit:
            return work()
    except Late:
        where = f", in {limit.where}" if limit.where else ""
        raise LawError(f"took longer than {seconds:g} s{where}") from None
