"""The gaps between the bodies of a scene, worked out from their poses alone.

This file imports numpy alone, as `scenes` does: other simulators are looked at by it as well.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]
Index = NDArray[np.intp]


class Gaps:
    """The gaps between a scene's bodies, n robots and p crates, and its fixed obstacles.

    A body or an obstacle is a rectangle about its pose, with a rim of some radius: a disc is a
    rectangle without size. A gap below 0 is an overlap: how far one has to be moved out. The gap of
    two rectangles that are apart may be stated too small, never too large; all others are exact.
    """

    def __init__(self, scene: Any) -> None:
        """Take a `Scene` of `scenes`."""
        boxes = np.array(scene.boxes, dtype=float).reshape(-1, 4, 2)
        along, across = boxes[:, 1] - boxes[:, 0], boxes[:, 3] - boxes[:, 0]
        self._boxes = np.column_stack([boxes.mean(axis=1), np.arctan2(along[:, 1], along[:, 0])])
        of_boxes = np.stack([np.hypot(*along.T), np.hypot(*across.T)]) / 2
        self._walls = scene.side / 2
        self._bodies = len(scene.half_sides)
        self._half = np.concatenate([np.array([scene.half_sides] * 2), of_boxes], axis=1)
        self._rim = np.concatenate([scene.rims, np.zeros(len(boxes))])
        self._reach = np.hypot(*self._half) + self._rim

    def __call__(self, pose: Float, within: float = 0.0) -> tuple[Float, Float]:
        """Return the gap of each body to the nearest other, and to walls and obstacles, metres.

        pose: (n + p, 3) of robots, then crates. within: larger gaps are returned as this one.
        """
        where = np.concatenate([pose, self._boxes])
        i, j = self._near(where, within)
        gap = self._gap(where, i, j)
        among, fixed = np.full((2, len(where)), within)
        both = j < self._bodies  # obstacles come last
        np.minimum.at(among, i[both], gap[both])
        np.minimum.at(among, j[both], gap[both])
        np.minimum.at(fixed, i[~both], gap[~both])
        n = self._bodies
        return among[:n], np.minimum(fixed[:n], self._to_walls(pose))

    def _near(self, where: Float, within: float) -> tuple[Index, Index]:
        """Return the pairs i < j of bodies, and of bodies and obstacles, that may be so near."""
        order = np.argsort(where[:, 0])
        x = where[order, 0]
        last = np.searchsorted(x, x + 2 * self._reach.max() + within, side="right")
        count = last - np.arange(len(x)) - 1
        first = np.repeat(np.arange(len(x)), count)
        second = first + 1 + np.arange(len(first)) - np.repeat(np.cumsum(count) - count, count)
        pair = order[first], order[second]
        i, j = np.minimum(*pair), np.maximum(*pair)
        apart = np.hypot(where[i, 0] - where[j, 0], where[i, 1] - where[j, 1])
        near = (i < self._bodies) & (apart <= self._reach[i] + self._reach[j] + within)
        return i[near], j[near]

    def _gap(self, where: Float, i: Index, j: Index) -> Float:
        """Return the gaps of pairs, by separating axes, or by the nearest corner."""
        axes = []
        for a, b in ((i, j), (j, i)):
            to, turn = where[b] - where[a], where[b, 2] - where[a, 2]
            c, s = np.cos(where[a, 2]), np.sin(where[a, 2])
            seen = np.abs([c * to[:, 0] + s * to[:, 1], c * to[:, 1] - s * to[:, 0]])
            axes.append(seen - self._half[:, a] - _extent(self._half[:, b], turn))
        corner = np.max([np.hypot(*np.maximum(along, 0)) for along in axes], axis=0)
        face = np.max(axes, axis=(0, 1))
        gap = np.where(face > 0, corner, face) - self._rim[i] - self._rim[j]
        return np.asarray(gap)

    def _to_walls(self, pose: Float) -> Float:
        """Return the gaps of bodies to the walls."""
        n = self._bodies
        reach = np.abs(pose[:, :2].T) + _extent(self._half[:, :n], pose[:, 2])
        return np.asarray(self._walls - reach.max(axis=0) - self._rim[:n])


def _extent(half: Float, angle: Float) -> Float:
    """Return how far turned rectangles with these half sides (2, m) reach along x and y, (2, m)."""
    c, s = np.abs(np.cos(angle)), np.abs(np.sin(angle))
    return np.stack([half[0] * c + half[1] * s, half[0] * s + half[1] * c])
