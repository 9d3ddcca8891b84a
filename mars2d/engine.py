"""The physics: one pymunk Space, its robots and obstacles, moved exactly where nothing touches.

A robot is a dynamic body. What its drive asks for is put to it in one of two ways:

- A robot that nothing can reach during the time to come is *carried*: its velocity is that of the
  chord of its arc, and one step of any length brings it to the exact pose.
- A robot that may touch something is *engaged*: a kinematic control body pulls it through a
  PivotJoint and a GearJoint of bounded force and torque. As long as it does follow, it is primed
  with the chord's velocity each substep, so that it is exact too. When contact has thrown it off,
  it *slips*: its velocity is left to the solver until the drive's force has brought it back.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, inf, sin, sqrt

import numpy as np
import pymunk
from numpy.typing import NDArray
from pymunk import batch

from mars2d.clearance import Clearance, Complex, Encounter, Float, Index, Mask
from mars2d.contact import ContactLog
from mars2d.geometry import Outline, edges_of
from mars2d.scenario import Scenario

__all__ = ["Engine"]

SLOP = 1e-4
"""The overlap that the solver leaves in steady contact, metres."""

ITERATIONS = 15
ITERATIONS_UNEQUAL = 20  # with masses more than three times apart

SLACK = 1.25
"""How much further than at its present speed a robot may be thrown before gaps are asked anew."""

GROWTH = 2.0
"""How much longer a substep may be than the one before, while impulses are carried over from it.

