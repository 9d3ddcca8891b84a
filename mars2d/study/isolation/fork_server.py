"""Start and end the processes of isolated laws.

On Linux a fork server, one process that has imported everything, forks a process for each law
within milliseconds. On other systems each law's process is started separately. `multiprocessing` is
not used, since it would import the caller's script again and forbid its daemons to have children.
"""

from __future__ import annotations

import atexit
import contextlib
import functools
import gc
import json
import os
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from typing import NamedTuple, NoReturn

from mars2d.core.errors import InputError
from mars2d.study import ONE_THREAD

Sockets = tuple[socket.socket, socket.socket]

REQUEST = struct.Struct("<cqd")
"""To the fork server: "f" for fork or "e" for end; a process; the time it has to end by itself."""

REPLY = struct.Struct("<q?")
"""From the fork server: a process or -1; or an exit code, and whether the end was forced."""

PREAMBLE = "import json, sys; sys.path[:] = json.loads(sys.argv[1]); "
"""The first statements of a new process, which give it this one's import path."""

ENVIRONMENT = {**ONE_THREAD, "PYTHONHASHSEED": "0"}
"""One thread, since numpy's threads take memory for each core; and sets in the same order in each
run."""


class Ended(NamedTuple):
    """The exit code of a process, -N for a signal N, and whether its end was forced."""

    code: int
    forced: bool


class Started(NamedTuple):
    """The id of a process, and the function that ends it and all that it has started.

    The function is given how many seconds the process has to end by itself.
    """

    process: int
    end: Callable[[float], Ended]


def start(sockets: Sockets) -> Started:
    """Start a law's process.

    sockets: its channel and its output, which are closed in this process. Raises InputError if no
    process can be started.
    """
    try:
        if sys.platform == "linux":
            return _fork(sockets)
        return spawn(sockets)
    except OSError as error:
        raise InputError(f"can't start a process for a law: {error}") from error
    finally:
        for each in sockets:
            each.close()


def _fork(sockets: Sockets) -> Started:
    """Let the fork server start a process; a new server, if a law has killed it."""
    server = _server(os.getpid())
    try:
        process = server.fork(sockets)
    except ConnectionError:
        server = _server(os.getpid())
        process = server.fork(sockets)
    return Started(process, functools.partial(server.end, process))


def spawn(sockets: Sockets) -> Started:
    """Start a law's process without a fork server."""
    windows = sys.platform == "win32"
    process = subprocess.Popen(
        _command("from mars2d.study.isolation.fork_server import run_alone; run_alone()"),
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        env=os.environ | ENVIRONMENT,
        pass_fds=() if windows else [each.fileno() for each in sockets],
        start_new_session=not windows,
    )
    given = [_shared(each, process.pid) if windows else each.fileno() for each in sockets]
    assert process.stdin is not None
    with contextlib.suppress(BrokenPipeError), process.stdin as pipe:
        pipe.write(json.dumps(given).encode())

    def end(grace: float) -> Ended:
        forced = False
        try:
            process.wait(grace)
        except subprocess.TimeoutExpired:
            forced = True
        _kill(process.pid, process.kill)
        return Ended(process.wait(), forced)

    return Started(process.pid, end)


def _shared(connection: socket.socket, process: int) -> str:
    share: Callable[[int], bytes] = getattr(connection, "share")  # noqa: B009 - Windows alone
    return share(process).hex()


def run_alone() -> NoReturn:
    """Run as a law's process that was started without a fork server."""
    from mars2d.study.isolation import host

    given = json.load(sys.stdin)
    if sys.platform == "win32":
        made = [socket.fromshare(bytes.fromhex(each)) for each in given]
    else:
        made = [socket.socket(fileno=each) for each in given]
    host.main(*made)


def _command(code: str, *arguments: str) -> list[str]:
    return [sys.executable, "-P", "-c", PREAMBLE + code, json.dumps(sys.path), *arguments]


