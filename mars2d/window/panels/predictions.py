"""A panel that compares the predictions of the experiment's `checks` with measurements."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence

from mars2d.core.errors import LawError
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.theme import Theme
from mars2d.record.frame import Frame
from mars2d.scenario.prediction import Prediction, cells, summary
from mars2d.window.widgets.panel import DOT, Panel
from mars2d.window.widgets.rows import Row, Word
from mars2d.world.timeline import Timeline
from mars2d.world.world import World

OFTEN = 0.2
"""The shortest time between two readings while the run goes on, seconds."""
SHARE = 0.04
"""The largest share of the time that `checks` may take."""

TITLES = "predicted", "measured", "tolerance"
GAP = 6.0
"""The height of the gap below a prediction, points."""
MAX_WORDS = 6
"""The most lines of words about values that could not be read."""


class Predictions(Panel):
    """Shows predictions as a table: predicted, measured, tolerance, and whether they agree.

    `checks` is written for a run that has ended. While one goes on, it is asked a few times a
    second, as far as it costs little; what it can't find yet, or has found too little of, is "not
    yet". Its errors are shown here, and never end the run.

    found, error: what it made of the run so far, and what ended it. finished: whether the run had
    come to its end then.
    """

    name, title, least = "predictions", "Predictions", 110.0

    def __init__(
        self,
        painter: Painter,
        timeline: Timeline | None,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        """Start with nothing read."""
        super().__init__(painter)
        self.found: tuple[Prediction, ...] = ()
        self.error: LawError | None = None
        self.finished = False
        self._timeline, self._clock = timeline, clock
        self._read: tuple[World, int] | None = None
        self._at, self._next = 0.0, -math.inf

    @property
    def lacks(self) -> str:  # type: ignore[override]
        """Why there is nothing to show: without checks, which may come when the file is saved."""
        checks = self._timeline is not None and self._timeline.experiment.source.checks is not None
        return "" if checks else "this file has no checks, which compare a run with theory"

    def look(self, *, playing: bool) -> bool:
        """Read the run again if it has gone on; return whether there is something new to see."""
        timeline, now = self._timeline, self._clock()
        if timeline is None or not self.is_open:
            return False
        world = timeline.world
        of = world, world.iteration
        if self._read == of or (playing and not world.over and now < self._next):
            return False
        self._read = of
        record = world.record
        self.found, self.error = timeline.experiment.predictions_so_far(record)
        self.finished, self._at = record.finished, float(record.time[-1]) if len(record) else 0.0
        self._next = now + max(OFTEN, (self._clock() - now) / SHARE)
        return True

    # -- the panel --------------------------------------------------------------------------------

    def rows(self, frame: Frame, width: float) -> Sequence[Row]:  # noqa: ARG002
        """Return the titles of the columns, and two rows for each prediction, or why none."""
        muted = self.painter.theme.muted
        if not self.found:
            return self._said(width)
        titles = [[], *([Word(each, muted)] for each in TITLES)]
        head, *numbers = self.table([titles, *map(self._numbers, self.found)])
        listed = [head]
        for each, row in zip(self.found, numbers, strict=True):
            why = self.line([Word(each.reason, muted)])
            listed += [self._head(each), why if each.reason else row, self.gap(GAP)]
        return listed

    def foot(self, width: float) -> Sequence[Row]:
        """Return lines about the run, and about values that could not be read."""
        return self._said(width) if self.found else ()

    def _said(self, width: float) -> list[Row]:
        theme, failed = self.painter.theme, self.error is not None and self.finished
        color = theme.error.ink if failed else theme.muted
        return [*self.wrapped(Word(self._words(), color), width, MAX_WORDS)]

    def _head(self, prediction: Prediction) -> Row:
        """Return a prediction's name and how it stands."""
        said, color = self._verdict(prediction, self.painter.theme)
        name = [Word(DOT, color), Word(prediction.name, self.painter.theme.ink)]
        return self.line(name, [Word(said, color, bold=True)])

    def _numbers(self, prediction: Prediction) -> list[list[Word]]:
        """Return the cells of a line: what is predicted and measured, and the tolerance."""
        theme = self.painter.theme
        predicted, measured, tolerance = cells(prediction)[-3:]
        measured = measured if math.isfinite(prediction.measured) else "-"
        ink = self._verdict(prediction, theme)[1] if self.finished else theme.text
        return [
            [],
            [Word(predicted, theme.text)],
            [Word(measured, ink, bold=True)],
            [Word(f"{tolerance} {prediction.unit}".strip(), theme.text)],
        ]

    def _verdict(self, prediction: Prediction, theme: Theme) -> tuple[str, str]:
        """Return how a prediction stands, in words, and their colour."""
        if prediction.reason:
            return prediction.verdict, theme.muted
        if prediction.ok:
            return ("ok" if self.finished else "ok so far"), theme.running.ink
        if self.finished:
            return "NOT OK", theme.error.ink
        return "not yet", theme.waiting.ink

    def _words(self) -> str:
        """Return what is to say about the run, and about values that could not be read."""
        timeline = self._timeline
        if timeline is not None and timeline.world.operator.log:
            first, now = timeline.world.recorder.options, timeline.experiment.options
            new = [f"{k} = {v:.6g}" for k, v in now.items() if first.get(k) != v]
            again = f"R: again with {', '.join(new)}, and predict." if new else "R: again."
            return f"A hand has changed this run; the predictions are for one without. {again}"
        if self.error is not None:
            return f"{'Failed' if self.finished else 'Not yet'}: {self.error}"
        when = "at the end" if self.finished else f"at {self._at:.4g} s"
        return f"{summary(self.found)} {when}" if self.found else "Nothing is measured yet."
