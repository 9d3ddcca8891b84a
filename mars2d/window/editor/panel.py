"""The panel at the right of the drawing: rows of properties, most of which can be changed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import pygame

from mars2d.output.raster.painter import Painter

WIDTH, MAX_SHARE = 268.0, 0.34
"""The panel's width, points, and at most this share of the window."""
ROW, SIZE, PAD = 26.0, 14.0, 14.0
"""The height of a row and of its letters, and the margin, points."""


class Row(NamedTuple):
    """A row of the panel.

    act: called with the pixel below the row when it is clicked; None for a row that only says
    something. step: called with 1 or -1 by the buttons + and - of a number. color: of a dot beside
    the value. level: how far the title is indented. kind: "field", "title" or "warning".
    """

    title: str
    value: str = ""
    act: Callable[[tuple[int, int]], None] | None = None
    step: Callable[[int], None] | None = None
    color: str = ""
    level: int = 0
    kind: str = "field"


class Panel:
    """A column of rows; the wheel scrolls to those that do not fit."""

    def __init__(self, painter: Painter) -> None:
        """Start with nothing drawn."""
        self._painter = painter
        self._rows: list[tuple[Row, pygame.Rect]] = []
        self._signs: list[tuple[Row, int, pygame.Rect]] = []
        self._first = 0
        self.area = pygame.Rect(0, 0, 0, 0)

    @staticmethod
    def width(size: tuple[int, int], ui: float) -> int:
        """Return its width in a window of `size` pixels."""
        return round(min(WIDTH * ui, MAX_SHARE * size[0]))

    @property
    def places(self) -> dict[str, pygame.Rect]:
        """The places of the rows that can be clicked, by their titles."""
        return {row.title: place for row, place in self._rows if row.act is not None}

    @property
    def signs(self) -> dict[str, pygame.Rect]:
        """The places of the buttons + and -, by their sign and the title of their row."""
        return {f"{'+' if way > 0 else '-'} {row.title}": at for row, way, at in self._signs}

    def click(self, pixel: tuple[int, int]) -> None:
        """Do the action of the row or button at a pixel."""
        for row, way, place in self._signs:
            if row.step is not None and place.collidepoint(pixel):
                row.step(way)
                return
        for row, place in self._rows:
            if row.act is not None and place.collidepoint(pixel):
                row.act(place.bottomleft)

    def scroll(self, notches: float) -> None:
        """Scroll by notches of the wheel."""
        self._first = max(0, self._first - round(notches))

    def draw(
        self,
        surface: pygame.Surface,
        area: pygame.Rect,
        rows: Sequence[Row],
        pointer: tuple[int, int],
    ) -> None:
        """Draw the rows in an area."""
        painter, theme, ui = self._painter, self._painter.theme, self._painter.ui
        self.area, self._rows, self._signs = area, [], []
        surface.fill(theme.bar, area)
        surface.fill(theme.edge, (area.left, area.top, 1, area.height))
        height, pad = round(ROW * ui), round(PAD * ui)
        room = max(1, (area.height - pad) // height)
        self._first = min(self._first, max(0, len(rows) - room))
        for k, row in enumerate(rows[self._first : self._first + room]):
            top = area.top + pad // 2 + k * height
            place = pygame.Rect(area.left + pad // 2, top, area.width - pad, height)
            self._rows.append((row, place))
            if row.act is not None and place.collidepoint(pointer):
                painter.panel(surface, place, theme.key, 5 * ui)
            self._draw_row(surface, row, place, pointer)
        if len(rows) > self._first + room:
            foot = (area.centerx, area.bottom)
            painter.write(surface, "▾", SIZE * ui, theme.muted, midbottom=foot)

    def _draw_row(
        self, surface: pygame.Surface, row: Row, place: pygame.Rect, pointer: tuple[int, int]
    ) -> None:
        painter, theme, ui = self._painter, self._painter.theme, self._painter.ui
        fonts, size, pad = painter.fonts, SIZE * ui, round(0.5 * PAD * ui)
        right = place.right - pad
        if row.step is not None:
            right = self._draw_signs(surface, row, place, pointer)
        bold = row.kind == "title"
        ink = {"title": theme.ink, "warning": theme.waiting.ink}.get(row.kind, theme.muted)
        left = place.left + pad + round(12 * ui) * row.level
        room = right - left
        value = fonts.shorten(row.value, size, 0.62 * room) if row.value else ""
        end = (right, place.centery)
        at = painter.write(surface, value, size, theme.ink, midright=end)
        edge = at.left if value else right
        if row.color:
            dot = pygame.Rect(0, 0, round(13 * ui), round(13 * ui))
            dot.midright = edge - round(6 * ui), place.centery
            painter.panel(surface, dot, theme.shade(row.color), dot.width / 2)
            edge = dot.left
        title = fonts.shorten(row.title, size, edge - left - round(8 * ui) * bool(value), bold=bold)
        painter.write(surface, title, size, ink, bold=bold, midleft=(left, place.centery))

    def _draw_signs(
        self, surface: pygame.Surface, row: Row, place: pygame.Rect, pointer: tuple[int, int]
    ) -> int:
        """Draw the buttons + and - of a number; return where its value ends."""
        painter, theme, ui = self._painter, self._painter.theme, self._painter.ui
        side, right = round(0.8 * place.height), place.right
        for way, sign in ((1, "+"), (-1, "\N{MINUS SIGN}")):
            key = pygame.Rect(0, 0, side, side)
            key.midright = right, place.centery
            if place.collidepoint(pointer):
                edge = theme.selected if key.collidepoint(pointer) else theme.key_edge
                painter.panel(surface, key, theme.bar, 4 * ui, edge)
            painter.write(surface, sign, SIZE * ui, theme.muted, center=key.center)
            self._signs.append((row, way, key))
            right = key.left - round(2 * ui)
        return right - round(2 * ui)
