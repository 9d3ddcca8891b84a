"""The clock of a match: it stands still while the match does."""

from __future__ import annotations

import time

LOOK = 0.1
"""The longest time between two looks at the clock while laws compute, seconds."""

LATE = 0.4
"""A look that comes later than that was kept from coming: only so much counts, seconds."""


class Clock:
    """Counts the time of a match, seconds, from look to look.

    A match that is stopped, put to sleep with its machine, or kept waiting by a busy processor
    looks late; then the laws have not had that time either, or could not tell their answer.
    """

    def __init__(self) -> None:
        self._last, self._time = time.perf_counter(), 0.0

    def now(self) -> float:
        """Look at the clock: return the time since it was made, without pauses."""
        last, self._last = self._last, time.perf_counter()
        self._time += min(self._last - last, LATE)
        return self._time
