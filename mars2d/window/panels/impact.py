"""The card of an impact: what the touch that led to this picture did to both bodies."""

from __future__ import annotations

from collections.abc import Sequence

from mars2d.output.raster.painter import Painter
from mars2d.record.contact import met
from mars2d.record.frame import Frame
from mars2d.record.impacts import card
from mars2d.window.panels.trace import with_present
from mars2d.window.screen.player import Player
from mars2d.window.widgets.panel import LINE, Panel
from mars2d.window.widgets.rows import Row, Word, minus

CARD = 12
"""The lines of a card."""
SIZE, NAME = 12.5, 72.0
"""The height of the letters of a name, and its room, points."""
SILENT = "No touch began in this control step. N: on to the next contact, Shift N: back."

Table = list[tuple[str, str, str, str]]


class Impact(Panel):
    """Shows velocities, energies and momenta before and after each touch of a control step.

    It opens with the keys that go from contact to contact.
    """

    name, title, least, remembered = "impact", "Impact", 0.0, False

    def __init__(self, painter: Painter, player: Player) -> None:
        """Start with nothing read."""
        super().__init__(painter)
        self._player = player
        self._read: tuple[float, list[Table]] = (-1.0, [])

    def rows(self, frame: Frame, width: float) -> Sequence[Row]:
        """Return the lines of all cards, or that there is none."""
        theme, lines = self.painter.theme, [line for each in self._cards(frame) for line in each]
        if not lines:
            return [*self.wrapped(Word(SILENT, theme.muted), width)]
        table = []
        for label, *numbers in lines:
            cells = [[Word(minus(each), theme.text)] * bool(each) for each in numbers]
            if not label:
                names = [
                    self.painter.fonts.shorten(each, SIZE, NAME, bold=True) for each in numbers
                ]
                cells = [[Word(each, theme.ink, SIZE, bold=True)] for each in names]
            table.append([[Word(label, theme.muted)], *cells])
        return self.table(table)

    def heights(self, frame: Frame, width: float) -> tuple[float, float]:
        """Return the least height, that of one card where there is one, and the wanted height."""
        _, wanted = super().heights(frame, width)
        return min(CARD * LINE, wanted), wanted

    def _cards(self, frame: Frame) -> list[Table]:
        """Return the tables of the touches that began in the control step before a frame."""
        if not met(frame.contacts).any():
            return []
        if self._read[0] != frame.time:
            record = with_present(self._player.source.recorded, frame)
            found = record.impacts(frame.iteration)
            self._read = frame.time, [card(frame.scenario, impact) for impact in found]
        return self._read[1]
