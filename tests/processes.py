"""Other processes in tests: command lines, an X server, waiting for what they do."""

from __future__ import annotations

import functools
import http.server
import os
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any

import pytest

PATIENCE = 120.0
"""Seconds after which a test that waits fails. It only bounds hangs: machines may be busy."""

HIDDEN = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER", "SDL_VIDEO_DRIVER")


def wait_until(condition: Callable[[], Any], process: Any = None) -> Any:
    """Wait until a condition holds, and return its value.

    process: fail at once if this one ends before.
    """
    end = time.monotonic() + PATIENCE
    while not (value := condition()):
        if process is not None and process.poll() is not None and not condition():
            pytest.fail(f"the process has ended: {process.communicate()}")
        assert time.monotonic() < end, f"it did not happen within {PATIENCE:g} s"
        time.sleep(0.01)
    return value


def running(pid: int) -> bool:
    """Return whether a process goes on; one that has ended may still be asked how."""
    try:
        os.kill(pid, 0)
        if sys.platform == "linux":
            return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
    return True


def bare_environment(**more: str) -> dict[str, str]:
    """Return this environment without a display."""
    return {key: value for key, value in os.environ.items() if key not in HIDDEN} | more


class _Pages(http.server.SimpleHTTPRequestHandler):
    """Serves files, modules of JavaScript too, and prints nothing."""

    extensions_map = {
        **http.server.SimpleHTTPRequestHandler.extensions_map,
        ".mjs": "text/javascript",
    }

    def log_message(self, *_: Any) -> None:
        pass


@contextmanager
def served(folder: Path) -> Iterator[str]:
    """Serve a folder to this machine; yield the address, which ends with a slash."""
    handler = functools.partial(_Pages, directory=str(folder))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()


@contextmanager
def started(command: list[str], **options: Any) -> Iterator[subprocess.Popen[str]]:
    """Start a process; kill it at the end if it still runs, or after PATIENCE.

    So a test that reads its output never waits for ever.
    """
    process = subprocess.Popen(command, text=True, **options)
    bound = threading.Timer(PATIENCE, process.kill)
    bound.start()
    try:
        yield process
        process.wait(PATIENCE)
    finally:
        bound.cancel()
        process.kill()
        with process:  # closes its pipes
            pass


def begun(*arguments: object, **options: Any) -> AbstractContextManager[subprocess.Popen[str]]:
    """Start a command line of MARS2D as `started` does, by Python with an option before -m."""
    command = [sys.executable, "-P", "-m", "mars2d", *map(str, arguments)]
    return started(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)


def mars(
    *arguments: object, cwd: Path | None = None, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run a command line of MARS2D without a display, in a process of its own, to its end."""
    with begun(*arguments, cwd=cwd, env=bare_environment(**environment)) as process:
        out, errors = process.communicate()
    return subprocess.CompletedProcess(process.args, process.returncode, out, errors)


@contextmanager
def x_server(
    width: int = 1000, height: int = 700, *, repeats: bool = False
) -> Iterator[tuple[str, subprocess.Popen[bytes]]]:
    """Start an X server on a free display; yield the display's name and the server's process.

    repeats: repeat the keys that are held. Else a key counts once, however late it is released.
    """
    if shutil.which("Xvfb") is None:
        pytest.skip("needs an X server: apt-get install xvfb")
    read, write = os.pipe()
    options = ["-screen", "0", f"{width}x{height}x24", "-noreset", *([] if repeats else ["-r"])]
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), *options],
        pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    os.close(write)
    try:
        with os.fdopen(read) as pipe:
            number = pipe.readline().strip()
        assert number, "Xvfb did not start"
        yield f":{number}", server
    finally:
        server.terminate()
        server.wait(PATIENCE)
