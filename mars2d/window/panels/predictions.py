"""A panel that compares the predictions of the experiment's `checks` with measurements."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import NamedTuple

import pygame

from mars2d.core.errors import LawError
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.theme import Theme
from mars2d.record.frame import Frame
from mars2d.scenario.prediction import SIGNS, Prediction, cells, number, summary
from mars2d.window.widgets.dock import Panel
from mars2d.window.widgets.words import Word, write_line
from mars2d.world.timeline import Timeline
from mars2d.world.world import World

OFTEN = 0.2
"""The shortest time between two readings while the run goes on, seconds."""
SHARE = 0.04
"""The largest share of the time that `checks` may take."""
DEAR = 0.1
"""Where `checks` takes longer, the numbers are read only when time stands still, seconds."""

TITLES, ROW, LINE, LEAST = 22.0, 40.0, 17.0, 110.0
"""The heights of the columns' titles, of a prediction, of a line of words, and the least height of
the panel, points."""
NUMBER = 13.0
"""The height of numbers, points."""
UNIT, MARK = 58.0, 8.0
"""The room for a unit, and the diameter of the mark before a name, points."""
MAX_WORDS = 6
"""The most lines of words about values that could not be read."""


class Reading(NamedTuple):
    """What `checks` made of a run so far.

    time: of the run, seconds. finished: whether it had come to its end. error: what ended `checks`.
    """

    time: float
    finished: bool
    predictions: tuple[Prediction, ...]
    error: LawError | None


class Predictions(Panel):
    """Shows predictions as a table: predicted, measured, tolerance, and whether they agree.

    `checks` is written for a run that has ended. While one goes on, it is asked a few times a
    second, as far as it costs little; what it can't find yet, or has found too little of, is "not
    yet". Its errors are shown here, and never end the run.
    """

    name, title = "predictions", "Predictions"

    def __init__(
        self,
        painter: Painter,
        timeline: Timeline | None,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        """Start with nothing read."""
        self.painter, self.reading = painter, Reading(0.0, False, (), None)
        self._timeline, self._clock = timeline, clock
        self._read: tuple[World, int] | None = None
        self._next, self._cost = -math.inf, 0.0
        self._first = 0  # the prediction at the top, if there is no room for all

    @property
    def offered(self) -> bool:
        """Whether the experiment has checks."""
        return self._timeline is not None and self._timeline.experiment.source.checks is not None

    def look(self, *, playing: bool) -> bool:
        """Read the run again if it has gone on; return whether there is something new to see."""
        timeline, now = self._timeline, self._clock()
        if timeline is None or not self.is_open:
            return False
        world = timeline.world
        of = world, world.iteration
        same = self._read is not None and self._read == of
        if same or (playing and not world.over and (now < self._next or self._cost > DEAR)):
            return False
        self._read = of
        record = world.record
        found, error = timeline.experiment.predictions_so_far(record)
        self._cost = self._clock() - now
        self._next = now + max(OFTEN, self._cost / SHARE)
        at = float(record.time[-1]) if len(record) else 0.0
        self.reading = Reading(at, record.finished, found, error)
        return True

    # -- the panel --------------------------------------------------------------------------------

    def heights(self, frame: Frame, width: float) -> tuple[float, float]:  # noqa: ARG002
        """Return the least and the wanted height at a width, points."""
        lines = len(self._words(width * self.painter.ui))
        rows = max(len(self.reading.predictions), 1)
        return LEAST, max(LEAST, TITLES + rows * ROW + lines * LINE)

    def handle(self, event: pygame.Event) -> bool:
        """Scroll by the wheel where there is no room for all predictions."""
        if event.type == pygame.MOUSEWHEEL:
            self._first -= event.y
        return False

    def draw(self, surface: pygame.Surface, rect: pygame.Rect, frame: Frame) -> None:  # noqa: ARG002
        """Draw the table, and below it the values that could not be read."""
        ui, theme, painter = self.painter.ui, self.painter.theme, self.painter
        rows, words = self.reading.predictions, self._words(rect.width)
        top, foot = rect.top, rect.bottom - round(len(words) * LINE * ui) if rows else rect.top
        each = self._column(rect.width)
        columns = [round(rect.right - UNIT * ui - k * each) for k in (2, 1, 0)]
        titles = ("predicted", "measured", "tolerance") if rows else ()
        for title, right in zip(titles, columns, strict=False):
            painter.write(surface, title, 11.5 * ui, theme.muted, topright=(right, top))
        top += round(TITLES * ui) if rows else 0
        room = max(1, int((foot - top) / (ROW * ui)))
        self._first = min(max(self._first, 0), max(0, len(rows) - room))
        for prediction in rows[self._first : self._first + room]:
            place = pygame.Rect(rect.left, top, rect.width, round(ROW * ui))
            self._draw_row(surface, place, prediction, columns)
            top = place.bottom
        failed = self.reading.error is not None and self.reading.finished
        color = theme.error.ink if failed else theme.muted
        for k, line in enumerate(words):
            place = pygame.Rect(rect.left, foot + round(k * LINE * ui), rect.width, 0)
            painter.write(surface, line, 12 * ui, color, topleft=place.topleft)
        if len(rows) > room:
            more = f"wheel: {len(rows) - room} more"
            painter.write(surface, more, 12 * ui, theme.muted, bottomright=rect.bottomright)

    def _column(self, width: float) -> float:
        """Return the width of a column of numbers, pixels, given that of the panel's content."""
        return (width - UNIT * self.painter.ui) / 3.1

    def _draw_row(
        self, surface: pygame.Surface, rect: pygame.Rect, p: Prediction, columns: list[int]
    ) -> None:
        """Draw a prediction: its name and how it stands, and below that its numbers."""
        ui, theme, painter = self.painter.ui, self.painter.theme, self.painter
        said, color = self._verdict(p, theme)
        mark = pygame.Rect(rect.left, rect.top + round(3 * ui), round(MARK * ui), round(MARK * ui))
        painter.panel(surface, mark, color, mark.width / 2)
        left = mark.right + round(7 * ui)
        line = pygame.Rect(left, rect.top - round(2 * ui), rect.right - left, round(18 * ui))
        name, state = Word(p.name, theme.ink, 13), Word(said, color, 12, bold=True)
        write_line(surface, line, painter, [name], [state])
        low = rect.top + round(17 * ui)
        if p.reason:
            words = painter.fonts.shorten(p.reason, 12 * ui, rect.right - left)
            painter.write(surface, words, 12 * ui, theme.muted, topleft=(left, low))
            return
        measured = p.measured if math.isfinite(p.measured) else None
        each = self._column(rect.width) - 8 * ui
        shown = [self._fitted(value, p.tolerance, each) for value in (p.predicted, measured)]
        shown[0] = SIGNS[p.bound] + shown[0]
        for k, (cell, right) in enumerate(zip((*shown, cells(p)[-1]), columns, strict=True)):
            ink = color if k == 1 and self.reading.finished else theme.text
            painter.write(surface, cell, NUMBER * ui, ink, bold=k == 1, topright=(right, low))
        unit = painter.fonts.shorten(p.unit, 12 * ui, (UNIT - 6) * ui)
        place = columns[-1] + round(6 * ui), low + round(ui)
        painter.write(surface, unit, 12 * ui, theme.muted, topleft=place)

    def _fitted(self, value: float | None, tolerance: float, room: float) -> str:
        """Return a number with the digits that its tolerance needs, or as many as there is room."""
        if value is None:
            return "-"
        texts = [number(value, tolerance), *(f"{value:.{digits}g}" for digits in (8, 6, 4))]
        size = NUMBER * self.painter.ui
        fits = (text for text in texts if self.painter.fonts.width(text, size, bold=True) <= room)
        return next(fits, texts[-1])

    def _verdict(self, prediction: Prediction, theme: Theme) -> tuple[str, str]:
        """Return how a prediction stands, in words, and their colour."""
        if prediction.reason:
            return prediction.verdict, theme.muted
        if prediction.ok:
            return ("ok" if self.reading.finished else "ok so far"), theme.running.ink
        if self.reading.finished:
            return "NOT OK", theme.error.ink
        return "not yet", theme.waiting.ink

    def _words(self, width: float) -> list[str]:
        """Return lines about the run, and about values that could not be read; width: pixels."""
        timeline, reading, ui = self._timeline, self.reading, self.painter.ui
        if timeline is not None and timeline.world.operator.log:
            first = timeline.world.recorder.options
            new = [f"{k} = {v:.6g}" for k, v in timeline.options.items() if first.get(k) != v]
            again = f"R: again with {', '.join(new)}, and predict." if new else "R: again."
            text = f"A hand has changed this run; the predictions are for one without. {again}"
        elif not reading.predictions and reading.error is None:
            text = "Nothing is measured yet."
        elif reading.error is not None:
            text = f"{'Failed' if reading.finished else 'Not yet'}: {reading.error}"
        else:
            when = "at the end" if reading.finished else f"at {reading.time:.4g} s"
            text = f"{summary(reading.predictions)} {when}"
        return self.painter.fonts.wrap(text, 12 * ui, width, MAX_WORDS)
