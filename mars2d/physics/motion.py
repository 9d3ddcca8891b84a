"""Motion: the state of moving bodies, velocities of their points, arcs in closed form."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["Arcs", "Motion", "Start", "point_velocity"]

Float = NDArray[np.float64]
Mask = NDArray[np.bool_]
Index = NDArray[np.integer[Any]]


class Start(NamedTuple):
    """How bodies move at an instant: their states (N, 6), which of them slip (N,), twists (3, n).

    A state is x, y [m], theta [rad], and their rates; a twist is the velocity that a drive is asked
    for.
    """

    state: Float
    slipping: Mask
    twist: Float

    def moved(self, poses: Mapping[int, tuple[float, float, float]]) -> Start:
        """Return a copy with some bodies at rest at other poses."""
        state, slipping = self.state.copy(), self.slipping.copy()
        for body, pose in poses.items():
            state[body] = (*pose, 0.0, 0.0, 0.0)
            slipping[body] = False
        return Start(state, slipping, self.twist)


class Motion:
    """The base of engines. `_state` (N, 6) holds x, y, theta, x', y', theta' of all bodies."""

    _state: Float

    @property
    def pose(self) -> Float:
        """The poses (3, N): x, y [m], theta [rad], as a new array."""
        return self._state[:, :3].T.copy()

    @property
    def velocity(self) -> Float:
        """The velocities (3, N): x', y' [m/s], theta' [rad/s], as a new array."""
        return self._state[:, 3:].T.copy()


def point_velocity(state: Float, velocity: Float, body: Index, point: Float) -> Float:
    """Return the velocities (k, 2) of points (k, 2) of bodies (k,); negative ones stand still.

    state: (N, 6) of all bodies, or any array that begins with poses. velocity: (N, 3).
    """
    result = np.zeros((len(body), 2))
    moves = body >= 0
    who = body[moves]
    vx, vy, spin = velocity[who].T
    x, y = (point[moves] - state[who, :2]).T
    result[moves] = np.column_stack([vx - spin * y, vy + spin * x])
    return result


class Arcs:
    """How k robots move under constant twists: along arcs, or straight on as they turn.

    spin: (k,) rad/s, how quickly they turn.
    """

    def __init__(self, twist: Float, in_robot_frame: Mask) -> None:
        """Take the twists (3, k), and which of them are in the robot's frame, (k,)."""
        self._twist, self._in_robot_frame = twist, in_robot_frame
        self._forward, self._left, self.spin = twist
        self._turning = np.where(in_robot_frame, self.spin, 0.0)
        self._straight = None if in_robot_frame.all() else ~in_robot_frame

    def take(self, which: Index) -> Arcs:
        """Return those of some of the robots."""
        return Arcs(self._twist[:, which], self._in_robot_frame[which])

    @property
    def bend(self) -> Float:
        """How fast their velocities turn, (k,) m/s^2."""
        return np.asarray(np.abs(np.hypot(self._forward, self._left) * self._turning))

    def chord(self, theta: Float, h: float) -> Float:
        """Return (..., k, 3): the velocities that lead from headings (..., k) to the arcs' ends.

        h: seconds until then. Source: the arc of radius v / omega seen as its chord, of length
        v h sinc(omega h / 2) in the direction theta + omega h / 2.
        """
        half = self._turning * (h / 2)
        turned = theta + half
        if self._straight is not None:
            turned[..., self._straight] = 0.0
        c, s = np.cos(turned), np.sin(turned)
        if np.count_nonzero(half):
            zero = half == 0.0
            shrink = (np.sin(half) + zero) / (half + zero)
            c, s = shrink * c, shrink * s
        velocity = np.empty((*theta.shape, 3))
        velocity[..., 0] = self._forward * c - self._left * s
        velocity[..., 1] = self._forward * s + self._left * c
        velocity[..., 2] = self.spin
        return velocity
