"""Dead reckoning: the covariance of a pose that is the sum of small measured steps."""

from __future__ import annotations

from math import isfinite, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.arithmetic import cosine_sine
from mars2d.core.scene import Scene, faded

Float = NDArray[np.float64]


def sinc(angle: float) -> float:
    """Return sin(angle) / angle: the ratio of chord to arc for an arc of twice that angle."""
    return cosine_sine(angle)[1] / angle if angle else 1.0


def odometry_covariance(
    covariance: ArrayLike, theta: float, left: float, right: float, semiaxis: float, drift: float
) -> Float:
    """Return the covariance (3, 3) of dead reckoning after one more step, to first order.

    covariance: (3, 3) of (x, y, theta) before. theta: the heading before, radians. left, right:
    the ways of the wheels' rims, metres. semiaxis: half the distance between the wheels, metres.
    drift: the field of `Odometry`, sqrt(m).

    >>> after = odometry_covariance(np.zeros((3, 3)), 0.0, 1.0, 1.0, 0.5, 0.1)
    >>> after.diagonal().round(6).tolist()
    [0.005, 0.005, 0.02]

    Source: Siegwart, Nourbakhsh and Scaramuzza (2011), equations 5.8 to 5.12, with the exact arc in
    place of the chord of the mean heading.
    """
    before = np.asarray(covariance, dtype=float)
    forward, spin = (left + right) / 2, (right - left) / (2 * semiaxis)
    middle, half = theta + spin / 2, spin / 2
    chord = sinc(half)
    # d(chord) / d(spin); for small angles its series, since the difference would cancel.
    bend = -spin / 12 if abs(spin) < 1e-3 else (cosine_sine(half)[0] - chord) / spin
    c, s = cosine_sine(middle)
    dx, dy = chord * forward * c, chord * forward * s
    by_pose = np.array([[1.0, 0.0, -dy], [0.0, 1.0, dx], [0.0, 0.0, 1.0]])
    by_spin = np.array(
        [forward * (bend * c - chord * s / 2), forward * (bend * s + chord * c / 2), 1]
    )
    by_forward = np.array([chord * c, chord * s, 0.0])
    per_left = by_forward / 2 - by_spin / (2 * semiaxis)
    per_right = by_forward / 2 + by_spin / (2 * semiaxis)
    by_rims = drift * np.column_stack([sqrt(abs(left)) * per_left, sqrt(abs(right)) * per_right])
    return _product(_product(by_pose, before), by_pose.T) + _product(by_rims, by_rims.T)


def _product(a: Float, b: Float) -> Float:
    """Return a product of matrices; numpy's own rounds as the processor does."""
    return np.asarray((a[:, :, None] * b).sum(axis=1))


def covariance_after_arc(
    covariance: Float, before: Float, after: Float, semiaxis: float, drift: float
) -> Float:
    """Return the covariance (3, 3) of dead reckoning after an arc from one pose (3,) to another.

    covariance: (3, 3) before. semiaxis and drift: as in `odometry_covariance`.
    """
    theta = float(before[2])
    dx, dy, turn = (after - before).tolist()
    middle, chord = theta + turn / 2, sinc(turn / 2)
    c, s = cosine_sine(middle)
    straight = c * dx + s * dy
    way = straight / chord if abs(chord) > 1e-9 else 0.0  # a whole turn ends where it began
    rims = (way - semiaxis * turn, way + semiaxis * turn)
    return odometry_covariance(covariance, theta, *rims, semiaxis, drift)


def draw_pose(scene: Scene, pose: ArrayLike, color: str) -> None:
    """Draw an estimated pose (3,) as a ring with a heading; nan: draw nothing."""
    x, y, theta = np.asarray(pose, dtype=float).tolist()
    if isfinite(x + y + theta):
        scene.circle((x, y), 0.0, stroke=color, fill=faded(color, 0.15), width=1.2, pixels=6.0)
        c, s = cosine_sine(theta)
        ahead = (x + 0.3 * c, y + 0.3 * s)
        scene.line([(x, y), ahead], stroke=color, width=1.2)


def covariances(path: ArrayLike, semiaxis: float, drift: float) -> Float:
    """Return the covariances (T, 3, 3) of a path (T, 3) measured by odometry.

    path: x [m], y [m], theta [rad, not wrapped], at each control step. semiaxis: half the distance
    between the wheels, metres. drift: the field of Odometry, sqrt(m). The first pose is certain.

    >>> straight = [(x, 0.0, 0.0) for x in (0.0, 1.0, 2.0)]
    >>> covariances(straight, 0.5, 0.1)[-1].diagonal().round(3).tolist()
    [0.01, 0.05, 0.04]
    """
    poses = np.asarray(path, dtype=float).reshape(-1, 3)
    found = np.zeros((len(poses), 3, 3))
    for k in range(1, len(poses)):
        found[k] = covariance_after_arc(found[k - 1], poses[k - 1], poses[k], semiaxis, drift)
    return found
