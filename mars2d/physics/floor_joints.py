"""Floor joints: friction of the floor on props while something may touch them.

A prop that nothing touches glides in closed form. Otherwise the solver moves it, and the floor
holds it by joints of bounded force and torque.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.physics.collision import Bounds
from mars2d.physics.floor import Floor
from mars2d.physics.space import Space
from mars2d.scenario.scenario import Scenario

__all__ = ["FloorJoints"]

Float = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]


class FloorJoints:
    """The floor under the props, as it acts on bodies.

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
        """Set the velocities of props, and what the floor may use, for a substep of h seconds.

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
