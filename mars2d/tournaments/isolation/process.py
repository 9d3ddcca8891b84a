"""An isolated law as the match sees it: a process with a clock, asked by messages."""

from __future__ import annotations

import json
import multiprocessing
import os
import pickle
import re
import signal
import socket
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import chain
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Self, TypeVar

from mars2d.core.errors import InputError, Mars2dError, one_line
from mars2d.core.usercode import users_line
from mars2d.study import WORKERS
from mars2d.tournaments.isolation.child import CUT_OFF, serve
from mars2d.tournaments.isolation.limits import MB
from mars2d.tournaments.isolation.observation import Briefing, look
from mars2d.world.laws import LARGEST

if TYPE_CHECKING:
    from mars2d.world.simulation import Simulation

T = TypeVar("T")

KEPT_OUTPUT = 64_000
"""How many characters of a law's output are kept."""

GRACE = 0.5
"""How long a process may take to end, seconds."""

PATIENCE = 3
"""How many times its time a law may take by the clock on the wall, on a machine that is busy."""

FAULTS = ("start", "memory", "error", "command", "output")
"""The kinds of faults that a law's process reports itself."""

SIGNALS = {
    "SIGSEGV": ", a segmentation fault",
    "SIGKILL": ", perhaps for lack of memory",
    "SIGXCPU": ": it took too much processor time",
}
"""What signals that end a process mean."""

CRASH = "Fatal Python error"
"""How the traceback begins that Python prints when a signal ends it."""

_starting = threading.Lock()


class LawProcess:
    """A law in a process of its own, which ends with the block.

    fault: why it has failed, the kind of a verdict and a line of text, or None. printed: the
    beginning of its output, once it has ended.
    """

    def __init__(self, briefing: Briefing, output: Path) -> None:
        """Start the process; output: a new file for what it prints.

        Raises InputError if that fails.
        """
        self._briefing, self._limits = briefing, briefing.limits
        self._most = int(self._limits.output * MB)
        self._spent = 0.0  # seconds of its clock for the match
        self._output = output
        self.fault: tuple[str, str] | None = None
        self.printed = ""
        try:
            output.touch()
            self._channel, theirs = socket.socketpair()
            with theirs:
                self._process = _started(theirs, str(output))
        except OSError as error:
            raise InputError(f"can't start a process for a law: {error}") from error
        self._clock = _Clock(self._process.pid)

    def load(self) -> None:
        """Let it load its file."""
        with self._judged(self._limits.start, "not loaded"):
            self._ask(self._briefing)

    def command(self, world: Simulation) -> dict[int, tuple[float, ...]]:
        """Return its robots' commands of a control step, and send their messages; {} if it fails.

        The law's process checks both. So if they are invalid, the law has written to the match
        itself, which is a fault.
        """
        robots = self._briefing.robots
        seen = look(world, robots)
        commands: dict[int, tuple[float, ...]] = {}
        with self._judged(min(self._limits.tick, self._limits.match - self._spent), "no command"):
            answer = self._ask(seen)
            self._spent += self._clock.used
            if self.fault is None:
                commands = {i: tuple(c) for i, c in zip(robots, answer["commands"], strict=True)}
                # Such a test is false for NaN, too.
                if not all(
                    type(x) is float and abs(x) <= LARGEST for x in chain(*commands.values())
                ):
                    raise ValueError(commands)
                for sender, text, receivers in answer["letters"]:
                    if sender not in robots:
                        raise ValueError(sender)
                    world.channel.send(sender, json.loads(text), receivers)
        return commands

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """End the process, and all that it has started."""
        with suppress(OSError):
            if hasattr(os, "killpg"):
                os.killpg(self._process.pid or 0, signal.SIGKILL)
        self._process.kill()
        self._process.join(10 * GRACE)
        self.printed = self._all_printed().partition(CRASH)[0][:KEPT_OUTPUT]
        self._channel.close()
        with suppress(ValueError):  # it does not end
            self._process.close()

    # -- questions and answers -----------------------------------------------------------------

    def _ask(self, question: object) -> Any:
        """Send a message and return the answer; see `_judged` for what it raises."""
        rest = memoryview(pickle.dumps(question, 5))
        while rest:
            rest = rest[self._in_time(self._channel.send, rest) :]
        told = b""
        while not told.endswith(b"\n"):
            piece = self._in_time(self._channel.recv, 1 << 16)
            told += piece
            if not piece:
                raise ConnectionError
            if len(told) > 2 * self._most + KEPT_OUTPUT:
                raise ValueError("its answer is too long")
        answer = json.loads(told)
        if "kind" in answer:
            kind, where = FAULTS[FAULTS.index(answer["kind"])], answer["where"]
            self._fail(kind, str(answer["text"]), where and str(where)[:200])
        return answer

    def _in_time(self, transfer: Callable[[Any], T], what: object) -> T:
        while (left := self._clock.left) > 0:
            self._channel.settimeout(left)
            with suppress(TimeoutError):
                return transfer(what)
        raise TimeoutError

    @contextmanager
    def _judged(self, allowed: float, late: str) -> Iterator[None]:
        """Note the fault of a law that does not answer as it should within some seconds."""
        self._clock.start(allowed)
        try:
            yield
        except TimeoutError:
            with suppress(OSError):  # it has ended
                if self._process.exitcode is None and sys.platform != "win32":
                    os.kill(self._process.pid or 0, signal.SIGABRT)  # it then prints where it is
            self._process.join(GRACE)
            if allowed < min(self._limits.tick, self._limits.start):
                self._fail("clock", f"its commands took more than {self._limits.match:g} s in all")
            else:
                self._fail("slow", f"{late} after {allowed:g} s")
        except ConnectionError:
            self._gone()
        except (Mars2dError, ValueError, TypeError, KeyError, RecursionError):
            self._fail("exit", "what it says to the match is no answer")
        if self._output.stat().st_size >= self._most:
            self._fail("output", f"printed more than {self._most} bytes")

    # -- faults --------------------------------------------------------------------------------

    def _gone(self) -> None:
        """Note why the process has ended or closed its connection."""
        self._process.join(GRACE)
        code = self._process.exitcode
        kind, why = "exit", "has closed the connection to the match"
        if code is not None and code != CUT_OFF:
            why = f"has ended itself, with code {code}"
        if code is not None and code < 0:
            name = signal.Signals(-code).name
            kind = "clock" if name == "SIGXCPU" else kind
            why = f"was ended by the signal {name}{SIGNALS.get(name, '')}"
        self._fail(kind, f"its process {why}")

    def _crash_line(self) -> str | None:
        """Return the user's line in the traceback that Python prints on a crash."""
        _, _, text = self._all_printed().rpartition(CRASH)
        steps = re.findall(r'File "([^"]+)", line (\d+) in (\S+)', text.partition("\n\n")[2])
        stack = traceback.StackSummary.from_list(
            [(file, int(line), name, "") for file, line, name in reversed(steps)]
        )
        return users_line(stack)

    def _fail(self, kind: str, text: str, where: str = "") -> None:
        """Note the first fault; where: the user's line, by default that of a crash."""
        if self.fault is None:
            if kind == "memory":
                text += f"; it may take {self._limits.memory:g} MB"
            place = where or self._crash_line() or self._briefing.file.name
            self.fault = kind, one_line(f"{place}: {' '.join(text.split())}")

    def _all_printed(self) -> str:
        return self._output.read_bytes().decode(errors="replace")


