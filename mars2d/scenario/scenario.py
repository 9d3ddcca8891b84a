"""The frozen description of an experiment: robots, workspace, timing, physics, looks."""

from __future__ import annotations

import copy
import numbers
from collections.abc import Callable, Sequence
from functools import cached_property
from math import floor, pi
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.base import Addon
from mars2d.bodies.colors import OBSTACLE, prop_colors
from mars2d.bodies.joints.base import AttachedJoint, Joint
from mars2d.bodies.props.base import Prop
from mars2d.bodies.rigid import Rigid, Surface
from mars2d.core import checks
from mars2d.core.arithmetic import cosine_sine, norm
from mars2d.core.description import Description, choice, entry, number, snake_case, text, wrong
from mars2d.core.errors import InputError, nearest
from mars2d.core.materials import RULES, blended, material_of
from mars2d.core.plane import Outline, bounds_of
from mars2d.core.usercode import called
from mars2d.geometry.shapes import known_shape
from mars2d.scenario import limits, starts
from mars2d.scenario.animation import Animation
from mars2d.scenario.material_pair import MaterialPair, check_once
from mars2d.scenario.neighbours import Everyone, Neighbourhood, neighbourhood
from mars2d.scenario.random_starts import RandomStarts, Room, poses_of, room_of
from mars2d.scenario.robot import Robot
from mars2d.scenario.roles import CONTACT, Pairs, bodies_named, stop_on

PHYSICS = ("contact", "stop", "ideal")

ROW_LIMIT = 100_000_000


def _outlines(addon: Addon) -> tuple[Outline, ...]:
    """Return an add-on's obstacles, checked: it may be of the user's own."""
    with called(f"add-on {addon.key!r}", addon.obstacles):
        found = addon.obstacles()
    return checks.outlines(f"{type(addon).__name__}.obstacles()", found)


class Obstacle(NamedTuple):
    """Something fixed: its outline [m], coefficients of friction and restitution.

    static_friction: holds while nothing slips; None: as friction.
    """

    outline: Outline
    friction: float
    restitution: float
    static_friction: float | None = None


def _robots(name: str, value: object) -> object:
    """Check a list of robots; a number n stands for n default robots, placed by the scenario."""
    if isinstance(value, numbers.Integral) and not isinstance(value, bool):
        if not 1 <= int(value) <= 10_000:
            raise wrong(name, value, "a list of robots, or how many")
        return int(value)
    robots = checks.listing(Robot, "Robot(pose=(0, 0, 0))")(name, value)
    if not robots:
        raise wrong(name, value, "at least one robot, such as [Robot(pose=(0, 0, 0))]")
    return robots


