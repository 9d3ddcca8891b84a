"""Surfaces: friction and restitution of a contact, where they are no products of two numbers.

The solver multiplies the values of two shapes by itself. In worlds that ask for another rule, for
values of certain pairs of materials, or for static friction, it asks here before each substep.
"""

from __future__ import annotations

from math import sqrt

from mars2d.physics.islands import chipmunk
from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.body import Body
from mars2d.physics.islands.library import Arbiter, Handle, Vector, callback, thing_at


@cython.cclass
class Surface:
    """That of a body or wall. rubs, bounces: numbers of materials, or -1."""

    friction: cython.double
    static: cython.double
    restitution: cython.double
    rubs: cython.int  # the material by whose name the friction was given
    bounces: cython.int  # and the restitution

    def __init__(
        self, friction: float, restitution: float, static: float, rubs: int, bounces: int
    ) -> None:
        """Take its coefficients and materials."""
        self.friction, self.static, self.restitution = friction, static, restitution
        self.rubs, self.bounces = rubs, bounces


@cython.cclass
class Surfaces:
    """Those of all bodies and walls, by number; and how two make a contact."""

    bodies: list[Body]
    of_bodies: list[Surface]
    of_walls: list[Surface]  # -1, -2, ...: of obstacles, then of walls that belong to several
    rule: cython.int
    bounce_rule: cython.int
    sticks: cython.double  # m/s, slower is not slipping
    count: cython.int  # of materials
    frictions: list[float]  # of pairs of materials, row by row; -1: by the rule
    statics: list[float]
    restitutions: list[float]
    handle: object  # by which the engine finds it, in Python

    def __init__(
        self,
        bodies: list[Body],
        of_bodies: list[Surface],
        of_walls: list[Surface],
        rules: tuple[int, int],
        sticks: float,
        pairs: tuple[list[float], list[float], list[float]],
    ) -> None:
        """Take surfaces, rules for friction and restitution, and tables of pairs.

        rules: 0 product, 1 minimum, 2 mean, 3 geometric mean, 4 maximum.
        """
        self.bodies, self.of_bodies, self.of_walls = bodies, of_bodies, of_walls
        self.rule, self.bounce_rule = rules
        self.frictions, self.statics, self.restitutions = pairs
        self.sticks, self.count = sticks, round(sqrt(len(pairs[0])))

    def settle(self, arbiter: Arbiter) -> cython.void:
        """Set friction and restitution of a contact, as the solver is to use them now."""
        if chipmunk.count_of(arbiter) == 0:
            return
        first: cython.int = chipmunk.first_of(arbiter)
        second: cython.int = chipmunk.second_of(arbiter)
        a: Surface = self.surface_of(first)
        b: Surface = self.surface_of(second)
        friction: cython.double = -1.0
        static: cython.double = -1.0
        restitution: cython.double = -1.0
        if a.rubs >= 0 and b.rubs >= 0:
            friction = self.frictions[a.rubs * self.count + b.rubs]
            static = self.statics[a.rubs * self.count + b.rubs]
        if a.bounces >= 0 and b.bounces >= 0:
            restitution = self.restitutions[a.bounces * self.count + b.bounces]
        if friction < 0.0:
            friction = blend(self.rule, a.friction, b.friction)
            static = blend(self.rule, a.static, b.static)
        if restitution < 0.0:
            restitution = blend(self.bounce_rule, a.restitution, b.restitution)
        if static > friction and self.slip(arbiter, first, second) < self.sticks:
            friction = static
        chipmunk.set_surface(arbiter, friction, restitution)

    def surface_of(self, number: cython.int) -> Surface:
        """Return the surface of a body or wall."""
        if number >= 0:
            return self.of_bodies[number]
        return self.of_walls[-1 - number]

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


def blend(rule: cython.int, p: cython.double, q: cython.double) -> cython.double:
    """Return a rule's result for the values of two surfaces, the same in both orders."""
    if rule == 1:
        return min(p, q)
    if rule == 2:
        return (p + q) / 2
    if rule == 3:
        return sqrt(p * q)
    if rule == 4:
        return max(p, q)
    return p * q
