"""The window of a comparison: three arenas in step, and how far apart the runs get below."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace

import pygame

from mars2d.core.errors import counted
from mars2d.core.scene import Scene
from mars2d.output.figures.comparison import (
    COLORS,
    COUNTED,
    CURVES,
    MEANINGS,
    MODES,
    NO_DRIFT,
    Drift,
)
from mars2d.output.films.footage import Cut
from mars2d.output.layers.table import Layers
from mars2d.output.raster.bars import Status, draw_header
from mars2d.output.raster.camera import PIXELS
from mars2d.output.raster.layout import Layout
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.stage import Stage
from mars2d.record.frame import Frame
from mars2d.window.run.mouse import Handle, Mouse, Pixel
from mars2d.window.run.player_window import PlayerWindow
from mars2d.window.run.toolbar import Toolbar
from mars2d.window.screen.display import Preferences
from mars2d.window.screen.source import Trio
from mars2d.window.screen.viewpoint import Viewpoint
from mars2d.window.widgets.plot import Axes
from mars2d.window.widgets.slider import Slider

LEFT, RIGHT, HEAD, FOOT = 72.0, 24.0, 34.0, 26.0
"""The room round the axes, points."""
MIN_TIME = 2.0
"""The shortest time axis, seconds."""
SIZE, SIGN = 13.0, 48.0
"""The height of letters above it, and the room for the sign of a curve, points."""
TITLE = "Distance from where contact puts a body"
HIDDEN = 0.01
"""How near a curve has to be to another to be hidden by it, in parts of the axis."""


def _alike(one: Drift, other: Drift, name: str, apart: float) -> bool:
    """Return whether a curve of one drift lies on that of another."""
    both = zip(getattr(one, name).tolist(), getattr(other, name).tolist(), strict=False)
    return all(abs(a - b) < apart for a, b in both)


class DriftPlot(Slider):
    """Draws the largest and the mean drift of "stop" and "ideal"; a press on it is a time."""

    @property
    def area(self) -> pygame.Rect:
        """Where the axes were drawn."""
        return self._line

    def draw(
        self,
        surface: pygame.Surface,
        rect: pygame.Rect,
        painter: Painter,
        drifts: Mapping[str, Drift],
        now: float,
        end: float,
        largest: float,
    ) -> None:
        """Draw the plot within a rectangle.

        drifts: by the physics. now, end: the time that is shown, and that of the last row, seconds.
        largest: the scale of the words above it, if they have room.
        """
        ui, theme, fonts, scene = painter.ui, painter.theme, painter.fonts, Scene()
        surface.fill(theme.paper, rect)
        surface.fill(theme.edge, (rect.left, rect.top, rect.width, 1))
        farthest = max(float(drift.max.max(initial=0.0)) for drift in drifts.values())
        agree, self.high = farthest < NO_DRIFT, max(end, MIN_TIME)
        high = 1.0 if agree else 1.06 * farthest
        words, above = dict[tuple[str, str], str](), drifts[next(iter(drifts))]
        for mode, drift in drifts.items():
            for name, *_ in CURVES:
                hidden = drift is not above and _alike(drift, above, name, HIDDEN * high)
                words[mode, name] = f"{mode}, {name}{': the same' * hidden}"
        need = sum(fonts.width(word, SIZE) + SIGN for word in words.values())
        wide = rect.width - round((LEFT + RIGHT) * ui)
        large = max(ui, min(largest, wide / need))
        left, top = rect.left + round(LEFT * ui), rect.top + round(HEAD * large)
        area = pygame.Rect(left, top, wide, rect.bottom - top - round(FOOT * ui))
        self._line = self._area = area
        if area.width <= 0 or area.height <= 0:
            return
        axes = Axes(area, 0.0, self.high, 0.0, high)
        axes.draw(surface, painter, "m")
        right, middle = area.right, (rect.top + area.top) // 2
        for mode, drift in reversed(list(drifts.items())):
            for name, dash, width in reversed(CURVES):
                look = {"stroke": COLORS[mode], "width": width, "style": dash}
                for points in axes.lines(drift.time, getattr(drift, name)):
                    scene.line(points * (1, -1), **look)
                at, size = (right, middle), SIZE * large
                place = painter.write(surface, words[mode, name], size, theme.text, midright=at)
                left = place.left - round(30 * large)
                scene.line([(left, -middle), (left + 24 * large, -middle)], **look)
                right = left - round(14 * large)
        x = axes.x_of(now)
        scene.line([(x, -area.top), (x, -area.bottom)], stroke=theme.selected, width=1.2)
        painter.paint(surface, scene.shapes, PIXELS)
        if agree:
            at = area.center
            painter.write(surface, "the three runs agree", 13 * ui, theme.muted, center=at)
        if fonts.width(TITLE, SIZE * large, bold=True) < right - area.left:
            at = area.left, middle
            painter.write(surface, TITLE, SIZE * large, theme.ink, bold=True, midleft=at)


TITLE_HEIGHT = 74.0
"""The height of the title above an arena, points."""
WIDE, TALL, SMALLEST = 290.0, 390.0, 0.75
"""The width of an arena and the height of arenas with titles and plot in which letters are as large
as everywhere, points; where there is less room they are smaller, down to this size."""
PLOT_SHARE, MIN_PLOT = 0.34, 150.0
"""The largest part of the height for the plot, and its least height, points."""


class CompareWindow(PlayerWindow):
    """Shows a trio of runs until the window is closed.

    The keys of time and of looks are those of the run window; a click or drag in the plot is one on
    the time bar. The camera is the same for all three arenas. speed, size, preferences: as for
    `Window`. plots: where the arenas are, by the physics.
    """

    def __init__(
        self,
        trio: Trio,
        speed: float | str = 1.0,
        size: tuple[int, int] = (1280, 720),
        preferences: Preferences | None = None,
    ) -> None:
        """Prepare; the window opens with `run`."""
        title, stem = (f"{trio.scenario.title}{word}" for word in (", compared", " compared"))
        marked = trio.runs["contact"]
        super().__init__(trio, speed, size, preferences, title=title, stem=stem, marked=marked)
        self.trio, self.plot = trio, DriftPlot()
        self._stages = {mode: Stage(self.looks.painter) for mode in MODES}
        self.viewpoint = Viewpoint(trio.scenario, self._arrange(self.looks.layout(size)))
        self._leave_out_names(self._ui)
        handles = [*self.handles, Handle(self.plot.hit, self._scrub)]
        self.mouse = Mouse(self.viewpoint, handles, self._place)
        self.toolbar = Toolbar(self._actions, self._is_on, self.menu, live=True)

    # -- drawing --------------------------------------------------------------------------------

    def film(self, cut: Cut, size: tuple[int, int], status: str) -> Iterator[pygame.Surface]:
        """Yield the pictures of a film of a part of the runs, all on one surface of `size` pixels.

        status: the text beside the time.
        """
        surface, step = pygame.Surface(size, 0, 32), self.trio.scenario.sampling_time
        for moment in cut.moments.tolist():
            while step * self.trio.row < moment - 1e-9 and not self.trio.over:
                self.trio.advance()
            layout = self.looks.layout(size, 0.0)
            latest = self._draw_runs(surface, layout, self.layers, moment)
            draw_header(surface, layout, self.looks.painter, latest, Status(status))
            yield surface

    def _draw_picture(self, surface: pygame.Surface, layout: Layout, layers: Layers) -> None:
        self._draw_runs(surface, layout, layers, self.player.frame.time)

    def _arrange(self, layout: Layout) -> Layout:
        """Give arenas and plot their places; return a layout whose picture is the first arena."""
        room = layout.plot
        ui = self._ui = max(min(layout.ui, room.width / 3 / WIDE, room.height / TALL), SMALLEST)
        top = room.top + round(TITLE_HEIGHT * ui)
        low = round(min(max(PLOT_SHARE * room.height, MIN_PLOT * ui), 0.5 * room.height))
        xmin, xmax, ymin, ymax = self.trio.scenario.bounds
        wide = room.width / 3 - 64 * ui
        wanted = round(max(wide, 1.0) * (ymax - ymin) / (xmax - xmin) + 36 * ui)
        high = max(1, min(wanted, room.bottom - low - top))
        edges = [room.left + round(k * room.width / 3) for k in range(4)]
        self.plots = {
            mode: pygame.Rect(left, top, right - left, high)
            for mode, left, right in zip(MODES, edges, edges[1:], strict=False)
        }
        self._plot_place = pygame.Rect(room.left, top + high, room.width, room.bottom - top - high)
        return replace(layout, plot=self.plots[MODES[0]], ui=ui)

    def _draw_runs(
        self, surface: pygame.Surface, layout: Layout, layers: Layers, moment: float
    ) -> Frame:
        """Draw the arenas and the plot at a time [s]; return the latest frame."""
        painter, trio = self.looks.painter, self.trio
        theme = painter.theme
        self.viewpoint.arrange(self._arrange(layout), trio.scenario)
        painter.ui = self._ui
        surface.fill(theme.page)
        frames, counts = trio.frames(moment), trio.collisions(moment)
        first = self.plots[MODES[0]]
        for mode, plot in self.plots.items():
            camera = self.viewpoint.camera.panned(plot.left - first.left, 0)
            self._stages[mode].draw(
                surface, frames[mode], camera, layers, plot,
                free=[pygame.Rect(plot.topleft, (0, 0))],  # legends would cover the robots
                hurried=self.viewpoint.hurried,
            )  # fmt: skip
            self._draw_title(surface, mode, frames[mode], counts[mode])
            if plot is not first:
                surface.fill(theme.edge, (plot.left, layout.plot.top, 1, plot.bottom))
        end = trio.scenario.sampling_time * trio.newest
        self.plot.draw(surface, self._plot_place, painter, trio.drifts, moment, end, layout.ui)
        painter.ui = layout.ui
        return max(frames.values(), key=lambda frame: frame.time)

    def _draw_title(
        self, surface: pygame.Surface, mode: str, frame: Frame, collisions: int
    ) -> None:
        """Write the physics and the number of collisions above an arena, and what it means."""
        painter, plot = self.looks.painter, self.plots[mode]
        ui, fonts, theme = painter.ui, painter.fonts, painter.theme
        left, right = plot.left + round(44 * ui), plot.right - round(20 * ui)
        level, done = plot.top - round(TITLE_HEIGHT * ui), counted(collisions, COUNTED[mode])
        place = painter.write(
            surface, mode, 21 * ui, theme.shade(COLORS[mode]), bold=True,
            midleft=(left, level + 20 * ui),
        )  # fmt: skip
        if right - place.right >= fonts.width(done, 17 * ui) + 10 * ui:
            painter.write(surface, done, 17 * ui, theme.ink, midright=(right, level + 21 * ui))
        text, color, joints = MEANINGS[mode], theme.muted, frame.scenario.joints
        if joints and mode != "contact":
            kinds = Counter(type(joint).__name__.lower() for joint in joints)
            left_out = [counted(number, kind) for kind, number in kinds.items()]
            text = f"without {', '.join(left_out)}; {text}"
        if frame.over_message:
            text, color = frame.over_message, theme.text
        for k, line in enumerate(fonts.wrap(text, 13.5 * ui, right - left, 2)):
            at = left, level + (43 + 17 * k) * ui
            painter.write(surface, line, 13.5 * ui, color, midleft=at)

    # -- events ---------------------------------------------------------------------------------

    def _place(self, pixel: Pixel) -> Pixel | None:
        """Return where the first arena shows what one of them shows at a pixel."""
        if self.help.is_open or self.toolbar.covers(pixel):
            return None
        left = self.plots[MODES[0]].left
        found = (plot for plot in self.plots.values() if plot.collidepoint(pixel))
        return next(((pixel[0] - plot.left + left, pixel[1]) for plot in found), None)

    def _scrub(self, pixel: Pixel) -> None:
        """Go to the time at a pixel of the plot."""
        at = self.plot.value_at(pixel[0])
        self.player.go(round(at / self.trio.scenario.sampling_time))
