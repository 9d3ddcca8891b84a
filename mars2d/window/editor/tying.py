"""The tool that ties a body to another, or to a place on the floor."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from mars2d.bodies.joints.base import Joint
from mars2d.core.plane import Point
from mars2d.core.scene import Scene, faded
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.handles import MARK
from mars2d.window.editor.item import Item
from mars2d.window.editor.picking import item_at
from mars2d.window.editor.tool import Tool


class Tie(Tool):
    """Ties bodies by joints of a kind: a click on another body, or on the floor, ends it."""

    hint: ClassVar[str] = "Click the body that it is tied to; a click on the floor ties it there"
    puts: ClassVar[bool] = False

    def __init__(
        self, desk: Desk, kind: type[Joint], items: tuple[Item, ...], done: Callable[[], None]
    ) -> None:
        """Take the bodies to tie; done: called when they are tied."""
        super().__init__(desk)
        self._kind, self._items, self._done = kind, items, done

    def press(self, point: Point, *, shift: bool) -> None:  # noqa: ARG002
        """Tie the bodies to the item at a point [m]."""
        desk, draft = self.desk, self.desk.draft
        other = item_at(desk, point)
        ends: dict[str, Any] = {"anchor_b": desk.snapped(point)}
        if other is not None and other.kind in ("robot", "prop"):
            ends = {"b": draft.member(other).name}
        for item in self._items:
            if item != other:
                draft = draft.with_joint(self._kind(a=str(draft.member(item).name), **ends))
        desk.put(draft)
        self._done()

    def move(self, point: Point, *, shift: bool) -> None:  # noqa: ARG002
        """Draw the joint to the pointer."""
        self.pointer = point

    def draw(self, scene: Scene) -> None:
        """Draw a line from each body to the pointer."""
        for item in self._items:
            if self.pointer is not None and self.desk.draft.holds(item):
                ends = [self.desk.draft.place(item), self.pointer]
                scene.line(ends, stroke=faded(MARK, 0.7), width=2.0, style="--")
