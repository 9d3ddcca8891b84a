"""Rows one below the other, which scroll: what panels, menus and the help are lists of."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Sequence
from itertools import accumulate
from math import ceil, floor
from typing import NamedTuple

import pygame

from mars2d.output.raster.painter import Painter

Pixel = tuple[int, int]

GAP = 8.0
"""The gap between two words, points."""
STEP = 8.0
"""What the widths of a table's columns are multiples of, points."""
BAR, THUMB = 8.0, 4.0
"""The room for the bar that shows how far something is scrolled, and its width, points."""


class Word(NamedTuple):
    """A word or more, and how it is written; size: of letters, points."""

    text: str
    color: str
    size: float = 12.5
    bold: bool = False


class Row(NamedTuple):
    """A row: its height [points], what draws it in its place, and the name to find it by."""

    height: float
    draw: Callable[[pygame.Surface, pygame.Rect], object]
    name: str = ""


class Scroll:
    """How far something is scrolled that may be longer than its room, pixels.

    room, whole: what is seen and what there is, when it was drawn last.
    """

    at = room = whole = 0.0

    @property
    def cut(self) -> bool:
        """Whether there is no room for all."""
        return self.whole > self.room + 2

    def fit(self, whole: float, room: float) -> None:
        """Scroll no further than to the end."""
        self.whole, self.room = whole, room
        self.at = max(0.0, min(self.at, whole - room))

    def bring(self, top: float, bottom: float) -> None:
        """Scroll as little as need be for a part to be seen."""
        self.at = max(min(self.at, top), bottom - self.room)

    def seen(
        self, heights: Sequence[float], area: pygame.Rect, sought: int | None = None
    ) -> list[tuple[int, pygame.Rect]]:
        """Return the numbers and places of rows that are seen whole, the first one at the top.

        heights: pixels. sought: a row that is to be one of them.
        """
        tops = [0.0, *accumulate(heights)]
        self.fit(tops[-1], area.height)
        if sought is not None:
            self.bring(tops[sought], tops[sought + 1])
        first = bisect_left(tops, self.at - 1, hi=max(len(heights) - 1, 0))
        found = []
        for k in range(first, len(heights)):
            top, bottom = (round(each - tops[first]) for each in tops[k : k + 2])
            if bottom > area.height + 1 and k > first:
                break
            found.append((k, pygame.Rect(area.left, area.top + top, area.width, bottom - top)))
        return found

    def draw_bar(self, surface: pygame.Surface, painter: Painter, area: pygame.Rect) -> None:
        """Draw a bar at the right of an area that shows which part is seen, if it is not all."""
        if self.cut:
            ui, room = painter.ui, area.height
            height = max(round(20 * ui), round(room * self.room / self.whole))
            thumb = pygame.Rect(0, 0, round(THUMB * ui), height)
            share = self.at / (self.whole - self.room)
            thumb.topright = area.right, area.top + round(share * (room - height))
            painter.panel(surface, thumb, painter.theme.track, thumb.width / 2)


def write_line(
    surface: pygame.Surface,
    rect: pygame.Rect,
    painter: Painter,
    left: Sequence[Word] = (),
    right: Sequence[Word] = (),
) -> pygame.Rect:
    """Write words from both ends of a rectangle, in its middle; return what is free between.

    Those at the left are shortened where there is no room for them, or left out.
    """
    gap, free = round(GAP * painter.ui), rect.copy()
    for text, color, size, bold in reversed(right):
        place = painter.write(
            surface, text, size * painter.ui, color, bold=bold, midright=free.midright
        )
        free.width = place.left - gap - free.left
    for text, color, size, bold in left:
        short = painter.fonts.shorten(text, size * painter.ui, max(free.width, 0), bold=bold)
        if painter.fonts.width(short, size * painter.ui, bold=bold) > free.width:
            break
        place = painter.write(
            surface, short, size * painter.ui, color, bold=bold, midleft=free.midleft
        )
        free.width, free.left = free.right - place.right - gap, place.right + gap
    return free


def width_of(painter: Painter, words: Sequence[Word]) -> float:
    """Return the width of words on a line with the gaps behind them, pixels."""
    width, ui = painter.fonts.width, painter.ui
    return sum(width(word.text, word.size * ui, bold=word.bold) + GAP * ui for word in words)


def columns(
    painter: Painter, lines: Sequence[Sequence[Sequence[Word]]], room: int
) -> tuple[Sequence[float], Callable[[Word], Word]]:
    """Return where the columns after the first one end, and the words in letters that fit.

    lines: of cells, as for `Panel.table`. room: the width, pixels.
    """
    ui, count, first = painter.ui, max(map(len, lines)) - 1, 0.0
    wide, sizes = [0.0] * count, [[width_of(painter, cell) for cell in line] for line in lines]
    for size in sizes:
        for k, each in enumerate(size[:0:-1], 1):  # by steps, since numbers change as they are read
            wide[-k] = max(wide[-k], ceil(each / (STEP * ui)) * STEP * ui)
    for label, *cells in sizes:
        skipped = next((k for k, each in enumerate(cells) if each), len(cells))
        first = max(first, label - sum(wide[: count - len(cells) + skipped]))
    share, spare = min(1.0, room / (first + sum(wide))), max(0.0, room - first - sum(wide))
    ends = [share * (first + end) for end in accumulate(each + spare / count for each in wide)]

    def sized(word: Word) -> Word:
        return word if share == 1 else word._replace(size=floor(share * word.size * ui) / ui)

    return ends, sized


def draw_rows(surface: pygame.Surface, rows: Sequence[Row], rect: pygame.Rect, ui: float) -> None:
    """Draw rows one below the other, from the top of a rectangle on."""
    place = rect.copy()
    for row in rows:
        place.height = round(row.height * ui)
        row.draw(surface, place)
        place.top = place.bottom


def height_of(rows: Sequence[Row]) -> float:
    """Return the height of rows together, points."""
    return sum(row.height for row in rows)


def minus(text: str) -> str:
    """Return a text with true minus signs in place of hyphens."""
    return text.replace("-", "\N{MINUS SIGN}")
