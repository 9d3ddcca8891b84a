"""The help: all keys in groups, laid out in columns, on several pages if need be."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

import pygame

from mars2d.output.raster.fonts import Fonts
from mars2d.output.raster.layout import Layout
from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.actions import Action

Groups = Iterable[tuple[str, Sequence[Action]]]
Named = tuple[tuple[str, tuple[Action, ...]], ...]

SHARES = (1.0, 0.9, 0.8, 0.7)
"""The scales that are tried until all is on one page, as shares of the window's."""
SIZE, ROW, LINE = 15.0, 33.0, 19.0
"""The heights of letters, of a row, and of each further line of a row, points."""
HEADING = 42.0
"""The height of a group's heading, points."""
TOP, PAD, BETWEEN = 62.0, 28.0, 34.0
"""The height of the title, the margin, and the gap between two columns, points."""
CAPS, WORDS = 114.0, (150.0, 390.0)
"""The room for keys, and the narrowest and widest line of words, points."""


class _Row(NamedTuple):
    """The labels of a key and the lines of its help; without labels, a group's heading."""

    labels: tuple[str, ...]
    lines: Sequence[str]

    @property
    def height(self) -> float:
        """Points."""
        return ROW + LINE * (len(self.lines) - 1) if self.labels else HEADING


class Help:
    """The help of a window; page: the open page, from 0, or None if it is closed.

    pages: how many there were when it was last drawn.
    """

    def __init__(self) -> None:
        """Start closed."""
        self.page: int | None = None
        self.pages = 1

    @property
    def is_open(self) -> bool:
        """Whether a page is open."""
        return self.page is not None

    def turn(self) -> None:
        """Open the help, turn the page, or close it after the last page."""
        page = 0 if self.page is None else self.page + 1
        self.page = page if page < self.pages else None

    def close(self) -> None:
        """Close the help."""
        self.page = None

    def draw(
        self, surface: pygame.Surface, layout: Layout, painter: Painter, groups: Groups
    ) -> None:
        """Draw the open page over the picture, if there is one.

        groups: pairs of a heading and its keys.
        """
        if self.page is None:
            return
        top = layout.header.bottom
        area = pygame.Rect(0, top, surface.get_width(), surface.get_height() - top)
        fonts, theme = painter.fonts, painter.theme
        named = tuple((heading, tuple(group)) for heading, group in groups)
        high = area.height - round(16 * layout.ui)
        ui, width, pages = _laid_out(fonts, named, (area.width, high), layout.ui)
        self.pages, self.page = len(pages), min(self.page, len(pages) - 1)
        draw_veil(surface, painter, area)
        pad, step = round(PAD * ui), width + round(BETWEEN * ui)
        tallest = max(sum(row.height for row in rows) for page in pages for rows in page)
        panel = pygame.Rect(0, 0, len(pages[0]) * step + pad, 0)
        panel.height = min(high, round((TOP + tallest + PAD) * ui))
        panel.center = area.center
        painter.panel(surface, panel, theme.plate, 14 * ui, theme.edge)
        title = f"Keys, page {self.page + 1} of {self.pages}" if self.pages > 1 else "Keys"
        word = "F1 goes on" if self.page + 1 < self.pages else "F1 closes this"
        middle = panel.top + 34 * ui
        at, end = (panel.left + pad, middle), (panel.right - pad, middle)
        painter.write(surface, title, 21 * ui, theme.ink, bold=True, midleft=at)
        painter.write(surface, word, 14 * ui, theme.muted, midright=end)
        for k, rows in enumerate(pages[self.page]):
            corner = panel.left + pad + k * step, panel.top + round(TOP * ui)
            _draw_column(surface, painter, rows, pygame.Rect(corner, (width, 0)), ui)


