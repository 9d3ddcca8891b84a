"""Workers: processes of our own, one task each at a time; one that ends is replaced."""

from __future__ import annotations

import atexit
import multiprocessing
import os
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection, wait
from types import FrameType
from typing import TypeVar

from mars2d.core.errors import InputError
from mars2d.core.interrupt import interrupts_blocked
from mars2d.study.attempt import Failure, attempt_packed, packed, unpacked

__all__ = ["done_by_processes", "leave_if_imported_again"]

T = TypeVar("T")
R = TypeVar("R")

SPAWN = multiprocessing.get_context("spawn")

UNGUARDED = 79
"""With what a worker ends that finds itself in the call that has started it."""

MOST_STARTS = 3
"""How often in a row workers may be killed before they have begun."""

PATIENCE = 2.0
"""How long workers may take to end when they are told to, seconds."""

THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


def leave_if_imported_again() -> None:
    """End this process if it is a worker that imports the script which has started it.

    A new process imports the main script. If that starts workers as it is imported, this would
    go on for ever. Who has started the worker sees how it has ended, and says why.
    """
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        raise SystemExit(UNGUARDED)


def done_by_processes(
    function: Callable[[T], R], tasks: Sequence[T], count: int
) -> Iterator[tuple[int, R | Failure]]:
    """Yield what `each_done` does, by `count` processes."""
    known, order, left = packed(function), _Order(len(tasks)), len(tasks)
    crew = _Crew()
    try:
        crew.start(min(count, left))
        while left:
            done = []
            for index, returned in crew.wait():
                if isinstance(returned, bytes):
                    done.append((index, unpacked(returned)))
                elif not order.once_more(index):
                    failure = Failure(f"the process that ran it {returned}, twice")
                    done.append((index, failure))
            for worker in crew.idle():
                following = order.next(alone=not crew.busy())
                if following is not None:
                    worker.give(following, known, packed(tasks[following]))
            left -= len(done)
            yield from done  # while the others go on
    finally:
        crew.end()


class _Order:
    """Which task is next: each in turn, then, alone, those whose worker has ended."""

    def __init__(self, count: int) -> None:
        self._fresh = iter(range(count))
        self._again: deque[int] = deque()
        self._ended: set[int] = set()

    def next(self, *, alone: bool) -> int | None:
        """Return the next task, or None; alone: whether no other task is being done."""
        index = next(self._fresh, None)
        if index is None and self._again and alone:
            return self._again.popleft()
        return index

    def once_more(self, index: int) -> bool:
        """Note that the worker of a task has ended; return whether it is tried once more."""
        first = index not in self._ended
        if first:
            self._ended.add(index)
            self._again.append(index)
        return first


class _Worker:
    """A process that does one task at a time."""

    def __init__(self) -> None:
        self.connection, theirs = SPAWN.Pipe()
        self.process = SPAWN.Process(target=_serve, args=(theirs,))
        try:
            with interrupts_blocked(), _one_thread():
                self.process.start()
        finally:
            theirs.close()
        self.ready = False
        self.task: int | None = None

    def give(self, index: int, function: bytes, task: bytes) -> None:
        """Send a task; if the worker has ended meanwhile, it is found to have ended with it."""
        self.task = index
        with suppress(OSError):
            self.connection.send_bytes(function)
            self.connection.send_bytes(task)

    def message(self) -> bytes | None:
        """Return what it has sent, or None where it has ended."""
        with suppress(EOFError, OSError):
            if self.connection.poll():
                return self.connection.recv_bytes()
        return None

    def tell_to_end(self) -> None:
        """Let go of it: when it waits for a task it ends by itself, else by a signal."""
        self.connection.close()
        if self.task is not None or not self.ready:
            self.process.terminate()

    def how_ended(self, until: float) -> str:
        """Wait until it has ended, until a time of the clock; then kill it. Return how it ended."""
        try:
            self.process.join(max(0.0, until - time.monotonic()))
        finally:
            self.process.kill()
        self.process.join()
        code = self.process.exitcode or 0
        if code >= 0:
            return f"ended with exit code {code}"
        why = ", perhaps for want of memory" if code == -9 else ""
        return f"was killed by {signal.Signals(-code).name}{why}"


