"""Where robots start, and whether they have arrived: the Robotarium's `misc`."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.errors import InputError
from mars2d.core.plane import rectangle
from mars2d.core.streams import stream

__all__ = ["at_pose", "at_position", "generate_initial_conditions"]

Float = NDArray[np.float64]
Int = NDArray[np.int64]


def generate_initial_conditions(
    N: int, spacing: float = 0.3, width: float = 3.0, height: float = 1.8
) -> Float:
    """Return poses (3, N) on a lattice of `spacing` metres, at random, by a fixed seed.

    Raises InputError if there are fewer places than robots.
    """
    columns, rows = int(width / spacing), int(height / spacing)
    if columns * rows < N:
        raise InputError(f"{N} robots need more than {columns * rows} places: a smaller spacing")
    rng = stream(0, "robotarium")
    places = rng.permutation(columns * rows)[:N]
    xmin, ymin = np.min(rectangle(-width / 2, width / 2, -height / 2, height / 2), axis=0)
    x = xmin + spacing * (places % columns + 0.5)
    y = ymin + spacing * (places // columns + 0.5)
    return np.array([x, y, rng.uniform(-np.pi, np.pi, N)])


def at_pose(
    states: ArrayLike, poses: ArrayLike, position_error: float = 0.05, rotation_error: float = 0.2
) -> Int:
    """Return the numbers of the robots that are at their poses (3, n)."""
    have, wanted = np.asarray(states, float), np.asarray(poses, float)
    turned = np.angle(np.exp(1j * (have[2] - wanted[2])))
    near = np.hypot(*(have[:2] - wanted[:2])) <= position_error
    return np.flatnonzero(near & (np.abs(turned) <= rotation_error))


def at_position(states: ArrayLike, points: ArrayLike, position_error: float = 0.02) -> Int:
    """Return the numbers of the robots that are at their points (2, n)."""
    have, wanted = np.asarray(states, float), np.asarray(points, float)
    return np.flatnonzero(np.hypot(*(have[:2] - wanted[:2])) <= position_error)
