"""Sweeps: an experiment is run at each point of a grid of settings, with the same seeds."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from mars2d.core.checks import items_of
from mars2d.core.description import wrong
from mars2d.core.errors import InputError
from mars2d.scenario.scenario import Scenario
from mars2d.study.table import Table

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from mars2d.study.measures import Measure


def sweep(
    experiment: str | Path | ModuleType | Scenario,
    settings: Mapping[str, Any] | None = None,
    seeds: int | Iterable[int] = 1,
    measures: str | Measure | Iterable[str | Measure] = (),
    *,
    control: Callable[[Any], Any] | None = None,
    stop_time: float | None = None,
    units: Mapping[str, str] | None = None,
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
    seeds: how many, from 0 on, or a list. All points have the same ones, so that they can be
    compared seed by seed. measures: names of built-in measures or of functions in the experiment's
    file, or functions of the record; by default the end time, the collisions and, in a game, the
    capture time. control: the law of the team, in place of the experiment's. stop_time: seconds, as
    another setting. units: those of settings and measures, by name, where they are not known: of
    fields of a scenario and of built-in measures they are.

    out: a .csv file to which each row is added when its run is done. Runs whose rows it holds are
    not repeated, except, with `retry`, those with an error. executor: any of concurrent.futures; by
    default processes are started, `workers` of them, one a core. With processes, call this under
    ``if __name__ == "__main__":``. time_limit: seconds that a run may take. keep: whether the runs'
    records are kept in a folder beside `out`: then a later sweep with `keep` and other measures
    takes these from the records, without a run. show_progress: whether a terminal shows a bar.

    A run that fails is a row with its `error`. The first five runs, evenly spaced over the study,
    are trials: if all of them fail, no others are made. The rows depend neither on the workers nor
    on the order in which runs end, and each has the digest of ``mars2d.run`` with the same options.

    Raises InputError, before the first run, for anything that can't be run, and if the file holds
    another study; `mars2d.study.run.StudyFailedError` if all trials fail, or a measure in the first
    one; `mars2d.study.run.StudyInterrupted` after Ctrl-C. Both have the rows as their `table`.
    """
    # Imported late, since importing processes and networks takes a while.
    from mars2d.study.plan import Plan, seeds_of, settings_of
    from mars2d.study.prepare import prepared
    from mars2d.study.run import run_study
    from mars2d.study.work import leave_if_imported_again

    leave_if_imported_again()
    if not isinstance(out, (str, Path, type(None))):
        raise wrong("out", out, "the name of a file, such as 'results.csv'")
    plan = Plan(settings_of(_with_stop_time(settings, stop_time)), seeds_of(seeds))
    study = prepared(
        experiment,
        plan,
        _listed(measures),
        control=control,
        time_limit=time_limit,
        units=units,
    )
    return run_study(
        study,
        None if out is None else Path(out),
        executor=executor,
        workers=workers,
        retry=retry,
        keep=keep,
        show_progress=show_progress,
    )


def _with_stop_time(settings: Mapping[str, Any] | None, stop_time: float | None) -> Any:
    if stop_time is None or not isinstance(settings, (Mapping, type(None))):
        return settings
    if settings and "stop_time" in settings:
        raise InputError("stop_time is given twice, once among the settings")
    return {**(settings or {}), "stop_time": stop_time}


def _listed(measures: str | Measure | Iterable[str | Measure]) -> tuple[str | Measure, ...]:
    if isinstance(measures, str) or callable(measures):
        return (measures,)
    expected = "names of measures, or functions of a record"
    listed = tuple(items_of("measures", measures, expected))
    for measure in listed:
        if not isinstance(measure, str) and not callable(measure):
            raise wrong("measures", measure, expected)
    return listed