class _Crew:
    """Workers, and others in the place of those that have ended."""

    def __init__(self) -> None:
        self._workers: list[_Worker] = []
        self._failed_starts = 0

    def start(self, count: int) -> None:
        """Start so many processes."""
        atexit.register(self.end)  # before multiprocessing waits for them there
        for started in range(count):
            try:
                self._workers.append(_Worker())
            except OSError as error:
                why = f"only {started} processes could be started: {error.strerror}"
                raise InputError(f"workers={count}: {why}") from error

    def end(self) -> None:
        """End all processes, at once: of one that does not go within `PATIENCE` nothing is left."""
        atexit.unregister(self.end)
        for worker in self._workers:
            worker.tell_to_end()
        until = time.monotonic() + PATIENCE
        try:
            for worker in self._workers:
                worker.how_ended(until)
        finally:
            for worker in self._workers:
                worker.process.kill()

    def idle(self) -> list[_Worker]:
        """Return the workers that wait for a task."""
        return [worker for worker in self._workers if worker.ready and worker.task is None]

    def busy(self) -> bool:
        """Return whether any does a task."""
        return any(worker.task is not None for worker in self._workers)

    def wait(self) -> list[tuple[int, bytes | str]]:
        """Wait until something has happened; return the tasks of which something has come.

        Of each its index and what was returned; or how its worker has ended, in words.
        """
        ends = [end for each in self._workers for end in (each.connection, each.process.sentinel)]
        heard = set(wait(ends))
        found: list[tuple[int, bytes | str]] = []
        for place, worker in enumerate(self._workers):
            if worker.connection not in heard and worker.process.sentinel not in heard:
                continue
            index, message = worker.task, worker.message()
            how = "" if message is not None else self._replace(place)
            worker.task, worker.ready = None, True
            self._failed_starts = 0 if message is not None else self._failed_starts
            if index is not None:
                found.append((index, how if message is None else message))
        return found

    def _replace(self, place: int) -> str:
        """Put another worker in the place of one that has ended; return how it has."""
        worker = self._workers[place]
        worker.tell_to_end()
        how = worker.how_ended(time.monotonic() + PATIENCE)
        if not worker.ready:
            self._failed_starts += 1
            code = worker.process.exitcode or 0
            if code == UNGUARDED:
                raise InputError(
                    "a script that starts worker processes is imported by each of them: put what "
                    'runs many runs under `if __name__ == "__main__":`'
                )
            if code >= 0 or self._failed_starts == MOST_STARTS:
                raise InputError(
                    f"a worker process {how} before it had begun, see above: each imports the "
                    "script that runs the study, which must be a file that can be imported"
                )
        self._workers[place] = _Worker()
        return how


@contextmanager
def _one_thread() -> Iterator[None]:
    """Start a process in which numpy's linear algebra is one thread, unless the user has said more.

    By itself it takes all cores, as does each other worker: at 100 unknowns that is times slower.
    """
    ours = {name: "1" for name in THREADS if name not in os.environ}
    os.environ.update(ours)
    try:
        yield
    finally:
        for name in ours:
            os.environ.pop(name, None)


class _EndedError(BaseException):
    """Raised in a worker that is told to end, so that what it has started ends with it."""


def _serve(connection: Connection) -> None:
    """Do tasks, in a process of one's own, until there are no more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, _end)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    with suppress(_EndedError, EOFError, BrokenPipeError, ConnectionResetError):
        connection.send_bytes(b"")
        while True:
            returned = attempt_packed(connection.recv_bytes(), connection.recv_bytes())
            sys.stdout.flush()
            connection.send_bytes(returned)


def _end(_number: int, _frame: FrameType | None) -> None:
    raise _EndedError


def _end_with_parent() -> None:
    """End this process when its parent has, also in the midst of a task."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
