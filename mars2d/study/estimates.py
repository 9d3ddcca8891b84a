"""Estimates: which means and shares the measures of a table come to."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import isfinite, nan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.study.measures import BUILT_IN, UNITS
from mars2d.study.statistics import (
    Interval,
    interval,
    paired,
    paired_shares,
    shared,
    unpaired,
    unpaired_shares,
)
from mars2d.study.table import Result, Table

__all__ = ["Estimate", "estimates"]

Float = NDArray[np.float64]
Value = float | str | None

MOST_WORDS = 4
"""So many words of a measure have a share each; others, seen less often, have one together."""

MEASURED = {"capture_time": "caught"}
"""What is said of runs in which a measure is a number, where there is a word for it."""


@dataclass(frozen=True)
class Estimate:
    """One number that runs of a point are to tell: the mean of a measure, or a share of the runs.

    label: what it is called. share: whether it is a share of all runs, from 0 to 1. tells: what a
    run's value counts as; nan if it is left out. some: whether it is the mean of only some of the
    runs, since others have no number: beside it there is an estimate of their share.
    """

    measure: str
    label: str
    unit: str
    share: bool
    tells: Callable[[Value], float]
    some: bool = False

    def values(self, results: Sequence[Result]) -> Float:
        """Return what runs count as, (k,), without those that failed."""
        return np.array(list(self.by_seed(results).values()), dtype=float)

    def by_seed(self, results: Sequence[Result]) -> dict[int, float]:
        """Return what runs count as by their seeds, without those that failed."""
        return {r.seed: self.tells(r.measures.get(self.measure)) for r in results if not r.error}

    def interval(self, values: Float, confidence: float = 0.95) -> Interval:
        """Return the estimate of values (k,): Student's interval of a mean, Wilson's of a share."""
        return (shared if self.share else interval)(values, confidence)

    def difference(self, a: Float, b: Float, confidence: float = 0.95) -> Interval:
        """Return by how much `a` is more than `b`, values of the same seeds in turn, (k,) each."""
        return (paired_shares if self.share else paired)(a, b, confidence)

    def apart(self, a: Float, b: Float, confidence: float = 0.95) -> Interval:
        """Return by how much `a` (k,) is more than `b` (m,), of whatever seeds."""
        return (unpaired_shares if self.share else unpaired)(a, b, confidence)


def estimates(table: Table, *, both: bool = True) -> list[Estimate]:
    """Return what the measures of a table come to.

    both: whether of two shares that make up the whole the second is there as well.

    Numbers have a mean; truths, words, and whether there is a number at all, have shares. A mean of
    those runs alone that have a number misleads where others have none, such as a time to capture
    where somebody escaped: so their share follows it.
    """
    sound = [result for result in table.results if not result.error]
    return [
        each
        for measure in table.measures
        for each in _of(measure, [result.measures.get(measure) for result in sound], both=both)
    ]


def _of(measure: str, values: list[Value], *, both: bool) -> list[Estimate]:
    unit = UNITS.get(measure, "")
    found = []
    numbers = [value for value in values if _is_number(value)]
    words = Counter(value for value in values if isinstance(value, str))
    some = len(numbers) < len(values)
    truths = measure not in BUILT_IN and all(isinstance(v, int) and v in (0, 1) for v in numbers)
    if numbers and truths:  # of those that are built in, none is
        found.append(Estimate(measure, f"{measure} = 1", "", True, _number, some))
    elif numbers or not words:
        found.append(Estimate(measure, measure, unit, False, _number, some))
    if (numbers or not words) and some:
        label = MEASURED.get(measure, f"{measure} measured")
        found.append(Estimate(measure, label, "", True, lambda v: float(_is_number(v))))
    kept = [word for word, _ in words.most_common(MOST_WORDS)]
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
