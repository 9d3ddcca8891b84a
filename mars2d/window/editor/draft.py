"""The draft that the editor works on: a scenario that need not be valid as a whole."""

from __future__ import annotations

import copy
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import count, islice, pairwise
from math import atan2, cos, sin
from typing import Any, Literal, NamedTuple, Self, cast

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
from mars2d.core.errors import InputError, Mars2dError, counted
from mars2d.core.plane import Outline, Point
from mars2d.record.frame import Frame
from mars2d.scenario import starts
from mars2d.scenario.random_starts import RandomStarts
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.window.panels.readout import in_both_units
from mars2d.window.widgets.rows import minus

Kind = Literal["robot", "prop", "outline", "wall", "route", "beacon", "workspace", "joint"]
LEAST: Mapping[Kind, int] = {"workspace": 3, "outline": 2, "wall": 2, "route": 1}
"""The kinds of items that are corners, and how many these are at least."""
BODIES: tuple[Kind, ...] = ("robot", "prop")
MAX_FAULTS = 50
"""The search stops after this many faults."""

BLANK: Outline = Scenario.__dataclass_fields__["workspace"].default
"""The area shown of an empty draft, metres."""


class Item(NamedTuple):
    """An item of a draft.

    number: its index among the items of its kind; of a route, that of its robot.
    """

    kind: Kind
    number: int = 0


class Motion(NamedTuple):
    """A turn by `angle` [rad] about the point `about`, then a shift by `by` [m]."""

    angle: float = 0.0
    about: Point = (0.0, 0.0)
    by: Point = (0.0, 0.0)

    def point(self, point: Point) -> Point:
        """Return a point after the motion."""
        if not self.angle:
            return tidy(point[0] + self.by[0]), tidy(point[1] + self.by[1])
        (x, y), c, s = self.about, cos(self.angle), sin(self.angle)
        dx, dy = point[0] - x, point[1] - y
        return tidy(x + c * dx - s * dy + self.by[0]), tidy(y + s * dx + c * dy + self.by[1])

    def pose(self, pose: tuple[float, float, float]) -> tuple[float, float, float]:
        """Return a pose after the motion, its heading in (-pi, pi] if it turns."""
        heading = pose[2]
        if self.angle:
            turned = heading + self.angle
            heading = tidy(atan2(sin(turned), cos(turned)))
        return (*self.point(pose[:2]), heading)


class Verdict(NamedTuple):
    """The scenario of a draft, None if it is not valid; what is wrong, and all items concerned."""

    scenario: Scenario | None
    text: str = ""
    culprits: frozenset[Item] = frozenset()