def _started(channel: socket.socket, output: str) -> multiprocessing.process.BaseProcess:
    """Start a law's process: one thread, and sets in the same order in each run.

    It does not import the caller's script. On Linux it is forked within milliseconds, by a process
    that has imported everything. Processes of Dask are daemons, which may have no children
    otherwise.
    """
    ours = {**WORKERS, "PYTHONHASHSEED": "0"}
    context: Any = multiprocessing.get_context("forkserver" if sys.platform == "linux" else "spawn")
    with _starting:
        before, main = dict(os.environ), sys.modules["__main__"]
        try:
            os.environ.update(ours)
            sys.modules["__main__"] = ModuleType("__main__")
            multiprocessing.current_process().daemon = False
            context.set_forkserver_preload([serve.__module__])
            process: multiprocessing.process.BaseProcess = context.Process(
                target=serve, args=(channel, output), daemon=True
            )
            process.start()
        finally:
            sys.modules["__main__"] = main
            for name in ours:
                del os.environ[name]
            os.environ.update(before)
    return process


class _Clock:
    """Counts the time of a law's answer, without the time that either side waits for a processor.

    So a machine that is busy makes no law slow. Where the system does not say how long a process
    has waited, all time counts.
    """

    def __init__(self, process: int | None) -> None:
        """Take the law's process."""
        self._files = [Path(f"/proc/{each}/schedstat") for each in (process, "thread-self")]

    def start(self, allowed: float) -> None:
        """Begin to count, up to the time that is allowed, seconds."""
        self._allowed = allowed
        self._since, self._waited = time.perf_counter(), self._waits()

    @property
    def used(self) -> float:
        """The time that has passed and counts, seconds."""
        return max(0.0, time.perf_counter() - self._since - self._waits() + self._waited)

    @property
    def left(self) -> float:
        """The time that is left, seconds; it ends in any case after `PATIENCE` times as much."""
        passed = time.perf_counter() - self._since
        if passed < self._allowed:
            return self._allowed - passed
        return min(self._allowed - self.used, PATIENCE * self._allowed - passed)

    def _waits(self) -> float:
        try:
            return sum(1e-9 * int(file.read_bytes().split()[1]) for file in self._files)
        except OSError:  # not on Linux, or it has ended
            return 0.0
