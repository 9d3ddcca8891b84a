"""Worker processes: a pool that is made anew when one of them dies.

Tasks and results travel as bytes, so that anything that can't be pickled or found on the other
side is reported for its own task and does not harm the pool.
"""

from __future__ import annotations

import faulthandler
import multiprocessing
import os
import pickle
import signal
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from mars2d.core.errors import InputError, shown
from mars2d.core.hints import described
from mars2d.study import ONE_THREAD

T = TypeVar("T")
R = TypeVar("R")

SPAWN = multiprocessing.get_context("spawn")

BREAKING_OFF = 6.0
"""How long a task may take to end by itself at its limit, before its process is ended, seconds."""

LOOK = 0.5
"""The time between two looks for results, seconds; Ctrl-C waits for it, on Windows."""


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
        raise SystemExit(1)


def done_by_processes(
    function: Callable[[T], R], tasks: Sequence[T], count: int, limit: float | None = None
) -> Iterator[tuple[int, R | Failure]]:
    """Do the tasks in `count` processes; yield as `mars2d.study.work.each_done` does.

    The tasks that run when a process dies are done once more, alone; so the one to blame is known.
    """
    known, doubtful, blamed = packed(function), list[int](), list[int]()
    yield from _done(known, tasks, range(len(tasks)), min(count, len(tasks)), limit, doubtful)
    yield from _done(known, tasks, doubtful, 1, limit, blamed)
    late = "" if limit is None else f", perhaps in code in C at the time limit of {limit:g} s"
    for index in blamed:
        yield index, Failure(f"the process that ran it ended, twice{late}")


def _done(
    function: bytes,
    tasks: Sequence[Any],
    which: Iterable[int],
    count: int,
    limit: float | None,
    lost: list[int],
) -> Iterator[tuple[int, Any]]:
    """Do tasks in `count` processes, and yield results; add to `lost` those that a death ended."""
    left, running, pool = iter(which), dict[Future[bytes], int](), None
    end = None if limit is None else limit + BREAKING_OFF
    following = next(left, None)
    try:
        while following is not None or running:
            pool = pool or _started(count)
            while following is not None and len(running) < count:
                task = packed(tasks[following])
                running[_submitted(pool, _attempt_within, end, function, task)] = following
                following = next(left, None)
            for future in wait(running, LOOK, FIRST_COMPLETED).done:
                index = running.pop(future)
                if isinstance(future.exception(), BrokenProcessPool):
                    lost += [index, *running.values()]
                    running.clear()
                    _end(pool)
                    pool = None
                    break
                yield index, unpacked(future.result())
    finally:
        if pool is not None:
            _end(pool)


def _started(count: int) -> ProcessPoolExecutor:
    """Return a pool whose first process has begun. Raises InputError if it can't."""
    pool = ProcessPoolExecutor(count, SPAWN, _begin)
    try:
        _submitted(pool, os.getpid).result()
    except OSError as error:
        raise InputError(f"workers={count}: none could be started: {error.strerror}") from error
    except BrokenProcessPool:
        _end(pool)
        raise InputError(
            "a worker process ended before it had begun: each imports the script that "
            "runs the study, which must be a file that can be imported: put what runs many runs "
            'under `if __name__ == "__main__":`'
        ) from None
    except BaseException:
        _end(pool)
        raise
    return pool


def _submitted(pool: ProcessPoolExecutor, call: Callable[..., R], *arguments: Any) -> Future[R]:
    """Submit a call, for which a process may be started; a broken pool's future says so."""
    try:
        with _deaf(), _one_thread():
            return pool.submit(call, *arguments)
    except BrokenProcessPool as error:
        broken: Future[R] = Future()
        broken.set_exception(error)
        return broken


def _end(pool: ProcessPoolExecutor) -> None:
    """End the processes of a pool, whatever they do."""
    for process in [*(pool._processes or {}).values()]:  # public as kill_workers from 3.14 on
        process.kill()
    pool.shutdown(cancel_futures=True)


@contextmanager
def _deaf() -> Iterator[None]:
    """Start processes that ignore Ctrl-C from their first moment: they inherit that."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


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


def _begin() -> None:
    """Begin a worker: Ctrl-C is its parent's business, and it ends with its parent."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _attempt_within(seconds: float | None, function: bytes, task: bytes) -> bytes:
    """Do as `attempt_packed`; after some seconds this process is ended, even within C code."""
    with Path(os.devnull).open("w") as nothing:
        if seconds is not None:
            faulthandler.dump_traceback_later(seconds, exit=True, file=nothing)
        try:
            return attempt_packed(function, task)
        finally:
            faulthandler.cancel_dump_traceback_later()
            sys.stdout.flush()


def _end_with_parent() -> None:
    """End this process when its parent ends, even in the middle of a task."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
