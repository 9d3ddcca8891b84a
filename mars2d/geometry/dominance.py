"""Dominance: the places that one who flees reaches before one who hunts."""

from __future__ import annotations

from functools import lru_cache
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.arithmetic import cosine_sine

Float = NDArray[np.float64]
FAR = 1e3
"""Where one who flees is never caught on a straight way, the boundary is drawn so far away, m."""


def dominance(
    evader: ArrayLike, pursuer: ArrayLike, ratio: float, capture: float = 0.0, count: int = 360
) -> Float:
    """Return the boundary of an evader's dominance region (2, count), metres, counter-clockwise.

    evader, pursuer: their positions (2,), metres. ratio: the evader's speed over the pursuer's.
    capture: how near the pursuer has to come, metres, less than they are apart. Both go straight in
    any direction. The boundary has a point in each of `count` directions from the evader, the first
    along the x axis: the way s at whose end the pursuer is `capture` away if it goes there, too,
    |E + s u - P| = capture + s / ratio, or 1 km if there is none.

    Without `capture` it is the Apollonius circle for ratio < 1, and the perpendicular bisector for
    ratio = 1 (Isaacs, Differential Games, 1965); with one it is a Cartesian oval.

    >>> circle = dominance((3, 0), (0, 0), 0.5, count=4)
    >>> circle.round(9).tolist()
    [[6.0, 3.0, 2.0, 3.0], [0.0, 1.732050808, 0.0, -1.732050808]]
    """
    e, p = np.asarray(evader, dtype=float), np.asarray(pursuer, dtype=float)
    ways = _ways(count)
    apart = e - p
    a, b = 1 - 1 / ratio**2, ways[0] * apart[0] + ways[1] * apart[1] - capture / ratio
    c = apart[0] ** 2 + apart[1] ** 2 - capture**2
    inside = b * b - a * c  # of the root of a s^2 + 2 b s + c = 0
    below = np.sqrt(np.maximum(inside, 0.0)) - b
    meets = (inside >= 0) & (below > c / FAR)
    way = np.where(meets, c / np.where(meets, below, 1.0), FAR)
    return np.asarray(e[:, None] + way * ways)


@lru_cache(maxsize=8)
def _ways(count: int) -> Float:
    """Return unit vectors in as many directions (2, count), counter-clockwise from the x axis."""
    ways = np.array([cosine_sine(2 * pi * k / count) for k in range(count)]).T
    ways.flags.writeable = False
    return ways
