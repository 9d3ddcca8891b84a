"""The help: all keys in groups, laid out in columns, on several pages if need be."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

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
MAX_COLUMNS = 3
SIZE, ROW, LINE = 15.0, 33.0, 19.0
"""The heights of letters, of a row, and of each further line of a row, points."""
HEADING, GAP = 34.0, 12.0
"""The heights of a group's heading and of the gap above it, points."""
TOP, PAD, BETWEEN = 62.0, 28.0, 34.0
"""The height of the title, the margin, and the gap between two columns, points."""
MIN_WORDS, MAX_WORDS = 150.0, 380.0
"""The narrowest and the widest line of words, points."""


@dataclass(frozen=True, slots=True)
class _Row:
    """The labels of a key and the lines of its help; without labels, a group's heading.

    caps: the room for the labels, pixels. first: whether it is the top row of a column.
    """

    labels: tuple[str, ...]
    lines: tuple[str, ...]
    caps: int = 0
    first: bool = False

    @property
    def height(self) -> float:
        """Points."""
        if not self.labels:
            return HEADING + (0.0 if self.first else GAP)
        return ROW + LINE * (len(self.lines) - 1)


@dataclass(frozen=True, slots=True)
class _Plan:
    """Pages of columns of rows; ui: pixels a point; column: the width of all columns, pixels."""

    ui: float
    column: int
    pages: tuple[tuple[tuple[_Row, ...], ...], ...]


class Help:
    """The help of a window; page: the open page, from 0, or None if it is closed."""

    def __init__(self) -> None:
        """Start closed."""
        self.page: int | None = None
        self._pages = 1  # when it was last drawn

    @property
    def is_open(self) -> bool:
        """Whether a page is open."""
        return self.page is not None

    def turn(self) -> None:
        """Open the help, turn the page, or close it after the last page."""
        page = 0 if self.page is None else self.page + 1
        self.page = page if page < self._pages else None

    def close(self) -> None:
        """Close the help."""
        self.page = None

    def draw(
        self, surface: pygame.Surface, layout: Layout, painter: Painter, groups: Groups
    ) -> None:
        """Draw the open page, if there is one; groups: pairs of a heading and its keys."""
        if self.page is not None:
            self._pages = draw_help(surface, layout, painter, groups, self.page)
            self.page = min(self.page, self._pages - 1)


def draw_help(
    surface: pygame.Surface,
    layout: Layout,
    painter: Painter,
    groups: Groups,
    page: int = 0,
) -> int:
    """Draw a page of help over the picture, and return the number of pages.

    groups: pairs of a heading and its keys. page: a number beyond the last page means the last.
    """
    top = layout.header.bottom
    area = pygame.Rect(0, top, surface.get_width(), surface.get_height() - top)
    named = tuple((heading, tuple(group)) for heading, group in groups)
    plan = _plan(painter.fonts, named, area.inflate(-16, -16).size, layout.ui)
    if plan is None:
        return 1
    page = min(page, len(plan.pages) - 1)
    columns = plan.pages[page]
    ui, fonts, theme = plan.ui, painter.fonts, painter.theme
    veil = pygame.Surface(area.size, 0, 32)
    veil.fill(theme.veil)
    veil.set_alpha(150 if theme.dark else 70)
    surface.blit(veil, area)
    column = plan.column
    pad, between = round(PAD * ui), round(BETWEEN * ui)
    width = max(len(part) for part in plan.pages) * (column + between) - between + 2 * pad
    tallest = max(_height(rows) for part in plan.pages for rows in part)
    several = len(plan.pages) > 1
    title = f"Keys, page {page + 1} of {len(plan.pages)}" if several else "Keys"
    word = "F1 goes on" if page + 1 < len(plan.pages) else "F1 closes this"
    head = fonts.width(title, 21 * ui, bold=True) + fonts.width(word, 14 * ui)
    width = max(width, head + 3 * pad)
    panel = pygame.Rect(0, 0, width, round((TOP + tallest + PAD - 10) * ui))
    panel.center = area.center
    painter.panel(surface, panel, theme.plate, 14 * ui, theme.edge)
    image = fonts.render(title, 21 * ui, theme.ink, bold=True)
    middle = panel.top + round(34 * ui)
    surface.blit(image, image.get_rect(midleft=(panel.left + pad, middle)))
    image = fonts.render(word, 14 * ui, theme.muted)
    surface.blit(image, image.get_rect(midright=(panel.right - pad, middle)))
    for k, rows in enumerate(columns):
        left = panel.left + pad + k * (column + between)
        _draw_column(surface, painter, rows, left, panel.top + round(TOP * ui), plan)
    return len(plan.pages)


