"""The mouse on a window: what it drags, on the bars, of the picture, or in it, and clicks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import dist

import pygame

from mars2d.core.plane import Point
from mars2d.window.hand import Hand
from mars2d.window.player import Player
from mars2d.window.viewpoint import Viewpoint, wheel_notches

__all__ = ["Mouse"]

Pixel = tuple[int, int]
Grip = tuple[Callable[[Pixel], bool], Callable[[Pixel], None]]
"""Whether a pixel is where something can be taken hold of, and what a drag to a pixel does."""

BUTTONS = (pygame.BUTTON_LEFT, pygame.BUTTON_MIDDLE, pygame.BUTTON_RIGHT)


class Mouse:
    """Tells where the mouse is and what its buttons do to those whom it concerns.

    grips: handles that the left button drags. is_picture: whether at a pixel there is the picture,
    and nothing over it. click: is given the point [m] of the picture that was clicked.
    """

    def __init__(
        self,
        player: Player,
        viewpoint: Viewpoint,
        hand: Hand,
        grips: Sequence[Grip],
        is_picture: Callable[[Pixel], bool],
        click: Callable[[Point], None],
    ) -> None:
        """Start with nothing held."""
        self._player, self._viewpoint, self._hand = player, viewpoint, hand
        self._grips, self._is_picture, self._click = grips, is_picture, click
        self._pressed: Pixel | None = None
        self._dragged: Callable[[Pixel], None] | None = None
        self._pans = False  # it drags the picture

    def drags(self, grip: Callable[[Pixel], None]) -> bool:
        """Return whether it drags the handle for which `grip` does that."""
        return self._dragged == grip

    def handle(self, event: pygame.Event) -> None:
        """Take an event of pygame, if it is one of the mouse."""
        if event.type == pygame.MOUSEMOTION:
            self._move(event)
        elif event.type == pygame.MOUSEBUTTONDOWN and event.button in BUTTONS:
            self._press(event.pos, event.button)
        elif event.type == pygame.MOUSEBUTTONUP and event.button in BUTTONS:
            self._release(event.pos, event.button)
        elif event.type == pygame.MOUSEWHEEL:
            self._viewpoint.zoom(wheel_notches(event), pygame.mouse.get_pos())
        elif event.type == pygame.WINDOWLEAVE:
            self._hand.leave()

    def let_go(self) -> None:
        """Let go of what is held; what was carried is back where it was."""
        self._hand.cancel()
        self._drop()

    def _press(self, pixel: Pixel, button: int) -> None:
        """Take hold of what lies at a pixel."""
        frame, camera, running = self._player.frame, self._viewpoint.camera, self._player.playing
        if button == pygame.BUTTON_LEFT:
            self._pressed = pixel
            self._dragged = next((drag for hit, drag in self._grips if hit(pixel)), self._dragged)
        if self._dragged is not None:
            self._dragged(pixel)
        elif self._is_picture(pixel):
            mods = pygame.key.get_mods()
            self._pans = not self._hand.press(frame, camera, pixel, button, mods, running)

    def _move(self, event: pygame.Event) -> None:
        if self._dragged is not None:
            self._dragged(event.pos)
        elif self._pans:
            self._viewpoint.pan(*event.rel)
        elif self._hand.busy or self._is_picture(event.pos):
            frame, camera = self._player.frame, self._viewpoint.camera
            self._hand.move(frame, camera, event.pos, self._player.playing)
        else:
            self._hand.leave()

    def _release(self, pixel: Pixel, button: int) -> None:
        """Let go; what was pressed and not dragged is clicked."""
        camera, near = self._viewpoint.camera, self._hand.click
        done = self._hand.busy and self._hand.release(
            self._player.frame, camera, pixel, self._player.playing
        )
        clicked = self._pressed is not None and dist(self._pressed, pixel) < near
        free = self._dragged is None and not done and self._is_picture(pixel)
        if clicked and free and button == pygame.BUTTON_LEFT:
            ((x, y),) = camera.to_world([pixel]).tolist()
            self._click((x, y))
        self._drop()

    def _drop(self) -> None:
        self._pressed = self._dragged = None
        self._pans = False
