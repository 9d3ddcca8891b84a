"""At random, away from obstacles."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from math import pi
from typing import Any, ClassVar

import numpy as np

from mars2d.core.description import number, text
from mars2d.scenario.controllers.base import Command, Paced, gone
from mars2d.sensors.base import Sensor
from mars2d.sensors.proximity import Proximity

HALF = pi / 3
"""A drive that moves in any direction turns round, and up to this much to either side, radians."""


class Wander(Paced):
    """Goes straight on until something is near, backs off in a bend at random, and goes on.

    It backs for a time that is even in (turn / 2, 3 turn / 2), to a side at random. A drive that
    moves in any direction turns round instead, off by an angle that is even in +-60 degrees.
    """

    title: ClassVar[str] = "at random"

    needs: ClassVar[tuple[Sensor, ...]] = (Proximity(range=0.4, field_of_view=2.0),)

    turn: float = number(default=1.5, above=0, high=1e3, unit="s", doc="mean time of backing off")
    sensor: str = text(
        default="proximity", doc="the name of its sensor, a Proximity or a Bumper", names="sensor"
    )

    @property
    def reads(self) -> Sequence[str]:
        """The name of its sensor."""
        return (self.sensor,)

    def __call__(self, robot: Any) -> Generator[Command]:
        """Yield the commands."""
        drive, rng, way = robot.drive, robot.rng, 0.0
        share = min(self.speed / drive.max_linear_speed, 1.0)
        free = drive.holonomic or drive.frame == "world"
        while True:
            ahead = gone(drive, way, self.speed) if free else drive.steered(0.0, share)
            while not np.any(getattr(robot.sense, self.sensor)):
                yield ahead
            if free:
                way += pi + rng.uniform(-HALF, HALF)
                back = gone(drive, way, self.speed)
            else:
                back = drive.steered(rng.choice((-1.0, 1.0)), -share)
            for _ in range(max(round(rng.uniform(0.5, 1.5) * self.turn / robot.sampling_time), 1)):
                yield back
