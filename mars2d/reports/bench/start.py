"""The time that a start takes, from shell to shell, in new processes."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from tempfile import TemporaryDirectory

__all__ = ["COMMANDS", "seconds", "with_bytecode"]

COMMANDS: dict[str, Sequence[str]] = {
    "import mars2d": ("-c", "import mars2d"),
    "mars2d run random_walk --headless": ("-m", "mars2d", "run", "random_walk", "--headless"),
}
"""The commands that are timed, as arguments of Python."""


@contextmanager
def with_bytecode() -> Iterator[dict[str, str]]:
    """Yield an environment in which modules are compiled once, as `pip install` compiles them.

    The compiled modules are kept in a temporary folder, not in the folders of packages.
    """
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
        yield environment | {"PYTHONPYCACHEPREFIX": folder}


def seconds(arguments: Sequence[str], environment: dict[str, str]) -> float:
    """Return the time that Python takes with these arguments, from its start to its end [s].

    Raises CalledProcessError if it fails.
    """
    start = time.perf_counter()
    subprocess.run(
        [sys.executable, *arguments],
        check=True, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
    )  # fmt: skip
    return time.perf_counter() - start
