"""The last resort: a second Ctrl-C ends the command line, whatever holds it.

Python reacts to a signal between two steps of its own. A law in C code that keeps the interpreter,
such as the decomposition of a large matrix, stops all of it. So a process of a few kilobytes looks
on, is notified of each signal, and ends the command where nothing else can.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import time
from contextlib import suppress
from pathlib import Path

ASKED = 2.0
"""How long after a first signal that nobody has heard a second one ends the command, seconds."""

HEARD = b"\xff"
"""What the command writes when it reacts to a signal; no signal has this number."""

PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36
"""Options of Linux's prctl: send a signal when the parent's thread ends; become the parent of
descendants whose parent ends."""

SAID = (
    "mars2d: ended by force: code in C did not let it save; a log, --record OUT.mcap, keeps what "
    "was recorded\n"
)

_told = -1
"""The pipe to the process that looks on, or -1."""

_looker = -1
"""The process that looks on, or -1."""


def look_on(numbers: list[signal.Signals]) -> None:
    """Start to look on: a second signal of these numbers that nobody hears ends this process.

    To be called once, in the main thread, before there are others. Has no effect but on Linux.
    """
    global _told, _looker  # noqa: PLW0603 - a process has one that looks on
    if sys.platform != "linux" or _told >= 0:
        return
    command = os.getpid()
    read, write = os.pipe()
    _looker = os.fork()
    if _looker == 0:
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
                    left = started_here(command)
                    _prctl(PR_SET_PDEATHSIG, 0)  # outlive the command, to kill what it left
                    os.kill(command, signal.SIGKILL)
                    for each in left:
                        kill(each)
                    return
                since = now if since is None else since


def keep_orphans() -> None:
    """Adopt processes whose parents, which this one started, end: `started_here` finds them."""
    _prctl(PR_SET_CHILD_SUBREAPER, 1)


def started_here(command: int | None = None) -> dict[int, str]:
    """Return the processes that one has started, and these in turn, and their names, on Linux.

    command: its number; None: this one. Those that have left its process group are not among them,
    nor is the one that looks on, nor are those that have ended.
    """
    command = os.getpid() if command is None else command
    if sys.platform != "linux":
        return {}
    parents, groups, names = {}, {}, {}
    for file in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):  # it has ended meanwhile
            before, _, after = file.read_text(errors="replace").rpartition(")")
            state, parent, group = after.split()[:3]
            if state not in "ZX":
                number = int(file.parent.name)
                parents[number], groups[number] = int(parent), int(group)
                names[number] = before.partition("(")[2]
    found, queue = {}, [command]
    for above in queue:
        queue += [number for number, parent in parents.items() if parent == above]
    for number in queue[1:]:
        if groups[number] == groups.get(command) and number not in (_looker, os.getpid()):
            found[number] = names[number]
    return found


def kill(process: int) -> None:
    """Kill a process, if it has not ended yet."""
    with suppress(ProcessLookupError, PermissionError):
        os.kill(process, signal.SIGKILL)


def die_with_parent() -> None:
    """Let the system kill this process when the thread that started it ends, on Linux.

    A thread of our own would never run while C code holds the interpreter.
    """
    _prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def _prctl(option: int, value: int) -> None:
    if sys.platform == "linux":
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(option, value)


def kill_group(leader: int) -> None:
    """Kill the processes of a group, on systems that have groups: its leader and all it started."""
    if hasattr(os, "killpg"):
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(leader, signal.SIGKILL)
