"""The process in which an isolated law runs: it receives observations and sends commands."""

from __future__ import annotations

import contextlib
import faulthandler
import io
import json
import os
import pickle
import random
import socket
import struct
import sys
import threading
import time
import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from mars2d.core.errors import Mars2dError
from mars2d.core.hints import described
from mars2d.core.usercode import stack_of, users_line
from mars2d.scenario.code_file import law_in
from mars2d.study.isolation.limits import MB
from mars2d.study.isolation.mirror_world import MirrorWorld
from mars2d.study.isolation.observation import Briefing
from mars2d.study.isolation.protocol import (
    ANSWER,
    COMMANDS,
    FAULT,
    LINE,
    READY,
    WANTED,
    Reader,
    framed,
)
from mars2d.world.laws import Law, robot_command

CUT_OFF = 70
"""The exit code of a process whose law has closed the connection to the match."""

LATE_SHARE = 0.6
"""After this share of its time, a law is late, and its current line is sent."""


def main(channel: socket.socket, output: socket.socket) -> NoReturn:
    """Serve one match and end the process.

    channel: the connection to the match. output: receives everything that is printed.
    """
    code = CUT_OFF
    try:
        _redirect(output)
        Host(channel).serve()
        code = 0
    except BaseException:
        traceback.print_exc()
    finally:
        os._exit(code)  # despite threads, handlers and exit functions that the law left behind


def _redirect(output: socket.socket) -> None:
    """Make the standard input empty, and send everything that is printed to the match."""
    with Path(os.devnull).open("rb") as nothing:
        os.dup2(nothing.fileno(), 0)
    for descriptor in (1, 2):
        os.dup2(output.fileno(), descriptor)
    output.close()
    sys.stdin = Path(os.devnull).open(encoding="utf-8")  # noqa: SIM115 - for as long as it runs
    faulthandler.enable(2)  # its traceback says where a law was when its memory ran out
    if sys.platform != "win32":
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


class _Printed(io.TextIOWrapper):
    """A standard stream that counts its bytes, so that the limit always falls on the same print."""

    total, limit = 0, 0
    """Bytes, of all streams together."""

    def __init__(self, descriptor: int, host: Host) -> None:
        raw = io.FileIO(descriptor, "w", closefd=False)
        super().__init__(io.BufferedWriter(raw), "utf-8", "backslashreplace")
        self._host = host

    def write(self, text: str) -> int:
        _Printed.total += len(text.encode("utf-8", "backslashreplace"))
        if _Printed.total > _Printed.limit:
            stack = traceback.extract_stack()
            self._host.fail(
                "output", users_line(stack), f"printed more than {_Printed.limit} bytes"
            )
            threading.Event().wait()  # until the match ends this process
        written = super().write(text)
        self.flush()
        return written


class Host:
    """Runs the law of one role for its robots."""

    def __init__(self, channel: socket.socket) -> None:
        """Take the connection to the match."""
        self._channel = channel
        self._frames = Reader(2**32)
        self._writing = threading.Lock()
        self._thinking: tuple[float, float] | None = None  # since when, and the time allowed
        os.register_at_fork(after_in_child=channel.close)  # a law's own forks must not answer

    def serve(self) -> None:
        """Load the law, then answer each control step, until the match is over."""
        briefing: Briefing = pickle.loads(self._next()[1])
        limits = briefing.limits
        os.chdir(briefing.folder)
        random.seed(briefing.chance)
        np.random.seed(briefing.chance)  # noqa: NPY002 - laws that draw from it
        _Printed.limit = int(limits.output * MB)
        printed = _Printed(1, self), _Printed(2, self)
        for name, stream in zip(("stdout", "stderr"), printed, strict=True):
            setattr(sys, name, stream)
            setattr(sys, f"__{name}__", stream)
        pause = min(limits.tick, limits.start) * LATE_SHARE / 4
        threading.Thread(target=self._tell_line, args=(pause,), daemon=True).start()
        self._thinking = time.monotonic(), limits.start
        mirror = MirrorWorld(briefing, self._velocities)
        try:
            laws = [Law(law_in(briefing.file, "control"), view) for view in mirror.mine]
        except BaseException as error:
            self._blame("start", error, briefing.file.name)
            return
        self._answer(READY, b"")
        while True:
            frame = self._next()
            self._thinking = time.monotonic(), limits.tick
            mirror.show(*frame)
            commands = self._commands(laws)
            if commands is None:
                return
            self._answer(
                COMMANDS, ANSWER.pack(mirror.iteration) + commands + mirror.taken_letters()
            )

    def _velocities(self) -> tuple[bytes, bytes]:
        """Request velocities; return the current control step's frame with them."""
        with self._writing:
            self._channel.sendall(framed(WANTED, b""))
        return self._next()

    def _commands(self, laws: Sequence[Law]) -> bytes | None:
        """Return the commands of all robots, two numbers each; None after reporting a fault."""
        asked = b""
        for law in laws:
            kind = "error"
            try:
                command: Any = law.command()
                kind = "command"
                asked += struct.pack("<2d", *robot_command(command, law.refuse))
            except BaseException as error:
                self._blame(kind, error, None)
                return None
        return asked

    def _blame(self, kind: str, error: BaseException, file: str | None) -> None:
        """Report an exception from loading or calling the law."""
        place = users_line(stack_of(error)) or file
        if _is_memory_error(error):
            kind = "memory"
        if isinstance(error, Mars2dError):
            place, text = error.where or place, str(error.args[0])
        else:
            text = f"raised {described(error)}"
        self.fail(kind, place, text)

    def fail(self, kind: str, place: str | None, text: str) -> None:
        """Report a fault of the law to the match."""
        fault = {"kind": kind, "where": place, "text": " ".join(text.split())[:2000]}
        self._answer(FAULT, json.dumps(fault).encode())
        with contextlib.suppress(EOFError):
            self._next()  # raises EOFError when the match is over

    def _tell_line(self, pause: float) -> None:
        """Report, in a separate thread, the current line of a law that takes long."""
        main = threading.main_thread().ident or 0
        told = None
        while True:
            time.sleep(pause)
            thinking = self._thinking
            if thinking is None or thinking == told:
                continue
            since, allowed = thinking
            if time.monotonic() - since < LATE_SHARE * allowed:
                continue
            told = thinking
            with contextlib.suppress(Exception), self._writing:
                place = users_line(traceback.extract_stack(sys._current_frames()[main]))
                if place is not None and self._thinking is thinking:
                    self._channel.sendall(framed(LINE, json.dumps(place).encode()))

    def _answer(self, kind: bytes, body: bytes) -> None:
        self._thinking = None
        with self._writing:
            self._channel.sendall(framed(kind, body))

    def _next(self) -> tuple[bytes, bytes]:
        """Return the kind and body of the next frame. Raises EOFError when the match is over."""
        while True:
            piece = self._channel.recv(1 << 12)
            if not piece:
                raise EOFError
            for frame in self._frames.read(piece):
                return frame


def _is_memory_error(error: BaseException | None) -> bool:
    """Return whether an error is a MemoryError or was caused by one."""
    seen: set[int] = set()
    while error is not None and id(error) not in seen:
        if isinstance(error, MemoryError):
            return True
        seen.add(id(error))
        error = error.__cause__
    return False
