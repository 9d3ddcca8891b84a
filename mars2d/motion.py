"""How robots move that nothing touches, in closed form."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["chord_velocity"]

Float = NDArray[np.float64]
Mask = NDArray[np.bool_]


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
