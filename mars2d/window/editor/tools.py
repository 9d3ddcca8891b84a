"""The editor's tools, which decide the effect of the mouse at points of the world [m]."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from math import degrees, dist, radians
from typing import Any

from mars2d.addons.beacon import Beacon
from mars2d.bodies.joints.base import Joint
from mars2d.bodies.joints.hinge import Hinge
from mars2d.bodies.props.base import Prop
from mars2d.bodies.props.solid import Solid
from mars2d.core.errors import InputError
from mars2d.core.plane import Outline, Point, bounds_of, rectangle
from mars2d.core.scene import INK, Scene, faded
from mars2d.geometry.shapes import Polygon
from mars2d.output.raster.theme import LIGHT
from mars2d.scenario.robot import Robot
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.draft import Draft, Item, Kind, Motion, angle_of, seen_from, tidy
from mars2d.window.editor.grips import NOTCH, Grip, banding, grip_at, grips, moving, sized
from mars2d.window.widgets.rows import minus

CLICK = 5.0
"""A press that moves by less than this is a click, points."""
CLOSE = 10.0
"""A click this near to the first corner closes a polygon, points."""
MARK, PAPER = LIGHT.selected, LIGHT.paper
GHOST = faded(MARK, 0.7)
SQUARE = 1.0
"""The side of an obstacle that is placed by a click, metres."""


def draw_outline(
    draft: Draft, item: Item, scene: Scene, stroke: str, width: float, fill: str | None = None
) -> None:
    """Draw the outlines of an item."""
    for points, radius in draft.rims(item):
        if len(points) == 1:
            pixels = 0.0 if radius else 9.0
            look = {"fill": fill} if radius else {}
            scene.circle(points[0], radius, stroke=stroke, width=width, pixels=pixels, **look)
        elif draft.is_line(item):
            scene.line(points, stroke=stroke, width=width)
        else:
            inside = None if item.kind == "workspace" else fill
            scene.polygon(points, stroke=stroke, fill=inside, width=width)


class Tool:
    """The base of all tools: methods for the mouse, and a few keys.

    hint: a line that says what to do. drag: the present one. moved: whether the pointer has moved
    since it began.
    """

    hint: str = ""

    def __init__(self, desk: Desk) -> None:
        """Start with nothing pressed."""
        self.desk = desk
        self.pointer: Point | None = None
        self.drag: Grip | None = None
        self.moved = False
        self._pressed: Point = (0.0, 0.0)

    def press(self, point: Point) -> None:
        """Press the left button."""

    def begin(self, drag: Grip, point: Point) -> None:
        """Begin a drag."""
        self.drag, self._pressed, self.moved = drag, point, False
        if drag.at_once:
            self.desk.hold(drag.to, drag.point)

    def move(self, point: Point) -> None:
        """Move the mouse, with or without the button."""
        self.pointer = point
        if self.drag is not None:
            self.moved = self.moved or not self.desk.near(self._pressed, point, CLICK)
            if self.moved:
                self.desk.hold(self.drag.to, point)

    def release(self) -> None:
        """Release the button: keep the changes of the drag, and select what is new."""
        clicked = None if self.drag is None or self.moved else self.drag.clicked
        self.drag, self.moved = None, False
        self.desk.settle()
        if clicked is not None:
            self.desk.select([clicked])

    @property
    def place(self) -> str:
        """Where what it holds is, as it can be typed; "" if it holds nothing yet."""
        return ""

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
        """What to show beside the pointer: the size, heading or place that the drag changes."""
        now, before = self.desk.draft, self.desk.settled
        changed = now.new_since(before) if self.moved else []
        if len(changed) != 1:
            return ""
        known = before.described(changed[0]) if changed[0] in before.things else []
        words = (line for line in reversed(now.described(changed[0])) if line not in known)
        return next(words, "")


class Select(Tool):
    """Selects, moves, turns and resizes items."""

    @property
    def place(self) -> str:
        """The place of the selection: of its corner, or of a body with its heading in degrees."""
        desk, draft = self.desk, self.desk.draft
        if desk.corner is not None:
            return _typed(desk.corners[desk.corner])
        held = desk.selection[0]
        body = draft.body(held) if held == desk.only else None
        return _typed(
            (*draft.place(held), *([] if body is None else [round(degrees(body.pose[2]), 6)]))
        )

    def put(self, x: float, y: float, heading: float | None) -> None:
        """Put the selection at a point: its corner, a body's pose, or an outline's first corner."""
        desk, draft = self.desk, self.desk.draft
        held = desk.selection[0]
        body, place = draft.body(held), draft.place(held)
        if heading is not None and (body is None or desk.only is None):
            raise InputError("only one robot or prop alone has a heading: expected x y")
        if desk.corner is not None:
            desk.put(draft.with_corner(held, desk.corner, (x, y)))
            return
        angle = 0.0 if heading is None or body is None else heading - body.pose[2]
        by = x - place[0], y - place[1]
        desk.put(draft.moved(desk.selection, Motion(angle, place, by)))

    def press(self, point: Point) -> None:
        """Begin to drag a handle, an item, or a rectangle round items."""
        desk = self.desk
        grip, item = grip_at(desk, point), desk.item_at(point)
        if grip is None and item is not None and item.kind == "route" and not desk.shift:
            desk.select([item])  # its waypoints are dragged at once
            grip = grip_at(desk, point)
        if grip is not None:
            desk.corner = grip.corner
            self.begin(grip, point)
            return
        if item is None:
            kept = desk.selection if desk.shift else ()
            desk.select(kept)
            self.begin(banding(desk, point, kept), point)
            return
        if desk.shift:
            others = tuple(other for other in desk.selection if other != item)
            desk.select(others if item in desk.selection else (*others, item))
        elif item not in desk.selection:
            desk.select([item])
        if item in desk.selection:
            self.begin(moving(desk, item, point), point)

    def draw(self, scene: Scene) -> None:
        """Draw the ring, the handles and the rectangle."""
        desk = self.desk
        for grip in grips(desk):
            x, y = grip.point
            if grip.look == "ring":
                radius = dist(grip.center, grip.point)
                scene.circle(grip.center, radius, stroke=PAPER, width=3.5)
                scene.circle(grip.center, radius, stroke=MARK, width=1.5)
                scene.circle((x, y), 0.0, fill=MARK, stroke=PAPER, width=2.0, pixels=7.0)
            elif grip.look == "dot":
                scene.circle((x, y), 0.0, fill=PAPER, stroke=MARK, width=1.2, pixels=3.2)
            else:
                chosen = grip.corner is not None and grip.corner == desk.corner
                half = desk.metres(6.5 if chosen else 5.0)
                square = rectangle(x - half, x + half, y - half, y + half)
                scene.polygon(square, fill=MARK if chosen else PAPER, stroke=MARK, width=2.0)
        if self.drag is not None and self.drag.look == "band" and self.pointer is not None:
            area = rectangle(*bounds_of([self.drag.point, self.pointer]))
            scene.polygon(area, fill=faded(MARK, 0.08), stroke=MARK, width=1.0)


def _typed(numbers: Iterable[float]) -> str:
    """Return numbers as they are typed, to the last digit."""
    return " ".join(repr(tidy(number)).removesuffix(".0") for number in numbers)


# -- what is placed by a click, and shaped by a drag ----------------------------------------------

Made = dict[Item, Any]
"""What is added to a draft; see `Draft.added`."""


class Place(Tool):
    """Places items.

    make: returns what a drag makes, given the desk and both ends of the drag.
    """

    def __init__(self, desk: Desk, make: Callable[[Desk, Point, Point], Made]) -> None:
        """Start with nothing pressed."""
        super().__init__(desk)
        self._make = make

    def press(self, point: Point) -> None:
        """Place an item."""
        desk, start, draft = self.desk, self.desk.snapped(point), self.desk.draft

        def to(end: Point) -> Draft:
            return draft.added(self._make(desk, start, end if self.moved else start))

        self.begin(Grip(to, point, at_once=True), point)

    def put(self, x: float, y: float, heading: float | None) -> None:
        """Place an item at a typed point."""
        draft, item = self._added((x, y))
        body = draft.body(item)
        if heading is not None and body is not None:
            draft = draft.moved([item], Motion(heading - body.pose[2], (x, y)))
        self.desk.put(draft, shows=True)

    def _added(self, at: Point) -> tuple[Draft, Item]:
        """Return the draft with one more item at a point, and the item."""
        draft = self.desk.draft.added(self._make(self.desk, at, at))
        return draft, draft.new_since(self.desk.draft)[-1]

    def draw(self, scene: Scene) -> None:
        """Draw the outline of what a click would place at the pointer."""
        if self.drag is None and self.pointer is not None:
            with suppress(InputError):  # it has no robot yet
                draw_outline(*self._added(self.desk.snapped(self.pointer)), scene, GHOST, 2.0)


class PlaceWaypoint(Place):
    """Places waypoints, each at the end of a robot's route."""

    def press(self, point: Point) -> None:
        """Place a waypoint, or choose another robot."""
        under = self.desk.item_at(point)
        if under is not None and under.kind == "robot":
            self.desk.select([under])
        else:
            super().press(point)

    def draw(self, scene: Scene) -> None:
        """Draw a ring round the robot whose route it is."""
        super().draw(scene)
        for robot in self.desk.draft.base.robots[_walker(self.desk) :][:1]:
            center, radius = robot.rigid.bound
            scene.circle(center, radius, stroke=MARK, width=2.0, pixels=7.0)