@lru_cache(maxsize=4)
def _laid_out(
    fonts: Fonts, groups: Named, room: tuple[int, int], largest: float
) -> tuple[float, int, list[list[list[_Row]]]]:
    """Return the scale, the width of a column, and the columns of each page.

    room: width and height, pixels. largest: the scale of the window, pixels a point.
    """
    for ui in (share * largest for share in SHARES):
        wide, (least, most) = room[0] - 2 * PAD * ui, WORDS
        count = min(3, max(1, int((wide / ui + BETWEEN) / (CAPS + least + BETWEEN))))
        column = min(CAPS + most, (wide / ui + BETWEEN) / count - BETWEEN) * ui
        rows = _rows(fonts, groups, column, ui)
        columns = [*_filled(rows, room[1] / ui - TOP - PAD)]
        if len(columns) <= count:
            break
    return ui, round(column), [columns[k : k + count] for k in range(0, len(columns), count)]


def _rows(fonts: Fonts, groups: Named, column: float, ui: float) -> Iterator[_Row]:
    for heading, group in groups:
        yield _Row((), (heading,))
        for key in group:
            words = column - max(CAPS * ui, _caps(fonts, key.labels, ui))
            yield _Row(key.labels, fonts.wrap(key.help, SIZE * ui, words, 4))


def _filled(rows: Iterable[_Row], limit: float) -> Iterator[list[_Row]]:
    """Yield columns of rows up to a height, points; no heading stands last."""
    column: list[_Row] = []
    left = limit
    for row in rows:
        if column and row.height + ROW * (not row.labels) > left:
            yield column
            column, left = [], limit
        column.append(row)
        left -= row.height
    yield column


def _draw_column(
    surface: pygame.Surface, painter: Painter, rows: Sequence[_Row], place: pygame.Rect, ui: float
) -> None:
    theme, size, bottom = painter.theme, SIZE * ui, float(place.top)
    for row in rows:
        top, bottom = bottom, bottom + row.height * ui
        if not row.labels:
            at, ink = (place.left, bottom - 16 * ui), theme.running.ink
            painter.write(surface, row.lines[0], size, ink, bold=True, midleft=at)
            surface.fill(theme.edge, (place.left, round(bottom - 3 * ui), place.width, 1))
            continue
        middle, x = round(top + ROW * ui / 2), place.left
        for name in row.labels:
            x = draw_cap(surface, painter, name, x, middle, ui)
        left = place.left + max(CAPS * ui, _caps(painter.fonts, row.labels, ui))
        for k, line in enumerate(row.lines):
            beside = left, middle + round(k * LINE * ui)
            painter.write(surface, line, size, theme.text, midleft=beside)


def _caps(fonts: Fonts, labels: Iterable[str], ui: float) -> float:
    """Return the room for the caps of keys, pixels."""
    return sum(cap_width(fonts, name, ui) for name in labels) + 10 * ui


def draw_veil(surface: pygame.Surface, painter: Painter, area: pygame.Rect) -> None:
    """Draw a veil over a part of the surface that does not take the mouse now."""
    veil = pygame.Surface(area.size, 0, 32)
    veil.fill(painter.theme.veil)
    veil.set_alpha(150 if painter.theme.dark else 70)
    surface.blit(veil, area)


def cap_width(fonts: Fonts, text: str, ui: float) -> int:
    """Return the width of a key's cap with the gap beside it, pixels."""
    width = fonts.width(text, 14 * ui, bold=True) + round(18 * ui)
    return max(width, round(30 * ui)) + round(6 * ui)


def draw_cap(
    surface: pygame.Surface, painter: Painter, text: str, x: int, y: int, ui: float
) -> int:
    """Draw a key's cap; return where the next one begins."""
    theme = painter.theme
    width = cap_width(painter.fonts, text, ui)
    plate = pygame.Rect(x, 0, width - round(6 * ui), round(26 * ui))
    plate.centery = y
    painter.panel(surface, plate.move(0, round(2 * ui)), theme.key_edge, 6 * ui)
    painter.panel(surface, plate, theme.key, 6 * ui, theme.key_edge)
    painter.write(surface, text, 14 * ui, theme.text, bold=True, center=plate.center)
    return x + width
