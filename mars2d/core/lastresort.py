"""The last resort: a second Ctrl-C ends the command line, whatever holds it.

Python reacts to a signal between two steps of its own. A law in C code that keeps the interpreter,
such as the decomposition of a large matrix, stops all of it. So a process of a few kilobytes looks
on, is told of each signal by the system, and ends the command where nothing else can.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import time
from contextlib import suppress

__all__ = ["die_with_parent", "heard", "kill_group", "look_on"]

ASKED = 2.0
"""How long after a first signal that nobody has heard a second one ends the command, seconds."""

HEARD = b"\xff"
"""What the command writes when it reacts to a signal; no signal has this number."""

PR_SET_PDEATHSIG = 1
"""The option of Linux's prctl that sends a signal when the parent's thread ends."""

SAID = (
    "mars2d: ended by force: code in C did not let it save; a log, --record OUT.mcap, keeps what "
    "was recorded\n"
)

_told = -1
"""Where the process that looks on is told, or -1."""


def look_on(numbers: list[signal.Signals]) -> None:
    """Start to look on: a second signal of these numbers that nobody hears ends this process.

    To be called once, in the main thread, before there are others. Has no effect but on Linux.
    """
    global _told  # noqa: PLW0603 - a process has one place to which signals are told
    if sys.platform != "linux" or _told >= 0:
        return
    command = os.getpid()
    read, write = os.pipe()
    if os.fork() == 0:
        os.close(write)
        with suppress(BaseException):
            _look(read, command, {int(number) for number in numbers})
        os._exit(0)
    os.close(read)
    os.set_blocking(write, False)
    _told = write
    signal.set_wakeup_fd(write, warn_on_full_buffer=False)


def heard() -> None:
    """Say that this process reacts to a signal."""
    if _told >= 0:
        with suppress(OSError):
            os.write(_told, HEARD)


def _look(told: int, command: int, numbers: set[int]) -> None:
    """Wait for signals of a process, and kill it after two that it has not heard."""
    for number in numbers:
        signal.signal(number, signal.SIG_IGN)
    die_with_parent()
    since = None
    while os.getppid() == command and (news := os.read(told, 64)):
        now = time.monotonic()
        for byte in news:
            if byte == HEARD[0]:
                since = None
            elif byte in numbers:
                if since is not None and now - since >= ASKED:
                    with suppress(OSError):
                        os.write(2, SAID.encode())
                    os.kill(command, signal.SIGKILL)
                    return
                since = now if since is None else since


def die_with_parent() -> None:
    """Let the system kill this process when the thread that started it ends, on Linux.

    A thread of our own would never run while C code holds the interpreter.
    """
    if sys.platform == "linux":
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def kill_group(leader: int) -> None:
    """Kill the processes of a group, on systems that have groups: its leader and all it started."""
    if hasattr(os, "killpg"):
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(leader, signal.SIGKILL)
