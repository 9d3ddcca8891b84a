"""The help: all keys in groups, laid out in columns, on several pages if need be."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from itertools import takewhile
from typing import NamedTuple

import pygame

from mars2d.output.raster.fonts import Fonts
from mars2d.output.raster.layout import Layout
from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.actions import Action

Groups = Iterable[tuple[str, Sequence[Action]]]
Named = tuple[tuple[str, tuple[Action, ...]], ...]

UNREADABLE = 0.2
"""The scale below which text is not drawn, pixels a point."""
LEGIBLE = 0.8
"""The scale below which the help is split into pages, pixels a point."""
LEGIBLE_SHARE = 0.62
"""The same as a share of the window's scale, so that large text stays rather large."""
SHARES = (0.9, 0.8, 0.7)
"""The scales that are tried, as shares of the window's."""
MAX_COLUMNS, MAX_PAGES = 3, 12
SIZE, ROW, LINE = 15.0, 33.0, 19.0
"""The heights of letters, of a row, and of each further line of a row, points."""
HEADING, GAP = 34.0, 12.0
"""The heights of a group's heading and of the gap above it, points."""
TOP, PAD, BETWEEN = 62.0, 28.0, 34.0
"""The height of the title, the margin, and the gap between two columns, points."""
MIN_WORDS, MAX_WORDS = 150.0, 380.0
"""The narrowest and the widest line of words, points."""


class _Row(NamedTuple):
    """The labels of a key and the lines of its help; without labels, a group's heading.

    caps: the room for the labels, pixels.
    """

    labels: tuple[str, ...]
    lines: Sequence[str]
    caps: int = 0

    @property
    def height(self) -> float:
        """Points."""
        return ROW + LINE * (len(self.lines) - 1) if self.labels else HEADING + GAP


class _Plan(NamedTuple):
    """Pages of columns of rows; ui: pixels a point; column: the width of all columns, pixels."""

    ui: float
    column: int
    pages: Sequence[Sequence[Sequence[_Row]]]


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
        named = tuple((heading, tuple(group)) for heading, group in groups)
        plan = _plan(painter.fonts, named, area.inflate(-16, -16).size, layout.ui)
        if plan is None:
            return
        ui, column, pages = plan
        self.pages, self.page = len(pages), min(self.page, len(pages) - 1)
        fonts, theme = painter.fonts, painter.theme
        draw_veil(surface, painter, area)
        pad, between = round(PAD * ui), round(BETWEEN * ui)
        title = f"Keys, page {self.page + 1} of {self.pages}" if self.pages > 1 else "Keys"
        word = "F1 goes on" if self.page + 1 < self.pages else "F1 closes this"
        head = fonts.width(title, 21 * ui, bold=True) + fonts.width(word, 14 * ui)
        width = max(len(columns) for columns in pages) * (column + between) - between + 2 * pad
        tallest = max(_height(rows) for columns in pages for rows in columns)
        high = round((TOP + tallest + PAD - 10) * ui)
        panel = pygame.Rect(0, 0, max(width, head + 3 * pad), high)
        panel.center = area.center
        painter.panel(surface, panel, theme.plate, 14 * ui, theme.edge)
        middle = panel.top + 34 * ui
        at, end = (panel.left + pad, middle), (panel.right - pad, middle)
        painter.write(surface, title, 21 * ui, theme.ink, bold=True, midleft=at)
        painter.write(surface, word, 14 * ui, theme.muted, midright=end)
        for k, rows in enumerate(pages[self.page]):
            left = panel.left + pad + k * (column + between)
            _draw_column(surface, painter, rows, left, panel.top + round(TOP * ui), plan)


