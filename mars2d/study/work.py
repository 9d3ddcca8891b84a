"""Work: apply one function to many tasks, in processes, in threads or on a cluster."""

from __future__ import annotations

import faulthandler
import multiprocessing
import os
import pickle
import signal
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import (
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
)
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any, NamedTuple, TypeVar

import cloudpickle

from mars2d.core.errors import InputError, shown
from mars2d.core.hints import described
from mars2d.study import WORKERS

T = TypeVar("T")
R = TypeVar("R")

MAX_WORKERS = 60 if sys.platform == "win32" else 1000
"""Windows can't wait for more than about 60 processes at once."""

IN_FLIGHT = 1000
"""How many tasks an executor that was given holds at once, at most."""

BREAKING_OFF = 6.0
"""How long a task may take to end by itself at its limit, before its process is ended, seconds."""

LOOK = 0.5
"""The time between two looks for results, seconds; Ctrl-C waits for it, on Windows."""


class Failure(NamedTuple):
    """The result of a task that failed: the reason, in one line."""

    error: str


class _Lost(Failure):
    """The result of a task whose process has ended, perhaps because of another task."""


def each_done(
    function: Callable[[T], R],
    tasks: Sequence[T],
    executor: Executor | None = None,
    workers: int | None = None,
    limit: float | None = None,
) -> Iterator[tuple[int, R | Failure]]:
    """Yield (index of a task, its result) as results arrive, exactly one for each task.

    The result of a task that raises is a `Failure`. executor: any executor of concurrent.futures,
    or a Client of Dask; it is left open. None starts `workers` processes, which end with the
    iterator; by default one a core. Where a process dies, the tasks that are lost are done again at
    the end, each alone; if that process dies too, the result is a Failure. limit: seconds after
    which a task ends by itself if it can, or else its process is ended some seconds later.

    Raises InputError for an impossible number of workers, if an executor takes no more tasks, and
    if a script calls this without ``if __name__ == "__main__":``.
    """
    leave_if_imported_again()
    count = worker_count(workers)
    of_dask = getattr(executor, "get_executor", None)
    given = executor if of_dask is None else of_dask(pure=False)
    if not isinstance(given, (Executor, type(None))):
        expected = "expected an Executor of concurrent.futures, or a Client of Dask"
        raise InputError(f"executor={shown(given)}: {expected}")
    todo, lost = deque(range(len(tasks))), list[int]()
    while todo:
        most = min(count, len(todo)) if given is None else IN_FLIGHT
        with Processes(most) if given is None else nullcontext(given) as pool:
            for index, result in _done(function, tasks, pool, todo, most, limit):
                if isinstance(result, _Lost):
                    lost.append(index)
                else:
                    yield index, result
    for alone in (deque([index]) for index in lost):
        while alone:
            with Processes(1) if given is None else nullcontext(given) as pool:
                yield from _done(function, tasks, pool, alone, 1, limit)


def worker_count(workers: int | None) -> int:
    """Return the number of workers: `workers`, or one for each core if it is None."""
    if workers is None:
        usable = hasattr(os, "sched_getaffinity")
        return min(len(os.sched_getaffinity(0)) if usable else os.cpu_count() or 1, MAX_WORKERS)
    if isinstance(workers, bool) or not isinstance(workers, int) or not 0 < workers <= MAX_WORKERS:
        expected = f"expected a whole number from 1 to {MAX_WORKERS}"
        raise InputError(f"workers={shown(workers)}: {expected}")
    return workers


def leave_if_imported_again() -> None:
    """End this process if it is a worker that is importing the script that started it.

    A new process imports the main script. If the script starts workers on import, they would start
    workers without end. `Processes` recognizes the exit, and explains the mistake.
    """
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        raise SystemExit(1)


def reason(error: BaseException) -> str:
    """Return an exception's type and message in one line."""
    return " ".join(described(error).split())


# -- in the process that has the tasks -------------------------------------------------------------


