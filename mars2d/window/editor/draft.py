"""The draft that the editor works on: the items of a scenario, each valid by itself."""

from __future__ import annotations

import copy
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import count
from typing import Any, Self, cast

import numpy as np

from mars2d.addons.base import Addon
from mars2d.addons.beacon import Beacon
from mars2d.addons.map import Map
from mars2d.addons.waypoints import Waypoints
from mars2d.bodies.joints.base import Joint
from mars2d.bodies.props.base import Prop
from mars2d.bodies.rigid import Rigid
from mars2d.core import checks
from mars2d.core.description import snake_case
from mars2d.core.errors import InputError
from mars2d.core.plane import Outline, Point, bounds_of
from mars2d.record.frame import Frame
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.window.editor.item import FIELDS, Item, Kind, Motion

DRAWN = (Map, Waypoints, Beacon)
"""The add-ons that are drawn with the mouse."""

BLANK: Outline = Scenario.__dataclass_fields__["workspace"].default
"""The area shown of an empty draft, metres."""


@dataclass(frozen=True)
class Draft:
    """The items of a scenario; `base` is the scenario that holds everything else.

    Each item is valid by itself, except outlines, which may cross themselves while they are drawn.
    outlines, walls: those of the first Map. routes: the waypoints, one list per robot.
    """

    base: Scenario
    robots: tuple[Robot, ...]
    props: tuple[Prop, ...]
    joints: tuple[Joint, ...]
    outlines: tuple[Outline, ...]
    walls: tuple[Outline, ...]
    routes: tuple[Outline, ...]
    beacons: tuple[Beacon, ...]
    workspace: Outline | None

    @classmethod
    def of(cls, scenario: Scenario) -> Self:
        """Return the draft of a scenario."""
        chart, routes = _first(Map, scenario.addons), _first(Waypoints, scenario.addons)
        drawn = () if routes is None else tuple(routes.routes)[: len(scenario.robots)]
        return cls(
            base=scenario,
            robots=tuple(scenario.robots),
            props=tuple(scenario.props),
            joints=tuple(scenario.joints),
            outlines=() if chart is None else tuple(chart.outlines),
            walls=() if chart is None else tuple(chart.walls),
            routes=(*drawn, *[()] * (len(scenario.robots) - len(drawn))),
            beacons=tuple(_all(Beacon, scenario.addons)),
            workspace=scenario.workspace,
        )

    @classmethod
    def empty(cls, scenario: Scenario) -> Self:
        """Return the draft of a scenario without its robots; no scenario can be empty."""
        return replace(cls.of(scenario), robots=(), routes=())

    # -- as a scenario --------------------------------------------------------------------------

    def scenario(self) -> Scenario:
        """Return the scenario. Raises InputError if it is not valid."""
        return self.base.replace(
            robots=self.robots,
            props=self.props,
            joints=self._joints(),
            workspace=self.workspace,
            addons=self._addons(self.outlines, self.base.addons),
        )

    @cached_property
    def sketch(self) -> Scenario:
        """The scenario for drawing: unchecked, and without invalid outlines. Never simulate it."""
        return self._sketch(self.base.addons)

    @cached_property
    def bare_sketch(self) -> Scenario:
        """The sketch with only the add-ons that are drawn with the mouse."""
        return self._sketch(_all(DRAWN, self.base.addons))

    def _sketch(self, addons: Sequence[Addon]) -> Scenario:
        sound = [outline for outline in self.outlines if flaw(outline) is None]
        animation = self.base.animation.replace(show_initial_pose=False)
        drawn = copy.copy(self.base)
        drawn.__dict__.update(
            robots=self.robots,
            props=self.props,
            joints=self._joints(),
            workspace=self.workspace,
            addons=tuple(self._addons(sound, addons)),
            animation=animation,
        )
        if self.workspace is None and not (self.robots or self.props or drawn.obstacles):
            drawn.__dict__["workspace"] = BLANK
        return drawn

    def _names(self) -> set[str | None]:
        return {robot.name for robot in self.robots} | {prop.name for prop in self.props}

    def _joints(self) -> tuple[Joint, ...]:
        """Return the joints whose bodies still exist."""
        names = self._names() | {None}
        return tuple(joint for joint in self.joints if {joint.a, joint.b} <= names)

    def _addons(self, outlines: Sequence[Outline], addons: Sequence[Addon]) -> list[Addon]:
        """Return the base's add-ons, those that are drawn replaced by their present state."""
        drawn = self._drawn_addons(outlines)
        base = self.base.addons
        edited = [_first(Map, base), _first(Waypoints, base), *_all(Beacon, base)]
        ids = {id(addon) for addon in edited}
        result = []
        for addon in addons:
            if id(addon) not in ids:
                result.append(addon)
            elif addon.key in drawn:
                result.append(drawn.pop(addon.key))
        return [*result, *drawn.values()]

    def _drawn_addons(self, outlines: Sequence[Outline]) -> dict[str, Addon]:
        """Return the map, the waypoints and the beacons that exist, by their keys."""
        result: dict[str, Addon] = {}
        if outlines or self.walls:
            own = _first(Map, self.base.addons)
            make = _chart if type(own) in (Map, type(None)) else _chart.__wrapped__
            chart = make(own, tuple(outlines), self.walls)
            result[chart.key] = chart
        routes = self.routes
        while routes and not routes[-1]:
            routes = routes[:-1]
        if routes:
            known = _first(Waypoints, self.base.addons)
            ways = Waypoints(routes) if known is None else known.replace(routes=routes)
            result[ways.key] = ways
        return result | {beacon.key: beacon for beacon in self.beacons}

    # -- its items ------------------------------------------------------------------------------

    def items(self) -> tuple[Item, ...]:
        """Return all items but the workspace, the lowest first."""
        plain: tuple[Kind, ...] = ("outline", "wall", "prop", "robot", "beacon")
        found = [Item(kind, i) for kind in plain for i in range(len(getattr(self, FIELDS[kind])))]
        ways = [
            Item("waypoint", i, k) for i, route in enumerate(self.routes) for k in range(len(route))
        ]
        return (*found, *ways)

    def new_since(self, before: Draft) -> list[Item]:
        """Return the items that an earlier draft did not have as they are now."""
        known = {id(before.value(item)) for item in before.items()}
        return [item for item in self.items() if id(self.value(item)) not in known]

    def value(self, item: Item) -> object:
        """Return what an item is: a robot, a prop, corners, a beacon, or a waypoint's point."""
        if item.kind == "workspace":
            return self.workspace
        listed = getattr(self, FIELDS[item.kind])[item.number]
        return listed[item.part] if item.kind == "waypoint" else listed

    def holds(self, item: Item) -> bool:
        """Return whether an item exists."""
        if item.kind == "workspace":
            return self.workspace is not None
        listed = getattr(self, FIELDS[item.kind])
        if item.number >= len(listed):
            return False
        return item.kind != "waypoint" or item.part < len(listed[item.number])

    def name(self, item: Item) -> str:
        """Return an item's name in words."""
        if item.kind == "robot":
            return str(self.robots[item.number].name)
        if item.kind == "prop":
            return str(self.props[item.number].name)
        if item.kind == "beacon":
            return self.beacons[item.number].key
        if item.kind == "waypoint":
            return f"waypoint {item.part} of {self.robots[item.number].name}"
        if item.kind == "workspace":
            return "the workspace"
        return f"{'obstacle' if item.kind == 'outline' else 'wall'} {item.number}"

    def corners(self, item: Item) -> Outline | None:
        """Return the corners of an outline, a wall or the workspace; None for other items."""
        if item.kind in ("outline", "wall", "workspace"):
            return cast("Outline | None", self.value(item))
        return None

    def pose(self, item: Item) -> tuple[float, float, float] | None:
        """Return the pose of a robot or prop; None for other items."""
        if item.kind == "robot":
            return self.robots[item.number].pose
        return self.props[item.number].pose if item.kind == "prop" else None

    def body(self, item: Item) -> Rigid | None:
        """Return the body of a robot or prop; None for other items."""
        if item.kind == "robot":
            return self.robots[item.number].rigid
        return self.props[item.number].rigid if item.kind == "prop" else None

    def place(self, item: Item) -> Point:
        """Return the point of an item that snaps to the grid."""
        pose = self.pose(item)
        if pose is not None:
            return pose[:2]
        if item.kind == "waypoint":
            return self.routes[item.number][item.part]
        if item.kind == "beacon":
            return self.beacons[item.number].position
        return (self.corners(item) or ((0.0, 0.0),))[0]

    def bounds(self, items: Collection[Item]) -> tuple[float, float, float, float]:
        """Return (xmin, xmax, ymin, ymax) of items, metres."""
        points: list[Point] = []
        for item in items:
            body = self.body(item)
            if body is None:
                points += self.corners(item) or [self.place(item)]
            else:
                (x, y), r = body.bound
                points += [(x - r, y - r), (x + r, y + r)]
        return bounds_of(points)

    # -- changes --------------------------------------------------------------------------------

    def moved(self, items: Collection[Item], motion: Motion) -> Self:
        """Return the draft with items moved."""
        draft = self
        for item in items:
            draft = draft._with(item, draft._moved_one(item, motion))
        return draft

    def _moved_one(self, item: Item, motion: Motion) -> object:
        if item.kind == "waypoint":
            return motion.point(self.place(item))
        if item.kind == "beacon":
            beacon = self.beacons[item.number]
            if beacon.path is None:
                return beacon.replace(at=motion.point(beacon.position))
            return beacon.replace(path=[motion.point(point) for point in beacon.path])
        corners = self.corners(item)
        if corners is not None:
            return tuple(motion.point(corner) for corner in corners)
        body = self.member(item)
        return body.replace(pose=motion.pose(body.pose))

    def with_corners(self, item: Item, corners: Outline) -> Self:
        """Return the draft with other corners of an outline, a wall or the workspace."""
        return self._with(item, tuple(corners))

    def with_prop(self, index: int, prop: Prop) -> Self:
        """Return the draft with one prop replaced."""
        return self._with(Item("prop", index), prop)

    def member(self, item: Item) -> Robot | Prop:
        """Return a robot or prop."""
        return self.robots[item.number] if item.kind == "robot" else self.props[item.number]

    def with_members(self, items: Collection[Item], change: Callable[[Any], Robot | Prop]) -> Self:
        """Return the draft with robots or props changed, each by a function of itself."""
        draft = self
        for item in items:
            draft = draft._with(item, change(draft.member(item)))
        return draft

    def joints_of(self, item: Item) -> tuple[Joint, ...]:
        """Return the joints that hold a robot or prop."""
        name = self.member(item).name
        return tuple(joint for joint in self._joints() if name in (joint.a, joint.b))

    def with_joint(self, joint: Joint, instead: Joint | None = None) -> Self:
        """Return the draft with one more joint, or with one in place of another."""
        if instead is None:
            return replace(self, joints=(*self.joints, joint))
        return replace(self, joints=tuple(joint if j is instead else j for j in self.joints))

    def without_joint(self, joint: Joint) -> Self:
        """Return the draft without a joint."""
        return replace(self, joints=tuple(each for each in self.joints if each is not joint))

    def _with(self, item: Item, value: Any) -> Self:
        if item.kind == "workspace":
            return replace(self, workspace=value)
        field = FIELDS[item.kind]
        listed = list(getattr(self, field))
        if item.kind == "waypoint":
            route = list(listed[item.number])
            route[item.part] = value
            value = tuple(route)
        listed[item.number] = value
        changes: dict[str, Any] = {field: tuple(listed)}
        return replace(self, **changes)

    def with_robot(self, robot: Robot) -> tuple[Self, Item]:
        """Return the draft with one more robot, which gets a new name, and its item."""
        named = robot.replace(name=self.free_name("robot"))
        draft = replace(self, robots=(*self.robots, named), routes=(*self.routes, ()))
        return draft, Item("robot", len(self.robots))

    def with_new_prop(self, prop: Prop) -> tuple[Self, Item]:
        """Return the draft with one more prop, which gets a new name, and its item."""
        named = prop.replace(name=self.free_name(snake_case(type(prop).__name__)))
        return replace(self, props=(*self.props, named)), Item("prop", len(self.props))

    def with_outline(self, corners: Outline) -> tuple[Self, Item]:
        """Return the draft with one more solid obstacle, and its item."""
        outlines = (*self.outlines, tuple(corners))
        return replace(self, outlines=outlines), Item("outline", len(self.outlines))

    def with_wall(self, corners: Outline) -> tuple[Self, Item]:
        """Return the draft with one more wall of two or more corners, and its item."""
        return replace(self, walls=(*self.walls, tuple(corners))), Item("wall", len(self.walls))

    def with_waypoint(self, robot: int, point: Point) -> tuple[Self, Item]:
        """Return the draft with one more waypoint at the end of a robot's route, and its item."""
        route = self.routes[robot]
        routes = (*self.routes[:robot], (*route, point), *self.routes[robot + 1 :])
        return replace(self, routes=routes), Item("waypoint", robot, len(route))

    def with_beacon(self, beacon: Beacon) -> tuple[Self, Item]:
        """Return the draft with one more beacon, which gets a new name, and its item."""
        taken = {addon.key for addon in (*self.base.addons, *self.beacons)}
        names = ("beacon" if k == 0 else f"beacon{k}" for k in count())
        named = beacon.replace(name=next(name for name in names if name not in taken))
        return replace(self, beacons=(*self.beacons, named)), Item("beacon", len(self.beacons))

    def without(self, items: Collection[Item]) -> Self:
        """Return the draft without items; a robot's route goes with it."""
        gone = set(items)

        def left(kind: Kind) -> tuple[Any, ...]:
            listed = enumerate(getattr(self, FIELDS[kind]))
            return tuple(value for i, value in listed if Item(kind, i) not in gone)

        routes = tuple(
            tuple(p for k, p in enumerate(route) if Item("waypoint", i, k) not in gone)
            for i, route in enumerate(self.routes)
            if Item("robot", i) not in gone
        )
        plain: tuple[Kind, ...] = ("robot", "prop", "outline", "wall", "beacon")
        kept: dict[str, Any] = {FIELDS[kind]: left(kind) for kind in plain}
        workspace = None if Item("workspace") in gone else self.workspace
        return replace(self, workspace=workspace, routes=routes, **kept)

    def copied(self, items: Collection[Item], motion: Motion) -> tuple[Self, list[Item]]:
        """Return the draft with moved copies of items, and the copies."""
        draft, copies = self, []
        for item in sorted(items):
            value: Any = draft._moved_one(item, motion)
            if item.kind == "waypoint":
                draft, new = draft.with_waypoint(item.number, value)
            else:
                adders: dict[str, Callable[[Any], tuple[Self, Item]]] = {
                    "robot": draft.with_robot, "prop": draft.with_new_prop,
                    "outline": draft.with_outline, "wall": draft.with_wall,
                    "beacon": draft.with_beacon,
                }  # fmt: skip
                draft, new = adders[item.kind](value)
            copies.append(new)
        return draft, copies

    def free_name(self, kind: str) -> str:
        """Return the first name of a kind that no body has, for example ``robot2``."""
        taken = self._names()
        return next(name for name in map(f"{kind}{{}}".format, count()) if name not in taken)

    def frame(self, sketch: Scenario | None = None) -> Frame:
        """Return the instant before the start; sketch: the scenario to draw, by default its own."""
        pose = np.array([robot.pose for robot in self.robots], dtype=float).reshape(-1, 3).T
        prop_pose = np.array([prop.pose for prop in self.props], dtype=float).reshape(-1, 3).T
        nothing = np.empty((0, 3, len(self.robots)))
        return Frame(sketch or self.sketch, 0.0, 0, pose, nothing, prop_pose=prop_pose)


@lru_cache(maxsize=8)
def _chart(own: Map | None, outlines: tuple[Outline, ...], walls: tuple[Outline, ...]) -> Map:
    """Return the map. It is cached, since checking a map takes long."""
    parts: dict[str, Any] = {"outlines": outlines, "walls": walls}
    return Map(**parts) if own is None else own.replace(**parts)


@lru_cache(maxsize=4096)
def flaw(outline: Outline, name: str = "it") -> str | None:
    """Return the fault of an obstacle's outline, in words; None if it is valid."""
    try:
        checks.outline(name, outline)
    except InputError as error:
        return str(error)
    return None


def _all(kind: type[Any] | tuple[type[Any], ...], addons: Sequence[Addon]) -> list[Any]:
    return [addon for addon in addons if isinstance(addon, kind)]


def _first(kind: type[Any], addons: Sequence[Addon]) -> Any:
    return next(iter(_all(kind, addons)), None)
