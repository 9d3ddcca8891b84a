"""Ctrl-C: not lost, handled once, and late while something is being saved.

A process has one SIGINT, so all that concerns it is in this module. In the command line other
signals that ask it to end do what Ctrl-C does, see `ENDING`. It is imported first: in a
process that is the command line, and in no other, importing it installs the handler `leave`.
Until all libraries are imported there is nothing to save, and libraries in C may turn
KeyboardInterrupt into other errors.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import pairwise
from math import inf
from types import FrameType, TracebackType
from typing import Any

from mars2d.core.lastresort import heard

INTERRUPTED = 130
"""The command line's exit code after Ctrl-C, by the convention of shells."""

GRACE = 2.0
"""Further Ctrl-C within this time count as the same one, while the run is tidied up, seconds."""

RETRY_DELAY = 0.01
"""The delay after which a Ctrl-C that Python has dropped is sent again, seconds."""

ENDING = [
    getattr(signal, name)
    for name in ("SIGTERM", "SIGUSR1", "SIGUSR2", "SIGXCPU")
    if hasattr(signal, name)
]
"""Signals that end the command line as Ctrl-C does, unless other code handles them: that of `kill`,
those of schedulers of clusters, and of limits of the processor's time."""

_raised = -inf
"""The time at which KeyboardInterrupt was last raised."""


