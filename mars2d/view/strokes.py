"""Cut polylines into dashes; thin out marks: what MARS's wake styles need, in pixels."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["DASHES", "MARK_SPACING", "arc_length", "dashes"]

Float = NDArray[np.float64]

# Lengths on, off, on, off ... in multiples of a screen point.
DASHES: dict[str, tuple[float, ...]] = {
    "--": (9.0, 6.0),
    ":": (2.0, 4.5),
    "-.": (9.0, 5.0, 2.0, 5.0),
}
MARK_SPACING = 9.0
"""Marks nearer than this to the one before, in points along the path, are left out."""


def arc_length(points: Float) -> Float:
    """Return how far along a polyline (k, 2) each of its points lies, (k,), from 0."""
    if len(points) < 2:
        return np.zeros(len(points))
    steps = np.hypot(*np.diff(points, axis=0).T)
    return np.concatenate([[0.0], np.cumsum(steps)])


def dashes(points: Float, pattern: tuple[float, ...], start: float = 0.0) -> list[Float]:
    """Return the drawn pieces of a polyline (k, 2), each again a polyline.

    pattern: lengths on, off, on, off ... start: how far along the pattern the first point lies, so
    that a path which grows goes on where its dashes ended.
    """
    along = arc_length(points) + start
    total = float(along[-1]) if len(along) else 0.0
    if len(points) < 2 or total <= start:
        return []
    period = sum(pattern)
    first = np.floor(start / period)
    periods = np.arange(first, np.floor(total / period) + 1) * period
    if len(periods) > 20_000:  # far zoomed in on a long path: the dashes would take for ever
        return [points]
    pieces: list[Float] = []
    offset = 0.0
    for on, off in zip(pattern[::2], pattern[1::2], strict=True):
        for begin in (periods + offset).tolist():
            low, high = max(begin, start), min(begin + on, total)
            if high > low:
                inner = points[(along > low) & (along < high)]
                ends = [
                    [np.interp(at, along, points[:, 0]), np.interp(at, along, points[:, 1])]
                    for at in (low, high)
                ]
                pieces.append(np.vstack([ends[:1], inner, ends[1:]]))
        offset += on + off
    return pieces
