"""Space: the bodies of one world in pymunk. Only `rays` and `kernel` know its objects, too.

Bodies are numbered robots first, then props; obstacles are -1, -2, ... The engine walks them in one
order: robots, props, the robots' control bodies, then the static ones, the floor first.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from math import inf
from typing import Any

import numpy as np
import pymunk
from numpy.typing import NDArray
from pymunk import batch
from pymunk._chipmunk_cffi import ffi, lib

from mars2d.bodies.constraints import (
    Constraint,
    FixedDistance,
    MaxDistance,
    Pin,
    SpringDamper,
    TurningRange,
    TurningSpring,
)
from mars2d.bodies.joints.base import AttachedJoint
from mars2d.bodies.rigid import Rigid
from mars2d.core.plane import Outline, Point, edges_of
from mars2d.physics.rays import BODY, POSE, SIGHT, Rays, end_bars
from mars2d.physics.settings import JOINT_BIAS, TAUT
from mars2d.record.contact import Solved
from mars2d.scenario.scenario import Scenario

__all__ = ["Space"]

Float = NDArray[np.float64]
Mask = NDArray[np.bool_]
Index = NDArray[np.intp]

_STATE = (
    batch.BodyFields.POSITION
    | batch.BodyFields.ANGLE
    | batch.BodyFields.VELOCITY
    | batch.BodyFields.ANGULAR_VELOCITY
)
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
"""The engine's states of contacts that have just begun, or go on."""

ORIGIN = (0.0, 0.0)

