"""The tools that put one thing after the other: robots, boxes, balls, beacons, waypoints."""

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
from mars2d.window.editor.draft import Draft, Item, Motion, tidy
from mars2d.window.editor.gestures import NOTCH, spanned
from mars2d.window.editor.handles import MARK, angle_of
from mars2d.window.editor.target import item_at
from mars2d.window.editor.tool import Maker, Making, minus, sides

__all__ = ["PlaceBall", "PlaceBeacon", "PlaceBox", "PlaceRobot", "PlaceWaypoint"]

GHOST = faded(MARK, 0.7)


class New(Making):
    """Puts a new thing, which the drag shapes."""

    def __init__(self, place: Place, start: Point) -> None:
        """Begin where the button went down."""
        self.place, self.start, self.draft = place, place.desk.snapped(start), place.desk.draft
        self.begun = False

    def to(self, point: Point, *, shift: bool) -> Draft:
        """Return the draft with the thing."""
        end = point if self.begun else self.start
        draft, self.item = self.place.added(self.draft, self.start, end, shift=shift)
        return draft


class Place(Maker):
    """The base of them: a click puts a thing, a drag shapes it, if it has a shape."""

    gesture: New | None = None

    def press(self, point: Point, *, shift: bool) -> None:
        """Put a thing."""
        self.pressed = point
        self.gesture = New(self, point)
        self.desk.drag(self.gesture, point, shift=shift)

    def move(self, point: Point, *, shift: bool) -> None:
        """Shape it."""
        self.pointer = point
        if self.gesture is not None and (self.gesture.begun or self.dragged(point)):
            self.gesture.begun = True
            self.desk.drag(self.gesture, point, shift=shift)

    def put(self, x: float, y: float, heading: float | None) -> None:
        """Put a thing at a typed place."""
        draft, item = self.added(self.desk.draft, (x, y), (x, y), shift=False)
        turned = draft.pose(item)
        if heading is not None and turned is not None:
            draft = draft.moved([item], Motion(heading - turned[2], (x, y)))
        self.desk.put(draft)
        self.desk.select([item])

    def added(self, draft: Draft, start: Point, end: Point, *, shift: bool) -> tuple[Draft, Item]:
        """Return a draft with one more thing, dragged from start to end, and that thing."""
        raise NotImplementedError

    def ghost(self, scene: Scene, place: Point) -> None:
        """Draw what a click would put."""
        scene.circle(place, 0.0, fill=GHOST, pixels=5.0)

    def draw(self, scene: Scene) -> None:
        """Draw what a click would put at the pointer."""
        if self.gesture is None and self.pointer is not None:
            self.ghost(scene, self.desk.snapped(self.pointer))


class PlaceRobot(Place):
    """Puts robots, each like the one selected, or like the last one."""

    hint: ClassVar[str] = "Click puts a robot, a drag turns it; it is like the selected one"

    def model(self, draft: Draft) -> Robot:
        """Return what the next robot is like."""
        chosen = next((i for i in reversed(self.desk.selection) if i.kind == "robot"), None)
        if chosen is not None and draft.holds(chosen):
            return draft.robots[chosen.number]
        return draft.robots[-1] if draft.robots else Robot()

    def added(self, draft: Draft, start: Point, end: Point, *, shift: bool) -> tuple[Draft, Item]:
        """Put a robot, its heading towards the pointer."""
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
        item = None if self.gesture is None or not self.gesture.begun else self.gesture.item
        pose = None if item is None else self.desk.draft.pose(item)
        return "" if pose is None else minus(f"{degrees(pose[2]):.4g}°")


class PlaceBox(Place):
    """Puts boxes."""

    hint: ClassVar[str] = "Click puts a box, a drag gives it its size"

    def added(self, draft: Draft, start: Point, end: Point, *, shift: bool) -> tuple[Draft, Item]:  # noqa: ARG002
        """Put a box between two corners."""
        corner = self.desk.snapped(end)
        if end == start or start[0] == corner[0] or start[1] == corner[1]:
            return draft.with_new_prop(Box(pose=(*start, 0.0)))
        return draft.with_new_prop(spanned(Box(), start, corner))

    def ghost(self, scene: Scene, place: Point) -> None:
        """Draw a hollow box."""
        draw_prop(scene, Box(), np.array((*place, 0.0)), MARK, hollow=True)

    @property
    def remark(self) -> str:
        """The size."""
        prop = _new_prop(self)
        return sides(prop.length, prop.width) if isinstance(prop, Box) else ""


class PlaceBall(Place):
    """Puts balls."""

    hint: ClassVar[str] = "Click puts a ball, a drag gives it its size"

    def added(self, draft: Draft, start: Point, end: Point, *, shift: bool) -> tuple[Draft, Item]:  # noqa: ARG002
        """Put a ball about its centre."""
        x, y = self.desk.snapped(end)
        ball, radius = Ball(pose=(*start, 0.0)), hypot(x - start[0], y - start[1])
        sized = end != start and radius > 0
        return draft.with_new_prop(ball.replace(diameter=tidy(2 * radius)) if sized else ball)

    def ghost(self, scene: Scene, place: Point) -> None:
        """Draw a hollow ball."""
        draw_prop(scene, Ball(), np.array((*place, 0.0)), MARK, hollow=True)

    @property
    def remark(self) -> str:
        """The size."""
        prop = _new_prop(self)
        return f"diameter {prop.diameter:.3g} m" if isinstance(prop, Ball) else ""


class PlaceBeacon(Place):
    """Puts beacons."""

    hint: ClassVar[str] = "Click puts a beacon"

    def added(self, draft: Draft, start: Point, end: Point, *, shift: bool) -> tuple[Draft, Item]:  # noqa: ARG002
        """Put a beacon where the pointer is."""
        return draft.with_beacon(Beacon(at=self.desk.snapped(end)))


class PlaceWaypoint(Place):
    """Puts waypoints, each at the end of a robot's route."""

    hint: ClassVar[str] = "Click puts a waypoint for the robot in the ring; click another robot"

    def __init__(self, desk: Desk) -> None:
        """Take the selected robot, or else the first one."""
        super().__init__(desk)
        owner = (i.number for i in desk.selection if i.kind in ("robot", "waypoint"))
        self._robot = next(owner, 0)

    @property
    def robot(self) -> Item | None:
        """The robot whose route is drawn."""
        item = Item("robot", self._robot)
        return item if self.desk.draft.holds(item) else None

    def press(self, point: Point, *, shift: bool) -> None:
        """Put a waypoint, or take another robot."""
        under = item_at(self.desk, point)
        if under is not None and under.kind == "robot":
            self._robot = under.number
            self.desk.select([under])
        elif self.robot is None:
            self.desk.say("waypoints are a robot's: first put one (R)", warns=True)
        else:
            super().press(point, shift=shift)

    def put(self, x: float, y: float, heading: float | None) -> None:
        """Put a waypoint at a typed place."""
        if self.robot is not None:
            super().put(x, y, heading)

    def added(self, draft: Draft, start: Point, end: Point, *, shift: bool) -> tuple[Draft, Item]:  # noqa: ARG002
        """Put a waypoint where the pointer is."""
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


def _new_prop(tool: Place) -> Prop | None:
    item = None if tool.gesture is None or not tool.gesture.begun else tool.gesture.item
    return None if item is None else tool.desk.draft.props[item.number]