def robot(desk: Desk, start: Point, end: Point) -> Made:
    """Make a robot that heads towards the pointer, like the selected one, or the last one."""
    draft = desk.settled
    chosen = [draft.things[item] for item in desk.selection if item.kind == "robot"]
    (*_, model) = chosen or (Robot(), *draft.base.robots)
    heading = model.pose[2]
    if end != start:
        step = NOTCH if desk.shift else 1.0
        heading = tidy(radians(round(degrees(angle_of(start, end)) / step) * step))
    return {Item("robot"): model.replace(pose=(*start, heading))}


def prop(kind: type[Prop], desk: Desk, start: Point, end: Point) -> Made:
    """Make a prop of a kind that is as large as the drag."""
    corner = desk.snapped(end)
    drawn = start not in (end, corner)
    return {Item("prop"): sized(kind(), start, corner) if drawn else kind().at(*start)}


def block(desk: Desk, start: Point, end: Point) -> Made:
    """Make a rectangular obstacle between two corners, or a square about a point."""
    (x, y), half = start, SQUARE / 2
    corners = [start, desk.snapped(end)]
    if end == start or x == corners[1][0] or y == corners[1][1]:
        corners = [(tidy(x - half), tidy(y - half)), (tidy(x + half), tidy(y + half))]
    return {Item("outline"): rectangle(*bounds_of(corners))}


