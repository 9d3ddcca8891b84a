"""Worker processes: each does one task at a time, and one that dies is replaced.

Tasks and results travel as bytes, so that anything that can't be pickled or found on the other
side is reported for its own task and does not harm the pool.
"""

from __future__ import annotations

import atexit
import multiprocessing
import os
import pickle
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import lru_cache
from multiprocessing.connection import Connection, wait
from typing import Any, NamedTuple, TypeVar

from mars2d.core.errors import InputError, shown
from mars2d.core.hints import described
from mars2d.core.interrupt import interrupts_blocked
from mars2d.study import ONE_THREAD

T = TypeVar("T")
R = TypeVar("R")

SPAWN = multiprocessing.get_context("spawn")

UNGUARDED_EXIT_CODE = 79
"""The exit code of a worker that reaches, while importing its script, the call that started it."""

MAX_FAILED_STARTS = 3
"""How many workers in a row may be killed before they have begun."""

BREAKING_OFF = 6.0
"""How long a task may take to end by itself at its limit, before its process is ended, seconds."""

LOOK = 0.5
"""The time between two looks at tasks with a limit, seconds."""

END_TIMEOUT = 2.0
"""How long workers may take to end when they are told to, seconds."""


# -- attempts --------------------------------------------------------------------------------------


class Failure(NamedTuple):
    """The result of a task that failed: the reason, in one line."""

    error: str


class _UnknownFunction(NamedTuple):
    """The function was not found in the process that was to run it: the reason, in one line."""

    error: str


def attempt(function: Callable[[T], R], task: T) -> R | Failure:
    """Return the function's result for a task, or a Failure if it raises."""
    try:
        return function(task)
    except (Exception, SystemExit) as error:
        return Failure(reason(error))


def reason(error: BaseException) -> str:
    """Return an exception's type and message in one line."""
    return " ".join(described(error).split())


def packed(thing: Any, dumps: Callable[[Any], bytes] = pickle.dumps) -> bytes:
    """Return a function or a task as bytes for another process.

    dumps: makes the bytes; pickle.loads must be able to read them. Raises InputError if it fails.
    """
    try:
        return dumps(thing)
    except Exception as error:
        raise InputError(
            f"{shown(thing)}: can't be sent to another process ({reason(error)}): give the "
            "experiment by its file and functions from a module, or run in this process, with "
            "executor=ThreadPoolExecutor()"
        ) from error


def attempt_packed(function: bytes, task: bytes) -> bytes:
    """Do as `attempt` with a `packed` function and task; read the result with `unpacked`."""
    result = _attempt_packed(function, task)
    try:
        return pickle.dumps(result)
    except Exception as error:
        return pickle.dumps(Failure(f"{shown(result)}: can't be sent back: {reason(error)}"))


def _attempt_packed(function: bytes, task: bytes) -> Any:
    try:
        known = _function(function)
    except Exception as error:
        return _UnknownFunction(reason(error))
    try:
        given = pickle.loads(task)
    except Exception as error:
        return Failure(f"can't be read by the process that runs it: {reason(error)}")
    return attempt(known, given)


_function = lru_cache(maxsize=4)(pickle.loads)
"""Unpickles a study's function, which is the same for all its tasks, once."""


def unpacked(returned: bytes) -> Any:
    """Return the result that `attempt_packed` sent; InputError if the function was not found."""
    try:
        value = pickle.loads(returned)
    except Exception as error:
        return Failure(f"what it returned can't be read: {reason(error)}")
    if isinstance(value, _UnknownFunction):
        raise InputError(
            f"a worker process does not find the function ({value.error}): put it into a module"
        )
    return value


# -- the pool --------------------------------------------------------------------------------------


def leave_if_imported_again() -> None:
    """End this process if it is a worker that is importing the script that started it.

    A new process imports the main script. If the script starts workers on import, they would start
    workers without end. The parent process recognizes the exit code and explains the mistake.
    """
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        raise SystemExit(UNGUARDED_EXIT_CODE)


def done_by_processes(
    function: Callable[[T], R], tasks: Sequence[T], count: int, limit: float | None = None
) -> Iterator[tuple[int, R | Failure]]:
    """Do the tasks in `count` processes; yield as `mars2d.study.work.each_done` does."""
    known, order, left = packed(function), _Order(len(tasks)), len(tasks)
    crew = _Crew()
    try:
        crew.start(min(count, left))
        while left:
            done = []
            for index, returned in crew.wait(limit):
                if isinstance(returned, bytes):
                    done.append((index, unpacked(returned)))
                elif isinstance(returned, _TooLong):
                    done.append((index, Failure(returned)))
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


class _TooLong(str):
    """The message about a task whose process was ended at its limit."""


