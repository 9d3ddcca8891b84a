"""Grids of cells, occupied or not: images of maps, and the outlines of what is occupied."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError
from mars2d.core.picture import opened_image

if TYPE_CHECKING:
    import shapely

__all__ = ["IMAGES", "MOST_BYTES", "cells", "read_image"]

Mask = NDArray[np.bool_]
Gray = NDArray[np.float32]

IMAGES = {".png": "PNG", ".pgm": "PPM", ".jpg": "JPEG", ".jpeg": "JPEG"}
"""The suffixes of images, and what Pillow calls their formats."""

MOST_BYTES = 20_000_000
"""Of an image."""

MOST_CORNERS = 100_000
"""An image whose cells have more corners is noise, not a map."""


def read_image(name: str, path: Path) -> tuple[Gray, Mask]:
    """Return the brightness of an image's pixels from 0 to 255, and where they are transparent.

    Both are (rows, columns), the upper row first; colours count by the mean of their channels.
    Raises InputError, which begins with `name`.
    """
    with opened_image(name, path, IMAGES[path.suffix.lower()]) as image:
        if image.mode == "L":
            gray = np.asarray(image, dtype=np.float32)
            return gray, np.zeros(gray.shape, dtype=bool)
        pixels = np.asarray(image.convert("RGBA"))
    return pixels[..., :3].mean(axis=2, dtype=np.float32), pixels[..., 3] == 0


def cells(name: str, occupied: Mask) -> list[shapely.Polygon]:
    """Return the outlines of occupied cells (rows, columns), those that share an edge as one.

    A cell is a square of side 1, the lower left one at (0, 0). Raises InputError, which begins
    with `name`, for more corners than a map has.
    """
    import shapely

    rows, columns = occupied.shape
    inside = np.zeros((rows + 2, columns + 2), dtype=bool)
    inside[1:-1, 1:-1] = occupied[::-1]  # the lower row first
    across = inside[1:, 1:-1] != inside[:-1, 1:-1]  # edges along x: (rows + 1, columns)
    along = (inside[1:-1, 1:] != inside[1:-1, :-1]).T  # edges along y: (columns + 1, rows)
    corner = _ends(across) & _ends(along).T
    count = int(corner.sum())
    if count > MOST_CORNERS:
        raise InputError(
            f"{name}: the occupied cells have {count} corners, expected at most {MOST_CORNERS}: "
            "is it a map? smooth it, or make it coarser"
        )
    y, x1, x2 = _runs(across, corner)
    x, y1, y2 = _runs(along, corner.T)
    ends = np.vstack([np.column_stack([x1, y, x2, y]), np.column_stack([x, y1, x, y2])])
    lines = shapely.linestrings(ends.reshape(-1, 2, 2).astype(float))
    faces = shapely.get_parts(shapely.polygonize(lines))
    middle = np.floor(shapely.get_coordinates(shapely.point_on_surface(faces))).astype(int)
    column, row = middle.reshape(-1, 2).T
    chosen: list[shapely.Polygon] = faces[inside[row + 1, column + 1]].tolist()
    return chosen


def _ends(edges: Mask) -> Mask:
    """Return which points of each line an edge touches: (lines, edges + 1)."""
    points = np.zeros((edges.shape[0], edges.shape[1] + 1), dtype=bool)
    points[:, :-1] |= edges
    points[:, 1:] |= edges
    return points


def _runs(edges: Mask, corner: Mask) -> tuple[NDArray[np.int64], ...]:
    """Return where edges (lines, k) run straight on between corners: line, first and last point."""
    none = np.zeros((edges.shape[0], 1), dtype=bool)
    before = np.hstack([none, edges[:, :-1]])
    after = np.hstack([edges[:, 1:], none])
    line, first = np.nonzero(edges & (~before | corner[:, :-1]))
    _, last = np.nonzero(edges & (~after | corner[:, 1:]))
    return line, first, last + 1
