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
        self.put(*self.desk.snapped(point), None)

    def put(self, x: float, y: float, heading: float | None) -> None:  # noqa: ARG002
        """Add a corner at a typed point, unless it is the same as the last one."""
        if [(x, y)] != self.corners[-1:]:
            self.corners.append((x, y))

    def confirm(self) -> bool:
        """Keep the outline if it has enough corners."""
        if len(self.corners) >= self.least:
            self.desk.put_new(self.made(tuple(self.corners)))
        return Chain.cancel(self)

    def made(self, corners: Outline) -> Draft:
        """Return the draft with the outline."""
        raise NotImplementedError

    def back(self) -> bool:
        """Remove the last corner."""
        return bool(self.corners) and self.corners.pop() is not None

    def cancel(self) -> bool:
        """Remove all corners."""
        corners, self.corners = self.corners, []
        return bool(corners)

    @property
    def line(self) -> list[Point]:
        """The corners so far, and the place of the next one."""
        ahead = [] if self.pointer is None else [self.desk.snapped(self.pointer)]
        return [*self.corners, *ahead]

    @property
    def remark(self) -> str:
        """The length and direction of the next edge."""
        return stretch(*self.line[-2:]) if self.corners and self.pointer is not None else ""

    def draw(self, scene: Scene) -> None:
        """Draw the corners so far, and the edge to the pointer."""
        if len(self.line) > 1:
            scene.line(self.line, stroke=MARK, width=2.0)
        for corner in self.line:
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
        first, desk = self.corners[:1], self.desk
        there = [desk.snapped(point)] == first or any(desk.near(c, point, CLOSE) for c in first)
        if there and len(self.corners) > 2:
            self.confirm()
        else:
            super().press(point, shift=shift)

    def made(self, corners: Outline) -> Draft:
        """Return the draft with the obstacle."""
        return self.desk.draft.added("outline", corners)

    def draw(self, scene: Scene) -> None:
        """Draw the corners and the area."""
        if self.corners and len(self.line) > 2:
            scene.polygon(self.line, fill=faded(INK, 0.15))
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
