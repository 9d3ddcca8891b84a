"""Range and bearing of points as seen from a pose."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import inf, isfinite, nan, pi
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.arithmetic import angles_of, cosine_sine, norms
from mars2d.core.plane import WITHIN, up_to, wrap
from mars2d.core.quantity import Quantity
from mars2d.core.scene import Scene, faded

Float = NDArray[np.float64]

RANGE = Quantity("range", "m", "distance")
BEARING = Quantity("bearing", "rad", "angle")


def sighted(
    poses: Float,
    points: Float,
    reach: float,
    field_of_view: float,
    bodies: NDArray[np.int64] | None = None,
    robots: Sequence[int] = (),
    sight: Any = None,
) -> Float:
    """Return rows of range [m] and bearing [rad] of points (k, 2) as seen from poses (3, m).

    The result is (m, k, 2). A point that is not seen has the row (inf, nan). reach: the largest
    range, metres. field_of_view: the angle seen about the heading, radians. bodies: (k,), the body
    to which each point belongs. robots: (m,), the one that looks from each pose; it does not see
    its own points. sight: `Surroundings`, which tell who is hidden; None: nobody.
    """
    rows = np.empty((poses.shape[1], len(points), 2))
    rows[..., 0], rows[..., 1] = inf, nan
    x, y, theta = poses
    across, upwards = points[:, 0] - x[:, None], points[:, 1] - y[:, None]
    # In a crowd, most points are outside the square about the circle that is seen.
    larger = np.maximum(np.abs(across), np.abs(upwards))
    around = larger <= WITHIN * reach
    if bodies is not None:
        around &= bodies != np.array(robots)[:, None]
    who, what = np.nonzero(around)
    dx, dy = across[who, what], upwards[who, what]
    apart = up_to(norms(dx, dy), reach)
    bearings = wrap(angles_of(dy, dx) - theta[who])
    seen = apart <= reach
    if field_of_view < 2 * pi:
        seen &= np.abs(bearings) <= WITHIN * field_of_view / 2
    who, what, apart, bearings = who[seen], what[seen], apart[seen], bearings[seen]
    if sight is not None and bodies is not None:
        seen = _not_hidden(poses, points, bodies, robots, sight, who, what)
        who, what, apart, bearings = who[seen], what[seen], apart[seen], bearings[seen]
    rows[who, what, 0], rows[who, what, 1] = apart, bearings
    return rows


def _not_hidden(
    poses: Float,
    points: Float,
    bodies: NDArray[np.int64],
    robots: Sequence[int],
    sight: Any,
    who: NDArray[np.intp],
    what: NDArray[np.intp],
) -> NDArray[np.bool_]:
    """Return whether nothing is between poses who (j,), which ascend, and points what (j,)."""
    seen = np.empty(len(who), dtype=bool)
    parts = pairwise(np.searchsorted(who, np.arange(len(robots) + 1)).tolist())
    for robot, (x, y, _), (first, last) in zip(robots, poses.T.tolist(), parts, strict=True):
        if first < last:
            there = what[first:last]
            seen[first:last] = ~sight.hidden((x, y), points[there], bodies[there], robot)
    return seen


def hold_missing(rows: Float, true: Float) -> Float:
    """Return measured rows (..., 2) of range and bearing, with both missing if either is.

    true: the perfect rows. A point that was not seen stays missing, despite noise and outliers.
    """
    seen = np.isfinite(rows + true).all(axis=-1, keepdims=True)
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
            c, s = cosine_sine(angle)
            there = (x + distance * c, y + distance * s)
            scene.line([(x, y), there], stroke=faded(color, 0.7), width=1.0)
            scene.circle(there, 0.0, fill="#ffffff", stroke=color, width=1.2, pixels=3.0)
