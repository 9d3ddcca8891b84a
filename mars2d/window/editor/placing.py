"""The tools that place new items: robots, boxes, balls, beacons, waypoints."""

from __future__ import annotations

from math import degrees, hypot, radians
from typing import ClassVar

import numpy as np

from mars2d.addons.beacon import Beacon
from mars2d.bodies.props.ball import Ball
from mars2d.bodies.props.base import Prop
from mars2d.bodies.props.box import Box
from mars2d.core.plane import Point
from mars2d.core.scene import Scene, faded
from mars2d.output.layers.bodies import draw_prop, draw_robot
from mars2d.scenario.robot import Robot
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.draft import Draft
from mars2d.window.editor.handles import MARK, NOTCH, spanned
from mars2d.window.editor.item import Item, Motion, angle_of, tidy
from mars2d.window.editor.picking import item_at
from mars2d.window.editor.readout import size_of, turned
from mars2d.window.editor.tool import Maker, Making

GHOST = faded(MARK, 0.7)


class Placing(Making):
    """The drag that places a new item and shapes it."""

    def __init__(self, place: Place, start: Point) -> None:
        """Begin where the button was pressed."""
        self.place, self.start, self.draft = place, place.desk.snapped(start), place.desk.draft
        self.begun = False

    def to(self, point: Point, *, shift: bool) -> Draft:
        """Return the draft with the new item."""
        end = point if self.begun else self.start
        draft, self.item = self.place.added(self.draft, self.start, end, shift=shift)
        return draft


class Place(Maker):
    """The base of tools that place an item by a click, and shape it by a drag."""

    gesture: Placing | None = None

    def press(self, point: Point, *, shift: bool) -> None:
        """Place an item."""
        self.pressed = point
        self.gesture = Placing(self, point)
        self.desk.drag(self.gesture, point, shift=shift)

    def move(self, point: Point, *, shift: bool) -> None:
        """Shape the new item."""
        self.pointer = point
        if self.gesture is not None and (self.gesture.begun or self.dragged(point)):
            self.gesture.begun = True
            self.desk.drag(self.gesture, point, shift=shift)

    def put(self, x: float, y: float, heading: float | None) -> None:
        """Place an item at a typed point."""
        draft, item = self.added(self.desk.draft, (x, y), (x, y), shift=False)
        pose = draft.pose(item)
        if heading is not None and pose is not None:
            draft = draft.moved([item], Motion(heading - pose[2], (x, y)))
        self.desk.put(draft)
        self.desk.select([item])

    def added(self, draft: Draft, start: Point, end: Point, *, shift: bool) -> tuple[Draft, Item]:
        """Return a draft with a new item that was dragged from start to end, and the item."""
        raise NotImplementedError

    def ghost(self, scene: Scene, place: Point) -> None:
        """Draw the item that a click would place."""
        scene.circle(place, 0.0, fill=GHOST, pixels=5.0)

    def draw(self, scene: Scene) -> None:
        """Draw the item that a click would place at the pointer."""
        if self.gesture is None and self.pointer is not None:
            self.ghost(scene, self.desk.snapped(self.pointer))

    @property
    def new(self) -> Item | None:
        """The item that the drag shapes."""
        return self.gesture.item if self.gesture is not None and self.gesture.begun else None


class PlaceRobot(Place):
    """Places robots that are like the selected one, or like the last one."""

    hint: ClassVar[str] = "Click places a robot, a drag turns it; it is like the selected one"

    def model(self, draft: Draft) -> Robot:
        """Return the robot that the next one is a copy of."""
        chosen = next((i for i in reversed(self.desk.selection) if i.kind == "robot"), None)
        if chosen is not None and draft.holds(chosen):
            return draft.robots[chosen.number]
        return draft.robots[-1] if draft.robots else Robot()

    def added(self, draft: Draft, start: Point, end: Point, *, shift: bool) -> tuple[Draft, Item]:
        """Place a robot that heads towards the pointer."""
        robot = self.model(draft)
        heading = robot.pose[2]
        if end != start:
            step = NOTCH if shift else 1.0
            heading = tidy(radians(round(degrees(angle_of(start, end)) / step) * step))
        return draft.with_robot(robot.replace(pose=(*start, heading)))

    def ghost(self, scene: Scene, place: Point) -> None:
        """Draw a hollow robot."""
        robot = self.model(self.desk.draft)
        draw_robot(scene, robot, np.array((*place, robot.pose[2])), None, GHOST)

    @property
    def remark(self) -> str:
        """The heading."""
        return "" if self.new is None else turned(self.desk.draft, self.new)


class PlaceProp(Place):
    """The base of tools that place props of one kind."""

    kind: ClassVar[type[Prop]]

    def ghost(self, scene: Scene, place: Point) -> None:
        """Draw a hollow prop."""
        draw_prop(scene, self.kind(), np.array((*place, 0.0)), MARK, hollow=True)

    @property
    def remark(self) -> str:
        """The size."""
        return "" if self.new is None else size_of(self.desk.draft, self.new)


class PlaceBox(PlaceProp):
    """Places boxes."""

    kind: ClassVar[type[Prop]] = Box

    hint: ClassVar[str] = "Click places a box, a drag gives it its size"

    def added(self, draft: Draft, start: Point, end: Point, *, shift: bool) -> tuple[Draft, Item]:  # noqa: ARG002
        """Place a box between two corners."""
        corner = self.desk.snapped(end)
        if end == start or start[0] == corner[0] or start[1] == corner[1]:
            return draft.with_new_prop(Box(pose=(*start, 0.0)))
        return draft.with_new_prop(spanned(Box(), start, corner))


class PlaceBall(PlaceProp):
    """Places balls."""

    kind: ClassVar[type[Prop]] = Ball

    hint: ClassVar[str] = "Click places a ball, a drag gives it its size"

    def added(self, draft: Draft, start: Point, end: Point, *, shift: bool) -> tuple[Draft, Item]:  # noqa: ARG002
        """Place a ball with its centre at `start`."""
        x, y = self.desk.snapped(end)
        ball, radius = Ball(pose=(*start, 0.0)), hypot(x - start[0], y - start[1])
        sized = end != start and radius > 0
        return draft.with_new_prop(ball.replace(diameter=tidy(2 * radius)) if sized else ball)


class PlaceBeacon(Place):
    """Places beacons."""

    hint: ClassVar[str] = "Click places a beacon"

    def added(self, draft: Draft, start: Point, end: Point, *, shift: bool) -> tuple[Draft, Item]:  # noqa: ARG002
        """Place a beacon at the pointer."""
        return draft.with_beacon(Beacon(at=self.desk.snapped(end)))


class PlaceWaypoint(Place):
    """Places waypoints, each at the end of a robot's route."""

    hint: ClassVar[str] = "Click places a waypoint for the robot in the ring; click another robot"

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

    def added(self, draft: Draft, start: Point, end: Point, *, shift: bool) -> tuple[Draft, Item]:  # noqa: ARG002
        """Place a waypoint at the pointer."""
        return draft.with_waypoint(self._robot, self.desk.snapped(end))

    def draw(self, scene: Scene) -> None:
        """Draw a ring round the robot whose route it is."""
        super().draw(scene)
        robot = self.robot
        if robot is not None:
            body = self.desk.draft.body(robot)
            assert body is not None
            center, radius = body.bound
            scene.circle(center, radius, stroke=MARK, width=2.0, pixels=7.0)
