"""Bodies that joints hold: when a rope will be taut, and how long a substep may be.

Points are complex numbers x + i y, in metres.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import inf, sqrt

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.attached_joint import Tie
from mars2d.bodies.joints.hinge import Hinge
from mars2d.bodies.joints.rope import Rope
from mars2d.bodies.joints.spring import Spring
from mars2d.bodies.rigid import Rigid

__all__ = ["TAUT", "Tethers"]

Float = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

SWING = 0.05
"""The longest substep, in periods of a spring over 2 pi."""

TAUT = 1e-6
"""By how much a rope is shorter than said, metres: so it pulls as soon as it is straight."""

BENT = 0.75
"""What part of the stretch allowed a joint may be pulled apart in one substep."""

TINY = 1e-12


class Tethers:
    """The joints of a scenario: which bodies they hold now.

    A rope holds its bodies while it is taut; other joints always do. There is at least one joint.
    """

    def __init__(self, ties: Sequence[Tie], bodies: Sequence[Rigid]) -> None:
        """Take the joints and the bodies at the start."""
        self._count = len(bodies)
        self._ropes = np.array([isinstance(tie.joint, Rope) for tie in ties], dtype=bool)
        self.tied = np.zeros(self._count, dtype=bool)
        """Which bodies have a joint, (N,)."""
        for tie in ties:
            self.tied[[i for i in (tie.a, tie.b) if i >= 0]] = True
        # Arrays (2, k) have their first ends, then their second ones.
        self._body = np.array([(tie.a, tie.b) for tie in ties], dtype=np.intp).T.copy()
        self._fixed = self._body < 0
        joints = [tie.joint for tie in ties]
        self._anchor = np.array(
            [[complex(*end) for end in (joint.anchor_a, joint.anchor_b)] for joint in joints]
        ).T.copy()
        self._length = np.array([tie.length for tie in ties])
        self._springs = np.array([isinstance(tie.joint, Spring) for tie in ties], dtype=bool)
        self.longest_step = min((_swing(tie, bodies) for tie in ties), default=inf)
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
        tight = self._slack <= TAUT
        held[self._body[~self._fixed & tight]] = True
        return held

    def time_to_jerk(self, velocity: Float, bend: Float, stretch: float) -> float:
        """Return how long a substep may be, seconds.

        Until then no rope gets longer by more than `stretch` metres, and no joint is pulled apart
        by more than a part of that, as its ends go straight on where they should go round.

        velocity: (N, 3) of all bodies; bend: (N,) m/s^2, how quickly one may turn away from it.
        """
        (speed_a, speed_b), (turn_a, turn_b) = self._at_the_ends(velocity, bend)
        parting = speed_b - speed_a
        rate = np.maximum(parting.real * self._normal.real + parting.imag * self._normal.imag, 0.0)
        # What moves across a rope or rod lengthens it too.
        across = parting.real * self._normal.imag - parting.imag * self._normal.real
        swing = np.where(self._length > 0, across**2 / np.maximum(self._apart, TINY), 0.0)
        turn = self._turn = turn_a + turn_b + swing
        room = np.maximum(self._slack + stretch, stretch / 64)
        h = 2 * room / (rate + np.sqrt(rate**2 + 2 * turn * room) + TINY)
        jerk = np.where(self._ropes, h, inf)
        tight = (self._slack <= TAUT) & ~self._springs
        # The ends of a hinge may part in any direction at the start, those of a rod along it.
        apart = np.hypot(parting.real, parting.imag)
        along = np.abs(parting.real * self._normal.real + parting.imag * self._normal.imag)
        speed = np.where(self._length > 0, np.where(self._ropes, 0.0, along), apart)
        give = BENT * stretch
        pulled_apart = 2 * give / (speed + np.sqrt(speed**2 + 2 * turn * give) + TINY)
        return float(np.minimum(jerk, np.where(tight, pulled_apart, inf)).min())

    def drift(self, h: float) -> Iterator[tuple[int, float]]:
        """Yield each rope, by its number, and how quickly substeps of h let it get longer, m/s."""
        for k in np.flatnonzero(self._ropes).tolist():
            yield k, float(self._turn[k]) * h

    def _at_the_ends(self, velocity: Float, bend: Float) -> tuple[Complex, Float]:
        """Return the velocities of all ends, (2, k), and how quickly they may turn [m/s^2]."""
        x, y, spin = np.where(self._fixed, 0.0, velocity[self._body].transpose(2, 0, 1))
        ends = x - spin * self._arm_y + 1j * (y + spin * self._arm_x)
        turn = bend[self._body] + spin**2 * np.hypot(self._arm_x, self._arm_y)
        return ends, np.where(self._fixed, 0.0, turn)


def _swing(tie: Tie, bodies: Sequence[Rigid]) -> float:
    """Return the longest substep that resolves how a joint's spring swings, seconds."""
    stiffness = tie.joint.stiffness if isinstance(tie.joint, (Spring, Hinge)) else 0.0
    return SWING / sqrt(stiffness * tie.lightness(bodies)) if stiffness else inf
