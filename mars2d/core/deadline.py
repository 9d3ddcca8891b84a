"""A time limit for the user's code, which is interrupted, with the line where that happened."""

from __future__ import annotations

import contextlib
import sys
import threading
import time
import traceback
from collections.abc import Callable
from types import TracebackType

from mars2d.core.errors import Passing
from mars2d.core.usercode import raise_in, users_line

PATIENCE = 10.0
"""The time that a control step may take, seconds."""

GRACE = 5.0
"""The time that the interruption may take, seconds."""


class Late(Passing):
    """The user's code took too long; a BaseException, so that its own `except` can't swallow it."""


class Deadline:
    """Interrupts the block by raising Late, `patience` seconds after the last call of `alive`.

    A separate thread watches the block, so it works in every thread and on every system. A call
    that waits in the operating system (``time.sleep``) can't be interrupted; then `give_up`, if
    given, is called from the watching thread with the line that hangs. If no thread can be
    started, for example in a browser, nothing is interrupted.
    """

    def __init__(
        self, patience: float = PATIENCE, give_up: Callable[[str], None] | None = None
    ) -> None:
        self.patience, self._give_up = patience, give_up
        self._lock = threading.Lock()
        self._ended = threading.Event()
        self._thread = 0
        self._since, self._fired = 0.0, False
        self.where = ""

    def alive(self) -> None:
        """Restart the clock."""
        self._since, self._fired = time.monotonic(), False

    def arrived(self) -> str:
        """Return the line that was interrupted; to be called where the block caught Late."""
        self.alive()
        return self.where

    def __enter__(self) -> Deadline:
        self.alive()
        self.where, self._thread, self._ended = "", threading.get_ident(), threading.Event()
        watch = threading.Thread(target=self._watch, args=(self._ended,), daemon=True)
        with contextlib.suppress(RuntimeError):  # "can't start new thread"
            watch.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        tb: TracebackType | None,
    ) -> None:
        with self._lock:
            self._ended.set()
        if self._fired and (kind is None or not issubclass(kind, Late)):
            # Late was raised but has not arrived. Revoking it would slow the interpreter down.
            with contextlib.suppress(Late):
                time.sleep(GRACE)

    def _watch(self, ended: threading.Event) -> None:
        while not ended.wait(min(self.patience / 10, 0.2)):
            waited = time.monotonic() - self._since
            if self._fired and waited > GRACE and self._give_up is not None:
                self._give_up(self.where)
                return
            if not self._fired and waited > self.patience:
                with self._lock:
                    if ended.is_set():
                        return
                    self.where = self._line()
                    self.alive()
                    self._fired = True
                    raise_in(self._thread, Late)

    def _line(self) -> str:
        frame = sys._current_frames().get(self._thread)
        return "" if frame is None else users_line(traceback.extract_stack(frame)) or ""
