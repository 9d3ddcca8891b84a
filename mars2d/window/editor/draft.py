"""The draft that the editor works on: a scenario that need not be valid as a whole."""

from __future__ import annotations

import copy
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import count
from typing import Any, Self, cast

import numpy as np
import shapely

from mars2d.addons.beacon import Beacon
from mars2d.addons.map import Map
from mars2d.addons.waypoints import Waypoints
from mars2d.bodies.joints.base import Joint
from mars2d.bodies.joints.hinge import Hinge
from mars2d.bodies.props.base import Prop
from mars2d.bodies.rigid import Rigid
from mars2d.core import checks
from mars2d.core.description import snake_case
from mars2d.core.errors import InputError
from mars2d.core.plane import Outline, Point
from mars2d.record.frame import Frame
from mars2d.scenario.random_starts import RandomStarts
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.window.editor.item import Item, Kind, Motion
from mars2d.window.editor.verdict import Verdict, judge

CORNERED: tuple[Kind, ...] = ("workspace", "outline", "wall")
"""The kinds of items that are corners."""
BODIES: tuple[Kind, ...] = ("robot", "prop")

BLANK: Outline = Scenario.__dataclass_fields__["workspace"].default
"""The area shown of an empty draft, metres."""


@dataclass(frozen=True)
class Draft:
    """A scenario of valid parts, which may not go together, with its items.

    base: the scenario, unchecked; it may have no robots.
    """

    base: Scenario

    def scenario(self) -> Scenario:
        """Return the scenario. Raises InputError if it is not valid."""
        return self.base.replace()

    @cached_property
    def sketch(self) -> Scenario:
        """The scenario for drawing, unchecked. Never simulate it."""
        shown = self.with_base(animation=self.base.animation.replace(show_initial_pose=False)).base
        if self.base.workspace is None and not (
            self.base.robots or self.base.props or shown.obstacles
        ):
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
        pose = np.array([robot.pose for robot in self.base.robots], dtype=float).reshape(-1, 3).T
        prop_pose = np.array([prop.pose for prop in self.base.props], dtype=float).reshape(-1, 3).T
        nothing = np.empty((0, 3, len(self.base.robots)))
        return Frame(self.sketch, 0.0, 0, pose, nothing, prop_pose=prop_pose)

    # -- its items ------------------------------------------------------------------------------

    @cached_property
    def listed(self) -> dict[Kind, tuple[Any, ...]]:
        """What there is of each kind, the lowest first; of waypoints the routes, one per robot."""
        base = self.base
        chart, ways = (_first(kind, base.addons) for kind in (Map, Waypoints))
        routes = tuple(getattr(ways, "routes", ()))[: len(base.robots)]
        return {
            "workspace": () if base.workspace is None else (base.workspace,),
            "outline": tuple(getattr(chart, "outlines", ())),
            "wall": tuple(getattr(chart, "walls", ())),
            "prop": tuple(base.props),
            "robot": tuple(base.robots),
            "beacon": tuple(addon for addon in base.addons if isinstance(addon, Beacon)),
            "waypoint": (*routes, *[()] * (len(base.robots) - len(routes))),
            "joint": tuple(base.joints),
        }

    @cached_property
    def things(self) -> dict[Item, Any]:
        """All items, the lowest first, and what each is: a body, corners, a beacon, a point, ..."""
        routes = enumerate(self.listed["waypoint"])
        plain = {
            Item(kind, i): value
            for kind, values in self.listed.items()
            for i, value in enumerate(values)
            if kind != "waypoint"
        }
        return plain | {Item("waypoint", i, k): p for i, way in routes for k, p in enumerate(way)}

    def items(self) -> tuple[Item, ...]:
        """Return all items but the workspace and joints, the lowest first."""
        return tuple(item for item in self.things if item.kind not in ("workspace", "joint"))

    def new_since(self, before: Draft) -> list[Item]:
        """Return the items that an earlier draft did not have as they are now."""
        now, then = (Counter(map(draft._key, draft.items())) for draft in (self, before))
        new = now - then
        return [item for item in self.items() if self._key(item) in new]

    def _key(self, item: Item) -> tuple[object, ...]:
        """Return what tells an item from others of its kind, or from those on other routes."""
        value, owner = self.things[item], item.number if item.kind == "waypoint" else None
        return item.kind, owner, value if isinstance(value, tuple) else id(value)

    def name(self, item: Item) -> str:
        """Return an item's name in words."""
        if item.kind == "waypoint":
            return f"waypoint {item.part} of {self.base.robots[item.number].name}"
        words = {"workspace": "the workspace", "outline": f"obstacle {item.number}"}
        if item.kind in CORNERED:
            return words.get(item.kind, f"wall {item.number}")
        value = self.things[item]
        return value.key if item.kind == "beacon" else str(value.name)

    def names(self, items: Collection[Item]) -> set[str]:
        """Return the names of the bodies among items."""
        return {self.name(item) for item in items if item.kind in BODIES}

    def corners(self, item: Item) -> Outline:
        """Return the corners of an outline, a wall or the workspace; () of other items."""
        return self.things[item] if item.kind in CORNERED else ()

    def body(self, item: Item) -> Rigid | None:
        """Return the body of a robot or prop; None for other items."""
        return self.things[item].rigid if item.kind in BODIES else None

    def place(self, item: Item) -> Point:
        """Return the point of an item that snaps to the grid."""
        value = self.things[item]
        if item.kind in BODIES:
            return cast("Point", value.pose[:2])
        value = value.position if item.kind == "beacon" else value
        return cast("Point", value[0] if item.kind in CORNERED else value)

    def rims(self, item: Item) -> list[tuple[Outline, float]]:
        """Return what an item looks like: outlines, lines, or points with a radius, metres."""
        body = self.body(item)
        if body is None:
            return [(self.corners(item) or (self.place(item),), 0.0)]
        return [(tuple(map(body.to_world, rim.points)), rim.radius) for rim in body.shape.rims]

    def is_line(self, item: Item) -> bool:
        """Return whether an item is a line, with nothing inside."""
        return item.kind == "wall" or len(self.corners(item)) == 2

    @cached_property
    def shapes(self) -> dict[Item, Any]:
        """Where the items lie, as geometries of shapely [m], the lowest first."""
        return {item: self.shape(item) for item in self.items()}

    def shape(self, item: Item) -> Any:
        """Return where an item lies, as a geometry of shapely [m]."""
        line = shapely.LineString if self.is_line(item) else shapely.Polygon
        return shapely.GeometryCollection([
            line(points) if points[1:] else shapely.Point(points).buffer(radius)
            if radius else shapely.Point(points)
            for points, radius in self.rims(item)
        ])  # fmt: skip

    def starts_at_random(self, item: Item) -> bool:
        """Return whether a robot or prop starts elsewhere in each run."""
        return any(self.name(item) in names for _, names in self._lots())

    def _lots(self) -> list[tuple[RandomStarts, Sequence[str]]]:
        """Return the random starts with the names of their bodies."""
        robots = [str(robot.name) for robot in self.base.robots]
        return [(each, each.bodies or robots) for each in self.base.random_starts]

    # -- changes --------------------------------------------------------------------------------

    def with_base(self, **changes: Any) -> Self:
        """Return the draft with other fields of the scenario, which are not checked."""
        base = copy.copy(self.base)
        base.__dict__.update(changes)
        return type(self)(base)

    def changed(self, values: Mapping[Item, Any]) -> Self:
        """Return the draft with other values of items, and with new ones; None takes an item out.

        With a robot goes its route. Raises InputError for outlines that are none.
        """
        left = {item: v for item, v in {**self.things, **values}.items() if v is not None}
        found: dict[str, list[Any]] = {kind: [] for kind in self.listed}
        routes: dict[int, list[Point]] = {i.number: [] for i in left if i.kind == "robot"}
        for item, value in left.items():
            if item.kind == "waypoint":
                routes.get(item.number, []).append(value)
            elif item.kind in CORNERED and item in values:
                found[item.kind].append(_checked(self.name(item), item, value))
            else:
                found[item.kind].append(value)
        ways = [tuple(route) for route in routes.values()]
        while ways and not ways[-1]:
            ways.pop()
        addons = _with_fields(self.base.addons, Waypoints, routes=ways)
        addons = _with_fields(addons, Map, outlines=found["outline"], walls=found["wall"])
        if tuple(found["beacon"]) != self.listed["beacon"]:
            first = next((k for k, each in enumerate(addons) if isinstance(each, Beacon)), None)
            others = [addon for addon in addons if not isinstance(addon, Beacon)]
            addons = [*others[:first], *found["beacon"], *others[len(others[:first]) :]]
        (workspace, *_) = (*found["workspace"], None)
        bodies = {name: tuple(found[name[:-1]]) for name in ("robots", "props", "joints")}
        return self.with_base(workspace=workspace, addons=tuple(addons), **bodies)

    def with_corner(self, item: Item, number: int, *new: Point) -> Self:
        """Return the draft with any number of corners in place of one of an outline."""
        corners = self.corners(item)
        return self.changed({item: (*corners[:number], *new, *corners[number + 1 :])})

    def moved(self, items: Collection[Item], motion: Motion) -> Self:
        """Return the draft with items moved. Bodies that started at random start there now."""
        names = self.names(items)
        return self.changed(self._moved(items, motion))._fixed(names)._pinned(names)

    def _moved(self, items: Collection[Item], motion: Motion) -> dict[Item, Any]:
        """Return what items are once they are moved."""
        values = {}
        for item in items:
            value, corners = self.things[item], self.corners(item)
            if item.kind in BODIES:
                values[item] = value.replace(pose=motion.pose(value.pose))
            elif item.kind == "beacon" and value.path is not None:
                values[item] = value.replace(path=[motion.point(point) for point in value.path])
            elif item.kind == "beacon":
                values[item] = value.replace(at=motion.point(value.position))
            else:
                values[item] = tuple(map(motion.point, corners)) or motion.point(value)
        return values

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
        return (*self.base.robots, *self.base.props)

    def with_members(self, items: Collection[Item], change: Callable[[Any], Robot | Prop]) -> Self:
        """Return the draft with robots or props changed, each by a function of itself.

        A new name is put wherever the old one is mentioned.
        """
        values = {item: change(self.things[item]) for item in items}
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
        draft = draft.changed(values)
        return draft._pinned(draft.names(items))

    def added(self, models: Mapping[Item, Any]) -> Self:
        """Return the draft with one more item for each, of its kind, a waypoint on its route.

        Bodies and beacons get new names. Bodies that are tied no longer start at random.
        """
        taken = {part.name for part in self._members()} | {a.key for a in self.base.addons}
        new: dict[Item, Any] = {}
        for item, value in models.items():
            if item.kind in (*BODIES, "beacon"):
                names = map(f"{snake_case(type(value).__name__)}{{}}".format, count())
                name = next(name for name in names if name not in taken)
                taken.add(name)
                value = value.replace(name=name)  # noqa: PLW2901
            if item.kind == "waypoint":
                place = item._replace(part=len(self.things) + len(new))
            else:
                place = Item(item.kind, len(self.listed[item.kind]) + len(new))
            new[place] = value
        joints = (value for value in new.values() if isinstance(value, Joint))
        ends = [name for joint in joints for name in (joint.a, joint.b) if name]
        return self.changed(new)._fixed(ends)

    def without(self, items: Collection[Item]) -> Self:
        """Return the draft without items; with a body go its route and its joints."""
        names, joints = self.names(items), enumerate(self.base.joints)
        untied = [Item("joint", k) for k, j in joints if not names.isdisjoint((j.a, j.b))]
        return self._fixed(names).changed(dict.fromkeys([*items, *untied]))

    def copied(self, items: Collection[Item], motion: Motion) -> Self:
        """Return the draft with moved copies of items, tied to each other as these are."""
        items = sorted(items)
        draft, names = self.added(self._moved(items, motion)), dict[str | None, str | None]()
        for kind in BODIES:
            models = [self.name(item) for item in items if item.kind == kind]
            copies = [part.name for part in draft.listed[kind][len(self.listed[kind]) :]]
            names |= dict(zip(models, copies, strict=True))
        names[None], joints = None, {}
        for k, joint in enumerate(self.base.joints):
            if joint.a in names and joint.b in names:
                at = motion.point(joint.anchor_b) if joint.b is None else joint.anchor_b
                ends = {"a": names[joint.a], "b": names[joint.b], "anchor_b": at}
                joints[Item("joint", k)] = joint.replace(**ends)
        return draft.added(joints)


