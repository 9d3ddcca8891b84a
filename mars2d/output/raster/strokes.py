"""Lines and outlines in pixels: clipped, dashed, simplified, and drawn anti-aliased."""

from __future__ import annotations

from math import ceil

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.output.lines import arc_length

Float = NDArray[np.float64]
Box = tuple[float, float, float, float]
"""xmin, ymin, xmax, ymax."""


def dashes(points: Float, pattern: tuple[float, ...]) -> list[Float]:
    """Return the drawn pieces of a polyline (k, 2), each again a polyline.

    pattern: lengths on, off, on, off ...
    """
    along = arc_length(points)
    total = float(along[-1]) if len(along) else 0.0
    if total <= 0:
        return []
    periods = np.arange(0.0, total, sum(pattern))
    if len(periods) > 20_000:  # zoomed in on a long path: dashes would take too long
        return [points]
    pieces: list[Float] = []
    offset = 0.0
    for on, off in zip(pattern[::2], pattern[1::2], strict=True):
        for low in (periods + offset).tolist():
            high = min(low + on, total)
            if high > low:
                inner = points[(along > low) & (along < high)]
                ends = [
                    [np.interp(at, along, points[:, 0]), np.interp(at, along, points[:, 1])]
                    for at in (low, high)
                ]
                pieces.append(np.vstack([ends[:1], inner, ends[1:]]))
        offset += on + off
    return pieces


def hairlines(surface: pygame.Surface, ink: tuple[int, ...], points: Float, width: float) -> None:
    """Draw an anti-aliased polyline (k, 2), quickly: hair lines side by side.

    On a surface with opacity that is filled with the ink's colour and no opacity, the opacity of
    the ink is kept where lines cross; elsewhere the ink is opaque. (pygame's own wide anti-aliased
    lines become thinner the nearer they are to a diagonal.)
    """
    steps = np.diff(points, axis=0)
    lengths = np.hypot(steps[:, 0], steps[:, 1])
    keep = lengths > 1e-9
    if not keep.any():
        return
    points = points[np.concatenate([[True], keep])]
    along = steps[keep] / lengths[keep, None]
    bends = np.concatenate([along[:1], (along[1:] + along[:-1]) / 2, along[-1:]])
    # Farther out where the line bends, so that its sides stay parallel: a mitre, at most doubled.
    bends /= np.maximum((bends**2).sum(axis=1), 0.25)[:, None]
    normals = np.column_stack([-bends[:, 1], bends[:, 0]])
    for shift in hair_shifts(width, normals):
        x, y = (points + shift).T.tolist()
        # Tuples of numbers, which the garbage collector untracks: thousands of lists slow it down.
        ends = list(zip(x, y, strict=True))
        if len(ends) == 2:  # pygame's line of several pieces differs from run to run for one piece
            pygame.draw.aaline(surface, ink, ends[0], ends[1])
        else:
            pygame.draw.aalines(surface, ink, False, ends)


def hair_shifts(width: float, normals: Float) -> list[Float]:
    """Return the sideways shifts of the hairlines that make up a line of `width` pixels.

    normals: (k, 2), perpendicular to the line at each point. Each shift is (k, 2) pixels.
    """
    count = max(1, ceil(width))
    if count == 1:
        return [np.zeros_like(normals)]
    # A hair line is one pixel wide along an axis, thus narrower where it is slanted.
    hair = np.abs(normals).max(axis=1, keepdims=True)
    reach = np.maximum(width - hair, 0) / 2 * normals
    return [(2 * k / (count - 1) - 1) * reach for k in range(count)]


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
    """Return the parts of a polyline (k, 2) within a box, each a polyline."""
    if len(points) < 2 or _inside(points, box):
        return [points]
    import shapely

    parts = shapely.get_parts(shapely.clip_by_rect(shapely.linestrings(points), *box))
    return [shapely.get_coordinates(part) for part in parts]


def _inside(points: Float, box: Box) -> bool:
    if len(points) == 0:
        return True
    low, high = points.min(axis=0), points.max(axis=0)
    return bool(low[0] >= box[0] and low[1] >= box[1] and high[0] <= box[2] and high[1] <= box[3])
