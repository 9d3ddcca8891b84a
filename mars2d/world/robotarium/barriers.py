"""Control barrier functions that keep robots apart: the Robotarium's `barrier_certificates`.

Each pair keeps h = |x_i - x_j|^2 - r^2 >= 0 by h' >= -gain h^3, linear in the velocities; the
certified velocities are those nearest to the wanted ones (Wang, Ames and Egerstedt, Safety barrier
certificates for collisions-free multirobot systems, IEEE Transactions on Robotics 33(3), 2017).
"""

from __future__ import annotations

import warnings
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.arithmetic import norm
from mars2d.world.robotarium.arena import HEIGHT, WIDTH
from mars2d.world.robotarium.mappings import (
    create_si_to_uni_mapping,
    create_uni_to_si_dynamics,
    slowed,
)  # fmt: skip

Float = NDArray[np.float64]
Certificate = Callable[[Float, Float], Float]

BOUNDARY = (-WIDTH / 2, WIDTH / 2, -HEIGHT / 2, HEIGHT / 2)
"""The arena: xmin, xmax, ymin, ymax, metres."""


def nearest_within(wanted: Float, rows: Float, limits: Float) -> Float | None:
    """Return the point (k,) nearest to `wanted` with rows @ point <= limits; None if there is none.

    It is a least-distance problem, solved by non-negative least squares (Lawson and Hanson,
    Solving Least Squares Problems, 1974, chapter 23).
    """
    from scipy.optimize import nnls

    slack = rows @ wanted - limits
    if not (slack > 0).any():
        return wanted
    tall = np.vstack([-rows.T, slack])
    target = np.zeros(len(wanted) + 1)
    target[-1] = 1.0
    weights, _ = nnls(tall, target)
    rest = tall @ weights - target
    return None if abs(rest[-1]) < 1e-12 else wanted - rest[:-1] / rest[-1]


def create_single_integrator_barrier_certificate(
    barrier_gain: float = 100, safety_radius: float = 0.17, magnitude_limit: float = 0.2
) -> Certificate:
    """Return a function of velocities and points (2, n) that gives safe velocities (2, n)."""
    return _certificate(barrier_gain, safety_radius, magnitude_limit, None)


def create_single_integrator_barrier_certificate2(
    barrier_gain: float = 100,
    unsafe_barrier_gain: float = 1e6,
    safety_radius: float = 0.17,
    magnitude_limit: float = 0.2,
) -> Certificate:
    """Return the same with another gain for pairs that are too near, which drives them apart."""
    return _certificate(barrier_gain, safety_radius, magnitude_limit, None, unsafe_barrier_gain)


def create_single_integrator_barrier_certificate_with_boundary(
    barrier_gain: float = 100,
    safety_radius: float = 0.17,
    magnitude_limit: float = 0.2,
    boundary_points: ArrayLike = BOUNDARY,
) -> Certificate:
    """Return the same with the arena's edges as bounds of the points."""
    return _certificate(barrier_gain, safety_radius, magnitude_limit, boundary_points)


def create_unicycle_barrier_certificate(
    barrier_gain: float = 100,
    safety_radius: float = 0.12,
    projection_distance: float = 0.05,
    magnitude_limit: float = 0.2,
) -> Certificate:
    """Return a function of (v, omega) and poses that gives safe ones, for the points ahead."""
    return _of_unicycles(barrier_gain, safety_radius, projection_distance, magnitude_limit, None)


def create_unicycle_barrier_certificate2(
    barrier_gain: float = 500,
    unsafe_barrier_gain: float = 1e6,
    safety_radius: float = 0.12,
    projection_distance: float = 0.05,
    magnitude_limit: float = 0.2,
) -> Certificate:
    """Return the same with another gain for pairs that are too near, which drives them apart."""
    return _of_unicycles(
        barrier_gain,
        safety_radius,
        projection_distance,
        magnitude_limit,
        None,
        unsafe_barrier_gain,
    )


def create_unicycle_barrier_certificate_with_boundary(
    barrier_gain: float = 100,
    safety_radius: float = 0.12,
    projection_distance: float = 0.05,
    magnitude_limit: float = 0.2,
    boundary_points: ArrayLike = BOUNDARY,
) -> Certificate:
    """Return the same with the arena's edges as bounds."""
    return _of_unicycles(
        barrier_gain, safety_radius, projection_distance, magnitude_limit, boundary_points
    )


def _of_unicycles(
    gain: float,
    radius: float,
    ahead: float,
    limit: float,
    edges: ArrayLike | None,
    unsafe: float | None = None,
) -> Certificate:
    safe = _certificate(gain, radius + 2 * ahead, limit, edges, unsafe)
    velocities = create_uni_to_si_dynamics(ahead)
    commands, points = create_si_to_uni_mapping(ahead)

    def certified(dxu: Float, poses: Float) -> Float:
        return commands(safe(velocities(dxu, poses), points(poses), 3), poses)

    return certified


def _certificate(
    gain: float,
    radius: float,
    limit: float,
    edges: ArrayLike | None,
    unsafe: float | None = None,
) -> Callable[..., Float]:
    """Return a certificate. unsafe: the gain of pairs with h < 0, by default the same.

    Where no velocities are safe it returns the wanted ones, and warns the first time; its third
    argument is how many calls above it the script is.
    """
    warned = False

    def certified(dxi: Float, x: Float, depth: int = 2) -> Float:
        nonlocal warned
        wanted = slowed(np.array(dxi, dtype=float), limit)
        points = np.asarray(x, dtype=float)[:2]
        count = points.shape[1]
        rows: list[Float] = []
        limits: list[float] = []
        about: list[tuple[str, float, float]] = []  # whom a row is about, the gap, the least one
        for i in range(count):
            for j in range(i + 1, count):
                apart = points[:, i] - points[:, j]
                row = np.zeros((2, count))
                row[:, i], row[:, j] = -2 * apart, 2 * apart
                rows.append(row.ravel())
                h = apart @ apart - radius**2
                limits.append((gain if h >= 0 or unsafe is None else unsafe) * h**3)
                about.append((f"robots {i} and {j} are", norm(*apart), radius))
        for i in range(count) if edges is not None else ():
            xmin, xmax, ymin, ymax = np.asarray(edges, dtype=float)
            x_i, y_i = points[:, i]
            gaps = (0, 1, xmax - x_i), (0, -1, x_i - xmin), (1, 1, ymax - y_i), (1, -1, y_i - ymin)
            for axis, sign, gap in gaps:
                row = np.zeros((2, count))
                row[axis, i] = sign
                rows.append(row.ravel())
                limits.append(gain * (gap - radius / 2) ** 3)
                about.append((f"robot {i} and the edge are", gap, radius / 2))
        if not rows:
            return wanted
        safe = nearest_within(wanted.ravel(), np.array(rows), np.array(limits))
        if safe is not None:
            return np.asarray(safe.reshape(2, count))
        if not warned:
            warned = True
            who, gap, least = about[int(np.argmin(limits))]
            warnings.warn(
                f"barrier certificate: no velocities are safe, so the wanted ones are used; {who} "
                f"{gap:.3g} m apart, less than {least:.3g} m (this is said once)",
                stacklevel=depth,
            )
        return wanted

    return certified
