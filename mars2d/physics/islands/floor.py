"""The floor: its friction against the sliding and spinning of props.

A body that lies flat and moves at v, turning at omega, is held by a force F u / d against v and a
torque F k s / d against omega, where F = mu m g, u = |v|, s = k |omega|, d = sqrt(u^2 + s^2), and
the lever k is the mean distance of the body's points from its centre of mass. So a body that only
slides is held by F, one that only spins by F k, and one that does both by less of either: a body
that is pushed turns easily. Source: the ellipsoid in place of the limit surface of S. Goyal, A.
Ruina, J. Papadopoulos, Wear 143, 307 (1991), as in R. D. Howe, M. R. Cutkosky, Int. J. Robotics
Research 15, 531 (1996). At rest F is that of static friction, which may be larger: C. A. Coulomb,
Theorie des machines simples (1785).
"""

from __future__ import annotations

from math import sqrt

from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import length, power
from mars2d.physics.islands.body import Body


def hold(body: Body, h: cython.double) -> cython.void:
    """Set the floor's largest impulses on a body in the next substep of h s.

    What else acts on it is thought to go on. If the floor can stop it within the substep, or hold
    it where it rests, that takes no more than it can: else it shares its force between sliding and
    spinning as for the mean of the velocities before and after, and acts against that mean where it
    is known, elsewhere against the velocity after. On what turns back it acts both ways in turn.
    """
    x: cython.double = (body.applied_x + body.pull_x) * (h / body.mass)
    y: cython.double = (body.applied_y + body.pull_y) * (h / body.mass)
    turn: cython.double = (body.applied_turn + body.pull_torque) * (body.lever * h / body.moment)
    spin: cython.double = body.lever * body.spin
    slide: cython.double = body.slows * h
    twist: cython.double = body.lever * body.stops * h
    rests: cython.bint = length(length(body.vx, body.vy), spin) <= max(1e-6, 0.01 * slide)
    grip: cython.double = body.rest_grip if rests else body.grip
    per: cython.double = 1.0 / (body.lever * body.lever)
    first: cython.double = length(body.vx + x, body.vy + y) * (body.mass / h)
    second: cython.double = abs(spin + turn) * per * (body.moment / h)
    far: cython.double = length(x, y)
    holds: cython.bint = (
        length(far * (body.mass / h), turn * per * (body.moment / h)) <= body.rest_grip
    )
    body.drift_x = body.drift_y = 0.0
    if holds and length(first, second) <= grip:
        body.allowed, body.twist_allowed = grip, grip * body.lever
        return
    u: cython.double = max(length(body.vx + x / 2, body.vy + y / 2), 1e-300)
    s: cython.double = abs(spin + turn / 2)
    # d is that of the mean: what falls by the floor by half of what it takes in the substep.
    d: cython.double = max(length(u, s) - max(slide, twist) / 2, 0.0)
    for _round in range(30):
        first, second = u / max(d + slide / 2, 1e-300), s / max(d + twist / 2, 1e-300)
        over: cython.double = first * first + second * second - 1.0
        if over <= 1e-12:
            break
        slope: cython.double = first * first / max(d + slide / 2, 1e-300)
        slope = slope + second * second / max(d + twist / 2, 1e-300)
        d = d + over / (2 * slope)
    size: cython.double = length(first, second)
    body.allowed = body.grip * (first / size)
    body.twist_allowed = body.twist_grip * (second / size)
    if not body.known:
        return
    speed: cython.double = length(body.vx, body.vy)
    against: cython.double = -body.vx * x - body.vy * y
    if against > 0.9 * speed * far and speed < far + slide:
        # It acts along with the change until the body turns back, and against it from then on.
        left: cython.double = 1.0 - 2.0 * speed / (far + slide)
        body.allowed *= abs(left)
        more: cython.double = max(1.0, slide / far) if left > 0.0 else -max(1.0, slide / far)
        body.drift_x, body.drift_y = body.vx + x - more * x, body.vy + y - more * y
        return
    more = max(1.0, slide / u)
    body.drift_x = body.vx + x - more * (body.vx + x / 2)
    body.drift_y = body.vy + y - more * (body.vy + y / 2)


