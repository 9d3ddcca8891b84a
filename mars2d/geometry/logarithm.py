"""Logarithms that round the same on every processor, see `mars2d.core.arithmetic`."""

from __future__ import annotations

from math import frexp, sqrt


def logarithm(x: float) -> float:
    """Return the natural logarithm of a number x > 0."""
    m, k = frexp(x)
    if m < 0.7071067811865476:
        m, k = m * 2, k - 1
    rest = _double_artanh((m - 1) / (m + 1))
    return k * 6.93147180369123816490e-01 + (k * 1.90821492927058770002e-10 + rest)


def arsinh(x: float) -> float:
    """Return the inverse hyperbolic sine of a number."""
    more = abs(x) + x * x / (1 + sqrt(x * x + 1))
    size = _double_artanh(more / (2 + more)) if more < 0.4 else logarithm(1 + more)
    return -size if x < 0 else size


def _double_artanh(s: float) -> float:
    """Return ln((1 + s) / (1 - s)) for |s| <= 0.172."""
    z, p = s * s, 0.0
    for odd in range(21, 1, -2):
        p = (p + 1 / odd) * z
    return 2 * s * (1 + p)
