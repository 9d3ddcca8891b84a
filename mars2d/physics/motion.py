"""Motion: moves the bodies of one world, and keeps their states and contacts."""

from __future__ import annotations

import weakref
from array import array
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arrays import locked
from mars2d.physics.space import Space
from mars2d.physics.translation import mover_of
from mars2d.record.contact import CONTACT
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]
Mask = NDArray[np.bool_]

NOTHING = np.empty(0, dtype=CONTACT)
NOTHING.flags.writeable = False

WIDE = np.dtype([(name, ("f8", CONTACT[name].shape)) for name in CONTACT.names or ()])
"""The fields of CONTACT, all of them as floating-point numbers."""


class Start(NamedTuple):
    """How bodies move at an instant: their states (N, 6), which of them slip (N,), twists (3, n).

    A state is x, y [m], theta [rad], and their rates; a twist is the velocity that a drive is asked
    for.
    """

    state: Float
    slipping: Mask
    twist: Float

    def moved(self, poses: Mapping[int, tuple[float, float, float]]) -> Start:
        """Return a copy with some bodies at rest at other poses."""
        state, slipping = self.state.copy(), self.slipping.copy()
        for body, pose in poses.items():
            state[body] = (*pose, 0.0, 0.0, 0.0)
            slipping[body] = False
        return Start(state, slipping, self.twist)


class Motion:
    """The base of engines: robots first, then props. space: the bodies as sensors see them.

    seen_velocity, seen_work: as `velocity` and `work`, at the last `look`, in memory that the next
    one writes again.
    """

    def __init__(self, scenario: Scenario, start: Start | None = None) -> None:
        """Build robots, props, obstacles and, where `on_exit` is "wall", the workspace's walls.

        start: how all bodies move at first; by default, as the scenario says.
        """
        self.n, self.count = len(scenario.robots), len(scenario.bodies)
        if start is None:
            self._twist = np.zeros((3, self.n))
            self._mover = mover_of(scenario, None, ())
        else:
            self._twist = start.twist
            self._mover = mover_of(scenario, start.state, start.slipping.tolist())
            self._mover.command(array("d", self._twist.tobytes()))
        weakref.finalize(self, self._mover.free)
        self._numbers = array("d", bytes(48 * self.count))
        self._state = np.frombuffer(self._numbers).reshape(-1, 6)
        self._mover.write_states(self._numbers)
        self._rates, self._worked = array("d", bytes(24 * self.count)), array("d", bytes(48))
        self.seen_velocity = locked(np.frombuffer(self._rates).reshape(3, -1))
        self.seen_work = locked(np.frombuffer(self._worked))
        self.space = Space(scenario, self._state)

    @property
    def pose(self) -> Float:
        """The poses (3, N): x, y [m], theta [rad], as a new array."""
        return self._state[:, :3].T.copy()

    @property
    def velocity(self) -> Float:
        """The velocities (3, N) at this instant: x', y' [m/s], theta' [rad/s], as a new array."""
        self.look()
        return self.seen_velocity.copy()

    def look(self) -> None:
        """Let `seen_velocity` and `seen_work` be those of this instant."""
        self._mover.write_velocities(self._rates)
        self._mover.write_work(self._worked)

    @property
    def motion(self) -> Start:
        """How all bodies move now: a motion that starts with it goes on from here."""
        state = self._state.copy()
        state[:, 3:] = self.velocity.T
        return Start(state, np.array(self._mover.slipping(), dtype=bool), self._twist)

    def ask(self, twist: Float) -> None:
        """Set the velocities that the robots are asked for at this instant, (3, n).

        Those that stand still since they were stopped go on to do so.
        """
        self._twist = twist
        self._mover.ask(array("d", twist.tobytes()))

    def take_effort(self) -> Float:
        """Return the largest share of its bounds that each drive used since the last call, (n,)."""
        effort = array("d", bytes(8 * self.n))
        self._mover.take_effort(effort)
        return np.frombuffer(effort)

    @property
    def work(self) -> Float:
        """The work on all bodies since the start (6,), joules; see `mars2d.record.energy.WORK`."""
        self.look()
        return self.seen_work.copy()

    def take_contacts(self) -> NDArray[np.void]:
        """Return the contacts since the last call by time: a row (CONTACT) per pair and normal."""
        count = self._mover.count_contacts()
        if not count:
            return NOTHING
        numbers = array("d", bytes(120 * count))
        self._mover.write_contacts(numbers)
        return np.frombuffer(numbers, dtype=WIDE).astype(CONTACT)
