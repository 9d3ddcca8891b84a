"""Panels of the dock: plates with a title, a close button, and rows that scroll."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache, lru_cache, partial
from typing import Any

import pygame

from mars2d.output.raster.fonts import Fonts
from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.rows import (
    BAR,
    Row,
    Scroll,
    Word,
    columns,
    draw_rows,
    height_of,
    write_line,
)

Frame = Any
"""What panels show: the dock passes it on."""

DOT = "\N{BLACK CIRCLE}"
"""A word that stands for a robot, or for how something stands, by its colour."""
LINE = 18.0
"""The height of a row of words, points."""
NOTCH = 38.0
"""How far a notch of the wheel scrolls, points."""


class Panel:
    """A panel of the dock: `rows` that scroll, above a `foot` of rows that stay.

    To add one, derive a class that sets `name` and `title` and has `rows` (or `heights`, `draw` and
    `handle`, if its content is of another kind), and put it into the list of panels in `panels.py`.
    The dock does the rest: it finds a place, draws plate, title and close button, passes the mouse
    on, and remembers from one window to the next which panels were open.

    name: one word, by which the panel is opened and remembered. title: written at its top.
    frames: whether the arena moves aside when it opens or changes its size. wanted: whether it is
    to be open, or with how many plots, which need room. remembered: whether the next window opens
    it again. least: the least height of rows and foot, points. lacks: why there is nothing to show,
    or "". sought: the name of a row that is brought into view. places: where named rows were drawn.
    """

    name = ""
    title = ""
    frames = True
    remembered = True
    wanted: int = False
    least = 72.0
    lacks = sought = ""

    def __init__(self, painter: Painter) -> None:
        """Start closed, at the top."""
        self.painter, self.scroll = painter, Scroll()
        self.places: dict[str, pygame.Rect] = {}

    @property
    def is_open(self) -> bool:
        """Whether it is wanted, and there is something to show."""
        return bool(self.wanted) and not self.lacks

    def open(self) -> None:
        """Open it."""
        self.wanted = True

    def close(self) -> None:
        """Close it."""
        self.wanted = False

    # -- content --------------------------------------------------------------------------------

    def head(self, frame: Frame) -> tuple[Sequence[Word], Sequence[Word]]:  # noqa: ARG002
        """Return the words at its top, at the left and at the right."""
        return [Word(self.title, self.painter.theme.ink, 13.5, bold=True)], []

    def rows(self, frame: Frame, width: float) -> Sequence[Row]:
        """Return the rows of now; width: points."""
        raise NotImplementedError

    def foot(self, width: float) -> Sequence[Row]:  # noqa: ARG002
        """Return the rows below, which do not scroll; width: points."""
        return ()

    def heights(self, frame: Frame, width: float) -> tuple[float, float]:
        """Return the least and the wanted height of the content at a width, points.

        The least height may depend only on what the user has chosen, not on what happens in the
        run: else the arena would change its size while it is watched.
        """
        wanted = height_of(self.rows(frame, width)) + height_of(self.foot(width))
        return self.least, max(self.least, wanted)

    def draw(self, surface: pygame.Surface, rect: pygame.Rect, frame: Frame) -> None:
        """Draw the content within a rectangle, which is at least as high as the least height.

        It is called for each picture, 60 times a second: what is costly should be kept.
        """
        ui, width = self.painter.ui, rect.width / self.painter.ui
        rows, foot = self.rows(frame, width), self.foot(width)
        area = rect.copy()
        area.height -= round(height_of(foot) * ui)
        self.scroll.fit(height_of(rows) * ui, area.height)
        beside = area.copy()
        if self.scroll.cut:  # the bar takes some of the width
            rows = self.rows(frame, width - BAR)
            beside.width -= round(BAR * ui)
        names, self.sought, sought = [row.name for row in rows], "", self.sought
        number = names.index(sought) if sought and sought in names else None
        seen = self.scroll.seen([row.height * ui for row in rows], beside, number)
        self.places = {names[k]: place for k, place in seen if names[k]}
        for k, place in seen:
            rows[k].draw(surface, place)
        self.scroll.draw_bar(surface, self.painter, area)
        draw_rows(surface, foot, pygame.Rect(area.bottomleft, rect.size), ui)

    def handle(self, event: pygame.Event) -> bool:
        """Handle an event of the mouse within the panel; return whether a drag has begun.

        Presses and turns of the wheel are those within the panel, positions are pixels of the
        window. After a press that returned True, all moves of the mouse come here, until the
        button is released; else only those over the panel do.
        """
        if event.type == pygame.MOUSEWHEEL:
            self.scroll.at -= event.y * NOTCH * self.painter.ui
        return False

    # -- rows of words --------------------------------------------------------------------------

    def line(
        self, left: Sequence[Word] = (), right: Sequence[Word] = (), high: float = LINE
    ) -> Row:
        """Return a row of words from both ends."""
        return Row(high, lambda surface, rect: write_line(surface, rect, self.painter, left, right))

    def table(self, lines: Sequence[Sequence[Sequence[Word]]]) -> list[Row]:
        """Return a row for each line of cells, in letters as large as all lines have room for.

        The first cell of a line is at the left. The others stand at the right, each below those of
        the lines above; where there are fewer, the first ones are missing.
        """
        laid_out = cache(partial(columns, self.painter, lines))

        def draw(
            line: Sequence[Sequence[Word]], surface: pygame.Surface, rect: pygame.Rect
        ) -> None:
            ends, sized = laid_out(rect.width)
            for cell, end in zip(line[1:], ends[-len(line) + 1 :], strict=True):
                place = pygame.Rect(rect.left, rect.top, end, rect.height)
                write_line(surface, place, self.painter, right=[*map(sized, cell)])
            write_line(surface, rect, self.painter, [*map(sized, line[0])])

        return [Row(LINE, partial(draw, line)) for line in lines]

    def rule(self, high: float) -> Row:
        """Return a line across the panel, with a gap above and below."""
        color = self.painter.theme.edge
        return Row(high, lambda on, at: on.fill(color, (at.left, at.centery, at.width, 1)))

    def gap(self, high: float) -> Row:
        """Return an empty row."""
        return self.line(high=high)

    def wrapped(self, word: Word, width: float, most: int = 100) -> Iterator[Row]:
        """Yield the lines of a text; most: as many as they are at most."""
        ui, fonts = self.painter.ui, self.painter.fonts
        for each in _lines(fonts, word.text, word.size * ui, width * ui, most) if word.text else ():
            yield self.line([word._replace(text=each)])


@lru_cache(maxsize=256)
def _lines(fonts: Fonts, text: str, size: float, room: float, most: int) -> list[str]:
    return fonts.wrap(text, size, room, most)
