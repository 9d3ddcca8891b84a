"""Impacts: the effect of contacts on the energy of the bodies that touch in a substep.

An impulse J works J (u + u') / 2, with the velocities u before and u' after of its point on one
body as seen from the other. The sum over all impulses is the change of the kinetic energy.
"""

from __future__ import annotations

from mars2d.physics.islands import chipmunk
from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import length
from mars2d.physics.islands.body import Body
from mars2d.physics.islands.library import Arbiter, Vector
from mars2d.physics.islands.solver import Solver

REBOUND = 0.1
"""How much faster than by its restitution a contact may throw back a body that it has stopped.

Between two walls that are almost parallel, what the solver remembers of an impact throws back
bodies at several times their speed.
"""

DRIVEN = 0.3
"""The part of their energy that impulses may add in a substep where robots are told to move."""

DRIVEN_BODIES = 5
"""Of how many bodies that touch at most this is asked where robots are told to move."""

FEW_BODIES = 2
"""Of how many bodies that touch at most this is asked: in a heap some contacts would give way."""


@cython.cclass
class Impact:
    """The contact of two shapes in a substep: one is of body a, the other of b or of a wall."""

    a: Body
    b: Body
    has_a: cython.bint
    has_b: cython.bint
    # at one of its points
    normal_x: cython.double
    normal_y: cython.double
    arm_ax: cython.double
    arm_ay: cython.double
    arm_bx: cython.double
    arm_by: cython.double
    push: cython.double
    friction: cython.double
    depth: cython.double

    def __init__(self, body: Body) -> None:
        """Stand for none yet; body: any."""
        self.a = self.b = body

    def take(self, arbiter: Arbiter, numbers: list[Body]) -> cython.void:
        """Stand for a contact that the solver knows."""
        first: cython.int = chipmunk.first_of(arbiter)
        second: cython.int = chipmunk.second_of(arbiter)
        self.has_a, self.has_b = first >= 0, second >= 0
        self.a = numbers[first if first >= 0 else second]
        self.b = numbers[second if second >= 0 else first]
        self.normal_x, self.normal_y = arbiter.n.x, arbiter.n.y

    def look_at(self, arbiter: Arbiter, k: cython.int) -> cython.void:
        """Stand for one of its points."""
        arm: Vector = arbiter.contacts[k].r1
        self.arm_ax, self.arm_ay = arm.x, arm.y
        arm = arbiter.contacts[k].r2
        self.arm_bx, self.arm_by = arm.x, arm.y
        self.push, self.friction = arbiter.contacts[k].jnAcc, arbiter.contacts[k].jtAcc
        self.depth = chipmunk.depth_of(arbiter, k)

    def hit(self) -> cython.void:
        """Add the impulse in this point to those of the bodies."""
        x: cython.double = self.push * self.normal_x - self.friction * self.normal_y
        y: cython.double = self.push * self.normal_y + self.friction * self.normal_x
        if self.has_a:
            self.a.hit_x -= x
            self.a.hit_y -= y
            self.a.hit_turn -= self.arm_ax * y - self.arm_ay * x
            self.a.pressure += self.push + abs(self.friction)
        if self.has_b:
            self.b.hit_x += x
            self.b.hit_y += y
            self.b.hit_turn += self.arm_bx * y - self.arm_by * x
            self.b.pressure += self.push + abs(self.friction)

    def work(self, bounce: cython.double, h: cython.double) -> cython.void:
        """Add up for the group how the impulse in this point works, its rebound, and its age.

        h: of the substep, s. Points that came to touch within it are as deep as they moved since.
        """
        group: Body = group_of(self.a)
        x: cython.double = 0.0
        y: cython.double = 0.0
        after_x: cython.double = 0.0
        after_y: cython.double = 0.0
        a: Body = self.a
        b: Body = self.b
        if self.has_b:
            x = b.before_x - b.before_spin * self.arm_by
            y = b.before_y + b.before_spin * self.arm_bx
            after_x = b.after_x - b.spin * self.arm_by
            after_y = b.after_y + b.spin * self.arm_bx
        if self.has_a:
            x -= a.before_x - a.before_spin * self.arm_ay
            y -= a.before_y + a.before_spin * self.arm_ax
            after_x -= a.after_x - a.spin * self.arm_ay
            after_y -= a.after_y + a.spin * self.arm_ax
        nx: cython.double = self.normal_x
        ny: cython.double = self.normal_y
        parting: cython.double = after_x * nx + after_y * ny
        closing: cython.double = -(x * nx + y * ny)
        if closing > 0.0 and self.depth <= closing * h * (1 + 1e-9):
            group.hit_power += self.push * closing
            group.hit_depth += self.push * max(self.depth, 0.0)
        group.push_work += self.push * (parting - closing) / 2
        group.friction_work += self.friction * ((y + after_y) * nx - (x + after_x) * ny) / 2
        group.excess += self.push * (parting + bounce)

    def power(self) -> cython.void:
        """Add up for the group the power of the impulse on the motion due to all impulses alone."""
        group: Body = group_of(self.a)
        x: cython.double = 0.0
        y: cython.double = 0.0
        if self.has_b:
            body = self.b
            turn = body.hit_turn / body.moment
            x = body.hit_x / body.mass - turn * self.arm_by
            y = body.hit_y / body.mass + turn * self.arm_bx
        if self.has_a:
            body = self.a
            turn = body.hit_turn / body.moment
            x -= body.hit_x / body.mass - turn * self.arm_ay
            y -= body.hit_y / body.mass + turn * self.arm_ax
        group.push_power += self.push * (x * self.normal_x + y * self.normal_y)
        group.friction_power += self.friction * (y * self.normal_x - x * self.normal_y)


