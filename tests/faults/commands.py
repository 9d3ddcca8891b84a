"""Commands of ``mars2d`` that something happens to: as processes of their own, or forked.

A fork of a process that has imported everything begins at once, so many cost little.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
import uuid
from pathlib import Path
from typing import NamedTuple

MARK = "MARS2D_TEST_MARK"
"""What is in the environment of a command, and so in that of all that it starts."""

FORKING = """
import json, os, signal, sys, time
import mars2d.cli.command_line, mars2d.core.interrupt
import matplotlib.backends.backend_agg, pygame, mars2d.output.formats.mcap
import mars2d.output.formats.table, mars2d.output.pages.replay
import mars2d.study.tournament.tournament, mars2d.study.run, mars2d.output.films.film, av
for line in sys.stdin:
    told = json.loads(line)
    if "wait" in told:
        until = time.monotonic() + told["seconds"]
        while (ended := os.waitpid(told["wait"], os.WNOHANG))[0] == 0:
            if time.monotonic() > until:
                os.kill(told["wait"], signal.SIGKILL)
                ended = os.waitpid(told["wait"], 0)
                break
            time.sleep(0.005)
        print(os.waitstatus_to_exitcode(ended[1]), flush=True)
        continue
    pid = os.fork()
    if pid == 0:
        os.setsid()
        os.environ.update(told["environment"])
        os.chdir(told["folder"])
        for number, name in ((1, "out"), (2, "err")):
            os.dup2(os.open(told[name], os.O_WRONLY | os.O_CREAT | os.O_TRUNC), number)
        signal.signal(signal.SIGINT, mars2d.core.interrupt.leave)  # as in a process of its own
        sys.argv = ["-c"]
        sys.exit(mars2d.cli.command_line.main(told["argv"]))
    print(pid, flush=True)
"""


class Ended(NamedTuple):
    """How a command has ended: its exit code, and what it printed."""

    code: int
    out: str
    err: str


class Command:
    """A command that goes on; `end` waits for its end."""

    def __init__(self, pid: int, mark: str, files: tuple[Path, Path]) -> None:
        self.pid, self._mark, self._files = pid, mark, files
        self.wait = lambda seconds: -999

    def interrupt(self, times: int = 1) -> None:
        """Press Ctrl-C in its terminal, so that all of its group get it."""
        for _ in range(times):
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(self.pid, signal.SIGINT)
            time.sleep(0.01)

    def kill(self) -> None:
        """End it as `kill -9` does."""
        with contextlib.suppress(ProcessLookupError):
            os.kill(self.pid, signal.SIGKILL)

    def end(self, seconds: float = 120) -> Ended:
        """Return how it has ended; one that does not is killed."""
        code = self.wait(seconds)
        out, err = (path.read_text(errors="replace") for path in self._files)
        return Ended(code, out, err)

    def left(self, patience: float = 30.0) -> list[str]:
        """Return the processes that it has started and that have outlived it."""
        until = time.monotonic() + patience
        while (found := _marked(self._mark)) and time.monotonic() < until:
            time.sleep(0.05)
        return found


def _marked(mark: str) -> list[str]:
    found = []
    for place in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            if f"{MARK}={mark}".encode() in (place / "environ").read_bytes():
                found.append((place / "cmdline").read_bytes().replace(b"\0", b" ").decode())
    return found


def started(folder: Path, *argv: str, **environment: str) -> Command:
    """Start ``mars2d`` in a folder, in a session of its own."""
    mark = uuid.uuid4().hex
    files = _files(folder, mark)
    with files[0].open("w") as out, files[1].open("w") as err:
        process = subprocess.Popen(
            [sys.executable, "-m", "mars2d", *argv],
            cwd=folder, stdout=out, stderr=err, stdin=subprocess.DEVNULL, start_new_session=True,
            env=os.environ | environment | {MARK: mark, "DISPLAY": ""},
        )  # fmt: skip
    command = Command(process.pid, mark, files)

    def wait(seconds: float) -> int:
        try:
            return process.wait(seconds)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            return -999

    command.wait = wait
    return command


def _files(folder: Path, mark: str) -> tuple[Path, Path]:
    place = folder.parent
    return place / f"{mark}.out", place / f"{mark}.err"


class Forking:
    """A process that has imported everything, and is forked for each command."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-c", FORKING],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
            env=os.environ | {"DISPLAY": ""},
        )  # fmt: skip

    def _ask(self, **told: object) -> int:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps(told) + "\n")
        self._process.stdin.flush()
        return int(self._process.stdout.readline())

    def started(self, folder: Path, *argv: str, **environment: str) -> Command:
        """Start a command of ``mars2d`` in a folder, in a session of its own."""
        mark = uuid.uuid4().hex
        out, err = _files(folder, mark)
        pid = self._ask(
            argv=argv, folder=str(folder), out=str(out), err=str(err),
            environment=environment | {MARK: mark},
        )  # fmt: skip
        command = Command(pid, mark, (out, err))
        command.wait = lambda seconds: self._ask(wait=pid, seconds=seconds)
        return command

    def close(self) -> None:
        """End the process."""
        self._process.communicate()