def seen_from(body: Rigid | None, point: Point) -> Point:
    """Return where a point of the world lies in a body's frame; None: in that of the world."""
    if body is None:
        return point
    x, y, theta = body.pose
    back = Motion(-theta, (x, y), (-x, -y))
    return back.point(point)


def _first(kind: type[Any], addons: Sequence[Any]) -> Any:
    """Return the first add-on of a class, None if there is none."""
    return next((addon for addon in addons if isinstance(addon, kind)), None)


def _with_fields(addons: Sequence[Any], kind: type[Any], **fields: list[Any]) -> list[Any]:
    """Return add-ons, the first of a class with other items in its fields; without any, it goes."""
    owner = _first(kind, addons)
    if all(items == [*getattr(owner, name, ())] for name, items in fields.items()):
        return [*addons]
    new = []
    if any(fields.values()):
        new = [kind(**fields) if owner is None else owner.replace(**fields)]
    place = len(addons) if owner is None else addons.index(owner)
    return [*addons[:place], *new, *addons[place + 1 :]]


def _checked(name: str, item: Item, corners: Any) -> Outline:
    """Return the corners of an item; InputError if it is none."""
    least = 3 if item.kind == "workspace" else 2
    return checks.outline(name, corners, least, closed=item.kind != "wall")
