"""From single integrators to unicycles and back: the Robotarium's `transformations`.

A point `projection_distance` ahead of a unicycle moves like a single integrator under
v = x' cos(theta) + y' sin(theta), omega = (y' cos(theta) - x' sin(theta)) / projection_distance
(Olfati-Saber, Near-identity diffeomorphisms and exponential tracking, CDC 2002).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]
Mapping = Callable[[Float, Float], Float]


def slowed(velocities: Float, limit: float) -> Float:
    """Return velocities (2, n) in the same directions, no quicker than a limit."""
    speed = np.hypot(*velocities)
    return np.asarray(velocities * np.minimum(1, limit / np.fmax(speed, 1e-12)))


def create_si_to_uni_mapping(
    projection_distance: float = 0.05, angular_velocity_limit: float = np.pi
) -> tuple[Mapping, Callable[[Float], Float]]:
    """Return a function of (dxi (2, n), poses (3, n)) that gives (v, omega), and one of poses.

    The second gives the points ahead of the robots, which move like single integrators.
    """

    def commands(dxi: Float, poses: Float) -> Float:
        c, s = np.cos(poses[2]), np.sin(poses[2])
        v = c * dxi[0] + s * dxi[1]
        omega = (c * dxi[1] - s * dxi[0]) / projection_distance
        return np.array([v, np.clip(omega, -angular_velocity_limit, angular_velocity_limit)])

    def points(poses: Float) -> Float:
        ahead = np.array([np.cos(poses[2]), np.sin(poses[2])])
        return np.asarray(poses[:2] + projection_distance * ahead)

    return commands, points


def create_uni_to_si_dynamics(projection_distance: float = 0.05) -> Mapping:
    """Return a function of (dxu (2, n), poses (3, n)): the velocities of the points ahead."""

    def velocities(dxu: Float, poses: Float) -> Float:
        c, s = np.cos(poses[2]), np.sin(poses[2])
        v, across = dxu[0], projection_distance * dxu[1]
        return np.array([c * v - s * across, s * v + c * across])

    return velocities


def create_si_to_uni_dynamics(
    linear_velocity_gain: float = 1, angular_velocity_limit: float = np.pi
) -> Mapping:
    """Return a function of (dxi, poses): forward where dxi leads, and a turn towards it.

    omega = angular_velocity_limit * angle / (pi / 2), with the angle from the heading to dxi.
    """

    def commands(dxi: Float, poses: Float) -> Float:
        c, s = np.cos(poses[2]), np.sin(poses[2])
        ahead, left = c * dxi[0] + s * dxi[1], c * dxi[1] - s * dxi[0]
        omega = angular_velocity_limit * np.arctan2(left, ahead) / (np.pi / 2)
        return np.array([linear_velocity_gain * ahead, omega])

    return commands


def create_si_to_uni_dynamics_with_backwards_motion(
    linear_velocity_gain: float = 1, angular_velocity_limit: float = np.pi
) -> Mapping:
    """Return the same for robots that may also drive backwards, whichever turn is less."""

    def commands(dxi: Float, poses: Float) -> Float:
        c, s = np.cos(poses[2]), np.sin(poses[2])
        ahead, left = c * dxi[0] + s * dxi[1], c * dxi[1] - s * dxi[0]
        way = np.where(ahead < 0, -1.0, 1.0)
        omega = angular_velocity_limit * np.arctan2(way * left, np.abs(ahead)) / (np.pi / 2)
        return np.array([linear_velocity_gain * ahead, omega])

    return commands
