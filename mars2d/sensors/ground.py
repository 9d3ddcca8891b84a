"""The colour of the floor beneath the robot, to follow lines and to find places."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from mars2d.core.errors import LawError, shown
from mars2d.core.interfaces import RobotLike
from mars2d.core.quantity import COLOR, Quantity
from mars2d.core.scene import Scene, color_of
from mars2d.sensors.base import Float, Sensor
from mars2d.sensors.surroundings import Surroundings


class Ground(Sensor):
    """Measures the colour of the floor beneath its mount: red, green and blue from 0 to 1.

    The reading is an array (3,). The floor is white where no add-on gives it a colour; the add-on
    Floor does. The sensor looks at one point, and sees the floor beneath robots, props and
    obstacles.
    """

    quantities: ClassVar[tuple[Quantity, ...]] = (COLOR,)

    def read(self, robot: RobotLike, world: Surroundings, rng: np.random.Generator) -> Float:  # noqa: ARG002
        """Return red, green and blue, (3,), from 0 to 1."""
        x, y, _ = self.placed(robot.pose).tolist()
        found = world.ground((x, y))
        try:
            color = np.array(found, dtype=float)
        except (TypeError, ValueError):
            color = np.empty(0)
        if color.shape != (3,) or not ((color >= 0) & (color <= 1)).all():
            raise LawError(
                f"the floor at ({x:.3g}, {y:.3g}) is {shown(found)}: expected of ground(point) of "
                "an add-on: red, green and blue from 0 to 1, or None"
            )
        return color

    def draw(self, scene: Scene, pose: Float, reading: Any, color: str) -> None:  # noqa: ARG002
        """Draw a disc of the colour that is read where it looks."""
        fill = color_of(np.nan_to_num(np.asarray(reading, dtype=float), nan=0.5).tolist())
        scene.circle(self.placed(pose), 0.0, fill=fill, stroke="#d55e00", width=1.5, pixels=5.0)
