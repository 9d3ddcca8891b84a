"""Ctrl-C, SIGTERM and SIGHUP: raised once, not lost, and late while something is being saved.

Python raises KeyboardInterrupt wherever it happens to be, and drops it where no caller can receive
it. So a run is a block that notes it as well. In a process that is the command line, and in no
other, all three do the same, and until all libraries are imported each ends it in a line.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from types import FrameType
from typing import Any

INTERRUPTED, BAD_INPUT = 130, 2
"""The command line's exit codes after Ctrl-C, by the convention of shells, and for a bad law."""

GRACE = 2.0
"""Further Ctrl-C within this time count as the same one, while the run is tidied up, seconds."""

ENDING = signal.SIGINT, signal.SIGTERM, getattr(signal, "SIGHUP", signal.SIGTERM)
"""Ctrl-C, `kill`, and the end of the terminal, which Windows does not tell."""

_raised = float("-inf")
"""The time at which KeyboardInterrupt was last raised."""


def leave(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
    """End the process at once: the signal handler while there is nothing to lose."""
    with suppress(OSError):
        os.write(2, b"mars2d: interrupted\n")
    os._exit(INTERRUPTED)


OURS = ("-m", "mars2d") in pairwise(sys.orig_argv) or Path([*sys.argv, ""][0]).stem == "mars2d"
"""Whether this process was started as ``mars2d`` or ``python -m mars2d``, with options or not."""

if OURS and threading.current_thread() is threading.main_thread():
    for each in ENDING:
        if signal.getsignal(each) in (signal.default_int_handler, signal.SIG_DFL):
            signal.signal(each, leave)


class interrupts:  # noqa: N801 - it is used as a function
    """A block with its own reaction to Ctrl-C; of nested blocks, the innermost one counts.

    It yields a function that raises KeyboardInterrupt if there has been one, to be called now and
    then. Several within `GRACE` count as one. Outside the main thread, and where other code handles
    the signal, it has no effect.

    held: why to wait, which is said on stderr, or "": KeyboardInterrupt is raised at the end of the
    block, unless an error is. kept: returns what there is to save by now. rescue: saves that where
    the block can't be left, see `give_up`.
    """

    def __init__(
        self,
        held: str | None = None,
        kept: Callable[[], Any] | None = None,
        rescue: Callable[[Any], None] | None = None,
    ) -> None:
        self._held, self.kept, self.rescue = held, kept, rescue
        self.pressed = False
        self.before: dict[int, Any] = {}

    def __call__(self, number: int, frame: FrameType | None) -> None:  # noqa: ARG002
        """React to Ctrl-C: this object is the signal's handler."""
        first, self.pressed = not self.pressed, True
        if self._held is None:
            if time.monotonic() - _raised >= GRACE:
                _raise()
        elif self._held and first:
            with suppress(OSError):  # it is closed, or full
                os.write(2, f"mars2d: one moment: {self._held}\n".encode(errors="replace"))

    def __enter__(self) -> Callable[[], None]:
        if threading.current_thread() is threading.main_thread():
            for number in ENDING:
                before: Any = signal.getsignal(number)
                if isinstance(before, interrupts) or before in (leave, signal.default_int_handler):
                    self.before[number] = before
                    signal.signal(number, self)
            if not any(isinstance(each, interrupts) for each in self.before.values()):
                global _raised  # noqa: PLW0603 - a process has one Ctrl-C
                _raised = float("-inf")
        return self._check

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        for number, before in self.before.items():
            signal.signal(number, before)
        if self._held is not None and kind is None:
            self._check()

    def _check(self) -> None:
        if self.pressed:
            _raise()


def _raise() -> None:
    global _raised  # noqa: PLW0603
    _raised = time.monotonic()
    raise KeyboardInterrupt


def give_up(where: str) -> None:
    """Save what the blocks around have kept, and end the process: code does not return.

    where: its line. Called from another thread. Has no effect unless one of the blocks can save.
    """
    block: Any = signal.getsignal(signal.SIGTERM)
    kept, rescue, code = None, None, BAD_INPUT
    while isinstance(block, interrupts):
        kept, rescue = kept or block.kept, rescue or block.rescue
        code = INTERRUPTED if block.pressed else code
        block = block.before.get(signal.SIGTERM)
    if kept is None or rescue is None:
        return
    try:
        with suppress(OSError):
            os.write(2, f"mars2d: {where} does not return: ended by force\n".encode())
        rescue(kept())
    finally:
        os._exit(code)