def group_of(body: Body) -> Body:
    """Return the body that stands for all that touch each other in this substep."""
    while body.group is not body:
        body.group = body.group.group
        body = body.group
    return body


def join_groups(a: Body, b: Body) -> cython.void:
    """Let one body stand for the groups of both."""
    a, b = group_of(a), group_of(b)
    if a is b:
        return
    b.group = a
    a.push_work += b.push_work
    a.friction_work += b.friction_work
    a.excess += b.excess
    a.hit_power += b.hit_power
    a.hit_depth += b.hit_depth
    b.push_work = b.friction_work = b.excess = 0.0
    a.crowd += b.crowd
    a.driven = a.driven or b.driven
    a.springy = a.springy or b.springy


def settle(solver: Solver, numbers: list[Body], impact: Impact, h: cython.double) -> cython.void:
    """Let the solver's step of h s add no energy by contacts or joints; add up their work.

    Of bodies that touch or hold each other, all impulses are weakened by one factor, so momentum is
    kept. impact: any, to work with.
    """
    for body in solver.bodies:
        body.group, body.springy, body.tied = body, False, False
        body.hit_x = body.hit_y = body.hit_turn = body.pressure = 0.0
        body.push_work = body.friction_work = body.excess = body.hit_power = body.hit_depth = 0.0
        body.crowd, body.driven = 1, body.is_told()
    if solver.find_contacts() > 0:
        take_hits(solver, numbers, impact, h)
        gain: cython.bint = False
        for body in solver.bodies:
            gain = gain or body.push_work + body.friction_work > 0.0 or body.excess > 0.0
        if gain:
            look_again(solver, numbers, impact, True)
            if weaken_contacts(solver):
                scale_all(solver, numbers, impact)
    if solver.ties:
        take_holds(solver, h)
        if weaken_holds(solver):
            scale_all(solver, numbers, impact)
            look_again(solver, numbers, impact, False)
    find_shifts(solver, h)
    for body in solver.bodies:
        body.by_push += body.push_work
        body.by_friction += body.friction_work


