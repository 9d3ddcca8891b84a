"""A ring of switches that tell on which side the robot was touched."""

from __future__ import annotations

from collections import deque
from functools import cached_property
from math import floor, pi
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arithmetic import angle_of
from mars2d.core.description import integer, number
from mars2d.core.interfaces import RobotLike
from mars2d.core.plane import WITHIN
from mars2d.core.quantity import FLAG, Quantity
from mars2d.core.scene import Scene, arc, faded
from mars2d.sensors.base import Float, Sensor, sight_angle
from mars2d.sensors.surroundings import Surroundings

LIT = "#d55e00"
"""The colour of a set flag."""


class Bumper(Sensor):
    """Tells in which sectors the robot has been touched since the last measurement.

    The reading is an array (sectors,) of True and False. The sectors share the field of view
    evenly, from the right to the left of the heading: two over pi are the right and the left side
    of the front. Over a full circle the first one is in the middle of the back: four are back,
    right, front and left. The bearing of the point of contact from the sensor counts, so it is best
    mounted in the middle of the robot.

    >>> Bumper(sectors=2, field_of_view=3.0).angles.tolist()
    [-0.75, 0.75]
    >>> Bumper(sectors=4).angles.round(2).tolist()
    [-3.14, -1.57, 0.0, 1.57]
    """

    quantities: ClassVar[tuple[Quantity, ...]] = (FLAG,)

    sectors: int = integer(default=4, low=1, high=10_000, doc="the number of sectors")
    field_of_view: float = sight_angle(default=2 * pi, doc="the angle that the sectors divide")
    radius: float = number(
        default=0.15, above=0, high=1e6, unit="m",
        doc="radius of the chassis that is drawn around its mount",
    )  # fmt: skip

    @cached_property
    def angles(self) -> Float:
        """The bearings of the sectors' middles (sectors,): radians from the sensor's heading."""
        first = 0.0 if self.field_of_view >= 2 * pi else 0.5
        angles = ((np.arange(self.sectors) + first) / self.sectors - 0.5) * self.field_of_view
        angles.flags.writeable = False
        return angles

    def on_start(self, robot: RobotLike, world: Surroundings, rng: np.random.Generator) -> None:  # noqa: ARG002
        """Begin untouched."""
        self._pose = robot.pose
        self._touches: deque[NDArray[np.bool_]] = deque(maxlen=self.period(world.sampling_time))

    def on_step(self, robot: RobotLike, world: Surroundings, rng: np.random.Generator) -> None:  # noqa: ARG002
        """Note in which sectors the robot was touched in the last control step."""
        touched = np.zeros(self.sectors, dtype=bool)
        step = world.sampling_time
        for contact in robot.contacts:
            # The point is where it was then: so must be the robot.
            share = min(max(1 - (world.time - float(contact["time"])) / step, 0.0), 1.0)
            pose = self.placed((1 - share) * self._pose + share * robot.pose)
            (px, py), (x, y, theta) = contact["point"].tolist(), pose.tolist()
            bearing = (angle_of(py - y, px - x) - theta + pi) % (2 * pi) - pi
            if abs(bearing) <= WITHIN * self.field_of_view / 2:
                width = self.field_of_view / self.sectors
                sector = floor((bearing - float(self.angles[0])) / width + 0.5)
                # The left end of all belongs to the last one, or to the first of a full circle.
                full, last = self.field_of_view >= 2 * pi, self.sectors - 1
                touched[sector % self.sectors if full else min(max(sector, 0), last)] = True
        self._pose = robot.pose
        self._touches.append(touched)

    def read(
        self,
        robot: RobotLike,  # noqa: ARG002
        world: Surroundings,  # noqa: ARG002
        rng: np.random.Generator,  # noqa: ARG002
    ) -> NDArray[np.bool_]:
        """Return which sectors (sectors,) were touched since the last measurement."""
        return np.asarray(np.any(self._touches, axis=0))

    def draw(self, scene: Scene, pose: Float, reading: Any, color: str) -> None:
        """Draw the sectors as arcs round the robot, lit where it was touched."""
        x, y, theta = self.placed(pose).tolist()
        width = 0.92 * self.field_of_view / self.sectors  # a gap parts it from the next
        for angle, touched in zip(theta + self.angles, np.asarray(reading).tolist(), strict=True):
            stroke, thick = (LIT, 4.0) if touched else (faded(color, 0.45), 1.5)
            points = arc((x, y, angle), 1.15 * self.radius, width)
            scene.line(points, stroke=stroke, width=thick)
