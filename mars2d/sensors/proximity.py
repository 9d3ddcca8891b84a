"""Whether something is close: the sensor of the paper's Algorithm 2."""

from __future__ import annotations

from math import cos, hypot, pi, sin
from typing import Any, ClassVar

import numpy as np

from mars2d.core.description import number
from mars2d.core.interfaces import RobotLike
from mars2d.core.scene import Scene, faded
from mars2d.sensors.base import FLAG, Float, Quantity, Sensor, Surroundings, sight_angle

__all__ = ["Proximity"]


class Proximity(Sensor):
    """Tells whether an obstacle or another robot is within range and field of view.

    The reading is True or False. range: metres from the sensor, which sits at the robot's pose (not
    at its rim) unless it is mounted elsewhere. field_of_view: radians, centred on the heading, 2 pi
    by default. The nearest point of each surface counts, so nothing slips between beams.
    Source: Casini & Garulli (2016), section 4.
    """

    quantities: ClassVar[tuple[Quantity, ...]] = (FLAG,)

    range: float = number(above=0, high=1e6, unit="m", doc="how far it sees, from its mount")
    field_of_view: float = sight_angle(default=2 * pi, doc="the angle it sees, about the heading")

    def read(self, robot: RobotLike, world: Surroundings, rng: np.random.Generator) -> bool:  # noqa: ARG002
        """Return whether something is within range and field of view."""
        x, y, theta = self.placed(robot.pose).tolist()
        me = robot.index
        if self.field_of_view >= 2 * pi:
            return world.distance((x, y), self.range, me) < self.range
        half = self.field_of_view / 2
        # All surfaces are convex pieces: their point nearest to us within the sector is either the
        # nearest of all, or lies where an edge of the sector first meets them.
        c, s = cos(theta), sin(theta)
        for px, py in world.nearby((x, y), self.range, me):
            ahead, left = c * (px - x) + s * (py - y), c * (py - y) - s * (px - x)
            if ahead >= hypot(ahead, left) * cos(half):
                return True
        edges = (theta - half, theta + half)
        return any(world.ray((x, y), edge, self.range, me) <= self.range for edge in edges)

    def draw(self, scene: Scene, pose: Float, reading: Any, color: str) -> None:
        """Draw the field of view, filled while something is seen."""
        scene.sector(
            self.placed(pose),
            self.range,
            self.field_of_view,
            fill=faded("#d55e00" if reading else color, 0.22 if reading else 0.07),
            stroke=faded("#d55e00" if reading else color, 0.8 if reading else 0.3),
        )
