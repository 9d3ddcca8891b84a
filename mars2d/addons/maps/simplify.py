"""Fewer corners: Douglas and Peucker's rule, piece by piece."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import shapely

__all__ = ["simple_area", "simple_line"]

Float = NDArray[np.float64]

PIECE = 500
"""Longer lines are cut: the library's function calls itself as deep as a line has corners."""

LOSS = 0.25
"""The share of its area that a simpler outline may win or lose."""

TRIALS = 3


def simple_line(points: Float, tolerance: float) -> Float:
    """Return points (k, 2) of a line with fewer corners, no more than `tolerance` metres off.

    Both ends stay, and every 500th corner of a long line. Source: Douglas and Peucker (1973).
    """
    import shapely

    if not tolerance or len(points) < 3:
        return points
    pieces = [points[k : k + PIECE + 1] for k in range(0, len(points) - 1, PIECE)]
    lines = [shapely.LineString(piece) for piece in pieces]
    simple = shapely.simplify(lines, tolerance, preserve_topology=False)
    found = [shapely.get_coordinates(line) for line in simple.tolist()]
    return np.concatenate([*(piece[:-1] for piece in found[:-1]), found[-1]])


def simple_area(area: shapely.Polygon, tolerance: float) -> shapely.Polygon:
    """Return a polygon with fewer corners, no more than `tolerance` metres off.

    Where it would cross itself, or lose its shape, a smaller tolerance is tried, and at last it
    stays as it is.
    """
    import shapely

    rings = [shapely.get_coordinates(ring) for ring in shapely.get_rings(area)]
    for trial in range(TRIALS):
        within = tolerance / 2**trial
        shell, *holes = (simple_line(ring, within) for ring in rings)
        if len(shell) < 4 or any(len(hole) < 4 for hole in holes):
            continue
        found = shapely.Polygon(shell, holes)
        if found.is_valid and abs(found.area / area.area - 1) <= LOSS:
            return found
    return area
