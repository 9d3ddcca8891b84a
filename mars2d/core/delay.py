"""Delays in control steps."""

from __future__ import annotations

from math import ceil

ROUNDING = 1e-9
"""Times that differ by less count as equal, in sampling times."""


def steps_until(delay: float, sampling_time: float) -> int:
    """Return the number of control steps until a delay [s] has passed."""
    return ceil(delay / sampling_time - ROUNDING)
