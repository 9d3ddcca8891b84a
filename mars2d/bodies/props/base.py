"""The base of props: rigid bodies without a drive that lie on the floor."""

from __future__ import annotations

from functools import cached_property
from typing import ClassVar, Self

from mars2d.bodies.joints.base import Joint
from mars2d.bodies.rigid import Inertia, Rigid, Surface, inertia_of
from mars2d.core import checks
from mars2d.core.description import Description, choice, entry, number, text
from mars2d.core.materials import (
    MATERIALS,
    Coefficient,
    check_static,
    surface_friction,
    surface_restitution,
)
from mars2d.core.scene import color
from mars2d.geometry.shapes import Shape, rectangle

MAX_SPEED = 100.0
"""The highest speed at the start, m/s and rad/s; higher ones need ever more substeps."""


_LIMITS = f"(vx, vy, omega) in m/s and rad/s, each within +-{MAX_SPEED:g}"


class Prop(Description):
    """The base of all props: bodies without a drive.

    Its pose is the pose of its centre of mass. Coulomb friction with the floor slows it down, with
    the force ground_friction * mass * g; at rest it is held by up to static_ground_friction * mass
    * g.
    """

    sides: ClassVar[tuple[str, ...]] = ()
    """The fields that are the length and width of a rectangle."""

    pose: tuple[float, float, float] = entry(
        default=(0.0, 0.0, 0.0), check=checks.pose, unit="m, m, rad",
        doc="initial pose (x, y, theta) of the centre of mass",
    )  # fmt: skip
    velocity: tuple[float, float, float] = entry(
        default=(0.0, 0.0, 0.0), check=checks.several(-MAX_SPEED, MAX_SPEED, 3, _LIMITS, fewer=1),
        unit="m/s, m/s, rad/s",
        doc="initial velocity (vx, vy, omega)",
    )  # fmt: skip
    material: str | None = choice(
        default=None, of=tuple(MATERIALS), optional=True,
        doc="its material, which gives the values that are None below",
    )  # fmt: skip
    mass: float | None = number(
        default=None, low=1e-6, high=1e6, unit="kg", optional=True,
        doc="mass; None: density x area x height, or 1 kg without a material",
    )  # fmt: skip
    moment: float | None = number(
        default=None, above=0, high=1e12, unit="kg m^2", optional=True,
        doc="moment of inertia; None: that of a plate",
    )  # fmt: skip
    height: float = number(
        default=0.1, above=0, high=1e3, unit="m", doc="its height, for the mass by material"
    )
    friction: float | None = entry(
        default=None, check=surface_friction, optional=True,
        doc="of its sides; None: the material's, or 0.5",
    )  # fmt: skip
    restitution: float | None = entry(
        default=None, check=surface_restitution, optional=True,
        doc="of its sides; None: the material's, or 0",
    )  # fmt: skip
    static_friction: float | None = number(
        default=None, low=0, high=1e3, optional=True,
        doc="friction at rest; None: as friction",
    )  # fmt: skip
    ground_friction: float = number(
        default=0.5, low=0, high=100, doc="coefficient of friction between it and the floor"
    )
    static_ground_friction: float | None = number(
        default=None, low=0, high=100, optional=True,
        doc="friction on the floor at rest; None: as ground_friction",
    )  # fmt: skip
    name: str | None = text(default=None, optional=True, doc="its name, else box0, ball1, ...")
    color: str | None = entry(
        default=None, check=color, optional=True, doc="its colour; None: automatic"
    )

    def _validate(self) -> None:
        kind = type(self).__name__
        if self.static_friction is not None:
            check_static(f"{kind}.static_friction", self.static_friction, self.surface.friction)
        check_static(
            f"{kind}.static_ground_friction", self.static_ground_friction, self.ground_friction
        )

    def at(self, x: float, y: float, theta: float = 0.0) -> Self:
        """Return a copy of this prop at pose (x [m], y [m], theta [rad])."""
        return self.replace(pose=(x, y, theta))

    @cached_property
    def shape(self) -> Shape:
        """Its shape, the centre of mass at the origin; that of a rectangle by its `sides`."""
        if self.side_lengths is None:
            raise NotImplementedError(f"{type(self).__name__} must say what shape it has")
        return rectangle(*self.side_lengths)

    @property
    def side_lengths(self) -> tuple[float, float] | None:
        """The length and width of a rectangle, metres; None for any other shape."""
        if not self.sides:
            return None
        length, width = (float(getattr(self, name)) for name in self.sides)
        return length, width

    def with_side_lengths(self, length: float, width: float) -> Self:
        """Return a copy of a rectangle with other sides, metres."""
        return self.replace(**dict(zip(self.sides, (length, width), strict=True)))

    def joints(self) -> tuple[Joint, ...]:
        """Return the joints that come with it. Its `name` is known by then."""
        return ()

    @property
    def inertia(self) -> Inertia:
        """Its mass [kg] and moment of inertia [kg m^2]."""
        shape = self.shape
        mass = self.mass
        if mass is None:
            mass = 1.0
            if self.material is not None:
                mass = MATERIALS[self.material].density * shape.area * self.height
        return inertia_of(shape, mass, self.moment)

    @property
    def rigid(self) -> Rigid:
        """Its rigid body at the start."""
        kind, name = type(self).__name__, str(self.name)
        shape, inertia, surface = self.shape, self.inertia, self.surface
        return Rigid(kind, name, self.pose, self.velocity, shape, inertia, surface)

    @property
    def surface(self) -> Surface:
        """The friction and restitution of its sides."""
        friction, restitution, name = self.friction, self.restitution, self.material
        if friction is None:
            friction = 0.5 if name is None else Coefficient(MATERIALS[name].friction, name)
        if restitution is None:
            restitution = 0.0 if name is None else Coefficient(MATERIALS[name].restitution, name)
        return Surface(friction, restitution, self.static_friction)

    @property
    def resting_friction(self) -> float:
        """The coefficient of friction with which the floor holds it at rest."""
        static = self.static_ground_friction
        return self.ground_friction if static is None else static
