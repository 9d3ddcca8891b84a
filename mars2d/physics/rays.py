"""Rays in pymunk's space: the engine's answers, and what rounding hides from it."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf
from typing import Any

import numpy as np
import pymunk
from numpy.typing import ArrayLike, NDArray
from pymunk import batch
from pymunk._chipmunk_cffi import ffi, lib

from mars2d.core.arithmetic import cosine_sine, cosines_sines, norm, norms
from mars2d.core.plane import WITHIN, Point, up_to
from mars2d.geometry.ray_casting import CORNER

Float = NDArray[np.float64]

POSE = batch.BodyFields.POSITION | batch.BodyFields.ANGLE

_ALL = 0xFFFFFFFF

SIGHT = 1 << 31
"""The category of shapes that only rays meet."""

BODY = _ALL & ~SIGHT
"""The categories of shapes that bodies and rays meet."""

BAR = 1e-9
"""Half the length of a bar across the end of a wall, metres."""

GRAZING = 1e-7
"""A ray at a smaller angle to an edge is checked again, rad: rounding decides where it hits."""

AT_THE_END = 1e-9
"""A surface as near to the end of a ray does not hide the end, metres."""


def end_bars(a: Point, b: Point) -> list[tuple[Point, Point]]:
    """Return two bars across the ends of a wall, so short that they count as points.

    A wall has no thickness, so the engine lets a ray along it pass. Such a ray meets the bar.
    """
    dx, dy = b[0] - a[0], b[1] - a[1]
    apart = float(norm(dx, dy))
    ux, uy = BAR * -dy / apart, BAR * dx / apart
    return [((x - ux, y - uy), (x + ux, y + uy)) for x, y in (a, b)]


class Rays:
    """Casts rays into a space, by the engine's function, without pymunk's object of each answer."""

    def __init__(self, space: pymunk.Space, bodies: Mapping[pymunk.Shape, int]) -> None:
        """Take the space, and the number of the body that each shape belongs to."""
        self._public = space
        self._space: Any = space._space
        self._body_of = {shape._shape: body for shape, body in bodies.items()}
        self._filter = ffi.new("cpShapeFilter *", (0, _ALL, _ALL))
        self._hit = ffi.new("cpSegmentQueryInfo *")
        corners = [
            (body, corner)
            for shape, body in bodies.items()
            if isinstance(shape, pymunk.Poly)
            for corner in shape.get_vertices()
        ]
        self._corner_body = np.array([body for body, _ in corners], dtype=np.int64)
        self._corner = np.array([corner for _, corner in corners]).reshape(-1, 2)
        self._pose_buffer = batch.Buffer()

    def length(self, start: Point, angle: float, reach: float, ignore: int) -> float:
        """Return the length of a ray, inf where nothing is hit; see Surroundings."""
        far = WITHIN * reach
        c, s = cosine_sine(angle)
        end = start[0] + far * c, start[1] + far * s
        ways = np.array([c]), np.array([s])
        (distance,), _ = self._met(start, ways, np.array([far]), [end], ignore)
        return float(up_to(distance, reach))

    def hidden(
        self, start: Point, points: Float, bodies: ArrayLike, ignore: int
    ) -> NDArray[np.bool_]:
        """Return whether something stands before points (k, 2); see Surroundings."""
        points = np.asarray(points, dtype=float).reshape(-1, 2)
        dx, dy = points[:, 0] - start[0], points[:, 1] - start[1]
        apart = norms(dx, dy)
        unit = np.where(apart > 0, apart, 1.0)
        ways = dx / unit, dy / unit
        distance, met = self._met(start, ways, apart, points.tolist(), ignore)
        return np.asarray((apart - distance > AT_THE_END) & (np.asarray(met) != bodies))

    def _met(
        self, start: Point, ways: tuple[Float, Float], far: Float, ends: list[Any], ignore: int
    ) -> tuple[Float, list[int]]:
        """Return how far rays go, inf where they meet nothing, and the bodies that they meet, or 0.

        ways: their directions, two (k,). far: their lengths (k,). ends: k of them.
        """
        self._filter.group = ignore + 1
        hit, own = self._hit, self._filter[0]
        distance, met = np.full(len(ends), inf), [0] * len(ends)
        for k, end in enumerate(ends):
            if not lib.cpSpaceSegmentQueryFirst(self._space, start, end, 0.0, own, hit):
                continue
            way = float(ways[0][k]), float(ways[1][k])
            if abs(hit.normal.x * way[0] + hit.normal.y * way[1]) < GRAZING:
                distance[k], met[k] = self._grazing(start, way, end, ignore)
            else:
                distance[k], met[k] = hit.alpha * far[k], self._body_of[hit.shape]
        if len(self._corner):
            self._meet_corners(start, ways, far, ignore, met, distance)
        return distance, met

    def _meet_corners(
        self,
        start: Point,
        ways: tuple[Float, Float],
        far: Float,
        ignore: int,
        met: list[int],
        distance: Float,
    ) -> None:
        """Let rays that are aimed at corners of bodies meet them.

        The engine checks each side of a polygon by itself: by rounding, such a ray may miss both.
        """
        buffer = self._pose_buffer
        buffer.clear()
        batch.get_space_bodies(self._public, POSE, buffer)
        pose = np.frombuffer(buffer.float_buf(), dtype=np.float64).reshape(-1, 3)
        at_x, at_y, angle = pose[self._corner_body].T
        turn_c, turn_s = cosines_sines(angle)
        dx = at_x + turn_c * self._corner[:, 0] - turn_s * self._corner[:, 1] - start[0]
        dy = at_y + turn_s * self._corner[:, 0] + turn_c * self._corner[:, 1] - start[1]
        apart = norms(dx, dy)
        near = np.flatnonzero((apart <= far.max(initial=0.0)) & (self._corner_body != ignore))
        offset = np.column_stack([dy[near], -dx[near]])
        beside = offset @ np.array(ways)  # rounding depends on the processor: checked again below
        reach = CORNER * (1 + apart[near])
        for row, k in np.argwhere(np.abs(beside) < 2 * reach[:, None]).tolist():
            x, y = float(dx[near[row]]), float(dy[near[row]])
            c, s = float(ways[0][k]), float(ways[1][k])
            along = x * c + y * s
            aimed = abs(y * c - x * s) < reach[row] and 0 <= along <= far[k]
            if aimed and along < distance[k]:
                distance[k], met[k] = along, int(self._corner_body[near[row]])

    def _grazing(self, start: Point, way: Point, end: Point, ignore: int) -> tuple[float, int]:
        """Return the distance to what a ray along an edge meets, and its body.

        The engine divides two rounding errors if a ray lies in an edge. Such a ray meets the edge's
        near end. way: its direction.
        """
        own = pymunk.ShapeFilter(group=ignore + 1)
        reach = float(norm(end[0] - start[0], end[1] - start[1]))
        found = [(inf, 0)]
        for info in self._public.segment_query(start, (end[0], end[1]), 0.0, own):
            shape = info.shape
            assert shape is not None
            distance = info.alpha * reach
            if info.alpha > 0 and not isinstance(shape, pymunk.Circle):
                ways = [(x - start[0], y - start[1]) for x, y in _corners(shape)]
                along = [
                    way[0] * x + way[1] * y for x, y in ways if abs(way[0] * y - way[1] * x) < BAR
                ]
                if len(along) > 1:
                    distance = inf if max(along) < 0 else max(min(along), 0.0)
            found.append((distance, self._body_of[shape._shape]))
        return min(found)


def _corners(shape: pymunk.Shape) -> list[Point]:
    """Return the ends of a segment, or the corners of a polygon, in the world."""
    assert isinstance(shape, (pymunk.Segment, pymunk.Poly))
    local = [shape.a, shape.b] if isinstance(shape, pymunk.Segment) else shape.get_vertices()
    assert shape.body is not None
    return [(x, y) for x, y in map(shape.body.local_to_world, local)]
