"""Contact physics: bodies moved exactly where nothing touches, by forces where something does.

What a robot's drive asks for is put to it in one of three ways:

- A robot that nothing can reach during the time to come is *carried*: its velocity is that of the
  chord of its arc, and one step of any length brings it to the exact pose.
- A robot that may touch something is watched. As long as it does follow, it is primed with the
  chord's velocity each substep, so that it is exact too.
- A robot that contact or a joint has thrown off its command *slips*: its velocity is left to the
  solver, and its drive is *engaged*, a kinematic control body that pulls it through joints of
  bounded force and torque, until that force has brought it back.

A prop that nothing touches *glides* as the closed form of friction says; else it is left to the
solver, with the floor's friction as a joint of bounded force.
"""

from __future__ import annotations

from math import ceil, inf, sqrt

import numpy as np
from numpy.typing import NDArray

from mars2d.contact import ContactLog
from mars2d.encounter import Bounds, Encounter
from mars2d.floor import Floor
from mars2d.motion import chord_velocity
from mars2d.scenario import Scenario
from mars2d.space import Space
from mars2d.tethers import Tethers

__all__ = ["SLOP", "Engine"]

Float = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

SLOP = 1e-4
"""The overlap that the solver leaves in steady contact, metres."""

ITERATIONS = 15
ITERATIONS_UNEQUAL = 20  # with masses more than three times apart

SLACK = 1.25
"""How much further than at its present speed a body may be thrown before gaps are asked anew."""

STRETCH = 1 / 15
"""How much longer a rope may be when it jerks, in parts of how deep bodies may enter.

The solver draws it in again, and what it pulls at bounces by that much more than nothing.
"""

LINGER = 3
"""For how many substeps a drive stays engaged that need not be any more."""

TURNED = 0.01
"""How far a rim may turn on while its drive stops it, in parts of the overlap allowed."""

GROWTH = 2.0
"""How much longer or shorter a substep may be than the one before, with the same impulses.

The solver begins with those of the substep before. From where the next one has to be shorter than
that, it begins anew.
"""


