"""The bodies of one world in pymunk. No other module knows the engine's objects.

Bodies are numbered robots first, then props; obstacles are -1, -2, ... The engine walks them in one
order: robots, props, the robots' control bodies, then the static ones, the floor first.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from math import inf
from typing import Any

import numpy as np
import pymunk
from numpy.typing import NDArray
from pymunk import batch
from pymunk._chipmunk_cffi import ffi, lib

from mars2d.contact import Solved
from mars2d.geometry import Outline, Point, edges_of
from mars2d.joints.base import Joint
from mars2d.joints.hinge import Hinge
from mars2d.joints.rod import Rod
from mars2d.joints.rope import Rope
from mars2d.joints.spring import Spring
from mars2d.motion import point_velocity
from mars2d.rays import BODY, SIGHT, Rays, end_bars
from mars2d.rigid import Rigid
from mars2d.scenario import Scenario
from mars2d.tethers import TAUT
from mars2d.tie import Tie

__all__ = ["Space"]

Float = NDArray[np.float64]
Mask = NDArray[np.bool_]
Index = NDArray[np.intp]
Clutch = tuple[pymunk.PivotJoint, pymunk.GearJoint]

_STATE = (
    batch.BodyFields.POSITION
    | batch.BodyFields.ANGLE
    | batch.BodyFields.VELOCITY
    | batch.BodyFields.ANGULAR_VELOCITY
)
_POSE = batch.BodyFields.POSITION | batch.BodyFields.ANGLE
_VELOCITY = batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY
_ARBITER = (
    batch.ArbiterFields.BODY_A_ID
    | batch.ArbiterFields.BODY_B_ID
    | batch.ArbiterFields.TOTAL_IMPULSE
    | batch.ArbiterFields.NORMAL
    | batch.ArbiterFields.CONTACT_COUNT
    | batch.ArbiterFields.POINT_A_1
    | batch.ArbiterFields.POINT_B_1
    | batch.ArbiterFields.POINT_A_2
    | batch.ArbiterFields.POINT_B_2
)


_IN_TOUCH = (0, 1)
"""The engine's states of contacts that are not over: just begun, going on."""

GOLDEN = (5**0.5 - 1) / 2
"""Multiples of it, less their whole part, lie evenly scattered from 0 to 1."""

JOINT_BIAS = 0.7**1000
"""What is left after a second of the error of a joint: 30 % of it go in 1 ms."""


