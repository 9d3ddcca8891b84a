"""Where the processes of isolated laws come from, and how they end.

On Linux a nursery, one process that has imported all, forks one for each law: that takes
milliseconds. Elsewhere each law's process starts by itself. `multiprocessing` has no part in it: so
what it calls a daemon may have such processes, and the caller's own script is not run again.
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

__all__ = ["Ended", "serve", "spawn", "start"]

Sockets = tuple[socket.socket, socket.socket]

ASK = struct.Struct("<cqd")
"""To the nursery: "f" for fork or "e" for end; a process; how long it may take to end by itself."""

TOLD = struct.Struct("<q?")
"""From the nursery: a process or -1; or the code that one has ended with, and if it was made to."""

CODE = "import json, sys; sys.path[:] = json.loads(sys.argv[1]); "
"""What a process begins with that imports what this one would."""

SETTINGS = {
    **dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1"),
    "PYTHONHASHSEED": "0",
}
"""A law is one thread, since others of numpy's would take memory by the number of cores; and sets
are in the same order in each run."""


class Ended(NamedTuple):
    """The code that a process has ended with, -N for a signal N, and whether it was made to."""

    code: int
    forced: bool


End = Callable[[float], Ended]
"""Ends a process and all that it has started, after so many seconds that it has for itself."""


def start(sockets: Sockets) -> End:
    """Start a law's process with its connections, which are closed here; return what ends it.

    sockets: its channel and its output. Raises InputError if none can be started.
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


def _fork(sockets: Sockets) -> End:
    """Let the nursery start a process; a new one, if a law has killed it."""
    nursery = _nursery(os.getpid())
    try:
        process = nursery.fork(sockets)
    except ConnectionError:
        nursery = _nursery(os.getpid())
        process = nursery.fork(sockets)
    return functools.partial(nursery.end, process)


def spawn(sockets: Sockets) -> End:
    """Start a law's process by itself, as `start` does where there is no nursery."""
    windows = sys.platform == "win32"
    process = subprocess.Popen(
        _command("from mars2d.study.isolation.nursery import stand; stand()"),
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        env=os.environ | SETTINGS,
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

    return end


def _shared(connection: socket.socket, process: int) -> str:
    share: Callable[[int], bytes] = getattr(connection, "share")  # noqa: B009 - Windows alone
    return share(process).hex()


def stand() -> NoReturn:
    """Be a law's process that was started by itself."""
    from mars2d.study.isolation import host

    given = json.load(sys.stdin)
    if sys.platform == "win32":
        made = [socket.fromshare(bytes.fromhex(each)) for each in given]
    else:
        made = [socket.socket(fileno=each) for each in given]
    host.main(*made)


def _command(code: str, *arguments: str) -> list[str]:
    return [sys.executable, "-P", "-c", CODE + code, json.dumps(sys.path), *arguments]


def _kill(process: int, alone: Callable[[], None]) -> None:
    """Kill a process and its group, where there are groups."""
    if hasattr(os, "killpg"):
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(process, signal.SIGKILL)
    with contextlib.suppress(ProcessLookupError):
        alone()


class Nursery:
    """A process that forks the processes of laws; it ends them all when this process ends."""

    def __init__(self) -> None:
        self._line, theirs = socket.socketpair()
        with theirs:
            self._process = subprocess.Popen(
                _command(
                    "from mars2d.study.isolation.nursery import serve; serve(int(sys.argv[2]))",
                    str(theirs.fileno()),
                ),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                env=os.environ | SETTINGS,
                pass_fds=[theirs.fileno()],
                start_new_session=True,
            )
        self._asking = threading.Lock()
        self.closed = False
        atexit.register(self.close)

    def fork(self, sockets: Sockets) -> int:
        """Return the number of a new process that has these connections."""
        descriptors = [each.fileno() for each in sockets]
        process, _ = self._ask(ASK.pack(b"f", 0, 0.0), descriptors)
        if process < 0:
            raise OSError("there are too many processes, or too little memory")
        return process

    def end(self, process: int, grace: float) -> Ended:
        """End a process and its group."""
        try:
            return Ended(*self._ask(ASK.pack(b"e", process, grace), []))
        except OSError:  # the nursery is gone
            _kill(process, lambda: os.kill(process, signal.SIGKILL))
            return Ended(-signal.SIGKILL, forced=True)

    def _ask(self, question: bytes, descriptors: list[int]) -> tuple[int, bool]:
        with self._asking:
            try:
                socket.send_fds(self._line, [question], descriptors)
                told = self._line.recv(TOLD.size, socket.MSG_WAITALL)
                if len(told) == TOLD.size:
                    process, flag = TOLD.unpack(told)
                    return process, flag
            except BaseException:  # Ctrl-C between question and answer
                self.close()
                raise
            self.close()
            raise ConnectionError("the process that starts them has ended")

    def close(self) -> None:
        """End the nursery, and with it all processes that it has started."""
        self.closed = True
        self._line.close()
        self._process.wait()
        atexit.unregister(self.close)


_nurseries: dict[int, Nursery] = {}
_choosing = threading.Lock()


def _nursery(process: int) -> Nursery:
    """Return the nursery of this process, not that of one that it was forked from."""
    with _choosing:
        if process not in _nurseries or _nurseries[process].closed:
            _nurseries[process] = Nursery()
        return _nurseries[process]


def serve(descriptor: int) -> None:
    """Be the nursery: fork and end processes as they are asked for, until nobody can ask."""
    from mars2d.study.isolation import host

    line = socket.socket(fileno=descriptor)
    gc.freeze()  # so that what is shared stays so
    living: set[int] = set()
    try:
        while True:
            question, descriptors, _, _ = socket.recv_fds(line, ASK.size, 2)
            if len(question) < ASK.size:
                return
            what, process, grace = ASK.unpack(question)
            if what == b"f":
                process = _forked(
                    line, [socket.socket(fileno=each) for each in descriptors], host.main
                )
                living.add(process)
                told = process, False
            else:
                living.discard(process)
                told = _ended(process, grace)
            line.sendall(TOLD.pack(*told))
    finally:
        for process in living - {-1}:
            _ended(process, 0.0)


def _forked(
    line: socket.socket, sockets: list[socket.socket], main: Callable[..., NoReturn]
) -> int:
    """Return the number of a new process that runs `main`; -1 if there can't be one."""
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
    """End a process and its group, after so many seconds that it has for itself."""
    until = time.monotonic() + grace
    gone = _is_gone(process)
    while not gone and time.monotonic() < until:
        time.sleep(0.001)
        gone = _is_gone(process)
    _kill(process, lambda: os.kill(process, signal.SIGKILL))  # its group may live on without it
    _, status = os.waitpid(process, 0)
    return Ended(os.waitstatus_to_exitcode(status), not gone)


def _is_gone(process: int) -> bool:
    """Return whether a process has ended; its number stays taken all the same."""
    return os.waitid(os.P_PID, process, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None
