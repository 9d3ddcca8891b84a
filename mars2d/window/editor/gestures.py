"""Drags of items: move, turn, shift a corner, resize a rectangle."""

from __future__ import annotations

from math import cos, degrees, radians, sin

from mars2d.bodies.props.base import Prop
from mars2d.core.plane import Point
from mars2d.window.editor.desk import Desk, Gesture
from mars2d.window.editor.draft import Draft
from mars2d.window.editor.handles import Ring, angle_of, size_corners
from mars2d.window.editor.item import Item, Motion, tidy

__all__ = ["Cornering", "Moving", "Sizing", "Turning"]

NOTCH = 15.0
"""The steps of a turn with Shift, degrees."""

MIN_SIDE = 0.01
"""The shortest side of a rectangle that is drawn, metres."""


class Moving(Gesture):
    """Moves the selection; the item that was grabbed snaps to the grid."""

    def __init__(self, desk: Desk, grabbed: Item, start: Point) -> None:
        """Begin where the button was pressed."""
        self.desk, self.start = desk, start
        self.draft, self.items = desk.draft, desk.selection
        self.place = desk.draft.place(grabbed)

    def to(self, point: Point, *, shift: bool) -> Draft:  # noqa: ARG002
        """Move the selection to the pointer."""
        (x, y), (ax, ay) = self.place, self.start
        goal = self.desk.snapped((x + point[0] - ax, y + point[1] - ay))
        return self.draft.moved(self.items, Motion(by=(goal[0] - x, goal[1] - y)))


class Turning(Gesture):
    """Turns the selection about the middle of its ring, with Shift in notches."""

    def __init__(self, desk: Desk, ring: Ring) -> None:
        """Begin with the handle where it is."""
        self.desk, self.ring = desk, ring
        self.draft, self.items = desk.draft, desk.selection
        pose = None if desk.only is None else desk.draft.pose(desk.only)
        self.zero = ring.heading if pose is None else 0.0  # from where notches are counted

    def to(self, point: Point, *, shift: bool) -> Draft:
        """Turn the handle towards the pointer."""
        step = NOTCH if shift else 1.0 if self.desk.snaps else 0.1
        wanted = degrees(angle_of(self.ring.center, point) - self.zero)
        angle = radians(round(wanted / step) * step) - (self.ring.heading - self.zero)
        if abs(angle) < 1e-12:
            return self.draft
        return self.draft.moved(self.items, Motion(angle, self.ring.center))


class Cornering(Gesture):
    """Moves a corner of an outline, a wall or the workspace; or adds one first."""

    def __init__(self, desk: Desk, item: Item, number: int, *, new: bool = False) -> None:
        """Begin with a corner; new: add one after it, and move that."""
        self.desk, self.item = desk, item
        self.draft = desk.draft
        corners = list(desk.draft.corners(item) or ())
        self.number = number + 1 if new else number
        if new:
            corners.insert(self.number, corners[number])
        self.corners = corners

    def to(self, point: Point, *, shift: bool) -> Draft:  # noqa: ARG002
        """Put the corner at the pointer."""
        corners = self.corners.copy()
        corners[self.number] = self.desk.snapped(point)
        return self.draft.with_corners(self.item, corners)


class Sizing(Gesture):
    """Resizes a rectangular prop by a corner; the opposite corner stays."""

    def __init__(self, desk: Desk, item: Item, number: int) -> None:
        """Begin with a corner."""
        self.desk, self.item, self.draft = desk, item, desk.draft
        self.fixed = size_corners(desk.draft, item)[(number + 2) % 4]

    def to(self, point: Point, *, shift: bool) -> Draft:  # noqa: ARG002
        """Put the corner at the pointer."""
        k = self.item.number
        prop = spanned(self.draft.props[k], self.fixed, self.desk.snapped(point))
        return self.draft.with_prop(k, prop)


def spanned(prop: Prop, a: Point, b: Point) -> Prop:
    """Return a rectangular prop between two opposite corners, with the same heading."""
    x, y, theta = prop.pose
    c, s = cos(theta), sin(theta)
    dx, dy = b[0] - a[0], b[1] - a[1]
    along, across = c * dx + s * dy, c * dy - s * dx
    length, width = (tidy(max(abs(side), MIN_SIDE)) for side in (along, across))
    along, across = (side / 2 if v >= 0 else -side / 2
                     for side, v in ((length, along), (width, across)))  # fmt: skip
    x, y = a[0] + c * along - s * across, a[1] + s * along + c * across
    return prop.with_side_lengths(length, width).replace(pose=(tidy(x), tidy(y), theta))
