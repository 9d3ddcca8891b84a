"""Arrows, dashes and marks along lines, the same in windows, figures and pages."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arithmetic import norm

Float = NDArray[np.float64]

# Lengths on, off, on, off ... in points.
DASHES: dict[str, tuple[float, ...]] = {
    "--": (9.0, 6.0),
    ":": (2.0, 4.5),
    "-.": (9.0, 5.0, 2.0, 5.0),
}

MARK_SPACING = 9.0
"""Marks nearer than this to the one before, in points along the path, are left out."""

TEXT_GAP = 4.0
"""The room between a label and the point it names, points."""

SHIFTS = {"left": (1, 0), "right": (-1, 0), "above": (0, 1), "below": (0, -1)}
"""Where a label lies, by its anchor: "left" puts its left end at the point, as in Matlab."""

HEAD_LENGTH, HEAD_WIDTH = 4.0, 3.4
"""Length and width of an arrow's head, in widths of its shaft."""

MIN_ARROW_LENGTH = 1.6
"""Shorter arrows are drawn smaller as a whole, in lengths of their head."""


def arrow_outline(
    tail: tuple[float, float], tip: tuple[float, float], width: float
) -> NDArray[np.float64]:
    """Return the corners (7, 2) of an arrow whose shaft is `width` wide, all in one unit."""
    dx, dy = tip[0] - tail[0], tip[1] - tail[1]
    length = float(norm(dx, dy))
    if length == 0.0:
        return np.tile(np.array([tail], dtype=float), (7, 1))
    width = min(width, length / (MIN_ARROW_LENGTH * HEAD_LENGTH))
    axes = np.array([[dx, dy], [-dy, dx]]) / length
    neck = length - HEAD_LENGTH * width
    half, head = width / 2, HEAD_WIDTH * width / 2
    corners = [(0, half), (neck, half), (neck, head), (length, 0)]
    corners += [(along, -across) for along, across in corners[2::-1]]
    return np.array(corners) @ axes + tail


def arc_length(points: Float) -> Float:
    """Return the length along a polyline (k, 2) up to each of its points, (k,)."""
    if len(points) < 2:
        return np.zeros(len(points))
    steps = np.hypot(*np.diff(points, axis=0).T)
    return np.concatenate([[0.0], np.cumsum(steps)])


def spaced(points: Float, spacing: float) -> NDArray[np.intp]:
    """Return the indices of points (k, 2) of a path at distances of about `spacing` along it."""
    return np.unique(np.floor(arc_length(points) / spacing), return_index=True)[1]
