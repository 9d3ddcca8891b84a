"""The header above the drawing, with its buttons."""

from __future__ import annotations

import pygame

from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.buttons import Buttons

BUTTONS = 0.5
"""The share of the header in which buttons begin; the rest is for the title."""


class Header(Buttons):
    """A bar with the title, and buttons of actions at the right; those that are lit stand out."""

    def draw_bar(
        self,
        surface: pygame.Surface,
        bar: pygame.Rect,
        painter: Painter,
        title: str,
        note: str,
        pointer: tuple[int, int],
    ) -> None:
        """Draw the header; note: muted text after the title."""
        theme, ui = painter.theme, painter.ui
        fonts, pad = painter.fonts, round(20 * ui)
        surface.fill(theme.bar, bar)
        surface.fill(theme.edge, (bar.left, bar.bottom - 1, bar.width, 1))
        right, self.places = bar.right - pad, {}
        for name, action in reversed(self._actions.items()):
            if right < (1 - BUTTONS) * bar.width:
                break  # the keys have all of them
            first, works = action.lit, action.works
            color = theme.running.ink if first else theme.text if works else theme.key_edge
            wide = fonts.width(action.title, 15 * ui, bold=first) + 22 * ui
            place = pygame.Rect(0, 0, round(wide), round(32 * ui))
            place.midright = (right, bar.centery)
            hover = place.collidepoint(pointer)
            fill = theme.running.pale if first or (hover and works) else theme.key
            edge = theme.selected if hover and works else theme.key_edge
            painter.panel(surface, place, fill, 7 * ui, edge)
            painter.write(surface, action.title, 15 * ui, color, bold=first, center=place.center)
            self.places[name] = place
            right = place.left - round(8 * ui)
        room = right - 2 * pad - fonts.width(note, 14 * ui) - 12 * ui
        title = fonts.shorten(title, 20 * ui, room, bold=True)
        at = (bar.left + pad, bar.centery)
        place = painter.write(surface, title, 20 * ui, theme.ink, bold=True, midleft=at)
        if room > 0:
            beside = (place.right + 12 * ui, bar.centery + 2 * ui)
            painter.write(surface, note, 14 * ui, theme.muted, midleft=beside)