def beacon(desk: Desk, start: Point, end: Point) -> Made:
    """Make a beacon at the pointer."""
    return {Item("beacon"): Beacon(at=start if start == end else desk.snapped(end))}


def waypoint(desk: Desk, start: Point, end: Point) -> Made:
    """Make a waypoint at the pointer."""
    if not desk.draft.base.robots:
        raise InputError("waypoints belong to a robot: place one first (R)")
    place = start if start == end else desk.snapped(end)
    return {Item("route", _walker(desk)): (place,)}


def _walker(desk: Desk) -> int:
    """Return the number of the robot whose route is drawn: the selected one, or else the first."""
    return next((i.number for i in desk.selection if i.kind in ("robot", "route")), 0)


# -- what is drawn corner by corner ---------------------------------------------------------------


class Chain(Tool):
    """Draws walls, obstacles, and props of any shape, corner by corner.

    kind: of the item. make: returns what it is, given its corners. All but walls are closed; a wall
    is kept when it is cancelled.
    """

    def __init__(self, desk: Desk, kind: Kind, make: Callable[[Outline], Any] = tuple) -> None:
        """Start without corners."""
        super().__init__(desk)
        self.corners: list[Point] = []
        self._item, self._make, self._closed = Item(kind), make, kind != "wall"
        self._least = 3 if self._closed else 2

    def press(self, point: Point) -> None:
        """Add a corner; close a polygon at the first one."""
        first, at = self.corners[:1], self.desk.snapped(point)
        there = [at] == first or any(self.desk.near(each, point, CLOSE) for each in first)
        if there and self._closed and len(self.corners) >= self._least:
            self.confirm()
        else:
            self.put(*at, None)

    def put(self, x: float, y: float, heading: float | None) -> None:  # noqa: ARG002
        """Add a corner at a typed point, unless it is the same as the last one."""
        if [(x, y)] != self.corners[-1:]:
            self.corners.append((x, y))

    def confirm(self) -> bool:
        """Keep the outline if it has enough corners."""
        corners, self.corners = self.corners, []
        if len(corners) >= self._least:
            self.desk.put(
                self.desk.draft.added({self._item: self._make(tuple(corners))}), shows=True
            )
        return bool(corners)

    def back(self) -> bool:
        """Remove the last corner."""
        return bool(self.corners) and self.corners.pop() is not None

    def cancel(self) -> bool:
        """Remove all corners; keep a wall as far as it is drawn."""
        if not self._closed:
            return self.confirm()
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
        if not self.corners or self.pointer is None:
            return ""
        a, b = self.line[-2:]
        turn = round(degrees(angle_of(a, b)), 1) + 0.0
        return minus(f"{dist(a, b):.4g} m   {turn:g}°") if a != b else ""

    def draw(self, scene: Scene) -> None:
        """Draw the corners so far, the edge to the pointer, and the area."""
        if self._closed and self.corners and len(self.line) > 2:
            scene.polygon(self.line, fill=faded(INK, 0.15))
        if len(self.line) > 1:
            scene.line(self.line, stroke=MARK, width=2.0)
        for corner in self.line:
            scene.circle(corner, 0.0, fill=PAPER, stroke=MARK, width=1.5, pixels=3.5)
        if self._closed and len(self.corners) > 2:
            scene.circle(self.corners[0], 0.0, stroke=MARK, width=2.0, pixels=8.0)


