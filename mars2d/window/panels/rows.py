"""Panels that are lists of rows, which scroll where there is no room for all of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import pygame

from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.window.widgets.dock import Panel
from mars2d.window.widgets.words import Word, write_line

DOT = "\N{BLACK CIRCLE}"
"""A word that stands for a robot, or for how something stands, by its colour."""
NOTCH, BAR, THUMB = 38.0, 8.0, 4.0
"""How far a notch of the wheel scrolls, the room for the bar that shows where, and its width,
points."""


class Row(NamedTuple):
    """A row of a panel: its height [points], and the function that draws it in its place."""

    height: float
    draw: Callable[[pygame.Surface, pygame.Rect], object]


class RowsPanel(Panel):
    """A panel of `rows` that scroll, above a `foot` of rows that stay.

    least: the least height of both, points. scroll: how far they are scrolled, points. cut: whether
    there was no room for all when they were drawn last. room: for them then, points.
    """

    least = 72.0
    scroll = room = 0.0
    cut = False

    def __init__(self, painter: Painter) -> None:
        """Start at the top."""
        self.painter = painter

    def rows(self, frame: Frame, width: float) -> Sequence[Row]:
        """Return the rows of now; width: points."""
        raise NotImplementedError

    def foot(self, width: float) -> Sequence[Row]:  # noqa: ARG002
        """Return the rows below, which do not scroll; width: points."""
        return ()

    def heights(self, frame: Frame, width: float) -> tuple[float, float]:
        """Return the least and the wanted height of the content at a width, points."""
        wanted = _high(self.rows(frame, width)) + _high(self.foot(width))
        return min(self.least, wanted), wanted

    def handle(self, event: pygame.Event) -> bool:
        """Scroll by the wheel."""
        if event.type == pygame.MOUSEWHEEL:
            self.scroll -= event.y * NOTCH
        return False

    def draw(self, surface: pygame.Surface, rect: pygame.Rect, frame: Frame) -> None:
        """Draw the rows for which there is room, where they are scrolled to."""
        ui, width = self.painter.ui, rect.width / self.painter.ui
        rows, foot = self.rows(frame, width), self.foot(width)
        room = pygame.Rect(rect.topleft, (rect.width, rect.height - round(_high(foot) * ui)))
        self.room = room.height / ui
        self.cut = _high(rows) > self.room + 2
        if self.cut:  # the bar takes some of the width
            rows = self.rows(frame, width - BAR)
        whole = _high(rows)
        self.scroll = min(max(self.scroll, 0.0), max(0.0, whole - self.room))
        clip = surface.get_clip()
        surface.set_clip(room.clip(clip))
        wide = room.width - self.cut * round(BAR * ui)
        area = pygame.Rect(room.topleft, (wide, room.height))
        self._draw_rows(surface, rows, area, room.top - self.scroll * ui)
        if self.cut:
            self._draw_bar(surface, room, whole)
        surface.set_clip(clip)
        self._draw_rows(surface, foot, rect, room.bottom)

    def _draw_rows(
        self, surface: pygame.Surface, rows: Sequence[Row], area: pygame.Rect, top: float
    ) -> None:
        """Draw rows from a height on, as far as they are seen in an area."""
        for row in rows:
            high = row.height * self.painter.ui
            place = pygame.Rect(area.left, round(top), area.width, round(high))
            top += high
            if place.bottom > area.top and place.top < area.bottom:
                row.draw(surface, place)

    def _draw_bar(self, surface: pygame.Surface, room: pygame.Rect, whole: float) -> None:
        ui = self.painter.ui
        height = max(round(20 * ui), round(room.height * self.room / whole))
        thumb = pygame.Rect(0, 0, round(THUMB * ui), height)
        share = self.scroll / (whole - self.room)
        thumb.topright = room.right, room.top + round(share * (room.height - height))
        self.painter.panel(surface, thumb, self.painter.theme.track, thumb.width / 2)

    # -- rows of words --------------------------------------------------------------------------

    def line(
        self,
        height: float,
        left: Sequence[Word] = (),
        right: Sequence[Word] = (),
        ends: Sequence[tuple[float, Sequence[Word]]] = (),
    ) -> Row:
        """Return a row of words from both ends; ends: of columns, in parts of the width."""

        def draw(surface: pygame.Surface, rect: pygame.Rect) -> None:
            write_line(surface, rect, self.painter, left, right)
            for end, words in ends:
                column = pygame.Rect(rect.topleft, (round(end * rect.width), rect.height))
                write_line(surface, column, self.painter, right=words)

        return Row(height, draw)

    def wrapped(self, height: float, word: Word, width: float, most: int = 100) -> Iterator[Row]:
        """Yield the lines of a text; most: as many as they are at most."""
        ui, (text, color, size, bold) = self.painter.ui, word
        for each in self.painter.fonts.wrap(text, size * ui, width * ui, most) if text else ():
            yield self.line(height, [Word(each, color, size, bold)])

    def stack(self, *rows: Row) -> Row:
        """Return rows that stay together as one."""
        return Row(
            _high(rows),
            lambda surface, rect: self._draw_rows(surface, rows, rect, rect.top),
        )


def _high(rows: Sequence[Row]) -> float:
    return sum(row.height for row in rows)
