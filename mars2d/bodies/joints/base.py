"""Joints, which tie two bodies together or one to the world: their base, and one attached."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.constraints import (
    Constraint,
    FixedDistance,
    MaxDistance,
    Pin,
    SpringDamper,
    TurningSpring,
)
from mars2d.bodies.rigid import Rigid
from mars2d.core import checks
from mars2d.core.arithmetic import norm
from mars2d.core.description import Description, entry, text
from mars2d.core.plane import Point
from mars2d.core.scene import Scene
from mars2d.core.usercode import called

Float = NDArray[np.float64]

STEEL = "#52606d"
"""The colour of rods and springs."""

_constraints = checks.listing(Constraint, "MaxDistance(1.0)")


class Joint(Description):
    """The base of all joints.

    A joint holds a point of body `a` and a point of body `b`, or of the world. A joint of one's
    own says in `constraints` what it does to its bodies, and in `draw` how it looks. Joints act
    if ``Scenario.physics`` is "contact".
    """

    a: str = text(doc="the name of a robot or prop", names="body")
    b: str | None = text(
        default=None, optional=True, doc="the name of another; None: the world", names="body"
    )
    anchor_a: Point = entry(
        default=(0.0, 0.0),
        check=checks.point,
        unit="m",
        doc="its attachment point on a, in a's frame",
    )
    anchor_b: Point = entry(
        default=(0.0, 0.0), check=checks.point, unit="m",
        doc="its attachment point on b, in b's frame; without b, in the world",
    )  # fmt: skip

    def constraints(self, apart: float) -> tuple[Constraint, ...]:
        """Return the constraints that it puts on its bodies; see `mars2d.bodies.constraints`.

        apart: the distance of its ends at the start, metres. A constraint of that distance comes
        first.
        """
        raise NotImplementedError(f"{type(self).__name__} must say what it does to its bodies")

    def draw(self, scene: Scene, start: Float, end: Float, length: float) -> None:  # noqa: ARG002
        """Draw it between its ends (2,), metres in the world; by default, as a rod.

        length: metres, that of its first constraint, 0 if this has none.
        """
        scene.line([start, end], stroke="#ffffff", width=6.0)
        scene.line([start, end], stroke=STEEL, width=4.0)
        for point in (start, end):
            scene.circle(point, 0.0, fill=STEEL, pixels=3.0)


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
        return norm(bx - ax, by - ay)

    def frequency(self, spring: SpringDamper | TurningSpring, bodies: Sequence[Rigid]) -> float:
        """Return the angular frequency of its bodies on one of its springs, rad/s."""
        held = ((self.a, self.joint.anchor_a), (self.b, self.joint.anchor_b))
        ends = [(bodies[i].inertia, (x - bodies[i].lead, y)) for i, (x, y) in held if i >= 0]
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


def beside(start: Float, end: Float, share: Float, side: Float) -> Float:
    """Return points (k, 2) at shares of the way from start to end, and metres to its left."""
    along = end - start
    apart = float(norm(*along))
    normal = np.array([-along[1], along[0]]) / apart if apart > 0 else np.array([0.0, 1.0])
    return np.asarray(start + share[:, None] * along + side[:, None] * normal)
