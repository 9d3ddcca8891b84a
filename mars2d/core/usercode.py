"""The user's code: errors that it raises name its line, and show the lines around it."""

from __future__ import annotations

import functools
import inspect
import io
import linecache
import os
import re
import sys
import sysconfig
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

from mars2d.core.errors import InputError, Late, LawError
from mars2d.core.hints import described

_PACKAGE = Path(__file__).parents[1]
_STANDARD_LIBRARY = Path(sysconfig.get_path("stdlib"))


class called:  # noqa: N801 - used like a function, as contextlib's are
    """Run the user's code, and turn an exception that it raises into a LawError with file and line.

    An InputError that one of MARS2D's own parts raises as a run starts is passed on unchanged: the
    user's code is not at fault.

    What is called at each control step catches exceptions and calls `blame`, which costs nothing
    until there is one; a ``with`` is two calls.
    """

    def __init__(self, name: str, function: Callable[..., Any], robot: str = "") -> None:
        """Take the name for messages, the function that is called, and the robot whose it is."""
        self._name, self._function, self._robot = name, function, robot

    def __enter__(self) -> None:
        pass

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        tb: TracebackType | None,
    ) -> None:
        if error is not None:
            self.blame(error)

    def blame(self, error: BaseException) -> None:
        """Raise the LawError for an exception that was caught, unless it is to be passed on."""
        late = error.why if isinstance(error, Late) else ""
        if not (late or isinstance(error, (Exception, SystemExit))):  # such as Ctrl-C
            return
        where = users_line(stack_of(error)) or definition(self._function)
        if isinstance(error, LawError):
            error.where, error.robot = error.where or where, error.robot or self._robot
            return
        at_start = getattr(self._function, "__name__", "") == "on_start"
        if isinstance(error, InputError) and where is None and at_start:
            return
        what = late or f"raised {described(error)}"
        wrapped = LawError(f"{self._name} {what}")
        wrapped.where, wrapped.robot = where, self._robot
        raise wrapped from error


def stack_of(error: BaseException) -> traceback.StackSummary:
    """Return the steps from where an exception was caught to where it was raised."""
    return traceback.extract_tb(error.__traceback__)


def users_line(stack: traceback.StackSummary) -> str | None:
    """Return file and line of the innermost step of a stack in the user's own code, if any."""
    steps = [step for step in stack if _is_users(Path(step.filename))]
    return _place(steps[-1].filename, steps[-1].lineno or 0) if steps else None


def _is_users(path: Path) -> bool:
    compiled = path.suffix == ".pyx"  # for example numpy's random generators
    others = compiled or _is_ours(path) or path.is_relative_to(_STANDARD_LIBRARY)
    return not (others or "site-packages" in path.parts or _is_no_file(path))


def _is_no_file(path: Path) -> bool:
    """Return whether this is the name of code that was made by `eval` or `exec`."""
    return str(path).startswith("<") or not path.name


def _is_ours(path: Path) -> bool:
    command = path.name == "mars2d"  # the file in bin/ that starts the command line
    return command or (
        path.is_relative_to(_PACKAGE) and not path.is_relative_to(_PACKAGE / "examples")
    )


def name_of(function: Callable[..., Any]) -> str:
    """Return the name of a function, also within a functools.partial, or of an object's class."""
    function = _whole(function)
    return str(getattr(function, "__name__", type(function).__name__))


def _whole(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return the function that a functools.partial calls; return any other unchanged."""
    while isinstance(function, functools.partial):
        function = function.func
    return function


def definition(function: Callable[..., Any]) -> str | None:
    """Return file and line of a function's definition.

    None if it is compiled, MARS2D's own, or made by `eval` or `exec`.
    """
    code = getattr(inspect.unwrap(_whole(function)), "__code__", None)
    if code is None or _is_ours(path := Path(code.co_filename)) or _is_no_file(path):
        return None
    return _place(code.co_filename, code.co_firstlineno)


def _place(filename: str, line: int) -> str:
    return f"{Path(filename).name}, line {line}"


# -- excerpts

CONTEXT_LINES = 2
"""Lines shown before and after the line that an error points at."""

MAX_LINE_LENGTH = 400
"""Longer lines are cut, characters."""


@dataclass(frozen=True, slots=True)
class Excerpt:
    """Some lines of a file, the first with the number `first`; an error points at line `line`."""

    file: Path
    line: int
    first: int
    lines: tuple[str, ...]

    def nearest(self, count: int) -> Excerpt:
        """Return at most `count` of the lines, around the one that the error points at."""
        before = self.line - self.first
        start = max(0, min(before - count // 2, len(self.lines) - count))
        return Excerpt(
            self.file, self.line, self.first + start, self.lines[start : start + max(count, 1)]
        )


def excerpt_of(error: BaseException, beside: Path | None = None) -> Excerpt | None:
    """Return the lines around the one that an error points at; None if that line is not known.

    beside: the experiment's file. It and its folder are searched if the error does not tell its
    file's folder, for example because a law returned something unusable.
    """
    stacks = _stacks(error)
    where = getattr(error, "where", None) or next(filter(None, map(users_line, stacks)), None)
    found = re.fullmatch(r"(.+), line (\d+)", where or "")
    if found is None:
        return None
    name, line = found[1], int(found[2])
    paths = [Path(step.filename) for stack in stacks for step in stack if step.lineno == line]
    if beside is not None:
        paths += [beside, beside.parent / name]
    excerpts = (_read(path, line) for path in paths if path.name == name)
    return next(filter(None, excerpts), None)


def _stacks(error: BaseException | None) -> list[traceback.StackSummary]:
    """Return the stacks of an error and of its causes, the first cause first."""
    chain: dict[int, BaseException] = {}
    while error is not None and id(error) not in chain:
        chain[id(error)] = error
        error = error.__cause__ or error.__context__
    return [_stack(step) for step in reversed(chain.values())]


def _stack(error: BaseException) -> traceback.StackSummary:
    stack = stack_of(error)
    if isinstance(error, SyntaxError) and error.filename:
        stack.append(traceback.FrameSummary(error.filename, error.lineno, "", lookup_line=False))
    return stack


def _read(path: Path, line: int) -> Excerpt | None:
    linecache.checkcache(str(path))
    lines = linecache.getlines(str(path))
    if not 1 <= line <= len(lines):
        return None
    first = max(1, line - CONTEXT_LINES)
    shown = [
        text.rstrip().expandtabs(4)[:MAX_LINE_LENGTH]
        for text in lines[first - 1 : line + CONTEXT_LINES]
    ]
    while len(shown) > line - first + 1 and not shown[-1]:
        del shown[-1]
    return Excerpt(path, line, first, tuple(shown))


@contextmanager
def quiet() -> Iterator[None]:
    """Let nothing be printed twice, and nobody be asked for input again."""
    with Path(os.devnull).open("w", encoding="utf-8") as nothing:
        stdin, sys.stdin = sys.stdin, io.StringIO()
        try:
            with redirect_stdout(nothing), redirect_stderr(nothing):
                yield
        finally:
            sys.stdin = stdin
