"""The mouse on a window: it drags handles on bars, the picture, and bodies; and it clicks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import dist

import pygame

from mars2d.core.plane import Point
from mars2d.window.run.grab import Grab
from mars2d.window.screen.player import Player
from mars2d.window.screen.viewpoint import Viewpoint, wheel_notches

Pixel = tuple[int, int]
Handle = tuple[Callable[[Pixel], bool], Callable[[Pixel], None]]
"""Whether a press at a pixel grabs the handle, and the effect of a drag to a pixel."""

BUTTONS = (pygame.BUTTON_LEFT, pygame.BUTTON_MIDDLE, pygame.BUTTON_RIGHT)


class Mouse:
    """Passes the mouse's moves and buttons on to the parts of a window.

    handles: dragged by the left button. is_picture: whether a pixel shows the picture, with nothing
    over it. click, menu: called with the point [m] of the picture that was clicked with the left or
    the right button.
    """

    def __init__(
        self,
        player: Player,
        viewpoint: Viewpoint,
        grab: Grab,
        handles: Sequence[Handle],
        is_picture: Callable[[Pixel], bool],
        click: Callable[[Point], None],
        menu: Callable[[Point], None],
    ) -> None:
        """Start with no button pressed."""
        self._player, self._viewpoint, self._grab = player, viewpoint, grab
        self._handles, self._is_picture = handles, is_picture
        self._clicks = {pygame.BUTTON_LEFT: click, pygame.BUTTON_RIGHT: menu}
        self._pressed: Pixel | None = None
        self._dragged: Callable[[Pixel], None] | None = None
        self._pans = False  # whether it drags the picture

    def drags(self, drag: Callable[[Pixel], None]) -> bool:
        """Return whether it drags the handle whose second function is `drag`."""
        return self._dragged == drag

    def handle(self, event: pygame.Event) -> None:
        """Handle an event of pygame, if it is one of the mouse."""
        if event.type == pygame.MOUSEMOTION:
            self._move(event)
        elif event.type == pygame.MOUSEBUTTONDOWN and event.button in BUTTONS:
            self._press(event.pos, event.button)
        elif event.type == pygame.MOUSEBUTTONUP and event.button in BUTTONS:
            self._release(event.pos, event.button)
        elif event.type == pygame.MOUSEWHEEL:
            self._viewpoint.zoom(wheel_notches(event), pygame.mouse.get_pos())
        elif event.type == pygame.WINDOWLEAVE:
            self._grab.leave()

    def let_go(self) -> None:
        """End a drag; a body that was moved or turned is back where it was."""
        self._grab.cancel()
        self._drop()

    def _press(self, pixel: Pixel, button: int) -> None:
        """Begin to drag the handle, body or picture at a pixel."""
        frame, camera, running = self._player.frame, self._viewpoint.camera, self._player.playing
        self._pressed = pixel
        if button == pygame.BUTTON_LEFT:
            self._dragged = next((drag for hit, drag in self._handles if hit(pixel)), self._dragged)
        if self._dragged is not None:
            self._dragged(pixel)
        elif self._is_picture(pixel):
            mods = pygame.key.get_mods()
            self._pans = not self._grab.press(frame, camera, pixel, button, mods, running)

    def _move(self, event: pygame.Event) -> None:
        if self._dragged is not None:
            self._dragged(event.pos)
        elif self._pans:
            self._viewpoint.pan(*event.rel)
        elif self._grab.busy or self._is_picture(event.pos):
            frame, camera = self._player.frame, self._viewpoint.camera
            self._grab.move(frame, camera, event.pos, self._player.playing)
        else:
            self._grab.leave()

    def _release(self, pixel: Pixel, button: int) -> None:
        """End a drag; a press without a drag is a click."""
        camera, near = self._viewpoint.camera, self._grab.click
        done = self._grab.busy and self._grab.release(
            self._player.frame, camera, pixel, self._player.playing
        )
        clicked = self._pressed is not None and dist(self._pressed, pixel) < near
        free = self._dragged is None and not done and self._is_picture(pixel)
        if clicked and free and button in self._clicks:
            ((x, y),) = camera.to_world([pixel]).tolist()
            self._clicks[button]((x, y))
        self._drop()

    def _drop(self) -> None:
        self._pressed = self._dragged = None
        self._pans = False
