"""The tools that draw outlines: walls, polygons, rectangles, the workspace."""

from __future__ import annotations

from collections.abc import Callable

from mars2d.bodies.props.solid import Solid
from mars2d.core.plane import Outline, Point, bounds_of, rectangle
from mars2d.core.scene import INK, Scene, faded
from mars2d.geometry.shapes import Polygon
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.draft import Draft
from mars2d.window.editor.handles import MARK, PAPER, Handle, handle_at
from mars2d.window.editor.item import Item, tidy
from mars2d.window.editor.picking import edge_at
from mars2d.window.editor.readout import sides, stretch
from mars2d.window.editor.select import Handling
from mars2d.window.editor.tool import Drag, Tool

CLOSE = 10.0
"""A click this near to the first corner closes a polygon, points."""
NEAR = 8.0
"""A click this near to an edge of the workspace adds a corner, points."""


class Chain(Tool):
    """The base of tools that draw corner by corner."""

    least = 2

    def __init__(self, desk: Desk) -> None:
        """Start without corners."""
        super().__init__(desk)
        self.corners: list[Point] = []

    def press(self, point: Point, *, shift: bool) -> None:  # noqa: ARG002
        """Add a corner."""
        self.add(self.desk.snapped(point))

    def put(self, x: float, y: float, heading: float | None) -> None:  # noqa: ARG002
        """Add a corner at a typed point."""
        self.add((x, y))

    def add(self, corner: Point) -> None:
        """Add a corner, unless it is the same as the last one."""
        if not self.corners or corner != self.corners[-1]:
            self.corners.append(corner)

    def confirm(self) -> bool:
        """Keep the outline if it has enough corners."""
        if len(self.corners) < self.least:
            return self._drop()
        self.desk.put_new(self.made(tuple(self.corners)))
        return self._drop()

    def made(self, corners: Outline) -> Draft:
        """Return the draft with the outline."""
        raise NotImplementedError

    def back(self) -> bool:
        """Remove the last corner."""
        return bool(self.corners) and self.corners.pop() is not None

    def cancel(self) -> bool:
        """Remove all corners."""
        return self._drop()

    def _drop(self) -> bool:
        corners, self.corners = self.corners, []
        return bool(corners)

    @property
    def next(self) -> Point | None:
        """The place of the next corner."""
        return None if self.pointer is None else self.desk.snapped(self.pointer)

    @property
    def remark(self) -> str:
        """The length and direction of the next edge."""
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

    hint = "Click corner by corner; Enter, Esc or the right button ends the wall"

    def made(self, corners: Outline) -> Draft:
        """Return the draft with the wall."""
        return self.desk.draft.added("wall", corners)

    def cancel(self) -> bool:
        """Keep the wall as far as it is drawn."""
        return self.confirm()


class DrawPolygon(Chain):
    """Draws solid obstacles."""

    hint = "Click corner by corner; the first one or Enter closes, Backspace goes back"
    least = 3

    def press(self, point: Point, *, shift: bool) -> None:
        """Add a corner; close the polygon at the first one."""
        if len(self.corners) > 2 and self._closes(point):
            self.confirm()
        else:
            super().press(point, shift=shift)

    def _closes(self, point: Point) -> bool:
        first = self.corners[0]
        return self.desk.near(first, point, CLOSE) or self.desk.snapped(point) == first

    def made(self, corners: Outline) -> Draft:
        """Return the draft with the obstacle."""
        return self.desk.draft.added("outline", corners)

    def draw(self, scene: Scene) -> None:
        """Draw the corners and the area."""
        place = self.next
        ring = [*self.corners, *([] if place is None else [place])]
        if self.corners and len(ring) > 2:
            scene.polygon(ring, fill=faded(INK, 0.15))
        super().draw(scene)
        if len(self.corners) > 2:
            scene.circle(self.corners[0], 0.0, stroke=MARK, width=2.0, pixels=8.0)


