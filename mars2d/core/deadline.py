"""A time limit for the user's code, which is broken off, with the line where that happened."""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
import threading
import time
import traceback
from collections.abc import Callable
from types import CodeType, FrameType

from mars2d.core.errors import InputError, Late, shown
from mars2d.core.usercode import users_line

VARIABLE = "MARS2D_PATIENCE"
"""The environment variable that sets the patience with a law, seconds; 0 waits for ever."""

PATIENCE = 10.0
"""The time that a control step, or a call of a law, may take, seconds."""

GRACE = 5.0
"""The time that breaking off may take, seconds."""

LOOK = 0.1
"""The longest time between two looks, seconds."""

SOON = 3
"""After as many looks at the same call somebody may be asked whether to go on waiting."""

UNANSWERED = 15
"""After as many more looks, code of which no step was done waits in C or in the system."""

_Pending = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)


def patience() -> float:
    """Return how long a call of a law may take, seconds. Raises InputError for a bad variable."""
    text = os.environ.get(VARIABLE) or f"{PATIENCE}"
    try:
        seconds = float(text)
    except ValueError:
        seconds = -1.0
    if not seconds >= 0:
        raise InputError(f"{VARIABLE}={shown(text)}: expected seconds, 0 or more; 0 waits for ever")
    return seconds or float("inf")


class Deadline:
    """Breaks off the block by raising Late, `patience` seconds after the last sign of life.

    It looks from a thread of its own, so it works in every thread and on every system, and counts
    its looks: a process that was suspended is not late. A call that waits in the operating system
    or in C can't be broken off: `GRACE` later `give_up`, if given, is called from the watching
    thread with the line. Where no thread can be started, as in a browser, nothing is broken off.

    calls: returns what changes with each call of the user's code, which is then all that is broken
    off, and Late says so of the call; a debugger is waited for. Else `alive` is the sign of life.
    meanwhile: called in the main thread while a call takes long, with the file and line; returns
    the reason to break it off at once, or "". Where the call waits in the system or in C, it is
    called in the watching thread, and `blocked` is set: a reason then means to give up.
    """

    def __init__(
        self,
        patience: float = PATIENCE,
        give_up: Callable[[str], None] | None = None,
        calls: Callable[[], object] | None = None,
        meanwhile: Callable[[str], str] | None = None,
    ) -> None:
        self.patience, self.where = patience, ""
        self._give_up, self._calls, self._meanwhile = give_up, calls, meanwhile
        self._lock, self._ended = threading.Lock(), threading.Event()
        self._signs, self._looks, self._fired = 0, 0, False
        self._thread, self._block = 0, sys._getframe()
        self._ask = _Pending(self._asked)  # kept: the interpreter calls it later
        self._asked_at, self.blocked = 0, False  # after which look; 0 once it is answered
        self._due: type[BaseException] | None = None  # the exception that the next look raises

    def alive(self) -> None:
        """Start counting again."""
        self._signs, self._looks, self._fired = self._signs + 1, 0, False

    def arrived(self) -> str:
        """Return the line that was broken off; to be called where the block caught Late."""
        self.alive()
        return self.where

    def __enter__(self) -> Deadline:
        self.alive()
        self._thread, self._block = threading.get_ident(), sys._getframe(1)
        self.where, self._ended = "", threading.Event()
        watch = threading.Thread(
            target=self._watch, args=(self._ended,), daemon=True, name="mars2d deadline"
        )
        with contextlib.suppress(RuntimeError):  # "can't start new thread"
            watch.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        with self._lock:
            self._ended.set()
        if self._fired and (kind is None or not issubclass(kind, Late)) and not self._calls:
            # Late was raised but has not arrived. Revoking it would slow the interpreter down.
            with contextlib.suppress(Late):
                time.sleep(GRACE)

    def _watch(self, ended: threading.Event) -> None:
        look, last = min(self.patience / 10, LOOK), None
        while not ended.wait(look):
            sign, line = self._signs if self._calls is None else self._calls(), self._line()
            due, self._due = self._due, None
            if sign != last or (self._calls is not None and not line):
                last, self._looks, self._fired, self.blocked = sign, 0, False, False
                continue
            self._looks += 1
            waited = self._looks * look
            if due is not None and self.blocked:  # it would not arrive
                if self._give_up is not None:
                    self._give_up(line)
                continue
            if due is None and waited > (GRACE if self._fired else self.patience):
                if self._fired and self._give_up is not None:
                    self._give_up(line)
                due = _late(f"did not return within {self.patience:g} s" if self._calls else "")
            if due is not None:
                with self._lock:
                    if ended.is_set():
                        return
                    self.where, self._looks, self._fired = line, 0, True
                    thread = ctypes.c_ulong(self._thread)  # between two steps of its Python code
                    ctypes.pythonapi.PyThreadState_SetAsyncExc(thread, ctypes.py_object(due))
            elif self._meanwhile is not None and self._looks >= SOON and not self._asked_at:
                self._asked_at = self._looks
                ctypes.pythonapi.Py_AddPendingCall(self._ask, None)
            elif self._asked_at and self._looks - self._asked_at > UNANSWERED:
                self.blocked = True
                self._consult()

    def _asked(self, _: object) -> int:
        """Ask whether to go on waiting; the interpreter calls it in the main thread.

        The answer waits for the next look: raised here, it would be lost.
        """
        self.blocked = False
        self._consult()
        self._asked_at = 0
        return 0

    def _consult(self) -> None:
        try:
            line = self._line()
            if self._meanwhile is not None and line:
                why = self._meanwhile(line)
                self._due = _late(why) if why else None
        except BaseException as error:
            self._due = type(error)

    def _line(self) -> str:
        """Return the line of the user's code that the block is in; "" if a debugger looks at it."""
        steps: list[traceback.FrameSummary] = []
        step: FrameType | None = sys._current_frames().get(self._thread)
        while step is not None and step is not self._block:
            if step.f_trace is not None and self._calls is not None:
                return ""
            code: object = step.f_code
            if not isinstance(code, CodeType):  # it has just ended, and its memory is another's
                break
            steps.append(traceback.FrameSummary(code.co_filename, step.f_lineno, code.co_name))
            step = step.f_back
        return users_line(traceback.StackSummary.from_list(steps[::-1])) or ""


def _late(why: str) -> type[Late]:
    return type("Late", (Late,), {"why": why})
