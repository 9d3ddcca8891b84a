"""A question over the picture, which is answered by a line of text."""

from __future__ import annotations

from collections.abc import Callable

import pygame

from mars2d.core.errors import InputError
from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.text_field import TextField

WIDTH, SIZE = 380.0, 14.5
"""The width of the plate, and the height of letters, points."""


class Question:
    """Asks for a text while it is open: it takes all keys; Enter answers, Esc closes."""

    def __init__(self) -> None:
        """Start closed."""
        self.field: TextField | None = None
        self._title, self._error = "", ""
        self._answer: Callable[[str], object] = print

    def ask(self, title: str, given: str, answer: Callable[[str], object]) -> None:
        """Open with a text; answer: takes what is typed, and raises InputError to ask again."""
        self.field = TextField(given, opened_by_key=True)
        self.field.select_all()
        self._title, self._error, self._answer = title, "", answer

    def handle(self, event: pygame.Event) -> bool:
        """Handle an event; return whether it was for the question."""
        if self.field is None:
            return False
        name = pygame.key.name(event.key) if event.type == pygame.KEYDOWN else ""
        if name == "escape":
            self.field = None
        elif name in ("return", "enter"):
            try:
                self._answer(self.field.text)
            except InputError as error:
                self._error = str(error)
            else:
                self.field = None
        else:
            taken = self.field.handle(event)
            return taken or event.type in (pygame.KEYDOWN, pygame.KEYUP)
        return True

    def draw(self, surface: pygame.Surface, plot: pygame.Rect, painter: Painter) -> None:
        """Draw it at the upper edge of the picture."""
        if self.field is None:
            return
        ui, theme, pad = painter.ui, painter.theme, round(14 * painter.ui)
        width = round(min(WIDTH * ui, plot.width - 2 * pad))
        error = painter.fonts.wrap(self._error, 0.9 * SIZE * ui, width - 2 * pad, 3)
        lines = [line for line in error if line]
        plate = pygame.Rect(0, 0, width, round((76 + 18 * len(lines)) * ui))
        plate.midtop = plot.centerx, plot.top + pad
        painter.panel(surface, plate, theme.plate, 8 * ui, theme.selected)
        left, top = plate.left + pad, plate.top
        title = painter.fonts.shorten(self._title, SIZE * ui, width - 2 * pad, bold=True)
        painter.write(
            surface, title, SIZE * ui, theme.ink, bold=True, midleft=(left, top + 20 * ui)
        )
        box = pygame.Rect(left, top + round(36 * ui), width - 2 * pad, round(28 * ui))
        painter.panel(surface, box, theme.paper, 4 * ui, theme.key_edge)
        self.field.draw(surface, box.inflate(-pad, 0), painter, SIZE * ui)
        for k, line in enumerate(lines):
            at = left, top + (78 + 18 * k) * ui
            painter.write(surface, line, 0.9 * SIZE * ui, theme.error.ink, midleft=at)
