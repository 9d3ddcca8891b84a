"""Rays in pymunk's space, many at once by the engine's own function, and their hits."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from itertools import repeat
from math import inf
from typing import Any

import numpy as np
import pymunk
from numpy.typing import ArrayLike, NDArray
from pymunk import batch
from pymunk._chipmunk_cffi import ffi, lib

from mars2d.core.arithmetic import cosines_sines, norm, norms
from mars2d.core.plane import WITHIN, Point, up_to
from mars2d.geometry.ray_casting import CORNER

Float = NDArray[np.float64]
Int = NDArray[np.int64]
Addresses = NDArray[np.uintp]

_HIT = np.dtype(
    [("shape", np.uintp), ("point", float, 2), ("normal", float, 2), ("alpha", float)], align=True
)
"""The engine's answer to one ray."""

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
    """Casts rays into a space.

    The engine's function is called once for each ray, and no objects are made in between. From the
    fourth ray on this is several times faster than pymunk's method, which makes an object of each
    answer.
    """

    def __init__(self, space: pymunk.Space, bodies: Mapping[pymunk.Shape, int]) -> None:
        """Take the space, and the number of the body that each shape belongs to."""
        self._public = space
        self._bodies_of = bodies
        self._space: Any = space._space
        named = [(int(ffi.cast("uintptr_t", shape._shape)), body) for shape, body in bodies.items()]
        pairs = np.array(sorted(named), dtype=np.int64).reshape(-1, 2)
        self._address = np.ascontiguousarray(pairs[:, 0]).astype(np.uintp)
        self._body = np.ascontiguousarray(pairs[:, 1])
        self._start = ffi.new("cpVect *")
        self._filter = ffi.new("cpShapeFilter *", (0, _ALL, _ALL))
        self._reserve(64)
        corners = [
            (body, address, corner)
            for (shape, body), (address, _) in zip(bodies.items(), named, strict=True)
            if isinstance(shape, pymunk.Poly)
            for corner in shape.get_vertices()
        ]
        self._corner_body = np.array([body for body, _, _ in corners], dtype=np.int64)
        self._corner_shape = np.array([address for _, address, _ in corners], dtype=np.uintp)
        self._corner = np.array([corner for _, _, corner in corners]).reshape(-1, 2)
        self._pose_buffer = batch.Buffer()

    def _reserve(self, count: int) -> None:
        """Make room for this many rays at once."""
        self._count = count
        self._keep = ends, hits = ffi.new("cpVect[]", count), ffi.new("cpSegmentQueryInfo[]", count)
        self._end_of = [ends[k] for k in range(count)]
        self._hit_of = [hits + k for k in range(count)]
        self._ends = np.frombuffer(ffi.buffer(ends), dtype=np.float64).reshape(-1, 2)
        answers = np.frombuffer(ffi.buffer(hits), dtype=_HIT)
        self._shape, self._alpha = answers["shape"], answers["alpha"]
        self._normal_x, self._normal_y = answers["normal"].T

    def _cast(self, start: Point, ends: Float, ignore: int) -> tuple[Addresses, Float]:
        """Send rays from `start` to ends (k, 2); see `_sweep`."""
        count = len(ends)
        if count > self._count:
            self._reserve(2 * count)
        self._ends[:count] = ends
        self._start.x, self._start.y = start
        self._filter.group = ignore + 1
        answers = map(
            lib.cpSpaceSegmentQueryFirst,
            repeat(self._space, count),
            repeat(self._start[0]),
            self._end_of,
            repeat(0.0),
            repeat(self._filter[0]),
            self._hit_of,
        )
        deque(answers, maxlen=0)
        return self._shape[:count], self._alpha[:count]

    def _sweep(
        self, start: Point, angles: Float, reach: ArrayLike, ignore: int
    ) -> tuple[Addresses, Float]:
        """Send rays at angles (k,); return the shapes they hit, 0 if none, and the distances."""
        far = np.asarray(reach, dtype=float)
        c, s = cosines_sines(angles)
        ends = np.empty((len(angles), 2))
        np.add(start[0], far * c, out=ends[:, 0])
        np.add(start[1], far * s, out=ends[:, 1])
        return self._met(start, (c, s), far, ends, ignore)

    def _met(
        self, start: Point, way: tuple[Float, Float], far: Float, ends: Float, ignore: int
    ) -> tuple[Addresses, Float]:
        """Return the shapes that rays hit, 0 if none, and the distances, (k,) each.

        way: their directions, two (k,). far: their lengths, (k,) or one. ends: (k, 2).
        """
        shapes, alpha = self._cast(start, ends, ignore)
        distance = np.asarray(alpha * far)
        hit = shapes != 0
        distance[~hit] = np.inf
        c, s = way
        count = len(ends)
        along = np.abs(self._normal_x[:count] * c + self._normal_y[:count] * s) < GRAZING
        for k in np.flatnonzero(along & hit).tolist():
            shapes[k], distance[k] = self._grazing(start, (c[k], s[k]), ends[k], ignore)
        if len(self._corner):
            self._meet_corners(start, way, far, ignore, shapes, distance)
        return shapes, distance

    def _meet_corners(
        self,
        start: Point,
        way: tuple[Float, Float],
        far: Float,
        ignore: int,
        shapes: Addresses,
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
        beside = offset @ np.array(way)  # rounding depends on the processor: checked again below
        reach = CORNER * (1 + apart[near])
        for row in np.flatnonzero(np.abs(beside).min(axis=1, initial=inf) < 2 * reach).tolist():
            x, y = float(dx[near[row]]), float(dy[near[row]])
            for k in np.flatnonzero(np.abs(beside[row]) < 2 * reach[row]).tolist():
                c, s = float(way[0][k]), float(way[1][k])
                along, most = x * c + y * s, float(far[k] if far.ndim else far)
                aimed = abs(y * c - x * s) < reach[row] and 0 <= along <= most
                if aimed and along < distance[k]:
                    shapes[k], distance[k] = self._corner_shape[near[row]], along

    def _grazing(self, start: Point, way: Point, end: Float, ignore: int) -> tuple[int, float]:
        """Return the shape that a ray along an edge hits, and the distance.

        The engine divides two rounding errors if a ray lies in an edge. Such a ray meets the edge's
        near end. way: its direction.
        """
        own = pymunk.ShapeFilter(group=ignore + 1)
        reach = float(norm(end[0] - start[0], end[1] - start[1]))
        found = [(inf, 0, 0)]
        for info in self._public.segment_query(start, (float(end[0]), float(end[1])), 0.0, own):
            shape = info.shape
            assert shape is not None
            distance = info.alpha * reach
            if info.alpha > 0 and not isinstance(shape, pymunk.Circle):
                corners = [point for point in _corners(shape) if _beside(start, way, point) < BAR]
                if len(corners) > 1:
                    distance = _nearest_ahead(start, way, corners)
            address = int(ffi.cast("uintptr_t", shape._shape))
            found.append((distance, self._bodies_of[shape], address))
        distance, _, address = min(found)
        return address, distance

    def distances(self, start: Point, angles: Float, reach: ArrayLike, ignore: int) -> Float:
        """Return the lengths of rays at angles (k,), inf where nothing is hit; see Surroundings."""
        far = np.multiply(WITHIN, reach)
        return up_to(self._sweep(start, angles, far, ignore)[1], reach)

    def hidden(
        self, start: Point, points: Float, bodies: ArrayLike, ignore: int
    ) -> NDArray[np.bool_]:
        """Return whether something stands before points (k, 2); see Surroundings."""
        points = np.asarray(points, dtype=float).reshape(-1, 2)
        dx, dy = points[:, 0] - start[0], points[:, 1] - start[1]
        apart = norms(dx, dy)
        unit = np.where(apart > 0, apart, 1.0)
        shapes, distance = self._met(start, (dx / unit, dy / unit), apart, points, ignore)
        before = apart - distance > AT_THE_END
        return np.asarray(before & (self._bodies(shapes) != bodies))

    def _bodies(self, shapes: Addresses) -> Int:
        """Return the bodies of shapes; of no shape, any."""
        rows = np.searchsorted(self._address, shapes)
        return self._body[np.minimum(rows, len(self._body) - 1)]


def _corners(shape: pymunk.Shape) -> list[Point]:
    """Return the ends of a segment, or the corners of a polygon, in the world."""
    assert isinstance(shape, (pymunk.Segment, pymunk.Poly))
    local = [shape.a, shape.b] if isinstance(shape, pymunk.Segment) else shape.get_vertices()
    assert shape.body is not None
    return [(x, y) for x, y in map(shape.body.local_to_world, local)]


def _beside(start: Point, way: Point, point: Point) -> float:
    """Return how far a point lies beside a ray."""
    return abs(way[0] * (point[1] - start[1]) - way[1] * (point[0] - start[0]))


def _nearest_ahead(start: Point, way: Point, points: list[Point]) -> float:
    """Return how far along a ray the nearest of some points lies; inf if they lie behind."""
    along = [way[0] * (x - start[0]) + way[1] * (y - start[1]) for x, y in points]
    return inf if max(along) < 0 else max(min(along), 0.0)
