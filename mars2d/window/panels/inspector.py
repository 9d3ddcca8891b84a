"""The inspector: a panel with everything about the selected body."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import NamedTuple

import pygame

from mars2d.bodies.colors import prop_colors
from mars2d.core.description import snake_case
from mars2d.output.layers.forces import SLIP, SLIPPING
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.window.panels.forcemeter import reading_of
from mars2d.window.panels.forceplot import draw_force
from mars2d.window.panels.readout import (
    MAX_MESSAGES,
    Row,
    contacts_of,
    dynamics_of,
    inbox,
    kind_of,
    rounded,
    state_of,
    touching,
)
from mars2d.window.panels.sensorplot import TITLE, SensorPlot, plot_of
from mars2d.window.screen.selection import Selection
from mars2d.window.widgets.dock import Panel
from mars2d.window.widgets.words import Word, write_line

COLUMN, LEAST, LEAST_IN_CONTACT = 300.0, 176.0, 268.0
"""The least width of a column of sections, and the least height of the inspector, points: with the
state, and where there are forces with their plot."""

GAP = 9.0
"""The gap between two sections, points."""
HEAD, ROW, FORCE, LINE = 36.0, 19.0, 118.0, 17.0
"""The heights of the name, a row of numbers, the plot of forces and a line of text, points."""
MIN_FORCE = 70.0
"""The lowest plot of forces, points."""
CLOSE = 20.0
"""The room for the button that closes it, points."""
LABEL = 80.0
"""The room for the label of a row, points."""

DRAW_INTERVAL = 1 / 15
"""The shortest time between two drawings while only numbers change, seconds."""


class Section(NamedTuple):
    """A section of the inspector; draw: draws it within a rectangle.

    height: points. least: the lowest height where there is little room; None: the same height.
    """

    name: str
    height: float
    draw: Callable[[pygame.Surface, pygame.Rect], object]
    least: float | None = None


class Inspector(Panel):
    """Shows the state, contacts, forces, sensors and messages of one body.

    clock: seconds; the inspector is drawn again a few times a second, and as soon as the body comes
    to touch another or parts from it, since it stands beside the arrows.

    selection: which body is shown; where none is, the inspector is closed. plays: whether somebody
    drives it, who needs no plot of forces before there are any.
    """

    name, title, headed, frames, remembered = "inspector", "Inspector", False, False, False

    def __init__(
        self,
        painter: Painter,
        selection: Selection,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        """Start with nothing drawn."""
        self.painter, self.selection, self.plays = painter, selection, False
        self._clock = clock
        self._image: pygame.Surface | None = None
        self._sections: list[Section] = []
        self._of: tuple[object, ...] = ()
        self._frame: Frame | None = None
        self._drawn_at = 0.0
        self._cut = False  # whether there is no room for all sections
        self._first = 0  # how many sections behind the state are turned away by the wheel

    @property
    def is_open(self) -> bool:
        """Whether a body is shown."""
        return self.selection.body is not None

    def close(self) -> None:
        """Show none."""
        self.selection.body = None

    def heights(self, frame: Frame, width: float) -> tuple[float, float]:
        """Return the least and the wanted height at a width, points."""
        each = [section.height + GAP for section in self._look(frame)]
        columns = _columns(width)
        wanted = sum(each) if columns == 1 else (sum(each) + max(each)) / columns
        least = LEAST_IN_CONTACT if frame.scenario.physics == "contact" else LEAST
        if columns > 1:
            least = max(LEAST, *each)
        return least, max(least, wanted)

    def draw(self, surface: pygame.Surface, rect: pygame.Rect, frame: Frame) -> None:
        """Draw the inspector within a rectangle."""
        sections, ui = self._look(frame), self.painter.ui
        if self._image is None or self._image.get_size() != rect.size:
            columns = _columns(rect.width / ui)
            gap = round(2 * GAP * ui)
            close = round(CLOSE * ui) if columns > 1 else 0
            width = (rect.width - close - (columns - 1) * gap) // columns
            self._image = pygame.Surface(rect.size, 0, 32)
            self._image.fill(self.painter.theme.plate)
            whole = sum(map(self._pixels, sections)) <= rect.height * columns
            last = 0 if whole else max(len(sections) - 2, 0)
            self._first = min(max(self._first, 0), last)
            shown = [*sections[:1], *sections[1 + self._first :]]
            for column, top, part in self._chosen(shown, rect.height, columns):
                left = column * (width + gap)
                part.draw(self._image, pygame.Rect(left, top, width, round(part.height * ui)))
        surface.blit(self._image, rect)

    def handle(self, event: pygame.Event) -> bool:
        """Turn to further sections by the wheel where there is no room for all."""
        if event.type == pygame.MOUSEWHEEL:
            turned = event.y if event.y > 0 or self._cut else 0
            self._first, self._image = self._first - turned, None
        return False

    def _look(self, frame: Frame) -> list[Section]:
        """Return the sections as they were last seen, or as they are now."""
        body, ui, theme = self.selection.body, self.painter.ui, self.painter.theme
        if body is None:
            return []
        of = body, self.plays, touching(frame, body), frame.scenario, ui, theme
        now = self._clock()
        late = frame is not self._frame and now - self._drawn_at >= DRAW_INTERVAL
        if of != self._of or late:
            self._sections = list(self._made(frame, body))
            self._first = self._first if of[:1] == self._of[:1] else 0
            self._image, self._of, self._frame, self._drawn_at = None, of, frame, now
        return self._sections

    def _pixels(self, section: Section) -> int:
        return round((section.height + GAP) * self.painter.ui)

    def _chosen(
        self, sections: Sequence[Section], height: int, columns: int = 1
    ) -> Iterator[tuple[int, int, Section]]:
        """Yield the sections for which there is room, in order of importance.

        height: of the columns, pixels. Each section comes with its column and its top, pixels.
        """
        left_out: list[str] = []
        column, top, self._cut = 0, 0, False
        whole = sum(map(self._pixels, sections)) <= height
        last = 0 if whole else round(LINE * self.painter.ui)  # for the names of those left out
        for each in sections:
            section = each
            if top and self._pixels(section) > height - top and column + 1 < columns:
                column, top = column + 1, 0
            important = section.least is not None
            room = height - top - (last if column == columns - 1 and not important else 0)
            if section.least is not None and self._pixels(section) > room:
                lower = room / self.painter.ui - GAP
                section = section._replace(height=max(section.least, lower))
            if self._pixels(section) <= room:
                yield column, top, section
                top += self._pixels(section)
            else:
                left_out.append(section.name)
        self._cut = bool(left_out)
        if left_out and top + last <= height:
            text = f"turn the wheel for {', '.join(left_out)}"
            word = Word(text, self.painter.theme.muted, 11.5)
            line = partial(write_line, painter=self.painter, left=[word])
            yield column, top, Section("", LINE - GAP, line)

    def _made(self, frame: Frame, body: int) -> Iterator[Section]:
        """Yield all sections."""
        robots, rows = frame.scenario.robots, state_of(frame, body)
        effort = float(frame.effort[body]) if body < min(len(robots), len(frame.effort)) else None
        high = HEAD + ROW * (len(rows) + (effort is not None))
        yield Section("its state", high, partial(self._draw_state, frame, body, rows, effort))
        if frame.scenario.physics == "contact":
            text = " · ".join(contacts_of(frame, body)) or "none"
            yield Section("contacts", TITLE, partial(self._heading, "contacts", text))
            reading = reading_of(frame, body)
            if reading.force.any() or not self.plays:
                plot = partial(draw_force, self.painter, frame, body, reading)
                yield Section("forces", FORCE, plot, MIN_FORCE)
        if dynamics := dynamics_of(frame, body):
            yield Section("energy", ROW * len(dynamics), partial(self._draw_rows, dynamics))
        for sensed in sensor_plots(frame, body):
            high = TITLE + sensed.height
            yield Section(sensed.sensor.key, high, partial(self._draw_sensor, sensed))
        if body < len(robots) and any(each.carries_messages for each in frame.scenario.addons):
            heard = [
                f"{sender}, {frame.time - sent:.1f} s ago: {rounded(text)}"
                for sender, sent, text in inbox(frame, body)
            ]
            high = TITLE + MAX_MESSAGES * LINE  # whatever has come
            yield Section("its inbox", high, partial(self._draw_inbox, heard))

    # -- sections -----------------------------------------------------------------------------

    def _draw_state(
        self,
        frame: Frame,
        body: int,
        rows: Sequence[Row],
        effort: float | None,
        surface: pygame.Surface,
        rect: pygame.Rect,
    ) -> None:
        """Draw the name and kind of a body, and its rows of numbers."""
        ui, theme = self.painter.ui, self.painter.theme
        colors = (*frame.scenario.colors, *prop_colors(frame.scenario.props))
        head = pygame.Rect(rect.topleft, (rect.width - round(CLOSE * ui), round(HEAD * ui)))
        center = rect.left + 7 * ui, float(head.centery)
        pygame.draw.aacircle(surface, theme.muted, center, 7.5 * ui)
        pygame.draw.aacircle(surface, theme.shade(colors[body]), center, 6.5 * ui)
        inset = round(22 * ui)
        head.left, head.width = head.left + inset, head.width - inset
        name = Word(str(frame.scenario.bodies[body].name), theme.ink, 17, bold=True)
        write_line(surface, head, self.painter, [name], [Word(kind_of(frame, body), theme.muted)])
        rest = pygame.Rect(rect.left, head.bottom, rect.width, rect.bottom - head.bottom)
        self._draw_rows(rows, surface, rest)
        if effort is not None:
            line = pygame.Rect(rect.left, 0, rect.width, round(ROW * ui))
            line.top = rest.top + round(len(rows) * ROW * ui)
            self._draw_effort(surface, line, effort)

    def _draw_rows(self, rows: Sequence[Row], surface: pygame.Surface, rect: pygame.Rect) -> None:
        """Draw rows of up to three numbers, in columns if these are wide enough."""
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        left, gap = rect.left + round(LABEL * ui), round(8 * ui)
        column = (rect.right - left) / 3
        for k, (what, numbers) in enumerate(rows):
            y = rect.top + round(k * ROW * ui) + round(ROW * ui) // 2
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

    def _draw_effort(self, surface: pygame.Surface, rect: pygame.Rect, effort: float) -> None:
        """Draw the effort of the drive as a bar."""
        ui, theme = self.painter.ui, self.painter.theme
        slips = effort >= SLIPPING
        value = "slips" if slips else f"{100 * effort:.0f} %"
        words = [Word("effort", theme.muted)], [Word(value, theme.ink)]
        write_line(surface, rect, self.painter, *words)
        left = rect.left + round(LABEL * ui)
        bar = pygame.Rect(left, 0, rect.right - round(52 * ui) - left, round(6 * ui))
        bar.centery = rect.centery
        radius = bar.height // 2
        pygame.draw.rect(surface, theme.track, bar, border_radius=radius)
        bar.width = round(bar.width * min(effort, 1.0))
        if bar.width > 0:
            color = SLIP if slips else theme.effort
            pygame.draw.rect(surface, color, bar, border_radius=radius)

    def _draw_sensor(self, plot: SensorPlot, surface: pygame.Surface, rect: pygame.Rect) -> None:
        """Draw the name of a sensor and its plot."""
        kind, key = snake_case(type(plot.sensor).__name__), plot.sensor.key
        self._heading(key, "" if kind == key else kind, surface, rect)
        rest = pygame.Rect(rect.left, 0, rect.width, round(plot.height * self.painter.ui))
        rest.bottom = rect.bottom
        plot.draw(surface, rest, self.painter)

    def _draw_inbox(self, lines: Sequence[str], surface: pygame.Surface, rect: pygame.Rect) -> None:
        ui, theme = self.painter.ui, self.painter.theme
        self._heading("inbox", "" if lines else "nothing yet", surface, rect)
        for k, line in enumerate(lines):
            row = pygame.Rect(rect.left, 0, rect.width, round(LINE * ui))
            row.top = rect.top + round((TITLE + k * LINE) * ui)
            write_line(surface, row, self.painter, [Word(line, theme.text)])

    def _heading(self, title: str, more: str, surface: pygame.Surface, rect: pygame.Rect) -> None:
        """Draw a line above a section, its title and more at the right."""
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        surface.fill(theme.edge, (rect.left, rect.top - round(GAP / 2 * ui), rect.width, 1))
        line = pygame.Rect(rect.topleft, (rect.width, round(TITLE * ui)))
        room = rect.width - fonts.width(title, 12.5 * ui, bold=True) - 12 * ui
        at_end = Word(fonts.shorten(more, 12 * ui, room), theme.muted, 12)
        write_line(surface, line, self.painter, [Word(title, theme.ink, bold=True)], [at_end])


def _columns(width: float) -> int:
    """Return how many columns of sections stand beside each other in a width, points."""
    return max(1, int(width // COLUMN))


def sensor_plots(frame: Frame, body: int) -> Iterator[SensorPlot]:
    """Yield the plots of a robot's sensors that have read something."""
    if body >= len(frame.scenario.robots):
        return
    for sensor in frame.scenario.robots[body].sensors:
        for robot, reading in frame.readings.get(sensor.key, ()):
            if robot == body:
                yield plot_of(frame, body, sensor, reading)
