"""The lesson: what an experiment asks, predicts and measures, as the docstring of its file says."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pygame

from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.window.widgets.dock import Panel
from mars2d.window.widgets.words import Word, write_line

HEADINGS = re.compile(
    r"(?:^|(?<=[.?!)] ))(Question|Setting|Law(?: \([^)]*\))?|Prediction|Measured|Try|Play|Source): "
)
"""The words with which parts of a docstring begin."""
LINE, SIZE = 18.0, 13.0
"""The heights of a line and of its letters, points."""
LEAST_LINES = 4
"""The lines that are seen at least."""


class Lesson(Panel):
    """Shows the docstring of an experiment's file, part by part; the wheel turns to the rest.

    parts: their headings, "" for the first one, and their texts.
    """

    name, title = "lesson", "Lesson"

    def __init__(self, painter: Painter, path: Path | None) -> None:
        """Read a file; one without a docstring of several parts has no lesson."""
        self.painter, self.parts = painter, parts_of(path)
        self._first = 0

    @property
    def offered(self) -> bool:
        """Whether there is a lesson."""
        return len(self.parts) > 1

    def heights(self, frame: Frame, width: float) -> tuple[float, float]:  # noqa: ARG002
        """Return the least and the wanted height at a width, points."""
        lines = len(self._lines(width * self.painter.ui))
        return min(lines, LEAST_LINES) * LINE, lines * LINE

    def handle(self, event: pygame.Event) -> bool:
        """Turn to other lines by the wheel."""
        if event.type == pygame.MOUSEWHEEL:
            self._first -= event.y
        return False

    def draw(self, surface: pygame.Surface, rect: pygame.Rect, frame: Frame) -> None:  # noqa: ARG002
        """Draw as many lines as there is room for."""
        high, lines = round(LINE * self.painter.ui), self._lines(rect.width)
        room = max(rect.height // high, 1)
        self._first = min(max(self._first, 0), max(len(lines) - room, 0))
        for k, word in enumerate(lines[self._first : self._first + room]):
            line = pygame.Rect(rect.left, rect.top + k * high, rect.width, high)
            write_line(surface, line, self.painter, [word])

    def _lines(self, width: float) -> list[Word]:
        """Return the lines at a width, pixels."""
        theme, ui, found = self.painter.theme, self.painter.ui, []
        for heading, text in self.parts:
            if heading:
                found.append(Word(heading, theme.ink, SIZE, bold=True))
            lines = self.painter.fonts.wrap(text, SIZE * ui, width, 100)
            found += [Word(line, theme.text, SIZE) for line in lines]
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
