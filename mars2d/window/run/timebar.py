"""The time bar: the recorded part of an experiment, the instant shown, and events."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence

import pygame

from mars2d.core.plane import grid_step
from mars2d.output.controls import MARKS
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.theme import mixed
from mars2d.record.marks import MarkKind, meetings
from mars2d.window.run.mouse import Pixel
from mars2d.window.screen.player import Player
from mars2d.window.screen.source import Playback, Source, done_in
from mars2d.window.widgets.slider import Slider, draw_tooltip
from mars2d.world.timeline import Timeline

ENDLESS = 1_000_000
"""Experiments of more rows than this are shown only as far as they have gone."""
MIN_ENDLESS = 10.0
"""The shortest time shown of such an experiment, seconds."""
LINE = 6.0
"""The height of the line, points."""
MARK_INTERVAL = 0.25
"""How often the log of contacts is read for collisions, seconds."""


class TimeBar(Slider):
    """Shows how far a player has come along a line, whose values are rows.

    marked: the source whose events are marked.
    """

    def __init__(self, player: Player, marked: Source) -> None:
        """Start with nothing drawn."""
        super().__init__()
        self._player, self._marked = player, marked
        self._read: tuple[object, float] = None, 0.0  # the run whose contacts were read, and when
        self._touched: list[int] = []

    def go(self, pixel: Pixel) -> None:
        """Go to the row at a pixel."""
        self._player.go(self.row_at(pixel[0]))

    def row_at(self, x: float) -> int:
        """Return the recorded row nearest to a pixel from the left."""
        return min(round(self.value_at(x)), self._player.source.newest)

    @property
    def extent(self) -> float:
        """The row at the right end: the last row, or a round time ahead in endless experiments."""
        source = self._player.source
        recorded = isinstance(source, Playback)
        last, rows = source.newest if recorded else source.scenario.last_iteration, source.newest
        if last <= ENDLESS:
            return max(last, rows, 1)
        step = source.scenario.sampling_time
        return min(grid_step(max(1.02 * rows * step, MIN_ENDLESS)) / step, float(last))

    def marks(self) -> Mapping[MarkKind, Sequence[int]]:
        """Return the rows of each kind in ascending order; collisions may lag by a moment."""
        source, now = self._marked, time.monotonic()
        run = source.world if isinstance(source, Timeline) else source
        if run is not self._read[0] or now >= self._read[1] + MARK_INTERVAL:
            self._read = run, now
            self._touched = meetings(source.contacts, source.scenario.sampling_time)
        marks: dict[MarkKind, Sequence[int]] = {"collision": self._touched}
        marks["hand"] = sorted({each.row for each in done_in(source)})
        if isinstance(source, Timeline):
            world = source.world
            marks["branch"] = sorted({source.branch.common(other) for other in source.branches})
            marks["error"] = [world.iteration] if world.over and not world.finished else []
        return marks

    # -- drawing --------------------------------------------------------------------------------

    def draw(
        self,
        surface: pygame.Surface,
        rect: pygame.Rect,
        painter: Painter,
        pointer: Pixel | None = None,
        *,
        held: bool = False,
    ) -> None:
        """Draw the bar on a part of a surface.

        pointer: where the mouse is. held: whether the mouse drags the handle.
        """
        theme = painter.theme
        surface.fill(theme.bar, rect)
        surface.fill(theme.edge, (rect.left, rect.top, rect.width, 1))
        self.high = self.extent
        self._arrange(surface, rect, painter)
        if self._line.width <= 0:
            return
        source = self._player.source
        ahead = mixed(theme.selected, theme.bar, 0.42)
        for row, color in (
            (self.high, theme.track), (source.newest, ahead), (source.row, theme.selected),
        ):  # fmt: skip
            self._fill(surface, painter, round(self.x_of(row)), color)
        self._draw_marks(surface, painter)
        hovered = held or (pointer is not None and self.hit(pointer))
        color = theme.past.ink if self._player.past else theme.selected
        self._draw_handle(surface, painter, source.row, theme.bar, color, 9.0 if hovered else 7.0)
        if hovered and pointer is not None:
            row = self.row_at(pointer[0])
            place = round(self.x_of(row)), rect.top - round(4 * painter.ui)
            draw_tooltip(surface, painter, self._time(row), midbottom=place)

    def _arrange(self, surface: pygame.Surface, rect: pygame.Rect, painter: Painter) -> None:
        """Place the line between the times of its ends; leave them out if it would be short."""
        ui, fonts = painter.ui, painter.fonts
        pad, gap, size = 20 * ui, 12 * ui, 13 * ui
        first, last = "0 s", self._time(self.high, digits=0)
        left = rect.left + pad + fonts.width(first, size) + gap
        right = rect.right - pad - fonts.width(last, size) - gap
        labelled = right - left >= 120 * ui
        if not labelled:
            left, right = rect.left + pad, rect.right - pad
        line = pygame.Rect(round(left), 0, max(0, round(right - left)), round(LINE * ui))
        line.centery = rect.top + round(0.58 * rect.height)
        self._place(rect, line, round(8 * ui))
        if labelled:
            ink, gap, y = painter.theme.muted, round(gap), line.centery
            painter.write(surface, first, size, ink, midright=(line.left - gap, y))
            painter.write(surface, last, size, ink, midleft=(line.right + gap, y))

    def _draw_marks(self, surface: pygame.Surface, painter: Painter) -> None:
        """Draw a tick per event above the line, below it, or both."""
        ui, line, rows = painter.ui, self._line, self.marks()
        thick, long = max(1, round(1.5 * ui)), round(6 * ui)
        above, below = line.top - round(2 * ui) - long, line.bottom + round(2 * ui)
        for kind, mark in MARKS.items():
            top = above if mark.above else below
            height = (below if mark.below else above) + long - top
            wide = thick * (2 if kind == "error" else 1)
            color = mark.color(painter.theme)
            for x in {round(self.x_of(row)) for row in rows.get(kind, ())}:
                surface.fill(color, (x - wide // 2, top, wide, height))

    def _time(self, row: float, digits: int | None = None) -> str:
        """Return the time of a row in words, with enough decimals to tell two rows apart."""
        step = self._player.source.scenario.sampling_time
        if digits is None:
            digits = next((k for k in (0, 1, 2) if abs(round(step, k) - step) < 1e-9), 3)
        seconds = row * step
        whole = digits or abs(seconds - round(seconds)) <= 1e-6
        return f"{seconds:.{digits}f} s" if whole else f"{seconds:.3g} s"


def costs(player: Player) -> str:
    """Return the time that parts of a control step take on average, and the last picture."""
    source = player.source
    if not isinstance(source, Timeline) or not source.newest:
        return ""
    spent = source.world.simulation.seconds
    times = {name: seconds / source.newest for name, seconds in spent.items()}
    unit, scale, digits = ("ms", 1e3, 1) if sum(times.values()) >= 1e-3 else ("µs", 1e6, 0)
    times["picture"] = player.drawing
    parts = ", ".join(f"{name} {scale * each:.{digits}f}" for name, each in times.items())
    return f"{unit}: {parts}"
