"""The base of the editor's tools, which decide the effect of the mouse."""

from __future__ import annotations

from typing import ClassVar

from mars2d.core.plane import Point
from mars2d.core.scene import Scene
from mars2d.window.editor.desk import Desk, Gesture
from mars2d.window.editor.item import Item

CLICK = 5.0
"""A press that moves by less than this is a click, points."""


class Tool:
    """The base of all tools: methods for the mouse, at points of the world [m], and a few keys.

    hint: a line that says what to do. puts: whether the tool makes new items.
    """

    hint: ClassVar[str] = ""
    puts: ClassVar[bool] = True
    gesture: Gesture | None = None

    def __init__(self, desk: Desk) -> None:
        """Start with nothing pressed."""
        self.desk = desk
        self.pointer: Point | None = None
        self.pressed: Point | None = None

    def press(self, point: Point, *, shift: bool) -> None:
        """Press the left button."""

    def move(self, point: Point, *, shift: bool) -> None:
        """Move the mouse, with or without the button."""

    def release(self, point: Point, *, shift: bool) -> None:
        """Release the button."""

    def put(self, x: float, y: float, heading: float | None) -> None:
        """Act like a click at a typed point; heading: radians, None if none was typed."""

    def confirm(self) -> bool:
        """Handle Enter and the right button; return whether there was anything to do."""
        return False

    def back(self) -> bool:
        """Remove the last corner; return whether there was one."""
        return False

    def cancel(self) -> bool:
        """Cancel a drag; return whether there was one."""
        return self.desk.drop()

    def draw(self, scene: Scene) -> None:
        """Draw a preview, or handles."""

    @property
    def remark(self) -> str:
        """A measure to show beside the pointer."""
        return "" if self.gesture is None else self.gesture.remark

    def dragged(self, point: Point) -> bool:
        """Return whether the pointer has moved since the button was pressed."""
        return self.pressed is not None and not self.desk.near(self.pressed, point, CLICK)


class Making(Gesture):
    """A drag that makes an item; item: None while there is none."""

    item: Item | None = None


class Maker(Tool):
    """The base of tools whose drag makes an item."""

    gesture: Making | None = None

    def release(self, point: Point, *, shift: bool) -> None:  # noqa: ARG002
        """Keep the new item, and select it."""
        gesture, self.gesture, self.pressed = self.gesture, None, None
        self.desk.settle()
        if gesture is not None and gesture.item is not None:
            self.desk.select([gesture.item])

    def cancel(self) -> bool:
        """Remove the new item."""
        busy, self.gesture, self.pressed = self.gesture is not None, None, None
        return self.desk.drop() or busy
