"""The command line: parses the verb and its arguments, runs it, and returns the exit code."""

from __future__ import annotations

import argparse
import errno
import os
import re
import signal
import sys
import threading
import traceback
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import cache, partial
from pathlib import Path
from types import FrameType
from typing import NoReturn

from mars2d import __version__
from mars2d.cli.home import home
from mars2d.cli.verbs import VERBS
from mars2d.core.errors import InputError, Mars2dError, likely
from mars2d.core.interrupt import ENDING, INTERRUPTED, interrupts
from mars2d.core.terminal import legible, usable_standard_files, warn
from mars2d.core.words import instead

OK, FAULT, BAD_INPUT = 0, 1, 2

UNUSABLE = (errno.ENAMETOOLONG, errno.EACCES)
"""Errors of paths typed by the user for which even asking whether they exist fails."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit code.

    0: everything was done. 1: a fault of MARS2D, or no run of a sweep succeeded. 2: bad input. 130:
    Ctrl-C, or the terminal was closed. argv: None for a process that is the command, and ends here.
    """
    if argv is None:
        usable_standard_files()
    legible()
    os.environ["MPLBACKEND"] = "agg"  # a law that shows a figure of its own waits for nobody
    try:
        with interrupts(), hang_up_as_interrupt():
            code = _outcome(argv)
    except KeyboardInterrupt as interrupt:
        warn(str(interrupt) or "interrupted")
        code = INTERRUPTED
    if argv is None:
        _leave(code)
    return code


def _leave(code: int) -> NoReturn:
    """End the process at once: threads and exit functions of the user's code can't hold it."""
    for number in ENDING:
        signal.signal(number, signal.SIG_IGN)
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):
            stream.flush()
    os._exit(code)


def _outcome(argv: Sequence[str] | None) -> int:
    """Execute the verb, print an error that it raises, and return the exit code."""
    try:
        words = sys.argv[1:] if argv is None else argv
        arguments, unknown = parser(words[:1]).parse_known_args(words)
        if unknown:
            arguments.refuse(f"unrecognized arguments: {' '.join(unknown)}")
        arguments.execute(arguments)
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
        known, message = self.options, message.partition(" (choose from")[0]
        for action in self._actions:
            if isinstance(action, argparse._SubParsersAction):
                known += [*action.choices]
                known += [o for sub in action.choices.values() for o in sub._option_string_actions]
        words = [word for word in re.split(r"[\s'=:]+", message) if word not in known]
        if message.startswith("the following arguments are required"):
            words = []  # the user typed none of these
        hint = next(filter(None, (self._meant(word, known) for word in words)), "")
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
