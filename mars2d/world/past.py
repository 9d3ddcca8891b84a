"""The past of a run: worlds that wait in it, and the way of a world back to an earlier row."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from operator import attrgetter
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError, LawError, Mars2dError
from mars2d.core.usercode import quiet
from mars2d.record.interventions import Change, Intervention
from mars2d.scenario.changes import carried, check_alike
from mars2d.scenario.experiment import Experiment
from mars2d.world.loop import open_world
from mars2d.world.world import World

PARKED = 4
"""The number of worlds that wait in the past, evenly apart; one more may be on its way."""

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
    """Makes a world again that is as it was at a row: from the start, or from one that waits.

    experiment: whose laws the worlds have. waiting: the worlds that wait, in any order. driven: the
    robots that were driven by hand. doubt: a sentence, where a law asked for another command than
    it did before, else empty.
    """

    def __init__(self, experiment: Experiment) -> None:
        self._experiment = experiment
        self._start, self._options = experiment.scenario, experiment.options
        self.waiting: list[World] = []
        self.driven: set[int] = set()
        self.doubt = ""
        self._hopeless = False  # a way back has failed while nobody asked for it
        self._cost = self._opening = 0.0  # seconds of a control step, and to open the experiment

    def with_laws_of(self, experiment: Experiment) -> Past:
        """Return the past of the same run, in which no world waits, for laws read again."""
        past = Past(experiment)
        past._start, past._options, past.driven = self._start, self._options, self.driven
        past._cost, past._opening = self._cost, self._opening
        return past

    def forget_from(self, row: int) -> None:
        """Drop the worlds that wait at a row or after it."""
        self.waiting = [world for world in self.waiting if world.iteration < row]

    def prepare(self, track: Track, row: int, seconds: float) -> None:
        """Use some time to prepare for changes: at a row of the past, or else anywhere in it.

        It takes no longer than that by more than a control step.
        """
        if self._hopeless:
            return
        if self._cost > seconds:
            self._cost *= 0.99  # it may have been slow by chance
            return
        newest = track.world.iteration
        try:
            if row < newest:
                self._approach(track, row, seconds)
            elif newest >= 2 * PARKED:
                self._spread(track, seconds)
        except Mars2dError:
            self.waiting, self._hopeless = [], True  # whoever asks for it is told why

    def world_at(self, track: Track, row: int, progress: Progress) -> World:
        """Return a world that is as it was at a row, and has read its sensors there.

        Raises InputError where `progress` breaks it off, and where the world is not the same.
        """
        self._hopeless = False
        start = self._nearest(row)
        begun = 0 if start is None else start.iteration
        while not self._approach(track, row, SLICE):
            here = self._nearest(row)
            done = (0 if here is None else here.iteration) - begun
            if not progress(done / max(1, row - begun)):
                raise InputError("going back was broken off: nothing was changed")
        world = self._nearest(row)
        assert world is not None
        with quiet():
            try:
                _redo(track, world)
                world.observe()
            except LawError:
                self.waiting.remove(world)
                raise
        if world.over:
            self.waiting.remove(world)
            raise InputError(
                f"nothing follows this step, whatever is changed: {world.over_message}"
            )
        if track.done is None:
            self._check_same(track.world, world, row)
        return world

    def _check_same(self, before: World, world: World, row: int) -> None:
        if row == before.iteration:
            was, props = before.pose, before.prop_pose
        else:
            was, props = before.history.pose[row], before.history.prop_pose[row]
        if not (np.array_equal(world.pose, was) and np.array_equal(world.prop_pose, props)):
            self.waiting = []
            raise InputError(
                f"can't go back: run again, things were not the same at step {row}. Does a law, a "
                "sensor or an add-on depend on something outside of the world?"
            )

    def _nearest(self, row: int) -> World | None:
        """Return the last world that waits at a row or before it."""
        before = [world for world in self.waiting if world.iteration <= row and not world.over]
        return max(before, key=lambda world: world.iteration, default=None)

    def opened(self, experiment: Experiment) -> World:
        """Return a world at the start of this run, with the laws of an experiment read again."""
        scenario = carried(experiment.scenario, self._start)
        begun = replace(experiment, scenario=scenario, options=self._options)
        return open_world(begun)

    def _open(self) -> World:
        """Let another world wait at the start, in place of another if there are many."""
        start = perf_counter()
        with quiet():
            fresh = self._experiment.reopened()
            check_alike(self._experiment.scenario, fresh.scenario)
            world = self.opened(fresh)
        self._opening = perf_counter() - start
        waiting = sorted((w for w in self.waiting if not w.over), key=lambda w: w.iteration)
        if len(waiting) > PARKED:
            gaps = [b.iteration - a.iteration for a, b in pairwise(waiting)]
            del waiting[int(np.argmin(gaps)) + 1]
        self.waiting = [*waiting, world]
        return world

    def _approach(self, track: Track, row: int, seconds: float) -> bool:
        """Let the nearest world go on to a row for some time; return whether it is there."""
        world = self._nearest(row) or self._open()
        return self._follow(track, world, row, perf_counter() + seconds)

    def _spread(self, track: Track, seconds: float) -> None:
        """Let worlds go on to where they divide the past evenly, the last one first."""
        if len(self.waiting) < PARKED:
            if self._opening > seconds:
                self._opening *= 0.99  # it may have been slow by chance
            else:
                self._open()
            return
        deadline = perf_counter() + seconds
        newest = track.world.iteration
        places = [(k + 1) * newest // (PARKED + 1) for k in range(PARKED)]
        self.waiting.sort(key=lambda world: world.iteration)
        for world, place in reversed([*zip(self.waiting, places, strict=False)]):
            if not self._follow(track, world, place, deadline):
                return

    def _follow(self, track: Track, world: World, row: int, deadline: float) -> bool:
        """Repeat a run in a world up to a row; return whether it got there in time."""
        commands = track.world.history.command
        now = perf_counter()
        with quiet():
            while world.iteration < row:
                if now > deadline:
                    return False
                if world.over:
                    raise InputError(f"run again, it ended before: {world.over_message}")
                _redo(track, world)
                k = world.iteration
                asked = world.simulation.follow(commands[k])
                if k >= track.since and not self.doubt:
                    self._compare(asked, commands[k], k)
                start, now = now, perf_counter()
                self._cost = max(now - start, 0.9 * self._cost)
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


def _redo(track: Track, world: World) -> None:
    """Repeat the interventions of a world's present row, unless they were repeated already."""
    row, log = world.iteration, world.operator.log
    if log and log[-1].row == row:
        return
    for intervention in track.interventions(row):
        if isinstance(intervention, Change):
            scenario = carried(world.scenario, intervention.scenario, intervention.given)
            moved, options = dict(intervention.moved), dict(intervention.options)
            world.operator.change(scenario, world.control, moved, options, intervention.given)
        else:
            world.operator.redo(intervention)
