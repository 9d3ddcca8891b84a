"""The past of a run: the way of a world back to an earlier row."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable
from dataclasses import dataclass, replace
from operator import attrgetter
from time import perf_counter
from typing import cast

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError
from mars2d.core.usercode import keeps_nothing, quiet
from mars2d.record.interventions import Change, Intervention
from mars2d.scenario.changes import alike, carried, check_same
from mars2d.scenario.experiment import Experiment
from mars2d.world.fork import forked
from mars2d.world.loop import open_world
from mars2d.world.simulation import REST, Simulation
from mars2d.world.world import World

MOST = 16
"""The number of snapshots; where there are more, every other one goes."""

SLICE = 0.05
"""The time on a way back between two calls of its progress, seconds."""

Float = NDArray[np.float64]
Progress = Callable[[float], bool]
"""Called with the share of a way back that is done, from 0 to 1; returns whether to go on."""


@dataclass(frozen=True, slots=True)
class Track:
    """The rows that a world is to follow.

    world: the world that has done them. since: the row from which on its laws were those of the
    experiment as it is now, so that they must ask for the same commands again. done: how many of
    its interventions are repeated; None: all.
    """

    world: World
    since: int
    done: int | None = None

    def interventions(self, row: int) -> list[Intervention]:
        """Return the interventions at a row, in order."""
        log = self.world.operator.log[: self.done]
        first = bisect_left(log, row, key=attrgetter("row"))
        return log[first : bisect_right(log, row, key=attrgetter("row"))]


class Past:
    """Makes a world again that is as it was at a row: from a snapshot before it, or the start.

    A snapshot is a fork, of which others are made. There is none where laws may remember something
    that forks share: then the whole run is repeated, with laws read again.

    experiment: whose laws the worlds have. driven: the robots that were driven by hand. doubt: a
    sentence, where a law asked for another command than it did before, else empty.
    """

    def __init__(self, experiment: Experiment) -> None:
        self.experiment = experiment
        self._start, self._options = experiment.scenario, experiment.options
        self._snapshots: dict[int, tuple[Simulation, tuple[int, int, int, int]]] = {}
        self._every = REST  # rows from one snapshot to the next; 0: none is made
        self.driven: set[int] = set()
        self.doubt = ""

    def with_laws_of(self, experiment: Experiment) -> Past:
        """Return the past of the same run, without snapshots, for laws read again."""
        past = Past(experiment)
        past._start, past._options, past.driven = self._start, self._options, self.driven
        return past

    def keep(self, world: World) -> None:
        """Make a snapshot of a world before anything is done to it, if it is time to."""
        row, now = world.iteration, world.simulation
        if not self._every or row % self._every or world.over or world.operator.driven:
            return
        try:
            if all(keeps_nothing(law.function) for law in now.laws):
                self._snapshots[row] = forked(now, laws=True), world.recorder.counts
        except InputError:  # something can't be copied
            self._every = 0
        if len(self._snapshots) > MOST:
            self._every *= 2
            kept = self._snapshots.items()
            self._snapshots = {k: snapshot for k, snapshot in kept if k % self._every == 0}

    def forget_after(self, row: int) -> None:
        """Drop the snapshots after a row."""
        self._snapshots = {k: kept for k, kept in self._snapshots.items() if k <= row}

    def world_at(
        self, track: Track, row: int, progress: Progress, world: World | None = None
    ) -> World:
        """Return a world as it was at a row, which has read its sensors, with hands still on it.

        world: to begin with, at the start. Raises InputError where `progress` breaks it off, and
        where the world is not the same.
        """
        world = self._nearest(track, row) if world is None else world
        begun = world.iteration
        while not self._follow(track, world, row):
            if not progress((world.iteration - begun) / (row - begun)):
                raise InputError("going back was broken off: nothing was changed")
        with quiet():
            _redo(track, world)
            world.observe()
        if world.over:
            raise InputError(
                f"nothing follows this step, whatever is changed: {world.over_message}"
            )
        same = track.done is not None or _same(track.world, world, row)
        if begun and (self.doubt or not same):  # forks may share what nobody thought of
            self._snapshots, self._every, self.doubt = {}, 0, ""
            return self.world_at(track, row, progress)
        if not same:
            raise InputError(
                f"can't go back: run again, things were not the same at step {row}. Does a law, a "
                "sensor or an add-on depend on something outside of the world?"
            )
        return world

    def _nearest(self, track: Track, row: int) -> World:
        """Return a world at the last snapshot up to a row, or else at the start."""
        before = [k for k in self._snapshots if k <= row]
        if before:
            snapshot, counts = self._snapshots[max(before)]
            recorder = track.world.recorder.upto(*counts)
            return cast(World, forked(snapshot, laws=True, recorder=recorder).world)
        with quiet():
            fresh = self.experiment.reopened()
            check_same(self.experiment.scenario, fresh.scenario, alike)
            return self.opened(fresh)

    def opened(self, experiment: Experiment) -> World:
        """Return a world at the start of this run, with the laws of an experiment read again."""
        scenario = carried(experiment.scenario, self._start)
        return open_world(replace(experiment, scenario=scenario, options=self._options))

    def _follow(self, track: Track, world: World, row: int) -> bool:
        """Repeat a run in a world up to a row, for some time; return whether it is there."""
        commands = track.world.history.command
        due = perf_counter() + SLICE
        with quiet():
            while world.iteration < row:
                if perf_counter() > due:
                    return False
                if world.over:
                    raise InputError(f"run again, it ended before: {world.over_message}")
                _redo(track, world)
                k = world.iteration
                asked = world.simulation.follow(commands[k])
                if k >= track.since and not self.doubt:
                    self._compare(asked, commands[k], k)
                self.keep(world)
        return True

    def _compare(self, asked: Float, given: Float, row: int) -> None:
        """Note a law that asks for another command than it did, unless its robot was driven."""
        others = set(np.flatnonzero((asked != given).any(axis=0)).tolist()) - self.driven
        if others:
            name = self._start.robots[min(others)].name
            self.doubt = (
                f"asked again, the law of {name} gave another command at step {row}: it depends on "
                "something outside of the world, such as random numbers that are not robot.rng. "
                "All moved as before, but what the law remembers may be different"
            )


def _same(before: World, world: World, row: int) -> bool:
    """Return whether all bodies of a world are where they were at a row."""
    poses = before.pose, before.prop_pose
    if row < before.iteration:
        poses = before.history.pose[row], before.history.prop_pose[row]
    return all(map(np.array_equal, (world.pose, world.prop_pose), poses))


def _redo(track: Track, world: World) -> None:
    """Repeat the interventions of a world's present row, unless they were repeated already."""
    row, log = world.iteration, world.operator.log
    if log and log[-1].row == row:
        return
    for each in track.interventions(row):
        again = each
        if isinstance(each, Change):
            scenario = carried(world.scenario, each.scenario, each.given)
            again = replace(each, scenario=scenario, control=world.control)
        world.operator.redo(again)
