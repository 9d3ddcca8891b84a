"""A region divided among points: the cells, their edges, and their plain moments."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property, lru_cache
from math import frexp, ldexp
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core import checks
from mars2d.core.plane import Outline, Point

Float = NDArray[np.float64]
Index = NDArray[np.intp]
Segment = tuple[Point, Point]
Moments = tuple[Float, Float, Float]
"""The moments of cells about their points: masses (n,), first (2, n), second (n,)."""

SAME_PLACE = 1e-9
"""Points nearer than this are at the same place, relative to the size of region and points."""

FAR_POINTS = 8.0
"""The distance of four points that bound the outer cells, in sizes of region and points."""

POLYGON, POLYGONS = 3, 6
"""shapely's type numbers of polygons and multipolygons."""

KEPT = 2
"""The number of partitions that are kept for whoever asks again: those before and after a step."""


def partition(points: Float, region: Outline) -> Partition:
    """Return a region divided among points (2, n); for the same points again, the same object.

    So a law, a drawing and a check that look at one instant share its cells. Raises InputError for
    a region that is none.
    """
    try:
        hash(region)
    except TypeError:  # a list or array
        region = checks.outline("Tessellation.region", region, least=3)
    return _partition(points.tobytes(), region)


@lru_cache(maxsize=KEPT)
def _partition(points: bytes, region: Outline) -> Partition:
    return Partition(np.frombuffer(points).reshape(2, -1), _prepared(region))


@lru_cache(maxsize=16)
def _prepared(region: Outline) -> Any:
    """Return the polygon of an outline, prepared for many queries."""
    import shapely

    polygon = shapely.Polygon(checks.outline("Tessellation.region", region, least=3))
    shapely.prepare(polygon)
    return polygon


