"""Collision: how close bodies are to each other and to obstacles, and when they may touch.

Points are complex numbers x + i y, in metres. Bodies are bounded by circles, which for discs are
the bodies themselves. Bodies of other shapes are compared in convex pieces when their circles are
near.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.rigid import Rigid
from mars2d.core.plane import Outline, edges_of
from mars2d.geometry.pair_list import Clearance, Close, DiscPairs, Walls
from mars2d.geometry.separation import ConvexPairs, Pieces

__all__ = ["Bounds", "Collisions"]

Float = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

RIM = 1e-3
"""A point of a polygon that is as near to its surface lies on it, metres."""


class Bounds:
    """The circles round the bodies of a world, and the edges of its obstacles.

    radius: (N,) of the circles; offset: (N,) from poses to their centres, in the bodies' frames;
    reach: (N,) of the bodies, from their poses.
    """

    def __init__(
        self,
        bodies: Sequence[Rigid],
        obstacles: Sequence[Outline],
        passing: Collection[tuple[int, int]],
    ) -> None:
        """Take the bodies, the obstacles, and pairs of bodies that pass through each other."""
        bounds = [body.shape.bound for body in bodies]
        self.radius = np.array([radius for _, radius in bounds])
        self.offset = np.array([complex(*center) for center, _ in bounds])
        self.reach = self.radius + np.hypot(self.offset.real, self.offset.imag)
        self._centred = not self.offset.any()
        self._is_disc = np.array([body.is_disc for body in bodies])
        self._only_discs = bool(self._is_disc.all())
        edges = [(*a, *b, k) for k, outline in enumerate(obstacles) for a, b in edges_of(outline)]
        x1, y1, x2, y2, obstacle = np.array(edges).reshape(-1, 5).T
        self._obstacle = obstacle.astype(np.intp)
        self._start, self._end = x1 + 1j * y1, x2 + 1j * y2
        self._walls = Walls(self._start, self._end - self._start)
        self.clearance = Clearance(self.radius, self._walls, passing)
        if not self._only_discs:
            self._set_pieces(bodies)

    @property
    def only_centred_discs(self) -> bool:
        """Whether all bodies are discs round their poses."""
        return self._centred and self._only_discs

    def shared(self) -> tuple[dict[str, NDArray[Any]], dict[str, float]]:
        """Return arrays and numbers of gaps for the kernel, by its names."""
        arrays, numbers = self.clearance.shared()
        return {**arrays, "obstacle": self._obstacle.astype(np.int32)}, numbers

    def _set_pieces(self, bodies: Sequence[Rigid]) -> None:
        """Keep the convex pieces of all bodies, in their frames, then the edges of obstacles."""
        pieces = [(i, piece) for i, body in enumerate(bodies) for piece in body.shape.pieces]
        vertices = [np.array([complex(*v) for v in piece.vertices]) for _, piece in pieces]
        vertices += [np.array(ends) for ends in zip(self._start, self._end, strict=True)]
        radius = [piece.radius for _, piece in pieces] + [0.0] * len(self._start)
        self._pieces = Pieces(vertices, np.array(radius))
        self._of_body: list[list[int]] = [[] for _ in bodies]
        for k, (i, _) in enumerate(pieces):
            self._of_body[i].append(k)
        self._first_edge = len(pieces)
        owner = [i for i, _ in pieces]
        self.owner = np.concatenate([owner, -1 - self._obstacle]).astype(np.intp)
        """The number of the body, or of the obstacle, to which each piece belongs."""

    def arm(self, theta: Float, who: Index | slice = slice(None)) -> Complex | None:
        """Return the vectors from poses at headings (k,) to the circles' centres; None: all 0."""
        if self._centred:
            return None
        offset, c, s = self.offset[who], np.cos(theta), np.sin(theta)
        x, y = offset.real, offset.imag
        return np.asarray(c * x - s * y + 1j * (s * x + c * y))

    def center(self, state: Float, who: Index | slice = slice(None)) -> Complex:
        """Return the centres of the circles of bodies with states (k, 6)."""
        position = np.asarray(state[:, 0] + 1j * state[:, 1])
        arm = self.arm(state[:, 2], who)
        return position if arm is None else position + arm

    def top_speed(self, velocity: Float, who: Index | slice = slice(None)) -> Float:
        """Return the highest speeds of the circles' centres at velocities (k, 3), m/s."""
        speed = np.hypot(velocity[:, 0], velocity[:, 1])
        if self._centred:
            return np.asarray(speed)
        offset = self.offset[who]
        return np.asarray(speed + np.hypot(offset.real, offset.imag) * np.abs(velocity[:, 2]))

    def collisions(self, who: Index, reach: float) -> Collisions:
        """Return all that bodies `who` (k,) may touch while their circles move by `reach` metres.

        They start where `clearance` was last told that they are.
        """
        close = self.clearance.close(who, reach)
        convex = None
        if not self._only_discs:
            i, j, body, segment = close
            disc = self._is_disc[who]
            pairs, walls = disc[i] & disc[j], disc[body]
            convex = self._convex(Close(i[~pairs], j[~pairs], body[~walls], segment[~walls]), who)
            close = Close(i[pairs], j[pairs], body[walls], segment[walls])
        discs = DiscPairs(self.radius[who], close, self._walls)
        return Collisions(self, who, discs, convex)

    def _convex(self, close: Close, who: Index) -> ConvexPairs | None:
        """Return the pairs of convex pieces of bodies, and of pieces and obstacles' edges."""
        mine = [self._of_body[i] for i in who]
        pairs = [
            (p, q)
            for i, j in zip(close.i.tolist(), close.j.tolist(), strict=True)
            for p in mine[i]
            for q in mine[j]
        ]
        pairs += [
            (p, self._first_edge + s)
            for i, s in zip(close.disc.tolist(), close.segment.tolist(), strict=True)
            for p in mine[i]
        ]
        if not pairs:
            return None
        local = np.full(len(self.radius) + 1, -1)
        local[who] = np.arange(len(who))
        body = local[np.maximum(self.owner, -1)]  # of the last, which is none, for obstacles
        first, second = np.array(pairs, dtype=np.intp).T
        return ConvexPairs(self._pieces, body, (first, second))

    def obstacle(self, segment: Index) -> Index:
        """Return the numbers of the obstacles that segments belong to."""
        return np.asarray(self._obstacle[segment])