def solid(corners: Outline) -> Solid:
    """Return a prop of any shape."""
    shape = Polygon(corners)
    x, y = shape.centroid
    return Solid(shape, pose=(tidy(x), tidy(y), 0.0))


# -- joints ---------------------------------------------------------------------------------------


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
        self.hint = f"{kind.__name__}: click a body or the floor"

    def press(self, point: Point) -> None:
        """Tie the bodies to the item at a point [m]; a pin snaps to the grid."""
        self._tie(point, self.desk.snapped(point))

    def put(self, x: float, y: float, heading: float | None) -> None:  # noqa: ARG002
        """Tie the bodies to the item at a typed point."""
        self._tie((x, y), (x, y))

    def _tie(self, point: Point, at: Point) -> None:
        desk, draft = self.desk, self.desk.draft
        other = desk.item_at(point, self._items)
        body = None if other is None else draft.body(other)
        ends: dict[str, Any] = {"b": None if body is None else body.name}
        if body is None or self._pins:
            ends["anchor_b"] = seen_from(body, at)
        joints = {}
        for k, item in enumerate(self._items):
            if self._pins:
                ends["anchor_a"] = seen_from(draft.body(item), at)
            joints[Item("joint", k)] = self._kind(a=draft.name(item), **ends)
        draft = draft.added(joints)
        if draft.verdict.text and not desk.draft.verdict.text:
            raise InputError(draft.verdict.text)
        desk.put(draft)
        self._done()

    def draw(self, scene: Scene) -> None:
        """Draw a line from each body to the pointer."""
        for item in self._items:
            if self.pointer is not None and item in self.desk.draft.things:
                ends = [self.desk.draft.place(item), self.pointer]
                scene.line(ends, stroke=GHOST, width=2.0, style="--")
