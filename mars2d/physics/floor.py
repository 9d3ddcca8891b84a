"""The floor: its friction against the sliding and spinning of props.

A body that lies flat and moves at v, turning at omega, is held by a force F u / d against v and a
torque F k s / d against omega, where F = mu m g, u = |v|, s = k |omega|, d = sqrt(u^2 + s^2), and
the lever k is the mean distance of the body's points from its centre of mass. So a body that only
slides is held by F, one that only spins by F k, and one that does both by less of either: a body
that is pushed turns easily. Source: the ellipsoid in place of the limit surface of S. Goyal, A.
Ruina, J. Papadopoulos, Wear 143, 307 (1991), as in R. D. Howe, M. R. Cutkosky, Int. J. Robotics
Research 15, 531 (1996).

A prop that nothing touches glides in closed form. Otherwise the solver moves it, and the floor
holds it by joints of bounded force and torque.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.props.base import Prop
from mars2d.core.materials import GRAVITY
from mars2d.physics.collision import Bounds
from mars2d.physics.space import Space
from mars2d.scenario.scenario import Scenario

__all__ = ["GRAVITY", "Floor", "FloorJoints"]

Float = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

RESTS = 1e-6
"""A body that moves no faster is held as if at rest, m/s."""

MAX_ROUNDS = 30
CLOSE = 1e-13
"""Newton's method ends after `MAX_ROUNDS`, or after a step of `CLOSE` at most."""


def _quadrature(count: int) -> tuple[Float, Float]:
    """Return nodes and weights for integrals from 0 to 1 of functions that bend sharply at 0.

    They are those of Gauss and Legendre in t, where the variable of the integrals is t^3.
    """
    t, weight = np.polynomial.legendre.leggauss(count)
    t = (t + 1) / 2
    return t[:, None] ** 3, 1.5 * weight * t**2


NODES, WEIGHTS = _quadrature(20)


class Floor:
    """The friction between the floor and p props.

    force: (p,) N, the largest against sliding. torque: (p,) N m, the largest against spinning.
    """

    def __init__(self, props: Sequence[Prop]) -> None:
        """Take the props."""
        inertia = [prop.inertia for prop in props]
        mass = np.array([i.mass for i in inertia])
        moment = np.array([i.moment for i in inertia])
        self._lever = np.array([prop.shape.lever for prop in props])
        self.force = np.array([prop.ground_friction for prop in props]) * mass * GRAVITY
        self.torque = self.force * self._lever
        self._slide, self._spin = (self.force / mass, self.torque / moment)  # m/s^2, rad/s^2

    def bounds(self, velocity: Float, held: Float, who: Index) -> tuple[Float, Float]:
        """Return the largest force [N] and torque [N m] against bodies `who`, (k,) each.

        velocity: (k, 3). held: (k, 2) force and torque of the floor on them in the last substep: a
        body at rest is held by both together as by either alone.
        """
        force, torque, lever = self.force[who], self.torque[who], self._lever[who]
        u, s = np.hypot(velocity[:, 0], velocity[:, 1]), lever * np.abs(velocity[:, 2])
        d = np.hypot(u, s)
        moves = d > RESTS
        share = np.column_stack([u, s]) / np.where(moves, d, 1.0)[:, None]
        limits = np.maximum(np.column_stack([force, torque]), np.finfo(float).tiny)
        used = held / limits
        over = np.maximum(np.hypot(used[:, 0], used[:, 1]), 1.0)
        at_rest = np.where(over[:, None] > 1.0, used / over[:, None], 1.0)
        first, second = np.where(moves[:, None], share, at_rest).T
        return force * first, torque * second

    def braking(self, velocity: Float, reach: Float, who: Index) -> Float:
        """Return the largest deceleration of points of bodies `who`, (k,) m/s^2.

        velocity: (k, 3). reach: (k,) metres, how far points lie from the bodies' poses.
        """
        slides, spins = (velocity[:, :2] != 0.0).any(axis=1), velocity[:, 2] != 0.0
        return np.asarray(self._slide[who] * slides + self._spin[who] * spins * reach)

    def glide(self, velocity: Float, who: Index, h: float) -> tuple[Float, Float]:
        """Return how far bodies `who` slide in h seconds, and their velocities then, (k, 3) each.

        velocity: (k, 3) = x', y' [m/s], theta' [rad/s], where nothing else acts on them.
        """
        if not velocity.any():
            rest = velocity * 0.0
            return rest, rest
        slide, lever = self._slide[who], self._lever[who]
        turn = lever * self._spin[who]
        u, s = np.hypot(velocity[:, 0], velocity[:, 1]), lever * np.abs(velocity[:, 2])
        both = np.flatnonzero((u > 0) & (s > 0) & (slide > 0) & (turn > 0))
        way, left = _alone(np.stack([u, s]), np.stack([slide, turn]), h)
        if len(both):
            speeds, rates = (np.stack([u[both], s[both]]), np.stack([slide[both], turn[both]]))
            way[:, both], left[:, both] = _together(speeds, rates, h)
        pick = [0, 0, 1]
        return velocity * way[pick].T, velocity * left[pick].T


def _alone(speed: Float, rate: Float, h: float) -> tuple[Float, Float]:
    """Return ways by initial speeds [s], and the shares of these left, at constant deceleration."""
    stops = (rate * h >= speed) & (rate > 0)
    lasts = np.where(stops, speed / np.where(rate > 0, rate, 1.0), h)
    left = np.where(stops, 0.0, 1.0 - rate * lasts / np.where(speed > 0, speed, 1.0))
    left = np.where(speed > 0, left, 0.0)
    return lasts * (1.0 + left) / 2, left


