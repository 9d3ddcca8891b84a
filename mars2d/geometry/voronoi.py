"""Voronoi cells of points within a region, and integrals over them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property, lru_cache
from math import frexp, ldexp
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core import checks
from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError, shown
from mars2d.core.plane import Outline, Point
from mars2d.geometry.quadrature import nodes

__all__ = ["Tessellation", "Weight", "density_at"]

Float = NDArray[np.float64]
Index = NDArray[np.intp]
Phi = Callable[[Float, Float], ArrayLike]
Segment = tuple[Point, Point]

SAME_PLACE = 1e-9
"""Points nearer than this are at the same place, relative to the size of region and points."""

FAR_POINTS = 8.0
"""The distance of four points that bound the outer cells, in sizes of region and points."""

DEFAULT_DIVISIONS = 12
"""The default resolution of the quadrature is the region's longer side divided by this."""


class Weight:
    """A density: the base of add-ons that weight Voronoi cells."""

    def of(self, points: Float) -> Float:
        """Return the density (k,) >= 0 at points (2, k) [m]."""
        raise NotImplementedError


class Tessellation:
    """The Voronoi cells of n points in a region: a cell is the part nearest to its point.

    >>> halves = Tessellation([[1, 3], [1, 1]], [(0, 0), (4, 0), (4, 2), (0, 2)])
    >>> halves.areas.tolist(), halves.edge(0, 1)
    ([4.0, 4.0], ((2.0, 0.0), (2.0, 2.0)))

    points: (2, n) metres. region: the vertices of a polygon, convex or not. density: a function
    phi(x, y) >= 0 of arrays (k,) that returns (k,), or a Weight, which weights everything except
    the areas; by default 1. resolution: metres, the largest side of the triangles over which a
    density is integrated; by default 1/12 of the region's longer side.

    Everything is computed once, when it is first asked for. Points may lie outside of the region; a
    point with an empty cell has area 0 and is its own centroid. Of several points at the same
    place, the first one has the cell. Raises InputError for invalid points or regions, and for a
    density that is negative, not finite or of the wrong shape. All arrays are read-only.
    """

    def __init__(
        self,
        points: ArrayLike,
        region: Outline,
        density: Phi | Weight | None = None,
        resolution: float | None = None,
    ) -> None:
        self.points = _points(points)
        self.region = region
        self.density = density
        self._polygon = _region(region)
        self._resolution = resolution
        if resolution is not None and real("Tessellation.resolution", resolution) <= 0:
            raise wrong("Tessellation.resolution", resolution, "metres > 0, or None")

    # -- the cells -----------------------------------------------------------------------------

    @cached_property
    def cells(self) -> tuple[Any, ...]:
        """The cell of each point, as a polygon of shapely, perhaps empty or in several pieces."""
        return tuple(self._cells)

    @cached_property
    def areas(self) -> Float:
        """The areas (n,) of the cells, m^2."""
        return self._plain_moments[0] if self.density is not None else self.masses

    @property
    def masses(self) -> Float:
        """The integrals (n,) of the density over the cells."""
        return self._moments[0]

    @cached_property
    def centroids(self) -> Float:
        """The weighted centroids (2, n) of the cells, m; for a cell without mass, its point."""
        mass, first, _ = self._moments
        return _unwritable(self.points + first / np.where(mass > 0, mass, 1.0))

    @cached_property
    def cost(self) -> float:
        """H = sum_i of the integral over cell i of |q - p_i|^2 phi(q) dq.

        Its gradient to p_i is 2 mass_i (p_i - centroid_i).
        Source: Cortes, Martinez, Karatas and Bullo, IEEE Trans. Rob. Autom. 20(2), 2004.
        """
        return float(sum(self._moments[2].tolist()))

    @property
    def gradient(self) -> Float:
        """The derivatives (2, n) of the cost by the coordinates of the points."""
        return np.asarray(2 * self.masses * (self.points - self.centroids))

    def neighbours(self, i: int) -> tuple[int, ...]:
        """Return the points whose cells share an edge with the cell of point i."""
        return self._neighbours[i]

    def edge(self, i: int, j: int) -> Segment | None:
        """Return the ends of the edge that two cells share within the region, or None.

        If the region cuts the edge into several pieces, return the longest one.
        """
        pieces = self.edges.get((min(i, j), max(i, j)), ())
        return pieces[0] if pieces else None

    @cached_property
    def edges(self) -> dict[tuple[int, int], tuple[Segment, ...]]:
        """All edges shared by two cells i < j within the region, in pieces, the longest first."""
        import shapely

        pairs, ends = self._diagram.ridge_points, np.array(self._diagram.ridge_vertices)
        own = (pairs < len(self._distinct)).all(axis=1)
        pairs = np.sort(self._distinct[pairs[own]], axis=1)
        lines = shapely.linestrings(self._corners[ends[own]])
        inside = shapely.intersection(lines, self._polygon)
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

    # -- how they are found --------------------------------------------------------------------

    @cached_property
    def _frame(self) -> tuple[Float, float]:
        """The middle (2,) and the size of region and points, a power of 2; metres."""
        xmin, ymin, xmax, ymax = self._polygon.bounds
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

    @cached_property
    def _cells(self) -> NDArray[Any]:
        import shapely

        rings = [self._diagram.regions[r] for r in self._diagram.point_region]
        rings = rings[: len(self._distinct)]  # those of the points far away reach to infinity
        lengths = [len(ring) for ring in rings]
        of_ring = np.repeat(np.arange(len(rings)), lengths)
        corners = self._corners[np.concatenate(rings).astype(int)]
        whole = shapely.polygons(shapely.linearrings(corners, indices=of_ring))
        cells = np.full(self.points.shape[1], shapely.Polygon(), dtype=object)
        cells[self._distinct] = _clipped(whole, self._polygon)
        return cells

    @cached_property
    def _neighbours(self) -> list[tuple[int, ...]]:
        beside: list[list[int]] = [[] for _ in self.points.T]
        for i, j in sorted(self.edges):
            beside[i].append(j)
            beside[j].append(i)
        return [tuple(sorted(those)) for those in beside]

    # -- integrals over them -------------------------------------------------------------------

    @cached_property
    def _pieces(self) -> tuple[NDArray[Any], Index]:
        """The polygons (k,) of all cells, and the point to which each belongs (k,)."""
        import shapely

        pieces, owner = shapely.get_parts(self._cells, return_index=True)
        return pieces, owner

    @cached_property
    def _moments(self) -> tuple[Float, Float, Float]:
        """The moments of the cells about their points: masses (n,), first (2, n), second (n,)."""
        return self._plain_moments if self.density is None else self._weighted_moments

    @cached_property
    def _plain_moments(self) -> tuple[Float, Float, Float]:
        """The moments without a density: exact sums over all sides, by Green's theorem."""
        import shapely

        n = self.points.shape[1]
        pieces, owner = self._pieces
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
        return _totals(of[side], sums, n)

    @cached_property
    def _weighted_moments(self) -> tuple[Float, Float, Float]:
        """The moments with a density: sums over the quadrature's points, with positive weights."""
        n = self.points.shape[1]
        points, areas, of = self._nodes
        mass = areas * self._phi(points)
        x, y = points - self.points[:, of]
        sums = (mass, mass * x, mass * y, mass * (x * x + y * y))
        return _totals(of, sums, n)

    @cached_property
    def _nodes(self) -> tuple[Float, Float, Index]:
        """The quadrature's points (2, k), their areas (k,), and the points of their cells (k,)."""
        xmin, ymin, xmax, ymax = self._polygon.bounds
        resolution = self._resolution or max(xmax - xmin, ymax - ymin) / DEFAULT_DIVISIONS
        pieces, owner = self._pieces
        points, areas, piece = nodes(pieces, resolution)
        return points, areas, owner[piece]

    def _phi(self, points: Float) -> Float:
        assert self.density is not None
        if isinstance(self.density, Weight):
            return self.density.of(points)
        return density_at("Tessellation.density", self.density, points)


