"""Motion without forces: when things touch, a robot stops, or nothing happens."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.physics.collision import Bounds, Collisions
from mars2d.physics.floor import Floor
from mars2d.physics.motion import Arcs, Motion, Start, point_velocity
from mars2d.physics.settings import SLOP
from mars2d.physics.space import Space
from mars2d.record.contact import ContactLog, Solved
from mars2d.scenario.scenario import Scenario

__all__ = ["Kinematics"]

Float = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

INWARDS = 1e-9
"""A body that moves faster into something it touches is stopped, m/s."""


class Kinematics(Motion):
    """The motion of one world's bodies where ``Scenario.physics`` is "stop" or "ideal".

    Robots follow their commands exactly, and props glide. With "stop", a robot that would enter
    another body or an obstacle stands still for the rest of the control step, a prop for good. With
    "ideal", both go through. Contacts are noted either way, without impulses. Joints do not act.
    """

    def __init__(self, scenario: Scenario, start: Start | None = None) -> None:
        """Take robots, props, obstacles and, where `on_exit` is "wall", the workspace's walls.

        start: how all bodies move at first; by default, as the scenario says.
        """
        bodies = scenario.bodies
        self.n = len(scenario.robots)
        self._stops = scenario.physics == "stop"
        self.space = Space(scenario, SLOP, 1)  # for rays; it is never stepped
        self.bounds = Bounds(bodies, [s.outline for s in scenario.surfaces], scenario.joined)
        self.contacts = ContactLog()
        self._in_robot_frame = np.array([robot.drive.frame == "robot" for robot in scenario.robots])
        self._floor = Floor(scenario.props)
        self._everyone = np.arange(len(scenario.props))
        self._depth = min(SLOP, min(body.shape.thickness for body in bodies) / 32)
        self._state = self.space.read().copy()
        if start is not None:
            self._state[:] = start.state
            self.space.place_all(self._state[:, :3])

    @property
    def motion(self) -> Start:
        """How all bodies move now: a motion that starts with it goes on from here."""
        nobody, still = np.zeros(len(self._state), dtype=bool), np.zeros((3, self.n))
        return Start(self._state.copy(), nobody, still)

    def take_effort(self) -> Float:
        """Return zeros (n,): no drive makes an effort."""
        return np.zeros(self.n)

    def take_contacts(self) -> NDArray[np.void]:
        """Return the contacts since the last call by time, one row (dtype CONTACT) per pair."""
        return self.contacts.take()

    def drive(self, twist: Float, duration: float, time: float) -> None:
        """Move all bodies for `duration` seconds under constant twists (3, n) of the robots.

        time: at the start, seconds, for the contacts.
        """
        speed = self.bounds.top_speed(self._state[:, 3:])
        speed[: self.n] = self.bounds.top_speed(twist.T, slice(self.n))
        reach = speed * duration
        center = self.bounds.center(self._state)
        self.bounds.clearance.measure(center)
        near = self.bounds.clearance.may_touch(reach)
        self.bounds.clearance.moved(reach)
        who = np.flatnonzero(near)
        start = self._state
        arcs = Arcs(twist, self._in_robot_frame)
        self._state = self._moved(arcs, start, duration)
        self._state[:, 3:] = self._now(arcs, self._state)
        if len(who):
            collisions = self.bounds.collisions(who, float(reach[who].max()))
            self._state[who] = self._substeps(twist, start, duration, time, who, collisions)[who]
        else:
            self.contacts.add_nothing()
        self.space.place_all(self._state[:, :3])

    def _now(self, arcs: Arcs, state: Float) -> Float:
        """Return the velocities (N, 3) now."""
        now, n = state[:, 3:].copy(), self.n
        now[:n] = arcs.chord(state[:n, 2], 0.0)
        return now

    def _moved(self, arcs: Arcs, state: Float, h: float) -> Float:
        """Return the states (N, 6) after h seconds."""
        after, n = state.copy(), self.n
        chord = arcs.chord(state[:n, 2], h)
        after[:n, :3] += h * chord
        after[:n, 3:] = chord
        moved, end = self._floor.glide(state[n:, 3:], self._everyone, h)
        after[n:, :3] += moved
        after[n:, 3:] = end
        return after

    def _substeps(
        self,
        twist: Float,
        state: Float,
        duration: float,
        time: float,
        who: Index,
        collisions: Collisions,
    ) -> Float:
        """Return the states (N, 6) after `duration`, with each touch of bodies `who` found."""
        twist, n = twist.copy(), self.n
        arcs = Arcs(twist, self._in_robot_frame)
        elapsed = h = 0.0
        while True:
            collisions.measure(state[who])
            now = self._now(arcs, state)
            if elapsed > 0 and collisions.any_touch:
                self._note(time + elapsed, h, state, now, collisions)
            elif elapsed > 0:
                self.contacts.add_nothing()
            if elapsed >= duration:
                state[:, 3:] = now
                return state
            if self._stops and collisions.any_touch:
                stopped = who[collisions.inwards(now[who]) > INWARDS]
                twist[:, stopped[stopped < n]] = 0.0
                arcs = Arcs(twist, self._in_robot_frame)
                state[stopped[stopped >= n], 3:] = 0.0
                now = self._now(arcs, state)
            bend = np.zeros(len(state))
            bend[:n] = arcs.bend
            reach = self.bounds.reach[n:]
            bend[n:] = self._floor.braking(state[n:, 3:], reach, self._everyone)
            left = h = duration - elapsed
            h = min(
                h, collisions.time_to_touch(now[who], bend[who], self._depth, again=self._stops)
            )
            state = self._moved(arcs, state, h)
            elapsed = duration if h == left else elapsed + h

    def _note(
        self, time: float, h: float, state: Float, velocity: Float, collisions: Collisions
    ) -> None:
        """Note who touches whom after a step of h seconds."""
        a, b, point, normal = collisions.touches()
        points, normals = (np.column_stack([z.real, z.imag]) for z in (point, normal))
        approach = point_velocity(state, velocity, b, points)
        approach -= point_velocity(state, velocity, a, points)
        nothing = np.zeros((len(a), 2))
        solved = Solved(np.column_stack([a, b]), nothing, normals, points, points, approach)
        self.contacts.add(time, h, solved, (a, b))
