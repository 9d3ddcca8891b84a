"""The tool that ties a body to another, or to a place on the floor."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from mars2d.bodies.joints.base import Joint
from mars2d.bodies.joints.hinge import Hinge
from mars2d.core.plane import Point
from mars2d.core.scene import Scene, faded
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.draft import seen_from
from mars2d.window.editor.handles import MARK
from mars2d.window.editor.item import Item
from mars2d.window.editor.picking import item_at
from mars2d.window.editor.tool import Tool


class Tie(Tool):
    """Ties bodies by joints of a kind: a click on another body, or on the floor, ends it.

    Joints hold bodies at their centres; a hinge is a pin where the click is.
    """

    def __init__(
        self, desk: Desk, kind: type[Joint], items: tuple[Item, ...], done: Callable[[], None]
    ) -> None:
        """Take the bodies to tie; done: called when they are tied."""
        super().__init__(desk)
        self._kind, self._items, self._done = kind, items, done
        self._pins = issubclass(kind, Hinge)
        to = "the pin goes through" if self._pins else "it is tied to"
        self.hint = f"Click the body that {to}; a click on the floor ties it there"

    def press(self, point: Point, *, shift: bool) -> None:  # noqa: ARG002
        """Tie the bodies to the item at a point [m]."""
        desk, draft = self.desk, self.desk.draft
        at, other = desk.snapped(point), item_at(desk, point, self._items)
        body = None if other is None else draft.body(other)
        ends: dict[str, Any] = {"b": None if body is None else body.name}
        if body is None or self._pins:
            ends["anchor_b"] = seen_from(body, at)
        for item in self._items:
            if self._pins:
                ends["anchor_a"] = seen_from(draft.body(item), at)
            draft = draft.with_joint(self._kind(a=draft.name(item), **ends))
        desk.put(draft)
        self._done()

    def put(self, x: float, y: float, heading: float | None) -> None:  # noqa: ARG002
        """Tie the bodies to the item at a typed point."""
        self.press((x, y), shift=False)

    def draw(self, scene: Scene) -> None:
        """Draw a line from each body to the pointer."""
        for item in self._items:
            if self.pointer is not None and self.desk.draft.holds(item):
                ends = [self.desk.draft.place(item), self.pointer]
                scene.line(ends, stroke=faded(MARK, 0.7), width=2.0, style="--")
