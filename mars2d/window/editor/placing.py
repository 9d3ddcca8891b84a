"""The tools that place new items: robots, props, beacons, waypoints, and joints between them."""

from __future__ import annotations

from collections.abc import Callable
from math import degrees, radians
from typing import Any

import numpy as np

from mars2d.addons.beacon import Beacon
from mars2d.bodies.joints.base import Joint
from mars2d.bodies.joints.hinge import Hinge
from mars2d.bodies.props.base import Prop
from mars2d.core.errors import InputError
from mars2d.core.plane import Point, bounds_of, rectangle
from mars2d.core.scene import Scene, faded
from mars2d.output.layers.bodies import draw_prop, draw_robot
from mars2d.scenario.robot import Robot
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.draft import Draft, seen_from
from mars2d.window.editor.handles import MARK, NOTCH, sized
from mars2d.window.editor.item import Item, Motion, angle_of, tidy
from mars2d.window.editor.picking import item_at
from mars2d.window.editor.readout import sides, size_of, turned
from mars2d.window.editor.tool import Drag, Tool

GHOST = faded(MARK, 0.7)
SQUARE = 1.0
"""The side of an obstacle that is placed by a click, metres."""


class Place(Tool):
    """The base of tools that place an item by a click, and shape it by a drag."""

    def press(self, point: Point, *, shift: bool) -> None:
        """Place an item."""
        start, draft = self.desk.snapped(point), self.desk.draft

        def to(end: Point, shift: bool) -> Draft:
            return self.added(draft, start, end if self.moved else start, shift)

        self.begin(Drag(to, self.measure), point)
        self.desk.hold(to, point, shift=shift)

    def put(self, x: float, y: float, heading: float | None) -> None:
        """Place an item at a typed point."""
        draft = self.added(self.desk.draft, (x, y), (x, y), False)
        (item,) = draft.new_since(self.desk.draft)
        pose = draft.pose(item)
        if heading is not None and pose is not None:
            draft = draft.moved([item], Motion(heading - pose[2], (x, y)))
        self.desk.put_new(draft)

    def added(self, draft: Draft, start: Point, end: Point, shift: bool) -> Draft:
        """Return a draft with a new item that was dragged from start to end."""
        raise NotImplementedError

    def measure(self) -> str:
        """Return a measure of the item that a drag shapes."""
        return ""

    def ghost(self, scene: Scene, place: Point) -> None:
        """Draw the item that a click would place."""
        scene.circle(place, 0.0, fill=GHOST, pixels=5.0)

    def draw(self, scene: Scene) -> None:
        """Draw the item that a click would place at the pointer."""
        if self.drag is None and self.pointer is not None:
            self.ghost(scene, self.desk.snapped(self.pointer))


class PlaceRobot(Place):
    """Places robots that are like the selected one, or like the last one."""

    hint = "Click places a robot, a drag turns it; it is like the selected one"

    def model(self, draft: Draft) -> Robot:
        """Return the robot that the next one is a copy of."""
        chosen = next((i for i in reversed(self.desk.selection) if i.kind == "robot"), None)
        if chosen is not None and draft.holds(chosen):
            return draft.robots[chosen.number]
        return draft.robots[-1] if draft.robots else Robot()

    def added(self, draft: Draft, start: Point, end: Point, shift: bool) -> Draft:
        """Place a robot that heads towards the pointer."""
        robot = self.model(draft)
        heading = robot.pose[2]
        if end != start:
            step = NOTCH if shift else 1.0
            heading = tidy(radians(round(degrees(angle_of(start, end)) / step) * step))
        return draft.added("robot", robot.replace(pose=(*start, heading)))

    def measure(self) -> str:
        """Return the heading."""
        return turned(self.desk.draft, Item("robot", len(self.desk.draft.robots) - 1))

    def ghost(self, scene: Scene, place: Point) -> None:
        """Draw a hollow robot."""
        robot = self.model(self.desk.draft)
        draw_robot(scene, robot, np.array((*place, robot.pose[2])), None, GHOST)


