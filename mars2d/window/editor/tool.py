"""What a tool is: what the mouse does while it is chosen."""

from __future__ import annotations

from typing import ClassVar

from mars2d.core.plane import Point
from mars2d.core.scene import Scene
from mars2d.window.editor.desk import Desk, Gesture
from mars2d.window.editor.item import Item

__all__ = ["Maker", "Making", "Tool"]

CLICK = 5.0
"""A press of the mouse that moves by less, in points, is a click."""


class Tool:
    """The base of all tools: the mouse at points of the world, metres; a few keys.

    hint: what to do, in one line. puts: whether it makes new things.
    """

    hint: ClassVar[str] = ""
    puts: ClassVar[bool] = True

    def __init__(self, desk: Desk) -> None:
        """Take the desk to work at."""
        self.desk = desk
        self.pointer: Point | None = None
        self.pressed: Point | None = None

    def press(self, point: Point, *, shift: bool) -> None:
        """Do what the mouse's left button does when it goes down."""

    def move(self, point: Point, *, shift: bool) -> None:
        """Follow the mouse, be its button down or not."""

    def release(self, point: Point, *, shift: bool) -> None:
        """Do what is done when the button goes up."""

    def put(self, x: float, y: float, heading: float | None) -> None:
        """Do at a typed place what a click does; heading: in radians, if there is one."""

    def confirm(self) -> bool:
        """Do what Enter and the right button do; return whether there was anything to do."""
        return False

    def back(self) -> bool:
        """Take one corner back; return whether there was one."""
        return False

    def cancel(self) -> bool:
        """Leave what was begun; return whether there was anything."""
        return self.desk.drop()

    def draw(self, scene: Scene) -> None:
        """Draw what is about to be."""

    @property
    def remark(self) -> str:
        """What there is to measure, as ``1.50 m, 90°``."""
        return ""

    def dragged(self, point: Point) -> bool:
        """Return whether the pointer has moved since the button went down."""
        return self.pressed is not None and not self.desk.near(self.pressed, point, CLICK)


class Making(Gesture):
    """A drag that makes a thing; item: that thing, while there is one."""

    item: Item | None = None


class Maker(Tool):
    """The base of tools whose drag makes a thing."""

    gesture: Making | None = None

    def release(self, point: Point, *, shift: bool) -> None:  # noqa: ARG002
        """Keep it, and select it."""
        gesture, self.gesture, self.pressed = self.gesture, None, None
        self.desk.settle()
        if gesture is not None and gesture.item is not None:
            self.desk.select([gesture.item])

    def cancel(self) -> bool:
        """Take it away again."""
        busy, self.gesture, self.pressed = self.gesture is not None, None, None
        return self.desk.drop() or busy