def _draw_column(
    surface: pygame.Surface,
    painter: Painter,
    rows: Sequence[_Row],
    left: int,
    top: float,
    plan: _Plan,
) -> None:
    ui, theme, size = plan.ui, painter.theme, SIZE * plan.ui
    bottom = top - _raised(rows) * ui
    for row in rows:
        top, bottom = bottom, bottom + row.height * ui
        if not row.labels:
            at, ink = (left, bottom - HEADING * ui / 2), theme.running.ink
            painter.write(surface, row.lines[0], size, ink, bold=True, midleft=at)
            surface.fill(theme.edge, (left, round(bottom - 3 * ui), plan.column, 1))
            continue
        middle, x = round(top + ROW * ui / 2), left
        for name in row.labels:
            x = draw_cap(surface, painter, name, x, middle, ui)
        for k, line in enumerate(row.lines):
            at = (left + row.caps, middle + round(k * LINE * ui))
            painter.write(surface, line, size, theme.text, midleft=at)


# -- layout ---------------------------------------------------------------------------------------


@lru_cache(maxsize=4)
def _plan(fonts: Fonts, groups: Named, room: tuple[int, int], ui: float) -> _Plan | None:
    """Return the largest layout on one page, or on few pages if that is too small to read.

    room: width and height, pixels.
    """
    least = max(min(LEGIBLE, ui), LEGIBLE_SHARE * ui)
    sizes = [ui, *(share * ui for share in SHARES if share * ui > least), least]
    tried = [(1, size) for size in sizes] + [(count, least) for count in range(2, MAX_PAGES + 1)]
    for pages, size in tried:
        limit = room[1] / size - TOP - PAD + 10
        for count in range(1, MAX_COLUMNS + 1):
            column, rows = _rows(fonts, groups, room, count, size)
            columns = _even(rows, limit, pages * count)
            if columns:
                each = [columns[k : k + count] for k in range(0, len(columns), count)]
                return _Plan(size, column, each)
    return None if ui < UNREADABLE else _plan(fonts, groups, room, 0.8 * ui)


def _rows(
    fonts: Fonts, groups: Named, room: tuple[int, int], count: int, ui: float
) -> tuple[int, list[_Row]]:
    """Return the width of `count` columns, pixels, and all rows; none if columns are too narrow."""
    column = (room[0] - 2 * PAD * ui - (count - 1) * BETWEEN * ui) / count
    rows, widest = [], 0
    for heading, group in groups:
        rows.append(_Row((), (heading,)))
        caps = max(sum(cap_width(fonts, name, ui) for name in key.labels) for key in group)
        caps += round(10 * ui)
        words = min(column - caps, MAX_WORDS * ui)
        if words < MIN_WORDS * ui:
            return 0, []
        for key in group:
            lines = fonts.wrap(key.help, SIZE * ui, words, 4)
            rows.append(_Row(key.labels, lines, caps))
            widest = max(widest, caps + max(fonts.width(line, SIZE * ui) for line in lines))
    return widest, rows


def _even(rows: Sequence[_Row], limit: float, most: int) -> list[list[_Row]]:
    """Return at most so many columns up to a height, points, as even as can be; [] for none."""
    best: list[list[_Row]] = []
    height = limit
    while rows and len(columns := _filled(rows, height)) <= most:
        heights = [*map(_height, columns)]
        if max(heights) <= limit and (not best or min(heights) > min(map(_height, best))):
            best = columns
        height -= ROW / 2
    return best


def _filled(rows: Sequence[_Row], limit: float) -> list[list[_Row]]:
    """Return columns up to a height, points; a group is not split if a column can hold it."""
    columns: list[list[_Row]] = []
    for k, row in enumerate(rows):
        rest = takewhile(lambda other: other.labels, rows[k + 1 :])
        together = [row, *rest] if not row.labels else [row]
        if not columns or _height([*columns[-1], *together]) > limit:
            columns.append([])
        columns[-1].append(row)
    return columns


def _height(rows: Sequence[_Row]) -> float:
    return sum(row.height for row in rows) - _raised(rows)


def _raised(rows: Sequence[_Row]) -> float:
    """Return the gap that a heading does not need at the top of a column, points."""
    return GAP if rows and not rows[0].labels else 0.0


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
