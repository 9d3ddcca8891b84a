"""Ctrl-C while the command line begins, and ends: it ends at once, in one line.

Importing this module sees to it, in a process that is the command line and in no other. Until the
libraries are imported there is nothing to be kept, and what they make of an exception is their own.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from itertools import pairwise
from types import FrameType

__all__ = ["INTERRUPTED", "ending", "leave"]

INTERRUPTED = 130
"""How the command line ends after Ctrl-C, as shells have it."""


def leave(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
    """End the process, when nothing can be lost: a handler of signals."""
    os.write(2, b"mars2d: interrupted\n")
    os._exit(INTERRUPTED)


def ending() -> None:
    """Ignore Ctrl-C from now on, in the command line: all is done, and the exit code is known."""
    if signal.getsignal(signal.SIGINT) is leave:
        signal.signal(signal.SIGINT, signal.SIG_IGN)


def _is_command_line() -> bool:
    """Return whether this process was started as ``mars2d`` or ``python -m mars2d``.

    In a worker process, which is told the arguments of the one that has started it, it was not.
    """
    told, first = sys.orig_argv, sys.argv[0] if sys.argv else ""
    if first == "-m":  # while the package is imported
        return any(
            word == "mars2d" and before.startswith("-") and before.endswith("m")
            for before, word in pairwise(told)
        )
    name = first.replace("\\", "/").rpartition("/")[2]
    return name.partition(".")[0] == "mars2d" and first in told


if (
    _is_command_line()
    and threading.current_thread() is threading.main_thread()
    and signal.getsignal(signal.SIGINT) is signal.default_int_handler
):
    signal.signal(signal.SIGINT, leave)
