"""Rope limits: when joints hold their bodies, and how long a substep may be.

Points are complex numbers x + i y, in metres.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import inf
from typing import Any

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
from mars2d.bodies.joints.base import AttachedJoint
from mars2d.bodies.rigid import Rigid
from mars2d.core.plane import TINY
from mars2d.physics.settings import BENT, SWING, TAUT

__all__ = ["RopeLimits"]

Float = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]


class RopeLimits:
    """The joints of a scenario, at least one: which bodies they hold now.

    A largest distance, such as a rope's, holds its bodies while it is taut; other constraints
    always do.
    """

    def __init__(self, joints: Sequence[AttachedJoint], bodies: Sequence[Rigid]) -> None:
        """Take the joints, and the bodies at the start."""
        self._count = len(bodies)
        self._ropes = _which(joints, MaxDistance)
        self._always = _which(joints, Constraint, but=MaxDistance)
        self._rigid = _which(joints, (MaxDistance, FixedDistance, Pin))
        self.tied = np.zeros(self._count, dtype=bool)
        """Which bodies have a joint, (N,)."""
        for joint in joints:
            self.tied[[i for i in (joint.a, joint.b) if i >= 0]] = True
        # Arrays (2, k) have the first ends of joints, then their second ones.
        self._body = np.array([(joint.a, joint.b) for joint in joints], dtype=np.intp).T.copy()
        self._fixed = self._body < 0
        ends = [(each.joint.anchor_a, each.joint.anchor_b) for each in joints]
        self._anchor = np.array([[complex(*a), complex(*b)] for a, b in ends]).T.copy()
        self._length = np.array([joint.length for joint in joints])
        self.longest_step = min((_swing(joint, bodies) for joint in joints), default=inf)
        """The longest substep that the springs allow, seconds."""

    def measure(self, state: Float) -> None:
        """Take the states (N, 6) of all bodies."""
        x, y, heading = np.where(self._fixed, 0.0, state[self._body, :3].transpose(2, 0, 1))
        c, s = np.cos(heading), np.sin(heading)
        along, across = self._anchor.real, self._anchor.imag
        self._arm_x, self._arm_y = c * along - s * across, s * along + c * across
        a, b = x + 1j * y + (self._arm_x + 1j * self._arm_y)
        between = b - a
        apart = np.hypot(between.real, between.imag)
        self._normal = between / np.maximum(apart, TINY)
        self._apart = apart
        self._slack = np.where(self._ropes, self._length - apart, 0.0)

    def held(self) -> Mask:
        """Return which bodies a joint holds, (N,): a rope does while it is taut."""
        held = np.zeros(self._count, dtype=bool)
        holds = self._always | (self._slack <= TAUT)
        held[self._body[~self._fixed & holds]] = True
        return held

    def time_to_jerk(self, velocity: Float, bend: Float, stretch: float) -> float:
        """Return how long a substep may be, seconds.

        Until then no rope gets longer by more than `stretch` metres, and no joint is pulled apart
        by more than a part of that, since its ends go straight on instead of round.

        velocity: (N, 3) of all bodies; bend: (N,) m/s^2, how fast it may change.
        """
        (speed_a, speed_b), (turn_a, turn_b) = self._at_the_ends(velocity, bend)
        parting = speed_b - speed_a
        rate = np.maximum(parting.real * self._normal.real + parting.imag * self._normal.imag, 0.0)
        # Motion across a rope or rod lengthens it, too.
        across = parting.real * self._normal.imag - parting.imag * self._normal.real
        swing = np.where(self._length > 0, across**2 / np.maximum(self._apart, TINY), 0.0)
        turn = self._turn = turn_a + turn_b + swing
        room = np.maximum(self._slack + stretch, stretch / 64)
        h = 2 * room / (rate + np.sqrt(rate**2 + 2 * turn * room) + TINY)
        jerk = np.where(self._ropes, h, inf)
        tight = (self._slack <= TAUT) & self._rigid
        # The ends of a hinge may part in any direction at the start, those of a rod along it.
        apart = np.hypot(parting.real, parting.imag)
        along = np.abs(parting.real * self._normal.real + parting.imag * self._normal.imag)
        speed = np.where(self._length > 0, np.where(self._ropes, 0.0, along), apart)
        give = BENT * stretch
        pulled_apart = 2 * give / (speed + np.sqrt(speed**2 + 2 * turn * give) + TINY)
        return float(np.minimum(jerk, np.where(tight, pulled_apart, inf)).min())

    def drift(self, h: float) -> Iterator[tuple[int, float]]:
        """Yield each rope's number, and how fast substeps of h seconds let it get longer, m/s."""
        for k in np.flatnonzero(self._ropes).tolist():
            yield k, float(self._turn[k]) * h

    def _at_the_ends(self, velocity: Float, bend: Float) -> tuple[Complex, Float]:
        """Return the velocities of all ends, (2, k), and how fast these may turn [m/s^2]."""
        x, y, spin = np.where(self._fixed, 0.0, velocity[self._body].transpose(2, 0, 1))
        ends = x - spin * self._arm_y + 1j * (y + spin * self._arm_x)
        turn = bend[self._body] + spin**2 * np.hypot(self._arm_x, self._arm_y)
        return ends, np.where(self._fixed, 0.0, turn)


def _which(joints: Sequence[AttachedJoint], kinds: Any, but: Any = ()) -> Mask:
    """Return which joints have a constraint of these kinds, leaving out others, (k,)."""
    return np.array(
        [
            any(isinstance(each, kinds) and not isinstance(each, but) for each in joint.constraints)
            for joint in joints
        ],
        dtype=bool,
    )


def _swing(joint: AttachedJoint, bodies: Sequence[Rigid]) -> float:
    """Return the longest substep that resolves how a joint's springs swing, seconds."""
    springs = [each for each in joint.constraints if isinstance(each, SpringDamper | TurningSpring)]
    return min((SWING / joint.frequency(s, bodies) for s in springs if s.stiffness), default=inf)
