"""Work: one function for many tasks, on all cores, in threads, or on a cluster."""

from __future__ import annotations

import os
import pickle
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import (
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
)
from queue import Empty, SimpleQueue
from typing import Any, TypeVar

from mars2d.core.errors import InputError, counted, shown
from mars2d.study.attempt import Failure, attempt, attempt_packed, one_line, packed, unpacked
from mars2d.study.cluster import cluster
from mars2d.study.workers import done_by_processes, leave_if_imported_again

__all__ = ["Failure", "cluster", "each_done", "worker_count"]

T = TypeVar("T")
R = TypeVar("R")

IN_FLIGHT = 1000
"""The most tasks that another's executor holds at once."""

LOST = "the executor takes no more tasks, or has lost them"
INSTEAD = "without one, processes are started, and replaced where they end"

MOST_WORKERS = 60 if sys.platform == "win32" else 1000
"""Windows can't wait for more."""


def each_done(
    function: Callable[[T], R],
    tasks: Sequence[T],
    executor: Executor | None = None,
    workers: int | None = None,
) -> Iterator[tuple[int, R | Failure]]:
    """Yield (index of the task, what the function made of it) as they come, each exactly once.

    A task that raises comes as a `Failure`. executor: any of concurrent.futures', which is left
    open; None starts `workers` processes, which end with the iterator. When one of these ends while
    it runs a task, another takes its place, and the task is tried once more, at the end and alone;
    ends that one as well, the task is a Failure. workers: how many, from 1; None is one a core.

    Raises InputError for a number of workers that can't be, for what can't be sent to another
    process, and where a script calls this without ``if __name__ == "__main__":``.
    """
    leave_if_imported_again()
    count = worker_count(workers)
    if executor is None:
        return done_by_processes(function, tasks, count)
    if not isinstance(executor, Executor):
        expected = "expected an Executor of concurrent.futures"
        raise InputError(f"executor={shown(executor)}: {expected}")
    return _done_by(executor, function, tasks)


def worker_count(workers: int | None) -> int:
    """Return how many workers are meant: as many as there are cores where nothing is said."""
    if workers is None:
        return min(cores(), MOST_WORKERS)
    if isinstance(workers, bool) or not isinstance(workers, int) or not 0 < workers <= MOST_WORKERS:
        expected = f"expected a whole number from 1 to {MOST_WORKERS}"
        raise InputError(f"workers={shown(workers)}: {expected}")
    return workers


def cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _done_by(
    executor: Executor, function: Callable[[T], R], tasks: Sequence[T]
) -> Iterator[tuple[int, R | Failure]]:
    """Do what `each_done` does by another's executor.

    Where a worker has ended, what it was about to tell of other tasks is lost as well. So those
    that are blamed for it are done again when all others are, each alone.
    """
    blamed: list[int] = []
    for index, outcome in _sent(executor, function, tasks, range(len(tasks)), IN_FLIGHT):
        if isinstance(outcome, _Ended):
            blamed.append(index)
        else:
            yield index, outcome
    for index, outcome in _sent(executor, function, tasks, blamed, 1):
        yield index, Failure(outcome) if isinstance(outcome, _Ended) else outcome


class _Ended(str):
    """What is said of a task whose process has ended."""


def _sent(
    executor: Executor,
    function: Callable[[T], R],
    tasks: Sequence[T],
    which: Iterable[int],
    most: int,
) -> Iterator[tuple[int, R | Failure | _Ended]]:
    """Send tasks to an executor, so many at once, and yield what came of each."""
    send, read = _ways(executor, function)
    running: dict[Future[Any], int] = {}
    done: SimpleQueue[Future[Any]] = SimpleQueue()
    indices = iter(which)
    try:
        while True:
            while len(running) < most and (index := next(indices, None)) is not None:
                task = tasks[index]
                try:
                    future = send(task)
                except RuntimeError as error:  # it is shut down, or broken
                    raise InputError(f"{LOST} ({one_line(error)}): {INSTEAD}") from error
                running[future] = index
                future.add_done_callback(done.put)
            if not running:
                return
            future = _next(done)
            yield running.pop(future), _outcome(future, read)
    finally:
        for future in running:
            future.cancel()


def _next(done: SimpleQueue[Future[Any]]) -> Future[Any]:
    while True:
        try:
            return done.get(timeout=0.5)  # Ctrl-C waits for it, on Windows
        except Empty:
            continue


def _ways(
    executor: Executor, function: Callable[[T], R]
) -> tuple[Callable[[T], Future[Any]], Callable[[Any], Any]]:
    """Return what gives a task to an executor, and what reads its result.

    Both go as bytes where that is known to be for other processes, so that what can't be sent, or
    is not found there, is told and does no harm.
    """
    dumps = _dumps(executor)
    if dumps is None:
        return lambda task: executor.submit(attempt, function, task), lambda value: value
    known = packed(function, dumps)
    return lambda task: executor.submit(attempt_packed, known, packed(task, dumps)), unpacked


def _dumps(executor: Executor) -> Callable[[Any], bytes] | None:
    """Return what packs for an executor's processes; None for one of threads, or unknown."""
    if isinstance(executor, ProcessPoolExecutor):
        return pickle.dumps
    if type(executor).__module__.startswith("distributed."):
        import cloudpickle  # comes with Dask; packs what is of no module as well

        return cloudpickle.dumps  # type: ignore[no-any-return]
    return None


def _outcome(future: Future[Any], read: Callable[[Any], Any]) -> Any:
    """Return what came of a task; InputError where the executor can't do any more."""
    try:
        value = future.result()
    except (BrokenExecutor, CancelledError) as error:
        raise InputError(f"{LOST} ({one_line(error)}): {INSTEAD}") from error
    except Exception as error:
        if type(error).__name__ == "KilledWorker":  # Dask's, which need not be installed
            times = counted(getattr(error, "allowed_failures", 0) + 1, "worker")
            return _Ended(f"the process that ran it ended, on {times} in turn")
        return Failure(one_line(error))
    return read(value)
