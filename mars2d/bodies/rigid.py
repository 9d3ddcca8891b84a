"""A rigid body, as the physics sees a robot or a prop."""

from __future__ import annotations

from typing import NamedTuple

from mars2d.core.arithmetic import cosine_sine
from mars2d.core.plane import Point
from mars2d.geometry.shapes import Disc, Shape

Triple = tuple[float, float, float]


class Inertia(NamedTuple):
    """A mass [kg] and a moment of inertia about the centre of mass [kg m^2]."""

    mass: float
    moment: float


class Surface(NamedTuple):
    """Coefficients of friction and restitution; by default a contact has both bodies' product.

    static_friction: holds while nothing slips; None: as friction.
    """

    friction: float
    restitution: float
    static_friction: float | None = None


class Rigid(NamedTuple):
    """One body at the start.

    kind: the class that describes it, such as "Robot" or "Box". pose: x, y [m], theta [rad].
    velocity: x', y' [m/s], theta' [rad/s]. shape: about the pose. lead: how far ahead of the pose
    the centre of mass lies, metres.
    """

    kind: str
    name: str
    pose: Triple
    velocity: Triple
    shape: Shape
    inertia: Inertia
    surface: Surface
    lead: float = 0.0

    @property
    def is_disc(self) -> bool:
        """Whether its shape is a single disc."""
        return isinstance(self.shape, Disc)

    @property
    def bound(self) -> tuple[Point, float]:
        """A circle around it at the start: centre and radius, metres."""
        center, radius = self.shape.bound
        return self.to_world(center), radius

    def to_world(self, point: Point) -> Point:
        """Return where a point of the body lies at the start."""
        x, y, theta = self.pose
        c, s = cosine_sine(theta)
        return x + c * point[0] - s * point[1], y + s * point[0] + c * point[1]


def inertia_of(shape: Shape, mass: float, moment: float | None) -> Inertia:
    """Return mass and moment of a body: the moment of a uniform plate unless one is given."""
    return Inertia(mass, mass * shape.plate.moment_per_mass if moment is None else moment)
