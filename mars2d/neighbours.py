"""Who is whose neighbour: everyone, those within range, the nearest, Voronoi's, a graph's."""

from __future__ import annotations

import numbers
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mars2d.description import Description, entry, integer, number, wrong
from mars2d.errors import InputError

__all__ = ["Everyone", "Graph", "Nearest", "Neighbourhood", "Voronoi", "Within"]

Float = NDArray[np.float64]
Neighbours = Sequence[Sequence[int]]


class Neighbourhood(Description):
    """The base of all rules that say who is whose neighbour: derive and write `of`."""

    fixed: ClassVar[bool] = False
    """Whether it gives the same at all positions, so that it is asked once."""

    def of(self, position: Float) -> Neighbours:
        """Return, for each robot, the indices of its neighbours in order.

        position: (2, n) of the robots now, metres.
        """
        raise NotImplementedError(f"{type(self).__name__} needs a method of(self, position)")

    def check_size(self, robots: int) -> None:
        """Raise InputError if the rule is for another number of robots."""


class Everyone(Neighbourhood):
    """All other robots are neighbours."""

    fixed = True

    def of(self, position: Float) -> Neighbours:
        """Return all but oneself."""
        return _Others(position.shape[1])


class _Others(Sequence[Sequence[int]]):
    """For each of n robots all others, listed when they are asked for: they are n^2 in all."""

    def __init__(self, n: int) -> None:
        self._n = n
        self._listed: dict[int, Sequence[int]] = {}

    def __len__(self) -> int:
        return self._n

    def __getitem__(self, i: Any) -> Any:
        if i not in self._listed:
            self._listed[i] = (*range(i), *range(i + 1, self._n))
        return self._listed[i]


class Within(Neighbourhood):
    """Those whose poses lie within a range [m]: the disc graph."""

    range: float = number(above=0, high=1e6, unit="m", kw_only=False, doc="the largest distance")

    def of(self, position: Float) -> Neighbours:
        """Return those within range, the bound included."""
        from scipy.spatial import cKDTree

        tree = cKDTree(position.T)
        found: Any = tree.query_ball_point(position.T, self.range, return_sorted=True)
        return [[j for j in near if j != i] for i, near in enumerate(found)]


class Nearest(Neighbourhood):
    """The k nearest robots, nearest first; of those equally far the one of lower index."""

    count: int = integer(low=1, high=10_000, kw_only=False, doc="how many")

    def of(self, position: Float) -> Neighbours:
        """Return the nearest ones."""
        x, y = position
        n, k = len(x), min(self.count, len(x) - 1)
        result = []
        for i in range(n):
            apart = np.hypot(x - x[i], y - y[i])
            apart[i] = np.inf
            result.append(np.argsort(apart, kind="stable")[:k].tolist())
        return result


class Voronoi(Neighbourhood):
    """Those whose Voronoi cells share an edge with one's own: the edges of Delaunay's triangles.

    The cells are those of the whole plane. Robots on one line are neighbours in their order. Where
    more than three cells meet in a point, which of the opposite ones are neighbours is up to the
    triangulation.

    Source: de Berg et al., Computational Geometry (2008), chapters 7 and 9.
    """

    def of(self, position: Float) -> Neighbours:
        """Return the neighbours in Delaunay's triangulation."""
        n = position.shape[1]
        found: list[set[int]] = [set() for _ in range(n)]
        for i, j in _delaunay_edges(position):
            found[i].add(j)
            found[j].add(i)
        return [sorted(others) for others in found]


def _delaunay_edges(position: Float) -> list[tuple[int, int]]:
    from scipy.spatial import Delaunay, QhullError

    n = position.shape[1]
    if n < 3:
        return [(0, 1)] if n == 2 else []
    try:
        triangles = Delaunay(position.T)
    except QhullError:  # all on one line
        order = np.lexsort(position).tolist()
        return list(zip(order[:-1], order[1:], strict=True))
    pointers, neighbours = triangles.vertex_neighbor_vertices
    edges = [(i, int(j)) for i in range(n) for j in neighbours[pointers[i] : pointers[i + 1]]]
    # Robots in one place: all but one of them are left out of the triangles.
    return edges + [(int(i), int(k)) for i, _, k in triangles.coplanar]


class Graph(Neighbourhood):
    """A fixed graph: a networkx graph of 0 to n - 1, or an adjacency matrix (n, n).

    >>> Graph([[0, 1, 0], [1, 0, 1], [0, 1, 0]]).of(np.zeros((2, 3)))
    [[1], [0, 2], [1]]

    Row i of the matrix is not zero where robot i has a neighbour: whom it sees, and may hear. An
    edge of a directed graph goes from the robot that sees to the one that is seen.
    """

    fixed = True

    graph: Any = entry(check=lambda name, value: _adjacency(name, value), kw_only=False,
                       doc="an adjacency matrix (n, n), or a networkx graph of 0 to n - 1")  # fmt: skip

    def of(self, position: Float) -> Neighbours:  # noqa: ARG002
        """Return those that a robot has an edge to."""
        return [np.flatnonzero(row).tolist() for row in self.graph]

    def check_size(self, robots: int) -> None:
        """Raise InputError if the graph has another number of nodes than there are robots."""
        if len(self.graph) != robots:
            raise InputError(
                f"Scenario.neighbours: the graph has {len(self.graph)} nodes, and there are "
                f"{robots} robots: expected one node for each"
            )


def _adjacency(name: str, value: Any) -> tuple[tuple[int, ...], ...]:
    expected = "an adjacency matrix (n, n) of numbers, or a networkx graph of the nodes 0 to n - 1"
    if hasattr(value, "nodes") and hasattr(value, "is_directed"):
        return _of_networkx(name, value)
    try:
        matrix = np.asarray(value)
    except (TypeError, ValueError):
        raise wrong(name, value, expected) from None
    if matrix.dtype.kind not in "biuf" or matrix.ndim != 2:
        raise wrong(name, value, expected)
    n, columns = matrix.shape
    if n != columns or not np.isfinite(matrix).all():
        raise InputError(f"{name}: a matrix {n} x {columns}: expected {expected}")
    if np.diagonal(matrix).any():
        i = int(np.flatnonzero(np.diagonal(matrix))[0])
        raise InputError(f"{name}[{i}][{i}] = {matrix[i, i]:g}: no robot is its own neighbour")
    return tuple(tuple(row) for row in (matrix != 0).astype(int).tolist())


def _of_networkx(name: str, graph: Any) -> tuple[tuple[int, ...], ...]:
    nodes = list(graph.nodes)
    n = len(nodes)
    whole = all(isinstance(v, numbers.Integral) for v in nodes)
    if not whole or sorted(int(v) for v in nodes) != list(range(n)):
        raise InputError(
            f"{name}: its nodes are {nodes[:5]!r}...: expected 0 to {n - 1}, the robots' indices; "
            "networkx.convert_node_labels_to_integers makes them so"
        )
    matrix = np.zeros((n, n), dtype=int)
    for i, j in graph.edges():
        matrix[i, j] = 1
        if not graph.is_directed():
            matrix[j, i] = 1
    return _adjacency(name, matrix)
