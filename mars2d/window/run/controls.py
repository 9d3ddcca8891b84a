"""The controls below the picture: the time bar with its marks, and the slider of the speed."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence

import pygame

from mars2d.output.raster.layout import Layout
from mars2d.output.raster.painter import Painter
from mars2d.record.marks import MarkKind, meetings
from mars2d.window.run.mouse import Handle, Pixel
from mars2d.window.run.timebar import TimeBar, TimeState
from mars2d.window.screen.player import SPEEDS, Player
from mars2d.window.screen.source import Playback, Source, done_in
from mars2d.window.widgets.slider import SpeedSlider
from mars2d.world.timeline import Timeline
from mars2d.world.world import World

MARK_INTERVAL = 0.25
"""How often the log of contacts is read for collisions, seconds."""


class Controls:
    """Shows a player's time and speed, and lets the mouse change them.

    handles: for the mouse.
    """

    def __init__(self, player: Player, marked: Source) -> None:
        """Start with nothing drawn; marked: the source whose events are marked."""
        self._player, self._marked = player, marked
        self._read: tuple[object, float] = None, 0.0  # the run whose contacts were read, and when
        self._touched: list[int] = []
        self.time_bar, self.slider = TimeBar(), SpeedSlider(SPEEDS)
        self.handles: list[Handle] = [
            (self.time_bar.hit, self._scrub),
            (self.slider.hit, self._choose_speed),
        ]

    def draw(
        self,
        surface: pygame.Surface,
        layout: Layout,
        painter: Painter,
        pointer: Pixel | None,
        drags: Callable[[Callable[[Pixel], None]], bool],
    ) -> None:
        """Draw both; drags: whether the mouse drags the handle with a given function."""
        player = self._player
        self.time_bar.draw(
            surface, layout.timebar, painter, self.time_state(), pointer=pointer,
            held=drags(self._scrub),
        )  # fmt: skip
        self.slider.draw(
            surface, layout.slider, painter, player.speed, pointer=pointer,
            held=drags(self._choose_speed), costs=self._costs(),
        )  # fmt: skip

    def _costs(self) -> str:
        """Return the time that parts of a control step take on average, and the last picture."""
        source = self._player.source
        if not isinstance(source, Timeline) or not source.newest:
            return ""
        spent = source.world.simulation.seconds
        times = {name: seconds / source.newest for name, seconds in spent.items()}
        unit, scale, digits = ("ms", 1e3, 1) if sum(times.values()) >= 1e-3 else ("µs", 1e6, 0)
        times["picture"] = self._player.drawing
        parts = ", ".join(f"{name} {scale * each:.{digits}f}" for name, each in times.items())
        return f"{unit}: {parts}"

    def time_state(self) -> TimeState:
        """Return the state that the time bar shows."""
        source = self._player.source
        live = not isinstance(source, Playback)
        return TimeState(
            row=source.row,
            rows=source.newest,
            last=source.scenario.last_iteration if live else source.newest,
            sampling_time=source.scenario.sampling_time,
            marks=self._marks(),
            live=live,
        )

    def _marks(self) -> Mapping[MarkKind, Sequence[int]]:
        """Return the rows of each kind in ascending order; collisions may lag by a moment."""
        source, now = self._marked, time.monotonic()
        run = source.world if isinstance(source, Timeline) else source
        if run is not self._read[0] or now >= self._read[1] + MARK_INTERVAL:
            self._read = run, now
            self._touched = meetings(source.contacts, source.scenario.sampling_time)
        marks: dict[MarkKind, Sequence[int]] = {"collision": self._touched}
        marks["hand"] = sorted({each.row for each in done_in(source)})
        if isinstance(run, World) and isinstance(source, Timeline):
            marks["branch"] = sorted({source.branch.common(other) for other in source.branches})
            marks["error"] = [run.iteration] if run.over and not run.finished else []
        return marks

    def _scrub(self, pixel: Pixel) -> None:
        """Go to the row at a pixel of the time bar."""
        row = self.time_bar.row_at(pixel[0])
        if row is not None:
            self._player.go(row)

    def _choose_speed(self, pixel: Pixel) -> None:
        """Play at the speed at a pixel of the slider."""
        speed = self.slider.speed_at(pixel[0])
        if speed != self._player.speed:
            self._player.set_speed(speed)
