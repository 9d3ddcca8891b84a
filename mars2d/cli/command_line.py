"""The command line: which verb is meant, and what its outcome is to the shell."""

from __future__ import annotations

import argparse
import errno
import re
import sys
import traceback
from collections.abc import Collection, Sequence
from typing import NoReturn

from mars2d import __version__
from mars2d.cli.terminal import hang_up_as_interrupt
from mars2d.cli.verbs import VERBS
from mars2d.core.errors import InputError, Mars2dError, likely, one_line
from mars2d.core.interrupt import INTERRUPTED, ending, raised_once, unwrapped, was_interrupted

__all__ = ["main", "parser"]

OK, FAULT, BAD_INPUT = 0, 1, 2

UNUSABLE = (errno.ENAMETOOLONG, errno.EACCES)
"""What a path may be that was typed; not even whether it is there can be asked."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit code.

    0 when all was done, 2 for bad input, 1 for a fault of MARS2D's, 130 after Ctrl-C, or
    the end of the terminal.
    """
    try:
        with raised_once(), unwrapped(), hang_up_as_interrupt():
            return _outcome(argv)
    except KeyboardInterrupt as interrupt:
        print(f"mars2d: {str(interrupt) or 'interrupted'}", file=sys.stderr)
        return INTERRUPTED
    finally:
        ending()


def _outcome(argv: Sequence[str] | None) -> int:
    """Do what is asked for; say what went wrong, and return the exit code."""
    try:
        arguments, unknown = parser().parse_known_args(argv)
        if unknown:
            arguments.refuse(f"unrecognized arguments: {' '.join(unknown)}")
        arguments.execute(arguments)
        if sys.stdout is not None:  # it is None where it was closed
            sys.stdout.flush()
    except InputError as error:
        print(f"mars2d: {one_line(error)}", file=sys.stderr)
        return BAD_INPUT
    except Mars2dError as error:
        print(f"mars2d: {one_line(error)}", file=sys.stderr)
        return FAULT
    except BrokenPipeError:
        sys.stderr.close()  # whoever read our output has seen enough
    except Exception as error:
        if was_interrupted(error):
            raise
        if isinstance(error, OSError) and error.errno in UNUSABLE and error.filename:
            print(f"mars2d: {one_line(error.filename)}: {error.strerror}", file=sys.stderr)
            return BAD_INPUT
        traceback.print_exc()
        print("mars2d: this is a fault of MARS2D's; please report it as above", file=sys.stderr)
        return FAULT
    return OK


def parser() -> argparse.ArgumentParser:
    """Return the parser of all verbs."""
    root = _Parser(
        prog="mars2d", description="Teams of mobile robots in the plane.", allow_abbrev=False
    )
    root.add_argument("--version", action="version", version=f"mars2d {__version__}")
    verbs = root.add_subparsers(metavar="COMMAND", required=True, parser_class=_Parser)
    for verb in VERBS:
        doc = (verb.execute.__doc__ or "").strip()
        sub = verbs.add_parser(verb.NAME, help=doc, description=doc, allow_abbrev=False)
        sub.set_defaults(execute=verb.execute, refuse=sub.error)
        verb.add_arguments(sub)
    for sub in verbs.choices.values():
        sub.elsewhere = {option for other in verbs.choices.values() for option in other.options}
    return root


class _Parser(argparse.ArgumentParser):
    """A parser whose errors are one line that names the nearest right word."""

    elsewhere: Collection[str] = ()
    """Options of other verbs: they are not misspelt."""

    @property
    def options(self) -> list[str]:
        """The options of this parser itself."""
        return [option for action in self._actions for option in action.option_strings]

    def error(self, message: str) -> NoReturn:
        """Raise an InputError in place of printing the usage and leaving."""
        known = self.options
        for action in self._actions:
            if isinstance(action, argparse._SubParsersAction):
                known += [*action.choices]
                known += [o for sub in action.choices.values() for o in sub._option_string_actions]
        right = {*known, *self.elsewhere}
        words = [word for word in re.split(r"[\s'=:]+", message) if word not in right]
        if message.startswith("the following arguments are required"):
            words = []  # none of these was typed
        hint = next(filter(None, (likely(word, known) for word in words)), "")
        message = message.partition(" (choose from")[0]
        raise InputError(f"{message}{hint} (see {self.prog} --help)")
