"""The window of a comparison: three arenas in step, and how far apart the runs get below."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from math import inf

import pygame

from mars2d.core.errors import Mars2dError
from mars2d.core.watchdog import Watchdog
from mars2d.output.figures.comparison import MODES
from mars2d.output.films.triptych import TITLE_HEIGHT, Arena
from mars2d.output.layers.table import LAYERS, Layers
from mars2d.output.raster.bars import Status, draw_footer, draw_header, footer_height
from mars2d.output.raster.layout import Layout, next_text_size
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.picture import summary
from mars2d.output.raster.stage import MEMORY
from mars2d.output.raster.theme import theme_of
from mars2d.window import keys
from mars2d.window.controls import Controls
from mars2d.window.desktop import desktop_scale, opening_size
from mars2d.window.display import (
    PICTURES_A_SECOND,
    Preferences,
    open_window,
    show_drawn,
    started_display,
)
from mars2d.window.driftplot import DriftPlot
from mars2d.window.help import Help
from mars2d.window.menu import Entry
from mars2d.window.notes import Ending, Notes
from mars2d.window.player import Player, time_actions
from mars2d.window.rest import Rest
from mars2d.window.saving import Saver
from mars2d.window.toolbar import Toolbar, layer_entries
from mars2d.window.trio import Trio
from mars2d.window.viewpoint import Viewpoint, wheel_notches

__all__ = ["CompareWindow"]

Pixel = tuple[int, int]

HINTS = (("Space", "pause"), ("← →", "step"), ("N", "contact"), ("F1", "help"))
ZOOM = 2.0
"""How far a key zooms, in notches of the wheel."""
PLOT_SHARE, MIN_PLOT = 0.34, 150.0
"""The largest part of the height for the plot, and its least height, points."""


class CompareWindow:
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
        preferences = preferences or Preferences()
        self.trio, self.player, self.size = trio, Player(trio, speed), size
        self.layers = Layers.of(trio.scenario.animation)
        self.text, self.scale = preferences.text, 1.0
        self.help, self.notes, self.plot = Help(), Notes(), DriftPlot()
        self.saver = Saver(self.notes, f"{trio.scenario.title} compared")
        self._painter = Painter(theme=theme_of(dark=preferences.dark))
        self.arenas = [Arena(mode, self._painter, MEMORY // len(MODES)) for mode in MODES]
        self._controls, self._ending = Controls(self.player), Ending(self.player)
        self._keyboard, self._rest = keys.Keyboard(), Rest()
        self._open = self._passing = False
        self._dragged: Callable[[Pixel], None] | None = None
        self.viewpoint = Viewpoint(trio.scenario, self._arranged(size))
        self._actions: dict[str, Callable[[], None]] = {
            **time_actions(self.player, self._keyboard.typed),
            "contact": partial(self._to_contact, self.player.next_contact),
            "contact_back": partial(self._to_contact, self.player.last_contact),
            "restart": self._restart,
            "layers": lambda: self.toolbar.open("layers", self._layer_entries),
            **{each.name: partial(self._toggle, each.name) for each in LAYERS if each.key},
            "fit": self.viewpoint.fit,
            "nearer": lambda: self.viewpoint.zoom(ZOOM, self.arenas[0].plot.center),
            "farther": lambda: self.viewpoint.zoom(-ZOOM, self.arenas[0].plot.center),
            "screen": self._fill_screen,
            "dark": self._change_theme,
            "text": self._change_text,
            "picture": self._save_picture,
            "help": self.help.turn,
            "close": self._close,
            "leave": self._leave,
        }
        self.toolbar = Toolbar(self._actions, self._is_on, live=True)

    def run(self) -> None:
        """Open the window and play until it is closed; then raise the error of a failed law.

        Raises what `Window.run` does.
        """
        with started_display():
            self.scale = desktop_scale()
            pygame.display.set_caption(f"{self.trio.scenario.title}, compared - MARS2D")
            screen = open_window(opening_size(self.size, self.scale), self._painter)
            self._open = True
            self.draw(screen)
            show_drawn()
            with Watchdog(self._calls, self._answer):
                self._loop(screen)
        if self.player.error is not None:
            raise self.player.error

    def _calls(self) -> object:
        """Return what changes with each call of the user's code."""
        return [each.world.simulation.calls for each in self.trio.timelines.values()]

    def _answer(self, where: str) -> str:
        """Answer the user while a law takes long at a line; return why to break it off, or ""."""
        if not self._passing:
            return ""
        self.notes.say(f"waiting for {where}; Esc leaves", kind="warning")
        surface = pygame.display.get_surface()
        if surface is not None:
            self.draw(surface)
            show_drawn()
        pygame.event.pump()
        keys_moved = pygame.event.get((pygame.KEYDOWN, pygame.KEYUP))
        for event in keys_moved:  # for later, in their order
            pygame.event.post(event)
        escapes = any(e.type == pygame.KEYDOWN and e.key == pygame.K_ESCAPE for e in keys_moved)
        if pygame.event.peek(pygame.QUIT) or escapes:
            self._open = False
            return "did not return before the window was closed"
        return ""

    def _loop(self, screen: pygame.Surface) -> None:
        clock, last = pygame.time.Clock(), time.perf_counter()
        while self._open:
            for event in self._rest.events():
                self._handle(event)
            now = time.perf_counter()
            self._passing = True  # from here on laws may be asked
            self.player.pass_time(now - last)
            self._passing = False
            last, player = now, self.player
            if player.playing or player.busy or len(self.notes):
                self._rest.stir()
            if not self._rest.resting and pygame.display.get_active():
                self.draw(pygame.display.get_surface() or screen)
                show_drawn()
                player.drawing = time.perf_counter() - now
            if player.speed < inf or not player.playing:
                clock.tick(PICTURES_A_SECOND)

    # -- drawing --------------------------------------------------------------------------------

    def _arranged(self, size: tuple[int, int]) -> Layout:
        """Give arenas and plot their places; return a layout whose picture is the first arena."""
        banner = self._ending.banner()
        foot = footer_height(banner, size, self._painter, self.text, self.scale)
        whole = Layout.of(size, foot, text=self.text, scale=self.scale, controls=True)
        self._painter.ui, ui, room = whole.ui, whole.ui, whole.plot
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
        layout, painter, trio = self._arranged(surface.get_size()), self._painter, self.trio
        ui, whole = layout.ui, self._whole
        self.viewpoint.arrange(layout, trio.scenario)
        frame = self.player.frame
        surface.fill(painter.theme.page)
        first, counts = self.arenas[0].plot, trio.collisions
        frames = trio.frames(frame.time)
        for arena in self.arenas:
            camera = self.viewpoint.camera.panned(arena.plot.left - first.left, 0)
            arena.paint(
                surface, frames[arena.mode], camera, self._seen(), counts[arena.mode],
                hurried=self.viewpoint.hurried,
            )  # fmt: skip
            if arena is not self.arenas[0]:
                surface.fill(
                    painter.theme.edge, (arena.plot.left, whole.plot.top, round(ui), first.bottom)
                )
        step = trio.scenario.sampling_time
        self.plot.draw(surface, self._plot_place, painter, trio.drifts, step, frame.time)
        text, kind = self.player.status()
        draw_header(surface, whole, painter, frame, Status(text, kind))
        pointer = self._pointer
        self._controls.draw(surface, whole, painter, pointer, lambda drag: self._dragged == drag)
        draw_footer(surface, whole, painter, self._ending.banner(), summary(frame), HINTS)
        self.toolbar.draw(surface, whole, painter, pointer)
        if notes:
            self.notes.draw(surface, whole.plot, painter, time.monotonic())
        self.help.draw(surface, whole, painter, self._help())

    def _seen(self) -> Layers:
        """Return the layers, without those that code of the user's draws once it has failed."""
        theirs = ("sensors", "messages", "neighbours", "theory", "addons")
        failed = self.player.error is not None
        return self.layers.switched(**dict.fromkeys(theirs, False)) if failed else self.layers

    def _help(self) -> list[tuple[str, list[keys.Key]]]:
        """Return the keys that do something here, in their groups."""
        return [
            (group, [key for key in each if key.action in self._actions or not key.names])
            for group, each in keys.GROUPS.items()
            if group != "Mouse"
        ]

    @property
    def _pointer(self) -> Pixel | None:
        """Where the mouse is, if it is on the open window."""
        return pygame.mouse.get_pos() if self._open and pygame.mouse.get_focused() else None

    # -- events ---------------------------------------------------------------------------------

    def _handle(self, event: pygame.Event) -> None:
        if event.type == pygame.QUIT:
            self._close()
        elif self.toolbar.handle(event) or self._controls.handle(event):
            pass
        elif event.type == pygame.KEYDOWN:
            key = self._keyboard.press(
                event.key, event.unicode, event.mod, manual=self.player.manual
            )
            if key is not None and key.action in self._actions:
                self._actions[key.action]()
            self._keyboard.forget(event.key, event.unicode)
        elif event.type == pygame.KEYUP:
            self._keyboard.release(event.key)
        elif event.type == pygame.WINDOWFOCUSLOST:
            self._keyboard.clear()
        else:
            self._point(event)

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

    def _is_on(self, action: str) -> bool:
        """Return whether what a button switches is on."""
        return {
            "pause": self.player.playing,
            "loop": self.player.loop,
            "layers": self.toolbar.menu.name == "layers",
            "screen": pygame.display.is_fullscreen() if self._open else False,
            "dark": self._painter.theme.dark,
            "help": self.help.is_open,
        }.get(action, False)

    # -- commands -------------------------------------------------------------------------------

    def _to_contact(self, go: Callable[[], None]) -> None:
        """Go to a contact of the run with contact; forces are shown there."""
        self.layers = self.layers.switched(forces=True, impulses=True)
        go()

    def _restart(self) -> None:
        """Begin anew, with the file as it is now."""
        self.notes.clear()
        try:
            self.player.restart()
        except Mars2dError as error:  # the file can't be read
            self.notes.say(str(error), "error")

    def _layer_entries(self) -> list[Entry]:
        return layer_entries(lambda name: getattr(self.layers, name), self._toggle_alone)

    def _toggle_alone(self, layer: str) -> None:
        self.layers = self.layers.toggled(layer, alone=True)

    def _toggle(self, layer: str) -> None:
        self.layers = self.layers.toggled(layer)

    def _change_theme(self) -> None:
        self._painter.theme = theme_of(dark=not self._painter.theme.dark)

    def _change_text(self) -> None:
        self.text = next_text_size(self.text)

    def _fill_screen(self) -> None:
        try:
            pygame.display.toggle_fullscreen()
        except pygame.error as error:
            self.notes.say(f"no full screen here: {error}", "warning")

    def _save_picture(self) -> None:
        """Save a picture of the three arenas and the plot."""
        surface = pygame.Surface(self._whole.size, 0, 32)
        self.draw(surface, notes=False)
        plot, head = self._whole.plot, self._whole.header
        self.saver.picture(
            surface.subsurface((plot.left, 0, plot.width, head.height + plot.height))
        )

    def _close(self) -> None:
        self._open = False

    def _leave(self) -> None:
        """Close the menu or the help, clear errors, or leave."""
        if self._keyboard.number:
            return
        if self.toolbar.menu.is_open:
            self.toolbar.menu.close()
        elif self.help.is_open:
            self.help.close()
        elif self.notes.failed:
            self.notes.clear()
        else:
            self._close()
