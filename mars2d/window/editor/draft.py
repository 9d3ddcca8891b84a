"""The draft that the editor works on: a scenario that need not be valid as a whole."""

from __future__ import annotations

import copy
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import count, groupby
from typing import Any, Self, cast

import numpy as np

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
from mars2d.window.editor.item import Item, Kind, Motion
from mars2d.window.editor.verdict import Verdict, judge

FIELDS: dict[Kind, tuple[type[Any], str]] = {
    "robot": (Scenario, "robots"), "prop": (Scenario, "props"),
    "outline": (Map, "outlines"), "wall": (Map, "walls"), "waypoint": (Waypoints, "routes"),
}  # fmt: skip
"""What holds the items of a kind, the scenario or its first add-on of a class, and in which field.
Each beacon is an add-on of its own."""

BLANK: Outline = Scenario.__dataclass_fields__["workspace"].default
"""The area shown of an empty draft, metres."""


@dataclass(frozen=True)
class Draft:
    """A scenario of valid parts, which may not go together, with its items.

    base: the scenario, unchecked; it may have no robots.
    """

    base: Scenario

    @classmethod
    def empty(cls, scenario: Scenario) -> Self:
        """Return the draft of a scenario without its robots; no scenario can be empty."""
        draft = cls(scenario)
        return draft.without([item for item in draft.items() if item.kind == "robot"])

    def scenario(self) -> Scenario:
        """Return the scenario. Raises InputError if it is not valid."""
        return self.base.replace()

    @cached_property
    def sketch(self) -> Scenario:
        """The scenario for drawing, unchecked. Never simulate it."""
        shown = self.with_base(animation=self.base.animation.replace(show_initial_pose=False)).base
        if self.base.workspace is None and not (self.robots or self.props or shown.obstacles):
            return self.with_base(workspace=BLANK).base
        return shown

    @cached_property
    def bare(self) -> Self:
        """The draft without add-ons other than those that are drawn with the mouse."""
        drawn = (addon for addon in self.base.addons if isinstance(addon, (Map, Waypoints, Beacon)))
        return self.with_base(addons=tuple(drawn))

    @cached_property
    def verdict(self) -> Verdict:
        """Whether it is a valid scenario."""
        return judge(self)

    def frame(self) -> Frame:
        """Return the instant before the start."""
        pose = np.array([robot.pose for robot in self.robots], dtype=float).reshape(-1, 3).T
        prop_pose = np.array([prop.pose for prop in self.props], dtype=float).reshape(-1, 3).T
        nothing = np.empty((0, 3, len(self.robots)))
        return Frame(self.sketch, 0.0, 0, pose, nothing, prop_pose=prop_pose)

    # -- its items ------------------------------------------------------------------------------

    @property
    def robots(self) -> tuple[Robot, ...]:
        """The robots."""
        return tuple(self.base.robots)

    @property
    def props(self) -> tuple[Prop, ...]:
        """The props."""
        return tuple(self.base.props)

    def listed(self, kind: Kind) -> tuple[Any, ...]:
        """Return the items of a kind; of waypoints the routes, one per robot."""
        if kind == "beacon":
            return tuple(addon for addon in self.base.addons if isinstance(addon, Beacon))
        if kind == "workspace":
            return () if self.base.workspace is None else (self.base.workspace,)
        owner, field = self._owner(kind), FIELDS[kind][1]
        found = () if owner is None else tuple(getattr(owner, field))
        if kind == "waypoint":
            robots = len(self.robots)
            return (*found[:robots], *[()] * (robots - len(found)))
        return found

    def _owner(self, kind: Kind) -> Any:
        """Return what holds the items of a kind, None if there is none yet."""
        parts = (self.base, *self.base.addons)
        return next((part for part in parts if isinstance(part, FIELDS[kind][0])), None)

    def items(self) -> tuple[Item, ...]:
        """Return all items but the workspace, the lowest first."""
        plain: tuple[Kind, ...] = ("outline", "wall", "prop", "robot", "beacon")
        found = [Item(kind, i) for kind in plain for i in range(len(self.listed(kind)))]
        routes = enumerate(self.listed("waypoint"))
        ways = [Item("waypoint", i, k) for i, route in routes for k in range(len(route))]
        return (*found, *ways)

    def new_since(self, before: Draft) -> list[Item]:
        """Return the items that an earlier draft did not have as they are now."""
        known = Counter(map(before._key, before.items()))
        new = []
        for item in self.items():
            key = self._key(item)
            if known[key]:
                known[key] -= 1
            else:
                new.append(item)
        return new

    def _key(self, item: Item) -> tuple[object, ...]:
        """Return what tells an item from others of its kind, or from those on other routes."""
        value = self.value(item)
        owner = item.number if item.kind == "waypoint" else None
        return item.kind, owner, value if isinstance(value, tuple) else id(value)

    def value(self, item: Item) -> Any:
        """Return what an item is: a robot, a prop, corners, a beacon, or a waypoint's point."""
        value = self.listed(item.kind)[item.number]
        return value[item.part] if item.kind == "waypoint" else value

    def holds(self, item: Item) -> bool:
        """Return whether an item exists."""
        listed = self.listed(item.kind)
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
        return [(each, each.bodies or robots) for each in self.base.random_starts]

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

    def with_base(self, **changes: Any) -> Self:
        """Return the draft with other fields of the scenario, which are not checked."""
        base = copy.copy(self.base)
        base.__dict__.update(changes)
        return type(self)(base)

    def with_list(self, kind: Kind, listed: Sequence[Any]) -> Self:
        """Return the draft with other items of a kind. Raises InputError for invalid outlines."""
        addons = list(self.base.addons)
        if kind in ("outline", "wall", "workspace"):
            known = set(map(id, self.listed(kind)))
            listed = [
                corners
                if id(corners) in known
                else _checked(self.name(Item(kind, i)), kind, corners)
                for i, corners in enumerate(listed)
            ]
        if kind == "workspace":
            return self.with_base(workspace=listed[0] if listed else None)
        if kind == "beacon":
            first = next((k for k, each in enumerate(addons) if isinstance(each, Beacon)), None)
            others = [addon for addon in addons if not isinstance(addon, Beacon)]
            first = len(others) if first is None else first
            return self.with_base(addons=(*others[:first], *listed, *others[first:]))
        owner, (make, field) = self._owner(kind), FIELDS[kind]
        if owner is self.base:
            return self.with_base(**{field: tuple(listed)})
        if kind == "waypoint":
            listed = [tuple(route) for route in listed]
            while listed and not listed[-1]:
                listed.pop()
        fields = {name: () for kind_, name in FIELDS.values() if kind_ is make}
        fields |= {name: getattr(owner, name) for name in fields if owner is not None}
        fields |= {field: tuple(listed)}
        new = []
        if any(fields.values()):  # without items, the add-on goes
            new = [make(**fields) if owner is None else owner.replace(**fields)]
        place = len(addons) if owner is None else addons.index(owner)
        return self.with_base(addons=(*addons[:place], *new, *addons[place + 1 :]))

    def with_values(self, values: Mapping[Item, Any]) -> Self:
        """Return the draft with other robots, props, beacons, points or outlines for items."""
        draft = self
        for kind in dict.fromkeys(item.kind for item in values):
            listed = list(self.listed(kind))
            for item in (item for item in values if item.kind == kind):
                if kind == "waypoint":
                    route = list(listed[item.number])
                    route[item.part] = values[item]
                    listed[item.number] = tuple(route)
                else:
                    listed[item.number] = values[item]
            draft = draft.with_list(kind, listed)
        return draft

    def with_corner(self, item: Item, number: int, *new: Point) -> Self:
        """Return the draft with any number of corners in place of one of an outline."""
        corners = self.corners(item) or ()
        return self.with_values({item: (*corners[:number], *new, *corners[number + 1 :])})

    def moved(self, items: Collection[Item], motion: Motion) -> Self:
        """Return the draft with items moved. Bodies that started at random start there now."""
        draft = self.with_values({item: self._moved_one(item, motion) for item in items})
        names = {self.name(item) for item in items if item.kind in ("robot", "prop")}
        return draft._fixed(names)._pinned(names)

    def _moved_one(self, item: Item, motion: Motion) -> object:
        if item.kind == "waypoint":
            return motion.point(self.place(item))
        if item.kind == "beacon":
            beacon = self.value(item)
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
        return self if self._lots() == left else self.with_base(random_starts=starts)

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

        return self.with_base(joints=tuple(map(pinned, self.base.joints)))

    def _members(self) -> tuple[Robot | Prop, ...]:
        return (*self.robots, *self.props)

    def with_members(self, items: Collection[Item], change: Callable[[Any], Robot | Prop]) -> Self:
        """Return the draft with robots or props changed, each by a function of itself.

        A new name is put wherever the old one is mentioned.
        """
        values = {item: change(self.value(item)) for item in items}
        draft = self
        for item, part in values.items():
            old, new = self.name(item), (part.name or "").strip()
            if new == old:
                continue
            if not new or new in {other.name for other in draft._members()}:
                raise InputError(
                    f"{new!r} is the name of another body" if new else "expected a name"
                )
            values[item] = part.replace(name=new)
            draft = draft.with_base(**draft.base.mentions(old, new))
        draft = draft.with_values(values)
        return draft._pinned({draft.name(item) for item in items})

    def with_joint(self, joint: Joint | None, instead: Joint | None = None) -> Self:
        """Return the draft with one more joint, or with one in place of another; None: without."""
        new = () if joint is None else (joint,)
        if instead is None:
            draft = self.with_base(joints=(*self.base.joints, *new))
            return draft._fixed({name for each in new for name in (each.a, each.b) if name})
        kept = [new if each is instead else (each,) for each in self.base.joints]
        return self.with_base(joints=tuple(joint for some in kept for joint in some))

    def added(self, kind: Kind, *values: Any, robot: int = 0) -> Self:
        """Return the draft with more items of a kind. Bodies and beacons get new names.

        robot: whose waypoints they are, at the end of its route.
        """
        listed = list(self.listed(kind))
        taken = {part.name for part in self._members()} | {a.key for a in self.base.addons}
        for value in values:
            if kind == "waypoint":
                listed[robot] = (*listed[robot], value)
            elif kind in ("robot", "prop", "beacon"):
                names = map(f"{snake_case(type(value).__name__)}{{}}".format, count())
                name = next(name for name in names if name not in taken)
                taken.add(name)
                listed.append(value.replace(name=name))
            else:
                listed.append(value)
        return self.with_list(kind, listed)

    def without(self, items: Collection[Item]) -> Self:
        """Return the draft without items; with a body go its route and its joints."""
        gone = set(items)
        names = {self.name(item) for item in gone if item.kind in ("robot", "prop")}
        routes = [
            [point for k, point in enumerate(route) if Item("waypoint", i, k) not in gone]
            for i, route in enumerate(self.listed("waypoint"))
            if Item("robot", i) not in gone
        ]
        joints = tuple(joint for joint in self.base.joints if names.isdisjoint((joint.a, joint.b)))
        draft = self._fixed(names).with_base(joints=joints)
        plain: tuple[Kind, ...] = ("robot", "prop", "outline", "wall", "beacon", "workspace")
        for kind in plain:
            listed = self.listed(kind)
            left = [value for i, value in enumerate(listed) if Item(kind, i) not in gone]
            if len(left) < len(listed):
                draft = draft.with_list(kind, left)
        return draft.with_list("waypoint", routes)

    def copied(self, items: Collection[Item], motion: Motion) -> Self:
        """Return the draft with moved copies of items, tied to each other as these are."""
        draft, names = self, dict[str | None, str | None]({None: None})

        def family(item: Item) -> tuple[Kind, int]:
            return item.kind, item.number * (item.kind == "waypoint")

        for (kind, robot), group in groupby(sorted(items), family):
            models = [*group]
            moved = (self._moved_one(item, motion) for item in models)
            draft = draft.added(kind, *moved, robot=robot)
            if kind in ("robot", "prop"):
                copies = draft.listed(kind)[-len(models) :]
                names |= {self.name(m): new.name for m, new in zip(models, copies, strict=True)}
        for joint in self.base.joints:
            if joint.a in names and joint.b in names:
                at = motion.point(joint.anchor_b) if joint.b is None else joint.anchor_b
                copy_ = joint.replace(a=names[joint.a], b=names[joint.b], anchor_b=at)
                draft = draft.with_joint(copy_)
        return draft


def seen_from(body: Rigid | None, point: Point) -> Point:
    """Return where a point of the world lies in a body's frame; None: in that of the world."""
    if body is None:
        return point
    x, y, theta = body.pose
    back = Motion(-theta, (x, y), (-x, -y))
    return back.point(point)


def _checked(name: str, kind: Kind, corners: Any) -> Outline:
    """Return the corners of an outline, a wall or the workspace; InputError if it is none."""
    least = 3 if kind == "workspace" else 2
    return checks.outline(name, corners, least, closed=kind != "wall")
