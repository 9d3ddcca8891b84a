"""Position and heading, as a GPS and a compass give them."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from mars2d.core.interfaces import RobotLike
from mars2d.core.quantity import Quantity
from mars2d.core.scene import Scene
from mars2d.geometry.dead_reckoning import draw_pose
from mars2d.sensors.base import Float, Sensor
from mars2d.sensors.surroundings import Surroundings


class Pose(Sensor):
    """Measures its own pose in the world: x [m], y [m], theta [rad], as a GPS and a compass do.

    The reading is an array (3,), nan when lost. It is the pose of the mount: with the default one,
    that of the robot. theta is not wrapped, as in ``robot.pose``. `noise` is white: one number for
    each, such as ``noise=(0.5, 0.5, 0.05)``.

    Source: Siegwart, Nourbakhsh and Scaramuzza, Introduction to Autonomous Mobile Robots (2011),
    sections 4.1.4 and 4.1.5.
    """

    quantities: ClassVar[tuple[Quantity, ...]] = (
        Quantity("x", "m"),
        Quantity("y", "m"),
        Quantity("theta", "rad"),
    )

    def read(self, robot: RobotLike, world: Surroundings, rng: np.random.Generator) -> Float:  # noqa: ARG002
        """Return the pose (3,) of the mount."""
        return self.placed(robot.pose)

    def draw(self, scene: Scene, pose: Float, reading: Any, color: str) -> None:  # noqa: ARG002
        """Draw a ring at the measured position, with the heading."""
        draw_pose(scene, reading, color)
