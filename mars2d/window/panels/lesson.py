"""The lesson: what an experiment asks, predicts and measures, as the docstring of its file says."""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence
from pathlib import Path

from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.window.panels.rows import Row, RowsPanel
from mars2d.window.widgets.words import Word

HEADINGS = re.compile(
    r"(?:^|(?<=[.?!)] ))(Question|Setting|Law(?: \([^)]*\))?|Prediction|Measured|Try|Play|Source): "
)
"""The words with which parts of a docstring begin."""
LINE, SIZE = 18.0, 13.0
"""The heights of a line and of its letters, points."""


class Lesson(RowsPanel):
    """Shows the docstring of an experiment's file, part by part.

    parts: their headings, "" for the first one, and their texts.
    """

    name, title = "lesson", "Lesson"

    def __init__(self, painter: Painter, path: Path | None) -> None:
        """Read a file; one without a docstring of several parts has no lesson."""
        super().__init__(painter)
        self.parts = parts_of(path)

    @property
    def offered(self) -> bool:
        """Whether there is a lesson."""
        return len(self.parts) > 1

    def rows(self, frame: Frame, width: float) -> Sequence[Row]:  # noqa: ARG002
        """Return the lines, each part under its heading."""
        theme, found = self.painter.theme, list[Row]()
        for heading, text in self.parts:
            found += self.wrapped(LINE, Word(heading, theme.ink, SIZE, bold=True), width)
            found += self.wrapped(LINE, Word(text, theme.text, SIZE), width)
        return found


def parts_of(path: Path | None) -> list[tuple[str, str]]:
    """Return the parts of the docstring of a Python file: headings and texts.

    >>> HEADINGS.split("Question: how far? Source: a book.")
    ['', 'Question', 'how far? ', 'Source', 'a book.']
    """
    if path is None or path.suffix != ".py":
        return []
    text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    first, *rest = HEADINGS.split(" ".join(text.split()))
    named = zip(rest[::2], rest[1::2], strict=True)
    parts = [(heading, text.strip()) for heading, text in (("", first), *named)]
    return [(heading, text[:1].upper() + text[1:]) for heading, text in parts]
