"""The command line: parses the verb and its arguments, runs it, and returns the exit code."""

from __future__ import annotations

import argparse
import errno
import os
import re
import signal
import sys
import traceback
from collections.abc import Sequence
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import NoReturn

from mars2d import __version__
from mars2d.cli.verbs import GROUPS, VERBS
from mars2d.core.errors import InputError, Mars2dError, likely, nearest, one_line
from mars2d.core.interrupt import ENDING, INTERRUPTED, interrupts
from mars2d.core.terminal import legible, tell, usable_standard_files, warn
from mars2d.core.words import instead

OK, FAULT, BAD_INPUT = 0, 1, 2

ABOUT = """\
usage: mars2d [-h] [--version] [COMMAND ...]

Teams of mobile robots in the plane. Without a command: a window with all
examples, games, and your own files. COMMAND --help shows its options.
"""


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
        code = _outcome(sys.argv[1:] if argv is None else argv)
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


def _outcome(words: Sequence[str]) -> int:
    """Execute the verb, print an error that it raises, and return the exit code."""
    try:
        arguments = parse(words)
        with interrupts():
            arguments.execute(arguments)
            sys.stdout.flush()
    except InputError as error:
        warn(error)
        return BAD_INPUT
    except Mars2dError as error:
        warn(error)
        return FAULT
    except BrokenPipeError:
        return OK  # the reader of our output, such as `head`, has ended
    except Exception as error:
        if isinstance(error, OSError) and (error.filename or error.errno == errno.ENOENT):
            warn(f"{error.filename or 'the current folder'}: {error.strerror}")
            return BAD_INPUT
        traceback.print_exc()
        warn("this is a fault of MARS2D's; please report it as above")
        return FAULT
    return OK


def parse(words: Sequence[str]) -> argparse.Namespace:
    """Return the arguments of a command, with the function that executes it.

    Raises InputError for words that are no command.
    """
    if words and words[0] in VERBS:
        return parser_of(words[0]).parse_args(words[1:])
    if words and not words[0].startswith("-"):
        raise InputError(f"there is no command {words[0]!r}{_meant(words[0])}")
    root = _Root(prog="mars2d", allow_abbrev=False)
    root.add_argument("--version", action="version", version=f"mars2d {__version__}")
    root.set_defaults(execute=_home)
    return root.parse_args(words)


def _meant(word: str) -> str:
    """Return a hint at the meaning of a word in the place of a verb."""
    from mars2d.scenario.examples import examples

    if Path(word).suffix in (".py", ".toml") or word in examples():
        return f"; write mars2d run {word}"
    runs = [f"run {name}" for name in examples()]
    return likely(word, VERBS) or likely(f"run {word}", runs, 0.8) or nearest(word, VERBS, most=20)


def parser_of(verb: str) -> argparse.ArgumentParser:
    """Return the parser of a verb, whose module is imported."""
    module = import_module(f"mars2d.cli.verbs.{verb}")
    parser = _Parser(prog=f"mars2d {verb}", description=module.execute.__doc__, allow_abbrev=False)
    parser.set_defaults(execute=module.execute)
    for name, settings in module.ARGUMENTS.items():
        parser.add_argument(name, **settings)
    return parser


def _options(parser: argparse.ArgumentParser) -> list[str]:
    return [option for action in parser._actions for option in action.option_strings]


class _Parser(argparse.ArgumentParser):
    """A parser whose errors are one line that suggests the nearest known word."""

    def error(self, message: str) -> NoReturn:
        """Raise InputError instead of printing the usage and exiting."""
        known = _options(self)
        words = [word for word in re.split(r"[\s'=:]+", message) if word not in known]
        if message.startswith("the following arguments are required"):
            words = []  # the user typed none of these
        of_others = {option for verb in VERBS for option in _options(parser_of(verb))}
        hints = [instead(word, self.prog) for word in words]
        hints += [likely(word, known) for word in words if word not in of_others]  # no slips
        hint = next(filter(None, hints), "")
        raise InputError(f"{message}{hint} (see {self.prog} --help)")


class _Root(_Parser):
    """The parser of ``mars2d`` alone, whose help is one screen."""

    def format_help(self) -> str:
        """Return what each verb is for."""
        groups = [
            "\n".join([f"\n{title}:", *(f"  {name:<12}{line}" for name, line in group.items())])
            for title, group in GROUPS.items()
        ]
        return "\n".join([ABOUT.rstrip(), *groups, ""])


def _home(_: argparse.Namespace) -> None:
    """Show the home, and run the commands chosen there; print the help if there is no display."""
    from mars2d.window.screen.display import display_available, started_display

    if not display_available():
        tell(_Root().format_help(), end="")
        return
    from mars2d.window.home import Home
    from mars2d.window.screen.memory import Memory

    note = ""
    with started_display():
        while (command := Home(Memory(), note).run()) is not None:
            note = ""
            try:
                chosen = parse(command)
                chosen.execute(chosen)
            except Mars2dError as error:
                warn(error)
                note = one_line(error)