class Space:
    """Robots, props, obstacles and joints as pymunk objects, read and written in batches."""

    def __init__(self, scenario: Scenario, slop: float, iterations: int) -> None:
        """Build all of it.

        slop: the overlap that the solver leaves in steady contact, metres. iterations: of the
        solver.
        """
        self._space = pymunk.Space()
        self._space.collision_slop = slop
        self._space.iterations = iterations
        self.robots = len(scenario.robots)
        self._shapes: dict[pymunk.Shape, int] = {}
        self._bodies = [self._add_body(rigid, i) for i, rigid in enumerate(scenario.bodies)]
        self._controls = [self._add(_kinematic()) for _ in scenario.robots]
        self._floor = self._add(_static())
        self.obstacles = tuple(s.outline for s in scenario.surfaces)
        self._statics = [
            self._add_obstacle(-1 - k, *surface) for k, surface in enumerate(scenario.surfaces)
        ]
        self._space.add(*_scattered([s for s, body in self._shapes.items() if body < 0]))
        self._clutches: dict[int, Clutch] = {
            i: _clutch(control, self._bodies[i], robot.drive.max_force, robot.drive.max_torque)
            for i, (control, robot) in enumerate(zip(self._controls, scenario.robots, strict=True))
        }
        drives = [robot.drive for robot in scenario.robots]
        self._bounds = np.array([(drive.max_force, drive.max_torque) for drive in drives])
        self._grips: dict[int, Clutch] = {}
        self._ties = scenario.ties
        self._joints = [self._add_joint(tie) for tie in self._ties]

        self.last_step = inf
        """The length of the last step, seconds."""
        count = len(self._bodies) + len(self._controls) + 1 + len(self._statics)
        self._state_buffer = batch.Buffer()
        self._arbiter_buffer = batch.Buffer()
        self.velocity = np.zeros((count, 3))
        """What `step` sets: (x', y', theta') of bodies, then of the robots' control bodies."""
        self._velocity_buffer = batch.Buffer()
        self._velocity_buffer.set_float_buf(self.velocity)
        self._pose_buffer = batch.Buffer()
        # In batches the engine names bodies by numbers of its own.
        named = [(body.id, i) for i, body in enumerate(self._bodies)]
        named += [(body.id, -1 - k) for k, body in enumerate(self._statics)]
        self._identity, self._name = np.array(sorted(named), dtype=np.int64).T
        self._rays = Rays(self._space, self._shapes)
        self._misplaced: set[int] = set()  # their shapes do not know yet where the bodies are

    # -- building ---------------------------------------------------------------------------

    def _add(self, body: pymunk.Body) -> pymunk.Body:
        self._space.add(body)
        return body

    def _add_body(self, rigid: Rigid, i: int) -> pymunk.Body:
        body = self._add(pymunk.Body(rigid.inertia.mass, rigid.inertia.moment))
        x, y, theta = rigid.pose
        body.position, body.angle = (x, y), theta
        body.velocity, body.angular_velocity = rigid.velocity[:2], rigid.velocity[2]
        for vertices, radius in rigid.shape.pieces:
            shape: pymunk.Shape
            if len(vertices) == 1:
                shape = pymunk.Circle(body, radius, vertices[0])
            else:
                shape = pymunk.Poly(body, vertices)
            shape.friction, shape.elasticity = rigid.surface
            # A robot's rays do not see itself.
            shape.filter = pymunk.ShapeFilter(i + 1 if i < self.robots else 0, categories=BODY)
            self._space.add(shape)
            self._shapes[shape] = i
        return body

    def _add_obstacle(
        self, k: int, outline: Outline, friction: float, restitution: float
    ) -> pymunk.Body:
        body = self._add(_static())
        edges = edges_of(outline)
        segments = [pymunk.Segment(body, a, b, 0.0) for a, b in edges]
        for segment in segments:
            segment.friction, segment.elasticity = friction, restitution
        if len(edges) == 1:
            bars = [pymunk.Segment(body, a, b, 0.0) for a, b in end_bars(*edges[0])]
            for bar in bars:
                bar.filter = pymunk.ShapeFilter(categories=SIGHT, mask=SIGHT)
            segments += bars
        self._shapes |= dict.fromkeys(segments, k)
        return body

    def _add_joint(self, tie: Tie) -> list[pymunk.Constraint]:
        a, b = (self._floor if i < 0 else self._bodies[i] for i in (tie.a, tie.b))
        make = next(_MAKERS[kind] for kind in type(tie.joint).__mro__ if kind in _MAKERS)
        constraints = make(tie, a, b)
        for constraint in constraints:
            constraint.collide_bodies = not isinstance(tie.joint, Hinge)
            constraint.error_bias = JOINT_BIAS
        self._space.add(*constraints)
        return constraints

    # -- state ------------------------------------------------------------------------------

    def read(self) -> Float:
        """Read (N, 6): x, y, theta, x', y', theta' of robots and props, in one call.

        The array is the engine's own memory, and changes with the next call.
        """
        buffer = self._state_buffer
        buffer.clear()
        batch.get_space_bodies(self._space, _STATE, buffer)
        count = len(self._bodies)
        return np.frombuffer(buffer.float_buf(), dtype=np.float64, count=6 * count).reshape(-1, 6)

    def step(self, h: float) -> None:
        """Set the velocities of all bodies to `velocity`, and go on by h seconds.

        The solver begins with the impulses of the step before, scaled by the ratio of the steps'
        lengths, but takes back the unscaled ones: a drive at its bound would push with
        F (2 h - h before), impacts would be undone by half. So those of contacts are scaled where
        they are kept, and the solver is told that both steps are equally long.
        """
        if h != self.last_step:
            self._scale_contacts(h / self.last_step)
            self.last_step = h
            self._renew_ties()
        self._misplaced.clear()
        lib.cpSpaceSetCurrentTimeStep(self._space._space, h)
        batch.set_space_bodies(self._space, _VELOCITY, self._velocity_buffer)
        self._space.step(h)

    def _scale_contacts(self, ratio: float) -> None:
        """Scale the impulses that the solver keeps of contacts."""
        for arbiter in self._space._get_arbiters():
            if arbiter.state in _IN_TOUCH:
                for k in range(arbiter.count):
                    contact = arbiter.contacts[k]
                    contact.jnAcc *= ratio
                    contact.jtAcc *= ratio

    def misplace(self, which: Index) -> None:
        """Note that bodies have been put somewhere else, where the next query is to find them."""
        self._misplaced.update(which.tolist())

    def shared(self) -> tuple[dict[str, NDArray[Any]], dict[str, float]]:
        """Return the addresses of the engine's objects for the kernel, by its names."""
        pivots, gears = zip(*self._clutches.values(), strict=True)
        arrays = {
            "body": _addresses(body._body for body in self._bodies),
            "control": _addresses(body._body for body in self._controls),
            "pivot": _addresses(joint._constraint for joint in pivots),
            "gear": _addresses(joint._constraint for joint in gears),
        }
        numbers = [*range(len(self._bodies)), *(-1 - k for k in range(len(self._statics)))]
        address = _addresses(body._body for body in self._bodies + self._statics)
        order = np.argsort(address)
        arrays["address"] = address[order]
        arrays["name"] = np.array(numbers, dtype=np.int64)[order]
        (space,) = _addresses([self._space._space]).tolist()
        return arrays, {"space": space, "bodies": len(numbers)}

    def place(self, i: int, x: float, y: float, theta: float | None = None) -> None:
        """Put a body somewhere; the next step and the next query find it there."""
        self._misplaced.add(i)
        self._bodies[i].position = x, y
        if theta is not None:
            self._bodies[i].angle = theta

    def place_all(self, pose: Float) -> None:
        """Put all bodies at poses (N, 3), where rays meet them at once."""
        everything = np.zeros((len(self.velocity), 3))
        everything[: len(pose)] = pose
        self._pose_buffer.set_float_buf(everything)
        batch.set_space_bodies(self._space, _POSE, self._pose_buffer)
        for body in self._bodies:
            self._space.reindex_shapes_for_body(body)

    # -- what holds bodies ------------------------------------------------------------------

    def engage(self, i: int) -> None:
        """Let a robot's drive act through its joints."""
        self._clutches[i] = _renewed(self._clutches[i])
        self._space.add(*self._clutches[i])

    def disengage(self, i: int) -> None:
        """Take a robot's joints out again."""
        self._space.remove(*self._clutches[i])

    def effort(self, which: list[int]) -> Float:
        """Return the shares of their bounds that engaged drives used in the last step."""
        used = [(pivot.impulse, gear.impulse) for pivot, gear in (self._clutches[i] for i in which)]
        return np.asarray((np.array(used) / (self._bounds[which] * self.last_step)).max(axis=1))

    def grip(self, i: int, force: float, torque: float) -> None:
        """Let the floor hold a body with a force [N] and a torque [N m] of friction."""
        if i not in self._grips:
            self._grips[i] = _clutch(self._floor, self._bodies[i], force, torque)
            self._space.add(*self._grips[i])
        pivot, gear = self._grips[i]
        pivot.max_force, gear.max_force = force, torque

    def held(self, i: int) -> tuple[float, float]:
        """Return the force [N] and torque [N m] of the floor on a body in the last step."""
        if i not in self._grips:
            return 0.0, 0.0
        pivot, gear = self._grips[i]
        return pivot.impulse / self.last_step, gear.impulse / self.last_step

    def draw_in(self, k: int, speed: float) -> None:
        """Let rope k, which is longer than it ought to be, get shorter by no more than this, m/s.

        What is drawn in goes on to move, and makes the rope slack.
        """
        (self._joints[k][0]).max_bias = speed

    def renew(self, which: Mask) -> None:
        """Let the joints of some bodies begin anew, as if they had not held anything yet; (N,).

        Robots among them are engaged. It is to be done where a step is much shorter than the one
        before: the solver would begin with what the joints did in that.
        """
        for i in np.flatnonzero(which).tolist():
            joints = self._clutches if i < self.robots else self._grips
            if i < self.robots or i in self._grips:
                joints[i] = self._replaced(joints[i])

    def _renew_ties(self) -> None:
        for k, tie in enumerate(self._ties):
            bias = self._joints[k][0].max_bias
            self._space.remove(*self._joints[k])
            self._joints[k] = self._add_joint(tie)
            self._joints[k][0].max_bias = bias

    def _replaced(self, clutch: Clutch) -> Clutch:
        self._space.remove(*clutch)
        fresh = _renewed(clutch)
        self._space.add(*fresh)
        return fresh

    # -- contacts ---------------------------------------------------------------------------

    def solved(self, state: Float) -> Solved:
        """Return the contacts of the last step, those included that parted shortly before.

        state: (N, 6) after it.
        """
        buffer = self._arbiter_buffer
        buffer.clear()
        batch.get_space_arbiters(self._space, _ARBITER, buffer)
        whole = np.frombuffer(buffer.int_buf(), dtype=np.int64).reshape(-1, 3)
        values = np.frombuffer(buffer.float_buf(), dtype=np.float64).reshape(-1, 12)
        bodies = self._name[np.searchsorted(self._identity, whole[:, :2])]
        two = whole[:, 2:] > 1
        first = np.where(two, (values[:, 4:6] + values[:, 8:10]) / 2, values[:, 4:6])
        second = np.where(two, (values[:, 6:8] + values[:, 10:12]) / 2, values[:, 6:8])
        impulse, normal = values[:, 0:2].copy(), values[:, 2:4].copy()
        velocity = point_velocity(state, self.velocity, bodies[:, 1], second)
        velocity -= point_velocity(state, self.velocity, bodies[:, 0], first)
        return Solved(bodies, impulse, normal, first, second, velocity)

    # -- what sensors ask -------------------------------------------------------------------

    @property
    def _seen(self) -> pymunk.Space:
        """The space, with all shapes where their bodies are."""
        for i in sorted(self._misplaced):
            self._space.reindex_shapes_for_body(self._bodies[i])
        self._misplaced.clear()
        return self._space

    @property
    def rays(self) -> Rays:
        """What casts rays at all that stands and moves here."""
        _ = self._seen
        return self._rays

    def distance(self, point: Point, limit: float, ignore: int) -> float:
        """Return the distance to the nearest surface, inf beyond `limit`; see Surroundings."""
        info = self._seen.point_query_nearest(point, limit, _own(ignore))
        return inf if info is None else info.distance

    def nearby(self, point: Point, limit: float, ignore: int) -> Iterator[Point]:
        """Yield the nearest point of each surface within `limit`; see Surroundings."""
        for info in self._seen.point_query(point, limit, _own(ignore)):
            yield info.point.x, info.point.y