class Partition:
    """A region divided among points: the part that does not depend on a density.

    points: (2, n) metres. region: a polygon of shapely. Everything is computed once, when it is
    first asked for; all arrays are read-only. See `mars2d.geometry.Tessellation`.
    """

    def __init__(self, points: Float, region: Any) -> None:
        self.points, self.region = points, region

    @cached_property
    def cells(self) -> NDArray[Any]:
        """The cell of each point (n,), a polygon of shapely, perhaps empty or in several pieces."""
        import shapely

        rings = [self._diagram.regions[r] for r in self._diagram.point_region]
        rings = rings[: len(self._distinct)]  # those of the points far away reach to infinity
        lengths = [len(ring) for ring in rings]
        of_ring = np.repeat(np.arange(len(rings)), lengths)
        corners = self._corners[np.concatenate(rings).astype(int)]
        whole = shapely.polygons(shapely.linearrings(corners, indices=of_ring))
        cells = np.full(self.points.shape[1], shapely.Polygon(), dtype=object)
        cells[self._distinct] = _areas_only(_within(self.region, whole))
        return unwritable(cells)

    @cached_property
    def pieces(self) -> tuple[NDArray[Any], Index]:
        """The polygons (k,) of all cells, and the point to which each belongs (k,)."""
        import shapely

        pieces, owner = shapely.get_parts(self.cells, return_index=True)
        return pieces, owner

    @cached_property
    def edges(self) -> dict[tuple[int, int], tuple[Segment, ...]]:
        """All edges shared by two cells i < j within the region, in pieces, the longest first."""
        import shapely

        pairs, ends = self._diagram.ridge_points, np.array(self._diagram.ridge_vertices)
        own = (pairs < len(self._distinct)).all(axis=1)
        pairs = np.sort(self._distinct[pairs[own]], axis=1)
        inside = _within(self.region, shapely.linestrings(self._corners[ends[own]]))
        pieces, whose = shapely.get_parts(inside, return_index=True)
        length = shapely.length(pieces)  # 0 for points, where an edge only touches the region
        long = np.flatnonzero(length > SAME_PLACE * self._frame[1])
        long = long[np.argsort(-length[long], kind="stable")]
        first, last = (
            shapely.get_coordinates(shapely.get_point(pieces[long], k)).tolist() for k in (0, -1)
        )
        found: dict[tuple[int, int], tuple[Segment, ...]] = {}
        for (i, j), a, b in zip(pairs[whose[long]].tolist(), first, last, strict=True):
            found[i, j] = (*found.get((i, j), ()), ((a[0], a[1]), (b[0], b[1])))
        return found

    @cached_property
    def neighbours(self) -> list[tuple[int, ...]]:
        """The points whose cells share an edge with that of each point."""
        beside: list[list[int]] = [[] for _ in self.points.T]
        for i, j in sorted(self.edges):
            beside[i].append(j)
            beside[j].append(i)
        return [tuple(sorted(those)) for those in beside]

    @cached_property
    def moments(self) -> Moments:
        """The moments without a density: exact sums over all sides, by Green's theorem."""
        import shapely

        pieces, owner = self.pieces
        corners, piece = shapely.get_coordinates(pieces, return_index=True)
        of = owner[piece]
        x, y = corners.T - self.points[:, of]
        side = np.flatnonzero(piece[1:] == piece[:-1])  # rings are closed
        ax, ay, bx, by = x[side], y[side], x[side + 1], y[side + 1]
        cross = ax * by - bx * ay
        sign = np.sign(np.bincount(piece[side], cross, len(pieces)))
        cross *= sign[piece[side]]  # rings may be clockwise
        square = ax * ax + ax * bx + bx * bx + ay * ay + ay * by + by * by
        sums = (cross / 2, cross * (ax + bx) / 6, cross * (ay + by) / 6, cross * square / 12)
        return totals(of[side], sums, self.points.shape[1])

    # -- how they are found --------------------------------------------------------------------

    @cached_property
    def _frame(self) -> tuple[Float, float]:
        """The middle (2,) and the size of region and points, a power of 2; metres."""
        xmin, ymin, xmax, ymax = self.region.bounds
        low = np.minimum(self.points.min(axis=1), [xmin, ymin])
        high = np.maximum(self.points.max(axis=1), [xmax, ymax])
        return (low + high) / 2, ldexp(1.0, frexp(float((high - low).max()))[1])

    @cached_property
    def _distinct(self) -> Index:
        """The points without those at the same place as an earlier one."""
        from scipy.spatial import KDTree

        radius = SAME_PLACE * self._frame[1]
        pairs = KDTree(self.points.T).query_pairs(radius, output_type="ndarray")
        again = np.zeros(self.points.shape[1], dtype=bool)
        again[pairs.max(axis=1)] = True
        return np.flatnonzero(~again)

    @cached_property
    def _diagram(self) -> Any:
        """The diagram of the distinct points and of four points far away."""
        from scipy.spatial import Voronoi

        middle, size = self._frame
        near = (self.points[:, self._distinct].T - middle) / size
        far = FAR_POINTS * np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])
        return Voronoi(np.vstack([near, far]))

    @cached_property
    def _corners(self) -> Float:
        """The diagram's vertices (k, 2), metres."""
        middle, size = self._frame
        return np.asarray(self._diagram.vertices * size + middle)


def _within(region: Any, shapes: NDArray[Any]) -> NDArray[Any]:
    """Return the parts of cells or edges within a region; those inside of it stay as they are."""
    import shapely

    result = shapes.copy()
    across = np.flatnonzero(~shapely.contains_properly(region, shapes))
    result[across] = shapely.intersection(shapes[across], region)
    return result


def _areas_only(cells: NDArray[Any]) -> NDArray[Any]:
    """Return cells as polygons or multipolygons, or empty, without points and lines."""
    import shapely

    kinds = shapely.get_type_id(cells)
    for k in np.flatnonzero((kinds != POLYGON) & (kinds != POLYGONS)).tolist():
        parts = shapely.get_parts(cells[k])
        parts = parts[shapely.get_type_id(parts) == POLYGON]
        cells[k] = shapely.MultiPolygon(list(parts)) if len(parts) else shapely.Polygon()
    return cells


def totals(of: Index, moments: Sequence[Float], count: int) -> Moments:
    """Return the moments of `count` cells, the sums over their parts.

    of: the cell of each part. moments: those of the parts: mass, first along x and y, second.
    """
    mass, x, y, second = (np.bincount(of, each, count).astype(float) for each in moments)
    return unwritable(mass), unwritable(np.array([x, y])), unwritable(second)


def unwritable(array: NDArray[Any]) -> NDArray[Any]:
    """Return the array made read-only, since all who ask share it."""
    array.flags.writeable = False
    return array
