"""Motion: moves the bodies of one world, and keeps their states and contacts."""

from __future__ import annotations

import weakref
from array import array
from collections.abc import Callable, Mapping
from functools import cached_property, wraps
from typing import Any, Self, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arrays import locked
from mars2d.physics.space import Space
from mars2d.physics.translation import mover_of
from mars2d.record.contact import CONTACT
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]
Act = TypeVar("Act", bound=Callable[..., Any])

NOTHING = np.empty(0, dtype=CONTACT)
NOTHING.flags.writeable = False

ALIKE = np.dtype([("s", "f8", (2,)), ("i", "i4", (2,)), ("number", "f8", (9,)), ("is", "?", (2,))])
"""CONTACT with the fields that are alike as one, which are quicker to set."""


def contacts_of(numbers: array[float]) -> NDArray[np.void]:
    """Return rows of CONTACT from fifteen numbers each."""
    wide = np.frombuffer(numbers).reshape(-1, 15)
    contacts = np.empty(len(wide), dtype=CONTACT)
    alike = contacts.view(ALIKE)
    alike["s"], alike["i"] = wide[:, :2], wide[:, 2:4]
    alike["number"], alike["is"] = wide[:, 4:13], wide[:, 13:]
    return contacts


def repeated(act: Act) -> Act:
    """Let a fork of an engine do again what this method does to the bodies."""

    @wraps(act)
    def noted(motion: Motion, *arguments: Any) -> Any:
        motion._acts.append((noted, arguments))
        return act(motion, *arguments)

    return cast(Act, noted)


class Motion:
    """The base of engines: robots first, then props. obstacles: their outlines.

    velocity: now, (3, N): x', y' [m/s], theta' [rad/s]. seen_work: on all bodies since the start at
    the last `look`, (6,) J, see `mars2d.record.energy.WORK`. Both are written again as they change.
    """

    def __init__(self, scenario: Scenario) -> None:
        """Build robots, props, obstacles and, where `on_exit` is "wall", the workspace's walls."""
        self._scenario = scenario
        self.n, self.count = len(scenario.robots), len(scenario.bodies)
        self._mover = mover_of(scenario)
        weakref.finalize(self, self._mover.free)
        self.rest()
        self._numbers = array("d", bytes(48 * self.count))
        self._state = np.frombuffer(self._numbers).reshape(-1, 6)
        self._seen = False  # whether the space has the bodies where they are
        self._worked = array("d", bytes(48))
        self.velocity = locked(self._state[:, 3:].T)
        self.seen_work = locked(np.frombuffer(self._worked))
        self.obstacles = tuple(surface.outline for surface in scenario.surfaces)
        self._moved()

    @cached_property
    def _space(self) -> Space:
        return Space([rigid.shape.pieces for rigid in self._scenario.bodies], self.obstacles)

    @property
    def space(self) -> Space:
        """The bodies and obstacles as sensors see them, where they are now."""
        if not self._seen:
            self._seen = True
            self._space.place(self._state)
        return self._space

    def _moved(self) -> None:
        """Note where bodies are after they have moved."""
        self._mover.write_states(self._numbers)
        self._seen = False

    @property
    def pose(self) -> Float:
        """The poses (3, N): x, y [m], theta [rad], as a new array."""
        return self._state[:, :3].T.copy()

    def look(self) -> None:
        """Let `seen_work` be that of this instant."""
        self._mover.write_work(self._worked)

    @repeated
    def ask(self, twist: Float) -> None:
        """Set the velocities that the robots are asked for at this instant, (3, n).

        Those that stand still since they were stopped go on to do so.
        """
        self._mover.ask(array("d", twist.tobytes()))
        self._moved()

    @repeated
    def take_effort(self) -> Float:
        """Return the largest share of its bounds that each drive used since the last call, (n,)."""
        effort = array("d", bytes(8 * self.n))
        self._mover.take_effort(effort)
        return np.frombuffer(effort)

    @repeated
    def take_contacts(self) -> NDArray[np.void]:
        """Return the contacts since the last call by time: a row (CONTACT) per pair and normal."""
        numbers = self._mover.take_contacts()
        return contacts_of(numbers) if numbers else NOTHING

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
        fork = self._resumed(self._scenario, self._rested)
        for act, arguments in self._acts:
            act(fork, *arguments)
        return fork

    def changed(self, scenario: Scenario, moved: Mapping[int, tuple[float, float, float]]) -> Self:
        """Return an engine of another scenario that goes on from here; this one ends.

        moved: poses of bodies that stand still elsewhere, by index. Contacts begin again. What that
        changes in the bodies' energies is the work of hands.
        """
        memories: list[Any] = [(memory, []) for memory, _ in self._mover.rest()]
        for body, pose in moved.items():
            memories[body] = (*pose, 0.0, 0.0, 0.0, False, *memories[body][0][7:]), []
        return self._resumed(scenario, memories)

    def _resumed(self, scenario: Scenario, memories: list[Any]) -> Self:
        resumed = type(self)(scenario)
        resumed._mover.remember(memories)
        resumed._moved()
        resumed._rested = memories
        return resumed
