"""The lines of the user's code that an error points at."""

from __future__ import annotations

import linecache
import re
import traceback
from dataclasses import dataclass
from pathlib import Path

from mars2d.core.usercode import users_line

__all__ = ["Excerpt", "excerpt_of"]

AROUND = 2
"""Lines before and after the one it is about."""
LONGEST = 400
"""Characters of a line."""


@dataclass(frozen=True, slots=True)
class Excerpt:
    """Some lines of a file, the first of which has the number `first`; `line` is the one meant."""

    file: Path
    line: int
    first: int
    lines: tuple[str, ...]

    def nearest(self, count: int) -> Excerpt:
        """Return at most `count` lines, those about the one that is meant."""
        before = self.line - self.first
        start = max(0, min(before - count // 2, len(self.lines) - count))
        return Excerpt(
            self.file, self.line, self.first + start, self.lines[start : start + max(count, 1)]
        )


def excerpt_of(error: BaseException, beside: Path | None = None) -> Excerpt | None:
    """Return the lines round the one that an error points at; None where that is not known.

    beside: the experiment's file; it, and what lies beside it, is looked into where the error does
    not tell its file's folder, as when a law returned what can't be used.
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
    """Return where an error and what led to it were raised, that which came first at first."""
    chain: list[BaseException] = []
    while error is not None and error not in chain:
        chain.insert(0, error)
        error = error.__cause__ or error.__context__
    return [_stack(step) for step in chain]


def _stack(error: BaseException) -> traceback.StackSummary:
    stack = traceback.extract_tb(error.__traceback__)
    if isinstance(error, SyntaxError) and error.filename:
        stack.append(traceback.FrameSummary(error.filename, error.lineno, "", lookup_line=False))
    return stack


def _read(path: Path, line: int) -> Excerpt | None:
    linecache.checkcache(str(path))
    lines = linecache.getlines(str(path))
    if not 1 <= line <= len(lines):
        return None
    first = max(1, line - AROUND)
    shown = [text.rstrip().expandtabs(4)[:LONGEST] for text in lines[first - 1 : line + AROUND]]
    while len(shown) > line - first + 1 and not shown[-1]:
        del shown[-1]
    return Excerpt(path, line, first, tuple(shown))
