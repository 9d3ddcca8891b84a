"""How much memory a process uses, without memory that it has only reserved."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

PAUSE = 0.02
"""The least time between two looks, seconds: a look takes as long as a quick law."""


class Scale:
    """Weighs a process: the bytes in main memory that are its own, beyond those at its start.

    Code and data of libraries that are read from files do not count, nor does address space that
    is reserved and not used, of which torch and ONNX Runtime take gigabytes. What the
    process has started is not weighed. Only Linux tells this of another process; elsewhere
    nothing is heavy.
    """

    def __init__(self, process: int, limit: float) -> None:
        """Take the process, which has just started, and how many bytes it may take."""
        self._file = Path(f"/proc/{process}/statm")
        self._works = sys.platform == "linux"
        self._start = self._own()
        self._limit, self._next = limit, 0.0

    def _own(self) -> int:
        """Return the bytes in main memory that no file backs; 0 where nobody knows."""
        if not self._works:
            return 0
        try:
            _, resident, shared, *_ = self._file.read_text(encoding="ascii").split()
        except (OSError, ValueError):  # it has ended
            return 0
        return (int(resident) - int(shared)) * os.sysconf("SC_PAGE_SIZE")

    @property
    def heavy(self) -> bool:
        """Whether it takes more than it may; looked up at most every `PAUSE` seconds."""
        now = time.perf_counter()
        if not self._works or now < self._next:
            return False
        self._next = now + PAUSE
        return self._own() - self._start > self._limit
