"""A progress bar on a terminal."""

from __future__ import annotations

import sys
import time
from typing import Any


class Progress:
    """A bar on one line of a terminal with progress, rate and time left; silent elsewhere."""

    def __init__(self, total: int, unit: str = "steps", after: float = 0.5) -> None:
        """Take the total number of steps.

        after: the time before the bar is shown, seconds; a short run needs none.
        """
        self._total = max(total, 1)
        self._unit = unit
        self._stream = sys.stderr
        self._on = self._stream.isatty()
        self._start = time.monotonic()
        self._next = self._start + after
        self._shown = False

    def __call__(self, stepped: Any) -> None:
        """Show the progress of an object by its iteration."""
        self.update(stepped.iteration)

    def update(self, done: int, doing: str = "") -> None:
        """Show that `done` of all steps are done, at most ten times a second.

        doing: the present activity, shown instead of the rate; for a few long steps.
        """
        if not self._on or (now := time.monotonic()) < self._next:
            return
        self._next = now + 0.1
        self._shown = True
        rate = done / (now - self._start)
        left = (self._total - done) / rate if rate else 0.0
        filled = round(30 * done / self._total)
        bar = "#" * filled + "-" * (30 - filled)
        part = 100 * done / self._total
        rest = doing or f"{rate:,.0f} {self._unit}/s  {left:.0f} s left"
        self._stream.write(f"\r{bar} {part:3.0f} %  {rest:<38.38} ")
        self._stream.flush()

    def close(self) -> None:
        """Wipe the bar off the terminal."""
        if self._shown:
            self._stream.write("\r" + " " * 78 + "\r")
            self._stream.flush()