def _done(
    function: Callable[[T], R],
    tasks: Sequence[T],
    pool: Executor,
    todo: deque[int],
    most: int,
    limit: float | None,
) -> Iterator[tuple[int, R | Failure]]:
    """Take tasks from `todo`, `most` at once, until none is left or a process has ended."""
    own = isinstance(pool, Processes)
    late = "" if limit is None else f", perhaps in code in C at the time limit of {limit:g} s"
    running, done = dict[Future[Any], int](), SimpleQueue[Future[Any]]()
    try:
        while todo or running:
            try:
                while todo and len(running) < most:
                    future = _submitted(pool, function, tasks[todo[0]], limit)
                    running[future] = todo.popleft()
                    future.add_done_callback(done.put)
            except RuntimeError as error:  # it is broken, or shut down
                if not own:
                    raise _gone(error) from error
                if not running:
                    return
            future = _next(done)
            try:
                result = future.result()
            except (BrokenExecutor, CancelledError) as error:
                if not own:
                    raise _gone(error) from error
                result = _Lost(f"the process that ran it ended, twice{late}")
            except Exception as error:
                result = Failure(reason(error))
                if type(error).__name__ == "KilledWorker":  # Dask's, after several workers
                    result = _Lost("the process that ran it ended, on several workers in turn")
            yield running.pop(future), result
    finally:
        for future in running:
            future.cancel()


def _submitted(
    pool: Executor, function: Callable[[T], R], task: T, limit: float | None
) -> Future[Any]:
    """Submit a task, to processes as bytes, so that what can't be read does not end them."""
    if isinstance(pool, ThreadPoolExecutor):
        return pool.submit(_attempt, function, task)
    try:
        packed = cloudpickle.dumps((function, task))
    except Exception as error:
        unsent = Future[Any]()
        unsent.set_result(Failure(f"can't be sent to another process: {reason(error)}"))
        return unsent
    return pool.submit(_attempt_packed, packed, limit if isinstance(pool, Processes) else None)


def _next(done: SimpleQueue[Future[Any]]) -> Future[Any]:
    while True:
        with suppress(Empty):
            return done.get(timeout=LOOK)


def _gone(error: BaseException) -> InputError:
    return InputError(
        f"the executor takes no more tasks, or has lost them ({reason(error)}): without one, "
        "processes are started, and replaced where they end"
    )


class Processes(ProcessPoolExecutor):
    """Processes that are ended at the end of the block, whatever they do, and with their parent.

    They ignore Ctrl-C, which is their parent's business, from their first moment.
    """

    def __init__(self, count: int) -> None:
        with _as_workers_need_it():
            super().__init__(count, multiprocessing.get_context("spawn"), _begin)

    def __enter__(self) -> Processes:
        """Return the pool when its first process has begun. Raises InputError if it can't."""
        try:
            self.submit(os.getpid).result()
        except BrokenExecutor:
            raise InputError(
                "a worker process ended before it had begun: each imports the script that "
                "runs the study, which must be a file that can be imported: put what runs many "
                'runs under `if __name__ == "__main__":`'
            ) from None
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        for process in [*(self._processes or {}).values()]:  # public as kill_workers from 3.14 on
            process.kill()
        self.shutdown(cancel_futures=True)

    def submit(self, function: Callable[..., R], /, *arguments: Any) -> Future[R]:  # type: ignore[override]
        """Submit a call, for which a process may be started."""
        with _as_workers_need_it():
            return super().submit(function, *arguments)


@contextmanager
def _as_workers_need_it() -> Iterator[None]:
    """Set the environment that processes inherit which are started meanwhile.

    By default, numpy's linear algebra uses all cores in each worker, which makes them compete: at
    100 unknowns it is several times slower. Ctrl-C meanwhile is not lost, but late.
    """
    masks = hasattr(signal, "pthread_sigmask")
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT]) if masks else ()
    ours = {name: value for name, value in WORKERS.items() if name not in os.environ}
    os.environ.update(ours)
    try:
        yield
    finally:
        for name in ours:
            del os.environ[name]
        if masks:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


# -- in a worker -----------------------------------------------------------------------------------


def _attempt(function: Callable[[T], R], task: T) -> R | Failure:
    try:
        return function(task)
    except (Exception, SystemExit) as error:
        return Failure(reason(error))


def _attempt_packed(packed: bytes, limit: float | None) -> Any:
    """Attempt a function and a task; where it does not end at the limit, end this process."""

    def call(packed: bytes) -> Any:
        function, task = pickle.loads(packed)
        return function(task)

    with Path(os.devnull).open("w") as nothing:
        if limit is not None:
            faulthandler.dump_traceback_later(limit + BREAKING_OFF, exit=True, file=nothing)
        try:
            return _attempt(call, packed)
        finally:
            faulthandler.cancel_dump_traceback_later()
            sys.stdout.flush()


def _begin() -> None:
    """Begin a worker: it ignores Ctrl-C, and ends with its parent even in the middle of a task."""

    def end_with_parent() -> None:
        parent = multiprocessing.parent_process()
        if parent is not None:
            parent.join()
            os._exit(1)

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=end_with_parent, daemon=True).start()
