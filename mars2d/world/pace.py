"""Wall-clock pacing: the simulation waits for real time, and nothing else knows the clock."""

from __future__ import annotations

import time
from typing import Protocol

__all__ = ["RealTime"]


class HasTime(Protocol):
    """What a pace is asked for: something with a simulated time."""

    @property
    def time(self) -> float:
        """The simulated time, seconds."""


class RealTime:
    """Waits until the wall clock has gone on as far as the simulated time, times 1 / factor."""

    def __init__(self, factor: float = 1.0) -> None:
        """Take how many simulated seconds go into a second, > 0."""
        self._factor = factor
        self._start: float | None = None

    def __call__(self, world: HasTime) -> None:
        """Wait until it is time for the control step of `world`."""
        now = time.monotonic()
        if self._start is None:
            self._start = now - world.time / self._factor
        delay = self._start + world.time / self._factor - now
        if delay > 0:
            time.sleep(delay)
