"""An isolated law as the match sees it: a process with a clock, asked by frames."""

from __future__ import annotations

import contextlib
import json
import os
import pickle
import re
import signal
import socket
import struct
import time
import traceback
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from mars2d.core.errors import Mars2dError
from mars2d.core.usercode import users_line
from mars2d.study.isolation.fork_server import start
from mars2d.study.isolation.host import CUT_OFF
from mars2d.study.isolation.limits import MB
from mars2d.study.isolation.observation import Briefing, Observer
from mars2d.study.isolation.protocol import (
    ANSWER,
    BRIEFING,
    COMMANDS,
    FAULT,
    HEAD,
    LINE,
    READY,
    WANTED,
    Reader,
    framed,
)
from mars2d.study.isolation.scale import Scale
from mars2d.world.laws import LARGEST

if TYPE_CHECKING:
    from mars2d.world.simulation import Simulation

KEPT_OUTPUT = 64_000
"""How many bytes of a law's output are kept from the beginning, and as many from the end."""

GRACE = 0.5
"""How long a process that has closed its connection may take to end by itself, seconds."""

PIECE = 1 << 16
"""How many bytes are read at once, at most."""

REPORTED_KINDS = ("start", "memory", "error", "command", "output")
"""The kinds of faults that a law's process reports itself."""

NO_ANSWER = "what it says to the match is no answer"


class Fault(NamedTuple):
    """The reason why a law has failed: the kind of a verdict, and a line of text."""

    kind: str
    text: str