def find_shifts(solver: Solver, h: cython.double) -> cython.void:
    """Find out since when, in the mean, the impulses on each group have acted in a step of h s.

    The engine moves bodies by the velocities that they had before. A force that lasts has acted
    half of the step, and so has all that it makes others do: no body has got more momentum than
    drives, floors, joints and pulls have given. Else it was an impact: it acted since bodies came
    to touch. Of what touched before nothing is known. `floor.hold` counts on forces that last.
    """
    for body in solver.bodies:
        body.held_by, body.lasting = 0.0, True
    for tie in solver.ties:
        group = group_of(tie.a)
        group.held_by += solver.pull_of(tie)
        if tie.hits and solver.pull_of(tie) > 0.0:
            group.lasting = False
    for body in solver.bodies:
        group = group_of(body)
        if body.engaged:
            group.held_by += solver.used_by(body)
        if body.pulled:
            group.held_by += length(body.pull_x, body.pull_y) * h
    for body in solver.bodies:
        group = group_of(body)
        gained: cython.double = body.mass * length(
            body.after_x - body.before_x, body.after_y - body.before_y
        )
        if gained > group.held_by * (1 + 1e-9):
            group.lasting = False
    middle: cython.double = h / 2 if solver.ties else 0.0
    for body in solver.bodies:
        group = group_of(body)
        body.eased = not group.lasting and group.hit_power > 0.0
        body.applied_x = body.applied_y = body.applied_turn = 0.0
        body.known = group.lasting and body.pressure == 0.0
        if group.lasting:
            body.shift = h / 2
            if body.engaged and not body.is_robot:
                solver.take_reaction(body)
                x: cython.double = body.mass * (body.after_x - body.before_x)
                y: cython.double = body.mass * (body.after_y - body.before_y)
                turned: cython.double = body.moment * (body.spin - body.before_spin)
                body.applied_x = (x - body.reaction_x) / h - body.pull_x
                body.applied_y = (y - body.reaction_y) / h - body.pull_y
                body.applied_turn = (turned - body.reaction_turn) / h - body.pull_torque
        elif group.hit_power > 0.0:
            body.shift = middle + group.hit_depth / group.hit_power
        else:
            body.shift = middle


def take_hits(solver: Solver, numbers: list[Body], impact: Impact, h: cython.double) -> cython.void:
    """Find the groups that touch, the impulses on each body, and how they work."""
    for i in range(solver.arbiters.count()):
        arbiter: Arbiter = solver.arbiters.at(i)
        impact.take(arbiter, numbers)
        pushes: cython.bint = False
        for k in range(chipmunk.count_of(arbiter)):
            pushes = pushes or arbiter.contacts[k].jnAcc != 0.0
        if not pushes:
            continue
        join_groups(impact.a, impact.b)
        for k in range(chipmunk.count_of(arbiter)):
            impact.look_at(arbiter, k)
            impact.hit()
            impact.work(arbiter.contacts[k].bounce, h)


def look_again(
    solver: Solver, numbers: list[Body], impact: Impact, at_power: cython.bint
) -> cython.void:
    """Find the power of contacts' impulses on the motion due to them alone, or again their work."""
    for body in solver.bodies:
        if at_power:
            body.push_power = body.friction_power = 0.0
        else:
            body.push_work = body.friction_work = 0.0
    for i in range(solver.arbiters.count()):
        arbiter: Arbiter = solver.arbiters.at(i)
        impact.take(arbiter, numbers)
        for k in range(chipmunk.count_of(arbiter)):
            impact.look_at(arbiter, k)
            if at_power:
                impact.power()
            else:
                impact.work(0.0, 0.0)


def weaken_contacts(solver: Solver) -> cython.bint:
    """Weaken contacts that add energy, or more rebound than their restitution; return if any do."""
    weaken: cython.bint = False
    for body in solver.bodies:
        if body.group is body:
            body.share = share_of(body)
            weaken = weaken or body.share < 1.0
    if weaken:
        for body in solver.bodies:
            weaken_body(body, body.hit_x, body.hit_y, body.hit_turn)
    return weaken


