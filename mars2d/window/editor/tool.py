"""The base of the editor's tools, which decide the effect of the mouse."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from mars2d.core.plane import Point
from mars2d.core.scene import Scene
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.draft import Draft

CLICK = 5.0
"""A press that moves by less than this is a click, points."""


@dataclass(frozen=True)
class Drag:
    """A drag of the mouse.

    to: returns the draft with the pointer dragged to a point [m]; its second argument is whether
    Shift is held. remark: returns a measure to show beside the pointer, for example ``1.50 m
    90°``. corner: the index of the corner that it moves, if it moves one.
    """

    to: Callable[[Point, bool], Draft]
    remark: Callable[[], str] = str
    corner: int | None = None


class Tool:
    """The base of all tools: methods for the mouse, at points of the world [m], and a few keys.

    hint: a line that says what to do. drag: the present one. moved: whether the pointer has moved
    since it began.
    """

    hint: str = ""

    def __init__(self, desk: Desk) -> None:
        """Start with nothing pressed."""
        self.desk = desk
        self.pointer: Point | None = None
        self.drag: Drag | None = None
        self.moved = False
        self._pressed: Point = (0.0, 0.0)

    def press(self, point: Point, *, shift: bool) -> None:
        """Press the left button."""

    def begin(self, drag: Drag, point: Point) -> None:
        """Begin a drag."""
        self.drag, self._pressed, self.moved = drag, point, False

    def move(self, point: Point, *, shift: bool) -> None:
        """Move the mouse, with or without the button."""
        self.pointer = point
        if self.drag is not None:
            self.moved = self.moved or not self.desk.near(self._pressed, point, CLICK)
            if self.moved:
                self.desk.hold(self.drag.to, point, shift=shift)

    def release(self, point: Point, *, shift: bool) -> None:  # noqa: ARG002
        """Release the button: keep the changes of the drag, and select what is new."""
        drag, self.drag, self.moved = self.drag, None, False
        self.desk.settle()
        if drag is not None and drag.corner is not None and self.desk.only is not None:
            self.desk.corner = drag.corner

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
        busy = self.drag is not None
        self.drag, self.moved = None, False
        return self.desk.drop() or busy

    def draw(self, scene: Scene) -> None:
        """Draw a preview, or handles."""

    @property
    def remark(self) -> str:
        """A measure to show beside the pointer."""
        return "" if self.drag is None or not self.moved else self.drag.remark()
