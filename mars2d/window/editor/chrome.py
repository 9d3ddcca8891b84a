"""What surrounds the drawing: the header with its buttons, and prompts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import pygame

from mars2d.core.errors import Mars2dError
from mars2d.output.raster.layout import Layout
from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.actions import Action, label_of
from mars2d.window.widgets.help import cap_width, draw_cap, draw_veil
from mars2d.window.widgets.text_field import TextField

BUTTONS = 0.5
"""The share of the header in which buttons begin; the rest is for the title."""


class Header:
    """A bar with the title, and buttons of actions at the right; those that are lit stand out."""

    def __init__(self, painter: Painter, actions: Sequence[Action]) -> None:
        """Start with nothing drawn."""
        self._painter, self._actions = painter, actions
        self._places: list[tuple[str, pygame.Rect]] = []

    def at(self, pixel: tuple[int, int]) -> str | None:
        """Return the action of the button at a pixel, if there is one."""
        return next((name for name, place in self._places if place.collidepoint(pixel)), None)

    def draw(
        self,
        surface: pygame.Surface,
        bar: pygame.Rect,
        title: str,
        note: str,
        pointer: tuple[int, int],
    ) -> None:
        """Draw the header; note: muted text after the title."""
        painter, theme, ui = self._painter, self._painter.theme, self._painter.ui
        fonts, pad = painter.fonts, round(20 * ui)
        surface.fill(theme.bar, bar)
        surface.fill(theme.edge, (bar.left, bar.bottom - 1, bar.width, 1))
        right, self._places = bar.right - pad, []
        for action in reversed(self._actions):
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
            self._places.append((action.name, place))
            right = place.left - round(8 * ui)
        room = right - 2 * pad - fonts.width(note, 14 * ui) - 12 * ui
        title = fonts.shorten(title, 20 * ui, room, bold=True)
        at = (bar.left + pad, bar.centery)
        place = painter.write(surface, title, 20 * ui, theme.ink, bold=True, midleft=at)
        if room > 0:
            beside = (place.right + 12 * ui, bar.centery + 2 * ui)
            painter.write(surface, note, 14 * ui, theme.muted, midleft=beside)


class Answer(NamedTuple):
    """A way to answer a prompt: a key, by its label, or its button.

    act: takes the text that was typed; if it raises Mars2dError, the error is shown and the prompt
    stays open.
    """

    label: str
    words: str
    act: Callable[[str], None]


class Prompt:
    """A question at the foot of the window, over which nothing else can be done.

    Esc closes it without an answer. field: to type in, if there is one. doc: says more about it.
    places: where the buttons of the answers were drawn, by their words.
    """

    def __init__(
        self,
        label: str,
        *answers: Answer,
        field: TextField | None = None,
        doc: str = "",
        escape: str = "cancel",
    ) -> None:
        """Open the prompt; escape: what Esc does, in words."""
        self.label, self.field, self.doc = label, field, doc
        self.error, self.open = "", True
        self._answers = [*answers, Answer("Esc", escape, lambda _: None)]
        self.places: dict[str, pygame.Rect] = {}

    def handle(self, event: pygame.Event) -> None:
        """Handle an event: each is for the prompt."""
        answer = self._answered(event)
        if answer is None:
            if self.field is not None and self.field.handle(event):
                self.error = ""
            return
        self.open = False  # unless the answer opens it again
        try:
            answer.act("" if self.field is None else self.field.text)
        except Mars2dError as error:
            self.open, self.error = True, str(error)

    def _answered(self, event: pygame.Event) -> Answer | None:
        """Return the answer of a key or a button, if an event is one."""
        if event.type == pygame.KEYDOWN:
            pressed = label_of(event)
            return next((each for each in self._answers if each.label == pressed), None)
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == pygame.BUTTON_LEFT:
            places = self.places
            hit = (a for a in self._answers if places[a.words].collidepoint(event.pos))
            return next(hit, None) if places else None
        return None

    def draw(self, surface: pygame.Surface, layout: Layout, painter: Painter) -> None:
        """Draw it in place of the footer, and a veil over all above."""
        theme, ui, fonts = painter.theme, painter.ui, painter.fonts
        pad, row = round(20 * ui), round(40 * ui)
        plate = pygame.Rect(0, 0, surface.get_width(), (3 if self.error else 2) * row)
        plate.bottom = layout.footer.bottom
        draw_veil(surface, painter, pygame.Rect(0, 0, plate.width, plate.top))
        surface.fill(theme.waiting.pale, plate)
        surface.fill(theme.waiting.ink, (plate.left, plate.top, plate.width, max(1, round(2 * ui))))
        if self.error:
            above = pygame.Rect(plate.topleft, (plate.width, row))
            surface.fill(theme.error.pale, above)
            short = fonts.shorten(self.error, 15 * ui, plate.width - 2 * pad, bold=True)
            at = (pad, above.centery)
            painter.write(surface, short, 15 * ui, theme.error.ink, bold=True, midleft=at)
        middle, ink = plate.bottom - row - row // 2, theme.waiting.ink
        place = painter.write(surface, self.label, 16 * ui, ink, bold=True, midleft=(pad, middle))
        if self.field is not None:
            box = pygame.Rect(place.right + pad // 2, 0, 0, round(30 * ui))
            box.width, box.centery = max(plate.right - pad - box.left, row), middle
            painter.panel(surface, box, theme.paper, 5 * ui, theme.selected)
            self.field.draw(surface, box.inflate(-round(18 * ui), 0), painter, 16 * ui)
        right = self._draw_buttons(surface, plate.right - pad, plate.bottom - row // 2, painter)
        doc, at = fonts.shorten(self.doc, 14 * ui, right - 2 * pad), (pad, plate.bottom - row // 2)
        painter.write(surface, doc, 14 * ui, theme.text, midleft=at)

    def _draw_buttons(
        self, surface: pygame.Surface, right: int, middle: int, painter: Painter
    ) -> int:
        """Draw the answers with their keys, up to a pixel at the right; return where they begin."""
        ui, fonts, theme = painter.ui, painter.fonts, painter.theme
        self.places = {}
        for label, words, _ in reversed(self._answers):
            caps = sum(cap_width(fonts, each, ui) for each in label.split())
            wide = fonts.width(words, 14 * ui) + caps + 16 * ui
            place = pygame.Rect(0, 0, round(wide), round(34 * ui))
            place.midright = right, middle
            painter.panel(surface, place, theme.plate, 6 * ui, theme.key_edge)
            x = place.left + round(5 * ui)
            for each in label.split():
                x = draw_cap(surface, painter, each, x, middle, ui)
            painter.write(surface, words, 14 * ui, theme.ink, midleft=(x + 2 * ui, middle))
            self.places[words] = place
            right = place.left - round(8 * ui)
        return right
