"""The tool that shapes the workspace."""

from __future__ import annotations

from typing import ClassVar

from mars2d.core.plane import Point, rectangle
from mars2d.core.scene import Scene
from mars2d.window.editor.desk import Desk, Gesture
from mars2d.window.editor.draft import Draft, Item
from mars2d.window.editor.handles import Handle, handle_at
from mars2d.window.editor.select import Taking
from mars2d.window.editor.target import edge_at, foot_on
from mars2d.window.editor.tool import sides

__all__ = ["Boundary"]

NEAR = 8.0
"""So many points beside an edge still hit it."""


class Spanning(Gesture):
    """Draws a workspace where there is none: a rectangle from corner to corner."""

    def __init__(self, desk: Desk, start: Point) -> None:
        """Begin with a corner."""
        self.desk, self.draft, self.start = desk, desk.draft, desk.snapped(start)

    def to(self, point: Point, *, shift: bool) -> Draft:  # noqa: ARG002
        """Put the opposite corner at the pointer."""
        (ax, ay), (bx, by) = self.start, self.desk.snapped(point)
        area = rectangle(min(ax, bx), max(ax, bx), min(ay, by), max(ay, by))
        return self.draft.with_corners(Item("workspace"), area)


class Boundary(Taking):
    """Moves the workspace's corners, adds and removes some."""

    hint: ClassVar[str] = "Drag corners; click an edge for a new one, Del removes one"

    def __init__(self, desk: Desk) -> None:
        """Take hold of the workspace."""
        super().__init__(desk)
        self._hold()

    def _hold(self) -> None:
        corner = self.desk.corner
        self.desk.select([Item("workspace")] if self.desk.draft.workspace is not None else [])
        self.desk.corner = corner if self.desk.selection else None

    def press(self, point: Point, *, shift: bool) -> None:  # noqa: ARG002
        """Take a corner, or make one of the point of an edge."""
        desk, corners = self.desk, self.desk.draft.workspace
        self.pressed = point
        if corners is None:
            self.gesture = Spanning(desk, point)
            return
        self._hold()
        handle = handle_at(desk, point)
        if handle is None:
            k = edge_at(point, corners, desk.metres(NEAR))
            if k is None:
                desk.corner = None
                return
            foot = foot_on(point, corners[k], corners[(k + 1) % len(corners)])
            handle = Handle("dot", k, foot)
        self.take(handle, point)

    def release(self, point: Point, *, shift: bool) -> None:
        """Keep what was done; a rectangle without area is none."""
        ring = self.desk.draft.workspace
        if isinstance(self.gesture, Spanning) and ring is not None:
            (ax, ay), (bx, by) = ring[0], ring[2]
            if min(abs(ax - bx), abs(ay - by)) < self.desk.metres(2.0):
                self.desk.drop()
        super().release(point, shift=shift)
        self._hold()

    def draw(self, scene: Scene) -> None:
        """Draw the handles."""
        self._hold()
        super().draw(scene)

    @property
    def remark(self) -> str:
        """The size of a new rectangle, else the edges at the corner that is dragged."""
        ring = self.desk.draft.workspace
        if isinstance(self.gesture, Spanning) and ring is not None:
            (ax, ay), (bx, by) = ring[0], ring[2]
            return sides(bx - ax, by - ay)
        return super().remark