The solver scales them by the ratio of the two. That is right for those of steady forces, but after
an impact it would throw the robots back: then the next substep must be no longer.
"""

_STATE = (
    batch.BodyFields.POSITION
    | batch.BodyFields.ANGLE
    | batch.BodyFields.VELOCITY
    | batch.BodyFields.ANGULAR_VELOCITY
)
_ARBITER = (
    batch.ArbiterFields.BODY_A_ID
    | batch.ArbiterFields.BODY_B_ID
    | batch.ArbiterFields.TOTAL_IMPULSE
    | batch.ArbiterFields.NORMAL
    | batch.ArbiterFields.POINT_A_1
    | batch.ArbiterFields.POINT_B_1
)
_VELOCITY = batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY


class Engine:
    """The bodies of one world. No other part of the package holds pymunk objects."""

    def __init__(self, scenario: Scenario) -> None:
        """Build robots, obstacles and, where `on_exit` is "wall", the workspace's walls."""
        robots = scenario.robots
        self.n = len(robots)
        self.space = pymunk.Space()
        smallest = min(robot.radius for robot in robots)
        self.space.collision_slop = min(SLOP, scenario.max_overlap / 4, smallest / 16)
        self._mass = np.array([robot.mass for robot in robots])
        unequal = self._mass.max() > 3 * self._mass.min()
        self.space.iterations = ITERATIONS_UNEQUAL if unequal else ITERATIONS

        self._radius = np.array([robot.radius for robot in robots])
        self._offset = np.array([robot.center_offset for robot in robots])
        self._in_robot_frame = np.array([robot.drive.frame == "robot" for robot in robots])
        self._bodies = [self._add_robot(scenario, i) for i in range(self.n)]
        self._add_controls(scenario)
        self.obstacles, segments = self._add_obstacles(scenario)

        # The order of the batch: robots, their control bodies, then the static bodies.
        count = 2 * self.n + len(self.obstacles)
        self._state_buffer = batch.Buffer()
        self._velocity = np.zeros((count, 3))
        self._velocity_buffer = batch.Buffer()
        self._velocity_buffer.set_float_buf(self._velocity)

        self._engaged = np.zeros(self.n, dtype=bool)
        self._slipping = np.zeros(self.n, dtype=bool)
        x1, y1, x2, y2, outline = segments.T
        start = x1 + 1j * y1
        self._clearance = Clearance(self._radius, start, x2 + 1j * y2 - start)
        self._contacts = ContactLog(outline.astype(np.int64))
        self._arbiter_buffer = batch.Buffer()
        # The engine names bodies by their addresses; robots are 0, 1, ..., obstacles -1, -2, ...
        named = [(body.id, i) for i, body in enumerate(self._bodies)]
        named += [(body.id, -1 - k) for k, body in enumerate(self._statics)]
        self._address, self._name = np.array(sorted(named), dtype=np.int64).T
        self._set_accuracy(scenario)
        self._last_step = inf
        self._hit = np.zeros(self.n, dtype=bool)  # in the last step
        self._state = self._read().copy()

    def _add_robot(self, scenario: Scenario, i: int) -> pymunk.Body:
        robot = scenario.robots[i]
        moment = robot.mass * (robot.radius**2 / 2 + robot.center_offset**2)
        body = pymunk.Body(robot.mass, moment)
        x, y, theta = robot.pose
        body.position, body.angle = (x, y), theta
        disc = pymunk.Circle(body, robot.radius, (-robot.center_offset, 0.0))
        disc.friction, disc.elasticity = robot.friction, robot.restitution
        disc.filter = pymunk.ShapeFilter(group=i + 1)  # a robot's rays do not see its own disc
        self.space.add(body, disc)
        return body

    def _add_controls(self, scenario: Scenario) -> None:
        """Give each robot its control body, and the joints that are added while it is engaged."""
        self._joints = []
        for robot, body in zip(scenario.robots, self._bodies, strict=True):
            control = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
            self.space.add(control)
            pivot = pymunk.PivotJoint(control, body, (0.0, 0.0), (0.0, 0.0))
            gear = pymunk.GearJoint(control, body, 0.0, 1.0)
            pivot.max_bias = gear.max_bias = 0.0
            pivot.max_force, gear.max_force = robot.drive.max_force, robot.drive.max_torque
            self._joints.append((pivot, gear))

    def _add_obstacles(self, scenario: Scenario) -> tuple[tuple[Outline, ...], Float]:
        """Return the outlines, and their edges (S, 5) = x1, y1, x2, y2, index of the outline."""
        self._statics = []
        edges: list[tuple[float, ...]] = []
        for k, (outline, friction, restitution) in enumerate(scenario.surfaces):
            body = pymunk.Body(body_type=pymunk.Body.STATIC)
            self.space.add(body)
            self._statics.append(body)
            for a, b in edges_of(outline):
                segment = pymunk.Segment(body, a, b, 0.0)
                segment.friction, segment.elasticity = friction, restitution
                self.space.add(segment)
                edges.append((*a, *b, k))
        return tuple(s.outline for s in scenario.surfaces), np.array(edges).reshape(-1, 5)

    def _set_accuracy(self, scenario: Scenario) -> None:
        """Work out how deep a body may enter in one substep, and how long one in contact may be."""
        robots = scenario.robots
        self._max_overlap = scenario.max_overlap
        # A quarter of the overlap allowed is left to the slop and to what the solver leaves over.
        self._entry = min(0.75 * scenario.max_overlap, 0.25 * float(self._radius.min()))
        self._moment = np.array([body.moment for body in self._bodies])
        self._max_force = np.array([robot.drive.max_force for robot in robots])
        self._max_torque = np.array([robot.drive.max_torque for robot in robots])
        # The depth under a force F settles at about F h^2 / (m iterations).
        push = float((self._max_force / self._mass).max())
        self._contact_step = sqrt(0.15 * scenario.max_overlap * self.space.iterations / push)

    # -- state ------------------------------------------------------------------------------

    def _read(self) -> Float:
        """Read (n, 6): x, y, theta, x', y', theta' of all robots, in one call.

        The array is the engine's own memory, and changes with the next step.
        """
        buffer = self._state_buffer
        buffer.clear()
        batch.get_space_bodies(self.space, _STATE, buffer)
        state = np.frombuffer(buffer.float_buf(), dtype=np.float64, count=6 * self.n)
        return state.reshape(self.n, 6)

    @property
    def pose(self) -> Float:
        """The poses (3, n): x, y [m], theta [rad], as a new array."""
        return self._state[:, :3].T.copy()

    @property
    def velocity(self) -> Float:
        """The velocities (3, n): x', y' [m/s], theta' [rad/s], as a new array."""
        return self._state[:, 3:].T.copy()

    # -- motion -----------------------------------------------------------------------------

    def drive(self, twist: Float, duration: float, time: float) -> None:
        """Move everything for `duration` seconds, the robots driven by constant twists (3, n).

        time: that of the start, seconds, for the contacts.
        """
        elapsed = 0.0
        while elapsed < duration:
            left = duration - elapsed
            gone = self._advance(twist, left, time + elapsed)
            elapsed = duration if gone == left else elapsed + gone

    def _advance(self, twist: Float, duration: float, time: float) -> float:
        """Go on by at most `duration` seconds, and return by how much.

        It is less when a robot has been thrown further than was thought possible: then it is to be
        asked anew what it may touch.
        """
        center = _center(self._state, self._offset)
        near, path = self._find_near(twist, center, duration)
        self._engage(near)
        self._hit &= near
        carried = chord_velocity(twist, self._state[:, 2], duration, self._in_robot_frame)
        self._velocity[: self.n] = carried
        if near.any():
            who = np.flatnonzero(near)
            encounter = self._clearance.encounter(center, who, path + self._max_overlap)
            gone = self._substeps(twist[:, who], duration, time, who, encounter, path)
            if gone < duration:
                self._put_on_arc(twist, np.flatnonzero(~near), gone)
        else:
            gone = duration
            self._step(duration)
            self._hit[:] = False
        self._state = self._read().copy()
        return gone

    def _find_near(self, twist: Float, center: Complex, duration: float) -> tuple[Mask, float]:
        """Return which robots may touch something, and the longest path that one may take.

        One that is near may be pushed by the quickest of them, and so be near to others.
        """
        speed = np.hypot(twist[0], twist[1]) + np.abs(self._offset * twist[2])
        near = self._slipping.copy()
        if near.any():
            speed = np.where(near, np.maximum(speed, _top_speed(self._state, self._offset)), speed)
        path, reach, count = 0.0, speed * duration, -1
        while int(near.sum()) != count:
            count = int(near.sum())
            near |= self._clearance.may_touch(center, reach)
            if near.any():
                path = SLACK * float(speed[near].max()) * duration
                reach = np.where(near, path + self._max_overlap, speed * duration)
        self._clearance.moved(reach)
        return near, path

    def _put_on_arc(self, twist: Float, who: Index, h: float) -> None:
        """Put robots, which were on the chord of a longer time, where their arcs lead in h."""
        theta, turns = self._state[who, 2], self._in_robot_frame[who]
        moved = h * chord_velocity(twist[:, who], theta, h, turns)
        for i, (x, y) in zip(who, (self._state[who, :2] + moved[:, :2]).tolist(), strict=True):
            self._bodies[i].position = x, y

    def _engage(self, near: Mask) -> None:
        """Add the joints of those that are near, remove those of the others."""
        for i in np.flatnonzero(near & ~self._engaged):
            self.space.add(*self._joints[i])
        for i in np.flatnonzero(self._engaged & ~near):
            self.space.remove(*self._joints[i])
        self._engaged = near

    def _step(self, h: float) -> None:
        """Give all bodies their velocities and let the engine go on by h seconds."""
        batch.set_space_bodies(self.space, _VELOCITY, self._velocity_buffer)
        self.space.step(h)
        self._last_step = h

    def _substeps(
        self,
        twist: Float,
        duration: float,
        time: float,
        who: Index,
        encounter: Encounter,
        path: float,
    ) -> float:
        """Step through `duration` as finely as those need that are near something.

        twist: (3, k) of the robots `who`, (k,) indices. path: metres; before one of them has gone
        further, this returns. Returns the seconds gone.
        """
        offset, slipping = self._offset[who], self._slipping[who]
        state = self._state[who]
        gone = np.zeros(len(who))  # paths, metres
        elapsed = 0.0
        while True:
            encounter.measure(_center(state, offset))
            touching = encounter.touching()
            if elapsed > 0 and encounter.any_touch:
                self._note_contacts(time + elapsed, who, encounter)
            if elapsed >= duration:
                self._slipping[who] = slipping
                return elapsed
            left = h = duration - elapsed
            slipping |= touching
            some_slip = bool(slipping.any())
            if some_slip:
                h = min(h, self._contact_step, GROWTH * self._last_step)
                slipping &= touching | self._out_of_reach(twist, state, h, who)
            velocity, bend, speed = self._motion(twist, state, slipping, who)
            h = min(h, encounter.time_to_touch(velocity, bend, self._entry))
            if h < left < 2 * h:
                h = left / 2  # rather than a sliver at the end
            gone += h * speed
            if elapsed > 0 and gone.max() > path:
                self._slipping[who] = slipping
                return elapsed
            self._aim(twist, state, slipping, who, h)
            if h != self._last_step:
                self._forget_impacts()
            self._step(h)
            elapsed = duration if h == left else elapsed + h
            state = self._read()[who]
            self._hit[who] = self._were_hit(state, who, h)

    def _motion(
        self, twist: Float, state: Float, slipping: Mask, who: Index
    ) -> tuple[Complex, Float, Float]:
        """Return how discs' centres move now, how quickly that may turn [m/s^2], and top speeds."""
        offset, turns = self._offset[who], self._in_robot_frame[who]
        tangent = chord_velocity(twist, state[:, 2], 0.0, turns)
        moving = np.hstack([state[:, :3], np.where(slipping[:, None], state[:, 3:], tangent)])
        bend = np.abs(offset) * moving[:, 5] ** 2
        follows = turns & ~slipping
        bend[follows] += np.abs(np.hypot(twist[0], twist[1]) * twist[2])[follows]
        return _center_velocity(moving, offset), bend, _top_speed(moving, offset)

    def _were_hit(self, state: Float, who: Index, h: float) -> Mask:
        """Return whose velocities the last substep changed by more than their drives can."""
        change = np.hypot(*(state[:, 3:5] - self._velocity[who, :2]).T)
        return np.asarray(change * self._mass[who] > 1.01 * self._max_force[who] * h)

    def _forget_impacts(self) -> None:
        """Make the solver forget the impulses of an impact in the last substep.

        It would begin with them again, scaled by the ratio of the substeps' lengths, and could take
        back only the unscaled part: robots would bounce, or stick, for no reason.
        """
        for i in np.flatnonzero(self._hit):
            for disc in self._bodies[i].shapes:
                self.space.remove(disc)
                self.space.add(disc)

    def _out_of_reach(self, twist: Float, state: Float, h: float, who: Index) -> Mask:
        """Return which robots their drives can't bring back to their commands within h."""
        wanted = chord_velocity(twist, state[:, 2], h, self._in_robot_frame[who])
        error = np.abs(state[:, 3:] - wanted)
        impulse = np.hypot(error[:, 0], error[:, 1]) * self._mass[who]
        slow = impulse > self._max_force[who] * h
        return np.asarray(slow | (error[:, 2] * self._moment[who] > self._max_torque[who] * h))

    def _aim(self, twist: Float, state: Float, slipping: Mask, who: Index, h: float) -> None:
        """Set the velocities of the robots `who` and of their control bodies for a substep of h.

        The engine moves bodies by the velocities that they have, then the joints work towards the
        control bodies': so these get the velocities of the substep after this one.
        """
        turns = self._in_robot_frame[who]
        now = chord_velocity(twist, state[:, 2], h, turns)
        now[slipping] = state[slipping, 3:]
        self._velocity[who] = now
        self._velocity[self.n + who] = chord_velocity(twist, state[:, 2] + now[:, 2] * h, h, turns)

    # -- contacts ---------------------------------------------------------------------------

    def _note_contacts(self, time: float, who: Index, encounter: Encounter) -> None:
        """Note the solver's contacts of the last substep, and which pairs do touch.

        The solver also lists pairs for up to two steps after they parted.
        """
        buffer = self._arbiter_buffer
        buffer.clear()
        batch.get_space_arbiters(self.space, _ARBITER, buffer)
        ids = np.frombuffer(buffer.int_buf(), dtype=np.int64).reshape(-1, 2)
        values = np.frombuffer(buffer.float_buf(), dtype=np.float64).reshape(-1, 8)
        bodies = self._name[np.searchsorted(self._address, ids)]
        self._contacts.add(time, bodies, values.copy(), encounter.touching_pairs(who))

    def take_contacts(self) -> NDArray[np.void]:
        """Return the contacts since the last call, one row (dtype CONTACT) a pair."""
        return self._contacts.take()

    # -- what sensors ask -------------------------------------------------------------------

    def distance(self, point: tuple[float, float], limit: float, ignore: int) -> float:
        """Return the distance to the nearest surface, inf beyond `limit`; see Surroundings."""
        own = pymunk.ShapeFilter(group=ignore + 1)
        info = self.space.point_query_nearest(point, limit, own)
        return inf if info is None else info.distance

    def nearby(
        self, point: tuple[float, float], limit: float, ignore: int
    ) -> Iterator[tuple[float, float]]:
        """Yield the nearest point of each surface within `limit`; see Surroundings."""
        own = pymunk.ShapeFilter(group=ignore + 1)
        for info in self.space.point_query(point, limit, own):
            yield info.point.x, info.point.y

    def ray(self, start: tuple[float, float], angle: float, length: float, ignore: int) -> float:
        """Return how far a ray goes, inf when nothing is hit; see Surroundings."""
        end = start[0] + length * cos(angle), start[1] + length * sin(angle)
        own = pymunk.ShapeFilter(group=ignore + 1)
        info = self.space.segment_query_first(start, end, 0.0, own)
        return inf if info is None else info.alpha * length


