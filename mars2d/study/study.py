"""Studies: what is to be run, after finding out before the first run whether it can be."""

from __future__ import annotations

import dataclasses
import hashlib
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from types import ModuleType
from typing import Any

from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError, Mars2dError, MissingExtraError, shown
from mars2d.scenario.roles import contests_of
from mars2d.scenario.scenario import Scenario
from mars2d.scenario.serialize import from_description
from mars2d.study.job import CODE_DIGITS, Job, code_of, measures_of, name_in, probed
from mars2d.study.measures import Measure
from mars2d.study.plan import Plan
from mars2d.study.table import FIRST, LAST, SEED, cells_of

MAX_PROBES = 100
"""How many points are opened before the first run, at most."""


@dataclass(frozen=True)
class Study:
    """A study that can be run.

    title: the experiment's name in the table. blank: a job without row, options and seed.
    troubles: the errors at single points, whose runs will fail. codes: the code of the runs at some
    points, by the points' cells. written: when the files that were read had been written, ns.
    """

    title: str
    plan: Plan
    blank: Job
    troubles: tuple[str, ...]
    codes: dict[tuple[str, ...], str]
    written: Mapping[Path, int]

    @property
    def measures(self) -> tuple[str, ...]:
        """The names of the measures."""
        return tuple(name_in(measure) for measure in self.blank.measures)


def prepared(
    experiment: str | Path | ModuleType | Scenario,
    plan: Plan,
    measures: tuple[str | Measure, ...] = (),
    *,
    control: Callable[[Any], Any] | None = None,
    time_limit: float | None = None,
) -> Study:
    """Return the study of a plan, after opening its experiment at points that cover all values.

    Without measures, those that suit any run are taken. Raises InputError if no point can be
    opened, and for unknown names.
    """
    if time_limit is not None and real("time_limit", time_limit, "a number > 0 [s]") <= 0:
        raise wrong("time_limit", time_limit, "a number > 0 [s]")
    _check_columns(plan, measures)
    title, source = _source(experiment)
    code = ""
    if isinstance(source, Scenario):  # its laws count by their names alone
        code = hashlib.sha256(repr(from_description(source)).encode()).hexdigest()[:CODE_DIGITS]
    folder = os.getcwd()  # noqa: PTH109
    blank = Job(0, source, {}, plan.seeds[0], measures, folder, control, time_limit, code)
    first, failed = None, None
    troubles, codes, written = list[str](), dict[tuple[str, ...], str](), dict[Path, int]()
    for point in islice(plan.probes(), MAX_PROBES):
        try:
            found = probed(dataclasses.replace(blank, options=point))
        except MissingExtraError:
            raise
        except Mars2dError as error:
            where = ", ".join(f"{name} = {shown(value)}" for name, value in point.items())
            troubles.append(f"{error}" if where in f"{error}" else f"{where}: {error}")
            failed = failed or error
            continue
        first = first or found
        codes[cells_of(point)] = code_of(found, code)
        written |= found.source.written
    if first is None:
        assert failed is not None  # a plan has at least one point
        raise failed
    contest = ["capture_time"] if len(contests_of(first.scenario)) == 1 else []
    chosen = measures or (*contest, "end_time", "collisions")
    measures_of(chosen, first, first.scenario)
    blank = dataclasses.replace(blank, measures=chosen)
    return Study(title, plan, blank, tuple(troubles), codes, written)


def _check_columns(plan: Plan, measures: tuple[str | Measure, ...]) -> None:
    """Raise InputError for a name that two columns of the table would have."""
    if SEED in plan.settings:
        raise InputError("setting 'seed': seeds are not a setting; say how many, with --seeds N")
    taken = dict.fromkeys((*FIRST, SEED, *LAST), "a column of each table")
    kinds = [(name, "a setting") for name in plan.settings]
    kinds += [(name_in(measure), "a measure") for measure in measures]
    for name, kind in kinds:
        if name in taken:
            twice = "is there twice" if taken[name] == kind else f"is {taken[name]} as well"
            raise InputError(f"{kind.partition(' ')[2]} {name!r}: {twice}")
        taken[name] = kind


def _source(experiment: str | Path | ModuleType | Scenario) -> tuple[str, str | Scenario]:
    """Return the experiment's name in the table, and the source that workers open."""
    if isinstance(experiment, Scenario):
        return experiment.title or "Scenario", experiment
    module = isinstance(experiment, ModuleType)
    given = getattr(experiment, "__file__", None) if module else experiment
    if not isinstance(given, (str, Path)):
        expected = "a file, the name of an example, a module that has a file, or a Scenario"
        raise wrong("experiment", experiment, expected)
    path = Path(given)
    return (path.as_posix(), str(path.absolute())) if path.is_file() else (str(given), str(given))
