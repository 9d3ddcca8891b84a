"""Contests in which robots leave one by one: who is out, how it stands, how it looks."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.contest import Contest, Outcome, Teams
from mars2d.core.interfaces import Contacts, FrameLike, ScenarioLike, WorldLike
from mars2d.core.scene import Scene

Float = NDArray[np.float64]

MARK = "#222222"
"""The colour of the mark on a robot that is out of the game."""


class Span(NamedTuple):
    """Some control steps of a run: times (T,), poses (T, 3, n), and all contacts, in order."""

    scenario: ScenarioLike
    time: Float
    pose: Float
    contacts: Contacts


class Exit(NamedTuple):
    """A robot that leaves: when [s], its index, its result, and the index of who caught it.

    The result is -1 for one that is caught or shoved out, and 1 for one that is safe.
    """

    time: float
    robot: int
    result: float
    hunter: int | None = None


class Elimination(Contest):
    """The base of contests in which robots leave, and stand still from then on.

    A class says in `exits` who leaves, in `judged` how it stands, and in `ending` why it is over;
    all else follows, in a running world and of a record.
    """

    holds_last: ClassVar[bool] = True
    """Whether who leaves in the last control step stands still in it."""

    @abstractmethod
    def exits(self, teams: Teams, span: Span) -> list[Exit]:
        """Return which robots of two teams leave in a span of a run, each once."""

    @abstractmethod
    def judged(self, teams: Teams, exits: Sequence[Exit], time_is_over: bool) -> Outcome:
        """Return how it stands after exits."""

    @abstractmethod
    def ending(self, world: WorldLike) -> str:
        """Return why it is over now, in words; "" while it goes on."""

    def time_is_over(self, scenario: ScenarioLike, row: int) -> bool:
        """Return whether time is over for the contest at a row of a run."""
        return row >= scenario.last_iteration

    def on_start(self, world: WorldLike) -> None:
        """Find the robots; raise InputError if one is not there, or has two roles."""
        self._teams, self._time_is_over = self.players(world.scenario), False
        self._exits: tuple[Exit, ...] = ()
        self._before: tuple[float, Float] | None = None  # the last control step

    def on_step(self, world: WorldLike) -> None:
        """Note who leaves; end the experiment when it is decided, or when time is over."""
        one, other, out, time = *self._teams, self.results, world.time
        if out:
            one, other = (tuple(r for r in team if r not in out) for team in self._teams)
        before = self._before or (time, world.pose)
        times, poses = map(np.array, zip(before, (time, world.pose), strict=True))
        self._before = time, world.pose
        span = Span(world.scenario, times, poses, world.contacts)
        now = self.exits((one, other), span)
        self._exits += tuple(now)
        self._time_is_over = self.time_is_over(world.scenario, world.iteration)
        changes = now or self._time_is_over or not world.iteration  # else it stands as before
        why = self.ending(world) if changes else ""
        if why:
            world.stop(why)
        for leaving in now if self.holds_last or not why else ():
            world.hold(leaving.robot)

    @property
    def results(self) -> dict[int, float]:
        """The results of robots that are out: -1 if caught or shoved out, 1 if safe."""
        return {leaving.robot: leaving.result for leaving in self._exits}

    @property
    def score(self) -> dict[str, int]:
        """The score of each role."""
        return self.judged(self._teams, self._exits, self._time_is_over).score

    @property
    def winner(self) -> str | None:
        """The role that has won, or None."""
        return self.judged(self._teams, self._exits, self._time_is_over).winner

    def outcome(self, record: Any) -> Outcome:
        """Return captures, score and winner of a record, loaded or just made."""
        teams = self.players(record.scenario)
        contacts = record.contacts[record.contact_rows < len(record)]  # before its last row
        exits = self.exits(teams, Span(record.scenario, record.time, record.pose, contacts))
        return self.judged(teams, exits, self.time_is_over(record.scenario, len(record) - 1))

    def exits_at(self, frame: FrameLike) -> list[Exit]:
        """Return who has left at a frame."""
        time = np.arange(len(frame.path)) * frame.scenario.sampling_time
        pose = np.concatenate([frame.path, frame.pose[None]])
        span = Span(frame.scenario, np.append(time, frame.time), pose, frame.contact_log())
        return self.exits(self.players(frame.scenario), span)


def firsts(time: Float, there: NDArray[np.bool_], robots: Sequence[int]) -> list[tuple[float, int]]:
    """Return when robots are first there, and their indices, in order. there: (T, n)."""
    found = [(float(time[there[:, r]][0]), r) for r in robots if there[:, r].any()]
    return sorted(found, key=lambda first: first[0])


def mark(scene: Scene, frame: FrameLike, leaving: Exit, *, above: bool) -> None:
    """Ring a robot that is out, cross it out if it lost; write the time above or below it."""
    arm = 1.25 * frame.scenario.robots[leaving.robot].radius
    x, y = frame.pose[:2, leaving.robot].tolist()
    scene.circle((x, y), arm, stroke=MARK, width=1.2)
    if leaving.result < 0:
        scene.cross((x, y), arm, stroke=MARK, width=1.2)
    label = f"{round(leaving.time, 1):g} s"
    place, lines = (y + arm, f"{label}\n") if above else (y - arm, f"\n{label}")
    scene.text((x, place), lines, color=MARK, size=10.0, halo="#ffffff")
