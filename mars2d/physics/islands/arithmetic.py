"""Sines and powers that round the same on every processor.

Those of the C libraries differ in their last bits, some even with what the processor can do. These
are made of sums, products and quotients alone, which IEEE 754 fixes.
"""

from __future__ import annotations

from math import floor, fmod, sqrt

from mars2d.physics.islands import shadow as cython


def length(x: cython.double, y: cython.double) -> cython.double:
    """Return the length of a vector."""
    return sqrt(x * x + y * y)


def _sine_near_zero(r: cython.double) -> cython.double:
    """Return the sine of an angle of at most pi / 4.

    Source: the minimax polynomial of fdlibm (Sun Microsystems, 1993), off by less than 2^-58.
    """
    z: cython.double = r * r
    p: cython.double = 1.58969099521155010221e-10
    p = p * z - 2.50507602534068634195e-08
    p = p * z + 2.75573137070700676789e-06
    p = p * z - 1.98412698298579493134e-04
    p = p * z + 8.33333333332248946124e-03
    p = p * z - 1.66666666666666324348e-01
    return r + r * z * p


def _cosine_near_zero(r: cython.double) -> cython.double:
    """Return the cosine of an angle of at most pi / 4; source as above."""
    z: cython.double = r * r
    p: cython.double = -1.13596475577881948265e-11
    p = p * z + 2.08757232129817482790e-09
    p = p * z - 2.75573143513906633035e-07
    p = p * z + 2.48015872894767294178e-05
    p = p * z - 1.38888888888741095749e-03
    p = p * z + 4.16666666666666019037e-02
    half: cython.double = 0.5 * z
    top: cython.double = 1.0 - half
    return top + (((1.0 - top) - half) + z * z * p)


def cosine_sine(angle: cython.double) -> tuple[cython.double, cython.double]:
    """Return the cosine and the sine of an angle."""
    if angle > 1e6 or angle < -1e6:  # turns of its own no longer fit in the parts of pi below
        angle = fmod(angle, 6.283185307179586)
    turns: cython.double = floor(angle * 0.6366197723675814 + 0.5)
    # pi / 2 in three parts, the first two of 33 bits: their products are exact
    r: cython.double = angle - turns * 1.57079632673412561417
    r = r - turns * 6.07710050630396597660e-11
    r = r - turns * 2.02226624879595063154e-21
    s: cython.double = _sine_near_zero(r)
    c: cython.double = _cosine_near_zero(r)
    quadrant: cython.double = turns - 4.0 * floor(turns / 4.0)
    if quadrant == 0.0:
        return c, s
    if quadrant == 1.0:
        return -s, c
    if quadrant == 2.0:
        return -c, -s
    return s, -c


def sine(angle: cython.double) -> cython.double:
    """Return the sine of an angle."""
    if -0.7853981633974483 < angle < 0.7853981633974483:
        return _sine_near_zero(angle)
    return cosine_sine(angle)[1]


def chord_share(half: cython.double) -> cython.double:
    """Return how long the chord of an arc is, in parts of the arc that turns by twice an angle."""
    return 1.0 if half == 0.0 else sine(half) / half


def _product(a: cython.double, b: cython.double) -> tuple[cython.double, cython.double]:
    """Return a product and its rounding error.

    Source: T. J. Dekker, Numer. Math. 18, 224 (1971).
    """
    p: cython.double = a * b
    c: cython.double = 134217729.0 * a
    high_a: cython.double = c - (c - a)
    low_a: cython.double = a - high_a
    c = 134217729.0 * b
    high_b: cython.double = c - (c - b)
    low_b: cython.double = b - high_b
    error: cython.double = high_a * high_b - p
    error = error + high_a * low_b
    error = error + low_a * high_b
    return p, error + low_a * low_b


def decay_base(rate: cython.double, base: cython.double, h: cython.double) -> cython.double:
    """Return a number near `base` whose power of h any C library rounds to the same number.

    base: exp(-rate).

    The engine asks its C library for it in each step. Powers that are nearly in the middle between
    two numbers are rounded to one by some libraries, and to the other by others; here exp(-rate h)
    is worked out to twice the digits, and the base is shifted until its power is a number itself.
    """
    p, error = _product(rate, h)
    n: cython.double = floor(p * 1.4426950408889634 + 0.5)
    r: cython.double = n * 6.93147180369123816490e-01 - p
    low: cython.double = n * 1.90821492927058770002e-10 - error
    high: cython.double = r + low
    low = low - (high - r)
    # exp(x) - 1 of x = -rate h + n ln 2, from that of x / 256 by eight doublings
    x: cython.double = high / 256.0
    rest: cython.double = low / 256.0 + x * x * (
        0.5 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x / 120.0))
    )
    high = x + rest
    low = rest - (high - x)
    for _ in range(8):
        p, error = _product(high, high)
        error = error + 2.0 * high * low + 2.0 * low
        twice: cython.double = 2.0 * high
        x = twice + p
        rest = (p - (x - twice)) + error
        high = x + rest
        low = rest - (high - x)
    near: cython.double = 1.0 + high
    beside: cython.double = (high - (near - 1.0)) + low
    return base * (1.0 - beside / near / h)


def implicitness(x: cython.double) -> cython.double:
    """Return theta of v' = v - x ((1 - theta) v + theta v') with v' = v e^-x, for x >= 0."""
    if x < 1e-3:
        return 0.5 + x / 12.0
    return 1.0 / (1.0 - exponential(-x)) - 1.0 / x


def power(x: cython.double, exponent: cython.double) -> cython.double:
    """Return x to the power of an exponent, where 0 <= x <= 1 and the exponent is >= 0."""
    if x <= 0.0:
        return 1.0 if exponent == 0.0 else 0.0
    # the logarithm: x = m / 2^k, and ln m = 2 artanh((m - 1) / (m + 1))
    k: cython.double = 0.0
    while x < 0.7071067811865476:
        x = x * 2.0
        k = k + 1.0
    s: cython.double = (x - 1.0) / (x + 1.0)
    z: cython.double = s * s
    p: cython.double = 1.0 / 19.0
    p = p * z + 1.0 / 17.0
    p = p * z + 1.0 / 15.0
    p = p * z + 1.0 / 13.0
    p = p * z + 1.0 / 11.0
    p = p * z + 1.0 / 9.0
    p = p * z + 1.0 / 7.0
    p = p * z + 1.0 / 5.0
    p = p * z + 1.0 / 3.0
    return exponential(exponent * (2.0 * s + 2.0 * s * z * p - k * 0.6931471805599453))


def exponential(y: cython.double) -> cython.double:
    """Return e to the power of y <= 0; 0 for y < -700."""
    if y < -700.0:
        return 0.0
    # y = r - n ln 2
    n: cython.double = floor(0.5 - y * 1.4426950408889634)
    r: cython.double = y + n * 6.93147180369123816490e-01
    r = r + n * 1.90821492927058770002e-10
    e: cython.double = 1.0 + r / 13.0
    for k in range(12, 0, -1):
        e = 1.0 + r * e / k
    while n >= 1.0:
        e = e * 0.5
        n = n - 1.0
    return e
