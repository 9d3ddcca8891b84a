"""A field to type in: a line of text with a caret, a selection, the clipboard, input methods."""

from __future__ import annotations

import pygame

from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.actions import CONTROL

MOUSE = pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP, pygame.MOUSEMOTION


class TextField:
    """A line of text that is typed. It takes pygame's events while it has the focus.

    An empty field leaves arrow keys and the like to others. Enter, Esc and Tab are never taken.

    text: so far. accepts: the characters that can be typed, "" for all. most: how many. opened_by
    key: whether a key has just opened it, whose own text is not for the field.
    """

    def __init__(
        self, text: str = "", *, accepts: str = "", most: int = 200, opened_by_key: bool = False
    ) -> None:
        """Start with the caret at the end."""
        self.text = text
        self.caret = self._mark = len(text)
        self.composed = ""  # by an input method, or a dead key; not part of the text yet
        self._accepts, self._most, self._deaf = accepts, most, opened_by_key
        self._starts: list[float] = [0.0]  # of characters, pixels, when it was last drawn
        self._place = pygame.Rect(0, 0, 0, 0)
        self._held = False

    @property
    def selected(self) -> tuple[int, int]:
        """The first character of the selection, and the one behind it; the caret without one."""
        return min(self.caret, self._mark), max(self.caret, self._mark)

    def select_all(self) -> None:
        """Select the whole text."""
        self._mark, self.caret = 0, len(self.text)

    def clear(self) -> None:
        """Remove all text."""
        self.text, self.composed, self.caret, self._mark = "", "", 0, 0

    def write(self, text: str) -> None:
        """Put text in place of the selection, as far as the field accepts it."""
        start, end = self.selected
        written = [c for c in " ".join(text.splitlines()) if self._takes(c)]
        room = self._most - len(self.text) + end - start
        new = "".join(written[:room])
        self.text = self.text[:start] + new + self.text[end:]
        self.caret = self._mark = start + len(new)

    def _takes(self, character: str) -> bool:
        return character.isprintable() and (not self._accepts or character in self._accepts)

    # -- events ---------------------------------------------------------------------------------

    def handle(self, event: pygame.Event) -> bool:
        """Handle an event; return whether it was for the field.

        The text of a key comes as an event of its own, after that of the key.
        """
        if event.type == pygame.TEXTINPUT:
            if not self._deaf:
                self.composed = ""
                self.write(event.text)
            return True
        if event.type == pygame.TEXTEDITING:
            self.composed, self._deaf = event.text, False
            return True
        if event.type in (pygame.KEYDOWN, pygame.KEYUP, pygame.MOUSEBUTTONUP):
            self._deaf = False
        if event.type == pygame.KEYDOWN:
            return bool(self.composed) or self._press(event)
        return self._point(event)

    def _press(self, event: pygame.Event) -> bool:
        name, shift = pygame.key.name(event.key), bool(event.mod & pygame.KMOD_SHIFT)
        control, (start, end) = bool(event.mod & CONTROL), self.selected
        left, right = max(self.caret - 1, 0), min(self.caret + 1, len(self.text))
        places = {"left": left, "right": right, "home": 0, "end": len(self.text)}
        if control and name == "a":
            self.select_all()
        elif control and name == "v":
            self.write(pasted())
        elif control and name in ("c", "x"):
            if start < end and copied(self.text[start:end]) and name == "x":
                self.write("")
        elif name in places and self.text:
            if (
                start < end and not shift and name in ("left", "right")
            ):  # to an end of the selection
                self.caret = start if name == "left" else end
            else:
                self.caret = places[name]
            self._mark = self._mark if shift else self.caret
        elif name in ("backspace", "delete") and self.text:
            if start == end:
                self.caret = left if name == "backspace" else right
            self.write("")
        else:
            typed = event.unicode
            return bool(typed) and not control and all(map(self._takes, typed))
        return True

    def _point(self, event: pygame.Event) -> bool:
        """Put the caret where the mouse is, and select by a drag."""
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == pygame.BUTTON_LEFT:
            self._held = bool(self._place.collidepoint(event.pos))
        if not self._held or event.type not in MOUSE:
            return False
        starts = enumerate(self._starts[: len(self.text) + 1])
        self.caret, _ = min(starts, key=lambda start: abs(start[1] - event.pos[0]))
        self._mark = self.caret if event.type == pygame.MOUSEBUTTONDOWN else self._mark
        self._held = event.type != pygame.MOUSEBUTTONUP
        return True

    # -- drawing --------------------------------------------------------------------------------

    def draw(
        self,
        surface: pygame.Surface,
        rect: pygame.Rect,
        painter: Painter,
        size: float,
        *,
        hint: str = "",
    ) -> None:
        """Draw the text with its caret within a rectangle; hint: shown while it is empty.

        size: of letters, pixels.
        """
        fonts, theme, before = painter.fonts, painter.theme, surface.get_clip()
        shown = self.text[: self.caret] + self.composed + self.text[self.caret :]
        caret = self.caret + len(self.composed)
        widths = [fonts.width(shown[:k], size) for k in range(len(shown) + 1)]
        scrolled = max(0, widths[caret] - rect.width + 2)
        left = rect.left - scrolled
        self._place, self._starts = rect, [left + width for width in widths]
        surface.set_clip(rect.clip(before))
        start, end = self.selected
        band = pygame.Rect(left + widths[start], 0, widths[end] - widths[start], round(1.4 * size))
        band.centery = rect.centery
        if start < end:
            surface.fill(theme.running.pale, band)
        words = fonts.render(shown or hint, size, theme.ink if shown else theme.muted)
        surface.blit(words, words.get_rect(midleft=(left, rect.centery)))
        thick = max(1, round(1.5 * painter.ui))
        if self.composed:
            begin, wide = widths[self.caret], widths[caret] - widths[self.caret]
            surface.fill(theme.ink, (left + begin, band.bottom - thick, wide, thick))
        surface.fill(theme.ink, (left + widths[caret], band.top, thick, band.height))
        surface.set_clip(before)
        if pygame.display.get_init():  # an input method puts its list of words there
            pygame.key.set_text_input_rect(band.move(widths[caret] - widths[start], 0))


def copied(text: str) -> bool:
    """Copy text to the clipboard; return whether that worked."""
    try:
        pygame.scrap.put_text(text)
    except pygame.error:
        return False
    return pasted() == text


def pasted() -> str:
    """Return the text on the clipboard, "" if there is none or it can't be reached."""
    try:
        return pygame.scrap.get_text()
    except pygame.error:
        return ""
