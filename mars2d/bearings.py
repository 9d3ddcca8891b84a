"""Range and bearing of points, as they are seen from somewhere."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, inf, nan, pi
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.geometry import Point, wrap
from mars2d.quantity import Quantity

__all__ = ["BEARING", "RANGE", "Sight", "hold_missing", "sighted"]

Float = NDArray[np.float64]

RANGE = Quantity("range", "m", "distance")
BEARING = Quantity("bearing", "rad", "angle")


class Sight(Protocol):
    """What says whether something is in the way; see `mars2d.sensors.Surroundings`."""

    def hidden(
        self, start: Point, points: Float, bodies: ArrayLike, ignore: int
    ) -> NDArray[np.bool_]:
        """Return whether something stands between `start` and points (k, 2)."""


def sighted(
    pose: Float,
    points: Float,
    reach: float,
    field_of_view: float,
    sight: Sight | None = None,
    bodies: Sequence[int] | NDArray[np.int64] = (),
    ignore: int = -1,
) -> Float:
    """Return rows (k, 2) of range [m] and bearing [rad] of points (k, 2) as seen from a pose (3,).

    reach: how far one sees, metres. field_of_view: the angle seen about the heading, radians.
    sight: says what is hidden; None: nothing is. bodies: (k,), what each point belongs to. ignore:
    the robot that is never in the way. What is not seen reads (inf, nan).
    """
    rows = np.tile([inf, nan], (len(points), 1))
    x, y, theta = pose.tolist()
    across, upwards = points[:, 0] - x, points[:, 1] - y
    apart = np.hypot(across, upwards)
    near = np.flatnonzero(apart <= reach)
    angles = [
        atan2(b, a) for a, b in zip(across[near].tolist(), upwards[near].tolist(), strict=True)
    ]
    bearings = wrap(np.array(angles) - theta) + 0.0  # 0, not -0
    if field_of_view < 2 * pi:
        ahead = np.abs(bearings) <= field_of_view / 2
        near, bearings = near[ahead], bearings[ahead]
    if sight is not None and len(near):
        hidden = sight.hidden((x, y), points[near], np.asarray(bodies)[near], ignore)
        near, bearings = near[~hidden], bearings[~hidden]
    rows[near, 0], rows[near, 1] = apart[near], bearings
    return rows


def hold_missing(rows: Float, true: Float) -> Float:
    """Return measured rows (k, 2) of range and bearing with both missing where either is.

    true: the perfect rows. What was not seen stays unseen, whatever noise and outliers made of it.
    """
    seen = np.isfinite(rows + true).all(axis=1, keepdims=True)
    return np.where(seen, rows, [inf, nan])
