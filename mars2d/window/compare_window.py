"""The window of a comparison: three arenas in step, and how far apart the runs get below."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import pygame

from mars2d.core.errors import Mars2dError
from mars2d.output.figures.comparison import MODES
from mars2d.output.films.triptych import TITLE_HEIGHT, Arena
from mars2d.output.raster.bars import Status, draw_footer, draw_header, footer_height
from mars2d.output.raster.layout import Layout
from mars2d.output.raster.picture import summary
from mars2d.output.raster.stage import MEMORY
from mars2d.window.driftplot import DriftPlot
from mars2d.window.run import keys
from mars2d.window.run.ending import Ending
from mars2d.window.run.player_window import PlayerWindow
from mars2d.window.run.toolbar import Toolbar
from mars2d.window.screen.display import Preferences
from mars2d.window.screen.viewpoint import Viewpoint, wheel_notches
from mars2d.window.trio import Trio
from mars2d.window.widgets.actions import Action

Pixel = tuple[int, int]

HINTS = (("Space", "pause"), ("← →", "step"), ("N", "contact"), ("F1", "help"))
PLOT_SHARE, MIN_PLOT = 0.34, 150.0
"""The largest part of the height for the plot, and its least height, points."""


class CompareWindow(PlayerWindow):
    """Shows a trio of runs until the window is closed.

    The keys of time and of looks are those of the run window; a click or drag in the plot is one on
    the time bar. The camera is the same for all three arenas. speed, size, preferences: as for
    `Window`.
    """

    def __init__(
        self,
        trio: Trio,
        speed: float | str = 1.0,
        size: tuple[int, int] = (1280, 720),
        preferences: Preferences | None = None,
    ) -> None:
        """Prepare; the window opens with `run`."""
        name = trio.scenario.title
        title, stem = f"{name}, compared", f"{name} compared"
        super().__init__(
            trio, speed, size, preferences, title=title, stem=stem, marked=trio.contact
        )
        self.trio, self.plot = trio, DriftPlot()
        self.arenas = [Arena(mode, self.looks.painter, MEMORY // len(MODES)) for mode in MODES]
        self._ending = Ending(self.player)
        self._dragged: Callable[[Pixel], None] | None = None
        self.viewpoint = Viewpoint(trio.scenario, self._arranged(size))
        self.toolbar = Toolbar(self._actions, self._is_on, live=True)

    def _calls(self) -> object:
        return [each.world.simulation.calls for each in self.trio.timelines.values()]

    def _pass_time(self, seconds: float) -> None:
        self.player.pass_time(seconds)

    # -- drawing --------------------------------------------------------------------------------

    def _arranged(self, size: tuple[int, int]) -> Layout:
        """Give arenas and plot their places; return a layout whose picture is the first arena."""
        banner = self._ending.banner()
        painter, text, scale = self.looks.painter, self.looks.text, self.looks.scale
        foot = footer_height(banner, size, painter, text, scale)
        whole = self.looks.layout(size, foot, controls=True)
        painter.ui, ui, room = whole.ui, whole.ui, whole.plot
        top = room.top + round(TITLE_HEIGHT * ui)
        low = round(min(max(PLOT_SHARE * room.height, MIN_PLOT * ui), 0.5 * room.height))
        xmin, xmax, ymin, ymax = self.trio.scenario.bounds
        wide = room.width / 3 - 64 * ui
        wanted = round(max(wide, 1.0) * (ymax - ymin) / (xmax - xmin) + 36 * ui)
        high = max(1, min(wanted, room.bottom - low - top))
        edges = [room.left + round(k * room.width / 3) for k in range(4)]
        for arena, left, right in zip(self.arenas, edges, edges[1:], strict=False):
            arena.plot = pygame.Rect(left, top, right - left, high)
        self._plot_place = pygame.Rect(room.left, top + high, room.width, room.bottom - top - high)
        self._whole = whole
        return replace(whole, plot=self.arenas[0].plot)

    def draw(self, surface: pygame.Surface, *, notes: bool = True) -> None:
        """Draw the window on a surface; the layout follows its size."""
        layout, painter, trio = self._arranged(surface.get_size()), self.looks.painter, self.trio
        ui, whole = layout.ui, self._whole
        self.viewpoint.arrange(layout, trio.scenario)
        frame = self.player.frame
        surface.fill(painter.theme.page)
        first, counts = self.arenas[0].plot, trio.collisions
        frames = trio.frames(frame.time)
        layers = self.layers if self.player.error is None else self._own_layers()
        for arena in self.arenas:
            camera = self.viewpoint.camera.panned(arena.plot.left - first.left, 0)
            arena.paint(
                surface, frames[arena.mode], camera, layers, counts[arena.mode],
                hurried=self.viewpoint.hurried,
            )  # fmt: skip
            if arena is not self.arenas[0]:
                surface.fill(
                    painter.theme.edge, (arena.plot.left, whole.plot.top, round(ui), first.bottom)
                )
        step = trio.scenario.sampling_time
        times = step, frame.time, step * trio.newest
        self.plot.draw(surface, self._plot_place, painter, trio.drifts, *times)
        text, kind = self.player.status()
        draw_header(surface, whole, painter, frame, Status(text, kind))
        pointer = self._pointer
        self._controls.draw(surface, whole, painter, pointer, lambda drag: self._dragged == drag)
        draw_footer(surface, whole, painter, self._ending.banner(), summary(frame), HINTS)
        self.toolbar.draw(surface, whole, painter, pointer)
        if notes:
            self.notes.draw(surface, whole.plot, painter, time.monotonic())
        self.help.draw(surface, whole, painter, self._help())

    def _help(self) -> list[tuple[str, list[Action]]]:
        """Return the keys that do something here, in their groups."""
        return [
            (group, [key for key in each if key.name in self._actions])
            for group, each in keys.GROUPS.items()
            if group != "Mouse"
        ]

    # -- events ---------------------------------------------------------------------------------

    def _take(self, event: pygame.Event) -> bool:
        return self.toolbar.handle(event) or self._controls.handle(event)

    def _point(self, event: pygame.Event) -> None:
        """Handle the mouse on the arenas, the plot and the bars."""
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == pygame.BUTTON_LEFT:
            handles = [*self._controls.handles, (self.plot.hit, self._scrub)]
            self._dragged = next((drag for hit, drag in handles if hit(event.pos)), None)
            if self._dragged is None and self._arena_at(event.pos) is not None:
                self._dragged = self._pan
            elif self._dragged is not None:
                self._dragged(event.pos)
        elif event.type == pygame.MOUSEBUTTONUP:
            self._dragged = None
        elif event.type == pygame.MOUSEMOTION and self._dragged == self._pan:
            self.viewpoint.pan(*event.rel)
        elif event.type == pygame.MOUSEMOTION and self._dragged is not None:
            self._dragged(event.pos)
        elif event.type == pygame.MOUSEWHEEL:
            x, y = pygame.mouse.get_pos()
            arena = self._arena_at((x, y))
            if arena is not None:
                shift = arena.plot.left - self.arenas[0].plot.left
                self.viewpoint.zoom(wheel_notches(event), (x - shift, y))

    def _arena_at(self, pixel: Pixel) -> Arena | None:
        if self.help.is_open or self.toolbar.covers(pixel):
            return None
        return next((each for each in self.arenas if each.plot.collidepoint(pixel)), None)

    def _pan(self, pixel: Pixel) -> None:
        """Move the pictures; `_point` does it by how far the mouse has moved."""

    def _scrub(self, pixel: Pixel) -> None:
        """Go to the time at a pixel of the plot."""
        at = self.plot.time_at(pixel[0])
        self.player.go(round(at / self.trio.scenario.sampling_time))

    # -- commands -------------------------------------------------------------------------------

    def _restart(self) -> None:
        """Start again, with the file as it is now."""
        self.notes.clear()
        try:
            self.player.restart()
        except Mars2dError as error:  # the file can't be read
            self.notes.say(str(error), "error")

    def _save_picture(self) -> None:
        """Save a picture of the three arenas and the plot."""
        surface = pygame.Surface(self._whole.size, 0, 32)
        self.draw(surface, notes=False)
        plot, head = self._whole.plot, self._whole.header
        self.saver.picture(
            surface.subsurface((plot.left, 0, plot.width, head.height + plot.height))
        )
