"""Whether something is close: the sensor of the paper's Algorithm 2."""

from __future__ import annotations

from math import pi
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arithmetic import cosine_sine, norm
from mars2d.core.description import number
from mars2d.core.interfaces import RobotLike
from mars2d.core.plane import WITHIN
from mars2d.core.quantity import FLAG, Quantity
from mars2d.core.scene import Scene, faded
from mars2d.sensors.base import Float, Scanner, sight_angle
from mars2d.sensors.surroundings import Surroundings


class Proximity(Scanner):
    """Tells whether an obstacle or another robot is within range and field of view.

    The reading is True or False. range: metres from the sensor, which sits at the robot's pose (not
    at its rim) unless it is mounted elsewhere. field_of_view: radians, centred on the heading, 2 pi
    by default. The nearest point of each surface counts, so nothing slips between beams.
    Source: Casini & Garulli (2016), section 4.
    """

    quantities: ClassVar[tuple[Quantity, ...]] = (FLAG,)
    stays: ClassVar[bool] = False

    range: float = number(above=0, high=1e6, unit="m", doc="its range, from its mount")
    field_of_view: float = sight_angle(default=2 * pi, doc="the angle it sees, about the heading")

    def read(self, robot: RobotLike, world: Surroundings, rng: np.random.Generator) -> bool:
        """Return whether something is within range and field of view."""
        return bool(super().read(robot, world, rng))

    def scan(self, poses: Float, robots: list[int], world: Surroundings) -> NDArray[np.bool_]:
        """Return whether something is within range and field of view of each robot, (m,)."""
        each, reach = zip(poses.T.tolist(), robots, strict=True), self.range
        if self.field_of_view < 2 * pi:
            return np.array([self._sees(world, x, y, to, me) for (x, y, to), me in each])
        return np.array([world.distance((x, y), reach, me) <= reach for (x, y, _), me in each])

    def _sees(self, world: Surroundings, x: float, y: float, theta: float, me: int) -> bool:
        """Return whether something is within the sector that a robot sees."""
        half = WITHIN * self.field_of_view / 2
        # All surfaces are convex pieces: their point nearest to us within the sector is either the
        # nearest of all, or lies where an edge of the sector first meets them.
        c, s = cosine_sine(theta)
        for px, py in world.nearby((x, y), self.range, me):
            ahead, left = c * (px - x) + s * (py - y), c * (py - y) - s * (px - x)
            if ahead >= norm(ahead, left) * cosine_sine(half)[0]:
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