GOLDEN = (5**0.5 - 1) / 2
"""The fractional parts of its multiples are scattered evenly from 0 to 1."""


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
        drives = [robot.drive for robot in scenario.robots]
        self._bounds = np.array([(drive.max_force, drive.max_torque) for drive in drives])
        self._drive_joints = [
            self._joint_pair(self._controls[i], self._bodies[i], *limits)
            for i, limits in enumerate(self._bounds.tolist())
        ]
        self._floor_joints: dict[int, JointPair] = {}
        self._ties = scenario.ties
        self._joints = [self._add_joint(tie) for tie in self._ties]

        self.last_step = inf
        """The length of the last step, seconds."""
        count = len(self._bodies) + len(self._controls) + 1 + len(self._statics)
        self._state_buffer = batch.Buffer()
        self._everything = np.empty((0, 6))  # what was read last, of all bodies
        self._arbiter_buffer = batch.Buffer()
        self.velocity = np.zeros((count, 3))
        """What `step` sets: (x', y', theta') of bodies, then of the robots' control bodies."""
        self._velocity_buffer = batch.Buffer()
        self._velocity_buffer.set_float_buf(self.velocity)
        self._pose_buffer = batch.Buffer()
        # In batches the engine names bodies by numbers of its own.
        first = count - len(self._statics)
        named = [(body.id, i, i) for i, body in enumerate(self._bodies)]
        named += [(body.id, -1 - k, first + k) for k, body in enumerate(self._statics)]
        self._identity, self._name, self._row = np.array(sorted(named), dtype=np.int64).T.copy()
        self._rays = Rays(self._space, self._shapes)
        self._misplaced: set[int] = set()  # their shapes do not know yet where the bodies are
        self._elsewhere: Float | None = None  # states (N, 6) where all bodies are, if not here
        self._surfaces = np.array([rigid.surface for rigid in scenario.bodies])
        self._wall_surfaces = np.array(
            [s[1:] for s in scenario.surfaces for _ in edges_of(s.outline)], dtype=float
        ).reshape(-1, 2)  # of each edge

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

    def _joint_pair(
        self, holder: pymunk.Body, body: pymunk.Body, force: float, torque: float
    ) -> JointPair:
        """Return joints that make a body move as its holder does, with bounded force and torque."""
        ends = ORIGIN, ORIGIN
        pivot = _Constraint(self._space, "PivotJoint", holder, body, *ends, max_bias=0.0)
        gear = _Constraint(self._space, "GearJoint", holder, body, 0.0, 1.0, max_bias=0.0)
        pivot.set(max_force=force)
        gear.set(max_force=torque)
        return pivot, gear

    def _add_joint(self, attached: AttachedJoint) -> list[_Constraint]:
        a, b = (self._floor if i < 0 else self._bodies[i] for i in (attached.a, attached.b))
        make = partial(_Constraint, self._space)
        made = [_translated(attached, each, make, a, b) for each in attached.constraints]
        for joint in made:
            joint.set(collide_bodies=not attached.pinned, error_bias=JOINT_BIAS)
            joint.add()
        return made

    # -- state ------------------------------------------------------------------------------

    def read(self) -> Float:
        """Read (N, 6): x, y, theta, x', y', theta' of robots and props, in one call.

        The array is the engine's own memory, and changes with the next call.
        """
        buffer = self._state_buffer
        buffer.clear()
        batch.get_space_bodies(self._space, _STATE, buffer)
        self._everything = np.frombuffer(buffer.float_buf()).reshape(-1, 6)
        return self._everything[: len(self._bodies)]

    def step(self, h: float) -> None:
        """Set the velocities of all bodies to `velocity`, and step by h seconds.

        The solver begins with the impulses of the step before, scaled by the ratio of the steps'
        lengths, but takes back the unscaled ones: a drive at its bound would push with
        F (2 h - h before), and impacts would be undone by half. So the impulses of contacts are
        scaled where they are kept, and the solver is told that both steps are equally long.
        """
        if h != self.last_step:
            self._scale_contacts(h / self.last_step)
            self.last_step = h
            for joints in self._joints:
                _renew(joints)
        self._misplaced.clear()
        lib.cpSpaceSetCurrentTimeStep(self._space._space, h)
        batch.set_space_bodies(self._space, _VELOCITY, self._velocity_buffer)
        self._space.step(h)

    def _scale_contacts(self, ratio: float) -> None:
        """Scale the impulses that the solver keeps of contacts."""
        for arbiter in self._space._get_arbiters():
            if arbiter.state in _IN_TOUCH:
                contacts = arbiter.contacts
                for k in range(arbiter.count):
                    contact = contacts[k]
                    contact.jnAcc *= ratio
                    contact.jtAcc *= ratio

    def misplace(self, which: Iterable[int]) -> None:
        """Note that these bodies, and no others, were moved since the last step.

        The next query finds them where they are.
        """
        self._misplaced = set(which)

    def misplace_all(self, state: Float) -> None:
        """Note the states (N, 6) of all bodies; the next query finds them there."""
        self._elsewhere = state

    def shared(self) -> tuple[dict[str, NDArray[Any]], dict[str, float]]:
        """Return the addresses of the engine's objects for the kernel, by its names."""
        arrays: dict[str, NDArray[Any]] = {
            "body": _addresses(body._body for body in self._bodies),
            "control": _addresses(body._body for body in self._controls),
            "pivot": _addresses(pivot.address for pivot, _ in self._drive_joints),
            "gear": _addresses(gear.address for _, gear in self._drive_joints),
        }
        numbers = [*range(len(self._bodies)), *(-1 - k for k in range(len(self._statics)))]
        address = _addresses(body._body for body in self._bodies + self._statics)
        order = np.argsort(address)
        arrays["address"] = address[order]
        arrays["name"] = np.array(numbers, dtype=np.int64)[order]
        arrays["friction"], arrays["restitution"] = self._surfaces.T.copy()
        arrays["wall_friction"], arrays["wall_restitution"] = self._wall_surfaces.T.copy()
        (space,) = _addresses([self._space._space]).tolist()
        return arrays, {
            "space": space, "bodies": len(numbers), "iterations": self._space.iterations,
            "slop": self._space.collision_slop,
        }  # fmt: skip

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
        batch.set_space_bodies(self._space, POSE, self._pose_buffer)
        for body in self._bodies:
            self._space.reindex_shapes_for_body(body)

    # -- what holds bodies ------------------------------------------------------------------

    def engage(self, i: int) -> None:
        """Let a robot's drive act through its joints, which begin anew."""
        for joint in self._drive_joints[i]:
            joint.renew()
            joint.add()

    def disengage(self, i: int) -> None:
        """Take a robot's joints out again."""
        for joint in self._drive_joints[i]:
            joint.remove()

    def effort(self, which: list[int]) -> Float:
        """Return the shares of their bounds that engaged drives used in the last step."""
        pairs = [self._drive_joints[i] for i in which]
        used = np.array([_impulse(joint.address) for pair in pairs for joint in pair])
        share = used.reshape(-1, 2) / (self._bounds[which] * self.last_step)
        return np.asarray(share.max(axis=1))

    def pull(self, i: int, x: float, y: float, torque: float) -> None:
        """Let a force (x, y) [N] and a torque [N m] act on a body in the next step."""
        self._bodies[i].force = x, y
        self._bodies[i].torque = torque

    def hold(self, i: int, force: float, torque: float) -> None:
        """Let the floor hold a body with a force [N] and a torque [N m] of friction."""
        if i not in self._floor_joints:
            self._floor_joints[i] = self._joint_pair(self._floor, self._bodies[i], force, torque)
            for joint in self._floor_joints[i]:
                joint.add()
        pivot, gear = self._floor_joints[i]
        pivot.set(max_force=force)
        gear.set(max_force=torque)

    def held(self, i: int) -> tuple[float, float]:
        """Return the force [N] and torque [N m] of the floor on a body in the last step."""
        if i not in self._floor_joints:
            return 0.0, 0.0
        pivot, gear = self._floor_joints[i]
        return _impulse(pivot.address) / self.last_step, _impulse(gear.address) / self.last_step

    def draw_in(self, k: int, speed: float) -> None:
        """Bound the speed at which rope k, if it is too long, is drawn in, m/s.

        A body that is drawn in keeps moving, which makes the rope slack.
        """
        self._joints[k][0].set(max_bias=speed)

    def renew(self, which: Index) -> None:
        """Let the drive joints or floor joints of some bodies begin anew.

        Robots among them are engaged. Do so before a step that is much shorter than the one before,
        since the solver begins with the impulses of joints in that.
        """
        for i in which.tolist():
            _renew(self._drive_joints[i] if i < self.robots else self._floor_joints.get(i, ()))

    # -- contacts ---------------------------------------------------------------------------

    def solved(self) -> Solved:
        """Return the contacts of the last step, with those that parted shortly before.

        Read the state after the step first.
        """
        buffer = self._arbiter_buffer
        buffer.clear()
        batch.get_space_arbiters(self._space, _ARBITER, buffer)
        whole = np.frombuffer(buffer.int_buf(), dtype=np.int64).reshape(-1, 3)
        values = np.frombuffer(buffer.float_buf()).reshape(-1, 12)
        place = self._identity.searchsorted(whole[:, :2])
        ends = values[:, 4:8]
        points = np.where(whole[:, 2:] > 1, (ends + values[:, 8:]) / 2, ends).reshape(-1, 2, 2)
        row = self._row[place]
        motion, arm = self.velocity[row], points - self._everything[row, :2]
        speed = motion[..., :2]
        speed[..., 0] -= motion[..., 2] * arm[..., 1]
        speed[..., 1] += motion[..., 2] * arm[..., 0]
        return Solved(
            bodies=self._name[place],
            impulse=values[:, 0:2].copy(),
            normal=values[:, 2:4].copy(),
            on_first=points[:, 0],
            on_second=points[:, 1],
            velocity=speed[:, 1] - speed[:, 0],
        )

    # -- what sensors ask -------------------------------------------------------------------

    @property
    def _seen(self) -> pymunk.Space:
        """The space, with all shapes where their bodies are."""
        if self._elsewhere is not None:
            self.place_all(self._elsewhere[:, :3])
            self._elsewhere = None
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
    """Return shapes in a fixed order in which neighbours lie far apart.

    The engine sorts shapes into a tree as they come. If neighbours follow one another, the tree is
    lopsided, and rays through it are up to twice as slow.
    """
    order = sorted(range(len(shapes)), key=lambda k: k * GOLDEN % 1.0)
    return [shapes[k] for k in order]


