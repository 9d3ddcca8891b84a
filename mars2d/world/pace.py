"""Wall-clock pacing: only this module knows the clock."""

from __future__ import annotations

import time
from typing import Protocol

__all__ = ["RealTime"]


class HasTime(Protocol):
    """An object with a simulated time."""

    @property
    def time(self) -> float:
        """The simulated time, seconds."""


class RealTime:
    """Waits until the wall clock has gone on by the simulated time / factor."""

    def __init__(self, factor: float = 1.0) -> None:
        """Take the simulated seconds per second, > 0."""
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
