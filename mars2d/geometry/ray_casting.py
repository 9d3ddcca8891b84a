"""Ray casting: the lengths of many rays from each of many points, in numpy over all at once.

A fan is a set of rays that start in one point. An edge or a disc can be hit only by rays whose
bearings lie between its ends, and only these are computed: a fan of 180 rays among 200 edges needs
about a hundred divisions instead of 36 000. Things beyond the range, and edges that face away, are
left out before.

The length of a ray follows from its start, its direction and the thing hit alone, in the same
operations whatever else is cast. So a fan gives the same bits alone and among others.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from math import inf, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.arithmetic import cosines_sines, norms
from mars2d.core.plane import WITHIN, Outline, Point, edges_of, up_to

Float = NDArray[np.float64]
Int = NDArray[np.int64]
Mask = NDArray[np.bool_]

Parts = Sequence[tuple[Sequence[Point], float]]
"""The parts of a body: convex polygons, counter-clockwise, or one point with a radius > 0."""

TURN = 2 * pi

MARGIN = 1e-9
"""Rays are computed up to this angle beyond the ends of an edge or disc, rad."""

GRAZING = 1e-4
"""An edge seen under a smaller angle is computed by a formula that is stable there, rad."""

CORNER = 1e-13
"""The rounding error by which a ray aimed at an edge's end passes it, per metre plus one."""

MAX_RAYS_AT_ONCE = 12_000
"""The approximate number of rays cast together; more do not fit into the processor's cache."""

NOBODY = np.iinfo(np.int64).min
"""The owner of obstacles; it differs from the number of every body that is ignored."""


class _Table(NamedTuple):
    """Values that depend on the bearings of a fan's rays (k,) alone.

    cos, sin: of the bearings (k,). bearing: the bearings from -2 pi to 4 pi, ascending, and number:
    the ray of each (3 k,).
    """

    cos: Float
    sin: Float
    bearing: Float
    number: Int


class _Beams(NamedTuple):
    """The rays of the fans that are cast together.

    x, y: the fans' starting points (m,). heading: (m,), in [-pi, pi]. way_x, way_y: the rays' unit
    vectors, fan by fan (m k,). each: the number of rays of a fan, k. reach: their range, metres.
    ignore: the body that each fan does not see (m,).
    """

    x: Float
    y: Float
    heading: Float
    way_x: Float
    way_y: Float
    table: _Table
    each: int
    reach: float
    ignore: Int

    def between(self, fan: Int, low: Float, width: Float) -> tuple[Int, Int, Mask]:
        """Return the table's rays in intervals of bearings, and which intervals end close to a ray.

        low, width: the beginning and the width of each interval, rad (p,). Returns for each (p,)
        the first ray, the one after the last, both with the margin, and whether a ray lies within
        the margin of either end.
        """
        bearing = self.table.bearing
        low = low - self.heading[fan]
        low = np.where(low < 0, low + TURN, low)
        high = low + width
        first = np.searchsorted(bearing, low - MARGIN)
        end = np.searchsorted(bearing, high + MARGIN, side="right")
        near = (bearing[first] < low + MARGIN) | (bearing[end - 1] > high - MARGIN)
        return first, end, near

    def rays(self, fan: Int, first: Int, count: Int) -> Int:
        """Return the indices among all rays of `count` consecutive rays of the table."""
        before = np.cumsum(count)
        total = int(before[-1]) if len(before) else 0
        within = np.arange(total) + np.repeat(first - before + count, count)
        return np.asarray(self.table.number[within] + np.repeat(fan * self.each, count))


class _Edges(NamedTuple):
    """Pairs of fans and edges (p,).

    low, width: the interval of bearings of the edge. area: the signed area of the parallelogram
    spanned by the edge and the fan's start, m^2. grazing: whether the edge is seen nearly end on.
    """

    fan: Int
    low: Float
    width: Float
    edge: Int
    area: Float
    grazing: Mask


class _Discs(NamedTuple):
    """Pairs of fans and discs (p,): intervals of bearings, relative centres [m], radii [m]."""

    fan: Int
    low: Float
    width: Float
    disc: Int
    dx: Float
    dy: Float
    radius: Float


class _Inside(NamedTuple):
    """Pairs of fans and bodies in which they start, (q,)."""

    fan: Int
    body: Int


class _Met(NamedTuple):
    """Rays (c,), by their indices among all, and their lengths (c,).

    body: the bodies hit (p,); run: the number of consecutive rays that hit each (p,).
    """

    ray: Int
    distance: Float
    body: Int
    run: Int


