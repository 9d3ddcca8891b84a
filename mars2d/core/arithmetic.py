"""Sines, angles and norms that round the same on every processor, for numbers and arrays.

Those of the C libraries and of numpy differ in their last bits, some even with what the processor
can do. These are made of sums, products, quotients and square roots alone, which IEEE 754 fixes.
The engine has the same sines: see ``mars2d/physics/islands/arithmetic.py``.
"""

from __future__ import annotations

from collections.abc import Callable
from math import ceil, floor, fmod, frexp, inf, isfinite, isinf, ldexp, nan, sqrt
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Float = NDArray[np.float64]

QUARTER = (1.57079632673412561417, 6.07710050630396597660e-11, 2.02226624879595063154e-21)
"""pi / 2 in three parts, the first two of 33 bits: their products with few turns are exact."""

PER_QUARTER = 0.6366197723675814
"""2 / pi."""

MANY_TURNS = 1e6
"""The angle beyond which whole turns are taken off first, rad; they do not fit in those parts."""

FEW = 32
"""So few angles are worked out one by one, which is quicker; of norms, a quarter as many."""

TURN = 6.283185307179586

ROUNDING = 1e-9
"""Times that differ by less count as equal, in sampling times."""

ARCTANGENTS = (0.46364760900080611621, 0.78539816339744830962, 0.98279372324732906799,
               1.57079632679489661923)  # fmt: skip
"""The arctangents of 1/2, 1, 3/2 and infinity."""


def cosine_sine(angle: float) -> tuple[float, float]:
    """Return the cosine and the sine of an angle [rad]."""
    if not isfinite(angle):
        return nan, nan
    if abs(angle) > MANY_TURNS:
        angle = fmod(angle, TURN)
    quarters = floor(angle * PER_QUARTER + 0.5)
    r = angle - quarters * QUARTER[0]
    r = r - quarters * QUARTER[1]
    r = r - quarters * QUARTER[2]
    c, s = _cosine_near_zero(r), _sine_near_zero(r)
    if quarters % 2:
        c, s = -s, c
    return (-c, -s) if quarters % 4 > 1 else (c, s)


def cosines_sines(angles: ArrayLike) -> tuple[Float, Float]:
    """Return the cosines and the sines of angles [rad], in arrays of the same shape."""
    angles = np.asarray(angles, dtype=float)
    if angles.size <= FEW:
        pairs = np.array([cosine_sine(each) for each in angles.ravel().tolist()]).reshape(-1, 2)
        return pairs[:, 0].reshape(angles.shape), pairs[:, 1].reshape(angles.shape)
    if not np.abs(angles).max() <= MANY_TURNS:
        with np.errstate(invalid="ignore"):
            angles = np.where(np.abs(angles) > MANY_TURNS, np.fmod(angles, TURN), angles)
    quarters = np.floor(angles * PER_QUARTER + 0.5)
    r = angles - quarters * QUARTER[0]
    r = r - quarters * QUARTER[1]
    r = r - quarters * QUARTER[2]
    c, s = _cosine_near_zero(r), _sine_near_zero(r)
    past = quarters - 4.0 * np.floor(quarters * 0.25)
    odd = past % 2.0 == 1.0
    behind = np.where((past == 1.0) | (past == 2.0), -1.0, 1.0)
    below = np.where(past >= 2.0, -1.0, 1.0)
    return np.where(odd, s, c) * behind, np.where(odd, c, s) * below


def angle_of(y: float, x: float) -> float:
    """Return the angle [rad] of a vector (x, y), from -pi to pi; 0 for no vector, or a zero one."""
    high, low = max(abs(x), abs(y)), min(abs(x), abs(y))
    steep = 0.0 if high == 0 else low / high if high < inf else float(low == inf)
    angle = float(_arctangent(steep, lambda first, a, b: a if first else b))
    if abs(y) > abs(x):
        angle = ARCTANGENTS[3] - angle
    if x < 0:
        angle = 2 * ARCTANGENTS[3] - angle
    return -angle if y < 0 else angle


