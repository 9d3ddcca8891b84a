"""The names of bodies in a figure, placed so that they don't overlap."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, hypot, sin
from typing import NamedTuple

import numpy as np

from mars2d.core.scene import INK, Arrow, Scene, Shape, Text
from mars2d.record.frame import Frame

__all__ = ["placed_names"]

LETTER = 0.6
"""The approximate width of a letter, in text heights."""

RINGS = 6
"""How many text heights a name may be away from its body."""

WAYS = [(0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0),
        (0.7, 0.7), (-0.7, 0.7), (0.7, -0.7), (-0.7, -0.7)]  # fmt: skip
"""Where a name may stand, as seen from its body: above at best."""


class Box(NamedTuple):
    """An upright rectangle by its centre and its half width and height, metres."""

    x: float
    y: float
    wide: float
    high: float

    def overlap(self, other: Box) -> float:
        """Return the area that two boxes share, square metres."""
        across = min(self.x + self.wide, other.x + other.wide) - max(
            self.x - self.wide, other.x - other.wide
        )
        up = min(self.y + self.high, other.y + other.high) - max(
            self.y - self.high, other.y - other.high
        )
        return max(across, 0.0) * max(up, 0.0)


def placed_names(
    names: Scene, frame: Frame, metres_per_point: float, view: Box, others: Sequence[Shape] = ()
) -> Scene:
    """Return the names of all bodies, each beside its body and away from the others.

    names: a text for each body; anything else stays where it is. A name that finds no room beside
    its body has a thin line to it. metres_per_point: how long a point of a text's height is. view:
    what the figure shows. others: arrows and texts that are there already.
    """
    bodies = [_bound(frame, i) for i in range(len(frame.scenario.bodies))]
    labels = [shape for shape in names.shapes if isinstance(shape, Text)]
    if len(labels) != len(bodies):
        return names
    scene = Scene([shape for shape in names.shapes if not isinstance(shape, Text)])
    taken = [_box_of(each, metres_per_point) for each in others if isinstance(each, (Arrow, Text))]
    for label, body in zip(labels, bodies, strict=True):
        wide, high = _half(label, metres_per_point)
        best = min(
            (_at(body, way, ring, wide, high) for ring in range(RINGS) for way in WAYS),
            key=lambda place: (_cost(place, taken, bodies, view), _distance(place, body)),
        )
        taken.append(best)
        if _distance(best, body) > body.wide + wide + 2 * high:
            scene.line([(body.x, body.y), (best.x, best.y)], stroke=INK, width=0.7)
        scene.shapes.append(
            Text((best.x, best.y), label.text, label.color, label.size, "center", label.halo)
        )
    return scene


def _half(label: Text, metres_per_point: float) -> tuple[float, float]:
    """Return half the width and height of a text, metres."""
    height = label.size * metres_per_point
    return 0.5 * LETTER * height * len(label.text), 0.6 * height


def _box_of(shape: Arrow | Text, metres_per_point: float) -> Box:
    """Return the box that an arrow or a text at the right of a point covers."""
    if isinstance(shape, Text):
        (x, y), (wide, high) = shape.position, _half(shape, metres_per_point)
        return Box(x + wide * (shape.anchor == "left"), y, wide, high)
    (x0, y0), (x1, y1) = shape.tail, shape.tip
    thick = 2 * shape.width * metres_per_point
    return Box((x0 + x1) / 2, (y0 + y1) / 2, abs(x1 - x0) / 2 + thick, abs(y1 - y0) / 2 + thick)


def _bound(frame: Frame, body: int) -> Box:
    """Return the box of the circle round a body."""
    x, y, theta = np.hstack([frame.pose, frame.prop_pose])[:, body].tolist()
    (ahead, left), radius = frame.scenario.bodies[body].shape.bound
    c, s = cos(theta), sin(theta)
    return Box(x + ahead * c - left * s, y + ahead * s + left * c, radius, radius)


def _at(body: Box, way: tuple[float, float], ring: int, wide: float, high: float) -> Box:
    """Return the box of a name that lies some rings away from its body."""
    gap = (2 * ring + 0.3) * high
    x = body.x + way[0] * (body.wide + gap + wide)
    y = body.y + way[1] * (body.high + gap + high)
    return Box(x, y, wide, high)


def _cost(place: Box, taken: list[Box], bodies: list[Box], view: Box) -> float:
    """Return how much of a place is not free; what covers another name counts most."""
    covered = 10 * sum(place.overlap(other) for other in taken)
    covered += sum(place.overlap(other) for other in bodies)
    outside = 4 * place.wide * place.high - place.overlap(view)
    return round(covered + 10 * outside, 12)


def _distance(place: Box, body: Box) -> float:
    return hypot(place.x - body.x, place.y - body.y)