def _together(speed: Float, rate: Float, h: float) -> tuple[Float, Float]:
    """Return the same where sliding and spinning share the friction; speed, rate: (2, k).

    With x what is left of the speed b that falls more slowly, and x^e of the other, o, where e is
    the ratio of their rates, the time gone is the integral of sqrt(b^2 + o^2 x^(2 e - 2)) / rate
    from x to 1, and the ways are those of x and x^e times the same.
    """
    slow = np.argmin(rate, axis=0)
    column = np.arange(speed.shape[1])
    b, o = speed[slow, column], speed[1 - slow, column]
    slower, exponent = rate[slow, column], rate[1 - slow, column] / rate[slow, column]

    def integral(x: Float, power: Float | None = None) -> Float:
        nodes = x + (1 - x) * NODES
        d = np.hypot(b, o * nodes ** (exponent - 1))
        if power is not None:
            d *= nodes**power
        return np.asarray((1 - x) * (WEIGHTS @ d) / slower)

    zero, one = np.zeros_like(b), np.ones_like(b)
    stops = integral(zero) <= h
    low, high = zero, one
    x = np.maximum(1 - slower * h / np.maximum(np.hypot(b, o), 1e-150), 0.0)
    for _ in range(MAX_ROUNDS):  # Newton's method, with bisection where that leaves the bounds
        gone = integral(x)
        low, high = np.where(gone >= h, x, low), np.where(gone <= h, x, high)
        rate_now = np.maximum(np.hypot(b, o * x ** (exponent - 1)), 1e-150)
        step = x + (gone - h) * slower / rate_now
        better = np.where((step >= low) & (step <= high), step, (low + high) / 2)
        moved, x = np.abs(better - x), better
        if (stops | (moved <= CLOSE)).all():
            break
    x = np.where(stops, 0.0, x)
    way, left = np.empty_like(speed), np.empty_like(speed)
    way[slow, column], way[1 - slow, column] = integral(x, one), integral(x, exponent)
    left[slow, column], left[1 - slow, column] = x, x**exponent
    return way, left


class FloorJoints:
    """The floor under the props, as it acts on bodies that the solver may move.

    In the methods, `who` (m,) are the numbers of some props among all bodies, `state` (m, 6) and
    `slipping` (m,) theirs; a prop slips while something touches or holds it.
    """

    def __init__(self, scenario: Scenario, space: Space, bounds: Bounds) -> None:
        """Take the scenario with the props, the space with their bodies, and their bounds."""
        self._space = space
        self._first = len(scenario.robots)
        self._floor = Floor(scenario.props)
        self._reach = bounds.reach
        self._allowed = np.zeros((len(scenario.props), 2))  # N and N m, what the floor may use now

    def glide(self, state: Float, who: Index, h: float) -> tuple[Float, Float]:
        """Return how far props slide in h seconds, and their velocities then, (m, 3) each."""
        return self._floor.glide(state[:, 3:], who - self._first, h)

    def bears(self, velocity: Float, body: int, force: float, torque: float) -> bool:
        """Return whether a prop with a velocity (3,) stays at rest under a force and a torque."""
        prop = body - self._first
        most, spin = float(self._floor.force[prop]), float(self._floor.torque[prop])
        if velocity.any() or not most:
            return False
        return (force / most) ** 2 + (torque / spin) ** 2 <= 1.0

    def motion(self, state: Float, slipping: Mask, who: Index) -> tuple[Float, Float]:
        """Return the velocities of props, (m, 3), and how fast these may change, (m,) m/s^2."""
        velocity = state[:, 3:]
        braking = self._floor.braking(velocity, self._reach[who], who - self._first)
        return velocity, np.where(slipping, 0.0, braking)

    def aim(self, state: Float, slipping: Mask, who: Index, h: float) -> None:
        """Set the velocities of props, and the floor's limits, for a substep of h seconds.

        A gliding prop gets its velocity at the end, so that the solver has the right one for an
        impact. With that it would not go far enough, so it is put ahead by the difference.
        """
        self._space.velocity[who] = state[:, 3:]
        glides = np.flatnonzero(~slipping & state[:, 3:].any(axis=1))
        if len(glides):
            moved, end = self.glide(state, who, h)
            self._space.velocity[who[glides]] = end[glides]
            ahead = (state[:, :3] + moved - end * h)[glides]
            for i, pose in zip(who[glides].tolist(), ahead.tolist(), strict=True):
                self._space.place(i, *pose)
        self._hold(state, slipping, who)

    def _hold(self, state: Float, slipping: Mask, who: Index) -> None:
        """Let the floor hold props that slip; a prop at rest is free until it is hit."""
        props = who - self._first
        allowed = np.zeros((len(who), 2))
        rows = np.flatnonzero(slipping)
        if len(rows):
            held = np.array([self._space.held(i) for i in who[rows].tolist()])
            bounds = self._floor.bounds(state[rows, 3:], held, props[rows])
            allowed[rows] = np.column_stack(bounds)
        changed = (allowed != self._allowed[props]).any(axis=1)
        self._allowed[props] = allowed
        for i, limits in zip(who[changed].tolist(), allowed[changed].tolist(), strict=True):
            self._space.hold(i, *limits)
