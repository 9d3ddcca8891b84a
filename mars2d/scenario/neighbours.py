"""Neighbourhoods: everyone, robots within range, the nearest, Delaunay's, or a graph."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import pairwise
from operator import index
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arithmetic import norm, norms
from mars2d.core.checks import instance
from mars2d.core.description import Description, entry, integer, number, wrong
from mars2d.core.errors import InputError, LawError, counted, shown
from mars2d.core.plane import WITHIN

Float = NDArray[np.float64]
Neighbours = Sequence[Sequence[int]]
Edges = tuple[tuple[int, int], ...]

FLAT = 1e-9
"""A robot is on a line if it is off by less than this share of the line's length."""

MAX_SORTED = 64
"""Up to this many robots, sorting all is faster than searching for the near ones."""


class Neighbourhood(Description):
    """The base of all neighbourhoods, rules of who is whose neighbour: derive and write `of`.

    >>> class Ring(Neighbourhood):
    ...     def of(self, position):
    ...         n = position.shape[1]
    ...         return [[(i + 1) % n] for i in range(n)]
    >>> Ring().of(np.zeros((2, 3)))
    [[1], [2], [0]]

    The result of a user's `of` is checked: for each robot, a list of other robots' indices.
    """

    fixed: ClassVar[bool] = False
    """Whether it does not depend on positions, so that it is asked only once."""

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if "of" in vars(cls) and cls.__module__ != __name__:  # of the user's own
            cls.of = _checked(cls.of)  # type: ignore[method-assign, assignment]

    def of(self, position: Float) -> Neighbours:
        """Return, for each robot, the indices of its neighbours in order.

        position: (2, n) of the robots now, metres.
        """
        raise NotImplementedError(f"{type(self).__name__} needs a method of(self, position)")

    def check_size(self, robots: int) -> None:
        """Raise InputError if the rule is for another number of robots."""


def _checked(of: Callable[[Any, Float], Neighbours]) -> Callable[[Any, Float], Neighbours]:
    """Wrap a rule's `of` to return new lists, and raise LawError for results of no use."""

    @functools.wraps(of)
    def checked(self: Neighbourhood, position: Float) -> Neighbours:
        name, n = f"{type(self).__name__}.of(position)", position.shape[1]
        found = of(self, position)
        try:
            rows = [[index(j) for j in row] for row in found]
        except TypeError:
            expected = "expected for each robot a list of its neighbours' indices"
            raise LawError(f"{name} returned {shown(found)}: {expected}") from None
        if len(rows) != n:
            raise LawError(f"{name} returned {len(rows)} lists: expected {n}, one for each robot")
        known = {*range(n)}
        for i, row in enumerate(rows):
            if i in row or len(known.intersection(row)) < len(row):
                expected = f"expected other robots, each once, by their indices, 0 to {n - 1}"
                raise LawError(f"{name} for robot {i} lists {shown(row)}: {expected}")
        return rows

    return checked


class Everyone(Neighbourhood):
    """All other robots are neighbours."""

    fixed = True

    def of(self, position: Float) -> Neighbours:
        """Return all other robots."""
        robots = tuple(range(position.shape[1]))
        return [robots[:i] + robots[i + 1 :] for i in robots]


def within(dx: Float, dy: Float, distance: float) -> NDArray[np.bool_]:
    """Return which vectors (k,), (k,) [m] are no longer than a distance, the bound included."""
    return np.asarray(norms(dx, dy) <= WITHIN * distance)


class Within(Neighbourhood):
    """Robots whose poses lie within a range [m]: the disc graph."""

    range: float = number(above=0, high=1e6, unit="m", kw_only=False, doc="the largest distance")

    def of(self, position: Float) -> Neighbours:
        """Return the robots within range, the bound included, by index."""
        from scipy.spatial import cKDTree

        # The tree compares squares, which are rounded differently from distances.
        tree = cKDTree(position.T)
        pairs = tree.query_pairs(self.range * WITHIN * WITHIN, output_type="ndarray")
        dx, dy = position[:, pairs[:, 1]] - position[:, pairs[:, 0]]
        return _mutual(position.shape[1], pairs[within(dx, dy, self.range)].tolist())


def _mutual(robots: int, pairs: Iterable[tuple[int, int]]) -> Neighbours:
    """Return who is whose neighbour, where both of each pair are."""
    found: list[list[int]] = [[] for _ in range(robots)]
    for i, j in pairs:
        found[i].append(j)
        found[j].append(i)
    return [sorted({*others}) for others in found]


class Nearest(Neighbourhood):
    """The k nearest robots, nearest first; of robots equally far, the one of lower index."""

    count: int = integer(low=1, high=10_000, kw_only=False, doc="the number of neighbours")

    def of(self, position: Float) -> Neighbours:
        """Return the nearest robots; all others, if they are fewer."""
        x, y = position
        k = min(self.count, len(x) - 1)
        result = []
        for i, near in enumerate(_candidates(position, k)):
            apart = norms(x[near] - x[i], y[near] - y[i])
            apart[near == i] = np.inf
            result.append(near[np.argsort(apart, kind="stable")[:k]].tolist())
        return result


def _candidates(position: Float, k: int) -> Iterator[NDArray[np.int64]]:
    """Yield, for each robot, ordered indices that include itself and its k nearest robots.

    All robots as far away as the last of these are included, too.
    """
    n = position.shape[1]
    if n <= MAX_SORTED or 4 * k > n:
        yield from [np.arange(n)] * n
        return
    from scipy.spatial import cKDTree

    tree = cKDTree(position.T)
    far = np.asarray(tree.query(position.T, k=[k + 1])[0])[:, 0]  # the nearest is oneself
    # The tree compares squares, which are rounded differently from distances, and may be 0.
    reach = far * WITHIN + 1e-150
    for near in tree.query_ball_point(position.T, reach, return_sorted=True):
        yield np.array(near, dtype=np.int64)