def _addresses(things: Iterable[Any]) -> NDArray[np.uintp]:
    return np.array([int(ffi.cast("uintptr_t", thing)) for thing in things], dtype=np.uintp)


def _own(robot: int) -> pymunk.ShapeFilter:
    return pymunk.ShapeFilter(group=robot + 1, categories=BODY)


def _scattered(shapes: list[pymunk.Shape]) -> list[pymunk.Shape]:
    """Return shapes in an order in which neighbours lie far apart, always the same.

    The engine sorts shapes into a tree as they come. Neighbours one after the other make it
    lopsided, and rays through it up to twice as slow.
    """
    order = sorted(range(len(shapes)), key=lambda k: k * GOLDEN % 1.0)
    return [shapes[k] for k in order]


def _kinematic() -> pymunk.Body:
    return pymunk.Body(body_type=pymunk.Body.KINEMATIC)


def _static() -> pymunk.Body:
    return pymunk.Body(body_type=pymunk.Body.STATIC)


def _renewed(clutch: Clutch) -> Clutch:
    """Return a clutch like this one that has not held anything yet."""
    pivot, gear = clutch
    return _clutch(pivot.a, pivot.b, pivot.max_force, gear.max_force)


def _clutch(holder: pymunk.Body, body: pymunk.Body, force: float, torque: float) -> Clutch:
    """Return the joints that make a body move as its holder does, with bounded force and torque."""
    pivot = pymunk.PivotJoint(holder, body, (0.0, 0.0), (0.0, 0.0))
    gear = pymunk.GearJoint(holder, body, 0.0, 1.0)
    pivot.max_bias = gear.max_bias = 0.0
    pivot.max_force, gear.max_force = force, torque
    return pivot, gear