class LawProcess:
    """A law in a process of its own.

    fault: why it has failed, or None. asked: whether its answer is awaited. channel, output: the
    sockets to poll; call `receive` and `drain` when they can be read.
    """

    def __init__(self, briefing: Briefing, robots: int, props: int) -> None:
        """Start the process. robots, props: the numbers of all of them."""
        self._briefing, self._limits = briefing, briefing.limits
        self._file = briefing.file.name
        self._observer = Observer(briefing, robots, props)
        self._most = int(self._limits.output * MB)
        self._frames = Reader(2 * self._most + PIECE)
        self._numbers = struct.Struct(f"<{2 * len(briefing.robots)}d")
        self._answer_struct = struct.Struct(
            HEAD.format + (ANSWER.format + self._numbers.format).replace("<", "")
        )
        self.fault: Fault | None = None
        self.asked, self._since, self._allowed = False, 0.0, 0.0
        self._used = 0.0  # seconds on its clock
        self._late = ""  # its current line, once it is late
        self._world: Simulation | None = None
        self._iteration = -1
        self._commands: Sequence[float] = ()
        self._places = {robot: 2 * k for k, robot in enumerate(briefing.robots)}
        self._letters: list[Any] = []
        self._printed, self._first, self._last = 0, b"", b""
        self.channel, theirs = socket.socketpair()
        self.channel.setblocking(False)
        self.output, their_output = socket.socketpair()
        self.output.setblocking(False)
        self._process, self._end = start((theirs, their_output))
        self._scale = Scale(self._process, self._limits.memory * MB)
        self._ended = False

    # -- questions and answers -----------------------------------------------------------------

    def brief(self) -> None:
        """Send its briefing; it answers when it has loaded its file."""
        self._ask(framed(BRIEFING, pickle.dumps(self._briefing)), self._limits.start)

    def look(self, world: Simulation) -> bytes | memoryview:
        """Return the frame of a control step, for `tell`."""
        self._world, self._iteration = world, world.iteration
        return self._observer.frame(world)

    def tell(self, frame: bytes | memoryview) -> None:
        """Ask it for the commands of a control step."""
        self._ask(frame, min(self._limits.tick, self._limits.match - self._used))

    def _ask(self, frame: bytes | memoryview, allowed: float) -> None:
        self.asked, self._allowed = True, allowed
        self._since = time.perf_counter()
        self._send(frame)

    def _send(self, frame: bytes | memoryview) -> None:
        sent = 0
        with contextlib.suppress(OSError):  # a process that is gone, or does not read
            sent = self.channel.send(frame)
        if sent < len(frame):
            self.channel.settimeout(self._allowed)
            with contextlib.suppress(OSError):  # there will be no answer
                self.channel.sendall(memoryview(frame)[sent:])
            self.channel.setblocking(False)

    @property
    def deadline(self) -> float:
        """The time by which it must answer, as `time.perf_counter` counts."""
        return self._since + self._allowed

    def receive(self) -> bool:
        """Read from its channel; return whether more may follow.

        `asked` becomes False with the answer, or if there will be none.
        """
        try:
            piece = self.channel.recv(1 << 12)
        except BlockingIOError:
            return True
        except OSError:
            piece = b""
        if not piece:
            self._gone()
            return False
        try:
            if len(piece) == self._answer_struct.size and self._is_plain_answer(piece):
                return True
            for kind, body in self._frames.read(piece):
                self._take(kind, body)
        except (ValueError, TypeError, KeyError, struct.error, RecursionError):
            self._fail("exit", "", NO_ANSWER)
        return self.fault is None

    def _is_plain_answer(self, piece: bytes) -> bool:
        """Process the most frequent answer, one frame of commands without messages, quickly."""
        length, kind, iteration, *numbers = self._answer_struct.unpack(piece)
        whole = length == len(piece) - HEAD.size and self._frames.empty
        if not (whole and kind == COMMANDS and self.asked and iteration == self._iteration):
            return False
        self._answered(numbers, [])
        return True

    def _take(self, kind: bytes, body: bytes) -> None:
        """Process a frame. Raises ValueError or the like for an invalid one."""
        if kind == LINE:
            self._late = _one_line(json.loads(body), 200)
        elif kind == FAULT:
            told = json.loads(body)
            if told["kind"] not in REPORTED_KINDS:
                raise ValueError(told["kind"])
            where = None if told["where"] is None else _one_line(told["where"], 200)
            self._fail(told["kind"], where, _one_line(told["text"], 2000))
        elif kind == READY and self._iteration < 0:
            self.asked = False
        elif kind == COMMANDS and self.asked:
            self._take_commands(body)
        elif kind == WANTED and self.asked and self._world and not self._observer.velocities:
            self._observer.velocities = True
            self._send(self._observer.again(self._world))
        else:
            raise ValueError(kind)

    def _take_commands(self, body: bytes) -> None:
        (iteration,) = ANSWER.unpack_from(body)
        if iteration != self._iteration:
            raise ValueError(iteration)
        numbers = self._numbers.unpack_from(body, ANSWER.size)
        rest = body[ANSWER.size + self._numbers.size :]
        self._answered(numbers, json.loads(rest) if rest else [])

    def _answered(self, numbers: Sequence[float], letters: list[Any]) -> None:
        if not all(-LARGEST <= number <= LARGEST for number in numbers):  # false for NaN
            raise ValueError(numbers)
        self._commands, self._letters = numbers, letters
        self.asked, self._late = False, ""
        self._used += time.perf_counter() - self._since
        if self._used > self._limits.match:
            self._too_long()

    def command(self, world: Simulation, robot: int) -> tuple[float, float]:
        """Return the command of one of its robots, after sending that robot's messages.

        Invalid messages are a fault: the law's process checks messages, so the law must have
        written to the channel itself.
        """
        try:
            for sender, text, receivers in self._letters:
                if sender == robot:
                    world.channel.send(robot, json.loads(text), receivers)
        except (Mars2dError, ValueError, TypeError, RecursionError):
            self._fail("exit", "", NO_ANSWER)
        place = self._places[robot]
        return self._commands[place], self._commands[place + 1]

    # -- faults --------------------------------------------------------------------------------

    def expire(self) -> None:
        """Note that its time is over, with its line if it can still report that."""
        with contextlib.suppress(OSError, ValueError):
            self._hear_line(time.perf_counter() + GRACE)
        if self._iteration < 0:
            self._fail("start", self._late, f"not loaded after {self._limits.start:g} s")
        elif self._allowed < self._limits.tick:
            self._too_long()
        else:
            self._fail("slow", self._late, f"no command after {self._limits.tick:g} s")

    def weigh(self) -> None:
        """End the process if it takes more memory than it may, and note the line where it was."""
        if self.fault is not None or not self._scale.heavy:
            return
        with contextlib.suppress(OSError):  # it has ended by itself
            os.kill(self._process, signal.SIGABRT)  # upon which it prints its traceback
        self._finish(GRACE)
        self._fail("memory", self._crash_line(), "took too much memory")

    def _hear_line(self, until: float) -> None:
        while not self._late and (left := until - time.perf_counter()) > 0:
            self.channel.settimeout(left)
            frames = [*self._frames.read(self.channel.recv(PIECE))]
            for kind, body in frames:
                if kind == LINE:
                    self._take(kind, body)
            if any(kind != LINE for kind, _ in frames) or not frames:
                return

    def _too_long(self) -> None:
        text = f"its commands took more than {self._limits.match:g} s in all"
        self._fail("clock", self._late, text)

    def _fail(self, kind: str, where: str | None, text: str) -> None:
        """Note the first fault, and stop waiting for an answer."""
        self.asked = False
        if self.fault is None:
            if kind == "memory":
                text += f"; it may take {self._limits.memory:g} MB"
            self.fault = Fault(kind, f"{where or self._file}: {text}")

    def _gone(self) -> None:
        """Note why the process has ended or closed its connection."""
        if self.fault is not None:
            return
        code, forced = self._finish(GRACE)
        if forced or code == CUT_OFF:
            self._fail("exit", None, "its process has closed the connection to the match")
        elif code >= 0:
            self._fail("exit", None, f"its process has ended itself, with code {code}")
        else:
            name = signal.Signals(-code).name
            words = {"SIGSEGV": ", a segmentation fault", "SIGKILL": ", perhaps for lack of memory"}
            text = f"its process was ended by the signal {name}{words.get(name, '')}"
            self._fail("exit", self._crash_line(), text)

    def _crash_line(self) -> str | None:
        """Return the user's line in the traceback that Python prints on a crash."""
        text = self._last.decode(errors="replace").rpartition("Fatal Python error")[2]
        steps = re.findall(r'File "([^"]+)", line (\d+) in (\S+)', text.partition("\n\n")[2])
        stack = traceback.StackSummary.from_list(
            [(file, int(line), name, "") for file, line, name in reversed(steps)]
        )
        return users_line(stack)

    # -- output and end ------------------------------------------------------------------------

    def drain(self) -> bool:
        """Read its output; return whether more may follow."""
        try:
            piece = self.output.recv(PIECE)
        except OSError:
            return False
        self._printed += len(piece)
        if len(self._first) < KEPT_OUTPUT:
            self._first += piece[: KEPT_OUTPUT - len(self._first)]
        self._last = (self._last + piece)[-KEPT_OUTPUT:]
        if self._printed > self._most + PIECE:
            self._fail("output", self._late, f"printed more than {self._most} bytes")
        return bool(piece)

    @property
    def printed(self) -> str:
        """The beginning of its output."""
        return self._first.decode(errors="replace")

    def _finish(self, grace: float) -> tuple[int, bool]:
        self._ended = True
        ended = self._end(grace)
        self._used_up()
        return ended

    def _used_up(self) -> None:
        """Read the rest of its output, up to the limit."""
        for _ in range(self._most // PIECE + 8):
            if not self.drain():
                return

    def end(self) -> None:
        """End the process and close its sockets."""
        try:
            if not self._ended:
                self._finish(0.0)
        finally:
            self.channel.close()
            self.output.close()


def _one_line(told: object, longest: int) -> str:
    return " ".join(str(told)[:longest].split())
