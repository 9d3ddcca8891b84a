"""A branch of a run: a world, and how one is made again that is as it was at a row."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError
from mars2d.core.usercode import keeps_nothing, quiet
from mars2d.record.interventions import Change, Steer
from mars2d.scenario.changes import alike, carried, check_same
from mars2d.scenario.experiment import Experiment
from mars2d.scenario.scenario import Scenario
from mars2d.world.fork import forked
from mars2d.world.loop import open_world
from mars2d.world.simulation import REST, Simulation
from mars2d.world.world import World

MOST = 16
"""The number of snapshots; where there are more, every other one goes."""

SLICE = 0.05
"""The time on a way back between two calls of its progress, seconds."""

NEVER = sys.maxsize
"""A row that no run reaches."""

Float = NDArray[np.float64]
Progress = Callable[[float], bool]
"""Called with the share of a way back that is done, from 0 to 1; returns whether to go on."""
Snapshots = dict[int, tuple[Simulation, tuple[int, int, int, int]]]
"""Forks by their rows, and how much was recorded then."""


@dataclass(eq=False)
class Branch:
    """The rows that a world has done, from the start of its run on.

    experiment: whose laws it has, with the options that hold at its newest row. parts: a mark of
    each branch that it went through, the run's first, and the row at which that begins. since: the
    row from which on such laws gave its commands, so that they must ask for the same ones again.
    snapshots: there is none where laws may remember something that forks share; None: they can't be
    made. doubt: a sentence, where a law asked for another command than it did before, else empty.
    """

    world: World
    experiment: Experiment
    parts: Sequence[tuple[object, int]]
    since: int = 0
    snapshots: Snapshots | None = field(default_factory=dict)
    doubt: str = ""

    def common(self, other: Branch) -> int:
        """Return up to which row this and another one are the same; 0 for those of other runs."""
        return min((row for _, row in {*self.parts} ^ {*other.parts}), default=NEVER)

    def poses(self, row: int) -> Float:
        """Return the poses (3, n + p) of robots and props at a row, or at the newest one."""
        history = self.world.history
        if row >= len(history):
            return np.hstack([self.world.pose, self.world.prop_pose])
        return np.hstack([history.pose[row], history.prop_pose[row]])

    def keep(self) -> None:
        """Make a snapshot before anything is done to the world, if it is time to."""
        world, row, every = self.world, self.world.iteration, REST
        while row > MOST * every:
            every *= 2
        if row % every or self.snapshots is None or self.since == NEVER:
            return
        if world.over or world.operator.driven:
            return
        try:
            if all(keeps_nothing(law.function) for law in world.simulation.laws):
                now = forked(world.simulation, laws=True), world.recorder.counts
                kept = {k: each for k, each in self.snapshots.items() if k % every == 0}
                self.snapshots = kept | {row: now}
        except InputError:  # something can't be copied
            self.snapshots = None

    def decides_as(self, experiment: Experiment) -> bool:
        """Return whether its laws are those of an experiment, as far as can be told."""
        return experiment is self.experiment or experiment.decides_as(self.experiment)

    def upto(self, row: int) -> Snapshots | None:
        """Return the snapshots up to a row; None if they can't be made."""
        kept = self.snapshots
        return None if kept is None else {k: each for k, each in kept.items() if k <= row}

    def off(
        self, row: int, progress: Progress, experiment: Experiment, done: int | None = None
    ) -> Branch:
        """Return a branch off this one, whose world is as this one was at a row.

        The world goes on from the last snapshot before, or else from the start with laws read
        again, which are asked on the way. It has read its sensors, and hands are still on it.
        experiment: whose laws are asked. done: how many interventions are done again; None: all.
        Raises InputError where `progress` breaks it off, and where the world is not the same.
        """
        same = self.decides_as(experiment)
        kept, since = (self.upto(row), self.since) if same else ({}, NEVER)
        parts = [*(part for part in self.parts if part[1] <= row), (object(), row)]
        while True:
            world = self._forked(*kept[max(kept)]) if kept else self._begun(experiment)
            branch = Branch(world, experiment, parts, min(since, row), kept)
            branch._follow(self, row, progress, since, done)
            same = done is not None or np.array_equal(branch.poses(row), self.poses(row))
            if same and not (kept and branch.doubt):
                return branch
            if not kept:
                raise InputError(
                    f"can't go back: run again, things were not the same at step {row}. Does a "
                    "law, a sensor or an add-on depend on something outside of the world?"
                )
            kept = {}  # forks may share what nobody thought of

    def _forked(self, snapshot: Simulation, counts: tuple[int, int, int, int]) -> World:
        """Return a world that goes on from a snapshot."""
        recorder = self.world.recorder.upto(*counts)
        return cast(World, forked(snapshot, laws=True, recorder=recorder).world)

    def _begun(self, experiment: Experiment) -> World:
        """Return a world at the start of this run, with the laws of an experiment read again."""
        with quiet():
            fresh = experiment.reopened()
            check_same(self.experiment.scenario, fresh.scenario, alike)
            scenario = carried(fresh.scenario, self.world.simulation.declared)
            options = self.world.recorder.options
            return open_world(replace(fresh, scenario=scenario, options=options))

    def _follow(
        self, other: Branch, row: int, progress: Progress, since: int, done: int | None
    ) -> None:
        """Repeat what another branch did up to a row, and read the sensors there.

        since: the row from which on the laws must ask for the same commands again. done: see `off`.
        """
        world, commands = self.world, other.world.history.command
        log = other.world.operator.log[:done]
        driven = {each.robot for each in log if isinstance(each, Steer)}

        def scenario_of(change: Change) -> Scenario:
            return carried(world.scenario, change.scenario, change.given)

        begun, due = world.iteration, perf_counter() + SLICE
        with quiet():
            for k in range(begun, row):
                if perf_counter() > due:
                    if not progress((k - begun) / (row - begun)):
                        raise InputError("going back was broken off: nothing was changed")
                    due = perf_counter() + SLICE
                if world.over:
                    raise InputError(f"run again, it ended before: {world.over_message}")
                world.operator.redo(log, scenario_of)
                asked = world.simulation.follow(commands[k])
                others = {*np.flatnonzero((asked != commands[k]).any(axis=0)).tolist()} - driven
                if k >= since and others and not self.doubt:
                    name = world.scenario.robots[min(others)].name
                    self.doubt = (
                        f"asked again, the law of {name} gave another command at step {k}: it "
                        "depends on something outside of the world, such as random numbers that "
                        "are not robot.rng. All moved as before, but what the law remembers may be "
                        "different"
                    )
                if not begun:  # else those before are near enough
                    self.keep()
            world.operator.redo(log, scenario_of)
            world.observe()
        if world.over:
            raise InputError(
                f"nothing follows this step, whatever is changed: {world.over_message}"
            )


def options_of(world: World, done: int | None = None) -> dict[str, Any]:
    """Return the options that hold at the newest row of a world; done: after so many changes."""
    options = dict(world.recorder.options)
    for each in world.operator.log[:done]:
        if isinstance(each, Change):
            options.update(each.options)
    return options
