"""Clusters: many machines that share the tasks, connected by Dask."""

from __future__ import annotations

import asyncio
import logging
import warnings
from collections import Counter
from collections.abc import Iterator, Mapping
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any

from mars2d.core.errors import InputError
from mars2d.core.extras import extra
from mars2d.core.terminal import warn
from mars2d.study.workers import reason

ANSWER_TIMEOUT = 5.0
"""How long a scheduler may take to answer, seconds."""

SAME_VERSION = ("mars2d", "pymunk", "numpy")
"""The packages that must have the same version everywhere, so that runs give the same results."""

SOON, ABSENCE = 5.0, 60.0
"""How long a study waits without any worker before it says so, and before it ends, seconds."""

LOGGERS = ("distributed", "distributed.client", "tornado.application")


@contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """Connect to a Dask cluster by the address of its scheduler, such as ``tcp://10.0.0.5:8786``.

    Yield an executor for `each_done`. Tasks that still run when this ends are forgotten. Raises
    MissingExtraError without Dask, and InputError if no scheduler answers within `ANSWER_TIMEOUT`,
    or if a worker has another version of Python or of a package in `SAME_VERSION`. Warns if there
    is no worker yet: tasks wait for one.
    """
    with extra("cluster", f"{address}: a cluster needs Dask"):
        from distributed import Client
    with _without_log():
        _check_scheduler(address)
        client = Client(address, timeout=ANSWER_TIMEOUT, set_as_default=False)
        try:
            _check_workers(address, client.get_versions(packages=SAME_VERSION))
            executor = client.get_executor(pure=False)
            executor.waiting = _Attendance(address, client)
            yield executor
        finally:
            client.close(timeout=ANSWER_TIMEOUT)


class DesertedError(InputError):
    """All workers have ended. ended: with which tasks, by their keys, and how many with each."""

    def __init__(self, message: str, ended: Mapping[str, int]) -> None:
        super().__init__(message)
        self.ended = ended


class _Attendance:
    """Looks whether workers are left, while a study waits for its runs."""

    def __init__(self, address: str, client: Any) -> None:
        self._address, self._client = address, client
        self._had, self._alone = bool(client.nthreads()), 0.0

    def __call__(self, seconds: float) -> None:
        """Note that nothing came for some seconds.

        Says when no worker is left, and raises DesertedError when none comes in `ABSENCE`.
        """
        if self._client.nthreads():
            self._had, self._alone = True, 0.0
            return
        before, self._alone = self._alone, self._alone + seconds
        if self._had and before < SOON <= self._alone:
            warn(f"{self._address}: all workers have ended: waits {ABSENCE:g} s for others")
        if self._had and self._alone > ABSENCE:
            raise DesertedError(
                f"{self._address}: all workers have ended, and none has come in {ABSENCE:g} s; a "
                "run that crashes takes its worker along, and a nanny, as workers have by default, "
                "starts another one. Start workers: the same command goes on",
                self._blamed(),
            )

    def _blamed(self) -> dict[str, int]:
        """Return the waiting tasks with which most workers have ended, and with how many."""
        waiting = [key for key, state in self._client.futures.items() if state.status == "pending"]
        ends: Counter[str] = Counter()
        for _, key, before, after, *_ in self._client.story(*waiting):
            ends[key] += (before, after) == ("processing", "released")
        most = max(ends.values(), default=0)
        return {key: count for key, count in ends.items() if count == most > 0}


def _check_scheduler(address: str) -> None:
    """Raise InputError unless a scheduler answers."""
    with ThreadPoolExecutor(1) as thread:  # a notebook has an event loop in this one
        try:
            kind = thread.submit(asyncio.run, _kind(address)).result()
        except Exception as error:
            raise InputError(
                f"{address}: no Dask scheduler answers there ({reason(error)}): expected its "
                "address, as tcp://10.0.0.5:8786, which `dask scheduler` prints"
            ) from error
    if kind != "Scheduler":
        raise InputError(f"{address}: a Dask {kind.lower()}; expected the address of its scheduler")


async def _kind(address: str) -> str:
    """Return the kind of process that answers at an address: Scheduler, Worker or Nanny."""
    from distributed import Security
    from distributed.core import rpc

    arguments = Security().get_connection_args("client")
    async with rpc(address, connection_args=arguments, timeout=ANSWER_TIMEOUT) as there:
        identity = await asyncio.wait_for(there.identity(), ANSWER_TIMEOUT)
    return str(identity["type"])


def _check_workers(address: str, versions: dict[str, Any]) -> None:
    """Raise InputError if a worker differs from this process; warn if there is no worker."""
    here = _compared(versions["client"])
    for worker, found in versions["workers"].items():
        for name, there in _compared(found).items():
            if there != here[name]:
                raise InputError(
                    f"{worker}, a worker of {address}: {name} {there or 'is not installed'}; "
                    f"expected {here[name]}, as here: runs would not come to the same"
                )
    if not versions["workers"]:
        warnings.warn(f"{address}: no worker yet: runs wait until there is one", stacklevel=4)


def _compared(versions: dict[str, Any]) -> dict[str, str | None]:
    packages = versions["packages"]
    python = ".".join(str(packages["python"]).split(".")[:2])
    return {"Python": python} | {name: packages[name] for name in SAME_VERSION}


@contextmanager
def _without_log() -> Iterator[None]:
    """Keep Dask's log off the terminal: errors that matter are raised."""
    loggers = [logging.getLogger(name) for name in LOGGERS]
    before = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for logger, level in zip(loggers, before, strict=True):
            logger.setLevel(level)
