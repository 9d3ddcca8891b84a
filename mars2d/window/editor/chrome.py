"""What surrounds the drawing: the header with its buttons, the footer, prompts, plates of text."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import pygame

from mars2d.core.errors import Mars2dError
from mars2d.output.raster.layout import Layout
from mars2d.output.raster.painter import Painter

MAX_TYPED = 200
"""How many characters can be typed into a prompt."""


class Button(NamedTuple):
    """A button of the header.

    first: whether it is emphasized. works: whether it does anything now.
    """

    action: str
    words: str
    first: bool = False
    works: bool = True


class Header:
    """A bar with the title, and buttons at the right."""

    def __init__(self, painter: Painter) -> None:
        """Start with nothing drawn."""
        self._painter = painter
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
        buttons: Sequence[Button],
        pointer: tuple[int, int],
    ) -> None:
        """Draw the header; note: muted text after the title."""
        painter, theme, ui = self._painter, self._painter.theme, self._painter.ui
        fonts, pad = painter.fonts, round(20 * ui)
        surface.fill(theme.bar, bar)
        surface.fill(theme.edge, (bar.left, bar.bottom - 1, bar.width, 1))
        right, self._places = bar.right - pad, []
        for name, words, first, works in reversed(buttons):
            color = theme.running.ink if first else theme.text if works else theme.key_edge
            text = fonts.render(words, 15 * ui, color, bold=first)
            place = pygame.Rect(0, 0, text.get_width() + round(22 * ui), round(32 * ui))
            place.midright = (right, bar.centery)
            hover = place.collidepoint(pointer)
            fill = theme.running.pale if first or (hover and works) else theme.key
            edge = theme.selected if hover and works else theme.key_edge
            painter.panel(surface, place, fill, 7 * ui, edge)
            surface.blit(text, text.get_rect(center=place.center))
            self._places.append((name, place))
            right = place.left - round(8 * ui)
        quiet = fonts.render(note, 14 * ui, theme.muted)
        room = right - 2 * pad - quiet.get_width() - round(12 * ui)
        image = fonts.render(
            fonts.shorten(title, 20 * ui, room, bold=True), 20 * ui, theme.ink, bold=True
        )
        place = image.get_rect(midleft=(pad, bar.centery))
        surface.blit(image, place)
        beside = (place.right + round(12 * ui), bar.centery + round(2 * ui))
        if room > 0:
            surface.blit(quiet, quiet.get_rect(midleft=beside))


def draw_footer(
    surface: pygame.Surface,
    bar: pygame.Rect,
    painter: Painter,
    text: str,
    kind: str,
    right: str,
) -> None:
    """Draw the footer; kind: of the text, "hint", "note" or "error". right: text at the right."""
    theme, ui, fonts = painter.theme, painter.ui, painter.fonts
    pad = round(20 * ui)
    tone = {"error": theme.error, "note": theme.running}.get(kind)
    surface.fill(theme.bar if tone is None else tone.pale, bar)
    surface.fill(theme.edge, (bar.left, bar.top, bar.width, 1))
    place = fonts.render(right, 14 * ui, theme.text)
    surface.blit(place, place.get_rect(midright=(bar.right - pad, bar.centery)))
    room = bar.width - 3 * pad - place.get_width()
    size, ink, bold = (14 * ui, theme.muted, False) if tone is None else (16 * ui, tone.ink, True)
    if tone is not None and fonts.width(text, size, bold=True) > room:
        size = 13 * ui  # two lines of it
    lines = fonts.wrap(text, size, room, 1 if tone is None else 2, bold=bold)
    y = bar.centery - 0.65 * size * (len(lines) - 1)
    for line in lines:
        words = fonts.render(line, size, ink, bold=bold)
        surface.blit(words, words.get_rect(midleft=(bar.left + pad, round(y))))
        y += 1.3 * size


class Prompt:
    """A question at the foot of the window, which stays until one of its keys is pressed.

    Esc closes it without an answer. answers: functions of the typed text, by the names of keys; if
    one raises Mars2dError, the error is shown and the prompt stays open. field: whether there is a
    field to type in.
    """

    def __init__(
        self,
        label: str,
        hint: str,
        answers: Mapping[str, Callable[[str], None]],
        *,
        text: str = "",
        field: bool = False,
    ) -> None:
        """Open the prompt; hint: names the keys; text: the first content of the field."""
        self.label, self.hint, self.text, self.field = label, hint, text, field
        self.error = ""
        self.open = True
        self._answers = answers

    def press(self, name: str, character: str) -> None:
        """Press a key; name: as `chord` returns it; character: the text that it types."""
        name = "return" if name == "enter" else "shift+return" if name == "shift+enter" else name
        if name == "escape":
            self.open = False
        elif name in self._answers:
            self._answer(self._answers[name])
        elif self.field and name == "backspace":
            self.text, self.error = self.text[:-1], ""
        elif self.field and character.isprintable() and len(self.text) < MAX_TYPED:
            self.text, self.error = self.text + character, ""

    def _answer(self, answer: Callable[[str], None]) -> None:
        self.open = False  # unless the answer opens it again
        try:
            answer(self.text)
        except Mars2dError as error:
            self.open, self.error = True, str(error)


def draw_prompt(
    surface: pygame.Surface, layout: Layout, painter: Painter, prompt: Prompt, *, blink: bool
) -> None:
    """Draw a prompt in place of the footer."""
    theme, ui, fonts, bar = painter.theme, painter.ui, painter.fonts, layout.footer
    surface.fill(theme.waiting.pale, bar)
    surface.fill(theme.waiting.ink, (bar.left, bar.top, bar.width, max(1, round(2 * ui))))
    pad = round(20 * ui)
    hint = fonts.render(prompt.hint, 14 * ui, theme.text)
    label = fonts.render(prompt.label, 16 * ui, theme.waiting.ink, bold=True)
    x = bar.left + pad
    surface.blit(label, label.get_rect(midleft=(x, bar.centery)))
    x += label.get_width() + round(12 * ui)
    place = hint.get_rect(midright=(bar.right - pad, bar.centery))
    if place.left > x + (200 * ui if prompt.field else 0):
        surface.blit(hint, place)
    right = place.left - pad
    if prompt.field:
        box = pygame.Rect(x, 0, max(right - x, round(160 * ui)), round(30 * ui))
        box.centery = bar.centery
        painter.panel(surface, box, theme.paper, 5 * ui, theme.key_edge)
        room = box.width - round(20 * ui)
        text = prompt.text
        while text and fonts.width(text, 16 * ui) > room:
            text = text[1:]
        words = fonts.render(text, 16 * ui, theme.ink)
        at = words.get_rect(midleft=(box.left + round(9 * ui), box.centery))
        surface.blit(words, at)
        if blink:
            cursor = (
                at.right + 1,
                box.top + round(6 * ui),
                max(1, round(1.5 * ui)),
                round(18 * ui),
            )
            surface.fill(theme.ink, cursor)
    if prompt.error:
        above = pygame.Rect(bar.left, bar.top - round(34 * ui), bar.width, round(34 * ui))
        surface.fill(theme.error.pale, above)
        short = fonts.shorten(prompt.error, 15 * ui, above.width - 2 * pad, bold=True)
        words = fonts.render(short, 15 * ui, theme.error.ink, bold=True)
        surface.blit(words, words.get_rect(midleft=(above.left + pad, above.centery)))


def draw_plate(
    surface: pygame.Surface,
    painter: Painter,
    lines: Sequence[str],
    bounds: pygame.Rect,
    **place: tuple[int, int],
) -> None:
    """Draw lines of text on a plate, the first line bold if there are several.

    place: the plate's position, as for ``get_rect``; it stays within bounds.
    """
    theme, ui, fonts = painter.theme, painter.ui, painter.fonts
    images = [
        fonts.render(line, 15 * ui, theme.ink, bold=i == 0 and len(lines) > 1)
        for i, line in enumerate(lines)
    ]
    width, step = max(image.get_width() for image in images), round(21 * ui)
    plate = pygame.Rect(0, 0, width + round(22 * ui), step * len(images) + round(12 * ui))
    for name, value in place.items():
        setattr(plate, name, value)
    plate.clamp_ip(bounds)
    painter.panel(surface, plate, theme.plate, 6 * ui, theme.key_edge)
    for i, image in enumerate(images):
        at = plate.left + round(11 * ui), plate.top + round(6 * ui) + step * i + step // 2
        surface.blit(image, image.get_rect(midleft=at))
