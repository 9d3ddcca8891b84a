"""Rays: what they meet among bodies and obstacles, for sensors and lines of sight."""

from __future__ import annotations

from collections.abc import Sequence
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


class Rays:
    """Casts rays at moving bodies and fixed obstacles.

    A body is solid: a ray that starts in it has length 0. An obstacle is an outline: a ray that
    starts in it goes on to its edge. Ends of edges belong to them, so that no ray slips through a
    corner, and a ray along a wall meets its near end.

    >>> rays = Rays([], [[(1, -1), (1, 1)]])
    >>> rays.distances(np.zeros((3, 1)), [-0.1, 0, 3], 5.0, [0]).round(3).tolist()
    [[1.005, 1.0, inf]]
    """

    def __init__(self, bodies: Sequence[Parts], obstacles: Sequence[Outline]) -> None:
        """Take the bodies' parts in their own frames, and the obstacles' outlines, metres.

        Body i has the number i, obstacle k the number -1 - k.
        """
        rings = [(ring, 0.0, -1 - k) for k, each in enumerate(obstacles) for ring in _rings(each)]
        parts = [(points, radius, i) for i, body in enumerate(bodies) for points, radius in body]
        self._fixed, self._moving = _Things(rings, solid=False), _Things(parts, solid=True)
        self._caster = islands().Caster([self._fixed.taken, self._moving.taken])
        self._fixed.place(np.zeros((3, 1)))

    def place(self, pose: Float) -> None:
        """Move the bodies to poses (3, N): x, y [m], theta [rad]."""
        self._moving.place(pose)

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


class _Things:
    """Parts that move together, or stand still: rings and discs, and where they are now."""

    def __init__(self, parts: Sequence[tuple[Ring, float, int]], *, solid: bool) -> None:
        """Take parts: corners of a ring, or one point and a radius > 0; and the owner of each."""
        self.taken: Any = islands().Things(solid)
        rings = [np.array(points, dtype=float).reshape(-1, 2) for points, _, _ in parts]
        # A single edge has two ends, but is one edge.
        edges = np.array([{1: 0, 2: 1}.get(len(ring), len(ring)) for ring in rings], dtype=int)
        starts = [ring[:many] for ring, many in zip(rings, edges, strict=True)]
        ends = [np.roll(ring, -1, axis=0)[:many] for ring, many in zip(rings, edges, strict=True)]
        boxes = [(ring.min(axis=0), ring.max(axis=0)) for ring in rings]
        middle = [(low + high) / 2 for low, high in boxes]
        half = [
            radius or norms(*(high - low)) / 2
            for (_, radius, _), (low, high) in zip(parts, boxes, strict=True)
        ]
        self._local = np.vstack([np.empty((0, 2)), *middle, *starts, *ends]).T.copy()
        self._radius = np.array(half, dtype=float)
        self._owner = np.array([owner for _, _, owner in parts], dtype=int)
        of_edge = np.repeat(self._owner, edges)
        self._body = np.concatenate([self._owner, of_edge, of_edge])
        self._first, self._edges = (np.cumsum(edges) - edges).astype(float), edges.astype(float)
        middling = float(np.median(self._radius)) if len(parts) else 0.0
        wide = self._radius > WIDE * middling
        self._wide = int(wide.sum())
        self._largest = float(self._radius[~wide].max(initial=0.0))
        self._rank = np.where(wide, -inf, 0.0)

    def place(self, pose: Float) -> None:
        """Move all to the poses of their owners, (3, N); of the first, if they stand still."""
        of = np.maximum(self._body, 0)
        c, s = (each[of] for each in cosines_sines(pose[2]))
        x = pose[0][of] + c * self._local[0] - s * self._local[1]
        y = pose[1][of] + s * self._local[0] + c * self._local[1]
        things, corners = len(self._radius), (len(x) + len(self._radius)) // 2
        order = np.argsort(x[:things] + self._rank, kind="stable")
        self.taken.take(
            self._wide,
            self._largest,
            (x[:things][order], y[:things][order], self._radius[order]),
            self._owner[order].astype(float),
            (self._first[order], self._edges[order]),
            (x[things:corners], y[things:corners], x[corners:], y[corners:]),
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
