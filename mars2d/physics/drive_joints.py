"""Drive joints: they tie robots to their commands while something may touch them.

A robot that follows its command gets the velocity of its chord in each substep. When a contact or a
joint has thrown it off its command, it slips: the solver decides its velocity, and its drive is
engaged. That is a control body which pulls the robot with bounded force and torque until it follows
again, and for a few short substeps more.
"""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.physics.motion import Arcs
from mars2d.physics.settings import DEFAULT_OVERLAP, LINGER, TURNED
from mars2d.physics.space import Space
from mars2d.scenario.scenario import Scenario

__all__ = ["DriveJoints", "Driven"]

Float = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

SMALLEST = float(np.finfo(float).tiny)
"""The smallest normal number: no divisor is smaller."""


class DriveJoints:
    """The drives of n robots, as they act on bodies."""

    def __init__(self, scenario: Scenario, space: Space) -> None:
        """Take the scenario with the robots, and the space with their bodies."""
        robots = scenario.robots
        self.space = space
        self.count = len(scenario.bodies)
        self.mass, self.moment = np.array([robot.inertia for robot in robots]).T.copy()
        self.rim = np.array([robot.chassis.bound[1] for robot in robots])
        overlap = scenario.max_overlap
        self.turned = TURNED * overlap * max(1.0, overlap / DEFAULT_OVERLAP)
        self.force = np.array([robot.drive.max_force for robot in robots])
        self.torque = np.array([robot.drive.max_torque for robot in robots])
        self._in_robot_frame = np.array([robot.drive.frame == "robot" for robot in robots])
        self.since = np.full(len(robots), LINGER + 1)  # substeps since a robot slipped
        self.effort = np.zeros(len(robots))
        self._engaged = np.zeros(len(robots), dtype=bool)

    def shared(self) -> tuple[dict[str, NDArray[Any]], dict[str, float]]:
        """Return arrays and numbers for the kernel, by its names; see ``kernel/team.h``."""
        arrays = {
            "mass": self.mass, "moment": self.moment, "rim": self.rim, "force": self.force,
            "torque": self.torque, "in_robot_frame": self._in_robot_frame,
            "engaged": self._engaged, "since": self.since, "effort": self.effort,
        }  # fmt: skip
        return arrays, {"turned": self.turned, "linger": LINGER, "least": SMALLEST}

    def arcs(self, twist: Float) -> Arcs:
        """Return how free robots move under twists (3, n)."""
        return Arcs(twist, self._in_robot_frame)

    def release(self, away: Mask) -> None:
        """Disengage the drives of robots that nothing can touch, (n,)."""
        self.engage(self._engaged & ~away)
        self.since[away] = LINGER + 1

    def engage(self, wanted: Mask) -> None:
        """Engage the drives of these robots, (n,), and disengage those of the others."""
        changes = np.flatnonzero(wanted != self._engaged).tolist()
        for i in changes:
            if wanted[i]:
                self.space.engage(i)
        for i in changes:
            if not wanted[i]:
                self.space.disengage(i)
        self._engaged[:] = wanted

    def take_effort(self) -> Float:
        """Return the largest share of its bounds that each drive used since the last call, (n,)."""
        effort = np.minimum(self.effort, 1.0)
        self.effort[:] = 0.0
        return effort


class Driven:
    """Some robots under constant twists, and their drives.

    In the methods `state` (m, 6) and `slipping` (m,) are theirs.
    """

    def __init__(self, joints: DriveJoints, arcs: Arcs, who: Index) -> None:
        """Take the robots' numbers (m,), and the arcs of all robots."""
        self._drive_joints, self._who = joints, who
        self._arcs = arcs.take(who)
        self._spin, self._bend = self._arcs.spin, self._arcs.bend
        self._mass, self._moment = joints.mass[who], joints.moment[who]
        self._force, self._torque = joints.force[who], joints.torque[who]
        self._rim = joints.rim[who]
        self._since = joints.since[who]

    def motion(self, state: Float, slipping: Mask) -> tuple[Float, Float]:
        """Return their velocities (m, 3), and how fast these may turn, (m,) m/s^2."""
        chord = self._arcs.chord(state[:, 2], 0.0)
        velocity = np.where(slipping[:, None], state[:, 3:], chord)
        return velocity, np.where(slipping, 0.0, self._bend)

    def time_to_brake(self, state: Float, slipping: Mask) -> float:
        """Return when the first drive stops the spin of a robot that begins to slip, s; else inf.

        In a longer substep the robot turns on until its end. The time has a lower bound, where this
        turn is too small to be seen.
        """
        begins = slipping & (self._since > 0)
        if not begins.any():
            return inf
        spin = np.abs(state[:, 5] - self._spin)
        rim = np.maximum(spin * self._rim, SMALLEST)
        lasts = np.maximum(spin * self._moment / self._torque, self._drive_joints.turned / rim)
        return float(lasts[begins].min())

    def out_of_reach(self, state: Float, h: float) -> Mask:
        """Return which robots their drives can't bring back to their commands within h s, (m,)."""
        error = np.abs(state[:, 3:] - self._arcs.chord(state[:, 2], h))
        slow = np.hypot(error[:, 0], error[:, 1]) * self._mass > self._force * h
        return np.asarray(slow | (error[:, 2] * self._moment > self._torque * h))

    def aim(self, state: Float, slipping: Mask, h: float, *, brief: bool) -> None:
        """Set the velocities of robots and of their control bodies for a substep of h seconds.

        The engine first moves bodies by their velocities, then joints pull these towards the
        velocities of the control bodies: so control bodies get those of the substep after this.

        brief: whether the substep is as short as in contact. Then a drive stays engaged for a while
        after its robot follows again, since a robot that pushes loses touch now and then. But a
        robot that comes from afar hits with its momentum alone, without its drive's force.
        """
        joints, who = self._drive_joints, self._who
        joints.since[who] = self._since = np.where(slipping, 0, self._since + 1)
        holds = slipping | (self._since <= LINGER) if brief else slipping
        spin = np.where(slipping, state[:, 5], self._spin)
        now, ahead = self._arcs.chord(np.array([state[:, 2], state[:, 2] + spin * h]), h)
        velocity = joints.space.velocity
        velocity[who] = np.where(slipping[:, None], state[:, 3:], now)
        velocity[joints.count + who] = ahead
        wanted = np.zeros(len(joints.since), dtype=bool)
        wanted[who] = holds
        joints.engage(wanted)

    def note_effort(self, slipping: Mask) -> None:
        """Note the shares of their bounds that drives of slipping robots have just used."""
        who = self._who[slipping]
        if len(who):
            used = self._drive_joints.space.effort(who.tolist())
            self._drive_joints.effort[who] = np.maximum(self._drive_joints.effort[who], used)
