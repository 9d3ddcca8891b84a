"""Work: apply one function to many tasks, on all cores, in threads or on a cluster."""

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
from uuid import uuid4

from mars2d.core.errors import InputError, counted, shown
from mars2d.study.cluster import DesertedError
from mars2d.study.workers import (
    Failure,
    attempt,
    attempt_packed,
    done_by_processes,
    leave_if_imported_again,
    packed,
    reason,
    unpacked,
)

T = TypeVar("T")
R = TypeVar("R")

IN_FLIGHT = 1000
"""How many tasks a foreign executor holds at once, at most."""

LOOK = 0.5
"""The time between two looks at the progress, seconds."""

LOST = "the executor takes no more tasks, or has lost them"
INSTEAD = "without one, processes are started, and replaced where they end"

MAX_WORKERS = 60 if sys.platform == "win32" else 1000
"""Windows can't wait for more than about 60 processes at once."""


def each_done(
    function: Callable[[T], R],
    tasks: Sequence[T],
    executor: Executor | None = None,
    workers: int | None = None,
    limit: float | None = None,
) -> Iterator[tuple[int, R | Failure]]:
    """Yield (index of a task, its result) as results arrive, exactly one for each task.

    The result of a task that raises is a `Failure`. executor: any executor of concurrent.futures;
    it is left open. None starts `workers` processes, which end with the iterator. If one of these
    dies during a task, another takes its place and the task is tried once more, at the end and
    alone; if that one dies too, the result is a Failure. workers: how many, from 1; by default one
    a core. limit: seconds after which a task ends by itself if it can, or else its process is
    ended some seconds later, and its result is a Failure.

    Raises InputError for an impossible number of workers, for a function or task that can't be sent
    to another process, and if a script calls this without ``if __name__ == "__main__":``.
    """
    leave_if_imported_again()
    count = worker_count(workers)
    if executor is None:
        return done_by_processes(function, tasks, count, limit)
    if not isinstance(executor, Executor):
        expected = "expected an Executor of concurrent.futures"
        raise InputError(f"executor={shown(executor)}: {expected}")
    return _done_by(executor, function, tasks)


def worker_count(workers: int | None) -> int:
    """Return the number of workers: `workers`, or one for each core if it is None."""
    if workers is None:
        return min(cores(), MAX_WORKERS)
    if isinstance(workers, bool) or not isinstance(workers, int) or not 0 < workers <= MAX_WORKERS:
        expected = f"expected a whole number from 1 to {MAX_WORKERS}"
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
    """Do as `each_done` with a foreign executor.

    A worker that dies takes finished results with it that it had not sent yet, so an innocent task
    may be blamed. Tasks that are blamed are therefore done again, alone, after all others.
    """
    left, blamed = len(tasks), dict[int, str]()
    try:
        for index, outcome in _sent(executor, function, tasks, range(left), IN_FLIGHT):
            if isinstance(outcome, _Ended):
                blamed[index] = outcome
            else:
                left -= 1
                yield index, outcome
        for index, outcome in _sent(executor, function, tasks, [*blamed], 1):
            left -= 1
            del blamed[index]
            yield index, Failure(outcome) if isinstance(outcome, _Ended) else outcome
    except DesertedError as deserted:
        for key, times in deserted.ended.items():
            blamed.setdefault(_index_in(key), _in_turn(times))
        for index, ended in blamed.items():
            yield index, Failure(f"{ended}; no worker is left")
        if len(blamed) < left:
            raise


class _Ended(str):
    """The message about a task whose process has died."""


def _sent(
    executor: Executor,
    function: Callable[[T], R],
    tasks: Sequence[T],
    which: Iterable[int],
    in_flight: int,
) -> Iterator[tuple[int, R | Failure | _Ended]]:
    """Send tasks to an executor, `in_flight` at once, and yield the outcome of each."""
    send, read = _ways(executor, function)
    study = uuid4().hex
    running: dict[Future[Any], int] = {}
    done: SimpleQueue[Future[Any]] = SimpleQueue()
    indices = iter(which)
    try:
        while True:
            while len(running) < in_flight and (index := next(indices, None)) is not None:
                task = tasks[index]
                try:
                    future = send(task, f"{study}-{index}")
                except RuntimeError as error:  # it is shut down, or broken
                    raise InputError(f"{LOST} ({reason(error)}): {INSTEAD}") from error
                running[future] = index
                future.add_done_callback(done.put)
            if not running:
                return
            future = _next(done, getattr(executor, "waiting", None))
            yield running.pop(future), _outcome(future, read)
    finally:
        for future in running:
            future.cancel()


def _next(done: SimpleQueue[Future[Any]], waiting: Callable[[float], None] | None) -> Future[Any]:
    """Return the next task that is done. waiting: called with the seconds that nothing came."""
    while True:
        try:
            return done.get(timeout=LOOK)  # Ctrl-C waits for it, on Windows
        except Empty:
            if waiting is not None:
                waiting(LOOK)


def _ways(
    executor: Executor, function: Callable[[T], R]
) -> tuple[Callable[[T, str], Future[Any]], Callable[[Any], Any]]:
    """Return a function that submits a task to an executor, and one that reads its result.

    The first one takes the task and its key, by which a cluster knows it.

    Tasks and results travel as bytes if the executor is known to use other processes; see
    `mars2d.study.workers`.
    """
    dumps = _dumps(executor)
    if dumps is None:
        return lambda task, _: executor.submit(attempt, function, task), lambda value: value
    known = packed(function, dumps)

    def send(task: T, key: str) -> Future[Any]:
        named = {"key": key} if _is_dasks(executor) else {}
        return executor.submit(attempt_packed, known, packed(task, dumps), **named)

    return send, unpacked


def _index_in(key: str) -> int:
    return int(key.rpartition("-")[2])


def _dumps(executor: Executor) -> Callable[[Any], bytes] | None:
    """Return the pickler for an executor's processes; None for threads and unknown executors."""
    if isinstance(executor, ProcessPoolExecutor):
        return pickle.dumps
    if _is_dasks(executor):
        import cloudpickle  # comes with Dask; also packs functions that are in no module

        return cloudpickle.dumps  # type: ignore[no-any-return]
    return None


def _is_dasks(executor: Executor) -> bool:
    return type(executor).__module__.startswith("distributed.")


def _outcome(future: Future[Any], read: Callable[[Any], Any]) -> Any:
    """Return the outcome of a task. Raises InputError if the executor can do no more."""
    try:
        value = future.result()
    except (BrokenExecutor, CancelledError) as error:
        raise InputError(f"{LOST} ({reason(error)}): {INSTEAD}") from error
    except Exception as error:
        if type(error).__name__ == "KilledWorker":  # Dask's, which need not be installed
            return _Ended(_in_turn(getattr(error, "allowed_failures", 0) + 1))
        return Failure(reason(error))
    return read(value)


def _in_turn(times: int) -> str:
    ended = "the process that ran it ended"
    return ended if times == 1 else f"{ended}, on {counted(times, 'worker')} in turn"
