"""Walls: what bodies feel of obstacles, so that they trip over no seam.

A body that slides along a wall overlaps it a little. Where the next wall begins, or one ends at
the back of this, it would hit that one's end. So edges that go on in one line are one wall, common
edges of blocks that stand side by side are none, and a wall that ends at another ends a little
before it. Of walls that go on round a bend, the engine is told.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from math import hypot
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.core.plane import Point, edges_of
from mars2d.scenario.scenario import Obstacle

__all__ = ["Span", "Straight", "walls_of"]

Float = NDArray[np.float64]

FEW = 200
"""Up to how many ends of edges all are looked at."""

MEETS = 1e-6
"""How far edges may lie apart that are taken for one line, or for meeting, metres."""


class Span(NamedTuple):
    """Which obstacle a wall is of, in a part of its length: an index, and two shares of it."""

    obstacle: int
    start: float
    end: float


class Straight(NamedTuple):
    """A straight wall from a to b, its friction and restitution, and whose it is where.

    before, after: the other ends of walls that go on at a and at b, a and b where none do.
    """

    a: Point
    b: Point
    surface: tuple[float, float]
    spans: tuple[Span, ...]
    before: Point
    after: Point


class _Edge(NamedTuple):
    """An edge of an obstacle. solid: on which side that lies, 1 on the left; 0 if it is a wall."""

    a: Point
    b: Point
    surface: tuple[float, float]
    obstacle: int
    solid: int


@lru_cache(maxsize=16)
def walls_of(obstacles: tuple[Obstacle, ...], gap: float) -> tuple[Straight, ...]:
    """Return the walls of obstacles.

    gap: how far from another one a wall ends that meets its side, metres. Those of the last
    obstacles are kept: each new world of a study, and each change of a running one, asks for them.
    """
    edges = [edge for k, obstacle in enumerate(obstacles) for edge in _edges(obstacle, k)]
    if not edges:
        return ()
    return _linked(_cut_short(_joined(_without_common(edges)), gap))


def _edges(obstacle: Obstacle, number: int) -> Iterator[_Edge]:
    outline = obstacle.outline
    looks = float(obstacle.friction), float(obstacle.restitution)
    x, y = np.array(outline, dtype=float).T
    area = float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())
    solid = 0 if len(outline) == 2 else 1 if area > 0 else -1
    for (ax, ay), (bx, by) in edges_of(outline):
        yield _Edge((float(ax), float(ay)), (float(bx), float(by)), looks, number, solid)


# -- blocks side by side ----------------------------------------------------------------------


def _without_common(edges: list[_Edge]) -> list[_Edge]:
    """Return edges without those parts in which two solids touch each other from both sides."""
    hidden: dict[int, list[tuple[float, float]]] = {}
    for i, j in _meeting(edges):
        first, second = edges[i], edges[j]
        if first.solid and second.solid and _in_line(first, second):
            (start, end), backwards = _overlap(first, second)
            apart = backwards == (first.solid == second.solid)  # on both sides of the line
            if apart and end - start > MEETS:
                hidden.setdefault(i, []).append((start, end))
    return [
        part
        for i, edge in enumerate(edges)
        for part in ([edge] if i not in hidden else _left_of(edge, hidden[i]))
    ]


def _left_of(edge: _Edge, hidden: list[tuple[float, float]]) -> Iterator[_Edge]:
    """Yield the parts of an edge outside of some intervals of its length, metres."""
    at = 0.0
    far = _length(edge)
    for start, end in [*sorted(hidden), (far, far)]:
        if start - at > MEETS:
            yield edge._replace(a=_along(edge, at), b=_along(edge, start))
        at = max(at, end)


# -- edges in one line ------------------------------------------------------------------------


def _joined(edges: list[_Edge]) -> list[Straight]:
    """Return walls, each of the edges with one surface that go on in one line."""
    first = list(range(len(edges)))

    def root(i: int) -> int:
        while first[i] != i:
            first[i] = first[first[i]]
            i = first[i]
        return i

    for i, j in _meeting(edges):
        if edges[i].surface == edges[j].surface and _in_line(edges[i], edges[j]):
            low, high = sorted((root(i), root(j)))
            first[high] = low
    groups: dict[int, list[_Edge]] = {}
    for i, edge in enumerate(edges):
        groups.setdefault(root(i), []).append(edge)
    return [wall for group in groups.values() for wall in _as_walls(group)]


def _as_walls(group: list[_Edge]) -> list[Straight]:
    """Return one wall for edges in one line; one for each if they bend in the end after all."""
    if len(group) > 1:
        ends = np.array([point for edge in group for point in (edge.a, edge.b)])
        longest = max(group, key=_length)
        way = np.subtract(longest.b, longest.a)
        along = (ends - longest.a) @ way
        a, b = ends[along.argmin()], ends[along.argmax()]
        way = (b - a) / hypot(*(b - a))
        off = np.abs((ends[:, 0] - a[0]) * way[1] - (ends[:, 1] - a[1]) * way[0])
        if off.max() <= 2 * MEETS:
            shares = ((ends - a) @ way / hypot(*(b - a))).reshape(-1, 2)
            shares.sort(axis=1)
            spans = [
                Span(edge.obstacle, *share)
                for edge, share in zip(group, shares.tolist(), strict=True)
            ]
            spans.sort(key=lambda span: (span.start, span.obstacle))
            start, end = (float(a[0]), float(a[1])), (float(b[0]), float(b[1]))
            return [Straight(start, end, group[0].surface, tuple(spans), start, end)]
    return [
        Straight(edge.a, edge.b, edge.surface, (Span(edge.obstacle, 0, 1),), edge.a, edge.b)
        for edge in group
    ]


# -- walls that end at others -----------------------------------------------------------------


def _cut_short(walls: list[Straight], gap: float) -> list[Straight]:
    """Return walls that end a little before others which they meet from one side."""
    cut = {i: [0.0, 0.0] for i in range(len(walls))}
    for i, j in _meeting(walls):
        if _in_line(walls[i], walls[j]):
            continue
        far = _length(walls[i])
        for k, end in enumerate((walls[j].a, walls[j].b)):
            along, off = _seen_from(walls[i], end)
            if off <= MEETS and gap < along < far - gap:
                away = _seen_from(walls[i], (walls[j].b, walls[j].a)[k])[1]
                cut[j][k] = max(cut[j][k], gap / away)
    return [_shorter(wall, *cut[i]) for i, wall in enumerate(walls)]


def _shorter(wall: Straight, at_a: float, at_b: float) -> Straight:
    """Return a wall without shares of its length at both ends, of each at most a third."""
    if not (at_a or at_b):
        return wall
    far = _length(wall)
    start, end = far * min(at_a, 1 / 3), far * (1 - min(at_b, 1 / 3))
    spans = [
        Span(k, *(float(np.clip((s * far - start) / (end - start), 0, 1)) for s in (low, high)))
        for k, low, high in wall.spans
    ]
    return wall._replace(a=_along(wall, start), b=_along(wall, end), spans=tuple(spans))


# -- walls that go on in another direction ----------------------------------------------------


def _linked(walls: list[Straight]) -> tuple[Straight, ...]:
    """Return walls that know which ones go on at their ends, the straightest where several do."""
    best: dict[tuple[int, bool], tuple[float, Point]] = {}
    for i, j in _meeting(walls):
        wall, other = walls[i], walls[j]
        for at_b, end, far in ((False, wall.a, wall.b), (True, wall.b, wall.a)):
            for near, next_ in ((other.a, other.b), (other.b, other.a)):
                if hypot(near[0] - end[0], near[1] - end[1]) > MEETS:
                    continue
                x, y = end[0] - far[0], end[1] - far[1]
                u, v = next_[0] - near[0], next_[1] - near[1]
                straight = (x * u + y * v) / (hypot(x, y) * hypot(u, v))
                if straight > best.get((i, at_b), (0.0, end))[0]:
                    best[i, at_b] = straight, next_
    return tuple(
        wall._replace(
            before=best.get((i, False), (0.0, wall.a))[1],
            after=best.get((i, True), (0.0, wall.b))[1],
        )
        for i, wall in enumerate(walls)
    )


# -- lines ------------------------------------------------------------------------------------


def _meeting(edges: Sequence[_Edge | Straight]) -> Iterator[tuple[int, int]]:
    """Yield i and j for each end of an edge j that lies on another edge i."""
    ends = np.array([point for edge in edges for point in (edge.a, edge.b)])
    for i, near in enumerate(_near(ends)):
        others = np.unique(near[_distances(edges[i], ends[near]) <= MEETS] // 2)
        for j in others.tolist():
            if i != j:
                yield i, j


def _near(ends: Float) -> Iterator[NDArray[np.intp]]:
    """Yield for each edge the ends that may lie on it, sorted; ends: of all edges, in pairs."""
    if len(ends) <= FEW:
        for _ in range(len(ends) // 2):
            yield np.arange(len(ends))
        return
    from scipy.spatial import cKDTree  # it takes longer to import than a small world to build

    starts, stops = ends[::2], ends[1::2]
    reach = np.hypot(*(stops - starts).T) / 2 + MEETS
    for near in cKDTree(ends).query_ball_point((starts + stops) / 2, reach, return_sorted=True):
        yield np.array(near)


def _distances(edge: _Edge | Straight, points: Float) -> Float:
    way = np.subtract(edge.b, edge.a)
    x, y = (points - edge.a).T
    share = np.clip((x * way[0] + y * way[1]) / (way @ way), 0, 1)
    off: Float = np.hypot(x - share * way[0], y - share * way[1])
    return off


def _in_line(one: _Edge | Straight, other: _Edge | Straight) -> bool:
    """Whether two edges lie on one line, as the longer of them says."""
    long, short = (one, other) if _length(one) >= _length(other) else (other, one)
    return all(abs(_seen_from(long, end)[1]) <= MEETS for end in (short.a, short.b))


def _overlap(one: _Edge, other: _Edge) -> tuple[tuple[float, float], bool]:
    """Return from where to where on one edge another in its line lies, and if it runs back."""
    start, end = (_seen_from(one, point)[0] for point in (other.a, other.b))
    low, high = sorted((start, end))
    return (max(low, 0.0), min(high, _length(one))), end < start


def _seen_from(edge: _Edge | Straight, point: Point) -> tuple[float, float]:
    """Return how far along an edge's line a point is, and how far beside it, metres."""
    far = _length(edge)
    ux, uy = (edge.b[0] - edge.a[0]) / far, (edge.b[1] - edge.a[1]) / far
    x, y = point[0] - edge.a[0], point[1] - edge.a[1]
    return x * ux + y * uy, abs(x * uy - y * ux)


def _length(edge: _Edge | Straight) -> float:
    return hypot(edge.b[0] - edge.a[0], edge.b[1] - edge.a[1])


def _along(edge: _Edge | Straight, way: float) -> Point:
    """Return the point that many metres along an edge."""
    share = way / _length(edge)
    (ax, ay), (bx, by) = edge.a, edge.b
    return ax + share * (bx - ax), ay + share * (by - ay)
