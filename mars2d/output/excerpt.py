"""The lines of the user's code around the one that an error points at."""

from __future__ import annotations

import linecache
import traceback
from dataclasses import dataclass
from pathlib import Path

from mars2d.core.usercode import users_line

CONTEXT_LINES = 2
"""Lines shown before and after the line that an error points at."""

MAX_CAUSES = 20
"""An error has no more causes, one of the other, that are looked at."""


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
    stacks: list[traceback.StackSummary] = []
    step: BaseException | None = error
    while step is not None and len(stacks) < MAX_CAUSES:
        stack = traceback.extract_tb(step.__traceback__)
        if isinstance(step, SyntaxError) and step.filename:
            stack.append(traceback.FrameSummary(step.filename, step.lineno, "", lookup_line=False))
        stacks, step = [stack, *stacks], step.__cause__ or step.__context__
    where = getattr(error, "where", None) or next(filter(None, map(users_line, stacks)), None)
    name, _, number = (where or "").partition(", line ")
    if not number.isdecimal():
        return None
    line = int(number)
    paths = [Path(step.filename) for stack in stacks for step in stack if step.lineno == line]
    if beside is not None:
        paths += [beside, beside.parent / name]
    excerpts = (_read(path, line) for path in paths if path.name == name)
    return next(filter(None, excerpts), None)


def _read(path: Path, line: int) -> Excerpt | None:
    linecache.checkcache(str(path))
    lines = linecache.getlines(str(path))
    if not 1 <= line <= len(lines):
        return None
    first = max(1, line - CONTEXT_LINES)
    shown = [text.rstrip().expandtabs(4) for text in lines[first - 1 : line + CONTEXT_LINES]]
    while len(shown) > line - first + 1 and not shown[-1]:
        del shown[-1]
    return Excerpt(path, line, first, tuple(shown))
