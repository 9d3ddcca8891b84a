"""Areas from rings of points, and lines cut where they cross, within limits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError

if TYPE_CHECKING:
    import shapely

__all__ = ["GRID", "check_crossings", "joined", "region"]

Float = NDArray[np.float64]

GRID = 1e-5
"""Corners are rounded to this, metres."""

MOST_AREAS = 10_000
"""So many areas can be joined."""

MOST_CROSSINGS = 30_000
MOST_NEAR = 500_000
"""So many pairs of edges may cross, and may have boxes that overlap: to cut more takes for ever."""

AT_ONCE = 2_000_000
"""So many answers are looked at together."""


def region(name: str, rings: Sequence[Float], *, even_odd: bool = False) -> list[shapely.Polygon]:
    """Return the area that rings (k, 2) of points [m] fill, as polygons, with their holes.

    even_odd: a point lies inside if it is surrounded an odd number of times; else if it is
    surrounded more often in one sense than in the other, as drawing programs have it.
    """
    import shapely

    edges = [shapely.LinearRing(ring) for ring in rings if len(np.unique(ring, axis=0)) > 2]
    if not edges:
        return []
    if len(edges) == 1:
        whole = shapely.Polygon(edges[0])
        if whole.is_valid:
            return [whole]
    check_crossings(name, edges)
    cut = shapely.union_all([shapely.LineString(ring.coords) for ring in edges], grid_size=GRID)
    faces = shapely.get_parts(shapely.polygonize(shapely.get_parts(cut)))
    if not len(faces):
        return []
    middles = shapely.get_coordinates(shapely.point_on_surface(faces))
    turns = _turns(name, middles, _edges(edges))
    inside = turns % 2 != 0 if even_odd else turns != 0
    whole = shapely.coverage_union_all(faces[inside])  # faces meet edge to edge
    return [part for part in shapely.get_parts(whole).tolist() if part.geom_type == "Polygon"]


def joined(name: str, polygons: Sequence[shapely.Geometry]) -> list[shapely.Polygon]:
    """Return polygons that cover the same and do not overlap, corners rounded to GRID."""
    import shapely

    if not polygons:
        return []
    if len(polygons) > MOST_AREAS:
        raise InputError(f"{name}: {len(polygons)} areas; expected at most {MOST_AREAS}")
    check_crossings(name, polygons)
    whole = shapely.set_precision(shapely.union_all(polygons), GRID)
    parts = shapely.get_parts(whole).tolist()
    return [part for part in parts if part.geom_type == "Polygon"]


def check_crossings(name: str, geometries: Sequence[shapely.Geometry]) -> None:
    """Refuse what crosses itself so often that nobody drew it. Raises InputError."""
    import shapely

    edges = shapely.linestrings(_edges(geometries))
    tree = shapely.STRtree(edges)
    at_once = max(16, AT_ONCE // max(len(edges), 1))
    near = crossing = 0
    for first in range(0, len(edges), at_once):
        some = edges[first : first + at_once]
        near += tree.query(some).shape[1]
        if near < MOST_NEAR + 16 * len(edges):
            crossing += tree.query(some, "crosses").shape[1] // 2
        if near > MOST_NEAR + 16 * len(edges) or crossing > MOST_CROSSINGS:
            raise InputError(f"{name}: its lines cross each other too many times")


def _edges(geometries: Sequence[shapely.Geometry]) -> Float:
    """Return all edges of lines and polygons, (k, 2, 2)."""
    import shapely

    parts = shapely.get_parts(geometries)
    areal = shapely.get_dimensions(parts) == 2
    lines = np.concatenate([shapely.get_rings(parts[areal]), parts[~areal]])
    points, line = shapely.get_coordinates(lines, return_index=True)
    same = line[1:] == line[:-1]
    return np.stack([points[:-1][same], points[1:][same]], axis=1)


def _turns(name: str, points: Float, edges: Float) -> NDArray[np.int64]:
    """Return how many times closed rings go round points (n, 2), counter-clockwise, (n,).

    edges: (k, 2, 2) of all rings. They count where they cross the ray from a point to the right.
    """
    import shapely

    ends = np.column_stack([np.full(len(points), edges[..., 0].max() + 1.0), points[:, 1]])
    rays = shapely.linestrings(np.stack([points, ends], axis=1))
    tree = shapely.STRtree(shapely.linestrings(edges))
    turns = np.zeros(len(points), dtype=np.int64)
    at_once = max(16, AT_ONCE // len(edges))
    met = 0
    for first in range(0, len(points), at_once):
        ray, edge = tree.query(rays[first : first + at_once])
        met += len(ray)
        if met > 10 * AT_ONCE:
            raise InputError(f"{name}: an area of too many parts within parts")
        (x, y), (x1, y1), (x2, y2) = points[first + ray].T, edges[edge, 0].T, edges[edge, 1].T
        left = (x2 - x1) * (y - y1) - (x - x1) * (y2 - y1)
        up, down = (y1 <= y) & (y2 > y) & (left > 0), (y1 > y) & (y2 <= y) & (left < 0)
        np.add.at(turns, first + ray, up.astype(np.int64) - down)
    return turns
