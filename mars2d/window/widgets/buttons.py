"""Bars of buttons with icons, and their tooltips."""

from __future__ import annotations

import io
from collections.abc import Sequence
from functools import lru_cache
from math import ceil

import pygame

from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.actions import Action
from mars2d.window.widgets.rows import Pixel
from mars2d.window.widgets.slider import draw_tooltip

SIDE, GAP = 36.0, 2.0
"""A button's side, and the gap between two, points."""
BREAK = 0.35
"""The gap between two groups, in sides."""
ICON = 0.56
"""An icon's side, in sides of its button."""
LABELLED, LABEL = 100.0, 13.0
"""The width of a column from which on buttons have labels, and the height of their letters,
points."""

SVG = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 24 24" width="24" height="24"><path '
    'fill="none" stroke="{}" stroke-width="2" stroke-linecap="round" stroke-linejoin="round" '
    'd="{}"/></svg>'
)


class Buttons:
    """A row or column of buttons in groups, each for an action.

    side: of the largest buttons, points. lettered: whether they show the letters of their keys.
    """

    def __init__(
        self, groups: Sequence[Sequence[Action]], *, side: float = SIDE, lettered: bool = False
    ) -> None:
        """Start with nothing drawn."""
        self._groups, self._side, self._lettered = groups, side, lettered
        self._actions = {action.name: action for group in groups for action in group}
        self.places: dict[str, pygame.Rect] = {}
        self._upright = self._labelled = False

    def at(self, pixel: Pixel) -> str | None:
        """Return the name of the button at a pixel, if there is one."""
        return next((name for name, at in self.places.items() if at.collidepoint(pixel)), None)

    def handle(self, event: pygame.Event) -> bool:
        """Handle a press of the left mouse button on a button; return whether there was one."""
        pressed = event.type == pygame.MOUSEBUTTONDOWN and event.button == pygame.BUTTON_LEFT
        name = self.at(event.pos) if pressed else None
        act = None if name is None else self._actions[name].act
        if act is not None:
            act()
        return name is not None

    def draw(
        self,
        surface: pygame.Surface,
        area: pygame.Rect,
        painter: Painter,
        pointer: Pixel | None,
    ) -> None:
        """Draw all buttons along the longer side of an area."""
        self._arrange(area, painter.ui)
        theme = painter.theme
        for name, place in self.places.items():
            action = self._actions[name]
            on, hover = action.lit, pointer is not None and place.collidepoint(pointer)
            if on or hover:
                fill = theme.running.pale if on else theme.key
                edge = theme.selected if on else theme.key_edge
                painter.panel(surface, place, fill, 0.18 * place.height, edge)
            icon = action.lit_icon if action.lit_icon and on else action.icon
            ink = theme.running.ink if on else theme.text
            square = pygame.Rect(place.topleft, (place.height, place.height))
            draw_icon(surface, icon, ink, square)
            if self._labelled:
                size, at = LABEL * painter.ui, (square.right + 3 * painter.ui, place.centery)
                painter.write(surface, action.title, size, ink, midleft=at)
            if self._lettered:
                size, color = 0.25 * place.width, theme.running.ink if on else theme.muted
                at, key = place.move(-3, -2).bottomright, action.labels[0]
                painter.write(surface, key, size, color, bold=True, bottomright=at)

    def draw_tip(self, surface: pygame.Surface, painter: Painter, pointer: Pixel | None) -> None:
        """Draw the tooltip of the button under the pointer."""
        name = None if pointer is None else self.at(pointer)
        if name is None:
            return
        place, gap = self.places[name], round(6 * painter.ui)
        beside = place.inflate(2 * gap, 2 * gap)
        at = {"midleft": beside.midright} if self._upright else {"midbottom": beside.midtop}
        draw_tooltip(surface, painter, self._actions[name].tip, **at)

    def _arrange(self, area: pygame.Rect, ui: float) -> None:
        """Lay out the buttons in an area: in several columns or smaller if they would not fit."""
        upright = self._upright = area.height > area.width
        long, thick = (area.height, area.width) if upright else (area.width, area.height)
        gap = round(GAP * ui)

        def side_in(lanes: int) -> int:
            rows = sum(ceil(len(group) / lanes) for group in self._groups)
            each = long / (rows + BREAK * len(self._groups)) - gap
            return round(max(8, min(self._side * ui, (thick - gap) / lanes - gap, each)))

        self._labelled = upright and thick >= LABELLED * ui
        every = (1,) if self._labelled else (1, 2, 3)
        lanes = max(every, key=lambda lanes: (side_in(lanes), -lanes))
        side = side_in(lanes)
        along, first = round(0.5 * BREAK * side) + gap, (thick - lanes * (side + gap) + gap) // 2
        self.places = {}
        for group in self._groups:
            for k, action in enumerate(group):
                x, y = first + k % lanes * (side + gap), along + k // lanes * (side + gap)
                x, y = (x, y) if upright else (y, x)
                place = pygame.Rect(area.left + x, area.top + y, side, side)
                if self._labelled:
                    place.update(area.left + gap, area.top + y, thick - 3 * gap, side)
                self.places[action.name] = place
            along += ceil(len(group) / lanes) * (side + gap) + round(BREAK * side)


def draw_icon(surface: pygame.Surface, path: str, color: str, place: pygame.Rect) -> None:
    """Draw an icon, the path of an SVG picture, in the middle of a rectangle."""
    image = _icon(path, color, max(4, round(ICON * place.width)))
    surface.blit(image, image.get_rect(center=place.center))


@lru_cache(maxsize=256)
def _icon(path: str, color: str, side: int) -> pygame.Surface:
    picture = io.BytesIO(SVG.format(color, path).encode())
    return pygame.image.load_sized_svg(picture, (side, side))