def density_at(name: str, phi: Phi, points: Float) -> Float:
    """Return phi(x, y) at points (2, k) as an array (k,).

    Raises InputError, beginning with `name`, if it is negative, not finite or of another shape.
    """
    expected = f"{name}: expected of phi(x, y) an array of numbers >= 0, as many as x has"
    given = phi(*points.copy())
    found = np.asarray(given)
    if found.dtype.kind not in "biuf":
        raise InputError(f"{expected}; it returned {shown(given)}")
    if found.ndim == 0:
        found = np.full(points.shape[1], found)
    if found.shape != points.shape[1:]:
        raise InputError(f"{expected}, {points.shape[1:]}; it returned shape {found.shape}")
    bad = np.flatnonzero(~((found >= 0) & (found < np.inf)))
    if len(bad):
        x, y = points[:, bad[0]]
        raise InputError(f"{expected}; it is {found[bad[0]]:g} at ({x:.4g}, {y:.4g})")
    return found.astype(float)


def _points(points: ArrayLike) -> Float:
    expected = "points (2, n) in metres, n >= 1, all of them finite"
    try:
        found = np.array(points, dtype=float)
    except (TypeError, ValueError):
        raise wrong("Tessellation.points", points, expected) from None
    fits = found.ndim == 2 and found.shape[0] == 2 and found.shape[1] > 0
    if not fits or not np.isfinite(found).all() or np.abs(found).max() > checks.MAX_COORDINATE:
        raise wrong("Tessellation.points", points, expected)
    return _unwritable(found)


def _region(region: Outline) -> Any:
    """Return the polygon of an outline, prepared for many queries; the result is cached."""
    try:
        return _prepared(region)
    except TypeError:  # a list or array, which is not hashable
        return _prepared(checks.outline("Tessellation.region", region, least=3))


@lru_cache(maxsize=16)
def _prepared(region: Outline) -> Any:
    import shapely

    polygon = shapely.Polygon(checks.outline("Tessellation.region", region, least=3))
    shapely.prepare(polygon)
    return polygon


def _clipped(cells: NDArray[Any], region: Any) -> NDArray[Any]:
    """Return the parts of convex cells within a region: polygons or multipolygons, or empty."""
    import shapely

    result = cells.copy()
    across = np.flatnonzero(~shapely.contains_properly(region, cells))
    result[across] = shapely.intersection(cells[across], region)
    kinds = shapely.get_type_id(result)
    for k in np.flatnonzero((kinds != POLYGON) & (kinds != POLYGONS)).tolist():
        parts = shapely.get_parts(result[k])
        parts = parts[shapely.get_type_id(parts) == POLYGON]
        result[k] = shapely.MultiPolygon(list(parts)) if len(parts) else shapely.Polygon()
    return result


POLYGON, POLYGONS = 3, 6
"""shapely's type numbers of polygons and multipolygons."""


def _totals(of: Index, moments: Sequence[Float], count: int) -> tuple[Float, Float, Float]:
    """Return masses (count,), first moments (2, count) and second ones (count,) of all cells.

    of: the cell of each part. moments: those of the parts: mass, first along x and y, second.
    """
    mass, x, y, second = (np.bincount(of, each, count).astype(float) for each in moments)
    return _unwritable(mass), _unwritable(np.array([x, y])), _unwritable(second)


def _unwritable(array: Float) -> Float:
    """Return the array made read-only, since all laws share it."""
    array.flags.writeable = False
    return array
