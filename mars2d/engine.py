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

from collections.abc import Iterator, Sequence
from math import cos, inf, sin, sqrt

import numpy as np
import pymunk
from numpy.typing import NDArray
from pymunk import batch

from mars2d.clearance import Clearance, Float, Index, Mask
from mars2d.contact import ContactLog
from mars2d.geometry import Outline, edges_of, point_segment_distance
from mars2d.scenario import Scenario

__all__ = ["Engine"]

SLOP = 1e-4
"""The overlap that the solver leaves in steady contact, metres."""

ITERATIONS = 15
ITERATIONS_UNEQUAL = 20  # with masses more than three times apart

GROWTH = 2.0
"""How much longer a substep may be than the one before, while impulses are carried over from it."""

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
        self.space.collision_slop = min(SLOP, scenario.max_overlap / 4)
        masses = np.array([robot.mass for robot in robots])
        unequal = masses.max() > 3 * masses.min()
        self.space.iterations = ITERATIONS_UNEQUAL if unequal else ITERATIONS

        self._radius = np.array([robot.radius for robot in robots])
        self._offset = np.array([robot.center_offset for robot in robots])
        self._in_robot_frame = np.array([robot.drive.frame == "robot" for robot in robots])
        self._bodies = [self._add_robot(scenario, i) for i in range(self.n)]
        self._add_controls(scenario)
        self.obstacles, self._segments = self._add_obstacles(scenario)

        # The order of the batch: robots, their control bodies, then the static bodies.
        count = 2 * self.n + len(self.obstacles)
        self._state_buffer = batch.Buffer()
        self._velocity = np.zeros((count, 3))
        self._velocity_buffer = batch.Buffer()
        self._velocity_buffer.set_float_buf(self._velocity)

        self._engaged = np.zeros(self.n, dtype=bool)
        self._slipping = np.zeros(self.n, dtype=bool)
        self._clearance = Clearance(self._radius, self._segments[:, :4])
        self._contacts = ContactLog(len(self.obstacles))
        self._arbiter_buffer = batch.Buffer()
        # The engine names bodies by their addresses; robots are 0, 1, ..., obstacles -1, -2, ...
        named = [(body.id, i) for i, body in enumerate(self._bodies)]
        named += [(body.id, -1 - k) for k, body in enumerate(self._statics)]
        self._address, self._name = np.array(sorted(named), dtype=np.int64).T
        self._restitution = max(robot.restitution for robot in robots)
        self._set_accuracy(scenario)
        self._last_step = inf
        self._read()

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
        surfaces = [
            (outline, addon.friction, addon.restitution)
            for addon in scenario.addons
            for outline in addon.obstacles()
        ]
        if scenario.on_exit == "wall" and scenario.workspace is not None:
            surfaces.append((scenario.workspace, 1.0, 1.0))
        self._statics = []
        edges: list[tuple[float, ...]] = []
        for k, (outline, friction, restitution) in enumerate(surfaces):
            body = pymunk.Body(body_type=pymunk.Body.STATIC)
            self.space.add(body)
            self._statics.append(body)
            for a, b in edges_of(outline):
                segment = pymunk.Segment(body, a, b, 0.0)
                segment.friction, segment.elasticity = friction, restitution
                self.space.add(segment)
                edges.append((*a, *b, k))
        return tuple(s[0] for s in surfaces), np.array(edges).reshape(-1, 5)

    def _set_accuracy(self, scenario: Scenario) -> None:
        """Work out how deep a body may enter in one substep, and how long one in contact may be."""
        robots = scenario.robots
        # A fifth of the overlap allowed is left to the slop and to what the solver leaves over.
        self._entry = min(0.75 * scenario.max_overlap, 0.25 * float(self._radius.min()))
        self._mass = np.array([robot.mass for robot in robots])
        self._moment = np.array([body.moment for body in self._bodies])
        self._max_force = np.array([robot.drive.max_force for robot in robots])
        self._max_torque = np.array([robot.drive.max_torque for robot in robots])
        # The depth under a force F settles at about F h^2 / (m iterations).
        push = float((self._max_force / self._mass).max())
        self._contact_step = sqrt(0.15 * scenario.max_overlap * self.space.iterations / push)

    # -- state ------------------------------------------------------------------------------

    def _read(self) -> None:
        """Read positions, angles and velocities of all bodies, in one call."""
        buffer = self._state_buffer
        buffer.clear()
        batch.get_space_bodies(self.space, _STATE, buffer)
        state = np.frombuffer(buffer.float_buf(), dtype=np.float64)
        self._state = state[: 6 * self.n].reshape(self.n, 6).copy()

    @property
    def pose(self) -> Float:
        """The poses (3, n): x, y [m], theta [rad], as a new array."""
        return np.ascontiguousarray(self._state[:, :3].T)

    @property
    def velocity(self) -> Float:
        """The velocities (3, n): x', y' [m/s], theta' [rad/s], as a new array."""
        return np.ascontiguousarray(self._state[:, 3:].T)

    def _centers(self) -> Float:
        """Return the geometric centres (n, 2)."""
        x, y, theta = self._state[:, 0], self._state[:, 1], self._state[:, 2]
        if not self._offset.any():
            return self._state[:, :2]
        return np.column_stack([x - self._offset * np.cos(theta), y - self._offset * np.sin(theta)])

    # -- motion -----------------------------------------------------------------------------

    def drive(self, twist: Float, duration: float, time: float) -> None:
        """Move everything for `duration` seconds, the robots driven by constant twists (3, n).

        time: that of the start, seconds, for the contacts.
        """
        near, reach = self._find_near(twist, duration)
        self._engage(near)
        self._velocity[: self.n] = _chord_velocity(
            twist, self._state[:, 2], duration, self._in_robot_frame
        )
        if near.any():
            self._substeps(twist, duration, time, near, reach)
        else:
            batch.set_space_bodies(self.space, _VELOCITY, self._velocity_buffer)
            self.space.step(duration)
            self._last_step = duration
            self._read()

    def _find_near(self, twist: Float, duration: float) -> tuple[Mask, float]:
        """Return which robots may touch something, and how far one of them may move.

        One that is near may be pushed by the quickest of them, and so be near to others.
        """
        linear = np.hypot(twist[0], twist[1])
        speed = linear + np.abs(self._offset * twist[2])
        if self._slipping.any():
            speed = np.where(self._slipping, np.maximum(speed, self._actual_speed()), speed)
        near = self._slipping.copy()
        reach = speed * duration
        count = -1
        while np.count_nonzero(near) != count:
            count = np.count_nonzero(near)
            near |= self._clearance.may_touch(self._centers(), reach)
            if near.any():
                pushed = speed[near].max() * (1 + self._restitution)
                reach = np.where(near, pushed * duration, speed * duration)
        self._clearance.moved(reach)
        return near, float(reach[near].max()) if count else 0.0

    def _engage(self, near: Mask) -> None:
        """Add the joints of those that are near, remove those of the others."""
        for i in np.flatnonzero(near & ~self._engaged):
            self.space.add(*self._joints[i])
        for i in np.flatnonzero(self._engaged & ~near):
            self.space.remove(*self._joints[i])
        self._engaged = near

    def _substeps(
        self, twist: Float, duration: float, time: float, near: Mask, reach: float
    ) -> None:
        """Step through `duration` as finely as the gaps between those that are near ask for."""
        centers = self._centers()
        i, j = self._clearance.close_pairs(centers, near, 2 * reach)
        apart = self._radius[i] + self._radius[j]
        disc, segment = self._clearance.close_walls(centers, near, reach)
        wall, outline = self._segments[segment, :4], self._segments[segment, 4].astype(np.int64)
        who = np.flatnonzero(near)
        commanded = np.hypot(twist[0], twist[1]) + np.abs(self._offset * twist[2])
        elapsed = 0.0
        while True:
            centers = self._centers()
            gap = np.hypot(*(centers[i] - centers[j]).T) - apart
            wall_gap = (
                point_segment_distance(centers[disc, 0], centers[disc, 1], wall)
                - self._radius[disc]
            )
            hit, wall_hit = gap <= 0, wall_gap <= 0
            touching = np.zeros(self.n, dtype=bool)
            touching[i[hit]] = touching[j[hit]] = touching[disc[wall_hit]] = True
            if elapsed > 0 and touching.any():
                pairs = (i[hit], j[hit]), (disc[wall_hit], -1 - outline[wall_hit])
                self._read_contacts(time + elapsed, pairs)
            if elapsed >= duration:
                return
            left = duration - elapsed
            h = self._recover(twist, touching, left)
            speed = np.where(self._slipping, self._actual_speed(), commanded)
            h = min(h, self._time_to_touch(gap, speed[i] + speed[j]))
            h = min(h, self._time_to_touch(wall_gap, speed[disc]))
            if self._slipping.any():
                h = min(h, GROWTH * self._last_step)
            if h < left < 2 * h:
                h = left / 2  # rather than a sliver at the end
            self._aim(twist, who, h)
            self.space.step(h)
            self._last_step = h
            elapsed = duration if h == left else elapsed + h
            self._read()

    def _actual_speed(self) -> Float:
        """Return how fast each disc's centre may be moving, (n,) m/s."""
        _, _, _, vx, vy, spin = self._state.T
        return np.asarray(np.hypot(vx, vy) + np.abs(self._offset * spin))

    def _recover(self, twist: Float, touching: Mask, h: float) -> float:
        """Find out which robots slip, and return how long the next substep may be for them.

        Who touches something slips. Who no longer does slips until its drive has the force to
        bring it back to its command within one substep.
        """
        self._slipping |= touching
        if not self._slipping.any():
            return h
        h = min(h, self._contact_step)
        wanted = _chord_velocity(twist, self._state[:, 2], h, self._in_robot_frame)
        error = self._state[:, 3:] - wanted
        in_reach = np.hypot(error[:, 0], error[:, 1]) * self._mass <= self._max_force * h
        in_reach &= np.abs(error[:, 2]) * self._moment <= self._max_torque * h
        self._slipping &= touching | ~in_reach
        return h

    def _time_to_touch(self, gap: Float, closing: Float) -> float:
        """Return how long all stay less deep than the entry allowed, those that are apart."""
        apart = (gap > 0) & (closing > 0)
        if not apart.any():
            return inf
        return float(((gap[apart] + self._entry) / closing[apart]).min())

    def _aim(self, twist: Float, who: Index, h: float) -> None:
        """Set the velocities of the robots `who` and of their control bodies for a substep of h.

        The engine moves bodies by the velocities that they have, then the joints work towards the
        control bodies': so these get the velocities of the substep after this one.
        """
        twist, turns = twist[:, who], self._in_robot_frame[who]
        theta, slipping = self._state[who, 2], self._slipping[who]
        now = _chord_velocity(twist, theta, h, turns)
        now[slipping] = self._state[who[slipping], 3:]
        self._velocity[who] = now
        self._velocity[self.n + who] = _chord_velocity(twist, theta + now[:, 2] * h, h, turns)
        batch.set_space_bodies(self.space, _VELOCITY, self._velocity_buffer)

    # -- contacts ---------------------------------------------------------------------------

    def _read_contacts(self, time: float, pairs: Sequence[tuple[Index, Index]]) -> None:
        """Read the solver's contacts of the last substep, of those pairs that do touch.

        The solver also lists pairs for up to two steps after they parted.
        """
        buffer = self._arbiter_buffer
        buffer.clear()
        batch.get_space_arbiters(self.space, _ARBITER, buffer)
        ids = np.frombuffer(buffer.int_buf(), dtype=np.int64).reshape(-1, 2)
        values = np.frombuffer(buffer.float_buf(), dtype=np.float64).reshape(-1, 8)
        a, b = self._name[np.searchsorted(self._address, ids)].T
        swap = (a < 0) | ((b >= 0) & (b < a))
        first, second = np.where(swap, b, a), np.where(swap, a, b)
        key = self._contacts.key
        live = np.isin(key(first, second), np.concatenate([key(p, q) for p, q in pairs]))
        sign = np.where(swap, -1.0, 1.0)[:, None]
        impulse, normal = values[:, 0:2] * sign, values[:, 2:4] * sign
        point = np.where(swap[:, None], values[:, 6:8], values[:, 4:6])
        self._contacts.add(
            time, first[live], second[live], point[live], normal[live], impulse[live]
        )

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


def _chord_velocity(twist: Float, theta: Float, h: float, in_robot_frame: Mask) -> Float:
    """Return (k, 3): the velocities that bring robots at headings (k,) along their arcs in h.

    twist: (3, k), of which the first two are along the robot's axes or the world's.
    """
    forward, left, spin = twist
    half = spin * (h / 2)
    direction = np.where(in_robot_frame, theta + half, 0.0)
    shrink = np.where(in_robot_frame, np.sinc(half / np.pi), 1.0)
    c, s = shrink * np.cos(direction), shrink * np.sin(direction)
    return np.column_stack([forward * c - left * s, forward * s + left * c, spin])
