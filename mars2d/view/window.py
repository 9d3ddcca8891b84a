"""The window: watch an experiment, stop it, step through it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pygame

from mars2d.errors import InputError, Mars2dError
from mars2d.frame import Frame
from mars2d.scene import PALETTE, Scene
from mars2d.view import keys
from mars2d.view.bars import (
    Banner,
    Layout,
    Status,
    draw_footer,
    draw_header,
    draw_help,
    fitted,
    footer_height,
)
from mars2d.view.camera import Camera
from mars2d.view.display import NO_DISPLAY, open_display
from mars2d.view.layers import Layers
from mars2d.view.painter import Painter
from mars2d.view.panel import Panel
from mars2d.view.picture import summary
from mars2d.view.player import Player
from mars2d.view.selection import body_at, next_body, selection_mark, sensed_by
from mars2d.view.source import Source
from mars2d.view.stage import Stage

__all__ = ["Window"]

PICTURES_A_SECOND = 60
REPEAT_DELAY, REPEAT_INTERVAL = 400, 60
WHEEL_FACTOR = 1.15
REST = 0.12
"""The camera moves until it has rested for so many seconds."""
HINTS = (("Space", "pause"), ("→", "step"), ("+ \N{MINUS SIGN}", "speed"), ("F1", "help"))
MANUAL_HINTS = (("any key", "step"), ("+", "play"), ("F1", "help"))
CLICK = 5
"""A press of the mouse that moves by less, in pixels, is a click."""
DEEPEST, WIDEST = 400.0, 0.05
"""How far one can zoom in and out, times the scale at which the workspace fits."""


class Window:
    """Shows a source on the screen until it is closed.

    speed: a factor of real time, 0 for one step a key press, or "max". size: pixels, at first.
    Raises InputError when there is no display.
    """

    def __init__(
        self, source: Source, speed: float | str = 1.0, size: tuple[int, int] = (1280, 720)
    ) -> None:
        """Prepare; the window opens with `run`."""
        self.player = Player(source, speed)
        self.size = size
        self.title = f"{source.scenario.title} - MARS2D"
        self.layers = Layers.of(source.scenario.animation)
        self.help = False
        self.selected: int | None = None  # an index of Scenario.bodies
        self._open = False
        self._fits = True
        self._hurry = 0.0
        self._held: set[int] = set()
        self._pressed: tuple[int, int] | None = None
        self._painter = Painter()
        self._stage = Stage(self._painter)
        self._panel = Panel(self._painter)
        self.layout = Layout.of(size)
        self.camera = self._fitted()
        self._actions: dict[str, Callable[[], None]] = {
            "pause": self.player.pause_or_resume,
            "step": self.player.step,
            "faster": self.player.faster,
            "slower": self.player.slower,
            "grid": lambda: self._toggle("grid"),
            "trails": lambda: self._toggle("trails"),
            "sensors": lambda: self._toggle("sensors"),
            "messages": lambda: self._toggle("messages"),
            "forces": lambda: self._toggle("forces"),
            "theory": lambda: self._toggle("theory"),
            "select": self._select_next,
            "fit": self._fit,
            "restart": self.player.restart,
            "help": self._toggle_help,
            "leave": self._leave,
        }

    def run(self) -> None:
        """Open the window and play until it is closed; then raise the error of a law that failed.

        Ctrl+C in the terminal closes it, and KeyboardInterrupt is raised.
        """
        ours = not pygame.display.get_init()
        open_display()
        try:
            screen = self._show()
            self._loop(screen)
        finally:
            if ours:
                pygame.display.quit()
        if self.player.error is not None:
            raise self.player.error

    def _show(self) -> pygame.Surface:
        pygame.display.set_caption(self.title)
        pygame.display.set_icon(_icon(self._painter))
        try:
            screen = pygame.display.set_mode(self.size, pygame.RESIZABLE)
        except pygame.error as error:
            raise InputError(f"the window can't be opened ({error}): {NO_DISPLAY}") from None
        pygame.key.set_repeat(REPEAT_DELAY, REPEAT_INTERVAL)
        self._open = True
        return screen

    def _loop(self, screen: pygame.Surface) -> None:
        clock = pygame.time.Clock()
        last = time.perf_counter()
        while self._open:
            for event in pygame.event.get():
                self._handle(event)
            now = time.perf_counter()
            self.player.pass_time(now - last)
            last = now
            screen = pygame.display.get_surface() or screen
            self.draw(screen)
            pygame.display.flip()
            clock.tick(PICTURES_A_SECOND)

    # -- drawing --------------------------------------------------------------------------------

    def draw(self, surface: pygame.Surface) -> None:
        """Draw everything on a surface; the layout follows its size."""
        try:
            self._draw(surface)
        except Mars2dError as error:  # of what a user's add-on or sensor draws
            self.player.fail(error)
            self._draw(surface)

    def _draw(self, surface: pygame.Surface) -> None:
        banner = self._banner()
        self._arrange(surface.get_size(), banner)
        frame = self.player.frame
        hurried = time.perf_counter() < self._hurry
        marks = [] if self.selected is None else selection_mark(frame, self.selected).shapes
        self._stage.draw(
            surface,
            sensed_by(frame, self.selected),
            self.camera,
            self.layers,
            self.layout.plot,
            marks=marks,
            hurried=hurried,
        )
        place = self._panel_place(frame)
        if place is not None and self.selected is not None:
            self._panel.draw(surface, place, frame, self.selected)
        text, waiting = self.player.status()
        status = Status(text, waiting, error=self.player.error is not None)
        draw_header(surface, self.layout, self._painter, frame, status)
        hints = MANUAL_HINTS if self.player.manual else HINTS
        draw_footer(surface, self.layout, self._painter, banner, summary(frame), hints)
        if self.help:
            draw_help(surface, self.layout, self._painter, (*keys.KEYS, *keys.MOUSE))

    def _panel_place(self, frame: Frame) -> pygame.Rect | None:
        """Return where the panel of the selected body lies, if there is one and room for it."""
        if self.selected is None:
            return None
        position = np.hstack([frame.pose, frame.prop_pose])[:2, self.selected]
        ((x, y),) = self.camera.to_pixels([position]).tolist()
        return self._panel.place(self.layout.plot, (x, y))

    def _banner(self) -> Banner | None:
        if not self.player.over:
            return None
        error = self.player.error
        hint = "R restarts   Esc leaves"
        if error is not None:
            return Banner(str(error), hint, error=True)
        return Banner(self.player.frame.over_message or "The experiment is over.", hint)

    def _arrange(self, size: tuple[int, int], banner: Banner | None) -> None:
        """Lay out a surface of this size; keep what is seen in place, or fitted if it was."""
        before = self.layout
        self.layout = Layout.of(size, footer_height(banner, size, self._painter))
        self._painter.ui = self.layout.ui
        if self.layout == before:
            return
        if self._fits:
            self._fit()
        else:
            old, new = before.plot.center, self.layout.plot.center
            self.camera = self.camera.panned(new[0] - old[0], new[1] - old[1])

    def _fit(self) -> None:
        self._fits = True
        self.camera = self._fitted()

    def _fitted(self) -> Camera:
        size = self.layout.header.width, self.layout.footer.bottom
        return fitted(self.player.source.scenario, size, self.layout)

    # -- events ---------------------------------------------------------------------------------

    def _handle(self, event: pygame.Event) -> None:
        if event.type == pygame.QUIT:
            self._open = False
        elif event.type == pygame.KEYDOWN:
            self._press(event.key, event.unicode)
        elif event.type == pygame.KEYUP:
            self._held.discard(event.key)
        elif event.type == pygame.WINDOWFOCUSLOST:
            self._held.clear()
        elif event.type == pygame.MOUSEWHEEL:
            self._zoom(WHEEL_FACTOR ** getattr(event, "precise_y", event.y))
        elif event.type == pygame.MOUSEMOTION and any(event.buttons):
            self._pan(*event.rel)
        elif event.type == pygame.MOUSEBUTTONDOWN and event.button == pygame.BUTTON_LEFT:
            self._pressed = event.pos
        elif event.type == pygame.MOUSEBUTTONUP and event.button == pygame.BUTTON_LEFT:
            if self._pressed is not None and math.dist(self._pressed, event.pos) < CLICK:
                self._click(event.pos)
            self._pressed = None

    def _press(self, code: int, character: str) -> None:
        key = keys.action_of(pygame.key.name(code), character, manual=self.player.manual)
        held = code in self._held
        self._held.add(code)
        if key is not None and (key.repeats or not held):
            self._actions[key.action]()

    def _zoom(self, factor: float) -> None:
        fit = self._fitted().scale
        wanted = min(max(self.camera.scale * factor, WIDEST * fit), DEEPEST * fit)
        self._look(self.camera.zoomed(pygame.mouse.get_pos(), wanted / self.camera.scale))

    def _pan(self, dx: int, dy: int) -> None:
        self._look(self.camera.panned(dx, dy))

    def _look(self, camera: Camera) -> None:
        """Look with another camera, of the person's choice."""
        self._fits = False
        self.camera = camera
        self._hurry = time.perf_counter() + REST

    def _toggle(self, layer: str) -> None:
        self.layers = replace(self.layers, **{layer: not getattr(self.layers, layer)})

    def _click(self, pixel: tuple[int, int]) -> None:
        """Select what lies at a pixel of the picture, or nothing."""
        frame = self.player.frame
        place = self._panel_place(frame)
        beside = not self.layout.plot.collidepoint(pixel)
        if self.help or beside or (place is not None and place.collidepoint(pixel)):
            return
        ((x, y),) = self.camera.to_world([pixel]).tolist()
        self.selected = body_at(frame, (x, y), CLICK * self.layout.ui / self.camera.scale)

    def _select_next(self) -> None:
        self.selected = next_body(self.player.frame, self.selected)

    def _toggle_help(self) -> None:
        self.help = not self.help

    def _leave(self) -> None:
        """Close the page of help if it is open, else select none, else close the window."""
        if self.help:
            self.help = False
        elif self.selected is not None:
            self.selected = None
        else:
            self._open = False


def _icon(painter: Painter) -> pygame.Surface:
    """Return the window's icon: a robot, seen from above."""
    scene = Scene()
    scene.circle((0, 0), 1.0, fill=PALETTE[0], stroke="#ffffff", width=2.0)
    scene.line([(0, 0), (1, 0)], stroke="#ffffff", width=7.0)
    icon = pygame.Surface((64, 64), pygame.SRCALPHA, 32)
    painter.paint(icon, scene.shapes, Camera(29.0, 32.0, 32.0))
    return icon
