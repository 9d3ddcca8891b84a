"""Estimates: the means and shares that summarize the measures of a table."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import isfinite, nan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.study.measures import BUILT_IN
from mars2d.study.statistics import (
    Interval,
    interval,
    paired,
    paired_shares,
    shared,
)
from mars2d.study.table import Result, Table

Float = NDArray[np.float64]
Value = float | str | None

MAX_WORDS = 4
"""How many words of a measure have a share each; the others, less frequent, share one."""

MEASURED = {"capture_time": "caught"}
"""The word for runs in which a measure is a number, if there is one."""


@dataclass(frozen=True)
class Estimate:
    """A number to be estimated from a point's runs: the mean of a measure, or a share of runs.

    label: its name. share: whether it is a share of all runs, from 0 to 1. tells: makes a number of
    a run's value; nan leaves the run out. some: whether it is the mean of only some runs, since
    others have no number; then another estimate is the share of those runs.
    """

    measure: str
    label: str
    unit: str
    share: bool
    tells: Callable[[Value], float]
    some: bool = False

    def values(self, results: Sequence[Result]) -> Float:
        """Return the numbers of the runs that did not fail, (k,)."""
        return np.array(list(self.by_seed(results).values()), dtype=float)

    def by_seed(self, results: Sequence[Result]) -> dict[int, float]:
        """Return the numbers of the runs that did not fail, by seed."""
        return {r.seed: self.tells(r.measures.get(self.measure)) for r in results if not r.error}

    def interval(self, values: Float, confidence: float = 0.95) -> Interval:
        """Estimate from values (k,): Student's interval for a mean, Wilson's for a share."""
        return (shared if self.share else interval)(values, confidence)

    def difference(self, a: Float, b: Float, confidence: float = 0.95) -> Interval:
        """Return the difference a - b, of values of the same seeds in order, (k,) each."""
        return (paired_shares if self.share else paired)(a, b, confidence)


def estimates(table: Table, *, both: bool = True) -> list[Estimate]:
    """Return the estimates for the measures of a table.

    both: whether to include the second of two shares that add up to 1.

    Numbers have a mean; truth values, words and the presence of a number have shares. The mean over
    only those runs that have a number is misleading by itself (a capture time, if some evaders
    escaped), so the share of these runs follows it.
    """
    sound = [result for result in table.results if not result.error]
    return [
        each
        for measure in table.measures
        for values in [[result.measures.get(measure) for result in sound]]
        for each in _of(measure, table.unit(measure), values, both=both)
    ]


def _of(measure: str, unit: str, values: list[Value], *, both: bool) -> list[Estimate]:
    found = []
    numbers = [value for value in values if _is_number(value)]
    words = Counter(value for value in values if isinstance(value, str))
    some = len(numbers) < len(values)
    truths = measure not in BUILT_IN and all(isinstance(v, int) and v in (0, 1) for v in numbers)
    if numbers and truths:  # no built-in measure is
        found.append(Estimate(measure, f"{measure} = 1", "", True, _number, some))
    elif numbers or not words:
        found.append(Estimate(measure, measure, unit, False, _number, some))
    if (numbers or not words) and some:
        label = MEASURED.get(measure, f"{measure} measured")
        found.append(Estimate(measure, label, "", True, lambda v: float(_is_number(v))))
    kept = [word for word, _ in words.most_common(MAX_WORDS)]
    found += [_share_of(measure, word, {word}) for word in kept]
    if len(words) > len(kept):
        found.append(_share_of(measure, "any other", {*words} - {*kept}))
    if words and None in values:
        found.append(_share_of(measure, "none", {None}))
    if len(found) == 2 and len({*values}) == 2 and not numbers and not both:
        found.pop()
    return found


def _share_of(measure: str, name: str, values: set[Any]) -> Estimate:
    return Estimate(measure, f"{measure} = {name}", "", True, lambda v: float(v in values))


def _is_number(value: Value) -> bool:
    return isinstance(value, (int, float)) and isfinite(value)


def _number(value: Value) -> float:
    return float(value) if value is not None and _is_number(value) else nan
