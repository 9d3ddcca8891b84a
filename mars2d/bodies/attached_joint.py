"""A joint of a scenario, with the bodies that it holds found."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot
from typing import NamedTuple, Self

from mars2d.bodies.joints.base import Joint
from mars2d.bodies.joints.hinge import Hinge
from mars2d.bodies.joints.rod import Rod
from mars2d.bodies.joints.rope import Rope
from mars2d.bodies.joints.spring import Spring
from mars2d.bodies.rigid import Rigid
from mars2d.core.plane import Point

__all__ = ["Tie"]


class Tie(NamedTuple):
    """A joint between body a and body b, by their indices; b = -1 is the world.

    length: metres, of a rope or rod, or the rest length of a spring; 0 for a hinge. turned: the
    heading of b less that of a at the start, radians.
    """

    joint: Joint
    a: int
    b: int
    length: float
    turned: float

    @classmethod
    def of(cls, joint: Joint, a: int, b: int, bodies: Sequence[Rigid]) -> Self:
        """Return a joint with its bodies; a length that was left open is that of the start."""
        turned = (bodies[b].pose[2] if b >= 0 else 0.0) - bodies[a].pose[2]
        tie = cls(joint, a, b, 0.0, turned)
        length: float | None = 0.0
        if isinstance(joint, (Rope, Rod)):
            length = joint.length
        elif isinstance(joint, Spring):
            length = joint.rest_length
        return tie._replace(length=tie.apart(bodies) if length is None else length)

    def apart(self, bodies: Sequence[Rigid]) -> float:
        """Return how far its ends are apart at the start, metres."""
        (ax, ay), (bx, by) = self.ends(bodies)
        return hypot(bx - ax, by - ay)

    def lightness(self, bodies: Sequence[Rigid]) -> float:
        """Return what a spring of unit stiffness would make of it: its frequency squared.

        It is 1 / mass [1/kg] of what the joint moves, the levers of its anchors included; of a
        hinge, 1 / moment [1/(kg m^2)].
        """
        held = ((self.a, self.joint.anchor_a), (self.b, self.joint.anchor_b))
        ends = [(bodies[i].inertia, anchor) for i, anchor in held if i >= 0]
        if isinstance(self.joint, Hinge):
            return sum(1 / inertia.moment for inertia, _ in ends)
        return sum(1 / i.mass + (x * x + y * y) / i.moment for i, (x, y) in ends)

    def ends(self, bodies: Sequence[Rigid]) -> tuple[Point, Point]:
        """Return where its ends are at the start."""
        first = bodies[self.a].to_world(self.joint.anchor_a)
        if self.b < 0:
            return first, self.joint.anchor_b
        return first, bodies[self.b].to_world(self.joint.anchor_b)