@cython.cclass
class Glide:
    """How props glide where nothing but the floor acts on them, in closed form."""

    # nodes and weights for integrals from 0 to 1 of functions that bend sharply at 0
    nodes: list[float]
    weights: list[float]
    way: cython.double  # s, the way over the speed at the beginning
    spin_way: cython.double
    left: cython.double  # the share of the speed that is left
    spin_left: cython.double
    # of the two speeds: the one that falls more slowly, the other, and their rates
    slow: cython.double
    other: cython.double
    rate: cython.double
    exponent: cython.double

    def __init__(self, nodes: list[float], weights: list[float]) -> None:
        """Take nodes and weights."""
        self.nodes, self.weights = nodes, weights

    def over(self, body: Body, h: cython.double) -> cython.void:
        """Aim a prop at where it will be after h seconds, and work out its velocity then."""
        if body.vx == 0.0 and body.vy == 0.0 and body.spin == 0.0:
            body.aim_x = body.aim_y = body.aim_spin = 0.0
            body.end_x = body.end_y = body.end_spin = 0.0
            return
        slide: cython.double = body.slows
        turn: cython.double = body.lever * body.stops
        u: cython.double = length(body.vx, body.vy)
        s: cython.double = body.lever * abs(body.spin)
        if u > 0 and s > 0 and slide > 0 and turn > 0:
            self.together(u, s, slide, turn, h)
        else:
            self.way, self.left = self.lasts(u, slide, h), self.remains(u, slide, h)
            self.spin_way, self.spin_left = self.lasts(s, turn, h), self.remains(s, turn, h)
        body.aim_x, body.aim_y = body.vx * (self.way / h), body.vy * (self.way / h)
        body.aim_spin = body.spin * (self.spin_way / h)
        body.end_x, body.end_y = body.vx * self.left, body.vy * self.left
        body.end_spin = body.spin * self.spin_left

    def remains(self, speed: cython.double, rate: cython.double, h: cython.double) -> cython.double:
        """Return the share of a speed that is left at constant deceleration."""
        if speed <= 0 or (rate > 0 and rate * h >= speed):
            return 0.0
        return 1.0 - rate * h / speed

    def lasts(self, speed: cython.double, rate: cython.double, h: cython.double) -> cython.double:
        """Return the way by the initial speed, at constant deceleration."""
        moves: cython.double = h
        if rate > 0 and rate * h >= speed:
            moves = speed / rate
        return moves * (1.0 + self.remains(speed, rate, h)) / 2

    def integral(self, x: cython.double, by: cython.double) -> cython.double:
        """Return the time until x is left of the slow speed; by > 0: weighed by y^by, at y left."""
        total: cython.double = 0.0
        for k in range(len(self.nodes)):
            node: cython.double = self.nodes[k]
            weight: cython.double = self.weights[k]
            node = x + (1 - x) * node
            d: cython.double = length(self.slow, self.other * power(node, self.exponent - 1))
            if by > 0:
                d = d * power(node, by)
            total = total + weight * d
        return (1 - x) * total / self.rate

    def together(
        self,
        u: cython.double,
        s: cython.double,
        slide: cython.double,
        turn: cython.double,
        h: cython.double,
    ) -> cython.void:
        """Let sliding and spinning share the friction.

        With x what is left of the speed b that falls more slowly, and x^e of the other, o, where e
        is the ratio of their rates, the time gone is the integral of sqrt(b^2 + o^2 x^(2 e - 2)) /
        rate from x to 1, and the ways are those of x and x^e times the same.
        """
        sliding: cython.bint = slide <= turn
        self.slow = u if sliding else s
        self.other = s if sliding else u
        self.rate = min(slide, turn)
        self.exponent = max(slide, turn) / self.rate
        x: cython.double = 0.0
        if self.integral(0.0, 0.0) > h:
            x = self.left_after(h)
        way: cython.double = self.integral(x, 1.0)
        other: cython.double = self.integral(x, self.exponent)
        share: cython.double = power(x, self.exponent)
        if sliding:
            self.way, self.spin_way, self.left, self.spin_left = way, other, x, share
        else:
            self.way, self.spin_way, self.left, self.spin_left = other, way, share, x

    def left_after(self, h: cython.double) -> cython.double:
        """Return the slow speed that is left after h seconds, by Newton's method.

        Where that leaves the bounds, they are halved.
        """
        low: cython.double = 0.0
        high: cython.double = 1.0
        d: cython.double = sqrt(self.slow * self.slow + self.other * self.other)
        x: cython.double = max(1 - self.rate * h / max(d, 1e-150), 0.0)
        for _round in range(30):
            gone: cython.double = self.integral(x, 0.0)
            if gone >= h:
                low = x
            if gone <= h:
                high = x
            d = length(self.slow, self.other * power(x, self.exponent - 1))
            better: cython.double = x + (gone - h) * self.rate / max(d, 1e-150)
            if not (low <= better <= high):
                better = (low + high) / 2
            moved: cython.double = abs(better - x)
            x = better
            if moved <= 1e-13:
                break
        return x
