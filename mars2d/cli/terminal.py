"""A terminal that goes away, as when its window is closed or a connection is cut."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

__all__ = ["hang_up_as_interrupt"]


@contextmanager
def hang_up_as_interrupt() -> Iterator[None]:
    """Let the end of the terminal be as Ctrl-C, so that what was recorded is saved.

    What is written to the terminal then goes nowhere: it would be an error. Does nothing outside of
    the main thread, under nohup, and on Windows, which has no such signal.
    """
    ours = threading.current_thread() is threading.main_thread() and sys.platform != "win32"
    if not ours or signal.getsignal(signal.SIGHUP) is not signal.SIG_DFL:
        yield
        return
    shown = [number for number in (1, 2) if os.isatty(number)]

    def hang_up(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
        with Path(os.devnull).open("wb") as nowhere:
            for each in shown:
                os.dup2(nowhere.fileno(), each)
        signal.raise_signal(signal.SIGINT)

    signal.signal(signal.SIGHUP, hang_up)
    try:
        yield
    finally:
        signal.signal(signal.SIGHUP, signal.SIG_DFL)
