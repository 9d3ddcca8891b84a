"""What a sensor is, and the little of the world that it may ask."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from mars2d import checks
from mars2d.description import Description, text
from mars2d.registry import snake_case
from mars2d.scene import Scene

if TYPE_CHECKING:
    from mars2d.control import RobotView

__all__ = ["Sensor", "Surroundings"]

Float = NDArray[np.float64]


class Surroundings(Protocol):
    """What a sensor may ask of the world. Points are (x, y) in metres, in the world's frame.

    `ignore` is the index of the robot that asks: it never sees itself.
    """

    @property
    def time(self) -> float:
        """The simulated time, seconds."""

    @property
    def pose(self) -> Float:
        """The poses of all robots, (3, n)."""

    def distance(self, point: tuple[float, float], limit: float, ignore: int) -> float:
        """Return the distance to the nearest surface, metres; inf when beyond `limit`.

        Negative inside a robot.
        """

    def nearby(
        self, point: tuple[float, float], limit: float, ignore: int
    ) -> Iterator[tuple[float, float]]:
        """Yield, for each surface nearer than `limit`, its nearest point (x, y)."""

    def ray(self, start: tuple[float, float], angle: float, length: float, ignore: int) -> float:
        """Return how far a ray goes until the first surface, metres; inf when nothing is hit."""


class Sensor(Description):
    """The base of all sensors: derive, declare fields, and write `read`.

    >>> class Compass(Sensor):
    ...     error: float = 0.02  # rad, standard deviation
    ...
    ...     def read(self, robot, world, rng):
    ...         return robot.pose[2] + rng.normal(0, self.error)
    >>> Compass(error=0.1).key
    'compass'

    name: under which a law finds the reading, ``robot.sense.<name>``; by default the name of the
    class in snake case.
    """

    name: str | None = text(default=None, optional=True, doc="the name of the reading")

    @property
    def key(self) -> str:
        """The name of the reading: `name`, or that of the class in snake case."""
        return self.name or snake_case(type(self).__name__)

    def _validate(self) -> None:
        checks.identifier(f"{type(self).__name__}.name", self.name, "robot.sense.")

    def read(self, robot: RobotView, world: Surroundings, rng: np.random.Generator) -> Any:
        """Return the reading now: a number, a bool, or an array whose shape never changes.

        robot: the robot that carries the sensor, with everything known of it.
        rng: the random stream of this one sensor.
        """
        raise NotImplementedError(
            f"{type(self).__name__} needs a method read(self, robot, world, rng)"
        )

    def draw(self, scene: Scene, pose: Float, reading: Any, color: str) -> None:
        """Draw field of view and reading for a robot at `pose` (3,). By default, nothing."""