class PlaceProp(Place):
    """Places props of a kind."""

    def __init__(self, desk: Desk, kind: type[Prop]) -> None:
        """Start with nothing pressed."""
        super().__init__(desk)
        self._prop, name = kind(), kind.__name__.lower()
        self.hint = f"Click places a {name}, a drag gives it its size"

    def added(self, draft: Draft, start: Point, end: Point, shift: bool) -> Draft:  # noqa: ARG002
        """Place a prop that is as large as the drag."""
        corner = self.desk.snapped(end)
        drawn = start not in (end, corner)
        prop = sized(self._prop, start, corner) if drawn else self._prop.at(*start)
        return draft.added("prop", prop)

    def measure(self) -> str:
        """Return the size."""
        return size_of(self.desk.draft, Item("prop", len(self.desk.draft.props) - 1))

    def ghost(self, scene: Scene, place: Point) -> None:
        """Draw a hollow prop."""
        draw_prop(scene, self._prop, np.array((*place, 0.0)), MARK, hollow=True)


class PlaceRectangle(Place):
    """Places rectangular obstacles."""

    hint = "Click places a square, a drag gives it its size"

    def added(self, draft: Draft, start: Point, end: Point, shift: bool) -> Draft:  # noqa: ARG002
        """Place a rectangle between two corners, or a square about a point."""
        (x, y), half = start, SQUARE / 2
        corners = [start, self.desk.snapped(end)]
        if end == start or x == corners[1][0] or y == corners[1][1]:
            corners = [(tidy(x - half), tidy(y - half)), (tidy(x + half), tidy(y + half))]
        return draft.added("outline", rectangle(*bounds_of(corners)))

    def measure(self) -> str:
        """Return the size."""
        (left, low), _, (right, high), *_ = self.desk.draft.listed("outline")[-1]
        return sides(right - left, high - low)


class PlaceBeacon(Place):
    """Places beacons."""

    hint = "Click places a beacon"

    def added(self, draft: Draft, start: Point, end: Point, shift: bool) -> Draft:  # noqa: ARG002
        """Place a beacon at the pointer."""
        return draft.added("beacon", Beacon(at=self.desk.snapped(end)))


class PlaceWaypoint(Place):
    """Places waypoints, each at the end of a robot's route."""

    hint = "Click places a waypoint for the robot in the ring; click another robot"

    def __init__(self, desk: Desk) -> None:
        """Start with the selected robot, or else the first one."""
        super().__init__(desk)
        owner = (i.number for i in desk.selection if i.kind in ("robot", "waypoint"))
        self._robot = next(owner, 0)

    @property
    def robot(self) -> Item | None:
        """The robot whose route is drawn."""
        item = Item("robot", self._robot)
        return item if self.desk.draft.holds(item) else None

    def press(self, point: Point, *, shift: bool) -> None:
        """Place a waypoint, or choose another robot."""
        under = item_at(self.desk, point)
        if under is not None and under.kind == "robot":
            self._robot = under.number
            self.desk.select([under])
        elif self.robot is None:
            self.desk.say("waypoints belong to a robot: place one first (R)", warns=True)
        else:
            super().press(point, shift=shift)

    def put(self, x: float, y: float, heading: float | None) -> None:
        """Place a waypoint at a typed point."""
        if self.robot is not None:
            super().put(x, y, heading)

    def added(self, draft: Draft, start: Point, end: Point, shift: bool) -> Draft:  # noqa: ARG002
        """Place a waypoint at the pointer."""
        return draft.added("waypoint", self.desk.snapped(end), robot=self._robot)

    def draw(self, scene: Scene) -> None:
        """Draw a ring round the robot whose route it is."""
        super().draw(scene)
        robot = self.robot
        if robot is not None:
            center, radius = self.desk.draft.robots[robot.number].rigid.bound
            scene.circle(center, radius, stroke=MARK, width=2.0, pixels=7.0)


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
        self.hint = f"Click the body that {to}, or the floor; or type = and its name"

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
        if draft.verdict.text and not desk.draft.verdict.text:
            raise InputError(draft.verdict.text)
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
