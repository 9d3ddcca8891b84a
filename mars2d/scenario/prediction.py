"""Predictions: a number by a formula, a number measured in a run, and whether they agree."""

from __future__ import annotations

import math
import numbers
import textwrap
from collections.abc import Sequence
from typing import Any, Self

from mars2d.core.description import Description, choice, entry, real, text, wrong
from mars2d.core.description import number as checked_number
from mars2d.core.errors import InputError, counted

WIDTH = 80
"""Columns of a table, as a terminal has."""

DIGITS = 12
"""The most significant digits that a table shows."""

MAX_ZEROS = 6
"""The most decimals of an exact 0."""

SIGNS = {"equal": "", "at least": ">= ", "at most": "<= "}
"""What stands before the predicted number, by the kind of bound."""


def _measured(name: str, value: object) -> float:
    """Check a number that may be NaN or infinite: a measurement can fail."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise wrong(name, value, "a number, or nan where nothing was measured")
    return float(value)


class Prediction(Description):
    """A number that a formula predicts, and the number that a run measured.

    Where a theory gives a bound, such as what a player gets for sure, `bound` says so. Where its
    conditions do not hold, `Prediction.silent` gives the reason instead of numbers. `measured` may
    be NaN or infinite if nothing could be measured: that is never ok. Raises InputError for other
    fields that are not finite, and for a tolerance below 0.

    >>> fall = Prediction("time to fall", 0.45, 0.448, 0.01, "s")
    >>> fall.ok
    True
    """

    name: str = text(kw_only=False, doc="the predicted quantity, in a few words")
    predicted: float = entry(check=real, kw_only=False, doc="the predicted number")
    measured: float = entry(check=_measured, kw_only=False, doc="the number found in the record")
    tolerance: float = checked_number(
        low=0, kw_only=False, doc="the largest allowed difference, in the same unit"
    )
    unit: str = text(
        default="", kw_only=False, doc="the unit of all three numbers; empty for counts and ratios"
    )
    bound: str = choice(
        of=tuple(SIGNS), default="equal", doc="how the measured number stands to the predicted one"
    )
    reason: str = text(
        default="", doc="why the theory does not apply to the run; then the numbers do not count"
    )

    @classmethod
    def within(
        cls, name: str, predicted: float, measured: float, percent: float, unit: str = ""
    ) -> Self:
        """Return a prediction whose tolerance is a share of the predicted number.

        percent: > 0. Raises InputError if the prediction is 0, since all shares of it are 0.

        >>> Prediction.within("speed", 0.5, 0.49, percent=4, unit="m/s").tolerance
        0.02
        """
        share = real("Prediction.within(percent)", percent, "a number > 0")
        if share <= 0:
            raise wrong("Prediction.within(percent)", percent, "a number > 0")
        if not real("Prediction.predicted", predicted):
            hint = "write Prediction(...) with a tolerance"
            raise InputError(f"Prediction.within({name!r}): {share:g} % of 0 is 0; {hint}")
        return cls(name, predicted, measured, abs(float(predicted)) * share / 100, unit)

    @classmethod
    def silent(cls, name: str, reason: str) -> Self:
        """Return what stands for a prediction where the conditions of its theory do not hold.

        >>> Prediction.silent("capture", "a wall is nearer than the meeting point").verdict
        'not predicted'
        """
        return cls(name, 0.0, math.nan, 0.0, reason=reason)

    @property
    def ok(self) -> bool | None:
        """Whether the measured number is as predicted, within the tolerance; None if silent."""
        if self.reason:
            return None
        above = self.measured - self.predicted
        low = self.bound == "at most" or above >= -self.tolerance
        high = self.bound == "at least" or above <= self.tolerance
        return math.isfinite(self.measured) and low and high

    @property
    def verdict(self) -> str:
        """How it ended: ``ok``, ``NOT OK`` or ``not predicted``."""
        return {True: "ok", False: "NOT OK", None: "not predicted"}[self.ok]

    def as_dict(self) -> dict[str, Any]:
        """Return name, numbers, bound and ok, as JSON can hold them.

        JSON has no NaN and infinities: a measured number of these is None. A silent prediction has
        its reason in place of numbers, and None as ok.
        """
        if self.reason:
            return {"name": self.name, "reason": self.reason, "ok": None}
        found = {key: value for key, value in vars(self).items() if key not in {"unit", "reason"}}
        found["measured"] = self.measured if math.isfinite(self.measured) else None
        return found | {"ok": self.ok}


def table(predictions: Sequence[Prediction]) -> str:
    """Return predictions as a table of text, 80 columns wide; empty if there are none.

    Numbers have enough digits to show the tolerance. Long names take several lines.
    """
    if not predictions:
        return ""
    rows = [("predicted", "measured", "tolerance", "", "")]
    rows += [
        ("", "", "", "", p.verdict) if p.reason else (*cells(p), p.unit, p.verdict)
        for p in predictions
    ]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    room = max(WIDTH - sum(widths) - 2 * len(widths), 8)
    names = [[""], *(textwrap.wrap(p.name, room) for p in predictions)]
    first = max(len(line) for name in names for line in name)
    lines = []
    for (*above, last), row in zip(names, rows, strict=True):
        shown = [cell.rjust(w) for cell, w in zip(row[:3], widths, strict=False)]
        shown += [row[3].ljust(widths[3]), row[4]]
        lines += [*above, "  ".join([last.ljust(first), *shown]).rstrip()]
    reasons = dict.fromkeys(p.reason for p in predictions if p.reason)
    wrapped = (textwrap.fill(f"not predicted: {each}", WIDTH) for each in reasons)
    return "\n".join([*lines, summary(predictions), *wrapped])


def summary(predictions: Sequence[Prediction]) -> str:
    """Return how many predictions hold, in words, such as ``3 of 4 predictions ok``."""
    found = [p.ok for p in predictions]
    silent, tested = found.count(None), len(found) - found.count(None)
    parts = [f"{found.count(True)} of {counted(tested, 'prediction')} ok"] if tested else []
    return ", ".join([*parts, f"{silent} not predicted"] if silent else parts)


def cells(prediction: Prediction) -> tuple[str, str, str]:
    """Return the predicted number with the sign of its bound, the measured one, the tolerance."""
    p = prediction
    tolerance = f"{p.tolerance:.{3 if p.tolerance < 1000 else 6}g}"
    predicted = SIGNS[p.bound] + number(p.predicted, p.tolerance)
    return predicted, number(p.measured, p.tolerance), tolerance


def number(value: float, tolerance: float) -> str:
    """Return a number as text, down to two digits of the tolerance; 12 digits at most."""
    if math.isnan(value):
        return "not a number"
    if math.isinf(value):
        return "infinite" if value > 0 else "-infinite"
    if tolerance == 0:
        return f"{value:.{DIGITS}g}"
    last = _exponent(tolerance) - 1  # the power of ten of the last digit
    first = _exponent(value) if value else 0
    decimals = max(-last, 0)
    if value == 0 and decimals > MAX_ZEROS:
        return "0"
    if decimals < DIGITS and max(first, 0) + 1 + decimals <= DIGITS:
        return f"{value:z.{decimals}f}"
    significant = min(max(first - last + 1, 2), DIGITS)
    return f"{value:#.{significant}g}".removesuffix(".")


def _exponent(value: float) -> int:
    return math.floor(math.log10(abs(value)))
