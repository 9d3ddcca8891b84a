"""The command line: parses the verb and its arguments, runs it, and returns the exit code."""

from __future__ import annotations

import argparse
import atexit
import errno
import multiprocessing
import os
import re
import signal
import sys
import threading
import time
import traceback
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import cache, partial
from multiprocessing import resource_tracker
from pathlib import Path
from types import FrameType
from typing import NoReturn

from mars2d import __version__
from mars2d.cli.home import home
from mars2d.cli.verbs import VERBS
from mars2d.core.errors import InputError, Mars2dError, counted, likely
from mars2d.core.interrupt import (
    ENDING,
    INTERRUPTED,
    OURS,
    ending,
    raised_once,
    unwrapped,
    was_interrupted,
)
from mars2d.core.lastresort import keep_orphans, kill, look_on, started_here
from mars2d.core.terminal import legible, warn
from mars2d.core.words import instead

OK, FAULT, BAD_INPUT = 0, 1, 2

LEFT = 2.0
"""How long threads and processes of the user's code may take to end after the command, seconds."""

LOOK = 0.01
"""The time between two looks at whether they have, seconds."""

UNUSABLE = (errno.ENAMETOOLONG, errno.EACCES)
"""Errors of paths typed by the user for which even asking whether they exist fails."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit code.

    0: everything was done. 1: a fault of MARS2D, or no run of a sweep succeeded. 2: bad input. 130:
    Ctrl-C, or the terminal was closed.
    """
    _hold_standard_files()
    if OURS:
        look_on([signal.SIGINT, *ENDING])
        keep_orphans()
    try:
        with legible(), raised_once(), unwrapped(), hang_up_as_interrupt():
            code = _outcome(argv)
    except KeyboardInterrupt as interrupt:
        warn(str(interrupt) or "interrupted")
        code = INTERRUPTED
    finally:
        ending()
    if OURS:
        _leave_behind(code)
    return code


def _leave_behind(code: int) -> None:
    """End the threads and processes that the user's code has started, which may never end."""
    children = [child for child in multiprocessing.active_children() if not child.daemon]
    own = threading.current_thread()
    threads = [t for t in threading.enumerate() if not t.daemon and t is not own]
    until = time.monotonic() + LEFT
    joins = [child.join for child in children] + [thread.join for thread in threads]
    for join in joins:
        join(max(0.0, until - time.monotonic()))
    while (others := _others()) and time.monotonic() < until:
        time.sleep(LOOK)
    running = [child for child in children if child.is_alive()]
    if names := [*(child.name for child in running), *others.values()]:
        warn(f"killed processes that did not end: {', '.join(names)}")
    for child in running:
        child.kill()
    killed: set[int] = set()
    while new := others.keys() - killed:  # they may have started more
        for process in new:
            kill(process)
        killed |= new
        others = _others()
    left = [thread.name for thread in threads if thread.is_alive()]
    if not left:
        return
    warn(f"left {counted(len(left), 'thread')} that did not end: {', '.join(left)}")
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError, AttributeError):
            stream.flush()
    os._exit(code)


def _others() -> dict[int, str]:
    """Return the processes that the user's code has started, by number, and their names."""
    ours = getattr(resource_tracker, "_resource_tracker", None)  # ends with this process
    own = {getattr(ours, "_pid", None)} | {each.pid for each in multiprocessing.active_children()}
    return {number: name for number, name in started_here().items() if number not in own}


def _hold_standard_files() -> None:
    """Open the standard files that were closed, so that none of ours takes their numbers.

    Libraries in C write on number 2: with `2>&-` that would be in the first file that is opened.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # the lowest number that is free


def _outcome(argv: Sequence[str] | None) -> int:
    """Execute the verb, print an error that it raises, and return the exit code."""
    try:
        words = sys.argv[1:] if argv is None else argv
        arguments, unknown = parser(words[:1]).parse_known_args(words)
        if unknown:
            arguments.refuse(f"unrecognized arguments: {' '.join(unknown)}")
        arguments.execute(arguments)
        if sys.stdout is not None:  # it is None if it was closed
            sys.stdout.flush()
    except InputError as error:
        warn(error)
        return BAD_INPUT
    except Mars2dError as error:
        warn(error)
        return FAULT
    except BrokenPipeError:
        _stop_telling()  # the reader of our output, such as `head`, has ended
    except Exception as error:
        if was_interrupted(error):
            raise
        if isinstance(error, OSError) and error.errno in UNUSABLE and error.filename:
            warn(f"{error.filename}: {error.strerror}")
            return BAD_INPUT
        if isinstance(error, FileNotFoundError) and not _has_folder():
            warn("the current folder is gone: go to another one, by cd")
            return BAD_INPUT
        traceback.print_exc()
        warn("this is a fault of MARS2D's; please report it as above")
        return FAULT
    return OK


def _has_folder() -> bool:
    """Return whether the current folder is still there."""
    try:
        return Path.cwd().is_dir()
    except FileNotFoundError:
        return False


def _stop_telling() -> None:
    """Discard the rest of the output: Python would fail with it as it ends."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)
    if sys.stderr is not None:
        sys.stderr.close()


