"""Constraints: the parts of joints, in terms that the physics knows.

A joint says which constraints it puts on its bodies, and the physics translates each of them for
its solver. So a new joint that is made of these needs no change in the physics.
"""

from __future__ import annotations

from math import pi

from mars2d.core.description import Description, number

MAX_LENGTH = 1e12
MAX_STIFFNESS = 1e6
MAX_DAMPING = 1e6
MAX_TURN = 100 * pi


class Constraint(Description):
    """The base of all constraints. The physics knows those of this module, and no others."""


class MaxDistance(Constraint):
    """Keep two points no further apart than a length, as a rope does. A jerk is inelastic."""

    length: float = number(low=0, high=MAX_LENGTH, unit="m", kw_only=False, doc="the length")


class FixedDistance(Constraint):
    """Keep two points at a distance, as a rod does."""

    length: float = number(low=0, high=MAX_LENGTH, unit="m", kw_only=False, doc="the distance")


class SpringDamper(Constraint):
    """Pull or push two points with the force k (length - rest length) + c (length)'."""

    length: float = number(low=0, high=MAX_LENGTH, unit="m", kw_only=False, doc="the rest length")
    stiffness: float = number(low=0, high=MAX_STIFFNESS, unit="N/m", doc="k")
    damping: float = number(default=0.0, low=0, high=MAX_DAMPING, unit="N s/m", doc="c")


class Pin(Constraint):
    """Keep two points in one place. Bodies that a pin joins do not collide with each other."""


class TurningRange(Constraint):
    """Bound the angle of b against a from the start, or without b that of a in the world."""

    least: float = number(low=-MAX_TURN, high=0, unit="rad", kw_only=False, doc="clockwise")
    largest: float = number(low=0, high=MAX_TURN, unit="rad", kw_only=False, doc="the other way")
    restitution: float = number(
        default=0.0, low=0, high=1, doc="at the ends: 0 stops, 1 turns back as fast"
    )


class TurningSpring(Constraint):
    """Turn two bodies back to their angle at the start."""

    stiffness: float = number(low=0, high=MAX_STIFFNESS, unit="N m/rad", doc="per angle")
    damping: float = number(default=0.0, low=0, high=MAX_DAMPING, unit="N m s/rad", doc="per spin")
