"""Laws that lead robots to points and poses: the Robotarium's `controllers`."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "create_clf_unicycle_pose_controller",
    "create_clf_unicycle_position_controller",
    "create_si_position_controller",
]

Float = NDArray[np.float64]
Law = Callable[[Float, Float], Float]


def create_si_position_controller(
    x_velocity_gain: float = 1, y_velocity_gain: float = 1, velocity_magnitude_limit: float = 0.15
) -> Law:
    """Return a function of points and goals (2, n): velocities in proportion, up to a limit."""

    def velocities(xi: Float, positions: Float) -> Float:
        gains = np.array([[x_velocity_gain], [y_velocity_gain]])
        wanted = gains * (np.asarray(positions)[:2] - np.asarray(xi)[:2])
        speed = np.hypot(*wanted)
        return np.asarray(wanted * np.minimum(1, velocity_magnitude_limit / np.fmax(speed, 1e-12)))

    return velocities


def create_clf_unicycle_position_controller(
    linear_velocity_gain: float = 0.8, angular_velocity_gain: float = 3
) -> Law:
    """Return a function of poses (3, n) and goals (2, n) that gives (v, omega).

    v = k d cos(a), omega = k_a a, with the distance d of the goal and its angle a from the heading,
    a control Lyapunov function of the polar coordinates (Aicardi et al., Closed loop steering of
    unicycle-like vehicles via Lyapunov techniques, IEEE Robotics & Automation Magazine 2(1), 1995).
    """

    def commands(states: Float, positions: Float) -> Float:
        dx, dy = np.asarray(positions)[:2] - states[:2]
        angle = np.angle(np.exp(1j * (np.arctan2(dy, dx) - states[2])))
        v = linear_velocity_gain * np.hypot(dx, dy) * np.cos(angle)
        return np.array([v, angular_velocity_gain * angle])

    return commands


def create_clf_unicycle_pose_controller(
    approach_angle_gain: float = 1,
    desired_angle_gain: float = 2.7,
    rotation_error_gain: float = 1,
) -> Law:
    """Return a function of poses and goals (3, n) that gives (v, omega); Aicardi et al., 1995.

    With rho the distance, alpha the angle from the heading to the goal, and theta that from the
    goal's heading: v = g rho cos(alpha), omega = k alpha + g cos(alpha) sin(alpha) / alpha
    (alpha + h theta).
    """

    def commands(states: Float, poses: Float) -> Float:
        dx, dy = poses[:2] - states[:2]
        bearing = np.arctan2(dy, dx)
        alpha = np.angle(np.exp(1j * (bearing - states[2])))
        theta = np.angle(np.exp(1j * (bearing - poses[2])))
        rho, g = np.hypot(dx, dy), rotation_error_gain
        v = g * rho * np.cos(alpha)
        shrink = np.sinc(alpha / np.pi) * np.cos(alpha)  # sin(alpha) cos(alpha) / alpha
        omega = desired_angle_gain * alpha + g * shrink * (alpha + approach_angle_gain * theta)
        return np.array([v, omega])

    return commands
