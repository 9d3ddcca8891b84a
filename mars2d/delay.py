"""The transmission delay between the controllers and the robots."""

from __future__ import annotations

from collections import deque
from math import floor

import numpy as np
from numpy.typing import NDArray

__all__ = ["DelayLine"]

Float = NDArray[np.float64]


class DelayLine:
    """Commands on their way: what is issued at time t takes effect at t + delay.

    The delay need not be a multiple of the sampling time: then the command in effect changes
    within each sampling time. Before the first one arrives, robots stand still.
    """

    def __init__(self, delay: float, sampling_time: float, robots: int) -> None:
        """Take the delay and the sampling time, seconds."""
        whole = floor(delay / sampling_time + 1e-9)
        self._rest = max(delay - whole * sampling_time, 0.0)
        if self._rest < 1e-9 * sampling_time:
            self._rest = 0.0
        self._sampling_time = sampling_time
        still = np.zeros((2, robots))
        self._waiting = deque([still] * (whole + 1), maxlen=whole + 2)

    def send(self, command: Float) -> list[tuple[float, Float]]:
        """Issue a command (2, n), and return what is in effect meanwhile: (seconds, command)."""
        self._waiting.append(command)
        before, after = self._waiting[0], self._waiting[1]
        if self._rest == 0.0:
            return [(self._sampling_time, after)]
        return [(self._rest, before), (self._sampling_time - self._rest, after)]