def chord_velocity(twist: Float, theta: Float, h: float, in_robot_frame: Mask) -> Float:
    """Return (k, 3): the velocities that bring robots at headings (k,) along their arcs in h.

    twist: (3, k), of which the first two are along the robot's axes or the world's.
    Source: the arc of radius v / omega seen as its chord, of length v h sinc(omega h / 2) in the
    direction theta + omega h / 2.
    """
    forward, left, spin = twist
    half = np.where(in_robot_frame, spin * (h / 2), 0.0)
    turned = np.where(in_robot_frame, theta + half, 0.0)
    shrink = np.where(half == 0.0, 1.0, np.sin(half) / np.where(half == 0.0, 1.0, half))
    c, s = shrink * np.cos(turned), shrink * np.sin(turned)
    velocity = np.empty((len(theta), 3))
    velocity[:, 0] = forward * c - left * s
    velocity[:, 1] = forward * s + left * c
    velocity[:, 2] = spin
    return velocity


def _center(state: Float, offset: Float) -> Complex:
    """Return the geometric centres of robots with states (k, 6), as x + i y."""
    center = state[:, 0] + 1j * state[:, 1]
    if offset.any():
        center -= offset * np.exp(1j * state[:, 2])
    return center


def _center_velocity(state: Float, offset: Float) -> Complex:
    """Return the velocities of the geometric centres, as x' + i y'."""
    velocity = state[:, 3] + 1j * state[:, 4]
    if offset.any():
        velocity -= 1j * offset * state[:, 5] * np.exp(1j * state[:, 2])
    return velocity


def _top_speed(state: Float, offset: Float) -> Float:
    """Return how fast the geometric centres may be while bodies go on as they do, m/s."""
    return np.asarray(np.hypot(state[:, 3], state[:, 4]) + np.abs(offset * state[:, 5]))