def leave(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
    """End the process at once: the signal handler while there is nothing to lose."""
    with suppress(OSError):
        os.write(2, b"mars2d: interrupted\n")
    os._exit(INTERRUPTED)


def ending() -> None:
    """Ignore Ctrl-C from now on in the command line: its work is done, its exit code is known."""
    if signal.getsignal(signal.SIGINT) is leave:
        signal.signal(signal.SIGINT, signal.SIG_IGN)


def _is_command_line() -> bool:
    """Return whether this process was started as ``mars2d`` or ``python -m mars2d``.

    A worker process was not, although it has the arguments of the process that started it.
    """
    told, first = sys.orig_argv, sys.argv[0] if sys.argv else ""
    if first == "-m":  # while the package is imported
        return any(
            word == "mars2d" and before.startswith("-") and before.endswith("m")
            for before, word in pairwise(told)
        )
    name = first.replace("\\", "/").rpartition("/")[2]
    return name.partition(".")[0] == "mars2d" and first in told


OURS = _is_command_line()
"""Whether the process is the command line, so that its signals are ours."""

if (
    OURS
    and threading.current_thread() is threading.main_thread()
    and signal.getsignal(signal.SIGINT) is signal.default_int_handler
):
    signal.signal(signal.SIGINT, leave)


class _Handling:
    """A block with its own reaction to Ctrl-C; of nested blocks, the innermost one counts.

    In the command line the signals of `ENDING` do what Ctrl-C does.

    It has no effect outside the main thread, or if other code handles the signal. It is not a
    generator, since a generator interrupted at the end of its block would restore the previous
    handler much later.
    """

    kept: Callable[[], Any] | None = None
    rescue: Callable[[Any], None] | None = None

    def __init__(self) -> None:
        self._before: Any = signal.getsignal(signal.SIGINT)
        ours = isinstance(self._before, _Handling) or self._before is leave
        if not ours and self._before is not signal.default_int_handler:
            self._before = None
        if threading.current_thread() is not threading.main_thread():
            self._before = None
        self._outermost = not isinstance(self._before, _Handling)
        self._others_before: dict[int, Any] = {}

    def __call__(self, number: int, frame: FrameType | None) -> None:  # noqa: ARG002
        """React to Ctrl-C: this object is the signal's handler."""
        heard()
        self._act()

    def _act(self) -> None:
        raise NotImplementedError

    def _begin(self) -> None:
        if OURS and threading.current_thread() is threading.main_thread():
            for number in ENDING:
                before = signal.getsignal(number)
                if before is signal.SIG_DFL or isinstance(before, _Handling):
                    self._others_before[number] = before
                    signal.signal(number, self)
        if self._before is None:
            return
        if self._outermost:
            global _raised  # noqa: PLW0603 - a process has one Ctrl-C
            _raised = -inf
        signal.signal(signal.SIGINT, self)

    def _end(self) -> None:
        for number, before in self._others_before.items():
            if signal.getsignal(number) is self:
                signal.signal(number, before)
        if self._before is not None:
            signal.signal(signal.SIGINT, self._before)


class noted_interrupts(_Handling):  # noqa: N801 - it is used as a function
    """Note each Ctrl-C; yield a function that raises KeyboardInterrupt if there has been one.

    Python raises KeyboardInterrupt wherever it happens to be, and drops it where no caller can
    receive it: in callbacks from C code and in destructors. So a long-running loop calls the
    function as well. Several Ctrl-C within `GRACE` count as one.

    kept: returns what there is to save by now. A second Ctrl-C that finds the block still going on,
    since the user's code catches everything, saves that by the `rescue` of a `held_back` around
    the block, and ends the process.
    """

    def __init__(self, kept: Callable[[], Any] | None = None) -> None:
        super().__init__()
        self.kept = kept
        self._pressed = False
        self._first = inf

    def _act(self) -> None:
        now = time.monotonic()
        if now - self._first >= GRACE and not unbroken.depth:
            self._give_up()
        self._first = min(self._first, now)
        self._pressed = True
        _raise_once()

    def _give_up(self) -> None:
        """Save the data so far and end the process, if somebody around the block can save them."""
        around: Any = self
        kept = rescue = None
        while isinstance(around, _Handling):
            kept, rescue = kept or around.kept, rescue or around.rescue
            around = around._before
        if kept is None or rescue is None:
            return
        try:
            rescue(kept())
        finally:
            leave(0, None)

    def _check(self) -> None:
        if self._pressed:
            _raise()

    def __enter__(self) -> Callable[[], None]:
        self._begin()
        return self._check

    def __exit__(self, *_: object) -> None:
        self._end()


class held_back(_Handling):  # noqa: N801 - it is used as a function
    """Hold Ctrl-C back until the end of the block, and raise KeyboardInterrupt then.

    what: the reason for waiting, which is printed on stderr. rescue: saves what a block within this
    one has kept, see `noted_interrupts`. A `noted_interrupts` within the block lets Ctrl-C through.
    If the block ends with an error, that error is raised instead.
    """

    def __init__(self, what: str = "", rescue: Callable[[Any], None] | None = None) -> None:
        super().__init__()
        self._what, self.rescue = what, rescue
        self._pressed = False

    def _act(self) -> None:
        if self._what and not self._pressed:
            with suppress(OSError):  # it is closed, or full
                os.write(2, f"mars2d: one moment: {self._what}\n".encode(errors="replace"))
        self._pressed = True

    def __enter__(self) -> held_back:
        self._begin()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._end()
        if self._pressed and error is None:
            _raise()


class raised_once(_Handling):  # noqa: N801 - it is used as a function
    """Raise KeyboardInterrupt at Ctrl-C, but not again while the program tidies up after it.

    A KeyboardInterrupt that Python drops with a traceback on stderr, for example in a destructor,
    is sent again.
    """

    def _act(self) -> None:
        _raise_once()

    def __enter__(self) -> None:
        self._hook = sys.unraisablehook
        if self._before is not None:
            sys.unraisablehook = self._dropped
        self._begin()

    def __exit__(self, *_: object) -> None:
        self._end()
        sys.unraisablehook = self._hook

    def _dropped(self, what: sys.UnraisableHookArgs) -> None:
        if not isinstance(what.exc_value, KeyboardInterrupt):
            self._hook(what)
            return
        global _raised  # noqa: PLW0603
        _raised = -inf
        again = threading.Timer(RETRY_DELAY, _press)
        again.daemon = True
        again.start()


class _Unbroken:
    """A short block that Ctrl-C does not interrupt: KeyboardInterrupt is raised at its end.

    It costs less than a microsecond. It must be within one of the other blocks, which handles the
    signal, and has an effect in the main thread only, where Python raises KeyboardInterrupt.
    """

    def __init__(self) -> None:
        self.depth = 0
        self.late = False

    def __enter__(self) -> None:
        if threading.current_thread() is threading.main_thread():
            self.depth += 1

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if threading.current_thread() is not threading.main_thread():
            return
        self.depth -= 1
        if self.late and not self.depth:
            self.late = False
            if kind is None:
                _raise()


unbroken = _Unbroken()


def _press() -> None:
    """Send Ctrl-C to the main thread, even if it is waiting in a system call."""
    main = threading.main_thread().ident
    if sys.platform == "win32" or main is None:
        signal.raise_signal(signal.SIGINT)
    else:
        signal.pthread_kill(main, signal.SIGINT)


def _raise_once() -> None:
    if unbroken.depth:
        unbroken.late = True
    elif time.monotonic() - _raised >= GRACE:
        _raise()


def _raise() -> None:
    global _raised  # noqa: PLW0603
    _raised = time.monotonic()
    raise KeyboardInterrupt


def was_interrupted(error: BaseException | None) -> bool:
    """Return whether an error was caused by a KeyboardInterrupt.

    Libraries in C convert it: "ImportError: initialization failed" if it comes as they are
    imported.
    """
    seen: set[int] = set()
    while error is not None and id(error) not in seen:
        if isinstance(error, KeyboardInterrupt):
            return True
        seen.add(id(error))
        error = error.__cause__ or error.__context__
    return False


@contextmanager
def unwrapped() -> Iterator[None]:
    """Raise KeyboardInterrupt in place of an error that was caused by it."""
    try:
        yield
    except Exception as error:
        if was_interrupted(error):
            raise KeyboardInterrupt from error
        raise


@contextmanager
def interrupts_blocked() -> Iterator[None]:
    """Block SIGINT within the block, so that processes started in it never receive Ctrl-C.

    A process inherits the blocked signals of the one that starts it. A Ctrl-C for this process is
    delivered at the end of the block. Has no effect on Windows.
    """
    if sys.platform == "win32":
        yield
        return
    from multiprocessing.resource_tracker import ensure_running

    ensure_running()  # else it would be started here, and unblock the signal
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