@dataclass(frozen=True)
class Draft:
    """A scenario of valid parts, which may not go together, with its items.

    base: the scenario, unchecked; it may have no robots.
    """

    base: Scenario

    @cached_property
    def sketch(self) -> Scenario:
        """The scenario for drawing, unchecked. Never simulate it."""
        shown = self.with_base(animation=self.base.animation.replace(show_initial_pose=False)).base
        if self.base.workspace is None and not (
            self.base.robots or self.base.props or shown.obstacles
        ):
            return self.with_base(workspace=BLANK).base
        return shown

    def frame(self) -> Frame:
        """Return the instant before the start."""
        pose, prop_pose = (
            np.array([part.pose for part in parts], dtype=float).reshape(-1, 3).T
            for parts in (self.base.robots, self.base.props)
        )
        nothing = np.empty((0, 3, len(self.base.robots)))
        return Frame(self.sketch, 0.0, 0, pose, nothing, prop_pose=prop_pose)

    # -- its items ------------------------------------------------------------------------------

    @cached_property
    def listed(self) -> dict[Kind, tuple[Any, ...]]:
        """What there is of each kind, the lowest first; of routes one per robot."""
        base = self.base
        chart, ways = (_first(kind, base.addons) for kind in (Map, Waypoints))
        return {
            "workspace": () if base.workspace is None else (base.workspace,),
            "outline": tuple(getattr(chart, "outlines", ())),
            "wall": tuple(getattr(chart, "walls", ())),
            "prop": tuple(base.props),
            "robot": tuple(base.robots),
            "beacon": tuple(addon for addon in base.addons if isinstance(addon, Beacon)),
            "route": tuple(getattr(ways, "routes", ()))[: len(base.robots)],
            "joint": tuple(base.joints),
        }

    @cached_property
    def things(self) -> dict[Item, Any]:
        """All items, the lowest first, and what each is: a body, corners, a beacon, a joint."""
        listed = (
            (kind, i, v) for kind, values in self.listed.items() for i, v in enumerate(values)
        )
        return {Item(kind, i): value for kind, i, value in listed if value != ()}

    def items(self) -> tuple[Item, ...]:
        """Return all items but the workspace and joints, the lowest first."""
        return tuple(item for item in self.things if item.kind not in ("workspace", "joint"))

    def new_since(self, before: Draft) -> list[Item]:
        """Return the items that an earlier draft did not have as they are now."""
        now, then = (
            {i: (i.kind, v if isinstance(v, tuple) else id(v)) for i, v in draft.things.items()}
            for draft in (self, before)
        )
        new = Counter(now.values()) - Counter(then.values())
        return [item for item in self.items() if now[item] in new]

    def name(self, item: Item) -> str:
        """Return an item's name in words."""
        words = {"workspace": "the workspace", "outline": f"obstacle {item.number}"}
        if item.kind == "route":
            return f"the route of {self.base.robots[item.number].name}"
        if item.kind in LEAST:
            return words.get(item.kind, f"wall {item.number}")
        value = self.things[item]
        return value.key if item.kind == "beacon" else str(value.name)

    def names(self, items: Collection[Item]) -> set[str]:
        """Return the names of the bodies among items."""
        return {self.name(item) for item in items if item.kind in BODIES}

    def corners(self, item: Item) -> Outline:
        """Return the corners of an outline, a line or the workspace; () of other items."""
        return self.things[item] if item.kind in LEAST else ()

    def body(self, item: Item) -> Rigid | None:
        """Return the body of a robot or prop; None for other items."""
        return self.things[item].rigid if item.kind in BODIES else None

    def place(self, item: Item) -> Point:
        """Return the point of an item that snaps to the grid."""
        value = self.things[item]
        if item.kind in BODIES:
            return cast("Point", value.pose[:2])
        return cast("Point", value.position if item.kind == "beacon" else value[0])

    def rims(self, item: Item) -> list[tuple[Outline, float]]:
        """Return what an item looks like: outlines, lines, or points with a radius, metres."""
        body = self.body(item)
        if body is None:
            return [(self.corners(item) or (self.place(item),), 0.0)]
        return [(tuple(map(body.to_world, rim.points)), rim.radius) for rim in body.shape.rims]

    def is_line(self, item: Item) -> bool:
        """Return whether an item is a line, with nothing inside."""
        return item.kind in ("wall", "route") or len(self.corners(item)) == 2

    @cached_property
    def shapes(self) -> dict[Item, Any]:
        """Where the items lie, as geometries of shapely [m], the lowest first."""
        return {item: self.shape(item) for item in self.items()}

    def shape(self, item: Item) -> Any:
        """Return where an item lies, as a geometry of shapely [m]."""
        body, points = self.body(item), self.corners(item)
        if body is not None:
            return starts.footprint(body)
        if len(points) < 2:
            return shapely.Point(self.place(item))
        return (shapely.LineString if self.is_line(item) else shapely.Polygon)(points)

    def described(self, item: Item) -> list[str]:
        """Return lines about an item: name, position, heading, size."""
        (x, y), corners, body = self.place(item), self.corners(item), self.body(item)
        lines, shape = [self.name(item)], self.shape(item)
        lines.append(counted(len(corners), "corner") if corners else f"at {x:.4g}, {y:.4g} m")
        xmin, ymin, xmax, ymax = shape.bounds
        sides = (xmax - xmin, ymax - ymin) if corners else None
        if body is not None:
            sides = getattr(self.things[item], "side_lengths", None)
            lines.append(f"θ {in_both_units(body.pose[2])}")
            if self.starts_at_random(item):
                lines[1:] = ["starts at random, until it is moved"]
            elif item.kind == "prop" and body.is_disc:
                lines.append(f"diameter {2 * body.bound[1]:.4g} m")
        if self.is_line(item):
            lines.append(f"{shape.length:.4g} m long")
        elif sides is not None:
            lines.append(f"{sides[0]:.4g} m x {sides[1]:.4g} m")
        return [minus(line) for line in lines]

    def starts_at_random(self, item: Item) -> bool:
        """Return whether a robot or prop starts elsewhere in each run."""
        return any(self.name(item) in names for _, names in self._lots())

    def _lots(self) -> list[tuple[RandomStarts, Sequence[str]]]:
        """Return the random starts with the names of their bodies."""
        robots = [str(robot.name) for robot in self.base.robots]
        return [(each, each.bodies or robots) for each in self.base.random_starts]

    def _members(self) -> tuple[Robot | Prop, ...]:
        return (*self.base.robots, *self.base.props)

    # -- what is wrong --------------------------------------------------------------------------

    @cached_property
    def verdict(self) -> Verdict:
        """Whether it is a valid scenario, which the Scenario itself decides."""
        if not self.base.robots:
            return Verdict(None, "there is no robot yet: choose Robot (R) and click")
        try:
            return Verdict(self.base.replace())
        except Mars2dError as error:
            text = str(error)
        faults = list(islice(self._misplaced(), MAX_FAULTS))
        if faults:
            more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
            text = f"{faults[0][0]}{more}"
        return Verdict(None, text, frozenset(item for _, items in faults for item in items))

    def _misplaced(self) -> Iterator[tuple[str, tuple[Item, Item]]]:
        """Find bodies that can't start where they are: why, and the items that it concerns."""
        bodies = [item for kind in BODIES for item in self.things if item.kind == kind]
        mine = {outline: Item("outline", i) for i, outline in enumerate(self.listed["outline"])}
        for i, wall in enumerate(self.listed["wall"]):
            mine |= dict.fromkeys(pairwise(wall), Item("wall", i))
        for found in starts.faults(self.sketch, self.sketch.bodies):
            item = bodies[found.body]
            name, other = self.name(item), item
            if found.kind == "overlap":
                other = bodies[found.other]
                text = f"{name} and {self.name(other)} overlap by {found.depth:.2g} m"
            elif found.kind == "obstacle":
                other = mine.get(self.sketch.obstacles[found.other], item)  # or another add-on's
                what = "an obstacle" if other is item else self.name(other)
                inside = f"starts inside {what}; if it is a room, draw it as walls"
                text = f"{name} {inside if found.inside else f'starts in contact with {what}'}"
            else:
                where = "outside" if found.kind == "outside" else "in the wall round"
                text = f"{name} starts {where} the workspace"
            yield text, (item, other)

    # -- changes --------------------------------------------------------------------------------

    def with_base(self, **changes: Any) -> Self:
        """Return the draft with other fields of the scenario, which are not checked."""
        base = copy.copy(self.base)
        base.__dict__.update(changes)
        return type(self)(base)

    def changed(self, values: Mapping[Item, Any]) -> Self:
        """Return the draft with other values of items, and with new ones; None takes an item out.

        With a robot goes its route, with a body its joints. Bodies that are moved, or tied by a new
        joint, no longer start at random; the pins of their hinges go with them. Raises InputError
        for outlines that are none.
        """
        left = {item: v for item, v in {**self.things, **values}.items() if v is not None}
        found: dict[str, list[Any]] = {kind: [] for kind in self.listed}
        for item, value in left.items():
            if item in values and item.kind in LEAST and item.kind != "route":
                closed = item.kind != "wall"
                value = checks.outline(self.name(item), value, LEAST[item.kind], closed=closed)  # noqa: PLW2901
            found[item.kind].append(value)
        bodies = {part.name: part.rigid for kind in BODIES for part in found[kind]}
        gone = self.names([item for item in self.things if item not in left])
        moved = {
            left[item].name
            for item in values.keys() & self.things.keys() & left.keys()
            if item.kind in BODIES and left[item].pose != self.things[item].pose
        }
        new_joints = [
            v for item, v in left.items() if isinstance(v, Joint) and item not in self.things
        ]
        fixed = {*gone, *moved, *(end for joint in new_joints for end in (joint.a, joint.b))}
        random = tuple(
            each
            if fixed.isdisjoint(names)
            else each.replace(bodies=[*filter(lambda n: n not in fixed, names)])
            for each, names in self._lots()
            if not fixed.issuperset(names)
        )
        joints = [_pinned(j, moved, bodies) for j in found["joint"] if gone.isdisjoint((j.a, j.b))]
        ways = [left.get(Item("route", item.number), ()) for item in left if item.kind == "robot"]
        while ways and not ways[-1]:
            ways.pop()
        addons = _with_fields(self.base.addons, Waypoints, routes=ways)
        addons = _with_fields(addons, Map, outlines=found["outline"], walls=found["wall"])
        if tuple(found["beacon"]) != self.listed["beacon"]:
            first = next((k for k, each in enumerate(addons) if isinstance(each, Beacon)), None)
            others = [addon for addon in addons if not isinstance(addon, Beacon)]
            addons = [*others[:first], *found["beacon"], *others[len(others[:first]) :]]
        return self.with_base(
            workspace=next(iter(found["workspace"]), None),
            robots=tuple(found["robot"]),
            props=tuple(found["prop"]),
            joints=tuple(joints),
            addons=tuple(addons),
            random_starts=random,
        )

    def with_corner(self, item: Item, number: int, *new: Point) -> Self:
        """Return the draft with any number of corners in place of one of an outline."""
        corners = self.corners(item)
        return self.changed({item: (*corners[:number], *new, *corners[number + 1 :])})

    def moved(self, items: Collection[Item], motion: Motion) -> Self:
        """Return the draft with items moved."""
        return self.changed(self._moved(items, motion))

    def _moved(self, items: Collection[Item], motion: Motion) -> dict[Item, Any]:
        """Return what items are once they are moved."""
        values = {}
        for item in items:
            value = self.things[item]
            if item.kind in BODIES:
                values[item] = value.replace(pose=motion.pose(value.pose))
            elif item.kind in LEAST:
                values[item] = tuple(map(motion.point, value))
            elif value.path is not None:
                values[item] = value.replace(path=[motion.point(point) for point in value.path])
            else:
                values[item] = value.replace(at=motion.point(value.position))
        return values

    def with_parts(self, items: Collection[Item], change: Callable[[Any], Any]) -> Self:
        """Return the draft with parts changed, each by a function of itself; None takes one out.

        A new name of a body is put wherever the old one is mentioned.
        """
        values = {item: change(self.things[item]) for item in items}
        draft = self
        for item in (item for item in items if item.kind in BODIES):
            old, new = self.name(item), (values[item].name or "").strip()
            if new == old:
                continue
            if not new or new in {other.name for other in draft._members()}:
                raise InputError(
                    f"{new!r} is the name of another body" if new else "expected a name"
                )
            values[item] = values[item].replace(name=new)
            draft = draft.with_base(**draft.base.mentions(old, new))
        return draft.changed(values)

    def added(self, models: Mapping[Item, Any]) -> Self:
        """Return the draft with one more item for each, of its kind.

        Bodies and beacons get new names. A route is that of the robot before it, if this is a model
        as well; else it goes on with the robot's route.
        """
        taken = {part.name for part in self._members()} | {a.key for a in self.base.addons}
        new: dict[Item, Any] = {}
        numbers: dict[Item, int] = {}
        for item, value in models.items():
            number = numbers[item] = len(self.listed[item.kind]) + len(new)
            place, robot = Item(item.kind, number), Item("robot", item.number)
            if item.kind == "route":
                old = () if robot in numbers else self.things.get(item, ())
                place = Item("route", numbers.get(robot, item.number))
                value = (*old, *value)  # noqa: PLW2901
            elif item.kind in (*BODIES, "beacon"):
                names = map(f"{snake_case(type(value).__name__)}{{}}".format, count())
                name = next(name for name in names if name not in taken)
                taken.add(name)
                value = value.replace(name=name)  # noqa: PLW2901
            new[place] = value
        return self.changed(new)

    def without(self, items: Collection[Item]) -> Self:
        """Return the draft without items."""
        return self.changed(dict.fromkeys(items))

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


def tidy(value: float) -> float:
    """Return a length or angle rounded to nine decimals, without errors of rounding."""
    return round(value, 9) + 0.0


def angle_of(center: Point, point: Point) -> float:
    """Return the direction from one point to another, radians."""
    return atan2(point[1] - center[1], point[0] - center[0])


def seen_from(body: Rigid | None, point: Point) -> Point:
    """Return where a point of the world lies in a body's frame; None: in that of the world."""
    if body is None:
        return point
    x, y, theta = body.pose
    return Motion(-theta, (x, y), (-x, -y)).point(point)


def _pinned(
    joint: Joint, moved: Collection[str | None], bodies: Mapping[str | None, Rigid]
) -> Joint:
    """Return a joint of bodies of which some have moved, its pin where that of these is."""
    if not isinstance(joint, Hinge) or (joint.a in moved) is (joint.b in moved):
        return joint
    ends = [("a", joint.a), ("b", joint.b)]
    (end, held), (other, beside) = ends if joint.a in moved else ends[::-1]
    pin = bodies[held].to_world(getattr(joint, f"anchor_{end}"))
    return joint.replace(**{f"anchor_{other}": seen_from(bodies.get(beside), pin)})


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
