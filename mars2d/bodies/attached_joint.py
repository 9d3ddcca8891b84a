"""A joint of a scenario, attached to the bodies that it names."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, sqrt
from typing import NamedTuple, Self

from mars2d.bodies.constraints import (
    Constraint,
    FixedDistance,
    MaxDistance,
    Pin,
    SpringDamper,
    TurningSpring,
)
from mars2d.bodies.joints.base import Joint
from mars2d.bodies.rigid import Rigid
from mars2d.core import checks
from mars2d.core.plane import Point
from mars2d.core.usercode import called

__all__ = ["AttachedJoint"]

_constraints = checks.listing(Constraint, "MaxDistance(1.0)")


class AttachedJoint(NamedTuple):
    """A joint between body a and body b, by their indices; b = -1 is the world.

    constraints: what it does to them. turned: the heading of b less that of a at the start, rad.
    """

    joint: Joint
    a: int
    b: int
    constraints: tuple[Constraint, ...]
    turned: float

    @classmethod
    def of(cls, joint: Joint, a: int, b: int, bodies: Sequence[Rigid]) -> Self:
        """Attach a joint to bodies a and b, where these are at the start.

        Raises LawError where a joint of the user's own fails, InputError where it returns anything
        but constraints.
        """
        turned = (bodies[b].pose[2] if b >= 0 else 0.0) - bodies[a].pose[2]
        attached = cls(joint, a, b, (), turned)
        name = f"{type(joint).__name__}.constraints()"
        with called(name, joint.constraints):
            found = joint.constraints(attached.apart(bodies))
        return attached._replace(constraints=_constraints(name, found))

    @property
    def length(self) -> float:
        """The length of a rope or rod, or the rest length of a spring, metres; 0 for a hinge."""
        lengths = (
            each.length
            for each in self.constraints
            if isinstance(each, (MaxDistance, FixedDistance, SpringDamper))
        )
        return next(lengths, 0.0)

    @property
    def pinned(self) -> bool:
        """Whether a pin joins its bodies, which then do not collide with each other."""
        return any(isinstance(each, Pin) for each in self.constraints)

    def apart(self, bodies: Sequence[Rigid]) -> float:
        """Return how far its ends are apart at the start, metres."""
        (ax, ay), (bx, by) = self.ends(bodies)
        return hypot(bx - ax, by - ay)

    def frequency(self, spring: SpringDamper | TurningSpring, bodies: Sequence[Rigid]) -> float:
        """Return the angular frequency of its bodies on one of its springs, rad/s."""
        held = ((self.a, self.joint.anchor_a), (self.b, self.joint.anchor_b))
        ends = [(bodies[i].inertia, anchor) for i, anchor in held if i >= 0]
        if isinstance(spring, TurningSpring):
            lightness = sum(1 / inertia.moment for inertia, _ in ends)
        else:  # at the end of a lever a body is lighter
            lightness = sum(1 / i.mass + (x * x + y * y) / i.moment for i, (x, y) in ends)
        return sqrt(spring.stiffness * lightness)

    def ends(self, bodies: Sequence[Rigid]) -> tuple[Point, Point]:
        """Return where its ends are at the start."""
        first = bodies[self.a].to_world(self.joint.anchor_a)
        if self.b < 0:
            return first, self.joint.anchor_b
        return first, bodies[self.b].to_world(self.joint.anchor_b)
