"""The tools that draw obstacles: walls, polygons, rectangles."""

from __future__ import annotations

from typing import ClassVar

from mars2d.core.plane import Outline, Point, rectangle
from mars2d.core.scene import Scene, faded
from mars2d.output.layers.bodies import INK
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.draft import Draft, Item
from mars2d.window.editor.handles import MARK, PAPER
from mars2d.window.editor.tool import Maker, Making, Tool, sides, stretch

__all__ = ["DrawPolygon", "DrawRectangle", "DrawWall"]

CLOSE = 10.0
"""So many points beside the first corner a click closes a polygon."""


class Chain(Tool):
    """The base of tools that draw corner by corner."""

    least: ClassVar[int] = 2

    def __init__(self, desk: Desk) -> None:
        """Start without corners."""
        super().__init__(desk)
        self.corners: list[Point] = []

    def press(self, point: Point, *, shift: bool) -> None:  # noqa: ARG002
        """Add a corner."""
        self.add(self.desk.snapped(point))

    def move(self, point: Point, *, shift: bool) -> None:  # noqa: ARG002
        """Follow the pointer with the next edge."""
        self.pointer = point

    def put(self, x: float, y: float, heading: float | None) -> None:  # noqa: ARG002
        """Add a corner at a typed place."""
        self.add((x, y))

    def add(self, corner: Point) -> None:
        """Add a corner, unless it is there already."""
        if not self.corners or corner != self.corners[-1]:
            self.corners.append(corner)

    def confirm(self) -> bool:
        """Keep what was drawn, if it is enough."""
        corners, self.corners = self.corners, []
        if len(corners) < self.least:
            return bool(corners)
        draft, item = self.made(tuple(corners))
        self.desk.put(draft)
        self.desk.select([item])
        return True

    def made(self, corners: Outline) -> tuple[Draft, Item]:
        """Return the draft with what was drawn, and that thing."""
        raise NotImplementedError

    def back(self) -> bool:
        """Take the last corner back."""
        return bool(self.corners) and self.corners.pop() is not None

    def cancel(self) -> bool:
        """Forget what was drawn."""
        corners, self.corners = self.corners, []
        return bool(corners)

    @property
    def next(self) -> Point | None:
        """Where the next corner would be."""
        return None if self.pointer is None else self.desk.snapped(self.pointer)

    @property
    def remark(self) -> str:
        """The length and direction of the edge that is being drawn."""
        if not self.corners or self.next is None:
            return ""
        return stretch(self.corners[-1], self.next)

    def draw(self, scene: Scene) -> None:
        """Draw the corners so far, and the edge to the pointer."""
        place = self.next
        ahead = [] if place is None else [place]
        if len(self.corners) + len(ahead) > 1:
            scene.line([*self.corners, *ahead], stroke=MARK, width=2.0)
        for corner in [*self.corners, *ahead]:
            scene.circle(corner, 0.0, fill=PAPER, stroke=MARK, width=1.5, pixels=3.5)


class DrawWall(Chain):
    """Draws walls: thin lines from corner to corner."""

    hint: ClassVar[str] = "Click corner by corner; Enter, Esc or the right button ends the wall"

    def made(self, corners: Outline) -> tuple[Draft, Item]:
        """Return the draft with the wall."""
        return self.desk.draft.with_wall(corners)

    def cancel(self) -> bool:
        """Keep the wall as far as it goes."""
        return self.confirm()


class DrawPolygon(Chain):
    """Draws solid obstacles."""

    hint: ClassVar[str] = (
        "Click corner by corner; the first one or Enter closes, Backspace goes back"
    )
    least: ClassVar[int] = 3

    def press(self, point: Point, *, shift: bool) -> None:
        """Add a corner; at the first one, close."""
        if len(self.corners) > 2 and self._closes(point):
            self.confirm()
        else:
            super().press(point, shift=shift)

    def _closes(self, point: Point) -> bool:
        first = self.corners[0]
        return self.desk.near(first, point, CLOSE) or self.desk.snapped(point) == first

    def made(self, corners: Outline) -> tuple[Draft, Item]:
        """Return the draft with the obstacle."""
        return self.desk.draft.with_outline(corners)

    def draw(self, scene: Scene) -> None:
        """Draw the area, too."""
        place = self.next
        ring = [*self.corners, *([] if place is None else [place])]
        if self.corners and len(ring) > 2:
            scene.polygon(ring, fill=faded(INK, 0.15))
        super().draw(scene)
        if len(self.corners) > 2:
            scene.circle(self.corners[0], 0.0, stroke=MARK, width=2.0, pixels=8.0)


class Across(Making):
    """Draws a rectangle from corner to corner."""

    def __init__(self, desk: Desk, start: Point) -> None:
        """Begin with a corner."""
        self.desk, self.draft, self.start = desk, desk.draft, desk.snapped(start)

    @property
    def area(self) -> Outline:
        """The rectangle, of which nothing may be there yet."""
        corners = None if self.item is None else self.desk.draft.corners(self.item)
        return corners or ()

    def to(self, point: Point, *, shift: bool) -> Draft:  # noqa: ARG002
        """Put the opposite corner at the pointer."""
        (ax, ay), (bx, by) = self.start, self.desk.snapped(point)
        if ax == bx or ay == by:
            self.item = None
            return self.draft
        ring = rectangle(min(ax, bx), max(ax, bx), min(ay, by), max(ay, by))
        draft, self.item = self.draft.with_outline(ring)
        return draft


class DrawRectangle(Maker):
    """Draws rectangular obstacles."""

    hint: ClassVar[str] = "Drag from corner to corner"
    gesture: Across | None = None

    def press(self, point: Point, *, shift: bool) -> None:  # noqa: ARG002
        """Begin with a corner."""
        self.pressed, self.gesture = point, Across(self.desk, point)

    def move(self, point: Point, *, shift: bool) -> None:
        """Draw up to the pointer."""
        self.pointer = point
        if self.gesture is not None:
            self.desk.drag(self.gesture, point, shift=shift)

    @property
    def remark(self) -> str:
        """The size."""
        if self.gesture is None or not self.gesture.area:
            return ""
        (ax, ay), (bx, by) = self.gesture.area[0], self.gesture.area[2]
        return sides(bx - ax, by - ay)

    def draw(self, scene: Scene) -> None:
        """Draw where the corner would be."""
        if self.pointer is not None and self.gesture is None:
            place = self.desk.snapped(self.pointer)
            scene.circle(place, 0.0, fill=PAPER, stroke=MARK, width=1.5, pixels=3.5)
