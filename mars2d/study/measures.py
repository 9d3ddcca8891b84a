"""Measures: a result of a run as one number or one word."""

from __future__ import annotations

import inspect
import math
import numbers
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from mars2d.core.errors import InputError, LawError, nearest, shown
from mars2d.core.usercode import called, definition
from mars2d.scenario.roles import contest_of

if TYPE_CHECKING:
    from mars2d.scenario.scenario import Scenario
    from mars2d.world.record import Record

Measure = Callable[["Record"], Any]

MAX_WORD_LENGTH = 80
"""The longest word, in letters, since it stands in one cell of a table."""

EXPECTED = "expected a number, a word, or None where there is nothing to measure"


# -- built-in measures -----------------------------------------------------------------------------


def capture_time(record: Record) -> float | None:
    """When the last evader of its contest was caught, seconds; nothing where one stayed free."""
    contest = contest_of(record.scenario, "measure 'capture_time'")
    time = contest.outcome(record).capture_time
    return None if math.isnan(time) else time


def winner(record: Record) -> str | None:
    """The role that won its contest, a word; nothing where it stayed undecided."""
    return contest_of(record.scenario, "measure 'winner'").outcome(record).winner


def end_time(record: Record) -> float | None:
    """When the run ended, seconds."""
    return float(record.time[-1]) if len(record) else None


def collisions(record: Record) -> int:
    """How many times two bodies came to touch."""
    return record.collisions


def path_length(record: Record) -> float | None:
    """How far the robots drove, metres: the mean over the robots."""
    if not len(record):
        return None
    from mars2d.output.signals import signals

    (speed,) = signals(record, ["speed"], None)
    driven = np.nansum(speed.values, axis=0) * record.scenario.sampling_time
    return float(driven.mean())


def least_clearance(record: Record) -> float | None:
    """The least gap between a robot and another body, metres; 0 in touch, nothing if alone."""
    if not len(record):
        return None
    from mars2d.output.figures.distances import clearances

    gaps = clearances(record).pair
    return float(gaps.min()) if gaps.size else None


def final_spread(record: Record) -> float | None:
    """How far the robots are from their common centre at the end, metres: root mean square."""
    if not len(record):
        return None
    place = record.pose[-1, :2]
    apart = place - place.mean(axis=1, keepdims=True)
    return float(np.sqrt((apart**2).sum(axis=0).mean()))


def effort(record: Record) -> float | None:
    """How much of their bounds the drives used, from 0 to 1: the mean over robots and time."""
    return float(record.effort[1:].mean()) if len(record) > 1 else None


BUILT_IN: dict[str, Measure] = {
    measure.__name__: measure
    for measure in (
        capture_time, winner, end_time, collisions, path_length, least_clearance, final_spread,
        effort,
    )
}  # fmt: skip

NO_MEASURES = ("scenario", "control", "checks")
"""The functions of an experiment's file that mean something else."""

UNITS = {
    "capture_time": "s",
    "end_time": "s",
    "path_length": "m",
    "least_clearance": "m",
    "final_spread": "m",
}
"""The units of the built-in measures that have one."""


# -- all measures ----------------------------------------------------------------------------------


def measure_named(
    name: str, functions: Mapping[str, Callable[..., Any]], scenario: Scenario | None = None
) -> Measure:
    """Return a measure by name: a function of the experiment's file, or else a built-in one.

    functions: the public functions of the file, by name; those that can be called with just a
    record are measures. scenario: if given, it is checked for what a built-in measure needs. Raises
    InputError, with the nearest name.
    """
    own = {key: made for key, made in functions.items() if key not in NO_MEASURES}
    if name in own:
        if not _takes_one(own[name]):
            raise InputError(
                f"measure {name!r}: {name}{inspect.signature(own[name])} is no measure: expected a "
                f"function of the record alone, such as {name}(record)"
            )
        return own[name]
    if name not in BUILT_IN:
        more = {key for key, function in own.items() if _takes_one(function)}
        known = nearest(name, [*BUILT_IN, *more], most=20)
        raise InputError(f"there is no measure {name!r}{known}")
    if scenario is not None and name in ("capture_time", "winner"):
        contest_of(scenario, f"measure {name!r}")
    return BUILT_IN[name]


def _takes_one(function: Callable[..., Any]) -> bool:
    try:
        inspect.signature(function).bind(None)
    except TypeError:
        return False
    return True


def measured(name: str, function: Measure, record: Record) -> float | str | None:
    """Return a measure of a record: a number, a word, or None.

    True and False become 1 and 0, NaN becomes None, and infinities stay. Raises LawError with file
    and line if a user's function raises or returns anything else, and InputError if a built-in
    measure does not apply.
    """
    if function is BUILT_IN.get(name):
        return _plain(function(record))
    with called(name, function):
        value = function(record)
    try:
        return _plain(value)
    except InputError as error:
        refused = LawError(f"{name} returned {shown(value)}: {error}")
        refused.where = definition(function)
        raise refused from None


def _plain(value: Any) -> float | str | None:
    """Return a plain Python number, or a word; raise InputError for anything else."""
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    if value is None:
        return None
    if isinstance(value, str):
        return _word(value)
    if not isinstance(value, (numbers.Real, np.bool_)):
        raise InputError(EXPECTED)
    number = float(value)
    if isinstance(value, (numbers.Integral, np.bool_)) and int(value) == number:
        return int(value)
    return None if math.isnan(number) else number


def _word(value: str) -> str:
    """Return a word on one line; raise InputError if it is a number, empty or too long."""
    word = " ".join(value.split())
    if not word:
        raise InputError("expected a word with letters, or None where there is nothing to measure")
    if len(word) > MAX_WORD_LENGTH:
        raise InputError(f"expected a word of at most {MAX_WORD_LENGTH} letters")
    try:
        float(word)
    except ValueError:
        return word
    raise InputError("a word that reads as a number; return the number itself")
