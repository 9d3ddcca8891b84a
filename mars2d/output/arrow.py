"""The outline of an arrow, the same in windows, figures and pages."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arithmetic import norm

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