def _rope(tie: Tie, a: pymunk.Body, b: pymunk.Body) -> list[pymunk.Constraint]:
    ends = tie.joint.anchor_a, tie.joint.anchor_b
    rope = pymunk.SlideJoint(a, b, *ends, 0.0, tie.length - TAUT)
    rope.max_bias = 0.0
    return [rope]


def _rod(tie: Tie, a: pymunk.Body, b: pymunk.Body) -> list[pymunk.Constraint]:
    rod = pymunk.PinJoint(a, b, tie.joint.anchor_a, tie.joint.anchor_b)
    rod.distance = tie.length
    return [rod]


def _spring(tie: Tie, a: pymunk.Body, b: pymunk.Body) -> list[pymunk.Constraint]:
    joint = tie.joint
    assert isinstance(joint, Spring)
    ends = joint.anchor_a, joint.anchor_b
    return [pymunk.DampedSpring(a, b, *ends, tie.length, joint.stiffness, joint.damping)]


def _hinge(tie: Tie, a: pymunk.Body, b: pymunk.Body) -> list[pymunk.Constraint]:
    joint, turned = tie.joint, tie.turned
    assert isinstance(joint, Hinge)
    made: list[pymunk.Constraint] = [pymunk.PivotJoint(a, b, joint.anchor_a, joint.anchor_b)]
    if tie.b < 0:  # it is a that turns against the world
        a, b, turned = b, a, -turned
    if joint.limits is not None:
        least, largest = joint.limits
        made.append(pymunk.RotaryLimitJoint(a, b, turned + least, turned + largest))
    if joint.stiffness or joint.damping:
        made.append(pymunk.DampedRotarySpring(a, b, -turned, joint.stiffness, joint.damping))
    return made


_MAKERS: dict[type[Joint], Callable[..., list[pymunk.Constraint]]] = {
    Rope: _rope,
    Rod: _rod,
    Spring: _spring,
    Hinge: _hinge,
}
