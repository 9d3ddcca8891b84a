"""The inspector: a panel with everything about the selected body."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial

import pygame

from mars2d.core.description import snake_case
from mars2d.output.layers.forces import SLIPPING
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
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
from mars2d.window.panels.rows import Row, RowsPanel
from mars2d.window.panels.sensorplot import TITLE, SensorPlot, plot_of
from mars2d.window.screen.picking import Selection
from mars2d.window.widgets.words import Word, write_line

LEAST = 176.0
"""The least height of the inspector, points."""
GAP = 9.0
"""The gap between two sections, points."""
HEAD, ROW, LINE = 36.0, 19.0, 17.0
"""The heights of the name, a row of numbers and a line of text, points."""
CLOSE = 20.0
"""The room for the button that closes it, points."""
LABEL = 80.0
"""The room for the label of a row, points."""

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
        robots, gap = frame.scenario.robots, self.line(GAP)
        state = [Row(HEAD, partial(self._draw_name, frame, body))]
        state += [Row(ROW, partial(self._draw_row, *row)) for row in state_of(frame, body)]
        if body < min(len(robots), len(frame.effort)):
            effort = float(frame.effort[body])
            said = "slips" if effort >= SLIPPING else f"{100 * effort:.0f} %"
            state.append(Row(ROW, partial(self._draw_row, "effort", [("", said)])))
        yield self.stack(*state, gap)
        if frame.scenario.physics == "contact":
            yield self._headed("contacts", " · ".join(contacts_of(frame, body)) or "none")
            numbers = [*force_of(frame, body), *dynamics_of(frame, body)]
            yield self.stack(*(Row(ROW, partial(self._draw_row, *row)) for row in numbers), gap)
        for sensed in sensor_plots(frame, body):
            kind, key = snake_case(type(sensed.sensor).__name__), sensed.sensor.key
            drawn = Row(sensed.height, partial(sensed.draw, self.painter))
            yield self._headed(key, "" if kind == key else kind, drawn)
        if body < len(robots) and any(each.carries_messages for each in frame.scenario.addons):
            heard = [
                f"{sender}, {frame.time - sent:.1f} s ago: {rounded(text)}"
                for sender, sent, text in inbox(frame, body)
            ]
            heard += [""] * (MAX_MESSAGES - len(heard))  # whatever has come
            words = (self.line(LINE, [Word(each, self.painter.theme.text)]) for each in heard)
            yield self._headed("inbox", "" if heard[0] else "nothing yet", *words)

    def _headed(self, title: str, more: str, *rows: Row) -> Row:
        """Return a section with a line above it, its title and more at the right."""
        return self.stack(
            Row(TITLE, partial(self._draw_heading, title, more)), *rows, self.line(GAP)
        )

    def _draw_name(
        self, frame: Frame, body: int, surface: pygame.Surface, rect: pygame.Rect
    ) -> None:
        """Draw the name and kind of a body."""
        ui, theme = self.painter.ui, self.painter.theme
        center = rect.left + 7 * ui, float(rect.centery)
        pygame.draw.aacircle(surface, theme.muted, center, 7.5 * ui)
        pygame.draw.aacircle(
            surface, theme.shade(frame.scenario.body_colors[body]), center, 6.5 * ui
        )
        inset, close = round(22 * ui), round(CLOSE * ui)
        head = pygame.Rect(rect.left + inset, rect.top, rect.width - inset - close, rect.height)
        name = Word(str(frame.scenario.bodies[body].name), theme.ink, 17, bold=True)
        write_line(surface, head, self.painter, [name], [Word(kind_of(frame, body), theme.muted)])

    def _draw_row(
        self,
        what: str,
        numbers: Sequence[tuple[str, str]],
        surface: pygame.Surface,
        rect: pygame.Rect,
    ) -> None:
        """Draw a label and up to three numbers, in columns if these are wide enough."""
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        left, gap, y = rect.left + round(LABEL * ui), round(8 * ui), rect.centery
        column = (rect.right - left) / 3
        self.painter.write(surface, what, 12.5 * ui, theme.muted, midleft=(rect.left, y))
        for size in (12.5 * ui, 11.5 * ui, 10.5 * ui):
            widths = [fonts.width(f"{name} {value}", size) for name, value in numbers]
            if sum(widths) + gap * (len(widths) - 1) <= rect.right - left:
                break
        in_columns = all(width + gap <= column for width in widths[:-1])
        x = left
        for place, (name, value) in enumerate(numbers):
            x = round(left + place * column) if in_columns else x
            x = self.painter.write(surface, f"{name} ", size, theme.muted, midleft=(x, y)).right
            x = self.painter.write(surface, value, size, theme.ink, midleft=(x, y)).right + gap

    def _draw_heading(
        self, title: str, more: str, surface: pygame.Surface, rect: pygame.Rect
    ) -> None:
        """Draw a line above a section, its title and more at the right."""
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        surface.fill(theme.edge, (rect.left, rect.top - round(GAP / 2 * ui), rect.width, 1))
        room = rect.width - fonts.width(title, 12.5 * ui, bold=True) - 12 * ui
        at_end = Word(fonts.shorten(more, 12 * ui, room), theme.muted, 12)
        write_line(surface, rect, self.painter, [Word(title, theme.ink, bold=True)], [at_end])


def sensor_plots(frame: Frame, body: int) -> Iterator[SensorPlot]:
    """Yield the plots of a robot's sensors that have read something."""
    if body >= len(frame.scenario.robots):
        return
    for sensor in frame.scenario.robots[body].sensors:
        for robot, reading in frame.readings.get(sensor.key, ()):
            if robot == body:
                yield plot_of(frame, body, sensor, reading)
