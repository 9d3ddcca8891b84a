"""Statistics of many runs: intervals, shares, paired differences, and how many seeds are enough.

Runs with different seeds are independent, so methods for independent observations apply. Values
that are nan or infinite are taken as missing and left out; `count` is the number of the others.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, nan, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.description import real, wrong

Float = NDArray[np.float64]


@dataclass(frozen=True)
class Interval:
    """A mean, its confidence bounds, and the number of observations.

    The bounds are nan if there are too few observations.
    """

    mean: float
    low: float
    high: float
    count: int

    @property
    def half_width(self) -> float:
        """Half the distance between the bounds."""
        return (self.high - self.low) / 2


def interval(values: ArrayLike, confidence: float = 0.95) -> Interval:
    """Return the mean of values (n,) and its Student interval.

    A single value has no bounds, and equal values have an interval of width zero. The interval is
    exact for normally distributed values, and a good approximation for many others.
    Source: Student, The probable error of a mean, Biometrika 6 (1908).

    >>> found = interval([4.0, 5.0, 6.0])
    >>> found.mean, round(found.low, 3), round(found.high, 3)
    (5.0, 2.516, 7.484)
    """
    from scipy.stats import t

    confidence, found = confident(confidence), _finite(values)
    count, mean = len(found), _mean(found)
    if count < 2:
        return Interval(mean, nan, nan, count)
    if np.ptp(found) == 0:
        return Interval(mean, mean, mean, count)
    low, high = t.interval(confidence, count - 1, mean, found.std(ddof=1) / sqrt(count))
    return Interval(mean, float(low), float(high), count)


def proportion(successes: float, count: int, confidence: float = 0.95) -> Interval:
    """Return the share of successes among `count` runs and its Wilson interval, from 0 to 1.

    The interval also holds for few runs and for shares near 0 and 1, where mean and deviation
    mislead. Without any runs the share is nan, with bounds 0 and 1.
    Source: E. B. Wilson, Journal of the American Statistical Association 22 (1927).

    >>> found = proportion(0, 10)
    >>> found.mean, found.low, round(found.high, 3)
    (0.0, 0.0, 0.278)
    """
    z = _normal(confident(confidence))
    if not 0 <= successes <= count:
        raise wrong("proportion(successes)", successes, f"a number from 0 to {count}, the count")
    if not count:
        return Interval(nan, 0.0, 1.0, 0)
    share = successes / count  # of halves, too, as draws are: scipy's takes whole ones alone
    middle, half = (share + z**2 / (2 * count)) / (1 + z**2 / count), _wilson_half(share, count, z)
    low = max(middle - half, 0.0) if successes else 0.0
    high = min(middle + half, 1.0) if successes < count else 1.0
    return Interval(share, low, high, int(count))


def paired(a: ArrayLike, b: ArrayLike, confidence: float = 0.95) -> Interval:
    """Return the mean of a - b and its Student interval, where a[k] and b[k] form a pair.

    a, b: (n,), of runs from the same seeds. Chance that affects both alike cancels out, so the
    interval is narrower if a and b are correlated. Pairs with a missing value are left out, and
    `count` is the number of the others. Raises InputError for other shapes.
    Source: A. M. Law, Simulation Modeling and Analysis, 5th ed. (2015), sections 10.2.1 and 11.2,
    paired-t interval and common random numbers.
    """
    first, second = _pairs(a, b)
    with np.errstate(invalid="ignore", over="ignore"):
        return interval(first - second, confidence)


def paired_shares(a: ArrayLike, b: ArrayLike, confidence: float = 0.95) -> Interval:
    """Return the share in a minus that in b, from -1 to 1, where a[k] and b[k] form a pair.

    a, b: (n,) of 1 and 0; a pair with a nan is left out. Even if all pairs agree, the interval has
    some width, like that of `proportion`.
    Source: D. G. Bonett, R. M. Price, Journal of Educational and Behavioral Statistics 37 (2012),
    the adjusted Wald interval.
    """
    z = _normal(confident(confidence))
    first, second = _pairs(a, b)
    both = np.isfinite(first) & np.isfinite(second)
    n = int(both.sum())
    if not n:
        return Interval(nan, nan, nan, 0)
    more, less = (int((both & (x > y)).sum()) for x, y in ((first, second), (second, first)))
    up, down = (more + 1) / (n + 2), (less + 1) / (n + 2)
    half = z * sqrt((up + down - (up - down) ** 2) / (n + 2))
    low, high = max(up - down - half, -1.0), min(up - down + half, 1.0)
    return Interval((more - less) / n, low, high, n)


def shared(values: ArrayLike, confidence: float = 0.95) -> Interval:
    """Return the share of 1 among values (n,) of 1 and 0, with Wilson's interval."""
    found = _finite(values)
    return proportion(int((found == 1).sum()), len(found), confidence)


def seeds_needed(values: ArrayLike, half_width: float, confidence: float = 0.95) -> int | None:
    """Return how many runs give an interval of at most this half width, if they vary like these.

    values: (n,) of the runs so far; None is returned for fewer than two. The result is about the
    smallest n with t s / sqrt(n) <= half_width, where Student's t is that of n runs and s is the
    standard deviation of the values. The forecast is as good as the estimate s.
    Source: W. C. Guenther, The American Statistician 35 (1981).

    >>> seeds_needed([9.0, 10.0, 11.0], half_width=0.5)
    18
    """
    z, wanted, found = _normal(confident(confidence)), _width(half_width), _finite(values)
    if len(found) < 2:
        return None
    return ceil((z * float(found.std(ddof=1)) / wanted) ** 2 + z**2 / 2)


def seeds_for_share(share: float, half_width: float, confidence: float = 0.95) -> int:
    """Return how many runs give a share an interval of at most this half width (of 1).

    >>> seeds_for_share(0.5, 0.1)
    93
    """
    z, w, pq = _normal(confident(confidence)), _width(half_width), share * (1 - share)
    root = sqrt(pq**2 + (1 - 4 * pq) * w**2)  # Wilson's half width is w at a root of a quadratic
    return max(ceil(z**2 * (pq - 2 * w**2 + root) / (2 * w**2)), 1)


# -- helpers ---------------------------------------------------------------------------------------


def _normal(confidence: float) -> float:
    from scipy.special import ndtri

    return float(ndtri((1 + confidence) / 2))


def _wilson_half(share: float, count: int, z: float) -> float:
    within = share * (1 - share) / count + z**2 / (4 * count**2)
    return z / (1 + z**2 / count) * sqrt(within)


def _finite(values: ArrayLike) -> Float:
    found: Float = np.asarray(values, dtype=float).ravel()
    return found[np.isfinite(found)]


def _pairs(a: ArrayLike, b: ArrayLike) -> tuple[Float, Float]:
    first, second = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    if first.ndim != 1 or first.shape != second.shape:
        raise wrong("pairs", (first.shape, second.shape), "two lists of the same length")
    return first, second


def _mean(values: Float) -> float:
    """Return the mean, for equal values that value to the last bit; nan for no values."""
    if not len(values):
        return nan
    with np.errstate(over="ignore"):
        return float(values[0]) if np.ptp(values) == 0 else float(values.mean())


def confident(value: object) -> float:
    """Return a given confidence; raise InputError if it is not between 0 and 1."""
    expected = "a share between 0 and 1, such as 0.95"
    confidence = real("confidence", value, expected)
    if not 0 < confidence < 1:
        raise wrong("confidence", value, expected)
    return confidence


def _width(value: object) -> float:
    half_width = real("half_width", value, "a number > 0")
    if half_width <= 0:
        raise wrong("half_width", value, "a number > 0")
    return half_width
