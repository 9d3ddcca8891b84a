"""What the tests share: a Python in a child process, a browser, settings that never flicker."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

from tests.browser import running_browser

settings.register_profile(
    "stable",
    deadline=None,
    derandomize=True,
    database=None,
    max_examples=50,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("stable")


def pytest_xdist_auto_num_workers() -> int:
    """Return how many processes ``-n auto`` is: one more than processors, since windows wait."""
    return (os.cpu_count() or 1) + 1


@pytest.hookimpl(tryfirst=True)
def pytest_cmdline_main(config: pytest.Config) -> None:
    """Let a process that has nothing left to do take tests from others, if none says otherwise.

    Each begins with neighbours, which share what a module or the session has set up.
    """
    if config.getoption("numprocesses", None) and config.getoption("dist") == "no":
        config.option.dist = "worksteal"


Child = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def child() -> Child:
    """Run code in a Python process of its own: what aborts it is seen, what hangs is ended.

    It imports what is installed, not what lies in the folder (-P).
    """

    def run(
        code: str, *flags: str, timeout: float = 60, **environment: str
    ) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-P", *flags, "-c", code],
            capture_output=True,
            text=True,
            timeout=timeout,
            check=False,
            env=os.environ | environment,
        )

    return run


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """Chromium, started once for all tests that need it: a process can drive only one."""
    with running_browser() as browser:
        yield browser
