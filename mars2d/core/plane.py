"""Plane geometry, in numpy alone.

Lengths in metres, angles in radians, counter-clockwise from +x.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import floor, log10
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.arithmetic import angles_of, norms

Float = NDArray[np.float64]
Point = tuple[float, float]
Outline = Sequence[Point]

ON_THE_EDGE = 1e-9
"""A point at most this far from a polygon's boundary lies on it, metres."""

WITHIN = 1 + 1e-9
"""What exceeds a range or an angle of view by no more than this factor is still within it."""


def wrap(angle: ArrayLike) -> Float:
    """Return the angle(s) in (-pi, pi].

    >>> float(wrap(3 * np.pi))
    3.141592653589793
    """
    turned = (np.pi - np.asarray(angle, dtype=float)) % (2 * np.pi)
    return np.asarray(-(turned - np.pi) + 0.0)  # 0, not -0


def up_to(distance: Float, reach: ArrayLike) -> Float:
    """Return distances as sensors with a range read them: inf beyond it, but not exactly at it.

    >>> up_to(np.array([0.1, 0.1 * 3, 0.301]), 0.3).tolist()
    [0.1, 0.3, inf]
    """
    return np.where(distance <= np.multiply(WITHIN, reach), np.minimum(distance, reach), np.inf)


def bounds_of(points: Sequence[Point] | Float) -> tuple[float, float, float, float]:
    """Return (xmin, xmax, ymin, ymax) of points (k, 2), in the order of MARS's Bounds."""
    xy = np.asarray(points, dtype=float)
    (xmin, ymin), (xmax, ymax) = xy.min(axis=0), xy.max(axis=0)
    return float(xmin), float(xmax), float(ymin), float(ymax)


def rectangle(xmin: float, xmax: float, ymin: float, ymax: float) -> Outline:
    """Return the corners of a rectangle, counter-clockwise.

    >>> rectangle(*bounds_of([(0, 3), (2, 1)]))
    ((0.0, 1.0), (2.0, 1.0), (2.0, 3.0), (0.0, 3.0))
    """
    return ((xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax))


def lines_and_areas(outlines: Sequence[Outline]) -> list[Any]:
    """Return outlines as geometries of shapely: a line for two vertices, else a polygon."""
    import shapely

    return [shapely.LineString(o) if len(o) == 2 else shapely.Polygon(o) for o in outlines]


def grid_step(wanted: float) -> float:
    """Return the smallest number >= `wanted` > 0 that is 1, 2 or 5 times a power of ten.

    >>> grid_step(0.3), grid_step(2.0), grid_step(7)
    (0.5, 2.0, 10.0)
    """
    power = 10.0 ** floor(log10(wanted))
    return next(k * power for k in (1, 2, 5, 10) if k * power >= wanted * (1 - 1e-9))


def _following(polygon: Float) -> Float:
    """Return the corner that follows each of a polygon (k, 2); several times as quick as roll."""
    return np.concatenate([polygon[1:], polygon[:1]])


def inside_polygon(x: Float, y: Float, polygon: Float) -> NDArray[np.bool_]:
    """Return which points (n,) lie inside a closed polygon (k, 2), by the crossing rule.

    The polygon need not be convex. A point exactly on the boundary may fall on either side.
    """
    x1, y1 = polygon.T
    x2, y2 = _following(polygon).T
    px, py = x[:, None], y[:, None]
    spans = (y1 > py) != (y2 > py)
    # The edge lies to the right of the point; multiplied out, so that no division can overflow.
    left_of_edge = (px - x1) * (y2 - y1) < (py - y1) * (x2 - x1)
    crosses = spans & (left_of_edge == (y2 > y1))
    return np.asarray(crosses.sum(axis=1) % 2 == 1)


def point_segment_distance(px: Float, py: Float, segments: Float) -> Float:
    """Return the distances from points to segments, metres.

    px, py: (...,) broadcast against segments (..., 4) = x1, y1, x2, y2.
    """
    x1, y1, x2, y2 = np.moveaxis(segments, -1, 0)
    ex, ey = x2 - x1, y2 - y1
    along = ((px - x1) * ex + (py - y1) * ey) / (ex * ex + ey * ey)
    along = np.minimum(np.maximum(along, 0.0), 1.0)
    return np.asarray(norms(px - x1 - along * ex, py - y1 - along * ey))


def edges_of(outline: Outline) -> list[tuple[Point, Point]]:
    """Return the edges of an outline: one for a wall (two vertices), else those of the ring."""
    if len(outline) == 2:
        return [(outline[0], outline[1])]
    return list(zip(outline, (*outline[1:], outline[0]), strict=True))


def distance_to_ring(x: Float, y: Float, polygon: Float) -> Float:
    """Return the distances of points (n,) to the boundary of a closed polygon (k, 2), metres."""
    edges = np.hstack([polygon, _following(polygon)])
    return np.asarray(point_segment_distance(x[:, None], y[:, None], edges).min(axis=1))


def is_clearly_convex(polygon: Float) -> bool:
    """Return whether a closed polygon (k, 2) is convex by more than rounding, and goes round once.

    Such a polygon has an area and can't cross itself.
    """
    edges = _following(polygon) - polygon
    after = _following(edges)
    turns = edges[:, 0] * after[:, 1] - edges[:, 1] * after[:, 0]
    if (np.abs(turns) < 1e-8).any() or np.ptp(np.sign(turns)) > 0:
        return False
    angles = angles_of(edges[:, 1], edges[:, 0])
    return bool(abs(wrap(_following(angles) - angles).sum()) < 3 * np.pi)


def outside_polygon(x: Float, y: Float, polygon: Float) -> NDArray[np.bool_]:
    """Return which points (n,) lie outside a closed polygon (k, 2); its boundary is inside."""
    outside = ~inside_polygon(x, y, polygon)
    if outside.any():
        gap = distance_to_ring(x[outside], y[outside], polygon)
        outside[outside] = gap > ON_THE_EDGE
    return outside
