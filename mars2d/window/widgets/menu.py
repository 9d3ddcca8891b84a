"""Menus over the picture: of layers to show, of actions on a body."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import pygame

from mars2d.output.raster.painter import Painter

ROW, PAD, BOX = 30.0, 8.0, 15.0
"""The height of an entry, the margin, and the side of a tick box, points."""
SIZE = 14.5
"""The height of letters, points."""
TICK = [(0.22, 0.52), (0.42, 0.74), (0.80, 0.26)]


class Entry(NamedTuple):
    """An entry of a menu.

    act: its effect; None for a title. key: the key that has the same effect. on: whether its tick
    box is ticked; None for none. color: of a dot before the title, or "".
    """

    title: str
    act: Callable[[], None] | None = None
    key: str = ""
    on: bool | None = None
    color: str = ""


class Menu:
    """A list of entries on a plate. One with tick boxes stays open until it is closed."""

    def __init__(self) -> None:
        """Start closed."""
        self._entries: Callable[[], Sequence[Entry]] | None = None
        self.corner = 0, 0
        self._places: list[tuple[Entry, pygame.Rect]] = []
        self.plate = pygame.Rect(0, 0, 0, 0)
        self.name = ""

    @property
    def is_open(self) -> bool:
        """Whether it is open."""
        return self._entries is not None

    @property
    def places(self) -> dict[str, pygame.Rect]:
        """The places of the entries that can be chosen, by their titles."""
        return {entry.title: place for entry, place in self._places if entry.act is not None}

    def open(
        self, name: str, entries: Callable[[], Sequence[Entry]], corner: tuple[int, int]
    ) -> None:
        """Open it at a pixel; entries: returns those of now."""
        self.name, self._entries, self.corner = name, entries, corner

    def close(self) -> None:
        """Close it."""
        self.name, self._entries, self._places = "", None, []
        self.plate = pygame.Rect(0, 0, 0, 0)

    def handle(self, event: pygame.Event) -> bool:
        """Handle a press of a mouse button; return whether the menu took it."""
        if not self.is_open or event.type != pygame.MOUSEBUTTONDOWN:
            return False
        if not self.plate.collidepoint(event.pos):
            self.close()
            return False
        chosen = next((e for e, place in self._places if place.collidepoint(event.pos)), None)
        if chosen is not None and chosen.act is not None:
            if chosen.on is None:
                self.close()
            chosen.act()
        return True

    def draw(
        self,
        surface: pygame.Surface,
        bounds: pygame.Rect,
        painter: Painter,
        pointer: tuple[int, int] | None,
    ) -> None:
        """Draw it within bounds, if it is open."""
        if self._entries is None:
            return
        entries = self._entries()
        self._arrange(entries, bounds, painter)
        theme, ui = painter.theme, painter.ui
        painter.panel(surface, self.plate, theme.plate, 8 * ui, theme.key_edge)
        for entry, place in self._places:
            if entry.act is not None and pointer is not None and place.collidepoint(pointer):
                painter.panel(surface, place, theme.key, 5 * ui)
            self._draw_entry(surface, entry, place, painter)

    def _arrange(self, entries: Sequence[Entry], bounds: pygame.Rect, painter: Painter) -> None:
        ui, fonts = painter.ui, painter.fonts
        pad = round(PAD * ui)
        row = round(min(ROW * ui, (bounds.height - 2 * pad) / max(len(entries), 1)))
        titles = max(
            fonts.width(entry.title, SIZE * ui, bold=entry.act is None) for entry in entries
        )
        keys = max(fonts.width(entry.key, SIZE * ui) for entry in entries)
        boxed = any(entry.on is not None or entry.color for entry in entries)
        boxes = round((BOX + 9) * ui) if boxed else 0
        width = titles + boxes + (keys + round(24 * ui) if keys else 0) + 4 * pad
        self.plate = pygame.Rect(self.corner, (width, row * len(entries) + 2 * pad))
        self.plate.clamp_ip(bounds)
        self._places = [
            (entry, pygame.Rect(self.plate.left + pad, self.plate.top + pad + k * row,
                                width - 2 * pad, row))
            for k, entry in enumerate(entries)
        ]  # fmt: skip

    def _draw_entry(
        self, surface: pygame.Surface, entry: Entry, place: pygame.Rect, painter: Painter
    ) -> None:
        ui, fonts, theme = painter.ui, painter.fonts, painter.theme
        pad = round(PAD * ui)
        left = place.left + pad
        if entry.on is not None:
            side = round(BOX * ui)
            box = pygame.Rect(left, 0, side, side)
            box.centery = place.centery
            fill, edge = (theme.selected,) * 2 if entry.on else (theme.plate, theme.muted)
            painter.panel(surface, box, fill, 3 * ui, edge)
            if entry.on:
                tick = [(box.left + x * side, box.top + y * side) for x, y in TICK]
                pygame.draw.lines(
                    surface, theme.plate, closed=False, points=tick, width=max(2, round(2 * ui))
                )
            left = box.right + round(9 * ui)
        elif entry.color:
            side = round(BOX * ui)
            dot = pygame.Rect(left, 0, side, side)
            dot.centery = place.centery
            painter.panel(surface, dot, theme.shade(entry.color), side / 2)
            left = dot.right + round(9 * ui)
        title = entry.act is None
        words = fonts.render(
            entry.title, SIZE * ui, theme.muted if title else theme.ink, bold=title
        )
        surface.blit(words, words.get_rect(midleft=(left, place.centery)))
        key = fonts.render(entry.key, SIZE * ui, theme.muted)
        surface.blit(key, key.get_rect(midright=(place.right - pad, place.centery)))