class Engine:
    """The motion of one world's bodies: robots first, then props."""

    def __init__(self, scenario: Scenario) -> None:
        """Build robots, props, obstacles and, where `on_exit` is "wall", the workspace's walls."""
        bodies = scenario.bodies
        self.n, self.count = len(scenario.robots), len(bodies)
        self._mass = np.array([body.inertia.mass for body in bodies])
        self._moment = np.array([body.inertia.moment for body in bodies])
        thinnest = min(body.shape.thickness for body in bodies)
        unequal = self._mass.max() > 3 * self._mass.min()
        iterations = ITERATIONS_UNEQUAL if unequal else ITERATIONS
        slop = min(SLOP, scenario.max_overlap / 4, thinnest / 32)
        self.space = Space(scenario, slop, iterations)
        self.bounds = Bounds(bodies, [s.outline for s in scenario.surfaces], scenario.joined)
        self._tethers = Tethers(scenario.ties, bodies) if scenario.ties else None
        self.contacts = ContactLog()

        self._in_robot_frame = np.array([robot.drive.frame == "robot" for robot in scenario.robots])
        self._set_forces(scenario)
        self._set_accuracy(scenario, thinnest, iterations)
        self._engaged = np.zeros(self.n, dtype=bool)
        self._since = np.full(self.n, LINGER + 1)  # substeps since a robot slipped
        self._slipping = np.zeros(self.count, dtype=bool)
        self._grip = np.zeros((self.count - self.n, 2))  # N and N m, what the floor may use now
        self._last_step = inf
        self._effort = np.zeros(self.n)
        self._state = self.space.read().copy()

    def _set_forces(self, scenario: Scenario) -> None:
        """Work out what drives and floor can hold bodies with."""
        drives = [robot.drive for robot in scenario.robots]
        self._force = np.array([drive.max_force for drive in drives])
        self._torque = np.array([drive.max_torque for drive in drives])
        self._floor = Floor(scenario.props)

    def _set_accuracy(self, scenario: Scenario, thinnest: float, iterations: int) -> None:
        """Work out how deep a body may enter in one substep, and how long one in contact may be."""
        self._max_overlap = scenario.max_overlap
        # A quarter of the overlap allowed is left to the slop and to what the solver leaves over.
        self._entry = min(0.75 * scenario.max_overlap, 0.125 * thinnest)
        # The depth under a force F settles at about F h^2 / (m iterations).
        own = (self._force / self._mass[: self.n]).max()
        push = float(max(own, self._force.max() / self._mass.min()))
        self._contact_step = sqrt(0.15 * scenario.max_overlap * iterations / push)
        if self._tethers is not None:
            self._contact_step = min(self._contact_step, self._tethers.longest_step)

    @property
    def pose(self) -> Float:
        """The poses (3, N): x, y [m], theta [rad], as a new array."""
        return self._state[:, :3].T.copy()

    @property
    def velocity(self) -> Float:
        """The velocities (3, N): x', y' [m/s], theta' [rad/s], as a new array."""
        return self._state[:, 3:].T.copy()

    def take_effort(self) -> Float:
        """Return the largest share of its bounds that each drive used since the last call, (n,)."""
        effort, self._effort = np.minimum(self._effort, 1.0), np.zeros(self.n)
        return effort

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

        It is less when a body has been thrown further than was thought possible: then it is to be
        asked anew what it may touch.
        """
        center = self.bounds.center(self._state)
        near, path = self._find_near(twist, center, duration)
        self._engage(self._engaged & near[: self.n])
        self._carry(twist, duration)
        if near.any():
            who = np.flatnonzero(near)
            encounter = self.bounds.encounter(center, who, path + self._max_overlap)
            gone = self._substeps(twist, duration, time, who, encounter, path)
        else:
            gone = duration
            self.space.step(duration)
            self._last_step = duration
            self.contacts.add_nothing()
        self._arrive(twist, ~near, gone, duration)
        return gone

    def _carry(self, twist: Float, duration: float) -> None:
        """Set the velocities that bring what touches nothing to where it will be."""
        velocity, n = self.space.velocity, self.n
        velocity[:n] = chord_velocity(twist, self._state[:n, 2], duration, self._in_robot_frame)
        if self.count > n:
            everyone = np.arange(self.count - n)
            moved, _ = self._floor.glide(self._state[n:, 3:], everyone, duration)
            velocity[n : self.count] = moved / duration

    def _arrive(self, twist: Float, carried: Mask, gone: float, duration: float) -> None:
        """Read the state; put those that were carried where they are after `gone` seconds."""
        before = self._state
        self._state = self.space.read().copy()
        if gone < duration:  # they were on the chord of a longer time
            who = np.flatnonzero(carried[: self.n])
            theta, turns = before[who, 2], self._in_robot_frame[who]
            moved = gone * chord_velocity(twist[:, who], theta, gone, turns)
            for i, (dx, dy, _) in zip(who.tolist(), moved.tolist(), strict=True):
                self._put(i, before[i, 0] + dx, before[i, 1] + dy, None)
        if self.count > self.n:
            who = self.n + np.flatnonzero(carried[self.n :])
            moved, end = self._floor.glide(before[who, 3:], who - self.n, gone)
            self._state[who, 3:] = end
            if gone < duration:
                for i, (x, y, theta) in zip(
                    who.tolist(), (before[who, :3] + moved).tolist(), strict=True
                ):
                    self._put(i, x, y, theta)

    def _put(self, i: int, x: float, y: float, theta: float | None) -> None:
        self.space.place(i, x, y, theta)
        self._state[i, :2] = x, y
        if theta is not None:
            self._state[i, 2] = theta

    def _find_near(self, twist: Float, center: Complex, duration: float) -> tuple[Mask, float]:
        """Return which bodies may touch something, and the longest path that one may take.

        One that is near may be pushed by the quickest of them, and so be near to others.
        """
        bounds, n = self.bounds, self.n
        now = bounds.top_speed(self._state[:, 3:])
        speed = now.copy()
        speed[:n] = bounds.top_speed(twist.T, slice(n))
        near = self._slipping.copy()
        if self._tethers is not None:
            near |= self._tethers.tied
        if near.any():
            speed = np.where(near, np.maximum(speed, now), speed)
        path, reach, count = 0.0, speed * duration, -1
        while int(near.sum()) != count:
            count = int(near.sum())
            near |= bounds.clearance.may_touch(center, reach)
            if near.any():
                path = SLACK * float(speed[near].max()) * duration
                reach = np.where(near, path + self._max_overlap, speed * duration)
        bounds.clearance.moved(reach)
        return near, path

    def _hold(self, slipping: Mask, who: Index, h: float) -> None:
        """Engage the drives of robots that slip, or did a moment ago, for a substep of h.

        One that pushes loses touch now and then for a substep or two. What comes from afar is to be
        hit with its momentum alone, not with all that its drive could give meanwhile.
        """
        self._since[who] = np.where(slipping, 0, self._since[who] + 1)
        wanted = np.zeros(self.n, dtype=bool)
        wanted[who] = slipping | ((self._since[who] <= LINGER) & (h <= self._contact_step))
        self._engage(wanted)

    def _engage(self, wanted: Mask) -> None:
        """Let the drives of these robots act through their joints, and those of no others; (n,)."""
        for i in np.flatnonzero(wanted & ~self._engaged).tolist():
            self.space.engage(i)
        for i in np.flatnonzero(self._engaged & ~wanted).tolist():
            self.space.disengage(i)
        self._engaged = wanted

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

        who: (k,) their numbers. path: metres; before one of them has gone further, this returns.
        Returns the seconds gone.
        """
        k = int(np.searchsorted(who, self.n))  # robots come first
        slipping = self._slipping[who]
        everything = self._state
        gone = np.zeros(len(who))  # paths, metres
        elapsed = h = 0.0
        while True:
            state = everything[who]
            encounter.measure(state)
            touching = encounter.touching()
            if elapsed > 0 and encounter.any_touch:
                solved = self.space.solved(everything)
                self.contacts.add(time + elapsed, h, solved, encounter.touching_pairs())
            elif elapsed > 0:
                self.contacts.add_nothing()
            if self._tethers is not None:
                self._tethers.measure(everything)
                touching |= self._tethers.held()[who]
            if elapsed >= duration:
                self._slipping[who] = slipping
                return elapsed
            left = h = duration - elapsed
            slipping |= touching
            if slipping.any():
                h = min(h, self._contact_step, GROWTH * self._last_step)
                h = self._time_to_brake(twist, state[:k], slipping[:k], h, who[:k])
                slipping[:k] &= touching[:k] | self._out_of_reach(twist, state[:k], h, who[:k])
                slipping[k:] = touching[k:]
            velocity, bend = self._motion(twist, state, slipping, who, k)
            h = min(h, encounter.time_to_touch(velocity, bend, self._entry))
            if self._tethers is not None:
                h = min(h, self._time_to_jerk(velocity, bend, who))
            h = left / ceil(left / h - 1e-9)  # equal ones settle best, and leave no sliver
            gone += h * self.bounds.top_speed(velocity, who)
            if elapsed > 0 and gone.max() > path:
                self._slipping[who] = slipping
                return elapsed
            self._aim(twist, state, slipping, who, k, h)
            self._hold(slipping[:k], who[:k], h)
            if GROWTH * h < self._last_step and slipping.any():
                held = np.zeros(self.count, dtype=bool)
                held[who] = slipping
                self.space.forget(held)
            if self._tethers is not None:
                for rope, speed in self._tethers.drift(h):
                    self.space.draw_in(rope, speed)
            self.space.step(h)
            self._last_step = h
            elapsed = duration if h == left else elapsed + h
            everything = self.space.read().copy()
            slips = who[:k][slipping[:k]].tolist()
            if slips:
                used = self.space.effort(slips, h)
                self._effort[slips] = np.maximum(self._effort[slips], used)

    def _motion(
        self, twist: Float, state: Float, slipping: Mask, who: Index, k: int
    ) -> tuple[Float, Float]:
        """Return how bodies move now (., 3), and how quickly that may turn [m/s^2].

        The first k of them are robots.
        """
        turns, mine = self._in_robot_frame[who[:k]], twist[:, who[:k]]
        velocity = state[:, 3:].copy()
        follows = np.flatnonzero(~slipping[:k])
        velocity[follows] = chord_velocity(mine, state[:k, 2], 0.0, turns)[follows]
        bend = np.zeros(len(who))
        arcs = turns & ~slipping[:k]
        bend[:k][arcs] = np.abs(np.hypot(mine[0], mine[1]) * mine[2])[arcs]
        if k < len(who):
            props, reach = who[k:] - self.n, self.bounds.reach[who[k:]]
            braking = self._floor.braking(state[k:, 3:], reach, props)
            bend[k:] = np.where(slipping[k:], 0.0, braking)
        return velocity, bend

    def _time_to_jerk(self, velocity: Float, bend: Float, who: Index) -> float:
        """Return for how long no rope gets taut and longer; all that are tied are near."""
        assert self._tethers is not None
        all_velocity, all_bend = np.zeros((self.count, 3)), np.zeros(self.count)
        all_velocity[who], all_bend[who] = velocity, bend
        return self._tethers.time_to_jerk(all_velocity, all_bend, STRETCH * self._entry)

    def _time_to_brake(
        self, twist: Float, state: Float, slipping: Mask, h: float, who: Index
    ) -> float:
        """Return h, or less where a strong drive ends a spin sooner: it would turn for all of h."""
        spin = np.abs(state[:, 5] - twist[2, who])
        rim = spin * self.bounds.radius[who]
        lasts = np.maximum(
            spin * self._moment[who] / self._torque[who],
            TURNED * self._max_overlap / np.maximum(rim, np.finfo(float).tiny),
        )
        return float(np.where(slipping, lasts, h).min(initial=h))

    def _out_of_reach(self, twist: Float, state: Float, h: float, who: Index) -> Mask:
        """Return which robots their drives can't bring back to their commands within h."""
        wanted = chord_velocity(twist[:, who], state[:, 2], h, self._in_robot_frame[who])
        error = np.abs(state[:, 3:] - wanted)
        impulse = np.hypot(error[:, 0], error[:, 1]) * self._mass[who]
        slow = impulse > self._force[who] * h
        return np.asarray(slow | (error[:, 2] * self._moment[who] > self._torque[who] * h))

    def _aim(
        self, twist: Float, state: Float, slipping: Mask, who: Index, k: int, h: float
    ) -> None:
        """Set the velocities of bodies `who`, of which k are robots, for a substep of h.

        The engine moves bodies by the velocities that they have, then joints work towards the
        control bodies': so these get the velocities of the substep after this one.
        """
        robots, mine = who[:k], twist[:, who[:k]]
        turns = self._in_robot_frame[robots]
        now = chord_velocity(mine, state[:k, 2], h, turns)
        now[slipping[:k]] = state[:k, 3:][slipping[:k]]
        velocity = self.space.velocity
        velocity[robots] = now
        velocity[self.count + robots] = chord_velocity(mine, state[:k, 2] + now[:, 2] * h, h, turns)
        if k < len(who):
            self._aim_props(state[k:], slipping[k:], who[k:], h)

    def _aim_props(self, state: Float, slipping: Mask, who: Index, h: float) -> None:
        """Set the velocities of props `who` for a substep of h.

        One that glides has its velocity at the end, so that the solver meets what it then runs into
        with the right one; it is put back by as much as it would go too short with that.
        """
        props = who - self.n
        moved, end = self._floor.glide(state[:, 3:], props, h)
        glides = ~slipping & state[:, 3:].any(axis=1)
        self.space.velocity[who] = np.where(glides[:, None], end, state[:, 3:])
        ahead = state[:, :3] + moved - end * h
        for row in np.flatnonzero(glides).tolist():
            self.space.place(int(who[row]), *ahead[row].tolist())
        held = np.zeros((len(who), 2))
        for row in np.flatnonzero(slipping).tolist():
            held[row] = self.space.held(int(who[row]), self._last_step)
        grip = np.column_stack(self._floor.bounds(state[:, 3:], held, props))
        grip[~slipping] = 0.0  # what rests untouched stays so, and is hit as if free
        changed = (grip != self._grip[props]).any(axis=1)
        self._grip[props] = grip
        for row in np.flatnonzero(changed).tolist():
            self.space.grip(int(who[row]), *grip[row].tolist())
