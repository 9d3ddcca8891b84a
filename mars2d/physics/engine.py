"""Contact physics: bodies moved exactly where nothing touches, by forces where something does.

A body that nothing can reach during the next step is *carried*: robots go to the ends of their arcs
and props glide, both in closed form, in one step of any length. A body that may touch something is
*near*. It is stepped finely: drive joints pull robots to their commands, floor joints hold props.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, sqrt

import numpy as np
from numpy.typing import NDArray

from mars2d.physics.collision import Bounds, Collisions
from mars2d.physics.drive_joints import DriveJoints, Driven
from mars2d.physics.floor import FloorJoints
from mars2d.physics.kernel import CONTACTS, EFFORT, PLACED, Kernel, reason_without
from mars2d.physics.motion import Motion, Start
from mars2d.physics.rope_limits import RopeLimits
from mars2d.physics.settings import (
    GROUP,
    GROUP_SLACK,
    GROWTH,
    ITERATIONS,
    ITERATIONS_JOINTS,
    ITERATIONS_UNEQUAL,
    MAX_GROUP_RATIO,
    PRESSED,
    SLACK,
    SLOP,
    STRETCH,
)
from mars2d.physics.space import Space
from mars2d.record.contact import CONTACT, ContactLog
from mars2d.scenario.scenario import Scenario

__all__ = ["Engine"]

Float = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

NOTHING = np.empty(0, dtype=CONTACT)
NOTHING.flags.writeable = False


def thrown(ratio: float) -> float:
    """Return the highest speed after a head-on impact without loss, in parts of both speeds before.

    ratio: the mass of the other body by its own, at least 1.
    """
    return (3 * ratio - 1) / (ratio + 1)


class Engine(Motion):
    """The motion of one world's bodies: robots first, then props."""

    def __init__(self, scenario: Scenario, start: Start | None = None) -> None:
        """Build robots, props, obstacles and, where `on_exit` is "wall", the workspace's walls.

        start: how all bodies move at first; by default, as the scenario says.
        """
        bodies = scenario.bodies
        self.n, self.count = len(scenario.robots), len(bodies)
        mass = self._mass = np.array([body.inertia.mass for body in bodies])
        thinnest = min(body.shape.thickness for body in bodies)
        unequal = mass.max() > 3 * mass.min()
        iterations = ITERATIONS_UNEQUAL if unequal else ITERATIONS
        if scenario.ties:
            iterations = ITERATIONS_JOINTS
        slop = min(SLOP, scenario.max_overlap / 4, thinnest / 32)
        self._pressed = PRESSED * slop
        self.space = Space(scenario, slop, iterations)
        self.bounds = Bounds(bodies, [s.outline for s in scenario.surfaces], scenario.joined)
        self._rope_limits = RopeLimits(scenario.ties, bodies) if scenario.ties else None
        self.contacts = ContactLog()

        self._drive_joints = DriveJoints(scenario, self.space)
        self._floor_joints = FloorJoints(scenario, self.space, self.bounds)
        self._set_accuracy(scenario, thinnest, iterations)
        self._slipping = np.zeros(self.count, dtype=bool)
        self._pulled = np.zeros(self.count, dtype=bool)
        self._pull = np.zeros((self.count, 3))  # N, N and N m
        self._state = self.space.read().copy()
        self._twist = np.zeros((3, self.n))
        if start is not None:
            self.space.place_all(start.state[:, :3])
            self._state[:], self._slipping[:], self._twist[:] = start
        self._kernel = self._compiled(scenario)
        self._left = 0  # of what the kernel did: contacts, efforts
        self._idle = np.zeros(self.n)
        self._idle.flags.writeable = False

    def _compiled(self, scenario: Scenario) -> Kernel | None:
        """Return the kernel if it can move this world, else None: then the plain engine does."""
        if scenario.props or scenario.ties or not self.bounds.only_centred_discs:
            return None
        if reason_without():
            return None
        ratio = float(self._mass.max() / self._mass.min())
        self._groups = self.n // GROUP if ratio <= MAX_GROUP_RATIO and self.n >= 2 * GROUP else 1
        slack = SLACK if self._groups == 1 else GROUP_SLACK * thrown(ratio)
        self._placed, self._reach = np.zeros(self.n, dtype=bool), np.zeros(self.n)
        arrays = {
            "state": self._state, "slipping": self._slipping, "placed": self._placed,
            "reach": self._reach, "pulled": self._pulled, "pull": self._pull,
        }  # fmt: skip
        numbers = {
            "n": self.n, "max_overlap": self._max_overlap, "entry": self._entry,
            "contact_step": self._contact_step, "pressed": self._pressed, "slack": slack,
            "growth": GROWTH, "last_step": self.space.last_step, "groups": self._groups,
        }  # fmt: skip
        for part in (self.bounds, self._drive_joints, self.space):
            more_arrays, more_numbers = part.shared()
            arrays |= more_arrays
            numbers |= more_numbers
        return Kernel(arrays, numbers)

    def _set_accuracy(self, scenario: Scenario, thinnest: float, iterations: int) -> None:
        """Work out the deepest entry in one substep, and the longest substep in contact."""
        self._max_overlap = scenario.max_overlap
        # A quarter of the overlap allowed is left to the slop and to what the solver leaves over.
        self._entry = min(0.75 * scenario.max_overlap, 0.125 * thinnest)
        # The depth under a force F settles at about F h^2 / (m iterations).
        force = self._drive_joints.force
        push = float(max((force / self._mass[: self.n]).max(), force.max() / self._mass.min()))
        self._depth_of_push = 0.15 * scenario.max_overlap * iterations
        self._contact_step = sqrt(self._depth_of_push / push)
        if self._rope_limits is not None:
            self._contact_step = min(self._contact_step, self._rope_limits.longest_step)

    def take_effort(self) -> Float:
        """Return the largest share of its bounds that each drive used since the last call, (n,)."""
        if self._kernel is not None and not self._left_over(EFFORT):
            return self._idle
        return self._drive_joints.take_effort()

    @property
    def velocity(self) -> Float:
        """The velocities (3, N) at this instant: x', y' [m/s], theta' [rad/s], as a new array."""
        velocity = super().velocity
        free = np.flatnonzero(~self._slipping[: self.n])  # the engine has chords of these
        arcs = self._drive_joints.arcs(self._twist).take(free)
        velocity[:, free] = arcs.chord(self._state[free, 2], 0.0).T
        return velocity

    # -- motion -----------------------------------------------------------------------------

    @property
    def motion(self) -> Start:
        """How all bodies move now: an engine that starts with it goes on from here."""
        state = self._state.copy()
        state[:, 3:] = self.velocity.T
        return Start(state, self._slipping.copy(), self._twist)

    def let_go(self) -> None:
        """End all pulls from outside."""
        self._pulled[:] = False

    def pull(self, body: int, force: tuple[float, float], torque: float) -> None:
        """Let a force (x, y) [N] and a torque [N m] act on a body from now on."""
        self._pull[body] = (*force, torque)
        self._pulled[body] = True
        self._state[body, 3:] = self.velocity[:, body]
        self._slipping[body] = True

    def step_under(self, acceleration: float) -> float:
        """Return how long a pull may act unchanged, seconds.

        Within this time it presses a body no deeper into another than drives do. acceleration: of
        the body by the pull, m/s^2, > 0.
        """
        return sqrt(self._depth_of_push / acceleration)

    def bears(self, body: int, force: float, torque: float) -> bool:
        """Return whether a body stays where it is held under a force [N] and torque [N m].

        A robot that follows its command is held by its drive, a prop at rest by the floor.
        """
        if self._slipping[body]:
            return False
        if body >= self.n:
            return self._floor_joints.bears(self._state[body, 3:], body, force, torque)
        drives = self._drive_joints
        share = max(force / drives.force[body], torque / drives.torque[body])
        if share > 1.0:
            return False
        drives.effort[body] = max(drives.effort[body], share)
        self._left |= EFFORT
        return True

    def drive(self, twist: Float, duration: float, time: float) -> None:
        """Move all bodies for `duration` seconds under constant twists (3, n) of the robots.

        time: at the start, seconds, for the contacts.
        """
        self._twist = twist
        if self._kernel is not None:
            self._drive_kernel(self._kernel, twist, duration, time)
            return
        self._arcs = self._drive_joints.arcs(twist)
        elapsed = 0.0
        while elapsed < duration:
            left = duration - elapsed
            gone = self._advance(twist, left, time + elapsed)
            elapsed = duration if gone == left else elapsed + gone

    def _drive_kernel(self, kernel: Kernel, twist: Float, duration: float, time: float) -> None:
        """Do the same with the kernel."""
        left = kernel.drive(twist, duration, time)
        self._left |= left
        if self._groups > 1:
            self.space.misplace_all(self._state)
        else:
            self.space.misplace(np.flatnonzero(self._placed).tolist() if left & PLACED else ())

    def take_contacts(self) -> NDArray[np.void]:
        """Return the contacts since the last call by time, one row (dtype CONTACT) per pair."""
        if self._kernel is None:
            return self.contacts.take()
        return self._kernel.take() if self._left_over(CONTACTS) else NOTHING

    def _left_over(self, what: int) -> bool:
        """Return whether the kernel has left something, and note that it is taken."""
        there = bool(self._left & what)
        self._left &= ~what
        return there

    def _advance(self, twist: Float, duration: float, time: float) -> float:
        """Go on by at most `duration` seconds, and return the seconds gone.

        They are fewer if a body was thrown further than was thought possible: then its neighbours
        have to be found anew.
        """
        self.bounds.clearance.measure(self.bounds.center(self._state))
        near, path = self._find_near(twist, duration)
        self._drive_joints.release(~near[: self.n])
        self._carry(~near, duration)
        if near.any():
            who = np.flatnonzero(near)
            robots = int(np.searchsorted(who, self.n))
            drives = Driven(self._drive_joints, self._arcs, who[:robots])
            collisions = self.bounds.collisions(who, path + self._max_overlap)
            group = _Near(who, robots, drives, collisions, self._slipping[who])
            gone = self._substeps(group, duration, time, path)
        else:
            gone = duration
            self.space.step(duration)
            self.contacts.add_nothing()
        self._arrive(~near, gone, duration)
        return gone

    def _carry(self, carried: Mask, duration: float) -> None:
        """Set the velocities that bring carried bodies to where they will be."""
        velocity, state, n = self.space.velocity, self._state, self.n
        velocity[:n] = self._arcs.chord(state[:n, 2], duration)
        if carried[n:].any():
            moved, _ = self._floor_joints.glide(state[n:], np.arange(n, self.count), duration)
            velocity[n : self.count] = moved / duration

    def _arrive(self, carried: Mask, gone: float, duration: float) -> None:
        """Read the state, and put carried bodies where they are after `gone` seconds."""
        before, n = self._state, self.n
        self._state = self.space.read().copy()
        if gone < duration:  # they were on the chord of a longer time
            who = np.flatnonzero(carried[:n])
            moved = gone * self._arcs.take(who).chord(before[who, 2], gone)
            for i, (dx, dy, _) in zip(who.tolist(), moved.tolist(), strict=True):
                self._put(i, before[i, 0] + dx, before[i, 1] + dy, None)
        if carried[n:].any():
            who = n + np.flatnonzero(carried[n:])
            moved, end = self._floor_joints.glide(before[who], who, gone)
            self._state[who, 3:] = end
            if gone < duration:
                after = (before[who, :3] + moved).tolist()
                for i, (x, y, theta) in zip(who.tolist(), after, strict=True):
                    self._put(i, x, y, theta)

    def _put(self, i: int, x: float, y: float, theta: float | None) -> None:
        self.space.place(i, x, y, theta)
        self._state[i, :2] = x, y
        if theta is not None:
            self._state[i, 2] = theta

    def _find_near(self, twist: Float, duration: float) -> tuple[Mask, float]:
        """Return which bodies may touch something, and the longest path that one of them may take.

        A body that is near may be pushed by the fastest of them, and so get near to others.
        """
        bounds, n = self.bounds, self.n
        now = bounds.top_speed(self._state[:, 3:])
        speed = now.copy()
        speed[:n] = bounds.top_speed(twist.T, slice(n))
        near = self._slipping.copy()
        if self._rope_limits is not None:
            near |= self._rope_limits.tied
        if near.any():
            speed = np.where(near, np.maximum(speed, now), speed)
        path, reach, count = 0.0, speed * duration, -1
        while int(near.sum()) != count:
            count = int(near.sum())
            if count:
                path = SLACK * float(speed[near].max()) * duration
                reach = np.where(near, path + self._max_overlap, speed * duration)
            near |= bounds.clearance.may_touch(reach)
        bounds.clearance.moved(reach)
        return near, path

    def _substeps(self, near: _Near, duration: float, time: float, path: float) -> float:
        """Step through `duration` as finely as the bodies near need; return the seconds gone.

        path: metres; it returns before one of them has gone further.
        """
        who, collisions = near.who, near.collisions
        everything = self._state
        gone = np.zeros(len(who))  # paths, metres
        elapsed = h = 0.0
        while True:
            collisions.measure(everything[who])
            if elapsed > 0:
                self._note_contacts(time + elapsed, h, collisions)
            if elapsed >= duration:
                break
            if collisions.any_touch:
                self._press(everything, collisions)
            left = duration - elapsed
            state = everything[who]
            velocity, h = self._look_ahead(near, everything, state, left)
            gone += h * self.bounds.top_speed(velocity, who)
            if elapsed > 0 and gone.max() > path:
                break
            self._aim(near, state, h)
            self.space.step(h)
            elapsed = duration if h == left else elapsed + h
            everything = self.space.read().copy()
            near.drives.note_effort(near.slipping[: near.robots])
        self._slipping[who] = near.slipping
        return elapsed

    def _press(self, everything: Float, collisions: Collisions) -> None:
        """Press bodies together that touch by a rounding error only, and would part by another.

        everything: (N, 6) states of all bodies, which are brought up to date.
        """
        for a, b, normal in collisions.grazing(self._pressed / 8):
            # Their common centre of mass stays where it is.
            share = 1.0 if b < 0 else self._mass[b] / (self._mass[a] + self._mass[b])
            for i, way in ((a, share * self._pressed), (b, (share - 1) * self._pressed)):
                if i >= 0:
                    everything[i, :2] += way * normal.real, way * normal.imag
                    self.space.place(i, *everything[i, :2].tolist())

    def _note_contacts(self, time: float, h: float, collisions: Collisions) -> None:
        if collisions.any_touch:
            self.contacts.add(time, h, self.space.solved(), collisions.touching_pairs())
        else:
            self.contacts.add_nothing()

    def _look_ahead(
        self, near: _Near, everything: Float, state: Float, left: float
    ) -> tuple[Float, float]:
        """Return the velocities (k, 3) of the bodies near, and the length of the next substep [s].

        It updates which of them slip. everything: (N, 6) states of all bodies; state: (k, 6) of
        those near. left: seconds until the end.
        """
        r, drives, slipping = near.robots, near.drives, near.slipping
        touching = near.collisions.touching()
        if self._rope_limits is not None:
            self._rope_limits.measure(everything)
            touching |= self._rope_limits.held()[near.who]
        touching |= self._pulled[near.who]
        h = left
        slipping |= touching
        if slipping.any():
            h = min(h, self._contact_step, GROWTH * self.space.last_step)
            h = min(h, drives.time_to_brake(state[:r], slipping[:r]))
            if (slipping[:r] & ~touching[:r]).any():
                slipping[:r] &= touching[:r] | drives.out_of_reach(state[:r], h)
            slipping[r:] = touching[r:]
        velocity, bend = drives.motion(state[:r], slipping[:r])
        if r < len(state):
            glides = self._floor_joints.motion(state[r:], slipping[r:], near.who[r:])
            velocity, bend = (np.concatenate([velocity, glides[0]]), np.append(bend, glides[1]))
        h = min(h, near.collisions.time_to_touch(velocity, bend, self._entry))
        if self._rope_limits is not None:
            h = min(h, self._time_to_jerk(velocity, bend, near.who))
        return velocity, left / ceil(
            left / h - 1e-9
        )  # equal substeps settle best, and leave no sliver

    def _time_to_jerk(self, velocity: Float, bend: Float, who: Index) -> float:
        """Return for how long no rope gets taut and longer; all bodies with joints are near."""
        assert self._rope_limits is not None
        all_velocity, all_bend = np.zeros((self.count, 3)), np.zeros(self.count)
        all_velocity[who], all_bend[who] = velocity, bend
        return self._rope_limits.time_to_jerk(all_velocity, all_bend, STRETCH * self._entry)

    def _aim(self, near: _Near, state: Float, h: float) -> None:
        """Prepare the bodies near, with states (k, 6), for a substep of h seconds."""
        r, slipping = near.robots, near.slipping
        near.drives.aim(state[:r], slipping[:r], h, brief=h <= self._contact_step)
        if r < len(state):
            self._floor_joints.aim(state[r:], slipping[r:], near.who[r:], h)
        if GROWTH * h < self.space.last_step and slipping.any():
            self.space.renew(near.who[slipping])
        for i in near.who[self._pulled[near.who]].tolist():
            self.space.pull(i, *self._pull[i].tolist())
        if self._rope_limits is not None:
            for rope, speed in self._rope_limits.drift(h):
                self.space.draw_in(rope, speed)


@dataclass
class _Near:
    """The bodies that may touch something, while they are stepped finely.

    who: (k,) their numbers; first the robots, `robots` of them, which `drives` move, then props.
    collisions: what they may touch. slipping: (k,) which do not follow their commands now.
    """

    who: Index
    robots: int
    drives: Driven
    collisions: Collisions
    slipping: Mask
