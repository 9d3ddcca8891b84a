"""``mars2d`` alone: a home where there is a display, else the help."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial

from mars2d.cli.runs import has_display
from mars2d.core.errors import Mars2dError, one_line
from mars2d.core.terminal import tell, warn


def home(parser: argparse.ArgumentParser, _: argparse.Namespace) -> None:
    """Show the home, and run the command chosen there; print the help if there is no display."""
    if not has_display():
        tell(parser.format_help().rstrip())
        return
    from mars2d.window.home import Home
    from mars2d.window.screen.display import started_display
    from mars2d.window.screen.memory import Memory

    note = ""
    with started_display():
        while (command := Home(Memory(), note).run()) is not None:
            note = _told(partial(_do, parser, command))


def _do(parser: argparse.ArgumentParser, command: tuple[str, ...]) -> None:
    arguments = parser.parse_args(command)
    arguments.execute(arguments)


def _told(do: Callable[[], None]) -> str:
    """Do something, and return its error, which is printed as well; "" if there is none."""
    try:
        do()
    except Mars2dError as error:
        warn(error)
        return one_line(str(error))
    return ""
