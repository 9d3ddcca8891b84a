"""The inspector: a panel with everything about the selected body."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import pygame

from mars2d.core.description import snake_case
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.sensors.base import Sensor
from mars2d.window.panels.readout import (
    MAX_MESSAGES,
    contacts_of,
    dynamics_of,
    force_of,
    inbox,
    kind_of,
    rounded,
    state_of,
    touching,
)
from mars2d.window.panels.sensorplot import rows_of
from mars2d.window.screen.picking import Selection
from mars2d.window.widgets.panel import DOT, Panel
from mars2d.window.widgets.rows import Row, Word, write_line

GAP = 9.0
"""The gap between two sections, points."""
HEAD, TITLE = 36.0, 21.0
"""The heights of the name and of a section's title, points."""
CLOSE = 5 * " "
"""The room for the button that closes it."""
LABEL = 0.22
"""The room for the label of a row, in parts of the width."""

DRAW_INTERVAL = 1 / 15
"""The shortest time between two drawings while only numbers change, seconds."""


class Inspector(Panel):
    """Shows the state, contacts, forces, sensors and messages of one body.

    selection: which body is shown; where none is, the inspector is closed. clock: seconds; the
    numbers are read again a few times a second, and as soon as the body comes to touch another or
    parts from it, since it stands beside the arrows.
    """

    name, title, headed, frames, remembered = "inspector", "Inspector", False, False, False
    least = 176.0

    def __init__(
        self,
        painter: Painter,
        selection: Selection,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        """Start with nothing read."""
        super().__init__(painter)
        self.selection, self._clock = selection, clock
        self._sections: list[Row] = []
        self._of: tuple[object, ...] = ()
        self._frame: Frame | None = None
        self._read_at = 0.0

    @property
    def is_open(self) -> bool:
        """Whether a body is shown."""
        return self.selection.body is not None

    def close(self) -> None:
        """Show none."""
        self.selection.body = None

    def rows(self, frame: Frame, width: float) -> Sequence[Row]:  # noqa: ARG002
        """Return the sections as they were last read, or as they are now."""
        body = self.selection.body
        if body is None:
            return []
        of = body, touching(frame, body), frame.scenario, self.painter.ui, self.painter.theme
        late = frame is not self._frame and self._clock() - self._read_at >= DRAW_INTERVAL
        if of != self._of or late:
            self._sections = list(self._made(frame, body))
            self.scroll.at = self.scroll.at if of[:1] == self._of[:1] else 0.0
            self._of, self._frame, self._read_at = of, frame, self._clock()
        return self._sections

    # -- sections -----------------------------------------------------------------------------

    def _made(self, frame: Frame, body: int) -> Iterator[Row]:
        """Yield all sections."""
        robots, theme = frame.scenario.robots, self.painter.theme
        dot = Word(DOT, theme.shade(frame.scenario.body_colors[body]), 17)
        name = Word(str(frame.scenario.bodies[body].name), theme.ink, 17, bold=True)
        kind = Word(f"{kind_of(frame, body)}{CLOSE}", theme.muted)
        yield self.line([dot, name], [kind], HEAD)
        yield from map(self._numbers, state_of(frame, body))
        if frame.scenario.physics == "contact":
            touched = " · ".join(contacts_of(frame, body)) or "none"
            numbers = [*force_of(frame, body), *dynamics_of(frame, body)]
            yield self._heading("contacts", touched)
            yield from map(self._numbers, numbers)
        for sensor, reading in readings_of(frame, body):
            kind_of_it, key = snake_case(type(sensor).__name__), sensor.key
            yield self._heading(key, "" if kind_of_it == key else kind_of_it)
            yield from rows_of(self, frame, body, sensor, reading)
        if body < len(robots) and any(each.carries_messages for each in frame.scenario.addons):
            heard = [
                f"{sender}, {frame.time - sent:.1f} s ago: {rounded(text)}"
                for sender, sent, text in inbox(frame, body)
            ]
            heard += [""] * (MAX_MESSAGES - len(heard))  # whatever has come
            yield self._heading("inbox", "" if heard[0] else "nothing yet")
            yield from (self.line([Word(each, theme.text)]) for each in heard)

    def _numbers(self, row: tuple[str, Sequence[tuple[str, str]]]) -> Row:
        """Return a label and up to three numbers in columns."""
        (what, numbers), theme = row, self.painter.theme
        pairs = ((Word(name, theme.muted), Word(each, theme.ink)) for name, each in numbers)
        words = [word for pair in pairs for word in pair]
        ends = [LABEL + (1 - LABEL) * k / len(numbers) for k in range(1, len(numbers) + 1)]
        return self.table(words, ends, [Word(what, theme.muted)])

    def _heading(self, title: str, more: str) -> Row:
        """Return the head of a section: a line above it, its title and more at the right."""

        def draw(surface: pygame.Surface, rect: pygame.Rect) -> None:
            ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
            surface.fill(theme.edge, (rect.left, rect.top + round(GAP / 2 * ui), rect.width, 1))
            line = pygame.Rect(rect.left, 0, rect.width, rect.height - round(GAP * ui))
            line.bottom = rect.bottom
            room = rect.width - fonts.width(title, 12.5 * ui, bold=True) - 12 * ui
            at_end = Word(fonts.shorten(more, 12.5 * ui, room), theme.muted)
            write_line(surface, line, self.painter, [Word(title, theme.ink, bold=True)], [at_end])

        return Row(GAP + TITLE, draw)


def readings_of(frame: Frame, body: int) -> Iterator[tuple[Sensor, Any]]:
    """Yield a robot's sensors that have read something, and what they have read."""
    if body >= len(frame.scenario.robots):
        return
    for sensor in frame.scenario.robots[body].sensors:
        for robot, reading in frame.readings.get(sensor.key, ()):
            if robot == body:
                yield sensor, reading
