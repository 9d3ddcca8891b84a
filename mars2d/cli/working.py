"""By whom many runs are done: the arguments that several verbs share."""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import ExitStack, contextmanager

from mars2d.core.errors import InputError
from mars2d.study.work import cluster, worker_count

__all__ = ["add_workers", "workers_of"]


def add_workers(parser: argparse.ArgumentParser) -> None:
    """Add on how many processes of this machine, or on which cluster, the runs are done."""
    parser.add_argument(
        "--workers", type=int, metavar="N", help="processes at a time; else one a core"
    )
    parser.add_argument(
        "--cluster", metavar="ADDRESS", help="of a Dask scheduler, as tcp://10.0.0.5:8786"
    )


@contextmanager
def workers_of(arguments: argparse.Namespace) -> Iterator[tuple[Executor | None, int | None]]:
    """Yield the executor and the number of workers that `add_workers` has asked for."""
    if arguments.workers is not None:
        worker_count(arguments.workers)
    if arguments.cluster is None:
        yield None, arguments.workers
        return
    if arguments.workers is not None:
        raise InputError(
            "--workers is of this machine: a cluster has its own; give it or --cluster"
        )
    with ExitStack() as stack:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", UserWarning)
            executor = stack.enter_context(cluster(arguments.cluster))
        for warning in caught:
            print(f"mars2d: {warning.message}", file=sys.stderr)
        yield executor, None
