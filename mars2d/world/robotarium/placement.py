"""Where robots start, and whether they have arrived: the Robotarium's `misc`."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.errors import InputError
from mars2d.core.plane import rectangle, wrap

Float = NDArray[np.float64]
Int = NDArray[np.int64]


def generate_initial_conditions(
    N: int, spacing: float = 0.3, width: float = 3.0, height: float = 1.8
) -> Float:
    """Return poses (3, N) on a lattice of `spacing` metres, at random: other ones at each call.

    They come from numpy's global generator, as a script's own random numbers do; a script starts
    with its seed 0. Raises InputError if there are fewer places than robots.
    """
    columns, rows = int(width / spacing), int(height / spacing)
    if columns * rows < N:
        raise InputError(f"{N} robots need more than {columns * rows} places: a smaller spacing")
    places = np.random.permutation(columns * rows)[:N]
    xmin, ymin = np.min(rectangle(-width / 2, width / 2, -height / 2, height / 2), axis=0)
    x = xmin + spacing * (places % columns + 0.5)
    y = ymin + spacing * (places // columns + 0.5)
    return np.array([x, y, np.random.uniform(-np.pi, np.pi, N)])


def at_pose(
    states: ArrayLike, poses: ArrayLike, position_error: float = 0.05, rotation_error: float = 0.2
) -> Int:
    """Return the numbers of the robots that are at their poses (3, n)."""
    have, wanted = np.asarray(states, float), np.asarray(poses, float)
    turned = wrap(have[2] - wanted[2])
    near = np.hypot(*(have[:2] - wanted[:2])) <= position_error
    return np.flatnonzero(near & (np.abs(turned) <= rotation_error))


def at_position(states: ArrayLike, points: ArrayLike, position_error: float = 0.02) -> Int:
    """Return the numbers of the robots that are at their points (2, n)."""
    have, wanted = np.asarray(states, float), np.asarray(points, float)
    return np.flatnonzero(np.hypot(*(have[:2] - wanted[:2])) <= position_error)


def determine_marker_size(robotarium_instance: Any, marker_size_meters: float) -> float:
    """Return the area in square points, as `scatter` takes it, of a marker of a width in metres."""
    return _points(robotarium_instance, marker_size_meters) ** 2


def determine_font_size(robotarium_instance: Any, font_height_meters: float) -> float:
    """Return the size in points of letters of a height in metres."""
    return _points(robotarium_instance, font_height_meters)


def _points(arena: Any, length: float) -> float:
    """Return a length [m] along the x axis of an arena's figure in points, 1/72 inch."""
    pixels = np.diff(arena.axes.transData.transform([(0.0, 0.0), (length, 0.0)])[:, 0])
    return float(pixels[0] * 72 / arena.figure.dpi)
