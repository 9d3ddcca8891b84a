"""The room of a world's robots: who has left the workspace?"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.core.plane import ON_THE_EDGE, Outline, distance_to_ring, inside_polygon

Float = NDArray[np.float64]

ROUNDING = 1e-9
"""The rounding error of a distance to the edge, per metre plus one."""


class Room:
    """A workspace, which remembers how far each robot was from its edge.

    A robot that has gone less far since then can't have left it, so few are looked at closely.
    """

    def __init__(self, outline: Outline, robots: int) -> None:
        """Take the polygon, metres, and how many robots there are."""
        self._corners = np.array(outline)
        self._position = np.zeros((2, robots))  # where each one was looked at closely
        self._free = np.zeros(robots)  # the squares of the ways it can go from there, m^2

    def left(self, position: Float) -> list[int]:
        """Return the robots that are outside, by index; the edge is inside.

        position: of all robots, (2, n) metres.
        """
        way = position - self._position
        way *= way
        stays = way[0] + way[1] < self._free
        if np.count_nonzero(stays) == stays.size:
            return []
        who = np.flatnonzero(~stays)
        x, y = there = position[:, who]
        gap = distance_to_ring(x, y, self._corners)
        outside = ~inside_polygon(x, y, self._corners)
        self._position[:, who] = there
        free = np.where(outside, 0.0, np.maximum(gap - ROUNDING * (1 + gap), 0.0))
        self._free[who] = free * free
        return [int(i) for i in who[outside & (gap > ON_THE_EDGE)]]