class Fans:
    """Casts fans of rays at moving bodies and fixed obstacles.

    A body is solid: a ray that starts in it has length 0. An obstacle is an outline: a ray that
    starts in it goes on to its edge. Ends of edges belong to them, so that no ray slips through a
    corner, and a ray along a wall meets its near end.

    >>> fans = Fans([], [[(1, -1), (1, 1)]])
    >>> fans.distances(np.zeros((3, 1)), [-0.1, 0, 3], 5.0, [0]).round(3).tolist()
    [[1.005, 1.0, inf]]
    """

    def __init__(self, bodies: Sequence[Parts], obstacles: Sequence[Outline]) -> None:
        """Take the bodies' parts in their own frames, and the obstacles' outlines, metres.

        Body i has the number i, obstacle k the number -1 - k.
        """
        rings: list[tuple[Sequence[Point], int]] = []
        for k, outline in enumerate(obstacles):
            rings += [(chain, -1 - k) for chain in _chains(outline)]
        fixed = len(rings)
        parts = [(*part, i) for i, body in enumerate(bodies) for part in body]
        rings += [(points, i) for points, _, i in parts if len(points) > 1]
        discs = [(points[0], radius, i) for points, radius, i in parts if len(points) == 1]
        self._build_rings(rings, fixed)
        self._disc_radius = np.array([radius for _, radius, _ in discs])
        self._disc_body = np.array([i for _, _, i in discs], dtype=int)
        # Things are the rings, then the discs; each lies within a circle about its middle.
        boxes = [np.array([np.min(ring, axis=0), np.max(ring, axis=0)]) for ring, _ in rings]
        middles = [box.mean(axis=0) for box in boxes] + [center for center, _, _ in discs]
        halves = [norms(*(box[1] - box[0])) / 2 for box in boxes]
        self._middle = np.array(middles).reshape(-1, 2).T.copy()
        self._disc = self._middle[:, len(rings) :]
        self._radius = np.concatenate([np.array(halves), self._disc_radius])
        body_of = np.concatenate([self._ring_body, self._disc_body])
        self._owner = np.where(body_of < 0, NOBODY, body_of)
        # These move with the bodies: corners of rings, and middles.
        self._placed = self._middle[:, fixed:]
        corner = self._edge_number[self._moving]
        self._local = np.hstack([self._edge_a[:, self._moving], self._placed])
        self._body_of = np.concatenate([corner, body_of[fixed:]])

    def _build_rings(self, rings: list[tuple[Sequence[Point], int]], fixed: int) -> None:
        """Store convex rings, or single edges, edge by edge; the first `fixed` ones don't move."""
        size = np.array([1 if len(ring) == 2 else len(ring) for ring, _ in rings], dtype=int)
        corners = [np.array(ring, dtype=float) for ring, _ in rings]
        self._rings, self._ring_size = len(rings), size
        self._ring_first = np.cumsum(size) - size
        self._ring_body = np.array([body for _, body in rings], dtype=int)
        self._ring_solid = np.arange(len(rings)) >= fixed
        self._edge_number = np.repeat(self._ring_body, size)
        self._edge_a = _points([ring[:k] for ring, k in zip(corners, size, strict=True)])
        ends = [np.roll(ring, -1, axis=0)[:k] for ring, k in zip(corners, size, strict=True)]
        self._edge_b = _points(ends)
        self._edge = self._edge_b - self._edge_a
        self._length = norms(*self._edge)
        self._thin = (GRAZING * self._length) ** 2
        moving = int(size[:fixed].sum())
        self._moving = slice(moving, None)
        first = self._ring_first[fixed:] - moving
        self._next = np.arange(1, len(self._length) - moving + 1)
        self._next[first + size[fixed:] - 1] = first

    def place(self, pose: Float) -> None:
        """Move the bodies to poses (3, N): x, y [m], theta [rad]."""
        body, corners = self._body_of, len(self._next)
        c, s = (each[body] for each in cosines_sines(pose[2]))
        x = pose[0][body] + c * self._local[0] - s * self._local[1]
        y = pose[1][body] + s * self._local[0] + c * self._local[1]
        self._placed[0], self._placed[1] = x[corners:], y[corners:]
        if corners:
            a, b = self._edge_a[:, self._moving], self._edge_b[:, self._moving]
            a[0], a[1] = x[:corners], y[:corners]
            b[:] = a[:, self._next]
            np.subtract(b, a, out=self._edge[:, self._moving])

    def distances(
        self, poses: Float, bearings: ArrayLike, reach: ArrayLike, ignore: ArrayLike
    ) -> Float:
        """Return the lengths of rays, (m, k) metres; inf for a ray that hits nothing.

        poses: x, y [m], heading [rad] of the fans (3, m). bearings: those of their rays relative to
        the heading, rad (k,). reach: the range of all rays, or of each (k,), metres. ignore: the
        body that each fan does not see (m,), a negative number for none.
        """
        return self._cast(poses, bearings, reach, ignore, None)[0]

    def sight(
        self,
        poses: Float,
        bearings: ArrayLike,
        reach: ArrayLike,
        ignore: ArrayLike,
        nothing: int,
    ) -> tuple[Float, Int]:
        """Return the lengths of rays and the bodies that they hit, (m, k) each; see `distances`.

        nothing: the value for a ray that hits nothing. Of equally distant bodies, the one with the
        lowest number counts.
        """
        return self._cast(poses, bearings, reach, ignore, nothing)

    def _cast(
        self,
        poses: Float,
        bearings: ArrayLike,
        reach: ArrayLike,
        ignore: ArrayLike,
        nothing: int | None,
    ) -> tuple[Float, Int]:
        """Return the lengths of rays, (m, k), and the bodies hit, empty if `nothing` is None."""
        far, blind = np.asarray(reach, dtype=float), np.asarray(ignore)
        limit = WITHIN * float(far.max(initial=0.0))
        table = _table(np.asarray(bearings, dtype=float).tobytes())
        shape = poses.shape[1], len(table.cos)
        distances = np.full(shape, inf)
        bodies = np.empty(shape if nothing is not None else 0, dtype=int)
        for fans in _strips(poses, limit, shape[1]):
            beams = _beams(poses[:, fans], table, limit, blind[fans])
            found = [*self._meet(beams, *self._near(beams))]
            nearest = np.full(len(beams.way_x), inf)
            for met in found:
                np.minimum.at(nearest, met.ray, met.distance)
            seen = distances[fans] = up_to(nearest.reshape(len(fans), -1), far)
            nearest[np.isinf(seen).ravel()] = inf
            if nothing is not None:
                bodies[fans] = _first(found, nearest, nothing).reshape(seen.shape)
        return distances, bodies

    def _near(self, beams: _Beams) -> tuple[Int, Int]:
        """Return pairs of fans and things within their range, fan by fan."""
        near = np.arange(len(self._radius))
        for middle, start in zip(self._middle, (beams.x, beams.y), strict=True):
            high, low = start.max() + beams.reach, start.min() - beams.reach
            radius = self._radius[near]
            near = near[(middle[near] - radius <= high) & (middle[near] + radius >= low)]
        dx, dy = self._middle[0, near] - beams.x[:, None], self._middle[1, near] - beams.y[:, None]
        seen = dx * dx + dy * dy <= (WITHIN * (self._radius[near] + beams.reach)) ** 2
        seen &= self._owner[near] != beams.ignore[:, None]
        fan, thing = np.nonzero(seen)
        return fan, near[thing]

    def _meet(self, beams: _Beams, fan: Int, thing: Int) -> Iterator[_Met]:
        """Yield the hits of rays on pairs of fans and things."""
        ring, disc = np.flatnonzero(thing < self._rings), np.flatnonzero(thing >= self._rings)
        edges, within_rings = self._edges(beams, fan[ring], thing[ring])
        discs, within_discs = self._discs(beams, fan[disc], thing[disc] - self._rings)
        for inside in (within_rings, within_discs):
            if len(inside.fan):
                yield _at_once(beams, inside)
        # Edges and discs together, since a call of numpy costs as much as some hundred numbers.
        eye = np.concatenate([edges.fan, discs.fan])
        low = np.concatenate([edges.low, discs.low])
        width = np.concatenate([edges.width, discs.width])
        first, end, near = beams.between(eye, low, width)
        count, parted = end - first, len(edges.fan)
        closely = np.flatnonzero(near[:parted] | edges.grazing)
        if len(closely):
            yield self._meet_closely(beams, edges, first, count, closely)
            count[closely] = 0
        ray = beams.rays(eye, first, count)
        c, s = beams.way_x[ray], beams.way_y[ray]
        there = int(count[:parted].sum())
        yield self._meet_edges(edges, count[:parted], ray[:there], c[:there], s[:there])
        yield self._meet_discs(discs, count[parted:], ray[there:], c[there:], s[there:])

    def _edges(self, beams: _Beams, fan: Int, ring: Int) -> tuple[_Edges, _Inside]:
        """Return the edges of rings that fans may see, and the bodies in which fans start."""
        size = self._ring_size[ring]
        before = np.cumsum(size) - size
        eye = np.repeat(fan, size)
        edge = np.arange(len(eye)) + np.repeat(self._ring_first[ring] - before, size)
        ax, ay = self._edge_a[0][edge] - beams.x[eye], self._edge_a[1][edge] - beams.y[eye]
        area = ax * self._edge[1][edge] - ay * self._edge[0][edge]
        # Rings are counter-clockwise. From outside, some edges show their outer sides and hide the
        # others; from inside, none does. Of a single edge, both sides count.
        inside = np.minimum.reduceat(area, before) >= 0
        solid = inside & self._ring_solid[ring]
        facing = (area < 0) | np.repeat(inside ^ solid, size)
        limit = beams.reach * WITHIN * self._length
        seen = np.flatnonzero(facing & (np.abs(area) <= limit[edge]))
        eye, edge, area, ax, ay = eye[seen], edge[seen], area[seen], ax[seen], ay[seen]
        bx, by = self._edge_b[0][edge] - beams.x[eye], self._edge_b[1][edge] - beams.y[eye]
        far_a, far_b = ax * ax + ay * ay, bx * bx + by * by
        grazing = area * area <= np.maximum(far_a, far_b) * self._thin[edge]
        low = np.arctan2(ay, ax)
        width = np.arctan2(by, bx) - low
        width -= TURN * np.rint(width / TURN)
        low += np.minimum(width, 0)
        np.abs(width, out=width)
        # If the start lies on the edge, the edge is all around it.
        width[grazing & ((width > 3) | (far_a == 0) | (far_b == 0))] = TURN
        within = np.flatnonzero(solid)
        return (
            _Edges(eye, low, width, edge, area, grazing),
            _Inside(fan[within], self._ring_body[ring[within]]),
        )

    def _meet_edges(self, edges: _Edges, count: Int, ray: Int, c: Float, s: Float) -> _Met:
        """Return the lengths of rays (c, s) up to edges, each of which is hit by `count` rays."""
        edge = np.repeat(edges.edge, count)
        # The ray (c, s) t meets the line a + e u at t = (a x e) / ((c, s) x e).
        slope = c * self._edge[1][edge] - s * self._edge[0][edge]
        distance = np.repeat(edges.area, count) / slope
        return _Met(ray, distance, self._edge_number[edges.edge], count)

    def _meet_closely(
        self, beams: _Beams, edges: _Edges, first: Int, count: Int, which: Int
    ) -> _Met:
        """Return the lengths of rays that pass near an end of an edge, or along it; inf for a miss.

        For two edges that share an end, the result there follows from the same numbers, so that no
        ray can pass between them.
        """
        count = count[which]
        ray = beams.rays(edges.fan[which], first[which], count)
        pair = np.repeat(which, count)
        eye, edge = edges.fan[pair], edges.edge[pair]
        ax, ay = self._edge_a[0][edge] - beams.x[eye], self._edge_a[1][edge] - beams.y[eye]
        bx, by = self._edge_b[0][edge] - beams.x[eye], self._edge_b[1][edge] - beams.y[eye]
        c, s = beams.way_x[ray], beams.way_y[ray]
        beside_a, beside_b = c * ay - s * ax, c * by - s * bx
        along_a, along_b = c * ax + s * ay, c * bx + s * by
        at_a = np.abs(beside_a) <= _aimed(norms(ax, ay))
        at_b = np.abs(beside_b) <= _aimed(norms(bx, by))
        between = np.minimum(beside_a, beside_b) <= 0
        between &= np.maximum(beside_a, beside_b) >= 0
        with np.errstate(divide="ignore", invalid="ignore"):
            plain = edges.area[pair] / (c * self._edge[1][edge] - s * self._edge[0][edge])
            mixed = (along_a * beside_b - along_b * beside_a) / (beside_b - beside_a)
        near, later = np.minimum(along_a, along_b), np.maximum(along_a, along_b)
        inline = np.where(later < 0, later, np.maximum(near, 0))
        met = [edges.grazing[pair] & at_a & at_b, edges.grazing[pair] & between]
        met += [edges.grazing[pair] & at_a, edges.grazing[pair] & at_b, between | at_a | at_b]
        distance = np.select(met, [inline, mixed, along_a, along_b, plain], -inf)
        distance = np.where(distance < -CORNER, inf, np.maximum(distance, 0))
        return _Met(ray, distance, self._edge_number[edges.edge[which]], count)

    def _discs(self, beams: _Beams, fan: Int, disc: Int) -> tuple[_Discs, _Inside]:
        """Return the discs that fans may see, and the bodies in which fans start."""
        dx, dy = self._disc[0][disc] - beams.x[fan], self._disc[1][disc] - beams.y[fan]
        radius = self._disc_radius[disc]
        tangent = dx * dx + dy * dy - radius * radius
        outer, within = np.flatnonzero(tangent > 0), np.flatnonzero(tangent <= 0)
        if len(within):
            inside = _Inside(fan[within], self._disc_body[disc[within]])
            fan, disc, dx, dy = fan[outer], disc[outer], dx[outer], dy[outer]
            radius, tangent = radius[outer], tangent[outer]
        else:
            inside = _Inside(within, within)
        half = np.arctan2(radius, np.sqrt(tangent))
        return _Discs(fan, np.arctan2(dy, dx) - half, 2 * half, disc, dx, dy, radius), inside

    def _meet_discs(self, discs: _Discs, count: Int, ray: Int, c: Float, s: Float) -> _Met:
        """Return the lengths of rays (c, s) up to discs, each of which `count` rays may hit."""
        pair = np.repeat(np.arange(len(count)), count)
        dx, dy, radius = discs.dx[pair], discs.dy[pair], discs.radius[pair]
        across, along = c * dy - s * dx, c * dx + s * dy
        inner = radius * radius - across * across
        distance = np.maximum(along - np.sqrt(np.maximum(inner, 0)), 0)
        distance[inner < 0] = inf
        return _Met(ray, distance, self._disc_body[discs.disc], count)


