"""The tool bar: one button for each tool, and one for the grid that things snap to."""

from __future__ import annotations

import pygame

from mars2d.output.raster.painter import Painter
from mars2d.window.editor.chrome import draw_plate
from mars2d.window.editor.icons import draw_icon
from mars2d.window.editor.keys import TOOLS, VIEW
from mars2d.window.keys import Key

__all__ = ["WIDTH", "Toolbar"]

WIDTH = 58.0
"""How wide it is, points."""

SIDE, GAP = 46.0, 2.0
(SNAP,) = (key for key in VIEW if key.action == "snap")


class Toolbar:
    """Buttons from top to bottom at the left of the window."""

    def __init__(self, painter: Painter) -> None:
        """Draw with a painter."""
        self._painter = painter
        self._places: list[tuple[Key, pygame.Rect]] = []

    def arrange(self, area: pygame.Rect, ui: float) -> None:
        """Lay the buttons out in an area; smaller where they would not fit."""
        count = len(TOOLS) + 1.6
        side = min(SIDE * ui, (area.height - 12 * ui) / count - GAP * ui)
        side = round(max(side, 8))
        x = area.centerx - side // 2
        step = side + round(GAP * ui)
        top = area.top + round(6 * ui)
        self._places = [
            (key, pygame.Rect(x, top + i * step, side, side)) for i, key in enumerate(TOOLS)
        ]
        low = top + round((len(TOOLS) + 0.25) * step)
        self._places.append((SNAP, pygame.Rect(x, low, side, side)))

    def at(self, pixel: tuple[int, int]) -> Key | None:
        """Return the key whose button lies at a pixel."""
        return next((key for key, place in self._places if place.collidepoint(pixel)), None)

    def draw(
        self,
        surface: pygame.Surface,
        area: pygame.Rect,
        chosen: str,
        pointer: tuple[int, int],
        *,
        snaps: bool,
        step: str,
    ) -> None:
        """Draw all buttons; chosen: the tool in use; step: that of the grid, in words."""
        painter, theme = self._painter, self._painter.theme
        surface.fill(theme.bar, area)
        surface.fill(theme.edge, (area.right - 1, area.top, 1, area.height))
        for key, place in self._places:
            on = snaps if key is SNAP else key.action == chosen
            hover = place.collidepoint(pointer)
            if on or hover:
                fill = theme.running.pale if on else theme.key
                edge = theme.selected if on else theme.key_edge
                painter.panel(surface, place, fill, 0.18 * place.width, edge)
            draw_icon(surface, painter, key.action, place)
            size = 0.23 * place.width
            color = theme.running.ink if on else theme.muted
            letter = painter.fonts.render(key.labels[0], size, color, bold=True)
            corner = (place.right - 0.09 * place.width, place.bottom - 0.05 * place.width)
            surface.blit(letter, letter.get_rect(bottomright=(round(corner[0]), round(corner[1]))))
        _, place = self._places[-1]
        words = painter.fonts.render(step if snaps else "free", 0.26 * place.width, theme.text)
        surface.blit(words, words.get_rect(midtop=(place.centerx, place.bottom + 2)))

    def draw_tip(
        self, surface: pygame.Surface, pointer: tuple[int, int], bounds: pygame.Rect
    ) -> None:
        """Say what the button beneath the pointer is for."""
        gap = round(10 * self._painter.ui)
        for key, place in self._places:
            if place.collidepoint(pointer):
                words, beside = key.help[0].upper() + key.help[1:], place.move(gap, 0).midright
                draw_plate(surface, self._painter, [words], bounds, midleft=beside)
