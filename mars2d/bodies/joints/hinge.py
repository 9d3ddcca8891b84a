"""A hinge: two bodies turn about one point."""

from __future__ import annotations

from math import pi

from mars2d.bodies.constraints import Constraint, Pin, TurningRange, TurningSpring
from mars2d.bodies.joints.base import Float, Joint
from mars2d.core.checks import several
from mars2d.core.description import accepts, entry, number, wrong
from mars2d.core.scene import INK, Scene

LIMITS = "(least, largest) angle from the start, radians, least <= 0 <= largest; or None"

_pair = several(-100 * pi, 100 * pi, 2, LIMITS)


@accepts(vars(_pair)["schema"])
def turning_limits(name: str, value: object) -> tuple[float, float]:
    """Check the limits of a hinge, angles from its start."""
    least, largest = _pair(name, value)
    if not least <= 0 <= largest:
        raise wrong(name, value, LIMITS)
    return least, largest


class Hinge(Joint):
    """A pin through both bodies, or through one and the world: `anchor_a` and `anchor_b` are one.

    Bodies that share a hinge do not collide with each other. Limits bound its angle; with stiffness
    and damping, a spring turns it back to the angle at the start.
    """

    limits: tuple[float, float] | None = entry(
        default=None,
        check=turning_limits,
        optional=True,
        unit="rad",
        doc="the range of rotation of b, or without b of a",
    )
    limit_restitution: float = number(
        default=0.0, low=0, high=1, doc="at the limits: 0 stops, 1 turns back as fast"
    )
    stiffness: float = number(
        default=0.0,
        low=0,
        high=1e6,
        unit="N m/rad",
        doc="stiffness of the spring that turns it back",
    )
    damping: float = number(
        default=0.0, low=0, high=1e6, unit="N m s/rad", doc="damping of its rotation"
    )

    def constraints(self, apart: float) -> tuple[Constraint, ...]:  # noqa: ARG002
        """Return a pin, and the limits and the spring of its angle."""
        found: list[Constraint] = [Pin()]
        if self.limits is not None:
            found.append(TurningRange(*self.limits, restitution=self.limit_restitution))
        if self.stiffness or self.damping:
            found.append(TurningSpring(stiffness=self.stiffness, damping=self.damping))
        return tuple(found)

    def draw(self, scene: Scene, start: Float, end: Float, length: float) -> None:  # noqa: ARG002
        """Draw a pin, seen from above."""
        scene.circle(start, 0.0, fill="#ffffff", stroke=INK, width=2.0, pixels=4.0)