class _Order:
    """The order of tasks: each in turn, then, one by one, those whose worker died."""

    def __init__(self, count: int) -> None:
        self._fresh = iter(range(count))
        self._again: deque[int] = deque()
        self._ended: set[int] = set()

    def next(self, *, alone: bool) -> int | None:
        """Return the next task, or None; alone: whether no other task is running."""
        index = next(self._fresh, None)
        if index is None and self._again and alone:
            return self._again.popleft()
        return index

    def once_more(self, index: int) -> bool:
        """Note that a task's worker died; return whether the task is tried once more."""
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
        self.spent = 0.0  # how long its task has taken, seconds

    def give(self, index: int, function: bytes, task: bytes) -> None:
        """Send a task; a worker that has died in the meantime will be blamed on this task."""
        self.task, self.spent = index, 0.0
        with suppress(OSError):
            self.connection.send_bytes(function)
            self.connection.send_bytes(task)

    def message(self) -> bytes | None:
        """Return the message that it has sent, or None if it has died."""
        with suppress(EOFError, OSError):
            if self.connection.poll():
                return self.connection.recv_bytes()
        return None

    def tell_to_end(self) -> None:
        """Close the connection, which ends an idle worker, and send a busy one a signal."""
        self.connection.close()
        if self.task is not None or not self.ready:
            self.process.terminate()

    def has_ended(self) -> bool:
        """Return whether it has ended, even if processes that it has started hold its pipes."""
        return self.process.exitcode is not None

    def how_ended(self, until: float) -> str:
        """Wait for its end until a time of the monotonic clock, then kill it; say how it ended."""
        try:
            self.process.join(max(0.0, until - time.monotonic()))
        finally:
            self.process.kill()
        self.process.join()
        code = self.process.exitcode or 0
        if code >= 0:
            return f"ended with exit code {code}"
        why = ", perhaps for lack of memory" if code == -9 else ""
        return f"was killed by {signal.Signals(-code).name}{why}"


class _Crew:
    """All workers; a new one takes the place of each that dies."""

    def __init__(self) -> None:
        self._workers: list[_Worker] = []
        self._failed_starts = 0

    def start(self, count: int) -> None:
        """Start `count` processes."""
        atexit.register(self.end)  # before multiprocessing waits for them there
        for started in range(count):
            try:
                self._workers.append(_Worker())
            except OSError as error:
                why = f"only {started} processes could be started: {error.strerror}"
                raise InputError(f"workers={count}: {why}") from error

    def end(self) -> None:
        """End all processes at the same time, and kill those that take over `END_TIMEOUT`."""
        atexit.unregister(self.end)
        for worker in self._workers:
            worker.tell_to_end()
        until = time.monotonic() + END_TIMEOUT
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
        """Return whether any worker is doing a task."""
        return any(worker.task is not None for worker in self._workers)

    def wait(self, limit: float | None = None) -> list[tuple[int, bytes | str]]:
        """Wait for news; return (index of a task, its result or how its worker died, in words).

        limit: seconds after which the worker of a task is ended.
        """
        ends = [end for each in self._workers for end in (each.connection, each.process.sentinel)]
        start = time.monotonic()
        heard = set(wait(ends, LOOK))
        heard |= {each.process.sentinel for each in self._workers if each.has_ended()}
        found = [] if limit is None else self._late(limit, time.monotonic() - start)
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

    def _late(self, limit: float, passed: float) -> list[tuple[int, bytes | str]]:
        """End the workers whose task takes too long, and return the tasks.

        passed: seconds since the last look. One that comes late, as after a pause of the whole
        program, counts as one look.
        """
        found: list[tuple[int, bytes | str]] = []
        for place, worker in enumerate(self._workers):
            if worker.task is None:
                continue
            worker.spent += min(passed, 2 * LOOK)
            if worker.spent > limit + BREAKING_OFF and not worker.connection.poll():
                said = f"took longer than {limit:g} s, in code that nothing interrupts"
                found.append((worker.task, _TooLong(said)))
                worker.process.kill()
                self._replace(place)
        return found

    def _replace(self, place: int) -> str:
        """Replace a worker that has died; say how it did. Raises InputError if none can begin."""
        worker = self._workers[place]
        worker.tell_to_end()
        how = worker.how_ended(time.monotonic() + END_TIMEOUT)
        if not worker.ready:
            self._failed_starts += 1
            code = worker.process.exitcode or 0
            if code == UNGUARDED_EXIT_CODE:
                raise InputError(
                    "a script that starts worker processes is imported by each of them: put what "
                    'runs many runs under `if __name__ == "__main__":`'
                )
            if code >= 0 or self._failed_starts == MAX_FAILED_STARTS:
                raise InputError(
                    f"a worker process {how} before it had begun, see above: each worker imports "
                    "the script that runs the study, which must be a file that can be imported"
                )
        self._workers[place] = _Worker()
        return how


@contextmanager
def _one_thread() -> Iterator[None]:
    """Start processes with `ONE_THREAD`, except for variables that the user has set.

    By default, numpy's linear algebra uses all cores in each worker, which makes them compete: at
    100 unknowns it is several times slower.
    """
    ours = {name: value for name, value in ONE_THREAD.items() if name not in os.environ}
    os.environ.update(ours)
    try:
        yield
    finally:
        for name in ours:
            os.environ.pop(name, None)


# -- inside a worker -------------------------------------------------------------------------------


def _serve(connection: Connection) -> None:
    """Do tasks, in a process of its own, until the connection closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    with suppress(EOFError, BrokenPipeError, ConnectionResetError):
        connection.send_bytes(b"")
        while True:
            returned = attempt_packed(connection.recv_bytes(), connection.recv_bytes())
            sys.stdout.flush()
            connection.send_bytes(returned)


def _end_with_parent() -> None:
    """End this process when its parent ends, even in the middle of a task."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
