"""A watchdog over the user's code during a run, which breaks off calls that never return."""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
import threading
import time
import traceback
from collections.abc import Callable
from types import FrameType

from mars2d.core.errors import InputError, shown
from mars2d.core.usercode import Hangs, raise_in, users_line

VARIABLE = "MARS2D_PATIENCE"
"""The environment variable that sets the patience, seconds; 0 waits for ever."""

PATIENCE = 10.0
"""The processor's time that one call of the user's code may take, seconds."""

ASLEEP = 3.0
"""How many times as long it may take if it sleeps in between."""

LOOK = 0.1
"""The time between two looks, seconds."""

SOON = 3
"""After as many looks at the same call somebody may be asked whether to go on waiting."""

_Pending = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)


def patience() -> float:
    """Return how long a call may take, seconds. Raises InputError for an invalid variable."""
    text = os.environ.get(VARIABLE)
    if not text:
        return PATIENCE
    try:
        seconds = float(text)
    except ValueError:
        seconds = -1.0
    if not seconds >= 0:
        raise InputError(f"{VARIABLE}={shown(text)}: expected seconds, 0 or more; 0 waits for ever")
    return seconds or float("inf")


class Watchdog:
    """Raises Hangs in a block whose calls of the user's code do not come to an end.

    It looks from a thread of its own, so it works on every system, and costs the block nothing. It
    counts the processor's time of the block's thread, and its own looks: a process that is stopped,
    and a processor that is busy, break off nobody. A debugger switches it off. Code that is not
    Python's can't be broken off before it returns. Where no thread can be started, as in a browser,
    nothing is.

    calls: returns what changes with each call. meanwhile: called in the main thread while a call
    takes long, with the file and line; returns the reason to break it off at once, or "".
    """

    def __init__(
        self, calls: Callable[[], object], meanwhile: Callable[[str], str] | None = None
    ) -> None:
        self._calls, self._meanwhile = calls, meanwhile
        self._patience = patience()
        self._ended = threading.Event()
        self._thread = threading.get_ident()
        self._spent = _clock_of(self._thread)
        self._ask = _Pending(self._asked)  # kept: the interpreter calls it later
        self._waits = False
        self._due: type[BaseException] | None = None  # the exception that the next look raises
        self._block: FrameType | None = None

    def __enter__(self) -> Watchdog:
        self._thread, self._block = threading.get_ident(), sys._getframe(1)
        self._spent = _clock_of(self._thread)
        watch = threading.Thread(target=self._watch, daemon=True, name="mars2d watchdog")
        with contextlib.suppress(RuntimeError):  # "can't start new thread"
            watch.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._block = None

    def _watch(self) -> None:
        with contextlib.suppress(OSError):  # of the clock of a thread that has ended
            self._look_on()

    def _look_on(self) -> None:
        last, since, looks = self._calls(), self._spent(), 0
        while not self._ended.wait(LOOK):
            now = self._calls()
            due, self._due = self._due, None
            if now != last:
                last, since, looks = now, self._spent(), 0
                continue
            if not self._users_line():
                looks, since = 0, self._spent()
                continue
            looks += 1
            spent = self._spent() - since
            if due is not None:
                raise_in(self._thread, due)
            elif spent > self._patience or looks * LOOK > ASLEEP * self._patience:
                late = _hangs(f"did not return within {self._patience:g} s")
                raise_in(self._thread, late)
                looks, since = 0, self._spent()
            elif self._meanwhile is not None and looks >= SOON and not self._waits:
                self._waits = True
                ctypes.pythonapi.Py_AddPendingCall(self._ask, None)

    def _asked(self, _: object) -> int:
        """Ask whether to go on waiting; the interpreter calls it in the main thread.

        The answer waits for the next look: raised here, it would be lost.
        """
        try:
            line = self._users_line()
            if self._meanwhile is not None and line:
                why = self._meanwhile(line)
                self._due = _hangs(why) if why else None
        except BaseException as error:
            self._due = type(error)
        finally:
            self._waits = False
        return 0

    def _users_line(self) -> str:
        """Return the line of the user's code that the block calls; "" if a debugger looks at it."""
        steps: list[traceback.FrameSummary] = []
        step = sys._current_frames().get(self._thread)
        while step is not None and step is not self._block:
            if step.f_trace is not None:
                return ""
            code = step.f_code
            steps.append(traceback.FrameSummary(code.co_filename, step.f_lineno, code.co_name))
            step = step.f_back
        return users_line(traceback.StackSummary.from_list(steps[::-1])) or ""


def _hangs(why: str) -> type[Hangs]:
    return type("Hangs", (Hangs,), {"why": why})


def _clock_of(thread: int) -> Callable[[], float]:
    """Return a clock of the processor's time of a thread, or of all time where there is none."""
    try:
        clock = time.pthread_getcpuclockid(thread)
    except (AttributeError, OSError):  # of Windows, and of a browser
        return time.monotonic
    return lambda: time.clock_gettime(clock)
