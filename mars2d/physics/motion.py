"""Motion: moves the bodies of one world, and keeps their states and contacts."""

from __future__ import annotations

import weakref
from array import array
from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, NamedTuple, Self, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arrays import locked
from mars2d.physics.space import Space
from mars2d.physics.translation import mover_of
from mars2d.record.contact import CONTACT
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]
Mask = NDArray[np.bool_]
Act = TypeVar("Act", bound=Callable[..., Any])

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


def repeated(act: Act) -> Act:
    """Let a fork of an engine do again what this method does to the bodies."""

    @wraps(act)
    def noted(motion: Motion, *arguments: Any) -> Any:
        motion._acts.append((noted, arguments))
        return act(motion, *arguments)

    return cast(Act, noted)


class Motion:
    """The base of engines: robots first, then props. space: the bodies as sensors see them.

    seen_velocity, seen_work: as `velocity` and `work`, at the last `look`, in memory that the next
    one writes again.
    """

    def __init__(self, scenario: Scenario, start: Start | None = None) -> None:
        """Build robots, props, obstacles and, where `on_exit` is "wall", the workspace's walls.

        start: how all bodies move at first; by default, as the scenario says.
        """
        self._scenario = scenario
        self.n, self.count = len(scenario.robots), len(scenario.bodies)
        if start is None:
            self._twist = np.zeros((3, self.n))
            self._mover = mover_of(scenario, None, ())
        else:
            self._twist = start.twist
            self._mover = mover_of(scenario, start.state, start.slipping.tolist())
            self._mover.command(array("d", self._twist.tobytes()))
        weakref.finalize(self, self._mover.free)
        self.rest()
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

    @repeated
    def ask(self, twist: Float) -> None:
        """Set the velocities that the robots are asked for at this instant, (3, n).

        Those that stand still since they were stopped go on to do so.
        """
        self._twist = twist
        self._mover.ask(array("d", twist.tobytes()))

    @repeated
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

    @repeated
    def take_contacts(self) -> NDArray[np.void]:
        """Return the contacts since the last call by time: a row (CONTACT) per pair and normal."""
        count = self._mover.count_contacts()
        if not count:
            return NOTHING
        numbers = array("d", bytes(120 * count))
        self._mover.write_contacts(numbers)
        return np.frombuffer(numbers, dtype=WIDE).astype(CONTACT)

    # -- forks ------------------------------------------------------------------------------------

    def rest(self) -> None:
        """Forget what the solvers keep, and begin again from how all bodies move and touch.

        What Chipmunk keeps can't be copied: impulses, and orders and identities of shapes in its
        tree. So it goes every few control steps, in each run: a fork repeats those since then.
        """
        self._rested: list[Any] = self._mover.rest()
        self._acts: list[tuple[Callable[..., Any], tuple[Any, ...]]] = []

    def fork(self) -> Self:
        """Return an engine that goes on from this instant as this one does, to the bit."""
        fork = type(self)(self._scenario)
        fork._mover.remember(self._rested)
        fork._mover.write_states(fork._numbers)
        fork._rested, fork._twist = self._rested, self._twist
        for act, arguments in self._acts:
            act(fork, *arguments)
        return fork
