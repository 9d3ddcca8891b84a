"""Space: bodies and obstacles as sensors see them: what rays meet, and the nearest points."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from math import inf, pi
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.arithmetic import cosines_sines, norms
from mars2d.core.plane import WITHIN, Outline, Point, edges_of, up_to
from mars2d.physics.islands import islands

Float = NDArray[np.float64]
Int = NDArray[np.int64]

Parts = Sequence[tuple[Sequence[Point], float]]
"""The parts of a body: convex polygons, counter-clockwise, or one point with a radius > 0."""

Ring = Sequence[Point]
"""Corners of a convex ring, counter-clockwise, or the ends of a single edge."""

WIDE = 4.0
"""Things so many times larger than the middle one are looked at by each ray."""

AT_THE_END = 1e-9
"""A surface as near to the end of a ray does not hide the end, metres."""


class Space:
    """Moving bodies and fixed obstacles.

    A body is solid: a ray that starts in it has length 0. An obstacle is an outline: a ray that
    starts in it goes on to its edge. Ends of edges belong to them, so that no ray slips through a
    corner, and a ray along a wall meets its near end.

    >>> space = Space([], [[(1, -1), (1, 1)]])
    >>> space.distances(np.zeros((3, 1)), [-0.1, 0, 3], 5.0, [0]).round(3).tolist()
    [[1.005, 1.0, inf]]
    """

    def __init__(self, bodies: Sequence[Parts], obstacles: Sequence[Outline]) -> None:
        """Take the bodies' parts in their own frames, and the obstacles' outlines, metres.

        Body i has the number i, obstacle k the number -1 - k.
        """
        rings = [(ring, 0.0, -1 - k) for k, each in enumerate(obstacles) for ring in _rings(each)]
        parts = [(points, radius, i) for i, body in enumerate(bodies) for points, radius in body]
        fixed, self._moving = _things(rings, solid=False), _things(parts, solid=True)
        self._caster = islands().Caster([fixed, self._moving])
        fixed.place(np.zeros(6))

    def place(self, states: Float) -> None:
        """Move the bodies to where they are, (N, 6): x, y [m], theta [rad], and any three more."""
        if states.size:
            self._moving.place(states.reshape(-1))

    def distance(self, point: Point, limit: float, ignore: int) -> float:
        """Return the distance to the nearest surface, inf beyond `limit`; see Surroundings."""
        near = self._caster.nearby(*point, WITHIN * limit, ignore)
        return min(float(min(near)[0]), limit) if near else inf

    def nearby(self, point: Point, limit: float, ignore: int) -> Iterator[Point]:
        """Yield the nearest point of each surface at most `limit` away; see Surroundings."""
        for _, x, y in self._caster.nearby(*point, WITHIN * limit, ignore):
            yield x, y

    def distances(
        self, poses: Float, bearings: ArrayLike, reach: ArrayLike, ignore: ArrayLike
    ) -> Float:
        """Return the lengths of rays, (m, k) metres; inf for a ray that hits nothing.

        poses: x, y [m], heading [rad] of the fans (3, m). bearings: those of their rays relative to
        the heading, rad (k,). reach: the range of all rays, or of each (k,), metres. ignore: the
        body that each fan does not see (m,), a negative number for none.
        """
        return self.sight(poses, bearings, reach, ignore, 0)[0]

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
        order, *rays = _table(np.asarray(bearings, dtype=float).tobytes())
        far, blind = np.asarray(reach, dtype=float), np.array(ignore, dtype=float)
        lengths, owners = np.full((2, len(blind), len(order)), inf)
        owners[:] = nothing
        start = np.array(poses, dtype=float, order="C").reshape(-1)
        limit = WITHIN * float(far.max(initial=0.0))
        if lengths.size:
            found = lengths.reshape(-1), owners.reshape(-1)
            self._caster.scan(start, rays, limit, blind, np.empty((2, len(order))), found)
        seen, met = np.empty_like(lengths), np.empty(lengths.shape, dtype=int)
        seen[:, order], met[:, order] = lengths, owners
        seen = up_to(seen, far)
        met[np.isinf(seen)] = nothing
        return seen, met

    def length(self, start: Point, angle: float, reach: float, ignore: int) -> float:
        """Return the length of one ray, metres; inf if it hits nothing."""
        found = np.full((2, 1), inf)
        pose, blind = np.array([*start, angle]), np.array([float(ignore)])
        self._caster.scan(pose, _AHEAD, WITHIN * reach, blind, np.empty((2, 1)), found)
        length = float(found[0, 0])
        return min(length, reach) if length <= WITHIN * reach else inf

    def hidden(
        self, start: Point, points: Float, bodies: ArrayLike, ignore: int
    ) -> NDArray[np.bool_]:
        """Return whether something stands before points (k, 2); see Surroundings."""
        points = np.asarray(points, dtype=float).reshape(-1, 2)
        lengths, owners = np.full((2, len(points)), inf)
        across = np.array(points.T, order="C").reshape(-1)
        self._caster.reach_points(*start, across, ignore, np.empty((3, 1)), (lengths, owners))
        apart = norms(points[:, 0] - start[0], points[:, 1] - start[1])
        return np.asarray((apart - lengths > AT_THE_END) & (owners != bodies))


def _things(parts: Sequence[tuple[Ring, float, int]], *, solid: bool) -> Any:
    """Return parts for the caster: corners of a ring, or one point and a radius > 0; and owners."""
    rings = [np.array(points, dtype=float).reshape(-1, 2) for points, _, _ in parts]
    boxes = [(ring.min(axis=0), ring.max(axis=0)) for ring in rings]
    radius = np.array(
        [
            radius or norms(*(high - low)) / 2
            for (_, radius, _), (low, high) in zip(parts, boxes, strict=True)
        ]
    )
    wide = radius > WIDE * np.median(radius) if len(parts) else radius > 0.0
    order = np.argsort(~wide, kind="stable")
    rings, boxes = [rings[k] for k in order], [boxes[k] for k in order]
    owner = np.array([parts[k][2] for k in order], dtype=float)
    # A single edge has two ends, but is one edge.
    edges = np.array([{1: 0, 2: 1}.get(len(ring), len(ring)) for ring in rings], dtype=int)
    starts = [ring[:many] for ring, many in zip(rings, edges, strict=True)]
    ends = [np.roll(ring, -1, axis=0)[:many] for ring, many in zip(rings, edges, strict=True)]
    middles = [(low + high) / 2 for low, high in boxes]
    local = np.vstack([np.empty((0, 2)), *middles, *starts, *ends]).T.copy()
    of_edge = np.repeat(owner, edges)
    bodies = np.maximum(np.concatenate([owner, of_edge, of_edge]), 0.0)
    n, corners = len(parts), len(parts) + len(of_edge)
    x, y = np.empty(local.shape)
    return islands().Things(
        solid,
        int(wide.sum()),
        float(radius[~wide].max(initial=0.0)),
        (owner, np.cumsum(edges, dtype=float) - edges, edges.astype(float), radius[order]),
        (bodies, *local, x, y, x[:n], y[:n], x[n:corners], y[n:corners], x[corners:], y[corners:]),
    )


_AHEAD = np.zeros(1), np.ones(1), np.zeros(1)
"""The table of a single bearing, 0: its diamond angle, cosine and sine."""


@lru_cache(maxsize=16)
def _table(bearings: bytes) -> tuple[Int, Float, Float, Float]:
    """Return the order of bearings, and in it their diamond angles, cosines and sines (k,).

    bearings: the bytes of floats.
    """
    c, s = cosines_sines(np.frombuffer(bearings))
    way = s / (np.abs(c) + np.abs(s))
    angle = np.where(c < 0, 2.0 - way, np.where(way < 0, 4.0 + way, way))
    order = np.argsort(angle, kind="stable")
    return order, angle[order], c[order], s[order]


def _rings(outline: Outline) -> list[Ring]:
    """Return a convex outline as one ring, counter-clockwise; any other one as single edges."""
    if len(outline) > 2:
        ring = np.array(outline, dtype=float)
        edge = np.roll(ring, -1, axis=0) - ring
        after = np.roll(edge, -1, axis=0)
        turn = edge[:, 0] * after[:, 1] - edge[:, 1] * after[:, 0]
        bend = np.arctan2(turn, (edge * after).sum(axis=1))
        if (turn > 0).all() and bend.sum() < 3 * pi:
            return [outline]
        if (turn < 0).all() and bend.sum() > -3 * pi:
            return [outline[::-1]]
    return [*edges_of(outline)]
