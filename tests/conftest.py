"""Fixtures and settings that all tests share."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

from mars2d.cli.command_line import main
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

SLOW_FIXTURES = {"browser", "screen", "display"}
"""Fixtures whose tests are marked `slow`: they start Chromium or an X server, or draw a window."""


def pytest_configure() -> None:
    """Handle signals as in a terminal, even where a job runner or `nohup` has them ignored.

    Child processes inherit ignored signals, but never a handler: with one, they start with the
    default. SIGHUP keeps having no effect on the tests themselves.
    """
    os.environ["MARS2D_MEMORY"] = ""  # windows look the same each time
    signal.signal(signal.SIGINT, signal.default_int_handler)
    if hasattr(signal, "SIGHUP"):
        if signal.getsignal(signal.SIGHUP) == signal.SIG_IGN:
            signal.signal(signal.SIGHUP, lambda *_: None)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT, signal.SIGHUP, signal.SIGTERM})


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the tests of slow fixtures."""
    for item in items:
        if SLOW_FIXTURES.intersection(getattr(item, "fixturenames", ())):
            item.add_marker("slow")


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
    """Run code in a Python process of its own, which may abort; one that hangs is killed.

    It imports the installed package, not what lies in the folder (-P).
    """

    def run(
        code: str, *flags: str, timeout: float = 120, **environment: str
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


@pytest.fixture
def typed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., tuple[int, str, str]]:
    """Return a function that runs a command in an empty folder: exit code, stdout, stderr."""
    monkeypatch.chdir(tmp_path)
    return lambda *words: (main([*map(str, words)]), *capsys.readouterr())


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """Chromium, started once for all tests that need it: a process can drive only one."""
    with running_browser() as browser:
        yield browser