class DrawSolid(DrawPolygon):
    """Draws props of any shape."""

    def made(self, corners: Outline) -> Draft:
        """Return the draft with the solid."""
        shape = Polygon(corners)
        x, y = shape.centroid
        return self.desk.draft.added("prop", Solid(shape, pose=(tidy(x), tidy(y), 0.0)))


def framing(
    desk: Desk, point: Point, made: Callable[[Draft, Outline], Draft], least: float
) -> Drag:
    """Draw a rectangle from corner to corner; least: its shortest side, points."""
    draft, (ax, ay) = desk.draft, desk.snapped(point)

    def to(end: Point, _: bool) -> Draft:
        bx, by = desk.snapped(end)
        if min(abs(ax - bx), abs(ay - by)) <= desk.metres(least):
            return draft
        return made(draft, rectangle(*bounds_of([(ax, ay), (bx, by)])))

    def remark() -> str:
        new = desk.draft.new_since(draft)
        ring = desk.draft.corners(new[0]) if new else desk.draft.base.workspace
        (left, low), _, (right, high), *_ = ring or ((0.0, 0.0),) * 3
        return sides(right - left, high - low) if desk.draft is not draft else ""

    return Drag(to, remark)


class DrawRectangle(Tool):
    """Draws rectangular obstacles."""

    hint = "Drag from corner to corner"
    least = 0.0
    """The shortest side, points."""
    _first: Point | None = None

    def made(self, draft: Draft, corners: Outline) -> Draft:
        """Return the draft with the rectangle."""
        return draft.added("outline", corners)

    def press(self, point: Point, *, shift: bool) -> None:  # noqa: ARG002
        """Begin with a corner."""
        self.begin(framing(self.desk, point, self.made, self.least), point)

    def put(self, x: float, y: float, heading: float | None) -> None:  # noqa: ARG002
        """Put a corner at a typed point; the second one makes the rectangle."""
        start, self._first = self._first, (x, y)
        if start is not None:
            self._first = None
            ring = rectangle(*bounds_of([start, (x, y)]))
            self.desk.put_new(self.made(self.desk.draft, ring))

    def draw(self, scene: Scene) -> None:
        """Draw the place of the first corner."""
        if self.pointer is not None and self.drag is None:
            place = self.desk.snapped(self.pointer)
            scene.circle(place, 0.0, fill=PAPER, stroke=MARK, width=1.5, pixels=3.5)


class Workspace(DrawRectangle, Handling):
    """Draws the workspace; moves, adds and removes its corners."""

    hint = "Drag corners; click an edge for a new one, Del removes one"
    least = 2.0

    def __init__(self, desk: Desk) -> None:
        """Select the workspace."""
        super().__init__(desk)
        self._hold()

    def _hold(self) -> None:
        corner = self.desk.corner
        self.desk.select([Item("workspace")] if self.desk.draft.base.workspace is not None else [])
        self.desk.corner = corner if self.desk.selection else None

    def made(self, draft: Draft, corners: Outline) -> Draft:
        """Return the draft with the workspace."""
        return draft.with_list("workspace", [corners])

    def put(self, x: float, y: float, heading: float | None) -> None:
        """Put the corner touched last, or without a workspace a corner of a new one."""
        base = DrawRectangle if self.desk.draft.base.workspace is None else Handling
        base.put(self, x, y, heading)

    def press(self, point: Point, *, shift: bool) -> None:
        """Begin to drag a corner, or add one on an edge."""
        desk, corners = self.desk, self.desk.draft.base.workspace
        if corners is None:
            super().press(point, shift=shift)
            return
        self._hold()
        handle = handle_at(desk, point)
        if handle is None:
            edge = edge_at(point, corners, desk.metres(NEAR))
            if edge is None:
                desk.corner = None
                return
            handle = Handle("dot", *edge)
        self.take(handle, point)

    def release(self, point: Point, *, shift: bool) -> None:
        """End the drag."""
        super().release(point, shift=shift)
        self._hold()

    def draw(self, scene: Scene) -> None:
        """Draw the handles."""
        self._hold()
        Handling.draw(self, scene)
