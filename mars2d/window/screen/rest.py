"""Rest: while nothing moves, a window waits for events instead of being drawn again and again."""

from __future__ import annotations

import time

import pygame

QUIET = 0.5
"""How long nothing has to move before a window rests, seconds; late events have come by then."""
LOOK = 0.25
"""How long a window that rests waits for an event before it looks at its files, seconds."""
NAP, LONG_NAP = 0.004, 0.016
"""The time between two looks for events, seconds: while somebody steps, and after a while of quiet.
SDL's own waiting looks every millisecond."""
AWHILE = 2.0
"""The time of quiet after which naps are long, seconds."""


class Rest:
    """Tells whether a window rests, and gives it its events."""

    def __init__(self) -> None:
        """Start awake."""
        self._moved = time.monotonic()

    @property
    def resting(self) -> bool:
        """Whether nothing has moved for a while."""
        return time.monotonic() - self._moved > QUIET

    def stir(self) -> None:
        """Note that something moves."""
        self._moved = time.monotonic()

    def events(self) -> list[pygame.Event]:
        """Return the events that have come; at rest, wait for some, and wake up by them."""
        until = time.monotonic() + LOOK
        while not (events := pygame.event.get()) and self.resting and time.monotonic() < until:
            quiet = time.monotonic() - self._moved
            time.sleep(NAP if quiet < AWHILE else LONG_NAP)
        if events:
            self.stir()
        return events
