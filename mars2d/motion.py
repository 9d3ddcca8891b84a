"""How bodies move that nothing touches, in closed form: on arcs, and sliding to rest.

Coulomb's friction slows what slides at a constant rate, whatever its speed: mu g. It slows a spin
at mu m g lever / moment, where the lever is the mean distance of the body's points from its centre
of mass. Both act as if the other were not there; for a body that slides and spins at once that is
an approximation.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["GRAVITY", "chord_velocity", "glide"]

Float = NDArray[np.float64]
Mask = NDArray[np.bool_]

GRAVITY = 9.81
"""The acceleration of gravity, m/s^2."""


def glide(velocity: Float, slowing: Float, h: float) -> tuple[Float, Float]:
    """Return how far bodies slide in h seconds, and their velocities then, (k, 3) each.

    velocity: (k, 3) = x', y' [m/s], theta' [rad/s]. slowing: (k, 2) of the speed [m/s^2] and of
    the spin [rad/s^2]; 0 for what slides for ever.

    >>> moved, end = glide(np.array([[2.0, 0.0, 1.0]]), np.array([[4.0, 0.0]]), 3.0)
    >>> moved.tolist(), end.tolist()  # it stops after v^2 / (2 a), and goes on turning
    ([[0.5, 0.0, 3.0]], [[0.0, 0.0, 1.0]])
    """
    speed = np.column_stack([np.hypot(velocity[:, 0], velocity[:, 1]), np.abs(velocity[:, 2])])
    stops = slowing * h >= speed  # at rest from the start, or within h
    slides = ~stops & (slowing > 0)
    lost = np.where(slides, slowing * h / np.where(slides, speed, 1.0), 0.0)
    left = np.where(stops, 0.0, 1.0 - lost)
    lasts = np.where(stops & (slowing > 0), speed / np.where(slowing > 0, slowing, 1.0), h)
    mean = lasts * (1.0 + left) / 2
    return velocity * mean[:, [0, 0, 1]], velocity * left[:, [0, 0, 1]]


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
