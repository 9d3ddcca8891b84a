"""The process in which an isolated law runs: it receives observations and sends commands."""

from __future__ import annotations

import errno
import faulthandler
import io
import json
import math
import os
import pickle
import random
import socket
import sys
import traceback
from collections.abc import Mapping
from contextlib import suppress
from importlib.machinery import (
    EXTENSION_SUFFIXES,
    ExtensionFileLoader,
    FileFinder,
    SourceFileLoader,
)
from pathlib import Path
from types import ModuleType
from typing import Any, ClassVar, NoReturn

import numpy as np

from mars2d.core.errors import Mars2dError
from mars2d.core.hints import described
from mars2d.core.usercode import users_line
from mars2d.scenario.code_file import law_in
from mars2d.tournaments.isolation import jail
from mars2d.tournaments.isolation.limits import MB, Limits
from mars2d.tournaments.isolation.mirror_world import MirrorWorld
from mars2d.tournaments.isolation.observation import Briefing
from mars2d.world.laws import Law, robot_command

CUT_OFF = 70
"""The exit code of a process whose law has closed the connection to the match."""

KEPT = ("LANG", "LC_ALL", "PATH", "PYTHONHASHSEED", "TZ", "OPENBLAS_NUM_THREADS")
"""The variables of the environment that a law sees."""

MAX_FILES = 256
"""How many files a law may have open at once."""


class Sent(SourceFileLoader):
    """Loads code from the bytes that the match has sent, which it knows, not from the disk."""

    contents: ClassVar[Mapping[Path, bytes]] = {}

    def get_data(self, path: str) -> bytes:
        """Return the contents of a file."""
        return self.contents.get(Path(path)) or super().get_data(path)

    def path_stats(self, path: str) -> NoReturn:
        """Refuse: so that no compiled code is read in place of the file."""
        raise OSError(path)


def serve(channel: socket.socket, output: str) -> NoReturn:
    """Serve one match and end the process.

    channel: the connection to the match. output: the file that gets everything that is printed.
    """
    code = CUT_OFF
    try:
        if sys.platform != "win32":
            os.setsid()
        _redirect(output)
        os.closerange(3, channel.fileno())
        os.closerange(channel.fileno() + 1, MAX_FILES)
        _play(channel)
        code = 0
    except BaseException:
        traceback.print_exc()
    finally:
        os._exit(code)  # despite threads, handlers and exit functions that the law left behind


def _redirect(output: str) -> None:
    """Make the standard input empty, and let everything that is printed go to a file."""
    sys.stdin = Path(os.devnull).open(encoding="utf-8")  # noqa: SIM115 - for as long as it runs
    os.dup2(sys.stdin.fileno(), 0)
    file = os.open(output, os.O_WRONLY | os.O_APPEND)
    for number, name in ((1, "stdout"), (2, "stderr")):
        os.dup2(file, number)
        raw: Any = io.FileIO(number, "w", closefd=False)
        stream = io.TextIOWrapper(raw, "utf-8", "backslashreplace", write_through=True)
        setattr(sys, name, stream)
        setattr(sys, f"__{name}__", stream)
    faulthandler.enable(2, all_threads=False)  # says where a law was when it was ended


def _play(channel: socket.socket) -> None:
    """Load the law of one role, and answer each control step for its robots, until all is over.

    Messages to it are pickled, those from it are lines of JSON, which runs no code.
    """
    questions = channel.makefile("rb")
    briefing: Briefing = pickle.load(questions)

    def answer(told: Mapping[str, Any]) -> None:
        channel.sendall(json.dumps(told).encode() + b"\n")

    _shut_in(briefing)
    mirror = MirrorWorld(briefing)
    kind = "start"
    try:
        loaded = [law_in(briefing.file, "control", loader=Sent) for _ in mirror.mine]
        inputs = mirror.mine[0].drive.inputs
        laws = [Law(law, view, ()) for law, view in zip(loaded, mirror.mine, strict=True)]
        answer({})
        while questions.peek(1):
            mirror.show(pickle.load(questions))
            commands = []
            for law in laws:
                kind = "error"
                command: Any = law.command()
                kind = "command"
                commands.append([*map(float, robot_command(command, inputs, law.refuse))])
            answer({"commands": commands, "letters": mirror.mailbox.sent})
    except BaseException as error:
        answer(_fault(kind, error, int(briefing.limits.output * MB)))


def _shut_in(briefing: Briefing) -> None:
    """Prepare this process for the law, and take from it what it does not need."""
    kept = {name: os.environ[name] for name in KEPT if name in os.environ}
    os.environ.clear()
    os.environ.update(kept)
    os.chdir(briefing.folder)
    random.seed(briefing.chance)
    np.random.seed(briefing.chance)  # noqa: NPY002 - laws that draw from it
    Sent.contents = briefing.code
    folders = {str(path.parent) for path in briefing.code}

    def finder(folder: str) -> FileFinder:
        if folder not in folders:
            raise ImportError(folder)
        return FileFinder(folder, (ExtensionFileLoader, EXTENSION_SUFFIXES), (Sent, [".py"]))

    sys.path_hooks.insert(0, finder)
    sys.path_importer_cache.clear()
    sys.modules["__main__"] = ModuleType("__main__")
    _limit(briefing.limits)
    if jail.is_protected():
        hidden = [path.resolve() for path in briefing.hidden]
        beside = [
            path
            for path in briefing.file.parent.iterdir()
            if not any(other.is_relative_to(path.resolve()) for other in hidden)
        ]
        jail.close_in([*beside, *map(Path, briefing.limits.reads)], [briefing.file.parent])


def _fault(kind: str, error: BaseException, most: int) -> dict[str, Any]:
    """Return what is told of an exception from loading or calling the law; most: its output."""
    place = users_line(traceback.extract_tb(error.__traceback__))
    text = f"raised {described(error)}"
    if isinstance(error, Mars2dError):
        place, text = error.where or place, str(error.args[0])
    causes = (error, error.__cause__)
    if jail.is_protected() and any(isinstance(each, PermissionError) for each in causes):
        text += "; this is refused to isolated laws, which read what is beside them and --reads"
    if any(isinstance(each, MemoryError) for each in causes):
        kind, text = "memory", "took too much memory"
    if any(getattr(each, "errno", None) == errno.EFBIG for each in causes):
        kind, text = "output", f"printed more than {most} bytes"
    return {"kind": kind, "where": place, "text": text[:2000]}


def _limit(limits: Limits) -> None:
    """Set the limits of the system for this process, as far as it has them."""
    if sys.platform == "win32":
        return
    import resource

    used = resource.getrusage(resource.RUSAGE_SELF)
    seconds = math.ceil(used.ru_utime + used.ru_stime + limits.start + limits.match) + 1
    most = {
        "CORE": (0, 0),
        "CPU": (seconds, seconds + 1),
        "FSIZE": (int(limits.output * MB),) * 2,
        "NOFILE": (MAX_FILES, MAX_FILES),
    }
    if sys.platform == "linux":  # writable memory; what is only reserved, as by torch, is not used
        data = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[5])
        most["DATA"] = (int(data * os.sysconf("SC_PAGE_SIZE") + limits.memory * MB),) * 2
    for name, limit in most.items():
        with suppress(ValueError):  # a lower one is set already
            resource.setrlimit(getattr(resource, f"RLIMIT_{name}"), limit)
