"""Surfaces: friction and restitution of a contact, where they are no products of two numbers.

The solver multiplies the values of two shapes by itself. In worlds that ask for another rule, for
values of certain pairs of materials, or for static friction, it asks here before each substep.
"""

from __future__ import annotations

from typing import Any

from mars2d.physics.islands import chipmunk
from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.body import Body
from mars2d.physics.islands.library import Arbiter, Handle, Vector, callback, thing_at


@cython.cclass
class Surfaces:
    """The coefficients of contacts by the numbers of what touches, as they are asked for."""

    bodies: list[Body]
    of: Any
    sticks: cython.double  # m/s, slower is not slipping
    known: dict[Any, Any]
    handle: object  # by which the engine finds it, in Python

    def __init__(self, bodies: list[Body], of: Any, sticks: float) -> None:
        """Take a function of two numbers: kinetic and static friction, and restitution."""
        self.bodies, self.of, self.sticks, self.known = bodies, of, sticks, {}

    def settle(self, arbiter: Arbiter) -> cython.void:
        """Set friction and restitution of a contact, as the solver is to use them now."""
        if chipmunk.count_of(arbiter) == 0:
            return
        first: cython.int = chipmunk.first_of(arbiter)
        second: cython.int = chipmunk.second_of(arbiter)
        found = self.known.get((first, second))
        if found is None:
            found = self.known[first, second] = self.of(first, second)
        friction: cython.double = found[0]
        static: cython.double = found[1]
        restitution: cython.double = found[2]
        if static > friction and self.slip(arbiter, first, second) < self.sticks:
            friction = static
        chipmunk.set_surface(arbiter, friction, restitution)

    def slip(self, arbiter: Arbiter, first: cython.int, second: cython.int) -> cython.double:
        """Return how fast two bodies slide along each other, before the substep, m/s."""
        vx: cython.double = 0.0
        vy: cython.double = 0.0
        if second >= 0:
            body = self.bodies[second]
            arm, fast = arbiter.contacts[0].r2, chipmunk.velocity_of(body.handle)
            vx = fast.x - chipmunk.spin_of(body.handle) * arm.y
            vy = fast.y + chipmunk.spin_of(body.handle) * arm.x
        if first >= 0:
            body = self.bodies[first]
            arm, fast = arbiter.contacts[0].r1, chipmunk.velocity_of(body.handle)
            vx = vx - (fast.x - chipmunk.spin_of(body.handle) * arm.y)
            vy = vy - (fast.y + chipmunk.spin_of(body.handle) * arm.x)
        normal: Vector = arbiter.n
        along: cython.double = vy * normal.x - vx * normal.y
        return abs(along)


@callback("void(cpArbiter *, cpSpace *, void *)")
def settle_contact(arbiter: Arbiter, _space: Handle, data: Handle) -> cython.void:
    """Let surfaces settle a contact before it is solved."""
    surfaces: Surfaces = thing_at(data)
    surfaces.settle(arbiter)
