"""The lesson: what an experiment asks, predicts and measures, as the docstring of its file says."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.scenario.code_file import lesson_of
from mars2d.window.widgets.panel import Panel
from mars2d.window.widgets.rows import Row, Word


class Lesson(Panel):
    """Shows the docstring of an experiment's file, part by part.

    parts: their headings, "" for the first one, and their texts.
    """

    name, title = "lesson", "Lesson"

    def __init__(self, painter: Painter, path: Path | None) -> None:
        """Read a file; one without a docstring of several parts has no lesson."""
        super().__init__(painter)
        self.parts = lesson_of(path)
        if len(self.parts) < 2:
            self.lacks = "this file has no lesson: a docstring with Question: and the like"

    def rows(self, frame: Frame, width: float) -> Sequence[Row]:  # noqa: ARG002
        """Return the lines, each part under its heading."""
        theme, found = self.painter.theme, list[Row]()
        for heading, text in self.parts:
            found += self.wrapped(Word(heading, theme.ink, bold=True), width)
            found += self.wrapped(Word(text, theme.text), width)
        return found
