"""Processes that are forked from one which has imported all that they need.

Each is a process of its own, with its output and exit code, as if Python were started for it, but
begins half a second of work later. As a program this is the one that they are forked from: it waits
at a socket for what to be, until nobody can ask.
"""

from __future__ import annotations

import atexit
import importlib
import json
import os
import select
import signal
import socket
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).parents[1]
MOST = 1 << 17
"""Bytes of what is asked for: arguments and environment."""


class Nursery:
    """The process that others are forked from.

    modules: what it imports before, by their full names.
    """

    def __init__(self, environment, *modules):
        self._socket, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        path = [str(ROOT), *filter(None, [environment.get("PYTHONPATH")])]
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.forking", str(theirs.fileno()), *modules],
            env=environment | {"PYTHONPATH": os.pathsep.join(path)},
            pass_fds=[theirs.fileno()],
        )
        theirs.close()
        atexit.register(self.close)

    def fork(self, module, arguments, environment, folder=None):
        """Let it fork a process that calls `main` of a module; its code is what that returns."""
        asked = json.dumps([module, arguments, environment, folder and str(folder)]).encode()
        pipes = [os.pipe() for _ in range(3)]
        socket.send_fds(self._socket, [asked], [write for _, write in pipes])
        for _, write in pipes:
            os.close(write)
        return Forked(*(read for read, _ in pipes))

    def close(self):
        """End it; those that it has forked go on."""
        self._socket.close()
        self._process.kill()
        self._process.wait()


class Forked:
    """A process that was forked by another: as much of `subprocess.Popen` as is needed here."""

    def __init__(self, stdout, stderr, report):
        self.stdout = os.fdopen(stdout, encoding="utf-8")
        self.stderr = os.fdopen(stderr, encoding="utf-8")
        self.returncode = None
        self._report = os.fdopen(report)
        self.pid = int(self._report.readline())

    def poll(self):
        """Return its exit code, or None while it runs."""
        return self._ended(0)

    def wait(self, timeout=None):
        """Wait until it has ended, and return its exit code."""
        if self._ended(timeout) is None:
            raise subprocess.TimeoutExpired("a forked process", timeout)
        return self.returncode

    def _ended(self, timeout):
        if self.returncode is None and select.select([self._report], [], [], timeout)[0]:
            self.returncode = int(self._report.readline())
            self._report.close()
        return self.returncode

    def communicate(self):
        """Return all that it prints and all that it says of errors, until both are closed."""
        with self.stdout, self.stderr, ThreadPoolExecutor(1) as reader:
            errors = reader.submit(self.stderr.read)
            return self.stdout.read(), errors.result()

    def send_signal(self, number):
        """Send it a signal."""
        os.kill(self.pid, number)

    def terminate(self):
        """End it; what measures coverage in it still writes what it has seen."""
        self.send_signal(signal.SIGTERM)


def serve(connection):
    """Fork as often as is asked for; return, in each forked process, the module that it is."""
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for those that wait
    while True:
        asked, pipes, *_ = socket.recv_fds(connection, MOST, 3)
        if not asked:
            raise SystemExit
        if os.fork() == 0:
            break
        for pipe in pipes:
            os.close(pipe)
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    connection.close()
    out, errors, report = pipes
    forked = os.fork()
    if forked:
        os.close(out)
        os.close(errors)
        os.write(report, f"{forked}\n".encode())
        status = os.waitpid(forked, 0)[1]
        os.write(report, f"{os.waitstatus_to_exitcode(status)}\n".encode())
        os._exit(0)
    os.close(report)
    os.dup2(out, 1)
    os.dup2(errors, 2)
    os.close(out)
    os.close(errors)
    module, arguments, environment, folder = json.loads(asked)
    os.environ.clear()
    os.environ.update(environment)
    if folder:
        os.chdir(folder)
        sys.path[0] = folder
    sys.argv[1:] = arguments
    return module


if __name__ == "__main__":
    number, *modules = sys.argv[1:]
    for name in modules:
        importlib.import_module(name)
    sys.exit(importlib.import_module(serve(socket.socket(fileno=int(number)))).main())
