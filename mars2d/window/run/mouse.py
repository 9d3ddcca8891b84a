"""The mouse on a window: a press begins a drag of a handle, of the picture, or of what is in it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import pygame

from mars2d.window.screen.viewpoint import Viewpoint, wheel_notches

Pixel = tuple[int, int]

BUTTONS = (pygame.BUTTON_LEFT, pygame.BUTTON_MIDDLE, pygame.BUTTON_RIGHT)


class Drag:
    """What the mouse does from the press of a button to its release; by itself nothing.

    begun: whether it is more than a click already.
    """

    begun = True

    def move(self, pixel: Pixel) -> None:
        """Move to a pixel."""

    def end(self) -> None:
        """End it by the release of the button."""

    def cancel(self) -> None:
        """End it before that."""


class Handle(Drag):
    """A handle on a bar. hit: whether a press at a pixel grabs it. go: brings it to a pixel."""

    def __init__(self, hit: Callable[[Pixel], bool], go: Callable[[Pixel], None]) -> None:
        self.hit, self._go = hit, go

    def move(self, pixel: Pixel) -> None:
        """Bring it to a pixel."""
        self._go(pixel)


class Pan(Drag):
    """Moves the picture from a pixel on."""

    begun = False

    def __init__(self, viewpoint: Viewpoint, pixel: Pixel) -> None:
        self._viewpoint, self._at = viewpoint, pixel

    def move(self, pixel: Pixel) -> None:
        """Move the picture with the pointer."""
        if pixel != self._at:
            self._viewpoint.pan(pixel[0] - self._at[0], pixel[1] - self._at[1])
            self._at = pixel


class Mouse:
    """Drags handles by the left button, and moves or zooms the picture.

    place: returns where the viewpoint has what is drawn at a pixel; None where that is no picture,
    or something lies over it. drag: the one that goes on. pressed: where it began.
    """

    def __init__(
        self,
        viewpoint: Viewpoint,
        handles: Sequence[Handle],
        place: Callable[[Pixel], Pixel | None],
    ) -> None:
        """Start with no button pressed."""
        self.viewpoint, self.handles, self.place = viewpoint, handles, place
        self.drag: Drag | None = None
        self.pressed: Pixel = (0, 0)

    def handle(self, event: pygame.Event) -> None:
        """Handle an event of pygame, if it is one of the mouse."""
        if event.type == pygame.MOUSEMOTION:
            self.move(event.pos)
        elif event.type == pygame.MOUSEBUTTONDOWN and event.button in BUTTONS:
            self.press(event.pos, event.button)
        elif event.type == pygame.MOUSEBUTTONUP and event.button in BUTTONS:
            self.release(event.pos, event.button)
        elif event.type == pygame.MOUSEWHEEL:
            pixel = self.place(pygame.mouse.get_pos())
            if pixel is not None:
                self.viewpoint.zoom(wheel_notches(event), pixel)

    def press(self, pixel: Pixel, button: int) -> None:
        """Begin to drag what is at a pixel; while a drag goes on, do nothing."""
        if self.drag is not None:
            return
        handles = self.handles if button == pygame.BUTTON_LEFT else ()
        self.pressed, self.drag = pixel, next((each for each in handles if each.hit(pixel)), None)
        if self.drag is not None:
            self.drag.move(pixel)
        elif self.place(pixel) is not None:
            self.drag = self.grip(pixel, button)

    def grip(self, pixel: Pixel, button: int) -> Drag:  # noqa: ARG002
        """Return the drag that a press on the picture begins."""
        return Pan(self.viewpoint, pixel)

    def move(self, pixel: Pixel) -> None:
        """Move to a pixel."""
        if self.drag is not None:
            self.drag.move(pixel)

    def release(self, pixel: Pixel, button: int) -> None:  # noqa: ARG002
        """End the drag."""
        self.move(pixel)
        drag, self.drag = self.drag, None
        if drag is not None:
            drag.end()

    def cancel(self) -> None:
        """End the drag before its button is released."""
        drag, self.drag = self.drag, None
        if drag is not None:
            drag.cancel()
