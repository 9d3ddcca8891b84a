"""The time bar: the recorded part of an experiment, the instant shown, and events."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import pygame

from mars2d.core.plane import grid_step
from mars2d.output.controls import MARKS
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.theme import mixed
from mars2d.record.marks import MarkKind
from mars2d.window.widgets.slider import Slider, draw_tooltip

ENDLESS = 1_000_000
"""Experiments of more rows than this are shown only as far as they have gone."""
MIN_ENDLESS = 10.0
"""The shortest time shown of such an experiment, seconds."""
LINE = 6.0
"""The height of the line, points."""


@dataclass(frozen=True, slots=True)
class TimeState:
    """Where an experiment is: rows are control steps, from 0.

    row: the row shown. rows: the newest row simulated so far. last: the row at which the experiment
    ends. sampling_time: seconds between two rows. marks: rows, in ascending order, at which
    collisions began, a person intervened, a branch begins, or a law failed. live: whether the run
    can go on from the row; else it is a recording.
    """

    row: int
    rows: int
    last: int
    sampling_time: float
    marks: Mapping[MarkKind, Sequence[int]] = field(default_factory=dict)
    live: bool = True

    @property
    def past(self) -> bool:
        """Whether an earlier row is shown than the newest of a run that goes on."""
        return self.live and self.row < self.rows

    @property
    def extent(self) -> float:
        """The row at the right end: the last row, or a round time ahead in endless experiments."""
        if self.last <= ENDLESS:
            return max(self.last, self.rows, 1)
        time = max(1.02 * self.rows * self.sampling_time, MIN_ENDLESS)
        return min(grid_step(time) / self.sampling_time, float(self.last))


class TimeBar(Slider):
    """Shows the state of an experiment along a line, and finds the row at a pixel."""

    def __init__(self) -> None:
        """Start with nothing drawn."""
        super().__init__()
        self._state: TimeState | None = None

    def row_at(self, x: float) -> int | None:
        """Return the recorded row nearest to a pixel from the left.

        None while nothing is drawn, or if there is no room for the line.
        """
        if self._state is None or self._line.width <= 0:
            return None
        share = (x - self._line.left) / self._line.width
        row = min(max(share, 0.0), 1.0) * self._state.extent
        return min(max(round(row), 0), self._state.rows)

    def x_of(self, row: float) -> float:
        """Return where a row lies, pixels from the left; at the nearer end if it is not shown."""
        extent = 1.0 if self._state is None else self._state.extent
        return self._line.left + self._line.width * min(max(row / extent, 0.0), 1.0)

    # -- drawing --------------------------------------------------------------------------------

    def draw(
        self,
        surface: pygame.Surface,
        rect: pygame.Rect,
        painter: Painter,
        state: TimeState,
        *,
        pointer: tuple[int, int] | None = None,
        held: bool = False,
    ) -> None:
        """Draw the bar on a part of a surface.

        pointer: where the mouse is. held: whether the mouse drags the handle.
        """
        ui, theme = painter.ui, painter.theme
        surface.fill(theme.bar, rect)
        surface.fill(theme.edge, (rect.left, rect.top, rect.width, 1))
        self._state = state
        self._arrange(rect, painter, state)
        if self._line.width <= 0:
            return
        hovered = held or (pointer is not None and self.hit(pointer))
        self._ends(surface, painter, state)
        self._band(surface, painter, state)
        self._marks(surface, painter, state)
        self._handle(surface, painter, state, lifted=hovered)
        if hovered and pointer is not None:
            row = self.row_at(pointer[0])
            place = round(self.x_of(row or 0)), rect.top - round(4 * ui)
            draw_tooltip(surface, painter, _time(row or 0, state), midbottom=place)

    def _arrange(self, rect: pygame.Rect, painter: Painter, state: TimeState) -> None:
        """Place the line between the labels of its ends; leave them out if it would be short."""
        ui, fonts = painter.ui, painter.fonts
        pad, gap, size = 20 * ui, 12 * ui, 13 * ui
        first, last = "0 s", _time(state.extent, state, digits=0)
        left = rect.left + pad + fonts.width(first, size) + gap
        right = rect.right - pad - fonts.width(last, size) - gap
        self._labelled = right - left >= 120 * ui
        if not self._labelled:
            left, right = rect.left + pad, rect.right - pad
        height = round(LINE * ui)
        line = pygame.Rect(round(left), 0, max(0, round(right - left)), height)
        line.centery = rect.top + round(0.58 * rect.height)
        self._place(rect, line, round(8 * ui))

    def _ends(self, surface: pygame.Surface, painter: Painter, state: TimeState) -> None:
        """Write the times at both ends."""
        if not self._labelled:
            return
        ui, line = painter.ui, self._line
        gap = round(12 * ui)
        texts = "0 s", _time(state.extent, state, digits=0)
        for text, place in zip(texts, ("midright", "midleft"), strict=True):
            x = line.left - gap if place == "midright" else line.right + gap
            image = painter.fonts.render(text, 13 * ui, painter.theme.muted)
            surface.blit(image, image.get_rect(**{place: (x, line.centery)}))

    def _band(self, surface: pygame.Surface, painter: Painter, state: TimeState) -> None:
        """Draw the line, over it the recorded part, and over that the part before the handle."""
        theme = painter.theme
        ahead = mixed(theme.selected, theme.bar, 0.42)
        for row, color in (
            (state.extent, theme.track),
            (state.rows, ahead),
            (state.row, theme.selected),
        ):
            self._fill(surface, painter, round(self.x_of(row)), color)

    def _marks(self, surface: pygame.Surface, painter: Painter, state: TimeState) -> None:
        """Draw a tick per event above the line, below it, or both."""
        ui, line = painter.ui, self._line
        thick, long = max(1, round(1.5 * ui)), round(6 * ui)
        above, below = line.top - round(2 * ui) - long, line.bottom + round(2 * ui)
        for kind, mark in MARKS.items():
            top = above if mark.above else below
            height = (below if mark.below else above) + long - top
            wide = thick * (2 if kind == "error" else 1)
            color = mark.color(painter.theme)
            for x, width in self._stretches(state.marks.get(kind, ()), wide):
                surface.fill(color, (x, top, width, height))

    def _stretches(self, rows: Sequence[int], thick: int) -> Iterator[tuple[int, int]]:
        """Yield runs of columns of pixels with events, each as its first pixel and its width.

        thick: the width of a tick, pixels.
        """
        columns = np.unique([round(self.x_of(row)) for row in rows]).astype(int)
        for each in np.split(columns, np.flatnonzero(np.diff(columns) > thick) + 1):
            if len(each):
                yield int(each[0]) - thick // 2, int(each[-1] - each[0]) + thick

    def _handle(
        self, surface: pygame.Surface, painter: Painter, state: TimeState, *, lifted: bool
    ) -> None:
        """Draw the handle, larger while the mouse is over the bar."""
        color = painter.theme.past.ink if state.past else painter.theme.selected
        radius = 9.0 if lifted else 7.0
        self._draw_handle(surface, painter, state.row, painter.theme.bar, color, radius)


def _time(row: float, state: TimeState, digits: int | None = None) -> str:
    """Return the time of a row in words, with enough decimals to tell two rows apart."""
    step = state.sampling_time
    if digits is None:
        digits = next((k for k in (0, 1, 2) if abs(round(step, k) - step) < 1e-9), 3)
    seconds = row * step
    text = f"{seconds:.{digits}f}"
    if digits == 0 and abs(seconds - round(seconds)) > 1e-6:
        text = f"{seconds:.3g}"
    return f"{text} s"
