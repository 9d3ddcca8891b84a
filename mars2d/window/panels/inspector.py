"""The inspector: a panel with everything about the selected body."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
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
from mars2d.window.panels.rows import DOT, Row, RowsPanel
from mars2d.window.panels.sensorplot import rows_of
from mars2d.window.screen.picking import Selection
from mars2d.window.widgets.words import Word, write_line

LEAST = 176.0
"""The least height of the inspector, points."""
GAP = 9.0
"""The gap between two sections, points."""
HEAD, TITLE, ROW, LINE = 36.0, 21.0, 19.0, 17.0
"""The heights of the name, a section's title, a row of numbers and a line of text, points."""
CLOSE = 5 * " "
"""The room for the button that closes it."""
SIZE = 12.5
"""The height of letters where they have room, points."""
LABEL = 0.22
"""The room for the label of a row, in parts of the width."""

DRAW_INTERVAL = 1 / 15
"""The shortest time between two drawings while only numbers change, seconds."""


class Inspector(RowsPanel):
    """Shows the state, contacts, forces, sensors and messages of one body.

    selection: which body is shown; where none is, the inspector is closed. clock: seconds; the
    numbers are read again a few times a second, and as soon as the body comes to touch another or
    parts from it, since it stands beside the arrows.
    """

    name, title, headed, frames, remembered = "inspector", "Inspector", False, False, False
    least = LEAST

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

    def heights(self, frame: Frame, width: float) -> tuple[float, float]:
        """Return the least and the wanted height at a width, points."""
        return LEAST, max(super().heights(frame, width)[1], LEAST)

    def rows(self, frame: Frame, width: float) -> Sequence[Row]:  # noqa: ARG002
        """Return the sections as they were last read, or as they are now."""
        body = self.selection.body
        if body is None:
            return []
        of = body, touching(frame, body), frame.scenario, self.painter.ui, self.painter.theme
        late = frame is not self._frame and self._clock() - self._read_at >= DRAW_INTERVAL
        if of != self._of or late:
            self._sections = list(self._made(frame, body))
            self.scroll = self.scroll if of[:1] == self._of[:1] else 0.0
            self._of, self._frame, self._read_at = of, frame, self._clock()
        return self._sections

    # -- sections -----------------------------------------------------------------------------

    def _made(self, frame: Frame, body: int) -> Iterator[Row]:
        """Yield all sections."""
        robots, theme = frame.scenario.robots, self.painter.theme
        dot = Word(DOT, theme.shade(frame.scenario.body_colors[body]), 17)
        name = Word(str(frame.scenario.bodies[body].name), theme.ink, 17, bold=True)
        kind = Word(f"{kind_of(frame, body)}{CLOSE}", theme.muted)
        head = self.line(HEAD, [dot, name], [kind])
        yield self.stack(head, *map(self._numbers, state_of(frame, body)), self.line(GAP))
        if frame.scenario.physics == "contact":
            touched = " · ".join(contacts_of(frame, body)) or "none"
            numbers = [*force_of(frame, body), *dynamics_of(frame, body)]
            yield self._headed("contacts", touched, *map(self._numbers, numbers))
        for sensor, reading in readings_of(frame, body):
            kind_of_it, key = snake_case(type(sensor).__name__), sensor.key
            drawn = rows_of(self, frame, body, sensor, reading)
            yield self._headed(key, "" if kind_of_it == key else kind_of_it, *drawn)
        if body < len(robots) and any(each.carries_messages for each in frame.scenario.addons):
            heard = [
                f"{sender}, {frame.time - sent:.1f} s ago: {rounded(text)}"
                for sender, sent, text in inbox(frame, body)
            ]
            heard += [""] * (MAX_MESSAGES - len(heard))  # whatever has come
            words = (self.line(LINE, [Word(each, theme.text)]) for each in heard)
            yield self._headed("inbox", "" if heard[0] else "nothing yet", *words)

    def _numbers(self, row: tuple[str, Sequence[tuple[str, str]]]) -> Row:
        """Return a label and up to three numbers in columns, as large as there is room."""
        (what, numbers), theme, ui = row, self.painter.theme, self.painter.ui
        widest = max(self.painter.fonts.width(f"{a}{b}", SIZE * ui) for a, b in numbers)

        def draw(surface: pygame.Surface, rect: pygame.Rect) -> None:
            room = (1 - LABEL) * rect.width / len(numbers) - 14 * ui
            size = SIZE * min(1.0, room / widest)
            ends = [
                (
                    LABEL + (1 - LABEL) * k / len(numbers),
                    [Word(name, theme.muted, size), Word(value, theme.ink, size)],
                )
                for k, (name, value) in enumerate(numbers, 1)
            ]
            self.line(ROW, [Word(what, theme.muted, size)], ends=ends).draw(surface, rect)

        return Row(ROW, draw)

    def _headed(self, title: str, more: str, *rows: Row) -> Row:
        """Return a section with a line above it, its title and more at the right."""
        return self.stack(
            Row(TITLE, partial(self._draw_heading, title, more)), *rows, self.line(GAP)
        )

    def _draw_heading(
        self, title: str, more: str, surface: pygame.Surface, rect: pygame.Rect
    ) -> None:
        """Draw a line above a section, its title and more at the right."""
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        surface.fill(theme.edge, (rect.left, rect.top - round(GAP / 2 * ui), rect.width, 1))
        room = rect.width - fonts.width(title, 12.5 * ui, bold=True) - 12 * ui
        at_end = Word(fonts.shorten(more, 12 * ui, room), theme.muted, 12)
        write_line(surface, rect, self.painter, [Word(title, theme.ink, bold=True)], [at_end])


def readings_of(frame: Frame, body: int) -> Iterator[tuple[Sensor, Any]]:
    """Yield a robot's sensors that have read something, and what they have read."""
    if body >= len(frame.scenario.robots):
        return
    for sensor in frame.scenario.robots[body].sensors:
        for robot, reading in frame.readings.get(sensor.key, ()):
            if robot == body:
                yield sensor, reading
