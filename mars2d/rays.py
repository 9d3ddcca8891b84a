"""Rays in pymunk's space: many at once through the engine's own function, with what each hits."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from itertools import repeat
from typing import Any

import numpy as np
import pymunk
from numpy.typing import ArrayLike, NDArray
from pymunk._chipmunk_cffi import ffi, lib

from mars2d.geometry import Point, length

__all__ = ["BODY", "SIGHT", "Rays", "end_bars"]

Float = NDArray[np.float64]
Int = NDArray[np.int64]

_HIT = np.dtype([("shape", np.uintp), ("point", float, 2), ("normal", float, 2), ("alpha", float)])
"""The engine's answer to one ray."""

_ALL = 0xFFFFFFFF

SIGHT = 1 << 31
"""The category of what only rays meet."""

BODY = _ALL & ~SIGHT
"""The categories of what bodies and rays meet."""

BAR = 1e-9
"""Half the length of a bar across the end of a wall, metres."""

AT_THE_END = 1e-9
"""What a ray hits so near to its end does not hide the end, metres."""


def end_bars(a: Point, b: Point) -> list[tuple[Point, Point]]:
    """Return two bars across the ends of a wall, so short that they count as points.

    A wall has no thickness, and the engine lets a ray that runs along it pass. It meets the bar.
    """
    dx, dy = b[0] - a[0], b[1] - a[1]
    apart = float(np.hypot(dx, dy))
    ux, uy = BAR * -dy / apart, BAR * dx / apart
    return [((x - ux, y - uy), (x + ux, y + uy)) for x, y in (a, b)]


class Rays:
    """Casts rays into a space.

    The engine's function is called once a ray, with nothing made anew in between: from the fourth
    ray on this is several times quicker than pymunk's method, which makes an object of each answer.
    """

    def __init__(self, space: pymunk.Space, bodies: Mapping[pymunk.Shape, int]) -> None:
        """Take the space, and the number of the body that each shape belongs to."""
        self._space: Any = space._space
        named = [(int(ffi.cast("uintptr_t", shape._shape)), body) for shape, body in bodies.items()]
        pairs = np.array(sorted(named), dtype=np.int64).reshape(-1, 2)
        self._address = np.ascontiguousarray(pairs[:, 0]).astype(np.uintp)
        self._body = np.ascontiguousarray(pairs[:, 1])
        self._start = ffi.new("cpVect *")
        self._filter = ffi.new("cpShapeFilter *", (0, _ALL, _ALL))
        self._reserve(64)

    def _reserve(self, count: int) -> None:
        """Make room for so many rays at once."""
        self._count = count
        self._keep = ends, hits = ffi.new("cpVect[]", count), ffi.new("cpSegmentQueryInfo[]", count)
        self._end_of = [ends[k] for k in range(count)]
        self._hit_of = [hits + k for k in range(count)]
        self._ends = np.frombuffer(ffi.buffer(ends), dtype=np.float64).reshape(-1, 2)
        self._hits = np.frombuffer(ffi.buffer(hits), dtype=_HIT)

    def _cast(self, start: Point, ends: Float, ignore: int) -> NDArray[np.void]:
        """Send rays from `start` to ends (k, 2), and return the engine's answers, (k,)."""
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
        return self._hits[:count]

    def distances(self, start: Point, angles: Float, reach: ArrayLike, ignore: int) -> Float:
        """Return how far rays at angles (k,) go, inf where nothing is hit; see Surroundings."""
        hits = self._cast(start, _ends(start, angles, reach), ignore)
        return np.where(hits["shape"] == 0, np.inf, hits["alpha"] * reach)

    def sight(
        self, start: Point, angles: Float, reach: ArrayLike, ignore: int, nothing: int
    ) -> tuple[Float, Int]:
        """Return how far rays go, and the bodies that they hit; see Surroundings."""
        hits = self._cast(start, _ends(start, angles, reach), ignore)
        none = hits["shape"] == 0
        distance = np.where(none, np.inf, hits["alpha"] * reach)
        return distance, np.where(none, nothing, self._bodies(hits))

    def hidden(
        self, start: Point, points: Float, bodies: ArrayLike, ignore: int
    ) -> NDArray[np.bool_]:
        """Return whether something stands before points (k, 2); see Surroundings."""
        points = np.asarray(points, dtype=float).reshape(-1, 2)
        hits = self._cast(start, points, ignore)
        apart = length(points[:, 0] - start[0] + 1j * (points[:, 1] - start[1]))
        before = (hits["shape"] != 0) & ((1 - hits["alpha"]) * apart > AT_THE_END)
        return np.asarray(before & (self._bodies(hits) != bodies))

    def _bodies(self, hits: NDArray[np.void]) -> Int:
        """Return the bodies of shapes; of no shape, any."""
        rows = np.searchsorted(self._address, hits["shape"])
        return self._body[np.minimum(rows, len(self._body) - 1)]


def _ends(start: Point, angles: Float, reach: ArrayLike) -> Float:
    reach = np.asarray(reach, dtype=float)
    return np.column_stack([start[0] + reach * np.cos(angles), start[1] + reach * np.sin(angles)])
