"""The frozen description of one robot."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import cos, sin
from typing import Any, Self

from mars2d import checks
from mars2d.bodies.base import Drive
from mars2d.bodies.unicycle import Unicycle
from mars2d.description import Description, choice, entry, number, text, wrong
from mars2d.geometry import Point
from mars2d.scene import color
from mars2d.sensors.base import Sensor

__all__ = ["Robot"]

ACCELERATION = 1e5
"""How strongly a drive may accelerate its robot, m/s^2; more needs ever more substeps."""


def _controller(name: str, value: object) -> object:
    return None if value is None else checks.law(name, value, "the robot")


def _optional_color(name: str, value: object) -> str | None:
    return None if value is None else color(name, value)


class Robot(Description):
    """One robot: a disc that its drive moves, with sensors and perhaps a law of its own.

    >>> Robot(diameter=0.2).at(1, 2, 0).pose
    (1.0, 2.0, 0.0)
    """

    pose: tuple[float, float, float] = entry(
        default=(0.0, 0.0, 0.0),
        check=checks.pose,
        unit="m, m, rad",
        doc="initial pose (x, y, theta)",
    )
    drive: Drive = entry(
        check=checks.instance(Drive, "Unicycle()"), factory=Unicycle, doc="how it moves"
    )
    diameter: float = number(
        default=0.3, low=1e-3, high=1e3, unit="m", doc="diameter of the chassis"
    )
    mass: float = number(default=1.0, low=1e-6, high=1e6, unit="kg", doc="mass")
    friction: float = number(
        default=0.5,
        low=0,
        high=1e3,
        doc="coefficient of friction; a contact has the product of both",
    )
    restitution: float = number(
        default=0.0, low=0, high=1, doc="0 stops, 1 bounces back; a contact has the product of both"
    )
    center_offset: float = number(
        default=0.0, low=-1e3, high=1e3, unit="m",
        doc="how far the centre of rotation lies ahead of the geometric centre",
    )  # fmt: skip
    sensors: Sequence[Sensor] = entry(
        default=(),
        check=checks.listing(Sensor, "Proximity(range=0.3)"),
        doc="what it perceives with",
    )
    controller: Callable[[Any], Any] | None = entry(
        default=None, check=_controller, doc="its own law, a function or generator of the robot"
    )
    sees: str = choice(default="full", of=("full", "sensors"), doc="what its law may see")
    name: str | None = text(default=None, optional=True, doc="its name, else robot0, robot1, ...")
    color: str | None = entry(
        default=None, check=_optional_color, doc="its colour, else from base_colors"
    )

    def at(self, x: float, y: float, theta: float = 0.0) -> Self:
        """Return a copy of this robot at pose (x [m], y [m], theta [rad])."""
        return self.replace(pose=(x, y, theta))

    @property
    def radius(self) -> float:
        """Half the diameter, metres."""
        return self.diameter / 2

    @property
    def center(self) -> Point:
        """The geometric centre at the start: `center_offset` behind the centre of rotation."""
        x, y, theta = self.pose
        return x - self.center_offset * cos(theta), y - self.center_offset * sin(theta)

    def _validate(self) -> None:
        if self.drive.max_force > ACCELERATION * self.mass:
            raise wrong(
                "Robot.drive.max_force", self.drive.max_force,
                f"at most {ACCELERATION:g} m/s^2 times the mass, {self.mass:g} kg",
            )  # fmt: skip
        if abs(self.center_offset) > self.radius:
            raise wrong(
                "Robot.center_offset", self.center_offset, f"within the radius, {self.radius:g} m"
            )
        checks.unique("Robot.sensors", [sensor.key for sensor in self.sensors])