def _draw_column(
    surface: pygame.Surface,
    painter: Painter,
    rows: Sequence[_Row],
    left: int,
    top: float,
    plan: _Plan,
) -> None:
    ui, fonts, theme = plan.ui, painter.fonts, painter.theme
    for row in rows:
        bottom = top + row.height * ui
        if not row.labels:
            image = fonts.render(row.lines[0], SIZE * ui, theme.running.ink, bold=True)
            surface.blit(image, image.get_rect(midleft=(left, round(bottom - HEADING * ui / 2))))
            foot = round(bottom - 3 * ui)
            surface.fill(theme.edge, (left, foot, plan.column, 1))
        else:
            middle, x = round(top + ROW * ui / 2), left
            for name in row.labels:
                x = draw_cap(surface, painter, name, x, middle, ui)
            for k, line in enumerate(row.lines):
                image = fonts.render(line, SIZE * ui, theme.text)
                place = image.get_rect(midleft=(left + row.caps, middle))
                surface.blit(image, place.move(0, round(k * LINE * ui)))
        top = bottom


# -- layout ---------------------------------------------------------------------------------------


@lru_cache(maxsize=4)
def _plan(fonts: Fonts, groups: Named, room: tuple[int, int], ui: float) -> _Plan | None:
    """Return the largest layout on one page, or on several pages if that is too small to read.

    room: width and height, pixels.
    """
    least = max(min(LEGIBLE, ui), LEGIBLE_SHARE * ui)
    counts = range(1, MAX_COLUMNS + 1)
    plans = [_one_page(fonts, groups, room, count, ui, least) for count in counts]
    best = max((plan for plan in plans if plan), key=lambda plan: plan.ui, default=None)
    if best is not None:
        return best
    plans = [_several_pages(fonts, groups, room, count, least) for count in counts]
    paged = min((plan for plan in plans if plan), key=lambda plan: len(plan.pages), default=None)
    return paged or _one_page(fonts, groups, room, 1, least, UNREADABLE)


def _one_page(
    fonts: Fonts, groups: Named, room: tuple[int, int], count: int, ui: float, least: float
) -> _Plan | None:
    """Return the largest page of `count` columns, at `ui` to `least` pixels a point, or None."""
    while ui >= least:
        made = _columns(fonts, groups, room, count, ui)
        if made is not None:
            column, rows = made
            parts = _split(rows, count, room[1] / ui - TOP - PAD + 10)
            if parts is not None:
                return _Plan(ui, column, (parts,))
        ui *= 0.97
    return None


def _several_pages(
    fonts: Fonts, groups: Named, room: tuple[int, int], count: int, ui: float
) -> _Plan | None:
    """Return pages of `count` columns that are filled one after the other, or None."""
    made = _columns(fonts, groups, room, count, ui)
    limit = room[1] / ui - TOP - PAD + 10
    if made is None:
        return None
    column, rows = made
    columns = _filled(rows, limit)
    if any(_height(rows) > limit for rows in columns):
        return None
    pages = tuple(columns[k : k + count] for k in range(0, len(columns), count))
    return _Plan(ui, column, pages)


def _columns(
    fonts: Fonts, groups: Named, room: tuple[int, int], count: int, ui: float
) -> tuple[int, list[_Row]] | None:
    """Return the width of the columns, pixels, and all rows; None if columns are too narrow."""
    column = (room[0] - 2 * PAD * ui - (count - 1) * BETWEEN * ui) / count
    rows, widest = [], 0
    for heading, group in groups:
        rows.append(_Row((), (heading,)))
        caps = max(sum(cap_width(fonts, name, ui) for name in key.labels) for key in group)
        caps += round(10 * ui)
        words = min(column - caps, MAX_WORDS * ui)
        if words < MIN_WORDS * ui:
            return None
        for key in group:
            lines = fonts.wrap(key.help, SIZE * ui, words, 4)
            rows.append(_Row(key.labels, tuple(lines), caps))
            widest = max(widest, caps + max(fonts.width(line, SIZE * ui) for line in lines))
    return widest, rows


def _split(rows: Sequence[_Row], count: int, limit: float) -> tuple[tuple[_Row, ...], ...] | None:
    """Return the rows in at most `count` columns of similar height; None if they don't fit."""
    low, high = 0.0, limit
    best = _filled(rows, high)
    if len(best) > count or any(_height(column) > high for column in best):
        return None
    for _ in range(12):
        middle = (low + high) / 2
        columns = _filled(rows, middle)
        if len(columns) <= count and all(_height(column) <= middle for column in columns):
            best, high = columns, middle
        else:
            low = middle
    return best


def _filled(rows: Sequence[_Row], limit: float) -> tuple[tuple[_Row, ...], ...]:
    """Return columns up to a height, points; a group is not split if a column can hold it."""
    groups: list[list[_Row]] = []
    for row in rows:
        if not row.labels:
            groups.append([])
        groups[-1].append(row)
    columns: list[list[_Row]] = [[]]
    for group in groups:
        if columns[-1] and _height([*columns[-1], *group]) > limit:
            columns.append([])
        for k, row in enumerate(group):
            last = [row, *group[k + 1 : k + 2]] if not row.labels else [row]  # no lone headings
            if columns[-1] and _height([*columns[-1], *last]) > limit:
                columns.append([])
            columns[-1].append(replace(row, first=not columns[-1]))
    return tuple(tuple(column) for column in columns)


def _height(rows: Sequence[_Row]) -> float:
    return sum(row.height for row in rows)


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
    image = painter.fonts.render(text, 14 * ui, theme.text, bold=True)
    surface.blit(image, image.get_rect(center=plate.center))
    return x + width