class Scenario(Description):
    """Everything about an experiment except its laws: frozen, validated, in SI units.

    >>> Scenario(robots=[Robot(pose=(0, 0, 0))]).bounds
    (-5.0, 5.0, -5.0, 5.0)

    Raises InputError for anything that the engine could not simulate truthfully: robots that start
    inside an obstacle, inside each other or outside the workspace, polygons that cross themselves,
    numbers out of range.
    """

    title: str = text(default="[Simulation]", doc="the title")
    robots: Sequence[Robot] = entry(
        default=1, check=_robots, doc="the robots, or the number of default robots"
    )
    props: Sequence[Prop] = entry(
        default=(),
        check=checks.listing(Prop, "Box(pose=(1, 0, 0))"),
        doc="the props: boxes, balls and others",
    )
    joints: Sequence[Joint] = entry(
        default=(), check=checks.listing(Joint, "Rope(a='robot0', b='box0')"),
        doc="the joints between robots and props",
    )  # fmt: skip
    workspace: Outline | None = entry(
        default=((-5.0, -5.0), (-5.0, 5.0), (5.0, 5.0), (5.0, -5.0)),
        check=checks.polygon, optional=True, unit="m",
        doc="the polygon in which the robots move; None: no limits",
    )  # fmt: skip
    on_exit: str = choice(
        default="stop", of=("stop", "wall", "ignore"),
        doc="the workspace's edge: it ends the experiment, is a wall, or has no effect",
    )  # fmt: skip
    sampling_time: float = number(
        default=0.1, low=1e-6, high=1e4, unit="s", doc="time between commands"
    )
    stop_time: float = number(
        default=100.0,
        low=0,
        high=1e12,
        unit="s",
        doc="the longest duration",
    )
    stop_on: str | Pairs | None = entry(
        default=None, check=stop_on, optional=True,
        doc="touches that end the experiment: any, or of bodies, roles or 'wall' by name",
        names="body",
    )  # fmt: skip
    command_delay: float = number(
        default=0.0, low=0, high=1e6, unit="s", doc="from a command's issue to its effect"
    )
    physics: str = choice(
        default="contact", of=PHYSICS,
        doc="the effect of contact: forces act, a robot stops, or nothing happens",
    )  # fmt: skip
    max_overlap: float = number(
        default=1e-3,
        low=1e-5,
        high=1.0,
        unit="m",
        doc="the largest overlap of bodies for an instant",
    )
    friction_rule: str = choice(
        default="product", of=RULES, doc="the rule that combines the friction of two surfaces"
    )
    restitution_rule: str = choice(
        default="product", of=RULES, doc="the rule that combines the restitution of two surfaces"
    )
    material_pairs: Sequence[MaterialPair] = entry(
        default=(),
        check=checks.listing(MaterialPair, "MaterialPair('steel', 'ice', friction=0.03)"),
        doc="coefficients of certain pairs of materials, in place of the rule",
    )
    random_starts: Sequence[RandomStarts] = entry(
        default=(), check=checks.listing(RandomStarts, "RandomStarts(least_distance=1)"),
        doc="robots and props with random starts, which depend on the seed",
    )  # fmt: skip
    addons: Sequence[Addon] = entry(
        default=(), check=checks.listing(Addon, "Map([...])"), doc="maps, measures, games"
    )
    sees: str = choice(
        default="full", of=("full", "positions"),
        doc="what the team's law may see: all, or only positions",
    )  # fmt: skip
    neighbours: Neighbourhood = entry(
        check=neighbourhood, factory=Everyone, doc="the rule that selects `robot.neighbours`"
    )
    animation: Animation = entry(
        check=checks.instance(Animation, "Animation()"),
        factory=Animation,
        doc="how the experiment is drawn",
    )

    def _validate(self) -> None:
        if isinstance(self.robots, int):
            object.__setattr__(self, "robots", self._circle_of_robots(self.robots))
        taken = {robot.name for robot in self.robots} | {prop.name for prop in self.props}
        robots = tuple(_named(robot, "robot", i, taken) for i, robot in enumerate(self.robots))
        props = tuple(
            _named(prop, snake_case(type(prop).__name__), i, taken)
            for i, prop in enumerate(self.props)
        )
        object.__setattr__(self, "robots", robots)
        object.__setattr__(self, "props", props)
        checks.unique("Scenario.robots and props", [str(part.name) for part in (*robots, *props)])
        checks.unique("Scenario.addons", [addon.key for addon in self.addons])
        check_once("Scenario.material_pairs", self.material_pairs)
        for kind in {k for addon in self.addons for k in type(addon).__mro__}:  # derived ones, too
            why = vars(kind).get("only_one")
            if why and sum(isinstance(addon, kind) for addon in self.addons) > 1:
                raise InputError(f"Scenario.addons: two are {kind.__name__}, and {why}")
        step = f"sampling times of {self.sampling_time:g} s"
        if self.stop_time / self.sampling_time > ROW_LIMIT:
            raise wrong("Scenario.stop_time", self.stop_time, f"at most {ROW_LIMIT:g} {step}")
        if self.command_delay / self.sampling_time > 1e6:
            raise wrong("Scenario.command_delay", self.command_delay, f"at most a million {step}")
        for robot in robots:
            for sensor in robot.sensors:
                sensor.check_timing(f"{type(sensor).__name__} of {robot.name}", self.sampling_time)
        self.neighbours.check_size(len(self.robots))
        self._check_bodies()
        if self.random_starts:
            vars(self).update(self._placed(0))  # it always has poses
        self._check_joints()
        for fault in starts.faults(self, self.bodies):
            raise InputError(fault.told(self))
        _ = self._ending  # refuses names that are not there

    def _circle_of_robots(self, count: int) -> tuple[Robot, ...]:
        """Place robots round a circle, facing its centre, as MARS does without an Initial_pose."""
        whole = bounds_of(self.workspace) if self.workspace else (-5.0, 5.0, -5.0, 5.0)
        xmin, xmax, ymin, ymax = whole
        x, y = (xmin + xmax) / 2, (ymin + ymax) / 2
        radius = 0.7 * min(xmax - xmin, ymax - ymin) / 2 if count > 1 else 0.0
        angles = [2 * pi * i / count for i in range(count)]
        ways = map(cosine_sine, angles)
        return tuple(
            Robot(pose=(x + radius * c, y + radius * s, a + pi if count > 1 else 0.0))
            for a, (c, s) in zip(angles, ways, strict=True)
        )

    def _check_bodies(self) -> None:
        """Refuse bodies that contacts can't hold."""
        for robot in self.robots:
            limits.check_drive(str(robot.name), robot.drive, limits.corner(robot.chassis))
        for prop in self.props:
            with called(f"prop {prop.name!r}", type(prop)):
                shape, _, _ = prop.shape, prop.inertia, prop.surface
            where = f"{type(prop).__name__}.shape of {prop.name}"
            limits.check_centred(where, known_shape(where, shape))
        floors = {str(prop.name): prop.resting_friction for prop in self.props}
        push = sum(robot.push for robot in self.robots)
        force = max(robot.drive.max_force for robot in self.robots)
        limits.check_bodies(self.bodies, self.max_overlap, floors, push, force)

    def _check_joints(self) -> None:
        """Refuse joints of unknown bodies, and joints that would pull them at once."""
        named = [(f"Scenario.joints[{i}]", joint) for i, joint in enumerate(self.joints)]
        for prop in self.props:
            with called(f"{type(prop).__name__}.joints()", prop.joints):
                brought = checks.listing(Joint, "Hinge(a='gate0')")("joints()", prop.joints())
            named += [(f"{type(prop).__name__} {prop.name}", joint) for joint in brought]
        for where, joint in named:
            limits.check_ends(where, joint, self._indices)
        for (where, _), attached in zip(named, self.ties, strict=True):
            limits.check_joint(where, attached, self.bodies)
            joint = attached.joint
            for index, anchor in ((attached.a, joint.anchor_a), (attached.b, joint.anchor_b)):
                if 0 <= index < len(self.robots):
                    robot = self.robots[index]
                    limits.check_drive(str(robot.name), robot.drive, norm(*anchor))

    def started(self, seed: int) -> Scenario:
        """Return the scenario of a run with this seed: with the poses that `random_starts` draws.

        What is returned starts there whatever the seed. Raises InputError if no place is found.
        """
        if not self.random_starts:
            return self
        found = copy.copy(self)  # whatever was checked holds for these starts as well
        vars(found).update(self._placed(seed), random_starts=(), surfaces=self.surfaces)
        return found

    def _repr_svg_(self) -> str:
        """Return the picture that a notebook shows; it lies above, among the public names."""
        import mars2d

        return str(mars2d.scenario_svg(self))

    def with_laws(self, laws: Sequence[Callable[[Any], Any] | None]) -> Self:
        """Return the scenario with these laws of its robots; nothing else is checked again."""
        found, robots = copy.copy(self), [copy.copy(robot) for robot in self.robots]
        for robot, law in zip(robots, laws, strict=True):
            object.__setattr__(robot, "controller", law)
        object.__setattr__(found, "robots", tuple(robots))
        return found

    @cached_property
    def _room(self) -> Room:
        return room_of(self)

    def _placed(self, seed: int) -> dict[str, Any]:
        """Return the robots, props and bodies with the poses that follow from the seed."""
        poses = poses_of(self, self._room, seed)

        def placed(part: Any) -> Any:
            if part.name not in poses:
                return part
            twin = copy.copy(part)
            vars(twin)["pose"] = poses[part.name]
            return twin

        bodies = [body._replace(pose=poses.get(body.name, body.pose)) for body in self.bodies]
        return {
            "robots": tuple(map(placed, self.robots)),
            "props": tuple(map(placed, self.props)),
            "bodies": tuple(bodies),
        }

    @cached_property
    def bodies(self) -> tuple[Rigid, ...]:
        """The rigid bodies of all robots, then of all props."""
        return (*(robot.rigid for robot in self.robots), *(prop.rigid for prop in self.props))

    @cached_property
    def inputs(self) -> int:
        """The most inputs that a robot's drive has: the rows of a command (m, n)."""
        return max((len(robot.drive.inputs) for robot in self.robots), default=2)

    @cached_property
    def _indices(self) -> dict[str, int]:
        return {body.name: i for i, body in enumerate(self.bodies)}

    @cached_property
    def ties(self) -> tuple[AttachedJoint, ...]:
        """All joints attached to their bodies, with those that props bring."""
        joints = [*self.joints, *(joint for prop in self.props for joint in prop.joints())]
        at, bodies = self._indices, self.bodies
        ends = ((j, at[j.a], -1 if j.b is None else at[j.b]) for j in joints)
        return tuple(AttachedJoint.of(joint, a, b, bodies) for joint, a, b in ends)

    @cached_property
    def joined(self) -> frozenset[tuple[int, int]]:
        """Pairs (i, j), i < j, of bodies that share a hinge, and so do not collide."""
        return frozenset(
            (min(tie.a, tie.b), max(tie.a, tie.b)) for tie in self.ties if tie.pinned and tie.b >= 0
        )

    @cached_property
    def surfaces(self) -> tuple[Obstacle, ...]:
        """The obstacles: those of the add-ons, then the workspace if it is a wall."""
        found = [
            Obstacle(outline, addon.friction, addon.restitution, addon.static_friction)
            for addon in self.addons
            for outline in _outlines(addon)
        ]
        if self.on_exit == "wall" and self.workspace is not None:
            found.append(Obstacle(self.workspace, 1.0, 1.0))
        return tuple(found)

    @property
    def obstacles(self) -> tuple[Outline, ...]:
        """The outlines of the add-ons' obstacles, in order."""
        walled = self.on_exit == "wall" and self.workspace is not None
        found = self.surfaces[:-1] if walled else self.surfaces
        return tuple(obstacle.outline for obstacle in found)

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """(xmin, xmax, ymin, ymax) of the workspace [m]; without one, of robots and obstacles."""
        if self.workspace is not None:
            return bounds_of(self.workspace)
        points = [body.bound[0] for body in self.bodies]
        points += [vertex for outline in self.obstacles for vertex in outline]
        xmin, xmax, ymin, ymax = bounds_of(points)
        return xmin - 1, xmax + 1, ymin - 1, ymax + 1

    @property
    def initial_pose(self) -> NDArray[np.float64]:
        """The poses at the start, (3, n)."""
        return np.array([robot.pose for robot in self.robots]).T

    def index_of(self, field: str, robot: str | int) -> int:
        """Return the index of a robot that is given by its name or index.

        Raises InputError, which begins with `field`, if there is no such robot.
        """
        return index_among(field, "robot", robot, [str(each.name) for each in self.robots])

    def body_index_of(self, field: str, body: str | int) -> int:
        """Return the index in `bodies` of a robot or prop that is given by its name or index."""
        return index_among(field, "body", body, [rigid.name for rigid in self.bodies])

    def body_name(self, body: int) -> str:
        """Return the name of a body of a contact; -1 - k is obstacle k, or the wall."""
        if body >= 0:
            return self.bodies[body].name
        walled = len(self.surfaces) > len(self.obstacles)
        return "wall" if walled and body == -len(self.surfaces) else f"obstacle {-1 - body}"

    @cached_property
    def _ending(self) -> tuple[tuple[frozenset[int], frozenset[int]], ...]:
        pairs = () if self.stop_on is None or isinstance(self.stop_on, str) else self.stop_on
        return bodies_named(self, pairs, self._indices, len(self.surfaces)) if pairs else ()

    def ends_by(self, a: int, b: int) -> bool:
        """Return whether a touch of two bodies, numbered as in contacts, ends the experiment."""
        pairs = [(one, other) for ends in self._ending for one, other in (ends, ends[::-1])]
        return self.stop_on == CONTACT or any(a in one and b in other for one, other in pairs)

    def friction_between(self, a: int, b: int, *, slides: bool = False) -> float:
        """Return the coefficient of friction of two bodies of a contact, as they rest or slide.

        a: an index of `bodies`. b: another, or -1 - k for obstacle k, as in contacts.
        """
        sides = self._surfaces(a, b)
        pair = self._pair(*(side.friction for side in sides))
        if pair is not None and pair.friction is not None:
            return pair.friction if slides else max(pair.friction, pair.static_friction or 0.0)
        values = (s.friction if slides else s.static_friction or s.friction for s in sides)
        return blended(self.friction_rule, *values)

    def restitution_between(self, a: int, b: int) -> float:
        """Return the coefficient of restitution of two bodies, numbered as for friction."""
        bounces = [side.restitution for side in self._surfaces(a, b)]
        pair = self._pair(*bounces)
        if pair is not None and pair.restitution is not None:
            return pair.restitution
        return blended(self.restitution_rule, *bounces)

    def _surfaces(self, a: int, b: int) -> tuple[Surface, Surface | Obstacle]:
        return self.bodies[a].surface, self.bodies[b].surface if b >= 0 else self.surfaces[-1 - b]

    def _pair(self, one: float, other: float) -> MaterialPair | None:
        """Return the pair of the table whose materials gave two coefficients, if there is one."""
        names = frozenset((material_of(one), material_of(other)))
        return next((pair for pair in self.material_pairs if pair.names == names), None)

    @cached_property
    def last_iteration(self) -> int:
        """The iteration at the stop time: the number of sampling times of the run."""
        return floor(self.stop_time / self.sampling_time * (1 + 1e-12) + 1e-9)

    @cached_property
    def colors(self) -> tuple[str, ...]:
        """The robots' colours, each its own or one of the animation's base colours."""
        base = self.animation.base_colors
        return tuple(robot.color or base[i % len(base)] for i, robot in enumerate(self.robots))

    @cached_property
    def body_colors(self) -> tuple[str, ...]:
        """The colours of all robots, then of all props."""
        return (*self.colors, *prop_colors(self.props))

    def color_of(self, body: int) -> str:
        """Return the colour of a body of a contact; obstacles have one in common."""
        return OBSTACLE if body < 0 else self.body_colors[body]


def index_among(field: str, kind: str, wanted: str | int, names: list[str]) -> int:
    """Return the place of a name among others, or a place that there is; else InputError.

    A name of digits that none of them has is a place.
    """
    if wanted in names:
        return names.index(str(wanted))
    if isinstance(wanted, str) and not wanted.isdecimal():
        raise InputError(f"{field}: there is no {kind} {wanted!r}{nearest(wanted, names)}")
    if not 0 <= int(wanted) < len(names):
        raise InputError(f"{field}: there is no {kind} {wanted}; they are 0 to {len(names) - 1}")
    return int(wanted)


def _named(part: Any, kind: str, index: int, taken: set[str | None]) -> Any:
    """Return a robot or prop with its own name, or else with one that no other has."""
    if part.name is not None:
        return part
    name = f"{kind}{index}"
    while name in taken:
        name += "_"
    return part.replace(name=name)
