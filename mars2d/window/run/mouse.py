"""The mouse on a window: it drags handles on bars and the picture, turns the wheel, and clicks."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import pygame

from mars2d.window.screen.viewpoint import Viewpoint, wheel_notches

Pixel = tuple[int, int]
Handle = tuple[Callable[[Pixel], bool], Callable[[Pixel], None]]
"""Whether a press at a pixel grabs the handle, and the effect of a drag to a pixel."""

BUTTONS = (pygame.BUTTON_LEFT, pygame.BUTTON_MIDDLE, pygame.BUTTON_RIGHT)


class Mouse:
    """Drags handles by the left button, and moves or zooms the picture.

    place: returns where the viewpoint has what is drawn at a pixel; None where that is no picture,
    or something lies over it.
    """

    def __init__(
        self,
        viewpoint: Viewpoint,
        handles: Sequence[Handle],
        place: Callable[[Pixel], Pixel | None],
    ) -> None:
        """Start with no button pressed."""
        self.viewpoint, self.handles, self.place = viewpoint, handles, place
        self.pressed: Pixel | None = None
        self.dragged: Callable[[Pixel], None] | None = None
        self.pans = False  # whether it drags the picture

    def drags(self, drag: Callable[[Pixel], None]) -> bool:
        """Return whether it drags the handle whose second function is `drag`."""
        return self.dragged == drag

    def handle(self, event: pygame.Event) -> None:
        """Handle an event of pygame, if it is one of the mouse."""
        if event.type == pygame.MOUSEMOTION:
            self.move(event.pos, event.rel)
        elif event.type == pygame.MOUSEBUTTONDOWN and event.button in BUTTONS:
            self.press(event.pos, event.button)
        elif event.type == pygame.MOUSEBUTTONUP and event.button in BUTTONS:
            self.release(event.pos, event.button)
        elif event.type == pygame.MOUSEWHEEL:
            pixel = self.place(pygame.mouse.get_pos())
            if pixel is not None:
                self.viewpoint.zoom(wheel_notches(event), pixel)

    def press(self, pixel: Pixel, button: int) -> None:
        """Begin to drag the handle or the picture at a pixel."""
        self.pressed = pixel
        if button == pygame.BUTTON_LEFT:
            self.dragged = next((drag for hit, drag in self.handles if hit(pixel)), self.dragged)
        if self.dragged is not None:
            self.dragged(pixel)
        elif self.place(pixel) is not None:
            self.pans = not self.grips(pixel, button)

    def grips(self, pixel: Pixel, button: int) -> bool:  # noqa: ARG002
        """Grip something in the picture; return whether there is anything."""
        return False

    def move(self, pixel: Pixel, by: Pixel) -> None:
        """Move to a pixel, by a number of pixels."""
        if self.dragged is not None:
            self.dragged(pixel)
        elif self.pans:
            self.viewpoint.pan(*by)

    def release(self, pixel: Pixel, button: int) -> None:  # noqa: ARG002
        """End a drag."""
        self.pressed = self.dragged = None
        self.pans = False