def _kinematic() -> pymunk.Body:
    return pymunk.Body(body_type=pymunk.Body.KINEMATIC)


def _static() -> pymunk.Body:
    return pymunk.Body(body_type=pymunk.Body.STATIC)


class _Constraint:
    """A joint of the engine that can begin anew.

    It does so in place, by the engine's own function. Making new objects of pymunk takes many times
    as long.
    """

    def __init__(
        self,
        space: pymunk.Space,
        kind: str,
        a: pymunk.Body,
        b: pymunk.Body,
        *numbers: Any,
        **settings: float,
    ) -> None:
        """Make one outside of the space. kind: its class in pymunk, which takes the numbers."""
        self._space, self._owner = space._space, getattr(pymunk, kind)(a, b, *numbers)
        self.address = self._owner._constraint
        itself = ffi.cast(f"cp{kind} *", self.address)
        self._make = partial(getattr(lib, f"cp{kind}Init"), itself, a._body, b._body, *numbers)
        self._settings: dict[str, float] = {}
        self.set(**settings)

    def set(self, **settings: float) -> None:
        """Set settings that all joints have, by their names in pymunk."""
        self._settings |= settings
        for name, value in settings.items():
            _SETTERS[name](self.address, value)

    def renew(self) -> None:
        """Let it begin as if it had held nothing yet; it must be outside of the space."""
        self._make()
        for name, value in self._settings.items():
            _SETTERS[name](self.address, value)

    def add(self) -> None:
        """Put it into the space."""
        lib.cpSpaceAddConstraint(self._space, self.address)

    def remove(self) -> None:
        """Take it out of the space."""
        lib.cpSpaceRemoveConstraint(self._space, self.address)


