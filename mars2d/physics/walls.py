"""Walls: the edges of obstacles as the engine gets them, joined where they go straight on.

A body that slides along a wall enters it by a tenth of a millimetre or so. With that it would trip
over the end of each piece that begins there. So pieces in one line become one, what two solids that
adjoin have in common is left out, and each wall knows what it meets at its ends.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from math import pi, sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arithmetic import angle_of, norm
from mars2d.core.plane import Outline, Point, edges_of

MEET = 1e-6
"""How near to each other walls meet, or lie in one line, metres: much less than bodies overlap."""

FEW = 48
"""Up to this number of walls, all pairs are looked at."""

Float = NDArray[np.float64]
Whole = NDArray[np.int64]
Surface = tuple[Any, ...]
"""Coefficients of friction and restitution, and more where these settle contacts."""


class Seam(NamedTuple):
    """The wall that is met first when one turns about an end, on one side of a wall.

    way: its direction from there, a unit vector. bulges: whether the corner between both is more
    than half a turn wide, as round the corner of a box.
    """

    way: Point
    bulges: bool


Seams = tuple[Seam | None, ...]
"""Those at the start of a wall, to its left and right, and at its end, to its left and right."""


class Shade(NamedTuple):
    """A wall behind which another one ends.

    end: of that one. away: the direction off both, a unit vector. far: metres to the nearer end of
    what it ends at: what is as near to there and on the other side is hidden from it.
    """

    end: Point
    away: Point
    far: float


class Wall(NamedTuple):
    """A straight wall: its ends [m], its surface, and whose it is.

    owners: pairs of metres from its start and the obstacle that it belongs to from there on.
    """

    start: Point
    end: Point
    surface: Surface
    owners: tuple[tuple[float, int], ...]
    seams: Seams
    shades: tuple[Shade, ...]


class Edge(NamedTuple):
    """An edge of an obstacle. solid: 1 if the obstacle lies to its left, -1 to its right, or 0."""

    start: Point
    end: Point
    obstacle: int
    surface: Surface
    solid: int


class Line(NamedTuple):
    """The straight line from a start in a direction, a unit vector."""

    start: Point
    way: Point

    def along(self, point: Point) -> float:
        """Return how far along it a point is, metres."""
        return _dot(_to(self.start, point), self.way)

    def off(self, point: Point) -> float:
        """Return how far a point is from it, metres."""
        return abs(_cross(_to(self.start, point), self.way))


@lru_cache(maxsize=4)
def walls_of(obstacles: tuple[tuple[Outline, Surface, bool], ...]) -> tuple[Wall, ...]:
    """Return the walls of obstacles: outlines, surfaces, and whether they are solid if closed."""
    sides = [_solid_side(outline) if solid else 0 for outline, _, solid in obstacles]
    edges = [
        Edge(*ends, k, surface, sides[k])
        for k, (outline, surface, _) in enumerate(obstacles)
        for ends in edges_of(outline)
    ]
    first: dict[tuple[Point, Point, int], Edge] = {}
    for edge in edges:  # of those in one place, solid on the same side, the first counts
        first.setdefault(_place(edge), edge)
    edges = [*first.values()]
    straight = [wall for group in _in_line(edges) for wall in _joined(edges, group)]
    meetings = _meetings([(wall.start, wall.end) for wall in straight])
    return tuple(_met(wall, straight, meetings[k]) for k, wall in enumerate(straight))


def _place(edge: Edge) -> tuple[Point, Point, int]:
    """Return the ends of an edge in order, and on which side of the way between them is a solid."""
    start, end = sorted((edge.start, edge.end))
    return start, end, edge.solid if start == edge.start else -edge.solid


def _solid_side(outline: Outline) -> int:
    """Return on which side of its edges a closed outline is solid: 1 left, -1 right, or 0."""
    if len(outline) == 2:
        return 0
    middle = outline[0]
    return (
        1 if sum(_cross(_to(middle, a), _to(middle, b)) for a, b in edges_of(outline)) > 0 else -1
    )


# -- what meets at an end ---------------------------------------------------------------------


def _meetings(lines: Sequence[tuple[Point, Point]]) -> list[tuple[list[int], list[int]]]:
    """Return for each line the others on which its start lies, and those on which its end does."""
    found: list[tuple[list[int], list[int]]] = [([], []) for _ in lines]
    if not lines:
        return found
    starts, ends = np.array(lines, dtype=float).transpose(1, 0, 2)
    points = np.concatenate([starts, ends])
    which, line = _near(points, starts, ends)
    others = which % len(lines) != line
    which, line = which[others], line[others]
    way = ends - starts
    far = np.sqrt((way * way).sum(axis=1))
    way /= far[:, None]
    to_x, to_y = (points[which] - starts[line]).T
    x, y = way[line].T
    along = to_x * x + to_y * y
    on = (abs(to_x * y - to_y * x) <= MEET) & (along >= -MEET) & (along <= far[line] + MEET)
    for k, other in sorted(zip(which[on].tolist(), line[on].tolist(), strict=True)):
        found[k % len(lines)][k // len(lines)].append(other)
    return found


def _near(points: Float, starts: Float, ends: Float) -> tuple[Whole, Whole]:
    """Return pairs of a point (m, 2) and a line (n, 2) to (n, 2), all that are near among them."""
    m, n = len(points), len(starts)
    if n <= FEW:
        return np.repeat(np.arange(m), n), np.tile(np.arange(n), m)
    import shapely

    tree = shapely.STRtree(shapely.linestrings(np.stack([starts, ends], axis=1)))
    which, line = tree.query(shapely.points(points), predicate="dwithin", distance=2 * MEET)
    return which, line


def _met(wall: Wall, walls: Sequence[Wall], meetings: tuple[list[int], list[int]]) -> Wall:
    """Return a wall that knows the walls at its ends."""
    seams: list[Seam | None] = []
    shades: list[Shade] = []
    sides = (wall.start, wall.end, 1), (wall.end, wall.start, -1)
    for (here, there, left), met in zip(sides, meetings, strict=True):
        others = [walls[j] for j in met]
        ways = [way for other in others for way in _ways(other, here)]
        own = _line(here, there).way
        seams += [_first(own, ways, left), _first(own, ways, -left)]
        shades += [_shade(here, own, other) for other in others if len(_ways(other, here)) == 2]
    return wall._replace(seams=tuple(seams), shades=tuple(shades))


def _shade(end: Point, own: Point, other: Wall) -> Shade:
    """Return the shade of a wall at which one ends that leads from there in its own direction."""
    x, y = _line(other.start, other.end).way
    away = (y, -x) if _dot((y, -x), own) < 0 else (-y, x)
    return Shade(end, away, min(norm(*_to(end, other.start)), norm(*_to(end, other.end))))


def _ways(wall: Wall, point: Point) -> list[Point]:
    """Return the directions in which a wall leads away from a point on it."""
    ahead = _line(wall.start, wall.end).way
    back = -ahead[0], -ahead[1]
    if norm(*_to(wall.start, point)) <= MEET:
        return [ahead]
    return [back] if norm(*_to(wall.end, point)) <= MEET else [ahead, back]


def _first(own: Point, ways: Iterable[Point], turn: int) -> Seam | None:
    """Return the first of some directions that one meets who turns from another, or None.

    turn: 1 for counter-clockwise, -1 for clockwise. What leads in that direction itself is left
    out: it overlaps it.
    """
    met = [(turn * angle_of(_cross(own, way), _dot(own, way)) % (2 * pi), way) for way in ways]
    angle, way = min((each for each in met if 1e-9 < each[0] < 2 * pi - 1e-9), default=(0.0, own))
    return Seam(way, angle > pi + 1e-9) if angle else None


# -- pieces in one line -----------------------------------------------------------------------


def _in_line(edges: Sequence[Edge]) -> list[list[int]]:
    """Return groups of edges that meet and lie in one line, each in order, by their first."""
    lines = [_line(edge.start, edge.end) for edge in edges]
    root = list(range(len(edges)))
    for k, (at_start, at_end) in enumerate(_meetings([(edge.start, edge.end) for edge in edges])):
        for other in (*at_start, *at_end):
            first, second = sorted((_root(root, k), _root(root, other)))
            if first != second and _parallel(lines[k], lines[other], edges[k], edges[other]):
                root[second] = first
    groups: dict[int, list[int]] = defaultdict(list)
    for k in range(len(edges)):
        groups[_root(root, k)].append(k)
    return [part for group in groups.values() for part in _kept_straight(edges, group)]


def _root(root: list[int], k: int) -> int:
    while root[k] != k:
        root[k] = root[root[k]]
        k = root[k]
    return k


def _parallel(line: Line, other: Line, edge: Edge, second: Edge) -> bool:
    """Return whether two edges lie in one line: that of the longer one."""
    if abs(_cross(line.way, other.way)) > 0.1:
        return False
    if line.along(edge.end) < other.along(second.end):
        line, second = other, edge
    return max(line.off(second.start), line.off(second.end)) <= MEET


def _kept_straight(edges: Sequence[Edge], group: list[int]) -> list[list[int]]:
    """Return a group, or its edges one by one if all together they bend."""
    if len(group) == 1:
        return [group]
    start, end = _extent(edges, group)
    line = _line(start, end)
    points = (point for k in group for point in (edges[k].start, edges[k].end))
    return [group] if all(line.off(p) <= MEET for p in points) else [[k] for k in group]


def _extent(edges: Sequence[Edge], group: list[int]) -> tuple[Point, Point]:
    """Return the outermost ends of edges in one line, in the direction of the first."""
    line = _line(edges[group[0]].start, edges[group[0]].end)
    points = [point for k in group for point in (edges[k].start, edges[k].end)]
    return min(points, key=line.along), max(points, key=line.along)


def _joined(edges: Sequence[Edge], group: list[int]) -> Iterator[Wall]:
    """Yield the walls of edges in one line, without the parts inside of solids."""
    if len(group) == 1:
        [only] = (edges[k] for k in group)
        yield Wall(only.start, only.end, only.surface, ((0.0, only.obstacle),), (), ())
        return
    start, end = _extent(edges, group)
    line = _line(start, end)
    run: list[tuple[Point, Point, Edge]] = []
    for low, high, owner in _stretches(edges, group, line):
        if run and (run[-1][2].surface != owner.surface or run[-1][1] != low):
            yield _wall(run)
            run = []
        run.append((low, high, owner))
    if run:
        yield _wall(run)


def _stretches(
    edges: Sequence[Edge], group: list[int], line: Line
) -> Iterator[tuple[Point, Point, Edge]]:
    """Yield from where to where a line is whose, from its start on; the first in order counts."""
    ends = []
    for k in group:
        ends += [(line.along(point), point, k) for point in (edges[k].start, edges[k].end)]
    ends.sort(key=lambda end: (end[0], end[2]))
    begun: set[int] = set()
    at, place = ends[0][:2]
    for along, point, edge in ends:
        if along > at + MEET:
            if begun and not _within(edges, begun, line):
                yield place, point, edges[min(begun)]
            at, place = along, point
        begun ^= {edge}


def _within(edges: Sequence[Edge], begun: Iterable[int], line: Line) -> bool:
    """Return whether there are solids on both sides of edges in one line."""
    sides = set()
    for k in begun:
        same = line.along(edges[k].end) > line.along(edges[k].start)
        sides.add(edges[k].solid if same else -edges[k].solid)
    return {1, -1} <= sides


def _wall(run: Sequence[tuple[Point, Point, Edge]]) -> Wall:
    """Return the wall of stretches that follow each other."""
    start, end = run[0][0], run[-1][1]
    owners: list[tuple[float, int]] = []
    for low, _, owner in run:
        if not owners or owners[-1][1] != owner.obstacle:
            owners.append((norm(*_to(start, low)), owner.obstacle))
    return Wall(start, end, run[0][2].surface, tuple(owners), (), ())


def _line(start: Point, end: Point) -> Line:
    dx, dy = _to(start, end)
    far = sqrt(dx * dx + dy * dy)
    return Line(start, (dx / far, dy / far))


def _to(a: Point, b: Point) -> Point:
    return b[0] - a[0], b[1] - a[1]


def _dot(a: Point, b: Point) -> float:
    return a[0] * b[0] + a[1] * b[1]


def _cross(a: Point, b: Point) -> float:
    return a[0] * b[1] - a[1] * b[0]
