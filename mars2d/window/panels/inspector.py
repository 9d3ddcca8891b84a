"""The inspector: a panel with everything about the selected body."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import pygame

from mars2d.bodies.colors import prop_colors
from mars2d.core.description import snake_case
from mars2d.output.layers.forces import SLIP, SLIPPING
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.window.panels.forcemeter import Meter
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

    height: float
    draw: Callable[[pygame.Surface, pygame.Rect], None]
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
        self._meter = Meter()
        self._image: pygame.Surface | None = None
        self._listed: list[tuple[str, Section]] = []
        self._of: tuple[object, ...] = ()
        self._frame: Frame | None = None
        self._drawn_at = 0.0

    @property
    def is_open(self) -> bool:  # type: ignore[override]
        """Whether a body is shown."""
        return self.selection.body is not None

    def close(self) -> None:
        """Show none."""
        self.selection.body = None

    def heights(self, frame: Frame, width: float) -> tuple[float, float]:
        """Return the least and the wanted height at a width, points."""
        each = [section.height + GAP for _, section in self._look(frame)]
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
            for column, top, part in self._chosen(sections, rect.height, columns):
                left = column * (width + gap)
                place = pygame.Rect(left, top, width, round(part.height * ui))
                part.draw(self._image, place)
        surface.blit(self._image, rect)

    def _look(self, frame: Frame) -> list[tuple[str, Section]]:
        """Return the sections with their names, as they were last seen or as they are now."""
        body, ui, theme = self.selection.body, self.painter.ui, self.painter.theme
        if body is None:
            return []
        of = body, self.plays, touching(frame, body), frame.scenario, ui, theme
        reading = self._meter.read(frame, body)  # at each control step, else it would start over
        now = self._clock()
        late = frame is not self._frame and now - self._drawn_at >= DRAW_INTERVAL
        if not self._listed or of != self._of or late:
            self._listed = list(self._sections(frame, body, reading))
            self._image, self._of, self._frame, self._drawn_at = None, of, frame, now
        return self._listed

    def _pixels(self, section: Section) -> int:
        return round((section.height + GAP) * self.painter.ui)

    def _chosen(
        self, sections: list[tuple[str, Section]], height: int, columns: int = 1
    ) -> Iterator[tuple[int, int, Section]]:
        """Yield the sections for which there is room, in order of importance.

        height: of the columns, pixels. Each section comes with its column and its top, pixels.
        """
        left_out: list[str] = []
        column, top = 0, 0
        whole = sum(self._pixels(section) for _, section in sections) <= height
        last = 0 if whole else round(LINE * self.painter.ui)  # for the names of those left out
        for name, section in sections:
            if top and self._pixels(section) > height - top and column + 1 < columns:
                column, top = column + 1, 0
            important = section.least is not None
            room = height - top - (last if column == columns - 1 and not important else 0)
            if section.least is not None and self._pixels(section) > room:
                lower = room / self.painter.ui - GAP
                section = section._replace(height=max(section.least, lower))  # noqa: PLW2901
            if self._pixels(section) <= room:
                yield column, top, section
                top += self._pixels(section)
            else:
                left_out.append(name)
        if left_out and top + last <= height:
            yield column, top, self._text(f"no room for {', '.join(left_out)}")

    def _sections(self, frame: Frame, body: int, reading: Any) -> Iterator[tuple[str, Section]]:
        """Yield all sections with their names."""
        n = len(frame.scenario.robots)
        rows = state_of(frame, body)
        effort = float(frame.effort[body]) if body < min(n, len(frame.effort)) else None
        height = HEAD + ROW * (len(rows) + (effort is not None))
        yield (
            "its state",
            Section(
                height,
                lambda surface, rect: self._draw_state(surface, rect, frame, body, rows, effort),
            ),
        )
        if frame.scenario.physics == "contact":
            yield "contacts", self._line("contacts", " · ".join(contacts_of(frame, body)) or "none")
        if frame.scenario.physics == "contact" and (reading.force.any() or not self.plays):
            yield (
                "forces",
                Section(
                    FORCE,
                    lambda surface, rect: draw_force(
                        surface, rect, self.painter, frame, body, reading
                    ),
                    MIN_FORCE,
                ),
            )
        dynamics = dynamics_of(frame, body)
        if dynamics:
            yield (
                "energy",
                Section(
                    ROW * len(dynamics),
                    lambda surface, rect: self._draw_rows(surface, rect, rect.top, dynamics),
                ),
            )
        for plot in sensor_plots(frame, body):
            yield plot.sensor.key, self._sensor(plot)
        if body < n and any(addon.carries_messages for addon in frame.scenario.addons):
            heard = [
                f"{sender}, {frame.time - sent:.1f} s ago: {rounded(text)}"
                for sender, sent, text in inbox(frame, body)
            ]
            yield "its inbox", self._list("inbox", heard)

    # -- sections -----------------------------------------------------------------------------

    def _draw_state(
        self,
        surface: pygame.Surface,
        rect: pygame.Rect,
        frame: Frame,
        body: int,
        rows: list[Row],
        effort: float | None,
    ) -> None:
        """Draw the name and kind of a body, and its rows of numbers."""
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        colors = (*frame.scenario.colors, *prop_colors(frame.scenario.props))
        middle = rect.top + round(HEAD / 2 * ui)
        center = rect.left + 7 * ui, float(middle)
        pygame.draw.aacircle(surface, theme.muted, center, 7.5 * ui)
        pygame.draw.aacircle(surface, theme.shade(colors[body]), center, 6.5 * ui)
        kind = fonts.render(kind_of(frame, body), 12.5 * ui, theme.muted)
        beside = rect.right - round(CLOSE * ui)
        surface.blit(kind, kind.get_rect(midright=(beside, middle)))
        room = beside - rect.left - kind.get_width() - 34 * ui
        name = fonts.shorten(str(frame.scenario.bodies[body].name), 17 * ui, room, bold=True)
        image = fonts.render(name, 17 * ui, theme.ink, bold=True)
        surface.blit(image, image.get_rect(midleft=(rect.left + round(22 * ui), middle)))
        top = rect.top + round(HEAD * ui)
        self._draw_rows(surface, rect, top, rows)
        if effort is not None:
            line = pygame.Rect(
                rect.left, top + round(len(rows) * ROW * ui), rect.width, round(ROW * ui)
            )
            self._draw_effort(surface, line, effort)

    def _draw_rows(
        self, surface: pygame.Surface, rect: pygame.Rect, top: int, rows: list[Row]
    ) -> None:
        """Draw rows of numbers one below the other."""
        ui = self.painter.ui
        for k, (what, numbers) in enumerate(rows):
            line = pygame.Rect(rect.left, top + round(k * ROW * ui), rect.width, round(ROW * ui))
            self._draw_row(surface, line, what, numbers)

    def _draw_row(
        self,
        surface: pygame.Surface,
        rect: pygame.Rect,
        what: str,
        numbers: list[tuple[str, str]],
    ) -> None:
        """Draw a row of up to three numbers, in columns if these are wide enough."""
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        image = fonts.render(what, 12.5 * ui, theme.muted)
        surface.blit(image, image.get_rect(midleft=rect.midleft))
        left, gap = rect.left + round(LABEL * ui), round(8 * ui)
        column = (rect.right - left) / 3
        for size in (12.5 * ui, 11.5 * ui, 10.5 * ui):
            texts = [[fonts.render(f"{name} ", size, theme.muted),
                      fonts.render(value, size, theme.ink)] for name, value in numbers]  # fmt: skip
            widths = [sum(image.get_width() for image in pair) for pair in texts]
            if sum(widths) + gap * (len(widths) - 1) <= rect.right - left:
                break
        in_columns = all(width + gap <= column for width in widths[:-1])
        x = left
        for k, pair in enumerate(texts):
            x = round(left + k * column) if in_columns else x
            for image in pair:
                surface.blit(image, image.get_rect(midleft=(x, rect.centery)))
                x += image.get_width()
            x += gap

    def _draw_effort(self, surface: pygame.Surface, rect: pygame.Rect, effort: float) -> None:
        """Draw the effort of the drive as a bar."""
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        image = fonts.render("effort", 12.5 * ui, theme.muted)
        surface.blit(image, image.get_rect(midleft=rect.midleft))
        slips = effort >= SLIPPING
        word = fonts.render("slips" if slips else f"{100 * effort:.0f} %", 12.5 * ui, theme.ink)
        surface.blit(word, word.get_rect(midright=rect.midright))
        left = rect.left + round(LABEL * ui)
        bar = pygame.Rect(left, 0, rect.right - round(52 * ui) - left, round(6 * ui))
        bar.centery = rect.centery
        radius = bar.height // 2
        pygame.draw.rect(surface, theme.track, bar, border_radius=radius)
        bar.width = round(bar.width * min(effort, 1.0))
        if bar.width > 0:
            color = SLIP if slips else theme.effort
            pygame.draw.rect(surface, color, bar, border_radius=radius)

    def _sensor(self, plot: SensorPlot) -> Section:
        """Return the section of a sensor: its name and its plot."""
        ui = self.painter.ui

        def draw(surface: pygame.Surface, rect: pygame.Rect) -> None:
            kind = snake_case(type(plot.sensor).__name__)
            self._heading(surface, rect, plot.sensor.key, "" if kind == plot.sensor.key else kind)
            rest = pygame.Rect(rect.left, 0, rect.width, round(plot.height * ui))
            rest.bottom = rect.bottom
            plot.draw(surface, rest, self.painter)

        return Section(TITLE + plot.height, draw)

    def _line(self, title: str, text: str) -> Section:
        """Return a section of one line."""
        ui, fonts = self.painter.ui, self.painter.fonts

        def draw(surface: pygame.Surface, rect: pygame.Rect) -> None:
            room = rect.width - fonts.width(title, 12.5 * ui, bold=True) - 12 * ui
            self._heading(surface, rect, title, fonts.shorten(text, 12 * ui, room))

        return Section(TITLE, draw)

    def _list(self, title: str, lines: list[str]) -> Section:
        """Return a section of lines of text; its height does not depend on their number."""
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme

        def draw(surface: pygame.Surface, rect: pygame.Rect) -> None:
            self._heading(surface, rect, title, "" if lines else "nothing yet")
            for k, line in enumerate(lines[:MAX_MESSAGES]):
                text = fonts.shorten(line, 12.5 * ui, rect.width)
                image = fonts.render(text, 12.5 * ui, theme.text)
                middle = rect.top + round((TITLE + (k + 0.5) * LINE) * ui)
                surface.blit(image, image.get_rect(midleft=(rect.left, middle)))

        return Section(TITLE + MAX_MESSAGES * LINE, draw)

    def _text(self, text: str) -> Section:
        """Return a section of one muted line."""
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme

        def draw(surface: pygame.Surface, rect: pygame.Rect) -> None:
            short = fonts.shorten(text, 11.5 * ui, rect.width)
            image = fonts.render(short, 11.5 * ui, theme.muted)
            surface.blit(image, image.get_rect(midleft=rect.midleft))

        return Section(LINE - GAP, draw)

    def _heading(self, surface: pygame.Surface, rect: pygame.Rect, title: str, more: str) -> None:
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        middle = rect.top + round(TITLE / 2 * ui)
        surface.fill(theme.edge, (rect.left, rect.top - round(GAP / 2 * ui), rect.width, 1))
        image = fonts.render(title, 12.5 * ui, theme.ink, bold=True)
        surface.blit(image, image.get_rect(midleft=(rect.left, middle)))
        image = fonts.render(more, 12 * ui, theme.muted)
        surface.blit(image, image.get_rect(midright=(rect.right, middle)))


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
