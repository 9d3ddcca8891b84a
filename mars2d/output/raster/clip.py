"""Cut shapes to what can be seen, so that far zoomed in they stay true and quick."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["clip_lines", "clip_polygon", "simplified"]

Float = NDArray[np.float64]
Box = tuple[float, float, float, float]
"""xmin, ymin, xmax, ymax."""


def clip_polygon(points: Float, box: Box) -> Float:
    """Return the part of a polygon (k, 2) within a box, (m, 2), perhaps with edges along the box.

    Source: Sutherland & Hodgman (1974).
    """
    if _inside(points, box):
        return points
    corners = points.tolist()
    for axis, limit, sign in ((0, box[0], 1), (1, box[1], 1), (0, box[2], -1), (1, box[3], -1)):
        kept: list[list[float]] = []
        for k, b in enumerate(corners):
            a = corners[k - 1]
            depth_a, depth_b = sign * (a[axis] - limit), sign * (b[axis] - limit)
            if (depth_a < 0) != (depth_b < 0):
                share = depth_a / (depth_a - depth_b)
                kept.append([a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])])
            if depth_b >= 0:
                kept.append(b)
        corners = kept
    return np.array(corners, dtype=float).reshape(-1, 2)


def clip_lines(points: Float, box: Box) -> list[Float]:
    """Return the parts of a polyline (k, 2) within a box, each a polyline.

    Source: Liang & Barsky (1984), for all segments at once.
    """
    if len(points) < 2 or _inside(points, box):
        return [points]
    start, delta = points[:-1], np.diff(points, axis=0)
    enter = np.zeros(len(start))
    leave = np.ones(len(start))
    with np.errstate(divide="ignore", invalid="ignore"):
        for axis in (0, 1):
            low = (box[axis] - start[:, axis]) / delta[:, axis]
            high = (box[axis + 2] - start[:, axis]) / delta[:, axis]
            # A segment along the box's side divides by zero: NaN where it lies on the side.
            enter = np.fmax(enter, np.fmin(low, high))
            leave = np.fmin(leave, np.fmax(low, high))
    pieces: list[Float] = []
    run: list[Float] = []
    for k in np.nonzero(enter <= leave)[0].tolist():
        a, b = start[k] + enter[k] * delta[k], start[k] + leave[k] * delta[k]
        if run and enter[k] == 0 and np.array_equal(run[-1], a):
            run.append(b)
        else:
            if run:
                pieces.append(np.array(run))
            run = [a, b]
    if run:
        pieces.append(np.array(run))
    return pieces


def simplified(points: Float, tolerance: float) -> Float:
    """Return a polygon (k, 2) without the corners that move its edge by no more than a tolerance.

    Source: Douglas & Peucker (1973).
    """
    import shapely

    line = shapely.simplify(shapely.linestrings(points), tolerance, preserve_topology=False)
    corners: Float = shapely.get_coordinates(line)
    return corners


def _inside(points: Float, box: Box) -> bool:
    if len(points) == 0:
        return True
    low, high = points.min(axis=0), points.max(axis=0)
    return bool(low[0] >= box[0] and low[1] >= box[1] and high[0] <= box[2] and high[1] <= box[3])