class Delaunay(Neighbourhood):
    """Robots whose Voronoi cells share an edge with one's own: the edges of Delaunay's triangles.

    The cells are those of the whole plane, so robots at the rim have distant neighbours, too.
    Robots on one line are neighbours in their order, and robots that are all in one place in the
    order of their indices. Otherwise, of several robots in one place, all but one have only that
    one as neighbour. Where more than three cells meet in a point, the triangulation decides which
    opposite cells are neighbours.

    Source: de Berg et al., Computational Geometry (2008), chapters 7 and 9.
    """

    def of(self, position: Float) -> Neighbours:
        """Return the neighbours in Delaunay's triangulation, by index."""
        from scipy.spatial import Delaunay as Triangles

        x, y = position - position[:, :1]
        far = int(np.argmax(norms(x, y)))
        length = float(norm(x[far], y[far]))
        if np.abs(x * y[far] - y * x[far]).max() <= FLAT * length**2:  # all on one line
            order = np.argsort(x * x[far] + y * y[far], kind="stable").tolist()
            return _mutual(len(x), pairwise(order))
        triangles = Triangles(np.array([x, y]).T)
        # Robots in one place: all but one of them are left out of the triangles.
        same = [(i, k) for i, _, k in triangles.coplanar.tolist()]
        return _mutual(len(x), _without_flat(triangles, FLAT * length) + same)


def _without_flat(triangles: Any, least: float) -> list[tuple[int, int]]:
    """Return the edges of triangles, without the long sides of flat ones at the rim.

    By rounding, robots in a row get such triangles: their cells meet a million kilometres away.
    least: the smallest height of a triangle that is not flat, metres.
    """
    corners = np.array(triangles.simplices)  # (m, 3)
    sides = np.array([corners[:, [1, 2]], corners[:, [0, 2]], corners[:, [0, 1]]])  # opposite
    (x, y), m = triangles.points.T[:, sides], range(len(corners))
    lengths = norms(x[..., 1] - x[..., 0], y[..., 1] - y[..., 0])
    long = lengths.argmax(axis=0)
    ax, ay = triangles.points[corners[:, 0]].T
    area = (x[0, :, 0] - ax) * (y[0, :, 1] - ay) - (x[0, :, 1] - ax) * (y[0, :, 0] - ay)
    flat = np.abs(area) <= least * lengths[long, m]
    beyond = triangles.neighbors[m, long]  # -1 at the rim
    there = np.append(np.ones(len(corners), bool), False)
    while (rim := flat & there[:-1] & ~there[beyond]).any():
        there[:-1] &= ~rim
    gone = {tuple(sorted(edge)) for edge in sides[long, m][~there[:-1]].tolist()}
    return list({tuple(sorted(edge)) for edge in sides.reshape(-1, 2).tolist()} - gone)


EXPECTED = "an adjacency matrix (n, n) of numbers, or a pair (n, edges)"


def _edges(name: str, value: Any) -> tuple[int, Edges]:
    """Check a graph, and return the number of its nodes and its edges in order."""
    try:
        if len(value) == 2 and np.ndim(value[0]) == 0:
            nodes, edges = index(value[0]), [(index(i), index(j)) for i, j in value[1]]
        else:
            matrix = np.array(value, dtype=float)
            nodes, columns = matrix.shape
            edges = [(i, j) for i, j in np.argwhere(matrix).tolist()]
            nodes = nodes if nodes == columns and np.isfinite(matrix).all() else 0
    except (TypeError, ValueError):
        nodes = 0
    if nodes < 1:
        raise wrong(name, value, EXPECTED)
    for i, j in edges:
        if i == j or min(i, j) < 0 or max(i, j) >= nodes:
            raise wrong(f"{name}: edge", (i, j), f"two different robots, from 0 to {nodes - 1}")
    return nodes, tuple(sorted({*edges}))


class Graph(Neighbourhood):
    """A fixed graph: an adjacency matrix (n, n), or the edges.

    >>> Graph([[0, 1, 0], [1, 0, 1], [0, 1, 0]]).of(np.zeros((2, 3)))
    [[1], [0, 2], [1]]

    Entry (i, j) of the matrix is not zero where robot j is a neighbour of robot i, which sees it,
    and may talk to it. The other form is a pair (n, edges), each edge from the robot that sees to
    the one that is seen; as that it is kept.

    >>> Graph((3, [(0, 1), (2, 1)])).of(np.zeros((2, 3)))
    [[1], [], [1]]
    """

    fixed = True

    graph: Any = entry(check=_edges, kw_only=False, doc="the graph of neighbours")

    def of(self, position: Float) -> Neighbours:  # noqa: ARG002
        """Return those that a robot has an edge to, by their indices."""
        nodes, edges = self.graph
        found: list[list[int]] = [[] for _ in range(nodes)]
        for i, j in edges:
            found[i].append(j)
        return found

    def check_size(self, robots: int) -> None:
        """Raise InputError if the graph has another number of nodes than there are robots."""
        if self.graph[0] != robots:
            nodes, team = counted(self.graph[0], "node"), counted(robots, "robot")
            raise InputError(f"Scenario.neighbours: the graph has {nodes}, the team {team}")


def neighbourhood(name: str, value: object) -> object:
    """Check a rule of neighbours; for a graph, say how it becomes one."""
    if isinstance(value, (np.ndarray, list, tuple)):
        raise wrong(name, value, "a rule; write Graph(...) of a graph")
    return instance(Neighbourhood, "Within(2), Nearest(3), Delaunay() or Graph(...)")(name, value)
