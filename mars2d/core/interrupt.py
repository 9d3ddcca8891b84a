"""Ctrl-C that is not lost, that tidies up once, and that waits for what is being saved."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import inf
from types import FrameType, TracebackType

from mars2d.core.startup import leave

__all__ = [
    "held_back",
    "interrupts_blocked",
    "noted_interrupts",
    "raised_once",
    "unbroken",
    "unwrapped",
    "was_interrupted",
]

GRACE = 2.0
"""For so long after a Ctrl-C another one is the same wish: meanwhile all is tidied up, seconds."""

AGAIN = 0.01
"""How soon a Ctrl-C comes again that Python has dropped, seconds."""

_raised = -inf
"""When KeyboardInterrupt was raised last."""


class _Handling:
    """A block in which Ctrl-C does something of its own; the innermost of such blocks counts.

    Does nothing outside of the main thread, or where somebody else handles the signal. A generator
    would not do: interrupted as its block ends, it would go back to what was before much later.
    """

    def __init__(self) -> None:
        self._before = signal.getsignal(signal.SIGINT)
        ours = isinstance(self._before, _Handling) or self._before is leave
        if not ours and self._before is not signal.default_int_handler:
            self._before = None
        if threading.current_thread() is not threading.main_thread():
            self._before = None
        self._outermost = not isinstance(self._before, _Handling)

    def __call__(self, number: int, frame: FrameType | None) -> None:  # noqa: ARG002
        """Do what Ctrl-C does here: the handler of the signal."""
        self._act()

    def _act(self) -> None:
        raise NotImplementedError

    def _begin(self) -> None:
        if self._before is None:
            return
        if self._outermost:
            global _raised  # noqa: PLW0603 - a process has one Ctrl-C
            _raised = -inf
        signal.signal(signal.SIGINT, self)

    def _end(self) -> None:
        if self._before is not None:
            signal.signal(signal.SIGINT, self._before)


class noted_interrupts(_Handling):  # noqa: N801 - it is used as a function
    """Note each Ctrl-C; yield what raises KeyboardInterrupt if there has been one.

    Python raises it wherever it is just then, and drops it where nobody is called who could pass it
    on: in what C code calls back, or in what is done while memory is tidied up. So whoever goes
    on for long asks again. Several within `GRACE` are one.
    """

    def __init__(self) -> None:
        super().__init__()
        self._pressed = False

    def _act(self) -> None:
        self._pressed = True
        _raise_once()

    def _check(self) -> None:
        if self._pressed:
            _raise()

    def __enter__(self) -> Callable[[], None]:
        self._begin()
        return self._check

    def __exit__(self, *_: object) -> None:
        self._end()


class held_back(_Handling):  # noqa: N801 - it is used as a function
    """Let Ctrl-C wait for the end of the block, and raise KeyboardInterrupt then.

    what: for what it waits, which is said on stderr. Within, `noted_interrupts` lets it through.
    Where the block ends with an error, that is the one that counts.
    """

    def __init__(self, what: str = "") -> None:
        super().__init__()
        self._what = what
        self._pressed = False

    def _act(self) -> None:
        if self._what and not self._pressed:
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
    """Raise KeyboardInterrupt at Ctrl-C, but not again while all is tidied up after it.

    One that Python would drop, with a traceback on stderr, as in what is done while memory is
    tidied up or a module is imported, comes again.
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
        again = threading.Timer(AGAIN, _press)
        again.daemon = True
        again.start()


class _Unbroken:
    """A short block that Ctrl-C does not break off: KeyboardInterrupt is raised at its end.

    It costs less than a microsecond, and needs one of the other blocks around it, which handles the
    signal. Only in the main thread, where Python raises it.
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
    """Send Ctrl-C to the main thread, also while it waits for the system."""
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
    """Return whether an error is what others have made of a KeyboardInterrupt.

    Libraries in C do, as "ImportError: initialization failed" where they are imported just then.
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
    """Raise KeyboardInterrupt in place of an error that others have made of it."""
    try:
        yield
    except Exception as error:
        if was_interrupted(error):
            raise KeyboardInterrupt from error
        raise


@contextmanager
def interrupts_blocked() -> Iterator[None]:
    """Start processes that Ctrl-C does not reach, from their first moment.

    They start with those signals blocked that are blocked here. Ours come as soon as they no longer
    are. Windows has no such thing.
    """
    if sys.platform == "win32":
        yield
        return
    from multiprocessing.resource_tracker import ensure_running

    ensure_running()  # which would let them through
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
