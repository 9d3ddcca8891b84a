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
from mars2d.bodies.joints.hinge import Hinge
from mars2d.bodies.props.base import Prop
from mars2d.bodies.rigid import Rigid, Triple
from mars2d.core import checks
from mars2d.core.description import snake_case
from mars2d.core.errors import InputError
from mars2d.core.plane import Outline, Point, bounds_of
from mars2d.record.frame import Frame
from mars2d.scenario.random_starts import RandomStarts
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
    outlines, walls: those of the first Map. routes: the waypoints, one list per robot. starts:
    which bodies start at random.
    """

    base: Scenario
    robots: tuple[Robot, ...]
    props: tuple[Prop, ...]
    joints: tuple[Joint, ...]
    outlines: tuple[Outline, ...]
    walls: tuple[Outline, ...]
    routes: tuple[Outline, ...]
    beacons: tuple[Beacon, ...]
    starts: tuple[RandomStarts, ...]
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
            starts=tuple(scenario.random_starts),
            workspace=scenario.workspace,
        )

    @classmethod
    def empty(cls, scenario: Scenario) -> Self:
        """Return the draft of a scenario without its robots; no scenario can be empty."""
        draft = cls.of(scenario)
        return draft.without([item for item in draft.items() if item.kind == "robot"])

    # -- as a scenario --------------------------------------------------------------------------

    def scenario(self) -> Scenario:
        """Return the scenario. Raises InputError if it is not valid."""
        return self.base.replace(
            robots=self.robots,
            props=self.props,
            joints=self.joints,
            random_starts=self.starts,
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
        sound = [outline for outline in self.outlines if not flaw(outline)]
        drawn = _unchecked(
            self.base,
            robots=self.robots,
            props=self.props,
            joints=self.joints,
            workspace=self.workspace,
            addons=tuple(self._addons(sound, addons)),
            animation=self.base.animation.replace(show_initial_pose=False),
        )
        if self.workspace is None and not (self.robots or self.props or drawn.obstacles):
            return _unchecked(drawn, workspace=BLANK)
        return drawn

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

    def value(self, item: Item) -> Any:
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
        if item.kind == "waypoint":
            return f"waypoint {item.part} of {self.robots[item.number].name}"
        if item.kind == "workspace":
            return "the workspace"
        if item.kind in ("outline", "wall"):
            return f"{'obstacle' if item.kind == 'outline' else 'wall'} {item.number}"
        value = self.value(item)
        return value.key if item.kind == "beacon" else str(value.name)

    def corners(self, item: Item) -> Outline | None:
        """Return the corners of an outline, a wall or the workspace; None for other items."""
        value: Outline = self.value(item)
        return value if item.kind in ("outline", "wall", "workspace") else None

    def pose(self, item: Item) -> Triple | None:
        """Return the pose of a robot or prop; None for other items."""
        return self.value(item).pose if item.kind in ("robot", "prop") else None

    def body(self, item: Item) -> Rigid | None:
        """Return the body of a robot or prop; None for other items."""
        return self.value(item).rigid if item.kind in ("robot", "prop") else None

    def place(self, item: Item) -> Point:
        """Return the point of an item that snaps to the grid."""
        value = self.value(item)
        if item.kind == "waypoint":
            return cast("Point", value)
        if item.kind == "beacon":
            return cast("Point", value.position)
        pose = self.pose(item)
        return (value or ((0.0, 0.0),))[0] if pose is None else pose[:2]

    def starts_at_random(self, item: Item) -> bool:
        """Return whether a robot or prop starts elsewhere in each run."""
        return any(self.name(item) in names for _, names in self._lots())

    def _lots(self) -> list[tuple[RandomStarts, Sequence[str]]]:
        """Return the random starts with the names of their bodies."""
        robots = [str(robot.name) for robot in self.robots]
        return [(each, each.bodies or robots) for each in self.starts]

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
        """Return the draft with items moved. Bodies that started at random start there now."""
        draft = self
        for item in items:
            draft = draft.with_value(item, draft._moved_one(item, motion))
        names = {self.name(item) for item in items if item.kind in ("robot", "prop")}
        return draft._fixed(names)._pinned(names)

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
        body = self.value(item)
        return body.replace(pose=motion.pose(body.pose))

    def _fixed(self, names: Collection[str]) -> Self:
        """Return the draft with bodies that no longer start at random."""
        left = [(each, [name for name in all_ if name not in names]) for each, all_ in self._lots()]
        starts = tuple(each.replace(bodies=bodies) for each, bodies in left if bodies)
        return self if self._lots() == left else replace(self, starts=starts)

    def _pinned(self, names: Collection[str]) -> Self:
        """Return the draft with the pins of hinges where those of some bodies that moved are."""
        bodies: dict[str | None, Rigid] = {part.name: part.rigid for part in self._members()}

        def pinned(joint: Joint) -> Joint:
            if not isinstance(joint, Hinge) or (joint.a in names) is (joint.b in names):
                return joint
            ends = [("a", joint.a), ("b", joint.b)]
            (end, held), (other, beside) = ends if joint.a in names else ends[::-1]
            pin = bodies[held].to_world(getattr(joint, f"anchor_{end}"))
            return joint.replace(**{f"anchor_{other}": seen_from(bodies.get(beside), pin)})

        return replace(self, joints=tuple(map(pinned, self.joints)))

    def _members(self) -> tuple[Robot | Prop, ...]:
        return (*self.robots, *self.props)

    def with_members(self, items: Collection[Item], change: Callable[[Any], Robot | Prop]) -> Self:
        """Return the draft with robots or props changed, each by a function of itself."""
        draft = self
        for item in items:
            draft = draft.with_value(item, change(draft.value(item)))
        return draft._pinned({self.name(item) for item in items})

    def renamed(self, item: Item, name: str) -> Self:
        """Return the draft with another name of a robot or prop, wherever it is mentioned."""
        old = self.name(item)
        if name in {part.name for part in self._members()} - {old}:
            raise InputError(f"{name!r} is the name of another body")

        def anew(parts: Sequence[Any]) -> tuple[Any, ...]:
            return tuple(part.renamed(old, name) for part in parts)

        draft = replace(
            self,
            base=_unchecked(self.base, addons=anew(self.base.addons)),
            robots=anew(self.robots),
            props=anew(self.props),
            joints=anew(self.joints),
            starts=anew(self.starts),
        )
        return draft.with_members([item], lambda part: part.replace(name=name))

    def joints_of(self, item: Item) -> tuple[Joint, ...]:
        """Return the joints that hold a robot or prop."""
        name = self.name(item)
        return tuple(joint for joint in self.joints if name in (joint.a, joint.b))

    def with_joint(self, joint: Joint | None, instead: Joint | None = None) -> Self:
        """Return the draft with one more joint, or with one in place of another; None: without."""
        new = () if joint is None else (joint,)
        if instead is None:
            draft = replace(self, joints=(*self.joints, *new))
            return draft._fixed({name for each in new for name in (each.a, each.b) if name})
        kept = [new if each is instead else (each,) for each in self.joints]
        return replace(self, joints=tuple(joint for some in kept for joint in some))

    def with_value(self, item: Item, value: Any) -> Self:
        """Return the draft with another robot, prop, beacon, point or outline for an item."""
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

    def added(self, kind: Kind, value: Any, robot: int = 0) -> Self:
        """Return the draft with one more item. Bodies and beacons get new names.

        robot: whose waypoint it is, at the end of its route.
        """
        if kind == "waypoint":
            route = (*self.routes[robot], value)
            return replace(self, routes=(*self.routes[:robot], route, *self.routes[robot + 1 :]))
        if kind in ("robot", "prop", "beacon"):
            value = value.replace(name=self._free_name(snake_case(type(value).__name__)))
        changes: dict[str, Any] = {FIELDS[kind]: (*getattr(self, FIELDS[kind]), value)}
        if kind == "robot":
            changes["routes"] = (*self.routes, ())
        return replace(self, **changes)

    def _free_name(self, kind: str) -> str:
        """Return the first name of a kind that nothing has, for example ``robot2``."""
        taken = {part.name for part in self._members()}
        taken |= {addon.key for addon in (*self.base.addons, *self.beacons)}
        return next(name for name in map(f"{kind}{{}}".format, count()) if name not in taken)

    def without(self, items: Collection[Item]) -> Self:
        """Return the draft without items; with a body go its route and its joints."""
        gone = set(items)
        names = {self.name(item) for item in gone if item.kind in ("robot", "prop")}

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
        joints = tuple(joint for joint in self.joints if names.isdisjoint((joint.a, joint.b)))
        draft = self._fixed(names)
        return replace(draft, workspace=workspace, routes=routes, joints=joints, **kept)

    def copied(self, items: Collection[Item], motion: Motion) -> Self:
        """Return the draft with moved copies of items, tied to each other as these are."""
        draft, names = self, dict[str | None, str | None]({None: None})
        for item in sorted(items):
            draft = draft.added(item.kind, draft._moved_one(item, motion), item.number)
            if item.kind in ("robot", "prop"):
                copies = draft.robots if item.kind == "robot" else draft.props
                names[self.name(item)] = copies[-1].name
        for joint in self.joints:
            if joint.a in names and joint.b in names:
                at = motion.point(joint.anchor_b) if joint.b is None else joint.anchor_b
                copy_ = joint.replace(a=names[joint.a], b=names[joint.b], anchor_b=at)
                draft = draft.with_joint(copy_)
        return draft

    def frame(self, sketch: Scenario | None = None) -> Frame:
        """Return the instant before the start; sketch: the scenario to draw, by default its own."""
        pose = np.array([robot.pose for robot in self.robots], dtype=float).reshape(-1, 3).T
        prop_pose = np.array([prop.pose for prop in self.props], dtype=float).reshape(-1, 3).T
        nothing = np.empty((0, 3, len(self.robots)))
        return Frame(sketch or self.sketch, 0.0, 0, pose, nothing, prop_pose=prop_pose)


def _unchecked(scenario: Scenario, **changes: Any) -> Scenario:
    """Return a copy of a scenario with other fields, which need not go together."""
    copied = copy.copy(scenario)
    copied.__dict__.update(changes)
    return copied


@lru_cache(maxsize=8)
def _chart(own: Map | None, outlines: tuple[Outline, ...], walls: tuple[Outline, ...]) -> Map:
    """Return the map. It is cached, since checking a map takes long."""
    parts: dict[str, Any] = {"outlines": outlines, "walls": walls}
    return Map(**parts) if own is None else own.replace(**parts)


@lru_cache(maxsize=4096)
def flaw(outline: Outline, name: str = "it", least: int = 2, *, closed: bool = True) -> str:
    """Return the fault of an outline, in words; "" if it is valid. The rest: see `checks`."""
    try:
        checks.outline(name, outline, least, closed=closed)
    except InputError as error:
        return str(error)
    return ""


def seen_from(body: Rigid | None, point: Point) -> Point:
    """Return where a point of the world lies in a body's frame; None: in that of the world."""
    if body is None:
        return point
    x, y, theta = body.pose
    back = Motion(-theta, (x, y), (-x, -y))
    return back.point(point)


def _all(kind: type[Any] | tuple[type[Any], ...], addons: Sequence[Addon]) -> list[Any]:
    return [addon for addon in addons if isinstance(addon, kind)]


def _first(kind: type[Any], addons: Sequence[Addon]) -> Any:
    return next(iter(_all(kind, addons)), None)
