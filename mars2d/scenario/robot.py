"""The frozen description of one robot."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from math import inf
from typing import Any, Self

from mars2d.bodies.drives.base import Drive
from mars2d.bodies.drives.wheeled import Unicycle
from mars2d.bodies.rigid import Inertia, Rigid, Surface, inertia_of
from mars2d.core import checks
from mars2d.core.arithmetic import cosine_sine
from mars2d.core.description import Description, choice, entry, number, text, wrong
from mars2d.core.materials import GRAVITY, check_static, surface_friction, surface_restitution
from mars2d.core.plane import Point
from mars2d.core.scene import color
from mars2d.geometry.shapes import Disc, Shape, known_shape
from mars2d.sensors.base import Sensor

DIAMETER = 0.3
"""The default diameter, metres."""

MAX_ACCELERATION = 1e5
"""The highest acceleration of a robot by its drive, m/s^2; more needs ever more substeps."""


def _shape(name: str, value: object) -> Shape:
    return known_shape(name, value, "Polygon([(-0.2, -0.1), (0.2, 0), (-0.2, 0.1)])")


def _law(name: str, value: object) -> object:
    return checks.function(name, value, "the robot")


class Robot(Description):
    """One robot: a body that its drive moves, with sensors and perhaps a law of its own.

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
        check=checks.instance(Drive, "Unicycle()"),
        factory=Unicycle,
        doc="the drive, which moves it",
    )
    diameter: float = number(
        default=DIAMETER,
        low=1e-3,
        high=1e3,
        unit="m",
        doc="diameter of the chassis, a disc",
    )
    shape: Shape | None = entry(
        default=None, check=_shape, optional=True,
        doc="the chassis, if it is not a disc, around the geometric centre, x ahead",
    )  # fmt: skip
    mass: float = number(default=1.0, low=1e-6, high=1e6, unit="kg", doc="mass")
    moment: float | None = number(
        default=None, above=0, high=1e12, unit="kg m^2", optional=True,
        doc="moment of inertia about the centre of mass; None: that of a plate about this point",
    )  # fmt: skip
    friction: float = entry(
        default=0.5, check=surface_friction,
        doc="coefficient of friction; a contact has the product of both",
    )  # fmt: skip
    restitution: float = entry(
        default=0.0, check=surface_restitution,
        doc="0 stops, 1 bounces back; a contact has the product of both",
    )  # fmt: skip
    static_friction: float | None = number(
        default=None, low=0, high=1e3, optional=True,
        doc="friction at rest; None: as friction",
    )  # fmt: skip
    center_offset: float = number(
        default=0.0, low=-1e3, high=1e3, unit="m",
        doc="distance of the centre of rotation ahead of the geometric centre",
    )  # fmt: skip
    mass_offset: float = number(
        default=0.0, low=-1e3, high=1e3, unit="m",
        doc="distance of the centre of mass ahead of the centre of rotation",
    )  # fmt: skip
    sensors: Sequence[Sensor] = entry(
        default=(), check=checks.listing(Sensor, "Proximity(range=0.3)"), doc="its sensors"
    )
    controller: Callable[[Any], Any] | None = entry(
        default=None, check=_law, optional=True,
        doc="its own law, a function or generator of the robot",
    )  # fmt: skip
    sees: str = choice(
        default="full", of=("full", "partial", "positions", "sensors"),
        doc="its law's information: all; itself and its neighbours; itself and their positions; "
        "or its sensors only",
    )  # fmt: skip
    name: str | None = text(default=None, optional=True, doc="its name, else robot0, robot1, ...")
    color: str | None = entry(
        default=None, check=color, optional=True, doc="its colour; None: one of base_colors"
    )

    def at(self, x: float, y: float, theta: float = 0.0) -> Self:
        """Return a copy of this robot at pose (x [m], y [m], theta [rad])."""
        return self.replace(pose=(x, y, theta))

    def sensor(self, key: str) -> Sensor | None:
        """Return the sensor with a name; None in a loaded record for sensors of the user's own."""
        return next((sensor for sensor in self.sensors if sensor.key == key), None)

    @property
    def radius(self) -> float:
        """Half the diameter of a disc, else the radius of a circle around the shape, metres."""
        return self.diameter / 2 if self.shape is None else self.shape.bound[1]

    @property
    def center(self) -> Point:
        """The geometric centre at the start: `center_offset` behind the centre of rotation."""
        x, y, theta = self.pose
        c, s = cosine_sine(theta)
        return x - self.center_offset * c, y - self.center_offset * s

    @cached_property
    def chassis(self) -> Shape:
        """Its shape about the centre of rotation."""
        shape = Disc(self.diameter) if self.shape is None else self.shape
        return shape.moved(-self.center_offset, 0.0) if self.center_offset else shape

    @property
    def inertia(self) -> Inertia:
        """Its mass [kg], and its moment of inertia about the centre of mass [kg m^2]."""
        about = self.chassis.moved(-self.mass_offset, 0.0) if self.mass_offset else self.chassis
        return inertia_of(about, self.mass, self.moment)

    @property
    def push(self) -> float:
        """The most it can push with at rest: its drive's force, or what its wheels hold [N]."""
        weight, along = self.mass * GRAVITY, self.drive.grips[0]
        return min(self.drive.strength(weight)[0], inf if along is None else along * weight)

    @property
    def surface(self) -> Surface:
        """The friction and restitution of its sides."""
        return Surface(self.friction, self.restitution, self.static_friction)

    @property
    def rigid(self) -> Rigid:
        """Its rigid body at the start."""
        still = (0.0, 0.0, 0.0)
        shape, inertia, surface = self.chassis, self.inertia, self.surface
        lead = self.mass_offset
        return Rigid("Robot", str(self.name), self.pose, still, shape, inertia, surface, lead)

    def _validate(self) -> None:
        check_static("Robot.static_friction", self.static_friction, self.friction)
        if self.drive.max_force > MAX_ACCELERATION * self.mass:
            raise wrong(
                "Robot.drive.max_force", self.drive.max_force,
                f"at most {MAX_ACCELERATION:g} m/s^2 times the mass, {self.mass:g} kg",
            )  # fmt: skip
        if self.shape is not None and self.diameter != DIAMETER:
            raise wrong("Robot.diameter", self.diameter, "no diameter, as a shape is given")
        reach = self.radius if self.shape is None else self.shape.reach
        if abs(self.center_offset) > reach:
            raise wrong(
                "Robot.center_offset", self.center_offset, f"within the radius, {reach:g} m"
            )
        if abs(self.mass_offset) > self.chassis.reach:
            raise wrong(
                "Robot.mass_offset", self.mass_offset,
                f"within its shape, {self.chassis.reach:g} m of the centre of rotation",
            )  # fmt: skip
        checks.unique("Robot.sensors", [sensor.key for sensor in self.sensors])
