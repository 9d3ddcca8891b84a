"""A rope pulls, and never pushes; a rod does both."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np

from mars2d.bodies.constraints import Constraint, FixedDistance, MaxDistance
from mars2d.bodies.joints.base import Float, Joint, beside
from mars2d.core.arithmetic import cosines_sines, norm
from mars2d.core.description import number
from mars2d.core.scene import Scene, faded

COLOR = "#7a5c2e"

STRAIGHT = 2e-3
"""A rope is drawn straight if its ends are apart by its length, less this share of it at most."""


class Rope(Joint):
    """A rope that does not stretch: it keeps two points no further apart than its length.

    It has no weight, and other things pass through it. A jerk on it is inelastic.
    """

    length: float | None = number(
        default=None, above=0, high=1e6, unit="m", optional=True,
        doc="its length; None: the distance of its ends at the start",
    )  # fmt: skip

    def constraints(self, apart: float) -> tuple[Constraint, ...]:
        """Return the largest distance of its ends."""
        return (MaxDistance(apart if self.length is None else self.length),)

    def draw(self, scene: Scene, start: Float, end: Float, length: float) -> None:
        """Draw a straight line, or while the rope is slack, a wave."""
        slack = length - float(norm(*(end - start))) > STRAIGHT * length
        points = _wave(start, end, length) if slack else [start, end]
        scene.line(points, stroke=faded(COLOR, 0.75) if slack else COLOR, width=2.0)
        for point in (start, end):
            scene.circle(point, 0.0, fill=COLOR, pixels=3.0)


def _wave(start: Float, end: Float, length: float) -> Float:
    """Return two periods of a wave that is as long as the rope [m], within a few percent."""
    apart = float(norm(*(end - start)))
    height = sqrt(max(length**2 - apart**2, 0.0)) / 8  # of a zigzag; a wave's is a little less
    height *= 1 - 0.1 * apart / length
    share = np.linspace(0.0, 1.0, 49)
    return beside(start, end, share, height * cosines_sines(4 * pi * share)[1])


class Rod(Joint):
    """A rigid rod without weight: it keeps two points at a distance, and turns freely at both."""

    length: float | None = number(
        default=None, above=0, high=1e6, unit="m", optional=True,
        doc="its length; None: the distance of its ends at the start",
    )  # fmt: skip

    def constraints(self, apart: float) -> tuple[Constraint, ...]:
        """Return the distance of its ends."""
        return (FixedDistance(apart if self.length is None else self.length),)
