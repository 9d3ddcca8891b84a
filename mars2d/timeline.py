"""A run that one can go back in: its past as it was recorded, and worlds to go on from there."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from contextlib import redirect_stdout
from dataclasses import replace
from time import perf_counter

import numpy as np

from mars2d.errors import InputError
from mars2d.files import Experiment
from mars2d.frame import Frame
from mars2d.interventions import Intervention
from mars2d.loop import open_world, watch_by
from mars2d.record import Record
from mars2d.scenario import Scenario
from mars2d.world import Watcher, World

__all__ = ["Timeline"]

PARKED = 4
"""Of how many worlds it is asked that they wait in the past, evenly apart."""

Progress = Callable[[float], bool]
"""Told which share of a way back is done, from 0 to 1; returns whether to go on."""


class Timeline:
    """A run in a window: rows up to the newest can be looked at, and gone on from.

    A row is looked at as it was recorded. To change something there, a world is made that is as it
    was: from the start, or from a world that waits in the past, under the commands that were given
    then. Laws are asked again on the way, so that they remember what they did. What was run after
    that row becomes another branch, which can be gone back to.

    experiment: what is run. seed: of all random streams. watchers: called at each control step.
    """

    def __init__(
        self, experiment: Experiment, seed: int = 0, watchers: Sequence[Watcher] = ()
    ) -> None:
        self.experiment = experiment
        self._seed = seed
        self._watchers = watchers
        self._fresh = True
        self.restart()

    def restart(self) -> None:
        """Build the world anew, from the experiment as it is now; forget all branches."""
        self._world = open_world(self._reopened(), self._seed, self._watchers)
        self.branches: list[World] = []
        self._waiting: list[World] = []
        self._seen: tuple[World, int, Record] | None = None
        self.row = 0
        self._observe()

    def _reopened(self) -> Experiment:
        """Return the experiment with laws that remember nothing, as far as it can be opened anew.

        The first time it is still as it was opened.
        """
        fresh, self._fresh = self._fresh, False
        return self.experiment if fresh else self.experiment.reopened()

    # -- where one is -------------------------------------------------------------------------

    @property
    def world(self) -> World:
        """The world at the newest row."""
        return self._world

    @property
    def newest(self) -> int:
        """The row up to which was run."""
        return self._world.iteration

    @property
    def scenario(self) -> Scenario:
        """What is simulated, at the newest row."""
        return self._world.scenario

    @property
    def frame(self) -> Frame:
        """What is seen at the present row."""
        if self.row == self.newest:
            return self._world.frame
        frame = self._past.frame(self.row)
        if not frame.over_message:
            return frame
        return replace(frame, over_message="", draw_addons=None)

    @property
    def over(self) -> bool:
        """Whether this is the newest row and nothing follows it."""
        return self.row == self.newest and self._world.over

    @property
    def record(self) -> Record:
        """The record of the present branch; where it is not over, it says that it was closed."""
        record = self._world.record
        if self._world.over:
            return record
        return replace(record, over_message="The window was closed")

    @property
    def _past(self) -> Record:
        """The record up to the newest row, kept as long as nothing is run."""
        world = self._world
        if self._seen is None or self._seen[:2] != (world, world.iteration):
            self._seen = world, world.iteration, world.record
        return self._seen[2]

    # -- going on, going back -----------------------------------------------------------------

    def advance(self) -> None:
        """Go on by one row: one that is recorded, or else by a control step.

        A LawError ends the run and carries its record.
        """
        if self.row < self.newest:
            self.row += 1
        elif not self._world.over:
            self._world.step()
            self.row = self.newest
            self._observe()

    def go(self, row: int) -> None:
        """Look at a row; at the nearest one that is there."""
        self.row = min(max(row, 0), self.newest)

    def _observe(self) -> None:
        """Read the sensors of what is seen next."""
        if not self._world.over:
            self._world.observe()

    # -- branches -----------------------------------------------------------------------------

    @property
    def _goes_on(self) -> bool:
        """Whether the newest world can be gone on with: it is not over, or it ended by itself."""
        return not self._world.over or self._world.finished

    @property
    def needs_way_back(self) -> bool:
        """Whether a world has to be made again before something can be changed at this row."""
        return self.row < self.newest or not self._goes_on

    def idle(self, seconds: float) -> None:
        """Use time that is left: let a world get to this row, or let worlds wait in the past."""
        if self.experiment.opened is None:
            return  # laws that ran beside would share what they remember with those of this run
        try:
            if self.row < self.newest:
                self._approach(self.row, seconds)
            elif self.newest >= 2 * PARKED:
                self._spread(seconds)
        except InputError:
            self._waiting = []  # whoever wants to go back there is told why that can't be

    def branch(self, progress: Progress = lambda _: True) -> World:
        """Return a world at the present row that may be changed and gone on with.

        What was run after it becomes a branch. progress: is told how much of the way back is done;
        if it returns False, nothing happens. Raises InputError if that is so, and if the world does
        not become what it was.
        """
        if not self.needs_way_back:
            return self._world
        row = self.row
        start = self._nearest(row)
        begun = 0 if start is None else start.iteration
        while not self._approach(row, 0.05):
            here = self._nearest(row)
            done = (0 if here is None else here.iteration) - begun
            if not progress(done / max(1, row - begun)):
                raise InputError("going back was broken off: nothing was changed")
        world = next(w for w in self._waiting if w.iteration == row)
        for intervention in self._world.hands.log:
            if intervention.row == row:
                world.hands.redo(intervention)
        self._check_same(world, row)
        self._waiting = [w for w in self._waiting if w.iteration < row]
        self.branches.append(self._world)
        self._world = world
        world.watch = watch_by(self._watchers)
        self._observe()
        return world

    def _check_same(self, world: World, row: int) -> None:
        before = self._world
        was = before.pose if row == before.iteration else before.history.pose[row]
        if not np.array_equal(world.pose, was):
            self._waiting = []
            raise InputError(_not_the_same(row))

    def other_branch(self) -> None:
        """Go to the branch that was left longest ago, at the same row if it has it."""
        if not self.branches:
            return
        other = self.branches.pop(0)
        self.branches.append(self._world)
        common = _common_rows(self._world, other)
        self._waiting = [world for world in self._waiting if world.iteration <= common]
        self._world = other
        self.go(self.row)

    # -- worlds that wait in the past -----------------------------------------------------------

    def _nearest(self, row: int) -> World | None:
        """Return the world that waits last before a row, or at it."""
        before = [world for world in self._waiting if world.iteration <= row and not world.over]
        return max(before, key=lambda world: world.iteration, default=None)

    def _approach(self, row: int, seconds: float) -> bool:
        """Let the nearest world go on to a row for some time; return whether it is there."""
        world = self._nearest(row)
        if world is None:
            world = open_world(self._reopened(), self._seed)
            self._waiting.append(world)
        return self._follow(world, row, perf_counter() + seconds)

    def _spread(self, seconds: float) -> None:
        """Let worlds get to where the past is divided evenly, the one that is last first."""
        deadline = perf_counter() + seconds
        places = [(k + 1) * self.newest // (PARKED + 1) for k in range(PARKED)]
        while len(self._waiting) < PARKED:
            self._waiting.append(open_world(self._reopened(), self._seed))
            if perf_counter() > deadline:
                return
        self._waiting.sort(key=lambda world: world.iteration)
        for world, place in reversed([*zip(self._waiting, places, strict=False)]):
            if not self._follow(world, place, deadline):
                return

    def _follow(self, world: World, row: int, deadline: float) -> bool:
        """Let a world do what was done before, up to a row; return whether it got there in time.

        Nothing that its laws print is seen twice.
        """
        done: dict[int, list[Intervention]] = {}
        for intervention in self._world.hands.log:
            done.setdefault(intervention.row, []).append(intervention)
        commands = self._world.history.command
        with redirect_stdout(io.StringIO()):
            while world.iteration < row:
                if world.over:
                    raise InputError(_not_the_same(world.iteration))
                if perf_counter() > deadline:
                    return False
                k = world.iteration
                for intervention in done.get(k, ()):
                    world.hands.redo(intervention)
                world.follow(commands[k])
        return True


def _not_the_same(row: int) -> str:
    return (
        f"can't go back: run again, things were not the same at step {row}. Does a law, a sensor or "
        "an add-on depend on something outside of the world?"
    )


def _common_rows(first: World, second: World) -> int:
    """Return up to which row two worlds of one run are the same."""
    count = min(len(first.history), len(second.history))
    same = (first.history.command[:count] == second.history.command[:count]).all(axis=(1, 2))
    same &= (first.history.pose[:count] == second.history.pose[:count]).all(axis=(1, 2))
    return count if same.all() else int(np.argmin(same))
