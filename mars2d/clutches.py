"""What ties robots to their drives while something may touch them.

As long as a robot follows its command, it is primed with its chord's velocity each substep. When
contact or a joint has thrown it off, it slips: its velocity is left to the solver, and its drive is
engaged, a control body that pulls it with bounded force and torque until it follows again, and for
a few short substeps more.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.motion import chord_velocity
from mars2d.scenario import Scenario
from mars2d.space import Space

__all__ = ["Clutches"]

Float = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

LINGER = 3
"""For how many substeps a drive stays engaged that need not be any more."""

TURNED = 0.01
"""How far a rim may turn on while its drive stops it, in parts of the overlap allowed.

It is what keeps slides along walls with friction within half a percent of the formula. Where more
overlap is allowed than by default, a larger part of it is: speed is wanted then.
"""

FINE = 1e-3
"""The overlap allowed by default, metres."""


LEAST = float(np.finfo(float).tiny)


class Clutches:
    """The drives of n robots, as they act on bodies.

    In the methods, `who` (m,) are the numbers of some robots, `state` (m, 6) and `slipping` (m,)
    theirs, and `twist` (3, n) what all drives ask for.
    """

    def __init__(self, scenario: Scenario, space: Space) -> None:
        """Take the robots and where their bodies are."""
        robots = scenario.robots
        self._space = space
        self._count = len(scenario.bodies)
        self._mass, self._moment = np.array([robot.inertia for robot in robots]).T.copy()
        self._rim = np.array([robot.chassis.bound[1] for robot in robots])
        self._turned = TURNED * scenario.max_overlap * max(1.0, scenario.max_overlap / FINE)
        self.force = np.array([robot.drive.max_force for robot in robots])
        self._torque = np.array([robot.drive.max_torque for robot in robots])
        self._in_robot_frame = np.array([robot.drive.frame == "robot" for robot in robots])
        self._engaged = np.zeros(len(robots), dtype=bool)
        self._since = np.full(len(robots), LINGER + 1)  # substeps since a robot slipped
        self._effort = np.zeros(len(robots))

    def shared(self) -> tuple[dict[str, NDArray[Any]], dict[str, float]]:
        """Return arrays and numbers for the kernel, by its names; see ``kernel/kernel.h``."""
        arrays = {
            "mass": self._mass, "moment": self._moment, "rim": self._rim, "force": self.force,
            "torque": self._torque, "in_robot_frame": self._in_robot_frame,
            "engaged": self._engaged, "since": self._since, "effort": self._effort,
        }  # fmt: skip
        return arrays, {"turned": self._turned, "linger": LINGER, "least": LEAST}

    def chord(self, twist: Float, state: Float, h: float, who: Index | slice) -> Float:
        """Return the velocities (m, 3) that bring robots along their arcs in h seconds."""
        return chord_velocity(twist[:, who], state[:, 2], h, self._in_robot_frame[who])

    def motion(self, twist: Float, state: Float, slipping: Mask, who: Index) -> tuple[Float, Float]:
        """Return how robots move now, (m, 3), and how quickly that may turn, (m,) m/s^2."""
        velocity = np.where(slipping[:, None], state[:, 3:], self.chord(twist, state, 0.0, who))
        forward, left, spin = twist[:, who]
        arcs = self._in_robot_frame[who] & ~slipping
        return velocity, np.where(arcs, np.abs(np.hypot(forward, left) * spin), 0.0)

    def time_to_brake(self, twist: Float, state: Float, slipping: Mask, who: Index) -> Float:
        """Return when drives end the spins of robots that just begin to slip, (m,) s; else inf.

        A substep that is longer lets them turn on for all of it. It need not be so short that this
        can't be seen.
        """
        spin = np.abs(state[:, 5] - twist[2, who])
        rim = np.maximum(spin * self._rim[who], LEAST)
        lasts = np.maximum(spin * self._moment[who] / self._torque[who], self._turned / rim)
        return np.where(slipping & (self._since[who] > 0), lasts, np.inf)

    def out_of_reach(self, twist: Float, state: Float, who: Index, h: float) -> Mask:
        """Return which robots their drives can't bring back to their commands within h."""
        error = np.abs(state[:, 3:] - self.chord(twist, state, h, who))
        impulse = np.hypot(error[:, 0], error[:, 1]) * self._mass[who]
        slow = impulse > self.force[who] * h
        return np.asarray(slow | (error[:, 2] * self._moment[who] > self._torque[who] * h))

    def aim(
        self, twist: Float, state: Float, slipping: Mask, who: Index, h: float, *, brief: bool
    ) -> None:
        """Set the velocities of robots and of their control bodies for a substep of h.

        The engine moves bodies by the velocities that they have, then joints work towards the
        control bodies': so these get the velocities of the substep after this one.

        brief: whether the substep is as short as those in contact are. Then a drive stays engaged
        for a while that need not be: a robot that pushes loses touch now and then. But what comes
        from afar is to hit with its momentum alone, not with all that its drive gives meanwhile.
        """
        now = np.where(slipping[:, None], state[:, 3:], self.chord(twist, state, h, who))
        self._space.velocity[who] = now
        self._since[who] = np.where(slipping, 0, self._since[who] + 1)
        holds = slipping | (brief & (self._since[who] <= LINGER))
        ahead = state[holds, :3]
        ahead[:, 2] += now[holds, 2] * h
        self._space.velocity[self._count + who[holds]] = self.chord(twist, ahead, h, who[holds])
        wanted = np.zeros(len(self._engaged), dtype=bool)
        wanted[who] = holds
        self._engage(wanted)

    def release(self, away: Mask) -> None:
        """Disengage the drives of robots that nothing can touch, (n,)."""
        self._engage(self._engaged & ~away)
        self._since[away] = LINGER + 1

    def _engage(self, wanted: Mask) -> None:
        for i in np.flatnonzero(wanted & ~self._engaged).tolist():
            self._space.engage(i)
        for i in np.flatnonzero(self._engaged & ~wanted).tolist():
            self._space.disengage(i)
        self._engaged = wanted

    def note_effort(self, who: Index) -> None:
        """Note how much of their bounds engaged drives have used in the last substep."""
        if len(who):
            used = self._space.effort(who.tolist())
            self._effort[who] = np.maximum(self._effort[who], used)

    def take_effort(self) -> Float:
        """Return the largest share of its bounds that each drive used since the last call, (n,)."""
        effort = np.minimum(self._effort, 1.0)
        self._effort[:] = 0.0
        return effort