@lru_cache(maxsize=16)
def _table(bearings: bytes) -> _Table:
    """Return the table of bearings, which are given as the bytes of floats."""
    given = np.frombuffer(bearings)
    turned = given % TURN
    order = np.argsort(turned)
    ahead = turned[order]
    bearing = np.concatenate([ahead - TURN, ahead, ahead + TURN])
    return _Table(*cosines_sines(given), bearing, np.tile(order, 3))


def _strips(poses: Float, reach: float, each: int) -> Iterator[Int]:
    """Yield groups of fans to cast together: not too many, with starting points close together."""
    x, y = poses[0], poses[1]
    order = np.lexsort((y, np.floor(x / reach))) if reach else np.arange(len(x))
    many = max(MAX_RAYS_AT_ONCE // max(each, 1), 1)
    for k in range(0, len(order) if each else 0, many):
        yield order[k : k + many]


def _beams(poses: Float, table: _Table, reach: float, ignore: Int) -> _Beams:
    """Return the rays of fans at poses (3, m), all with the same bearings."""
    x, y, theta = np.ascontiguousarray(poses)
    c, s = cosines_sines(theta)
    heading = np.arctan2(s, c)
    c, s = c[:, None], s[:, None]
    way_x, way_y = c * table.cos - s * table.sin, s * table.cos + c * table.sin
    return _Beams(x, y, heading, way_x.ravel(), way_y.ravel(), table, way_x.shape[1], reach, ignore)


def _first(found: list[_Met], nearest: Float, nothing: int) -> Int:
    """Return the body that each ray hits (c,); of equally near ones, the lowest."""
    body = np.full(len(nearest), np.iinfo(int).max)
    for met in found:
        first = met.distance == nearest[met.ray]
        whose = np.repeat(met.body, met.run)
        np.minimum.at(body, met.ray[first], whose[first])
    body[np.isinf(nearest)] = nothing
    return body


def _at_once(beams: _Beams, inside: _Inside) -> _Met:
    """Return the hits of fans that start inside bodies: all their rays have length 0."""
    ray = (inside.fan[:, None] * beams.each + np.arange(beams.each)).ravel()
    return _Met(ray, np.zeros(len(ray)), inside.body, np.full(len(inside.fan), beams.each))


def _aimed(apart: Float) -> Float:
    """Return the distance within which a ray counts as aimed at a point `apart` away, metres."""
    return np.minimum(CORNER * (1 + apart), MARGIN / 2 * apart)


def _points(rings: Sequence[Float]) -> Float:
    """Return the points of all rings as (2, k)."""
    return np.concatenate([np.empty((0, 2)), *rings]).T.copy()


def _chains(outline: Outline) -> list[Sequence[Point]]:
    """Return a convex outline as one ring, counter-clockwise; any other one as single edges."""
    if len(outline) > 2:
        ring = np.array(outline, dtype=float)
        edge = np.roll(ring, -1, axis=0) - ring
        after = np.roll(edge, -1, axis=0)
        turn = edge[:, 0] * after[:, 1] - edge[:, 1] * after[:, 0]
        bend = np.arctan2(turn, (edge * after).sum(axis=1))
        if (turn > 0).all() and bend.sum() < 1.5 * TURN:
            return [outline]
        if (turn < 0).all() and bend.sum() > -1.5 * TURN:
            return [outline[::-1]]
    return [*edges_of(outline)]
