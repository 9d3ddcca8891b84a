"""Along walls, by a laser."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, pi
from typing import Any, ClassVar

import numpy as np

from mars2d.core.arithmetic import angle_of, cosines_sines
from mars2d.core.description import choice, number, text
from mars2d.core.interfaces import ScenarioLike
from mars2d.geometry.bearings import beam_angles
from mars2d.scenario.controllers.base import Command, Paced, steered
from mars2d.sensors.base import Float, Sensor, sight_angle
from mars2d.sensors.range_finder import RangeFinder

NEAR = 1.15
"""Beams up to this many times as long as the shortest one tell which way the wall is."""


class FollowWall(Paced):
    """Follows the nearest wall at a distance, by sensors alone; straight ahead until there is one.

    With e the distance to the nearest surface less `distance`, it heads along the surface, and
    atan(gain e) towards it. So along a straight wall e' = -v sin(atan(gain e)): for small e the
    error decays as exp(-v gain t). A drive that moves in the world's frame needs to know its
    heading as well.
    """

    title: ClassVar[str] = "along walls"

    needs: ClassVar[tuple[Sensor, ...]] = (RangeFinder(beams=72, range=2.0),)

    distance: float = number(
        default=0.5, above=0, high=1e3, unit="m", doc="from the sensor to the wall"
    )
    side: str = choice(default="left", of=("left", "right"), doc="the side of the wall")
    gain: float = number(
        default=3.0, above=0, high=100, unit="1/m", doc="how steeply it returns to its distance"
    )
    sensor: str = text(
        default="range_finder", doc="the name of its sensor, a RangeFinder or a SonarRing",
        names="sensor",
    )  # fmt: skip
    field_of_view: float = sight_angle(default=2 * pi, doc="that of its sensor")

    @property
    def reads(self) -> Sequence[str]:
        """The name of its sensor."""
        return (self.sensor,)

    def __call__(self, robot: Any) -> Command:
        """Return the command that goes along the wall; directions are from the robot's heading."""
        ranges = np.asarray(getattr(robot.sense, self.sensor))
        heading = float(robot.pose[2]) if robot.drive.frame == "world" else 0.0
        shortest = float(ranges.min(initial=inf))
        if shortest == inf:
            return steered(robot.drive, heading, heading, self.speed)
        angles = beam_angles(len(ranges), self.field_of_view)
        to_wall = _middle(angles, NEAR * shortest - ranges)
        sign = 1.0 if self.side == "left" else -1.0
        along = to_wall - sign * (pi / 2 - angle_of(self.gain * (shortest - self.distance), 1.0))
        return steered(robot.drive, heading, heading + along, self.speed)

    def want(self, scenario: ScenarioLike, index: int) -> str:
        """Return what a robot lacks to be moved by this law: a scanner."""
        if missing := super().want(scenario, index):
            return missing
        carried = scenario.robots[index].sensors
        sensor = next(each for each in carried if each.key == self.sensor)
        if getattr(sensor, "field_of_view", None) != self.field_of_view or sensor.fan is None:
            return "a scanner with the field of view of its law"
        return ""


def _middle(angles: Float, weights: Float) -> float:
    """Return the mean of angles (k,), weighted where the weights (k,) are positive."""
    c, s = cosines_sines(angles)
    weights = np.clip(weights, 0.0, None)
    return angle_of(float(weights @ s), float(weights @ c))