_impulse = lib.cpConstraintGetImpulse

_SETTERS = {
    "max_force": lib.cpConstraintSetMaxForce,
    "max_bias": lib.cpConstraintSetMaxBias,
    "error_bias": lib.cpConstraintSetErrorBias,
    "collide_bodies": lib.cpConstraintSetCollideBodies,
    "distance": lib.cpPinJointSetDist,
}

JointPair = tuple[_Constraint, _Constraint]
Maker = Callable[..., _Constraint]


def _renew(joints: Iterable[_Constraint]) -> None:
    """Let joints in the space begin anew; the engine walks them in this order."""
    for act in (_Constraint.remove, _Constraint.renew, _Constraint.add):
        for joint in joints:
            act(joint)


def _translated(
    attached: AttachedJoint, constraint: Constraint, make: Maker, a: pymunk.Body, b: pymunk.Body
) -> _Constraint:
    """Return the engine's joint for a constraint between bodies a and b."""
    ends = attached.joint.anchor_a, attached.joint.anchor_b
    still, turning, turned = a, b, attached.turned
    if attached.b < 0:  # it is a that turns against the world
        still, turning, turned = b, a, -turned
    match constraint:
        case MaxDistance(length=length):
            return make("SlideJoint", a, b, *ends, 0.0, length - TAUT, max_bias=0.0)
        case FixedDistance(length=length):
            return make("PinJoint", a, b, *ends, distance=length)
        case SpringDamper(length=length, stiffness=k, damping=c):
            return make("DampedSpring", a, b, *ends, length, k, c)
        case Pin():
            return make("PivotJoint", a, b, *ends)
        case TurningRange(least=least, largest=largest):
            return make("RotaryLimitJoint", still, turning, turned + least, turned + largest)
        case TurningSpring(stiffness=k, damping=c):
            return make("DampedRotarySpring", still, turning, -turned, k, c)
    raise TypeError(f"{constraint!r} is unknown to the physics")