def _kill(process: int, alone: Callable[[], None]) -> None:
    """Kill a process and its group."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        if hasattr(os, "killpg"):
            os.killpg(process, signal.SIGKILL)
    with contextlib.suppress(ProcessLookupError):
        alone()


class ForkServer:
    """A process that forks the laws' processes, and ends them all when this process ends."""

    def __init__(self) -> None:
        self._line, theirs = socket.socketpair()
        with theirs:
            self._process = subprocess.Popen(
                _command(
                    "from mars2d.study.isolation.fork_server import serve; serve(int(sys.argv[2]))",
                    str(theirs.fileno()),
                ),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                env=os.environ | ENVIRONMENT,
                pass_fds=[theirs.fileno()],
                start_new_session=True,
            )
        self._asking = threading.Lock()
        self.closed = False
        atexit.register(self.close)

    def fork(self, sockets: Sockets) -> int:
        """Return the id of a new process that has these connections."""
        descriptors = [each.fileno() for each in sockets]
        process, _ = self._ask(REQUEST.pack(b"f", 0, 0.0), descriptors)
        if process < 0:
            raise OSError("there are too many processes, or too little memory")
        return process

    def end(self, process: int, grace: float) -> Ended:
        """End a process and its group."""
        try:
            return Ended(*self._ask(REQUEST.pack(b"e", process, grace), []))
        except OSError:  # the fork server is gone
            _kill(process, lambda: os.kill(process, signal.SIGKILL))
            return Ended(-signal.SIGKILL, forced=True)

    def _ask(self, question: bytes, descriptors: list[int]) -> tuple[int, bool]:
        with self._asking:
            try:
                socket.send_fds(self._line, [question], descriptors)
                told = self._line.recv(REPLY.size, socket.MSG_WAITALL)
                if len(told) == REPLY.size:
                    process, flag = REPLY.unpack(told)
                    return process, flag
            except BaseException:  # Ctrl-C between question and answer
                self.close()
                raise
            self.close()
            raise ConnectionError("the process that starts them has ended")

    def close(self) -> None:
        """End the fork server, and with it all processes that it has started."""
        self.closed = True
        self._line.close()
        self._process.wait()
        atexit.unregister(self.close)


_servers: dict[int, ForkServer] = {}
_choosing = threading.Lock()


def _server(process: int) -> ForkServer:
    """Return the fork server of this process, not that of a process it was forked from."""
    with _choosing:
        if process not in _servers or _servers[process].closed:
            _servers[process] = ForkServer()
        return _servers[process]


def serve(descriptor: int) -> None:
    """Run as the fork server: fork and end processes on request, until the connection closes."""
    from mars2d.study.isolation import host

    line = socket.socket(fileno=descriptor)
    gc.freeze()  # so that forked processes keep sharing memory
    living: set[int] = set()
    try:
        while True:
            question, descriptors, _, _ = socket.recv_fds(line, REQUEST.size, 2)
            if len(question) < REQUEST.size:
                return
            what, process, grace = REQUEST.unpack(question)
            if what == b"f":
                process = _forked(
                    line, [socket.socket(fileno=each) for each in descriptors], host.main
                )
                living.add(process)
                told = process, False
            else:
                living.discard(process)
                told = _ended(process, grace)
            line.sendall(REPLY.pack(*told))
    except (BrokenPipeError, ConnectionResetError):
        return  # the match was killed
    finally:
        for process in living - {-1}:
            _ended(process, 0.0)


def _forked(
    line: socket.socket, sockets: list[socket.socket], main: Callable[..., NoReturn]
) -> int:
    """Return the id of a new process that runs `main`; -1 if none can be started."""
    try:
        process = os.fork()
    except OSError:
        process = -1
    if process == 0:
        try:
            os.setsid()
            line.close()
            main(*sockets)
        finally:
            os._exit(1)
    for each in sockets:
        each.close()
    return process


def _ended(process: int, grace: float) -> Ended:
    """End a process and its group; it has `grace` seconds to end by itself."""
    until = time.monotonic() + grace
    gone = _is_gone(process)
    while not gone and time.monotonic() < until:
        time.sleep(0.001)
        gone = _is_gone(process)
    _kill(process, lambda: os.kill(process, signal.SIGKILL))  # its group may live on without it
    _, status = os.waitpid(process, 0)
    return Ended(os.waitstatus_to_exitcode(status), not gone)


def _is_gone(process: int) -> bool:
    """Return whether a process has ended, without releasing its id."""
    return os.waitid(os.P_PID, process, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None
