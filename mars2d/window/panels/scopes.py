"""Scopes: a panel of plots over time that follow a run, of several bodies each."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from math import ceil
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.core.errors import InputError, Mars2dError
from mars2d.core.scene import PALETTE
from mars2d.core.usercode import name_of
from mars2d.output.raster.painter import Painter
from mars2d.output.signals import Signal, without_nothing
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario
from mars2d.window.panels.trace import What, read, span_of
from mars2d.window.screen.picking import Selection
from mars2d.window.screen.player import Player
from mars2d.window.screen.saving import Saver
from mars2d.window.screen.viewpoint import wheel_notches
from mars2d.window.widgets.panel import Panel
from mars2d.window.widgets.plot import Axes, as_number, draw_curve
from mars2d.window.widgets.rows import Word, draw_rows, height_of, width_of, write_line
from mars2d.world.timeline import Timeline

Float = NDArray[np.float64]

TITLE, LEFT, FOOT, GAP = 19.0, 52.0, 17.0, 7.0
"""The room for a plot's title, the numbers of its axis and those of the time axis, and the gap to
the next plot, points."""
LEAST, WANTED = 56.0, 124.0
"""The least and the wanted height of a plot with its title, points."""
HIGH = 56.0
"""The height that a plot has at least beside lines for the names of its curves, points."""
LINE = 16.0
"""The height of a line of text, points."""
NAMED = 6
"""The most curves of a plot whose names and numbers are written."""
WIDTH, CROWD = 2.0, 12
"""The width of a curve, points, and the most curves of a plot that are drawn each: of more, their
median and quartiles."""
INTERVAL, SHARE = 1 / 15, 0.1
"""The shortest time between two drawings while time passes, seconds, and the largest share of the
time that they take."""
ZOOM, SHORTEST = 1.25, 10
"""How far a notch of the wheel zooms in time, and the least time that is shown, control steps."""


class _Plot(NamedTuple):
    """A plot that was drawn.

    axes: in the panel's own image. colors, names: of the curves. single: those that are drawn each.
    below: how many lines the names have below the title.
    """

    signal: Signal
    axes: Axes
    colors: Sequence[str]
    names: Sequence[str]
    single: Sequence[int]
    below: int


class Scopes(Panel):
    """Plots of columns of the record over all that was run, with the time shown as a cursor.

    player: of the run, which a click in a plot takes to a row. selection: the body whose curve lies
    above a summary of many. clock: seconds.

    traces: what is plotted, one below the other, and the bodies of each. span: the time that is
    shown, seconds; None: all.
    """

    name, title, remembered = "scopes", "Scopes", False

    def __init__(
        self,
        painter: Painter,
        player: Player,
        selection: Selection,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        """Start with the plots that the experiment's file names; else closed."""
        super().__init__(painter)
        self._player, self._clock = player, clock
        self._selection = selection
        self.traces: dict[What, tuple[int, ...]] = {}
        self.span: float | None = None
        self._plots: list[_Plot] = []
        self._image: pygame.Surface | None = None
        self._place = pygame.Rect(0, 0, 0, 0)
        self._of: tuple[object, ...] = ()
        self._frame: Frame | None = None
        self._next = 0.0  # when it is drawn again while time passes
        self._held: Axes | None = None
        robots = tuple(range(len(player.frame.scenario.robots)))
        for what in self._named:
            self.switch(what, robots if isinstance(what, str) else ())

    # -- what is plotted ----------------------------------------------------------------------

    @property
    def _named(self) -> Sequence[What]:
        """The plots that the experiment's file names."""
        source = self._player.source
        return source.experiment.source.scopes if isinstance(source, Timeline) else ()

    @property
    def functions(self) -> list[Callable[[Any], Any]]:
        """The functions among the plots that the experiment's file names."""
        return [what for what in self._named if not isinstance(what, str)]

    def open(self) -> None:
        """Open it; where nothing is plotted, the robots' speeds are."""
        super().open()
        robots = len(self._player.source.recorded.scenario.robots)
        self.traces = self.traces or {"speed": tuple(range(robots))}

    def shows(self, what: What, bodies: tuple[int, ...]) -> bool:
        """Return whether something is plotted for all of some bodies."""
        return self.is_open and what in self.traces and {*bodies} <= {*self.traces[what]}

    def switch(self, what: What, bodies: tuple[int, ...]) -> None:
        """Plot something for some bodies, beside others for which it is plotted, or no longer."""
        shown, now = self.shows(what, bodies), self.traces.get(what, ()) if self.is_open else ()
        others = tuple(body for body in now if body not in bodies)
        kept = self.traces if self.is_open else {}
        self.traces = {**kept, what: others if shown else (*others, *bodies)}
        if shown and not others:
            del self.traces[what]
        self.wanted = len(self.traces)
        self._image = None

    def meet(self, scenario: Scenario) -> None:
        """Take the functions of a file that was read again; forget bodies that are not there."""
        named, count = {name_of(each): each for each in self.functions}, len(scenario.bodies)
        traces, self.traces = self.traces, {}
        for what, bodies in traces.items():
            left = tuple(body for body in bodies if body < count)
            if left or not bodies:
                again = what if isinstance(what, str) else named.get(name_of(what), what)
                self.traces[again] = left
        self.wanted = self.is_open and len(self.traces)

    # -- saving -------------------------------------------------------------------------------

    def save_figure(self, frame: Frame, saver: Saver) -> None:
        """Save what is plotted as a figure, of all that was run."""

        def write(path: Path) -> None:
            from mars2d.output.figures.figure import save_drawing
            from mars2d.output.figures.signals import draw_signals

            record, (found, _) = self._player.source.recorded, self._signals(frame)
            if not found or not len(record):
                raise InputError("nothing to save: no step was run yet, or nothing is plotted")
            found = [replace(each, values=each.values[: len(record)]) for each in found]

            def draw() -> Any:
                return draw_signals(record, found)[0].figure

            save_drawing(draw, path)

        saver.save("figure", ".png", write)

    def _signals(self, frame: Frame) -> tuple[list[Signal], list[str]]:
        """Return the signals of all that is plotted, and why some of it has none."""
        record, found, errors = self._player.source.recorded, list[Signal](), []
        for what, bodies in self.traces.items():
            try:
                found += map(without_nothing, read(what, bodies, record, frame))
            except Mars2dError as error:
                name = what if isinstance(what, str) else name_of(what)
                errors.append(f"{name}: {str(error).removeprefix('columns: ')}")
        return found, errors

    # -- drawing ------------------------------------------------------------------------------

    def heights(self, frame: Frame, width: float) -> tuple[float, float]:  # noqa: ARG002
        """Return the least and the wanted height, points."""
        count = max(len(self.traces), 1)
        return LEAST * min(count, 2) + FOOT, WANTED * max(count, len(self._plots)) + FOOT

    def draw(self, surface: pygame.Surface, rect: pygame.Rect, frame: Frame) -> None:
        """Draw the plots, and over them the cursor."""
        theme, body = self.painter.theme, self._selection.body
        of = rect.size, self.painter.ui, theme, self.span, len(self.traces), frame.scenario, body
        begin = self._clock()
        late = frame is not self._frame and begin >= self._next
        if self._image is None or of != self._of or late:
            self._image = pygame.Surface(rect.size, 0, 32)
            self._image.fill(theme.plate)
            self._draw_plots(self._image, frame)
            self._of, self._frame, now = of, frame, self._clock()
            self._next = now + max(INTERVAL, (now - begin) / SHARE)
        self._place = rect
        surface.blit(self._image, rect)
        for plot in self._plots:
            self._draw_cursor(surface, plot, frame)

    def _draw_plots(self, surface: pygame.Surface, frame: Frame) -> None:
        """Draw the plots for which there is room, and say what is missing."""
        ui, record, place = self.painter.ui, self._player.source.recorded, surface.get_rect()
        dt, ink = frame.scenario.sampling_time, self.painter.theme.error.ink
        found, said = self._signals(frame)
        fit = max(1, int((place.height / ui - FOOT - 2 * LINE * len(said)) // LEAST))
        if len(found) > fit:
            said.append(f"no room for {', '.join(signal.name for signal in found[fit:])}")
        rows = [row for each in said for row in self.wrapped(Word(each, ink), place.width / ui, 4)]
        draw_rows(surface, rows, place, ui)
        place.height -= round((FOOT + height_of(rows)) * ui)
        place.top, found = round(height_of(rows) * ui), found[:fit]
        start, end = self._shown(frame, max(len(record) - 1, frame.iteration))
        place.height //= max(1, len(found))
        self._plots, before = [], surface.get_clip()
        for signal in found:
            values, times = signal.values, dt * np.arange(len(signal.values), dtype=float)
            plot = self._plot(place, signal, frame.scenario, start, end)
            plot.axes.draw(surface, self.painter, times=signal is found[-1])
            surface.set_clip(plot.axes.area.inflate(2, 4).clip(before))
            if len(plot.colors) > CROWD:
                plot.axes.draw_quartiles(surface, self.painter, times, values)
            for k in plot.single:
                lines = plot.axes.lines(times, values[:, k], held=signal.held, wraps=signal.wraps)
                draw_curve(surface, self.painter, lines, plot.colors[k], WIDTH)
            surface.set_clip(before)
            self._plots.append(plot)
            place.top = place.bottom

    def _shown(self, frame: Frame, newest: int) -> tuple[float, float]:
        """Return the time that is shown, seconds: all, or one of the parts that have the span."""
        dt = frame.scenario.sampling_time
        if self.span is None:
            return 0.0, max(newest * dt, span_of(dt))
        start = frame.time // self.span * self.span
        return start, start + self.span

    def _plot(
        self, place: pygame.Rect, signal: Signal, scenario: Scenario, start: float, end: float
    ) -> _Plot:
        """Return a plot in a place; the colour of a curve is its body's, if it tells them apart."""
        ui, count = self.painter.ui, signal.values.shape[1]
        each = count // max(1, len(signal.bodies))
        bodies = [body for body in signal.bodies for _ in range(each)]
        names = [f"{scenario.bodies[body].name}" for body in bodies]
        names = [f"{name} {k % each}" for k, name in enumerate(names)] if each > 1 else names
        colors = [scenario.body_colors[body] for body in bodies]
        if not colors or len(set(colors)) < count <= len(PALETTE):
            colors = [PALETTE[k % len(PALETTE)] for k in range(count)]
        single: Sequence[int] = range(count)
        if count > CROWD:  # of many only those of the chosen body
            single = [k for k, body in enumerate(bodies) if body == self._selection.body]
        if not bodies:  # in few words: the title says that it is energy
            names = [name.removeprefix("work of ") * (count > 1) for name in signal.curves]
        named = names if 1 < count <= NAMED else []
        wide = width_of(self.painter, [Word(f"{name} {as_number(1.0)}", "", 12) for name in named])
        below = ceil(wide / (place.width - LEFT * ui))
        below = below if place.height >= (HIGH + LINE * below) * ui else 0
        top, left = place.top + round((TITLE + LINE * below) * ui), place.left + round(LEFT * ui)
        area = pygame.Rect(left, top, place.right - left - 2, place.bottom - round(GAP * ui) - top)
        shades = [self.painter.theme.shade(color) for color in colors]
        dt = scenario.sampling_time
        axes = Axes.round(area, start, end, signal.values[int(start / dt) : int(end / dt) + 2])
        return _Plot(signal, axes, shades, names, single, below)

    def _draw_cursor(self, surface: pygame.Surface, plot: _Plot, frame: Frame) -> None:
        """Draw where the time shown lies in a plot, and write the values there."""
        ui, theme = self.painter.ui, self.painter.theme
        axes, signal = self._on_surface(plot), plot.signal
        row = min(frame.iteration, len(signal.values) - 1)
        values = signal.values[row] if row >= 0 else np.full(len(plot.colors), np.nan)
        if axes.start <= frame.time <= axes.end:
            x = round(axes.x_of(frame.time))
            surface.fill(theme.selected, (x, axes.area.top, max(1, round(ui)), axes.area.height))
        high, unit = round(LINE * ui), f" [{signal.unit}]" if signal.unit else ""
        line = pygame.Rect(self._place.left, 0, self._place.width, high)
        line.centery = axes.area.top - round((TITLE / 2 + LINE * plot.below) * ui)
        title = Word(f"{signal.name}{unit}", theme.ink, 12, bold=True)
        free = write_line(surface, line, self.painter, [title])
        if plot.below:
            free = pygame.Rect(axes.area.left, line.bottom, line.right - axes.area.left, high)
        self._write_values(surface, plot, values, free)

    def _write_values(
        self, surface: pygame.Surface, plot: _Plot, values: Float, rect: pygame.Rect
    ) -> None:
        """Write the names and values of curves at the right of some room, as far as they fit."""
        numbers, count = [as_number(float(value)) for value in values], len(plot.names)
        both = [f"{name} {one}".strip() for name, one in zip(plot.names, numbers, strict=True)]
        if count > NAMED:
            text = f"middle half of {count}" if count > CROWD else f"{count} curves"
            own = [Word(both[k], plot.colors[k], 12) for k in plot.single] if count > CROWD else []
            write_line(surface, rect, self.painter, [Word(text, self.painter.theme.muted, 12)], own)
            return
        each = max(1, ceil(count / max(plot.below, 1)))
        for texts in (both, numbers):
            words = [Word(*word, 12) for word in zip(texts, plot.colors, strict=True)]
            lines = [words[k : k + each] for k in range(0, count, each)]
            if all(width_of(self.painter, line) <= rect.width for line in lines):
                for k, line in enumerate(lines):
                    write_line(surface, rect.move(0, k * rect.height), self.painter, right=line)
                return

    def _on_surface(self, plot: _Plot) -> Axes:
        return plot.axes._replace(area=plot.axes.area.move(self._place.topleft))

    # -- the mouse ----------------------------------------------------------------------------

    def handle(self, event: pygame.Event) -> bool:
        """Go to the time of a press, and follow a drag; show more or less time by the wheel."""
        if event.type == pygame.MOUSEWHEEL:
            self.zoom(wheel_notches(event))
            return False
        if event.type == pygame.MOUSEBUTTONUP:
            self._held = None
        elif event.type == pygame.MOUSEBUTTONDOWN and event.button == pygame.BUTTON_LEFT:
            axes = map(self._on_surface, self._plots)
            self._held = next((each for each in axes if each.area.collidepoint(event.pos)), None)
        if self._held is not None:
            dt = self._player.frame.scenario.sampling_time
            self._player.go(max(0, round(self._held.time_at(event.pos[0]) / dt)))
        return self._held is not None

    def zoom(self, notches: float) -> None:
        """Show less time by notches of the wheel, or more, until it is all."""
        if not self._plots or self._frame is None:
            return
        dt, axes = self._frame.scenario.sampling_time, self._plots[0].axes
        whole = max(len(self._plots[0].signal.values) * dt, span_of(dt))
        span = (axes.end - axes.start) * ZOOM**-notches
        self.span = None if span >= whole else max(span, SHORTEST * dt)
