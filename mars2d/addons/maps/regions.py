"""Areas from rings of points, and lines and areas with fewer corners."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import shapely

Float = NDArray[np.float64]

GRID = 1e-5
"""The step to which corners are rounded, metres."""

MAX_LINE = 500
"""The most corners of a line that is simplified as one: the library recurses as deep as that."""

LOSS = 0.25
"""The share of its area that a simpler outline may gain or lose."""

TRIALS = 3
"""The number of tolerances that are tried, each half of the one before."""


def region(rings: Sequence[Float], *, even_odd: bool = False) -> list[shapely.Polygon]:
    """Return the area that rings (k, 2) of points [m] fill, as polygons, with their holes.

    even_odd: a point lies inside if it is surrounded an odd number of times; else, as in drawing
    programs, if it is surrounded more often in one sense than in the other.
    """
    import shapely

    edges = [shapely.LinearRing(ring) for ring in rings if len(np.unique(ring, axis=0)) > 2]
    if not edges:
        return []
    if len(edges) == 1:
        whole = shapely.Polygon(edges[0])
        if whole.is_valid:
            return [whole]
    cut = shapely.union_all([shapely.LineString(ring.coords) for ring in edges], grid_size=GRID)
    faces = shapely.get_parts(shapely.polygonize(shapely.get_parts(cut)))
    if not len(faces):
        return []
    middles = shapely.get_coordinates(shapely.point_on_surface(faces))
    points, ring = shapely.get_coordinates(edges, return_index=True)
    steps = np.stack([points[:-1], points[1:]], axis=1)[ring[1:] == ring[:-1]]
    turns = _turns(middles, steps)
    inside = turns % 2 != 0 if even_odd else turns != 0
    whole = shapely.coverage_union_all(faces[inside])  # faces meet edge to edge
    return [part for part in shapely.get_parts(whole).tolist() if part.geom_type == "Polygon"]


def joined(polygons: Sequence[shapely.Geometry]) -> list[shapely.Polygon]:
    """Return polygons that cover the same and do not overlap, corners rounded to GRID."""
    import shapely

    whole = shapely.set_precision(shapely.union_all(polygons), GRID)
    return [part for part in shapely.get_parts(whole).tolist() if part.geom_type == "Polygon"]


def simple_line(points: Float, tolerance: float) -> Float:
    """Return points (k, 2) of a line with fewer corners, no more than `tolerance` metres off.

    Both ends stay, and every 500th corner of a long line. Source: Douglas and Peucker (1973).
    """
    import shapely

    if not tolerance or len(points) < 3:
        return points
    pieces = [points[k : k + MAX_LINE + 1] for k in range(0, len(points) - 1, MAX_LINE)]
    lines = [shapely.LineString(piece) for piece in pieces]
    simple = shapely.simplify(lines, tolerance, preserve_topology=False)
    found = [shapely.get_coordinates(line) for line in simple.tolist()]
    return np.concatenate([*(piece[:-1] for piece in found[:-1]), found[-1]])


def simple_area(area: shapely.Polygon, tolerance: float) -> shapely.Polygon:
    """Return a polygon with fewer corners, no more than `tolerance` metres off.

    Where it would cross itself or lose its shape, smaller tolerances are tried; if none works, it
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


def _turns(points: Float, edges: Float) -> NDArray[np.int64]:
    """Return how many times closed rings go round points (n, 2), counter-clockwise, (n,).

    edges: (k, 2, 2) of all rings. They count where they cross the ray from a point to the right.
    """
    import shapely

    ends = np.column_stack([np.full(len(points), edges[..., 0].max() + 1.0), points[:, 1]])
    rays = shapely.linestrings(np.stack([points, ends], axis=1))
    tree = shapely.STRtree(shapely.linestrings(edges))
    turns = np.zeros(len(points), dtype=np.int64)
    ray, edge = tree.query(rays)
    (x, y), (x1, y1), (x2, y2) = points[ray].T, edges[edge, 0].T, edges[edge, 1].T
    left = (x2 - x1) * (y - y1) - (x - x1) * (y2 - y1)
    up, down = (y1 <= y) & (y2 > y) & (left > 0), (y1 > y) & (y2 <= y) & (left < 0)
    np.add.at(turns, ray, up.astype(np.int64) - down)
    return turns