def share_of(group: Body) -> cython.double:
    """Return the share of their impulses that a group's contacts may keep, and let that work.

    Contacts that keep a share s of all impulses J work s (W - (1 - s) Q), with W their work now,
    and Q the kinetic energy that J alone would give. Their rebound, the sum of J (u' + e u) along
    normals, is too large by s (R - (1 - s) P), with R what it is now, and P the power of J on the
    velocities that J alone would give.
    """
    energy: cython.double = (group.push_power + group.friction_power) / 2
    share: cython.double = 1.0
    work: cython.double = group.push_work + group.friction_work
    if work > spare(group) * energy:
        share = min(share, 1.0 - work / max(energy, 1e-300))
    if group.crowd <= FEW_BODIES and group.excess > REBOUND * group.push_power:
        share = min(share, 1.0 - group.excess / max(group.push_power, 1e-300))
    share = max(share, 0.0)
    group.push_work = share * (group.push_work - (1 - share) * group.push_power / 2)
    group.friction_work = share * (group.friction_work - (1 - share) * group.friction_power / 2)
    return share


def spare(group: Body) -> cython.double:
    """Return the part of the energy of a group's impulses that these may add to it.

    Where drives push, the solver leaves some of either sign, and bodies would sink into each other.
    """
    if not group.driven:
        return 0.0
    return DRIVEN if group.crowd <= DRIVEN_BODIES else 1e300


def weaken_body(body: Body, x: cython.double, y: cython.double, turn: cython.double) -> cython.void:
    """Take back all but its group's share of impulses x, y and turn on a body."""
    group = group_of(body)
    share = group.share
    if share >= 1.0:
        return
    body.after_x -= (1 - share) * x / body.mass
    body.after_y -= (1 - share) * y / body.mass
    body.spin -= (1 - share) * turn / body.moment
    body.hit_x *= share
    body.hit_y *= share
    body.hit_turn *= share


def scale_all(solver: Solver, numbers: list[Body], impact: Impact) -> cython.void:
    """Let the solver remember only the part of the contacts' impulses that they keep."""
    for i in range(solver.arbiters.count()):
        impact.take(solver.arbiters.at(i), numbers)
        group = group_of(impact.a)
        if group.share < 1.0:
            chipmunk.scale(solver.arbiters.at(i), group.share)


def take_holds(solver: Solver, h: cython.double) -> cython.void:
    """Find the groups that joints hold, and the impulses on them that no drive or pull explains."""
    for tie in solver.ties:
        if tie.is_rope and not tie.springy and solver.pull_of(tie) == 0.0:
            continue
        tie.a.tied = tie.b.tied = True
        join_groups(tie.a, tie.b)
        group = group_of(tie.a)
        group.springy = group.springy or tie.springy
    for body in solver.bodies:
        body.held_x = body.mass * (body.after_x - body.before_x)
        body.held_y = body.mass * (body.after_y - body.before_y)
        body.held_turn = body.moment * (body.spin - body.before_spin)
        if body.pulled:
            body.held_x -= body.pull_x * h
            body.held_y -= body.pull_y * h
            body.held_turn -= body.pull_turn * h
        if body.engaged:
            solver.take_reaction(body)
            body.held_x -= body.reaction_x
            body.held_y -= body.reaction_y
            body.held_turn -= body.reaction_turn


def weaken_holds(solver: Solver) -> cython.bint:
    """Weaken joints and contacts that together add energy; return whether any do.

    Those of a group with a spring may: it gives what it took before.
    """
    for body in solver.bodies:
        body.hold_work = body.hold_energy = 0.0
        body.share = 1.0
    for body in solver.bodies:
        group = group_of(body)
        group.hold_work += (
            body.held_x * (body.before_x + body.after_x)
            + body.held_y * (body.before_y + body.after_y)
            + body.held_turn * (body.before_spin + body.spin)
        ) / 2
        group.hold_energy += (
            (body.held_x * body.held_x + body.held_y * body.held_y) / body.mass
            + body.held_turn * body.held_turn / body.moment
        ) / 2
        group.tied = group.tied or body.tied
    weaken: cython.bint = False
    for body in solver.bodies:
        if not (body.group is body and body.tied) or body.springy:
            continue
        if body.hold_work > spare(body) * body.hold_energy:
            body.share = max(1.0 - body.hold_work / max(body.hold_energy, 1e-300), 0.0)
            weaken = weaken or body.share < 1.0
    if weaken:
        for body in solver.bodies:
            weaken_body(body, body.held_x, body.held_y, body.held_turn)
    return weaken