class Collisions:
    """Some bodies, all that they may touch during the next step, and the gaps between them."""

    def __init__(
        self, bounds: Bounds, who: Index, discs: DiscPairs, convex: ConvexPairs | None
    ) -> None:
        """Take the bodies `who` (k,), and pairs of them by their numbers 0 to k - 1."""
        self._bounds, self._who = bounds, who
        self._discs, self._convex = discs, convex

    def measure(self, state: Float) -> None:
        """Take the bodies' states (k, 6) and measure all gaps."""
        position = state[:, 0] + 1j * state[:, 1]
        self._arm = self._bounds.arm(state[:, 2], self._who)
        self._discs.measure(position if self._arm is None else position + self._arm)
        self.any_touch = self._discs.any_touch
        if self._convex is not None:
            self._convex.measure(position, state[:, 2])
            self.any_touch |= self._convex.any_touch

    def touching(self) -> Mask:
        """Return which bodies touch something, (k,)."""
        touching = self._discs.touching()
        if self._convex is not None and self._convex.any_touch:
            ends = np.concatenate(self._convex.touching_bodies())
            touching[ends[ends >= 0]] = True
        return touching

    def touching_pairs(self) -> tuple[Index, Index]:
        """Return the pairs (a, b) that touch, by the numbers of the world's bodies.

        Obstacles are -1, -2, ...
        """
        i, j, disc, segment = self._discs.touching_pairs()
        who = self._who
        first = [who[i], who[disc]]
        second = [who[j], -1 - self._bounds.obstacle(segment)]
        if self._convex is not None and self._convex.any_touch:
            for piece, ends in zip(self._convex.pairs, (first, second), strict=True):
                ends.append(self._bounds.owner[piece[self._convex.touch]])
        return np.concatenate(first), np.concatenate(second)

    def grazing(self, depth: float) -> Iterator[tuple[int, int, complex]]:
        """Yield pairs a, b that touch, but less deep than this, with normals; see `touches`."""
        gap, normal = self._discs.gap_of_touching(), self._discs.normal_of_touching()
        if self._convex is not None and self._convex.any_touch:
            touch = self._convex.touch
            gap = np.concatenate([gap, self._convex.gap[touch]])
            normal = np.concatenate([normal, self._convex.normal[touch]])
        grazes = gap > -depth
        if grazes.any():
            a, b = self.touching_pairs()
            rows = (a[grazes], b[grazes], normal[grazes])
            yield from zip(*(row.tolist() for row in rows), strict=True)

    def inwards(self, velocity: Float) -> Float:
        """Return the highest speeds of bodies into others, (k,) m/s; velocity: (k, 3)."""
        fastest = np.full(len(self._who), -inf)
        touching = self._discs.touching_pairs()
        pairs = [
            (
                (np.concatenate([touching.i, touching.disc]), touching.j),
                self._discs.inwards(self._center_velocity(velocity)),
            )
        ]
        if self._convex is not None and self._convex.any_touch:
            speed = velocity[:, 0] + 1j * velocity[:, 1]
            inwards = self._convex.inwards(speed, velocity[:, 2], RIM)
            pairs.append((self._convex.touching_bodies(), inwards))
        for bodies, speeds in pairs:
            for body, speed in zip(bodies, speeds, strict=True):
                moves = body >= 0
                np.maximum.at(fastest, body[moves], speed[: len(body)][moves])
        return fastest

    def touches(self) -> tuple[Index, Index, Complex, Complex]:
        """Return who touches whom, where, and the normals: a, b, points and unit vectors, (m,).

        The order is that of `touching_pairs`.
        """
        a, b = self.touching_pairs()
        points, normals = ([part] for part in self._discs.touching_points())
        if self._convex is not None and self._convex.any_touch:
            points.append(self._convex.touching_points(RIM))
            normals.append(self._convex.normal[self._convex.touch])
        return a, b, np.concatenate(points), np.concatenate(normals)

    def time_to_touch(
        self, velocity: Float, bend: Float, depth: float, *, again: bool = True
    ) -> float:
        """Return for how long no pair gets deeper than `depth` metres, seconds.

        velocity: (k, 3). bend: (k,) m/s^2, how fast it may change. Without `again`, pairs that
        touch are left out.
        """
        center = self._center_velocity(velocity)
        spin = velocity[:, 2]
        swing = bend
        if self._arm is not None:
            swing = bend + spin**2 * np.hypot(self._arm.real, self._arm.imag)
        h = self._discs.time_to_touch(center, swing, depth, again=again)
        if self._convex is not None:
            speed = np.asarray(velocity[:, 0] + 1j * velocity[:, 1])
            h = min(h, self._convex.time_to_touch(speed, spin, bend, depth, again=again))
        return h

    def _center_velocity(self, velocity: Float) -> Complex:
        """Return the velocities of the circles' centres, (k,)."""
        speed = np.asarray(velocity[:, 0] + 1j * velocity[:, 1])
        if self._arm is None:
            return speed
        x, y = self._arm.real, self._arm.imag
        return np.asarray(speed + velocity[:, 2] * (-y + 1j * x))
