"""The tools that draw corner by corner: walls, obstacles, props of any shape."""

from __future__ import annotations

from mars2d.bodies.props.solid import Solid
from mars2d.core.plane import Outline, Point
from mars2d.core.scene import INK, Scene, faded
from mars2d.geometry.shapes import Polygon
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.draft import Draft
from mars2d.window.editor.handles import MARK, PAPER
from mars2d.window.editor.item import tidy
from mars2d.window.editor.readout import stretch
from mars2d.window.editor.tool import Tool

CLOSE = 10.0
"""A click this near to the first corner closes a polygon, points."""


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
