"""Voronoi cells of points within a region, and integrals over them."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core import checks
from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError, shown
from mars2d.core.plane import Outline
from mars2d.geometry.partition import Moments, Segment, partition, totals, unwritable
from mars2d.geometry.quadrature import nodes

Float = NDArray[np.float64]
Index = NDArray[np.intp]
Phi = Callable[[Float, Float], ArrayLike]

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

    Everything is computed once, when it is first asked for; and what does not depend on a density,
    once for all that are made of the same points and region. Points may lie outside of the region;
    a point with an empty cell has area 0 and is its own centroid. Of several points at the same
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
        self._partition = partition(self.points, region)
        self._resolution = resolution
        if resolution is not None and real("Tessellation.resolution", resolution) <= 0:
            raise wrong("Tessellation.resolution", resolution, "metres > 0, or None")

    # -- the cells -----------------------------------------------------------------------------

    @cached_property
    def cells(self) -> tuple[Any, ...]:
        """The cell of each point, as a polygon of shapely, perhaps empty or in several pieces."""
        return tuple(self._partition.cells)

    @property
    def areas(self) -> Float:
        """The areas (n,) of the cells, m^2."""
        return self._partition.moments[0]

    @property
    def masses(self) -> Float:
        """The integrals (n,) of the density over the cells."""
        return self._moments[0]

    @cached_property
    def centroids(self) -> Float:
        """The weighted centroids (2, n) of the cells, m; for a cell without mass, its point."""
        mass, first, _ = self._moments
        return unwritable(self.points + first / np.where(mass > 0, mass, 1.0))

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
        return self._partition.neighbours[i]

    def edge(self, i: int, j: int) -> Segment | None:
        """Return the ends of the edge that two cells share within the region, or None.

        If the region cuts the edge into several pieces, return the longest one.
        """
        pieces = self.edges.get((min(i, j), max(i, j)), ())
        return pieces[0] if pieces else None

    @property
    def edges(self) -> dict[tuple[int, int], tuple[Segment, ...]]:
        """All edges shared by two cells i < j within the region, in pieces, the longest first."""
        return self._partition.edges

    # -- integrals over them -------------------------------------------------------------------

    @cached_property
    def _moments(self) -> Moments:
        """The moments; with a density sums over the quadrature's points, with positive weights."""
        if self.density is None:
            return self._partition.moments
        points, areas, of = self._nodes
        mass = areas * self._phi(points)
        x, y = points - self.points[:, of]
        sums = (mass, mass * x, mass * y, mass * (x * x + y * y))
        return totals(of, sums, self.points.shape[1])

    @property
    def _nodes(self) -> tuple[Float, Float, Index]:
        """The quadrature's points (2, k), their areas (k,), and the points of their cells (k,)."""
        xmin, ymin, xmax, ymax = self._partition.region.bounds
        resolution = self._resolution or max(xmax - xmin, ymax - ymin) / DEFAULT_DIVISIONS
        pieces, owner = self._partition.pieces
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
    return unwritable(found)
