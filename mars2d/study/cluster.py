"""Clusters: many machines that share the tasks, connected by Dask."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any

from mars2d.core.errors import InputError
from mars2d.core.extras import extra
from mars2d.core.terminal import warn
from mars2d.study.work import reason

ANSWER_TIMEOUT = 5.0
"""How long a scheduler may take to answer, seconds."""

SAME_VERSION = ("mars2d", "pymunk", "numpy")
"""The packages that must have the same version everywhere, so that runs give the same results."""


@contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """Connect to a Dask cluster by the address of its scheduler, such as ``tcp://10.0.0.5:8786``.

    Yield an executor for `each_done`. Tasks that still run when this ends are forgotten. Raises
    MissingExtraError without Dask, and InputError if no scheduler answers within `ANSWER_TIMEOUT`,
    or if a worker has another version of Python or of a package in `SAME_VERSION`. A line on stderr
    says if there is no worker yet: tasks wait for one.
    """
    with extra("cluster", f"{address}: a cluster needs Dask"):
        from distributed import Client
    try:
        with ThreadPoolExecutor(1) as thread:  # a notebook has an event loop in this one
            kind = thread.submit(asyncio.run, _kind(address)).result()
    except Exception as error:
        raise InputError(
            f"{address}: no Dask scheduler answers there ({reason(error)}): expected its "
            "address, as tcp://10.0.0.5:8786, which `dask scheduler` prints"
        ) from error
    if kind != "Scheduler":
        raise InputError(f"{address}: a Dask {kind.lower()}; expected the address of its scheduler")
    with _without_log(), Client(address, timeout=ANSWER_TIMEOUT, set_as_default=False) as client:
        versions = client.get_versions(packages=SAME_VERSION)
        here = _compared(versions["client"])
        for worker, found in versions["workers"].items():
            for name, there in _compared(found).items():
                if there != here[name]:
                    raise InputError(
                        f"{worker}, a worker of {address}: {name} {there or 'is not installed'}; "
                        f"expected {here[name]}, as here: runs would not come to the same"
                    )
        if not versions["workers"]:
            warn(f"{address}: no worker yet: runs wait until there is one")
        yield client.get_executor(pure=False)


@contextmanager
def _without_log() -> Iterator[None]:
    """Keep Dask's log off the terminal: errors that matter are raised."""
    names = "distributed", "distributed.client", "tornado.application"
    before = {logger: logger.level for logger in map(logging.getLogger, names)}
    for logger in before:
        logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for logger, level in before.items():
            logger.setLevel(level)


async def _kind(address: str) -> str:
    """Return the kind of process that answers at an address: Scheduler, Worker or Nanny."""
    from distributed import Security
    from distributed.core import rpc

    arguments = Security().get_connection_args("client")
    async with rpc(address, connection_args=arguments, timeout=ANSWER_TIMEOUT) as there:
        return str((await asyncio.wait_for(there.identity(), ANSWER_TIMEOUT))["type"])


def _compared(versions: dict[str, Any]) -> dict[str, str | None]:
    packages = versions["packages"]
    python = packages["python"].rsplit(".", 3)[0]  # of 3.11.7.final.0
    return {"Python": python} | {name: packages[name] for name in SAME_VERSION}
