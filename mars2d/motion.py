"""Motion: the state of what moves bodies, how their points move, arcs in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["Motion", "chord_velocity", "point_velocity"]

Float = NDArray[np.float64]
Mask = NDArray[np.bool_]
Index = NDArray[np.integer[Any]]


class Motion:
    """What moves a world's bodies; `_state` (N, 6) are their x, y, theta, x', y', theta' now."""

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

    state: (N, 6) of all bodies, or what else begins with their poses. velocity: (N, 3) of theirs.
    """
    result = np.zeros((len(body), 2))
    moves = body >= 0
    who = body[moves]
    vx, vy, spin = velocity[who].T
    x, y = (point[moves] - state[who, :2]).T
    result[moves] = np.column_stack([vx - spin * y, vy + spin * x])
    return result


def chord_velocity(twist: Float, theta: Float, h: float, in_robot_frame: Mask) -> Float:
    """Return (k, 3): the velocities that bring robots at headings (k,) along their arcs in h.

    twist: (3, k), of which the first two are along the robot's axes or the world's.
    Source: the arc of radius v / omega seen as its chord, of length v h sinc(omega h / 2) in the
    direction theta + omega h / 2.
    """
    forward, left, spin = twist
    half = np.where(in_robot_frame, spin * (h / 2), 0.0)
    turned = np.where(in_robot_frame, theta + half, 0.0)
    shrink = np.where(half == 0.0, 1.0, np.sin(half) / np.where(half == 0.0, 1.0, half))
    c, s = shrink * np.cos(turned), shrink * np.sin(turned)
    velocity = np.empty((len(theta), 3))
    velocity[:, 0] = forward * c - left * s
    velocity[:, 1] = forward * s + left * c
    velocity[:, 2] = spin
    return velocity
