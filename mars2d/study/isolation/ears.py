"""Which of some sockets can be read: asked anew at each control step, and so without detours."""

from __future__ import annotations

import os
import select
import socket
import time
from collections.abc import Callable
from math import ceil

__all__ = ["Ears"]


SPIN = 3e-4
"""For how long one asks again before one sleeps, seconds: most laws have answered by then, and to
wake up takes as long. Whoever else wants the processor gets it meanwhile."""

_let_others_run = getattr(os, "sched_yield", lambda: None)


class Ears:
    """Listens to sockets, and knows whom to call when there is something to be read."""

    def __init__(self) -> None:
        self._takers: dict[int, Callable[[], object]] = {}
        self._poll = select.poll() if hasattr(select, "poll") else None  # not on Windows

    def add(self, heard: socket.socket, take: Callable[[], object]) -> None:
        """Listen to a socket; take: reads what is there, and returns False when nothing follows."""
        self._takers[heard.fileno()] = take
        if self._poll is not None:
            self._poll.register(heard, select.POLLIN)

    def listen(self, seconds: float) -> bool:
        """Let all take that can, when the first of them can; return whether there was any."""
        if self._poll is not None:
            until = time.perf_counter() + min(seconds, SPIN)
            while not (events := self._poll.poll(0)) and time.perf_counter() < until:
                _let_others_run()
            events = events or self._poll.poll(ceil(1000 * seconds))
            ready = [descriptor for descriptor, _ in events]
        else:
            ready = select.select([*self._takers], [], [], seconds)[0]
        for descriptor in ready:
            if self._takers[descriptor]() is False:
                del self._takers[descriptor]
                if self._poll is not None:
                    self._poll.unregister(descriptor)
        return bool(ready)