def parser(words: Sequence[str] = ()) -> argparse.ArgumentParser:
    """Return the parser of all verbs, or only of the one that some words begin with.

    The others' modules are then imported only if an error is to be said.
    """
    root = _Parser(
        prog="mars2d",
        usage="mars2d [-h] [--version] [COMMAND ...]",
        description="Teams of mobile robots in the plane. Without a command: a window with all "
        "examples, games, and your own files.",
        allow_abbrev=False,
    )
    root.add_argument("--version", action="version", version=f"mars2d {__version__}")
    root.set_defaults(execute=partial(home, root), refuse=root.error)
    verbs = root.add_subparsers(prog="mars2d", metavar="COMMAND", parser_class=_Parser)
    for name in words[:1] if words and words[0] in VERBS else VERBS:
        verb = VERBS[name]
        doc = (verb.execute.__doc__ or "").strip()
        sub = verbs.add_parser(name, help=doc, description=doc, allow_abbrev=False)
        sub.set_defaults(execute=verb.execute, refuse=sub.error)
        verb.add_arguments(sub)
    return root


@cache
def _all_options() -> frozenset[str]:
    """Return the options of all verbs."""
    found: list[str] = []
    for verb in VERBS.values():
        sub = _Parser(add_help=False)
        verb.add_arguments(sub)
        found += sub.options
    return frozenset(found)


class _Parser(argparse.ArgumentParser):
    """A parser whose errors are one line that suggests the nearest known word."""

    @property
    def options(self) -> list[str]:
        """The options of this parser itself."""
        return [option for action in self._actions for option in action.option_strings]

    def _meant(self, word: str, known: Collection[str]) -> str:
        """Return a hint at the meaning of a word of the command line."""
        if self.prog == "mars2d" and Path(word).suffix in (".py", ".toml"):
            return f"; write mars2d run {word}"
        if meant := instead(word, self.prog):
            return meant
        return "" if word in _all_options() else likely(word, known)  # another verb's is no slip

    def error(self, message: str) -> NoReturn:
        """Raise InputError instead of printing the usage and exiting."""
        known = self.options
        for action in self._actions:
            if isinstance(action, argparse._SubParsersAction):
                known += [*action.choices]
                known += [o for sub in action.choices.values() for o in sub._option_string_actions]
        words = [word for word in re.split(r"[\s'=:]+", message) if word not in known]
        if message.startswith("the following arguments are required"):
            words = []  # the user typed none of these
        hint = next(filter(None, (self._meant(word, known) for word in words)), "")
        message = message.partition(" (choose from")[0]
        raise InputError(f"{message}{hint} (see {self.prog} --help)")


@contextmanager
def hang_up_as_interrupt() -> Iterator[None]:
    """Treat the end of the terminal (SIGHUP) as Ctrl-C, so that recorded data are saved.

    Output to the terminal is discarded from then on, since writing it would fail. Has no effect
    outside the main thread, under nohup, and on Windows, which has no SIGHUP.
    """
    ours = threading.current_thread() is threading.main_thread() and sys.platform != "win32"
    if not ours or signal.getsignal(signal.SIGHUP) is not signal.SIG_DFL:
        yield
        return
    shown = [number for number in (1, 2) if os.isatty(number)]

    def hang_up(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
        with Path(os.devnull).open("wb") as nowhere:
            for each in shown:
                os.dup2(nowhere.fileno(), each)
        signal.raise_signal(signal.SIGINT)

    signal.signal(signal.SIGHUP, hang_up)
    try:
        yield
    finally:
        signal.signal(signal.SIGHUP, signal.SIG_DFL)
