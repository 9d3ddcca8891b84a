"""Curves as points: cubic Bezier curves, and the elliptic arcs that they stand for."""

from __future__ import annotations

from math import acos, atan, ceil, cos, hypot, pi, sin, sqrt, tan

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]

MOST = 20_000
"""The most points on one curve."""

ROUGH = 1e-6
"""How exact the control points of an arc are, as a share of its chord."""


def cubic(controls: Float, within: float, *, arcs: bool = False) -> Float:
    """Return points (k, 2) along a cubic Bezier curve, without its first one.

    controls: (4, 2). within: the largest distance between the curve and the polyline through the
    points, in the unit of `controls`. arcs: the curve stands for an arc of an ellipse, of at most
    90 degrees, if it looks like one; drawing libraries turn arcs into such curves, which are up to
    0.00027 radii off. Then the points lie on the arc.
    """
    if arcs:
        arc = _arc(controls, within)
        if arc is not None:
            return arc
    a, b, c, d = controls
    bend = max(np.linalg.norm(a - 2 * b + c), np.linalg.norm(b - 2 * c + d))
    t = _places(sqrt(0.75 * bend / within))[:, None]  # |B''| <= 6 bend; off by |B''| / 8 / n^2
    s = 1 - t
    points: Float = s**3 * a + 3 * s**2 * t * b + 3 * s * t**2 * c + t**3 * d
    return points


def _places(count: float) -> Float:
    """Return the parameters of `count` points after the first, the last one 1."""
    number = max(1, ceil(min(count, MOST)))
    return np.arange(1, number + 1) / number


def _arc(controls: Float, within: float) -> Float | None:
    """Return points along the elliptic arc that a cubic curve stands for; None if it is none.

    With the half axes u, v of the ellipse, which begins at u and turns by an angle q, and
    k = 4/3 tan(q/4): the first arm is k v, the last one k (v cos q - u sin q), and their sum is
    2/3 (1 - tan(q/4)^2) times the chord.
    """
    first, last = controls[1] - controls[0], controls[3] - controls[2]
    chord = controls[3] - controls[0]
    long = float(chord @ chord)
    if not long:
        return None
    share = float((first + last) @ chord) / long
    turned = first[0] * last[1] - first[1] * last[0]
    off = first + last - share * chord
    if not (0.55228 < share < 2 / 3 - 1e-9) or hypot(*off) > ROUGH * sqrt(long) or not turned:
        return None
    angle = 4 * atan(sqrt(1 - 1.5 * share))
    v = first / (4 / 3 * tan(angle / 4))
    u = (v * sin(angle) - chord) / (1 - cos(angle))
    radius = float(np.linalg.norm([u, v], 2))  # the larger half axis
    step = 2 * acos(1 - within / radius) if within < radius else pi
    turns = angle * _places(angle / step)[:, None]
    points: Float = controls[0] + u * (np.cos(turns) - 1) + v * np.sin(turns)
    points[-1] = controls[3]
    return points
