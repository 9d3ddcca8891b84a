"""Laws that lead robots to points and poses: the Robotarium's `controllers`."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from mars2d.core.plane import wrap
from mars2d.world.robotarium.mappings import create_si_to_uni_dynamics, slowed

Float = NDArray[np.float64]
Law = Callable[[Float, Float], Float]


def create_si_position_controller(
    x_velocity_gain: float = 1, y_velocity_gain: float = 1, velocity_magnitude_limit: float = 0.15
) -> Law:
    """Return a function of points and goals (2, n): velocities in proportion, up to a limit."""

    def velocities(xi: Float, positions: Float) -> Float:
        gains = np.array([[x_velocity_gain], [y_velocity_gain]])
        wanted = gains * (np.asarray(positions)[:2] - np.asarray(xi)[:2])
        return slowed(wanted, velocity_magnitude_limit)

    return velocities


def create_clf_unicycle_position_controller(
    linear_velocity_gain: float = 0.8, angular_velocity_gain: float = 3
) -> Law:
    """Return a function of poses (3, n) and goals (2, n) that gives (v, omega).

    v = k d cos(a), omega = k_a d sin(a), with the distance d of the goal and its angle a from the
    heading: the goal's coordinates in the robot's frame, by gains. So d^2 / 2 is a control Lyapunov
    function: its derivative is -k d^2 cos^2(a) (Aicardi et al., Closed loop steering of
    unicycle-like vehicles via Lyapunov techniques, IEEE Robotics & Automation Magazine 2(1), 1995).
    """

    def commands(states: Float, positions: Float) -> Float:
        dx, dy = np.asarray(positions)[:2] - states[:2]
        c, s = np.cos(states[2]), np.sin(states[2])
        ahead, left = c * dx + s * dy, c * dy - s * dx
        return np.array([linear_velocity_gain * ahead, angular_velocity_gain * left])

    return commands


def create_clf_unicycle_pose_controller(
    approach_angle_gain: float = 1,
    desired_angle_gain: float = 2.7,
    rotation_error_gain: float = 1,
) -> Law:
    """Return a function of poses and goals (3, n) that gives (v, omega); Aicardi et al., 1995.

    With rho the distance, alpha the angle from the heading to the goal, and theta that from the
    goal's heading: v = g rho cos(alpha), omega = k alpha + g cos(alpha) sin(alpha) / alpha
    (alpha + h theta). The gains are g, k and h, in this order.
    """

    def commands(states: Float, poses: Float) -> Float:
        dx, dy = poses[:2] - states[:2]
        bearing = np.arctan2(dy, dx)
        alpha = wrap(bearing - states[2])
        theta = wrap(bearing - poses[2])
        rho, g = np.hypot(dx, dy), approach_angle_gain
        v = g * rho * np.cos(alpha)
        shrink = np.sinc(alpha / np.pi) * np.cos(alpha)  # sin(alpha) cos(alpha) / alpha
        omega = desired_angle_gain * alpha + g * shrink * (alpha + rotation_error_gain * theta)
        return np.array([v, omega])

    return commands


def create_hybrid_unicycle_pose_controller(
    linear_velocity_gain: float = 1,
    angular_velocity_gain: float = 2,
    velocity_magnitude_limit: float = 0.15,
    angular_velocity_limit: float = np.pi,
    position_error: float = 0.05,
    position_epsilon: float = 0.03,
    rotation_error: float = 0.05,
) -> Law:
    """Return a function of poses and goals (3, n) that gives (v, omega), in two modes.

    A robot drives straight to its point, and turns there, in proportion to its heading's error. It
    turns from `position_error` - `position_epsilon` [m] on, and drives again if it has got further
    away than `position_error`; within `rotation_error` [rad] it stands.
    """
    drive = create_si_to_uni_dynamics(linear_velocity_gain, angular_velocity_limit)
    straight = create_si_position_controller(1, 1, velocity_magnitude_limit)
    there = np.zeros(0, dtype=bool)

    def commands(states: Float, poses: Float) -> Float:
        nonlocal there
        apart = np.hypot(*(poses[:2] - states[:2]))
        if there.shape != apart.shape:
            there = np.zeros(apart.shape, dtype=bool)
        there = apart <= np.where(there, position_error, position_error - position_epsilon)
        wrong = wrap(poses[2] - states[2])
        turn = np.where(np.abs(wrong) > rotation_error, angular_velocity_gain * wrong, 0.0)
        turning = np.array([np.zeros_like(turn), turn])
        return np.where(there, turning, drive(straight(states[:2], poses[:2]), states))

    return commands
