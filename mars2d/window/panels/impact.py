"""The card of an impact: what the touch that led to this picture did to both bodies."""

from __future__ import annotations

import pygame

from mars2d.output.raster.painter import Painter
from mars2d.record.contact import met
from mars2d.record.frame import Frame
from mars2d.record.impacts import card
from mars2d.window.panels.readout import MINUS
from mars2d.window.screen.player import Player
from mars2d.window.widgets.dock import Panel
from mars2d.window.widgets.words import Word, write_line

LINE, SIZE = 18.0, 12.5
"""The heights of a line and of its letters, points."""
LINES = 13
"""Those of a card, and one on what else there is."""
ENDS = (0.52, 0.69, 1.0)
"""Where the numbers of a, of b and of both end, in parts of the width."""
SILENT = "No touch began in this control step. N: on to the next contact, K: back."


class Impact(Panel):
    """Shows velocities, energies and momenta before and after a touch; the wheel turns to others.

    It opens with the keys that go from contact to contact.
    """

    name, title = "impact", "Impact"
    remembered = False

    def __init__(self, painter: Painter, player: Player) -> None:
        """Start with nothing read."""
        self.painter, self._player = painter, player
        self._read: tuple[float, list[list[tuple[str, str, str, str]]]] = (-1.0, [])
        self._turned = 0

    def heights(self, frame: Frame, width: float) -> tuple[float, float]:  # noqa: ARG002
        """Return the least and the wanted height at a width, points."""
        return LINE * LINES, LINE * LINES

    def handle(self, event: pygame.Event) -> bool:
        """Turn to another touch of the same control step by the wheel."""
        if event.type == pygame.MOUSEWHEEL:
            self._turned -= event.y
        return False

    def draw(self, surface: pygame.Surface, rect: pygame.Rect, frame: Frame) -> None:
        """Draw the card, or that there is none."""
        theme, ui, cards = self.painter.theme, self.painter.ui, self._cards(frame)
        line = pygame.Rect(rect.left, rect.top, rect.width, round(LINE * ui))
        if not cards:
            for text in self.painter.fonts.wrap(SILENT, SIZE * ui, rect.width, 4):
                write_line(surface, line, self.painter, [Word(text, theme.muted, SIZE)])
                line.top = line.bottom
            return
        chosen = self._turned % len(cards)
        for k, (label, *numbers) in enumerate(cards[chosen]):
            words = [Word(label, theme.muted, SIZE)]
            color, bold = (theme.ink, True) if k == 0 else (theme.text, False)
            write_line(surface, line, self.painter, words)
            for text, end in zip(numbers, ENDS, strict=True):
                cell = pygame.Rect(line.left, line.top, round(line.width * end), line.height)
                number = Word(text.replace("-", MINUS), color, SIZE, bold)
                write_line(surface, cell, self.painter, [], [number])
            line.top = line.bottom
        if len(cards) > 1:
            more = f"{chosen + 1} of {len(cards)} touches; wheel: others"
            write_line(surface, line, self.painter, [Word(more, theme.muted, SIZE)])

    def _cards(self, frame: Frame) -> list[list[tuple[str, str, str, str]]]:
        """Return the tables of the touches that began in the control step before a frame."""
        if not met(frame.contacts).any():
            return []
        if self._read[0] != frame.time:
            found = self._player.source.recorded.impacts(frame.iteration)
            self._read = frame.time, [card(frame.scenario, impact) for impact in found]
            self._turned = 0
        return self._read[1]