def angles_of(y: ArrayLike, x: ArrayLike) -> Float:
    """Return the angles [rad] of vectors (x, y), from -pi to pi, in an array of their shape."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if x.size <= FEW and x.shape == y.shape:
        pairs = zip(y.ravel().tolist(), x.ravel().tolist(), strict=True)
        return np.array([angle_of(*pair) for pair in pairs]).reshape(x.shape)
    high, low = np.maximum(np.abs(x), np.abs(y)), np.minimum(np.abs(x), np.abs(y))
    steep = np.divide(low, high, out=np.zeros_like(high), where=high > 0)
    angle: Float = _arctangent(steep, np.where)
    angle = np.where(np.abs(y) > np.abs(x), ARCTANGENTS[3] - angle, angle)
    angle = np.where(x < 0, 2 * ARCTANGENTS[3] - angle, angle)
    return np.where(y < 0, -angle, angle)


def norm(x: float, y: float) -> float:
    """Return the norm of a vector; less than 1e-162 is 0."""
    size = sqrt(x * x + y * y)
    if size < inf or isinf(x) or isinf(y):
        return size
    return 1e200 * sqrt((x / 1e200) * (x / 1e200) + (y / 1e200) * (y / 1e200))


def norms(x: ArrayLike, y: ArrayLike) -> Float:
    """Return the norms of vectors, in an array of their shape; less than 1e-162 is 0."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if x.size <= FEW // 4 and x.shape == y.shape:
        pairs = zip(x.ravel().tolist(), y.ravel().tolist(), strict=True)
        return np.array([norm(*pair) for pair in pairs]).reshape(x.shape)
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        size = np.asarray(np.sqrt(x * x + y * y))
        if size.size and size.max() == inf:
            x, y = x / 1e200, y / 1e200
            size = np.where(size == inf, 1e200 * np.sqrt(x * x + y * y), size)
    return size


# -- near zero ------------------------------------------------------------------------------------


def _sine_near_zero(r: Any) -> Any:
    """Return the sine of an angle of at most pi / 4.

    Source: the minimax polynomial of fdlibm (Sun Microsystems, 1993), off by less than 2^-58.
    """
    z = r * r
    p = 1.58969099521155010221e-10 * z - 2.50507602534068634195e-08
    p = p * z + 2.75573137070700676789e-06
    p = p * z - 1.98412698298579493134e-04
    p = p * z + 8.33333333332248946124e-03
    p = p * z - 1.66666666666666324348e-01
    return r + r * z * p


def _cosine_near_zero(r: Any) -> Any:
    """Return the cosine of an angle of at most pi / 4; source as above."""
    z = r * r
    p = -1.13596475577881948265e-11 * z + 2.08757232129817482790e-09
    p = p * z - 2.75573143513906633035e-07
    p = p * z + 2.48015872894767294178e-05
    p = p * z - 1.38888888888741095749e-03
    p = p * z + 4.16666666666666019037e-02
    half = 0.5 * z
    top = 1.0 - half
    return top + (((1.0 - top) - half) + z * z * p)


def _arctangent(x: Any, choose: Callable[[Any, Any, Any], Any]) -> Any:
    """Return the arctangent of numbers from 0 to 1; choose: np.where, or the like of it for one."""
    few, some = x <= 0.4375, x < 0.6875
    r = choose(few, x, choose(some, (2 * x - 1) / (2 + x), (x - 1) / (x + 1)))
    begin = choose(few, 0.0, choose(some, ARCTANGENTS[0], ARCTANGENTS[1]))
    share = r * _arc_share(r)
    return choose(few, r - share, begin - (share - r))


def _arc_share(r: Any) -> Any:
    """Return 1 - arctan(r) / r for |r| <= 7 / 16; source as above."""
    z = r * r
    w = z * z
    odd = 1.62858201153657823623e-02 * w + 4.97687799461593236017e-02
    odd = odd * w + 6.66107313738753120669e-02
    odd = odd * w + 9.09088713343650656196e-02
    odd = odd * w + 1.42857142725034663711e-01
    odd = odd * w + 3.33333333333329318027e-01
    even = -3.65315727442169155270e-02 * w - 5.83357013379057348645e-02
    even = even * w - 7.69187620504482999495e-02
    even = even * w - 1.11111104054623557880e-01
    even = even * w - 1.99999999998764832476e-01
    return z * odd + w * even


def decay(x: float) -> float:
    """Return exp(-x) for x >= 0, within a share of 1e-12 of it.

    >>> abs(decay(0.7) - 0.49658530379140951) < 1e-15
    True
    """
    halvings = max(frexp(x)[1] + 3, 0)
    small, result = ldexp(-x, -halvings), 1.0
    for k in range(12, 0, -1):
        result = 1.0 + small * result / k
    for _ in range(halvings):
        result *= result
    return result


def steps_until(delay: float, sampling_time: float) -> int:
    """Return the number of control steps until a delay [s] has passed."""
    return ceil(delay / sampling_time - ROUNDING)
