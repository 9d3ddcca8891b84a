"""The inspector: a panel with everything about the selected body."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from mars2d.core.description import snake_case
from mars2d.core.quantity import Quantity
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.sensors.base import Sensor
from mars2d.window.panels.readout import (
    MAX_MESSAGES,
    contacts_of,
    dynamics_of,
    force_of,
    in_words,
    inbox,
    kind_of,
    rounded,
    state_of,
    touching,
)
from mars2d.window.screen.picking import Selection
from mars2d.window.widgets.panel import DOT, LINE, Panel
from mars2d.window.widgets.plot import draw_bars, draw_colors
from mars2d.window.widgets.rows import Row, Word

GAP = 9.0
"""The gap between two sections, points."""
TITLE = 21.0
"""The height of a section's title, points."""
BARS, MAX_LINES = 40.0, 6
"""The height of bars, points, and how many numbers are written; more are drawn as bars."""
DRAW_INTERVAL = 1 / 15
"""The shortest time between two drawings while only numbers change, seconds."""


class Inspector(Panel):
    """Shows the state, contacts, forces, sensors and messages of one body.

    selection: which body is shown; where none is, the inspector is closed. clock: seconds; the
    numbers are read again a few times a second, and as soon as the body comes to touch another or
    parts from it, since it stands beside the arrows.
    """

    name, title, frames, remembered = "inspector", "Inspector", False, False
    least = 142.0

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

    def head(self, frame: Frame) -> tuple[Sequence[Word], Sequence[Word]]:
        """Return the body's name after a dot in its colour, and its kind."""
        theme, body = self.painter.theme, self.selection.body or 0
        dot = Word(DOT, theme.shade(frame.scenario.body_colors[body]), 15)
        name = Word(str(frame.scenario.bodies[body].name), theme.ink, 15, bold=True)
        return [dot, name], [Word(kind_of(frame, body), theme.muted)]

    # -- sections -----------------------------------------------------------------------------

    def _made(self, frame: Frame, body: int) -> Iterator[Row]:
        """Yield all sections."""
        theme = self.painter.theme
        yield from self._numbers(state_of(frame, body))
        if frame.scenario.physics == "contact":
            yield from self._heading("contacts", " · ".join(contacts_of(frame, body)) or "none")
            yield from self._numbers([*force_of(frame, body), *dynamics_of(frame, body)])
        for sensor, reading in readings_of(frame, body):
            kind_of_it, key = snake_case(type(sensor).__name__), sensor.key
            yield from self._heading(key, "" if kind_of_it == key else kind_of_it)
            yield from self.reading(frame, body, sensor, reading)
        if body < len(frame.scenario.robots) and any(
            each.carries_messages for each in frame.scenario.addons
        ):
            heard = [
                f"{sender}, {frame.time - sent:.1f} s ago: {rounded(text)}"
                for sender, sent, text in inbox(frame, body)
            ]
            heard += [""] * (MAX_MESSAGES - len(heard))  # whatever has come
            yield from self._heading("inbox", "" if heard[0] else "nothing yet")
            yield from (self.line([Word(each, theme.text)]) for each in heard)

    def _numbers(self, rows: Sequence[tuple[str, Sequence[tuple[str, str]]]]) -> list[Row]:
        """Return rows of a label and up to three numbers in columns."""
        muted, ink = self.painter.theme.muted, self.painter.theme.ink
        return self.table(
            [
                [[Word(what, muted)], *([Word(name, muted), Word(n, ink)] for name, n in numbers)]
                for what, numbers in rows
            ]
        )

    def _heading(self, title: str, more: str) -> list[Row]:
        """Return the head of a section: a line above it, its title and more."""
        theme = self.painter.theme
        words = Word(title, theme.ink, bold=True), Word(more, theme.muted)
        return [self.rule(GAP), self.line(words, high=TITLE)]

    def reading(self, frame: Frame, robot: int, sensor: Sensor, reading: Any) -> list[Row]:
        """Return the reading of a sensor of a robot: numbers, colours, or bars.

        Bars are those of now, from left to right as the robot sees where they are of beams.
        """
        now, painter, theme = np.asarray(reading), self.painter, self.painter.theme
        quantities = sensor.quantities or (Quantity("value"),)
        if quantities[0].kind == "color" and now.shape[-1:] == (3,):
            strip = now.reshape(-1, 3)[::-1]
            return [Row(LINE, lambda on, at: draw_colors(on, at, painter, strip))]
        numbers = now.ravel().astype(float)
        if len(numbers) > MAX_LINES:
            beams = np.shape(getattr(sensor, "angles", ())) == now.shape
            bars, color = numbers[::-1] if beams else numbers, frame.scenario.colors[robot]
            return [Row(BARS, lambda on, at: draw_bars(on, at, painter, bars, color))]
        named = len(quantities) == len(numbers)
        each = [quantities[k if named else 0] for k in range(len(numbers))]
        return [
            self.line(
                [Word(quantity.name if named else f"[{k}]", theme.text)],
                [Word(in_words(value, quantity), theme.ink)],
            )
            for k, (value, quantity) in enumerate(zip(numbers.tolist(), each, strict=True))
        ]


def readings_of(frame: Frame, body: int) -> Iterator[tuple[Sensor, Any]]:
    """Yield a robot's sensors that have read something, and what they have read."""
    if body >= len(frame.scenario.robots):
        return
    for sensor in frame.scenario.robots[body].sensors:
        for robot, reading in frame.readings.get(sensor.key, ()):
            if robot == body:
                yield sensor, reading
