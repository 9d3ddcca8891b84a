"""Range and bearing of points as seen from a pose."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, inf, isfinite, nan, pi, sin
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.plane import Point, wrap
from mars2d.core.quantity import Quantity
from mars2d.core.scene import Scene, faded

__all__ = ["BEARING", "RANGE", "Sight", "beam_angles", "draw_sighted", "hold_missing", "sighted"]

Float = NDArray[np.float64]

RANGE = Quantity("range", "m", "distance")
BEARING = Quantity("bearing", "rad", "angle")

ROUNDING = 1e-9
"""The relative rounding error of a distance is less than this."""


class Sight(Protocol):
    """Tells whether something is in the way; see `mars2d.sensors.Surroundings`."""

    def hidden(
        self, start: Point, points: Float, bodies: ArrayLike, ignore: int
    ) -> NDArray[np.bool_]:
        """Return whether something is between `start` and each of the points (k, 2)."""


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

    reach: the largest range, metres. field_of_view: the angle seen about the heading, radians.
    sight: tells which points are hidden; without it, none is. bodies: (k,), the body to which each
    point belongs. ignore: the robot that is never in the way. A point that is not seen has the row
    (inf, nan).
    """
    rows = np.empty((len(points), 2))
    rows[:, 0], rows[:, 1] = inf, nan
    x, y, theta = pose.tolist()
    across, upwards = points[:, 0] - x, points[:, 1] - y
    # In a crowd, most points are outside the square about the circle that is seen.
    larger = np.maximum(np.abs(across), np.abs(upwards))
    near = np.flatnonzero(larger <= reach * (1 + ROUNDING))
    apart = np.hypot(across[near], upwards[near])
    near, apart = near[apart <= reach], apart[apart <= reach]
    angles = list(map(atan2, upwards[near].tolist(), across[near].tolist()))
    bearings = wrap(np.array(angles) - theta)
    if field_of_view < 2 * pi:
        ahead = np.abs(bearings) <= field_of_view / 2
        near, apart, bearings = near[ahead], apart[ahead], bearings[ahead]
    if sight is not None and len(near):
        seen = ~sight.hidden((x, y), points[near], np.asarray(bodies)[near], ignore)
        near, apart, bearings = near[seen], apart[seen], bearings[seen]
    rows[near, 0], rows[near, 1] = apart, bearings
    return rows


def hold_missing(rows: Float, true: Float) -> Float:
    """Return measured rows (k, 2) of range and bearing, with both missing if either is.

    true: the perfect rows. A point that was not seen stays missing, despite noise and outliers.
    """
    seen = np.isfinite(rows + true).all(axis=1, keepdims=True)
    return np.where(seen, rows, [inf, nan])


def beam_angles(count: int, field_of_view: float) -> Float:
    """Return the bearings (count,) of evenly spaced beams, from -field_of_view / 2 on [rad].

    Both ends are included, except over a full circle, where the last would be the first again. A
    single beam points ahead. The array is read-only.
    """
    full = field_of_view >= 2 * pi
    angles = np.linspace(-field_of_view / 2, field_of_view / 2, count, endpoint=not full)
    if count == 1:
        angles = np.zeros(1)
    angles.flags.writeable = False
    return angles


def draw_sighted(scene: Scene, pose: Float, rows: ArrayLike, color: str) -> None:
    """Draw lines from a sensor's pose (3,) to the points at ranges and bearings (k, 2)."""
    x, y, theta = pose.tolist()
    for distance, bearing in np.asarray(rows, dtype=float).reshape(-1, 2).tolist():
        if isfinite(distance + bearing):
            angle = theta + bearing
            there = (x + distance * cos(angle), y + distance * sin(angle))
            scene.line([(x, y), there], stroke=faded(color, 0.7), width=1.0)
            scene.circle(there, 0.0, fill="#ffffff", stroke=color, width=1.2, pixels=3.0)
