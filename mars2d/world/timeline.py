"""A run that one can go back in: its past as it was recorded, and worlds to go on from there."""

from __future__ import annotations

import io
import os
import sys
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, redirect_stderr, redirect_stdout, suppress
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError, LawError, Mars2dError
from mars2d.record.columns import DiskError
from mars2d.record.frame import Frame
from mars2d.record.interventions import Change, Intervention
from mars2d.record.record import Record
from mars2d.scenario.experiment import Experiment
from mars2d.scenario.hot_reload import carried, check_alike, merged
from mars2d.scenario.scenario import Scenario
from mars2d.world.loop import open_world, watch_by
from mars2d.world.world import Watcher, World

if TYPE_CHECKING:
    from mars2d.output.formats.mcap import Log

__all__ = ["Progress", "Timeline"]

PARKED = 4
"""How many worlds wait in the past, evenly apart; there may be one more, on its way."""

SLICE = 0.05
"""The seconds of a way back between two words of how far it has got."""

NEVER = sys.maxsize
"""A row that no run gets to."""

Float = NDArray[np.float64]
Progress = Callable[[float], bool]
"""Told which share of a way back is done, from 0 to 1; returns whether to go on."""


class Timeline:
    """A run in a window: rows up to the newest can be looked at, and gone on from.

    A row is looked at as it was recorded. To change something there, a world is made that is as it
    was: from the start, or from a world that waits in the past, under the commands that were given
    then. Laws are asked again on the way, so that they remember what they did. What was run after
    that row becomes another branch, which can be gone back to.

    The laws are those of the experiment, whose file is run anew for each world: so no two worlds
    share what a law keeps in its module. What laws print or write to stderr is not repeated, but
    what they do else outside of the world, such as writing a file, is done again. So nothing is
    made before somebody has gone back for the first time.

    experiment: what is run. seed: of all random streams. watchers: called at each control step.
    log: what writes each row to a file when it is run; of branches, the present one.

    row: what is looked at. branches: the worlds of the other branches, that left longest ago first.
    remark: what has to be said of the last way back, else empty.
    """

    def __init__(
        self,
        experiment: Experiment,
        seed: int = 0,
        watchers: Sequence[Watcher] = (),
        log: Log | None = None,
    ) -> None:
        self._seed = seed
        self._log = log
        self._watchers = watchers
        self._begin(experiment)
        with suppress(LawError):  # of a sensor at the start: it is kept as `error`
            self._observe()

    def restart(self, experiment: Experiment | None = None) -> None:
        """Begin anew, with the experiment as its file is now, or as given; forget all branches."""
        self._begin(self._experiment.reopened() if experiment is None else experiment)
        self._observe()

    def _begin(self, experiment: Experiment) -> None:
        """Build the world of an experiment whose laws have not been asked yet."""
        self._world = open_world(experiment, self._seed, self._watchers)
        self._experiment = experiment
        self._start = experiment.scenario
        self.branches: list[World] = []
        self.row = 0
        self.remark = ""
        self._lines = {self._world: _Line(((0, 0),))}
        self._errors: dict[World, LawError] = {}
        self._count = 0  # of branches that there have been
        self._waiting: list[World] = []
        self._seen: tuple[World, int, Record] | None = None
        self._driven: set[int] = set()  # robots that hands have driven
        self._doubt = ""
        self._gone_back = False
        self._hopeless = False  # a way back has failed while nobody asked for it
        self._cost = self._opening = 0.0  # seconds of a control step, and to open the experiment
        self._write()

    # -- where one is -------------------------------------------------------------------------

    @property
    def experiment(self) -> Experiment:
        """What is run: the laws, as its file was last read."""
        return self._experiment

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
        """What is simulated, at the present row."""
        if self.row == self.newest:
            return self._world.scenario
        return self._past.scenario_at(self.row)

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
    def error(self) -> LawError | None:
        """What a law, sensor or add-on raised at the newest row; None if none did."""
        return self._errors.get(self._world)

    @property
    def record(self) -> Record:
        """The record of the present branch, which holds those of the others as its `branches`.

        Where a run is not over, it says that the window was closed.
        """
        branches = tuple(_closed(world) for world in self.branches)
        return replace(_closed(self._world), branches=branches)

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
            self._driven.update(self._world.hands.driven)
            with self._noting():
                self._world.step()
            self.row = self.newest
            self._write()
            self._observe()

    def _write(self, same: int = 0) -> None:
        """Let the log write what is new. same: how many rows are those that it has already.

        A DiskError ends the run.
        """
        if self._log is None:
            return
        try:
            self._log.follow(self._world, same)
        except DiskError as error:
            self._world.break_off(f"Error: {error}")
            raise

    def go(self, row: int) -> None:
        """Look at a row; at the nearest one that is there."""
        self.row = min(max(row, 0), self.newest)
        self._gone_back |= self.row < self.newest

    def _observe(self) -> None:
        """Read the sensors of what is seen next."""
        if not self._world.over:
            with self._noting():
                self._world.observe()

    @contextmanager
    def _noting(self) -> Iterator[None]:
        """Keep the error that ends the run, for whoever comes back to it."""
        try:
            yield
        except LawError as error:
            self._errors[self._world] = error
            raise

    # -- branches -----------------------------------------------------------------------------

    @property
    def needs_way_back(self) -> bool:
        """Whether a world has to be made again before something can be changed at this row."""
        return self.row < self.newest or self._world.over

    def idle(self, seconds: float) -> None:
        """Use time that is left to prepare for changes in the past, once somebody has gone back.

        A world gets to the row that is looked at, or worlds wait evenly apart. It takes no longer
        than that by more than a control step does; a file is opened at the newest row only if there
        is time for it.
        """
        own = self._experiment.opened is not None  # else worlds would share what laws remember
        if not (own and self._gone_back) or self._hopeless:
            return
        if self._cost > seconds:
            self._cost *= 0.99  # it may have been slow by chance
            return
        try:
            if self.row < self.newest:
                self._approach(self.row, seconds)
            elif self.newest >= 2 * PARKED:
                self._spread(seconds)
        except Mars2dError:
            self._waiting, self._hopeless = [], True  # whoever asks for it is told why

    def branch(self, progress: Progress = lambda _: True) -> World:
        """Return a world at the present row that may be changed and gone on with.

        What was run after it becomes a branch. Hands let go of what they pulled or drove. progress:
        is told how much of the way back is done; if it returns False, nothing happens. Raises
        InputError if that is so, and if the world does not become what it was.
        """
        self.remark = ""
        if self.needs_way_back:
            self._adopt(self._way_back(progress, self._lines[self._world].since))
            self.remark = self._doubt
        return self._world

    def change(self, act: Callable[[World], None], progress: Progress = lambda _: True) -> None:
        """Do something to the world at the present row, of a branch where that is in the past.

        Where `act` raises InputError, all is as it was before.
        """
        before, branches = self._world, [*self.branches]
        lines, errors = dict(self._lines), dict(self._errors)
        world = self.branch(progress)
        log = [*world.hands.log]
        try:
            act(world)
        except InputError:
            if world is not before:
                self._world, self.branches = before, branches
                self._write(self.row)
                self._lines, self._errors = lines, errors
                if world.hands.log == log and not world.hands.driven:  # it may be asked for again
                    world.watch = None
                    self._waiting.append(world)
            raise

    def check(self, experiment: Experiment) -> None:
        """Refuse an experiment that `take` can't go on with; the InputError says why not."""
        check_alike(self._experiment.scenario, experiment.scenario)

    def take(self, experiment: Experiment, progress: Progress = lambda _: True) -> str:
        """Go on from the present row with an experiment read again; return what happens, in words.

        Its laws are asked along all that was run, as if they had watched, while the robots did what
        they did: so they know what has been before, and going back stays exact. Raises InputError,
        and leaves all as it is, where a new start is needed (see `hot_reload.check_alike`),
        and where a law fails on the way.
        """
        before, waiting = self._experiment, self._waiting
        self.check(experiment)
        self._experiment, self._waiting = experiment, []
        ended = self.over and self._world.finished
        try:
            if not ended:
                world = self._way_back(progress, NEVER, self._built(experiment))
                wanted = merged(before.scenario, experiment.scenario, world.scenario)
                if self.row or wanted != world.scenario:
                    world.change(wanted, world.control)  # so the record tells of it
        except Mars2dError:
            self._experiment, self._waiting = before, waiting
            raise
        self._doubt, self._hopeless = "", False
        self._lines = {w: replace(line, since=NEVER) for w, line in self._lines.items()}
        if ended:
            return "in effect where you go back and change something; R runs it from the start"
        self._adopt(world)
        return "in effect from now on; R runs it from the start"

    def _adopt(self, world: World) -> None:
        """Go on with a world at the present row; the one before becomes a branch.

        It does not where it has the same rows, unless they ended as they should.
        """
        before, row = self._world, self.row
        line = self._lines[before]
        if row < before.iteration or before.finished:
            self.branches.append(before)
        else:
            del self._lines[before]
            self._errors.pop(before, None)
        self._count += 1
        self._lines[world] = line.off(self._count, row)
        self._world = world
        self._waiting = [each for each in self._waiting if each.iteration < row]
        world.hands.let_go()
        world.watch = watch_by(self._watchers)
        self._write(row)

    def other_branch(self) -> None:
        """Go to the branch that was left longest ago, at the same row if it has it."""
        if not self.branches:
            return
        other = self.branches.pop(0)
        self.branches.append(self._world)
        common = self._lines[self._world].common(self._lines[other])
        self._waiting = [world for world in self._waiting if world.iteration < common]
        self._world = other
        self._write(common)
        self.go(self.row)

    def parted(self, other: World) -> int:
        """Return the row up to which another branch is the same as the present one."""
        return self._lines[self._world].common(self._lines[other])

    # -- ways back ------------------------------------------------------------------------------

    def _way_back(self, progress: Progress, since: int, first: World | None = None) -> World:
        """Return a world that is as it was at the present row, and has read its sensors there.

        since: the row from which on the laws are asked again that gave the commands. first: the
        world to begin with, if it has to be a certain one.
        """
        row = self.row
        self._hopeless = False
        if first is not None:
            self._waiting.append(first)
        start = self._nearest(row)
        begun = 0 if start is None else start.iteration
        while not self._approach(row, SLICE, since):
            here = self._nearest(row)
            done = (0 if here is None else here.iteration) - begun
            if not progress(done / max(1, row - begun)):
                raise InputError("going back was broken off: nothing was changed")
        world = self._nearest(row)
        assert world is not None
        with _quiet():
            try:
                self._redo(world)
                world.observe()
            except LawError:
                self._waiting.remove(world)
                raise
        if world.over:
            self._waiting.remove(world)
            raise InputError(
                f"nothing follows this step, whatever is changed: {world.over_message}"
            )
        self._check_same(world, row)
        return world

    def _check_same(self, world: World, row: int) -> None:
        before = self._world
        if row == before.iteration:
            was, props = before.pose, before.prop_pose
        else:
            was, props = before.history.pose[row], before.history.prop_pose[row]
        if not (np.array_equal(world.pose, was) and np.array_equal(world.prop_pose, props)):
            self._waiting = []
            raise InputError(_not_the_same(row))

    def _nearest(self, row: int) -> World | None:
        """Return the world that waits last before a row, or at it."""
        before = [world for world in self._waiting if world.iteration <= row and not world.over]
        return max(before, key=lambda world: world.iteration, default=None)

    def _open(self) -> World:
        """Let another world wait, at the start; one of those that wait goes if there are many."""
        start = perf_counter()
        with _quiet():
            fresh = self._experiment.reopened()
            self.check(fresh)
            world = self._built(fresh)
        self._opening = perf_counter() - start
        waiting = sorted((w for w in self._waiting if not w.over), key=lambda w: w.iteration)
        if len(waiting) > PARKED:
            gaps = [b.iteration - a.iteration for a, b in pairwise(waiting)]
            del waiting[int(np.argmin(gaps)) + 1]
        self._waiting = [*waiting, world]
        return world

    def _built(self, fresh: Experiment) -> World:
        """Return a world at the start of this run, with the laws of an experiment read again."""
        return open_world(replace(fresh, scenario=carried(fresh.scenario, self._start)), self._seed)

    def _approach(self, row: int, seconds: float, since: int | None = None) -> bool:
        """Let the nearest world go on to a row for some time; return whether it is there."""
        world = self._nearest(row) or self._open()
        if since is None:
            since = self._lines[self._world].since
        return self._follow(world, row, perf_counter() + seconds, since)

    def _spread(self, seconds: float) -> None:
        """Let worlds get to where the past is divided evenly, the one that is last first."""
        if len(self._waiting) < PARKED:
            if self._opening > seconds:
                self._opening *= 0.99  # it may have been slow by chance
            else:
                self._open()
            return
        deadline = perf_counter() + seconds
        since = self._lines[self._world].since
        places = [(k + 1) * self.newest // (PARKED + 1) for k in range(PARKED)]
        self._waiting.sort(key=lambda world: world.iteration)
        for world, place in reversed([*zip(self._waiting, places, strict=False)]):
            if not self._follow(world, place, deadline, since):
                return

    def _follow(self, world: World, row: int, deadline: float, since: int) -> bool:
        """Let a world do what was done before, up to a row; return whether it got there in time."""
        commands = self._world.history.command
        now = perf_counter()
        with _quiet():
            while world.iteration < row:
                if now > deadline:
                    return False
                if world.over:
                    raise InputError(f"run again, it ended before: {world.over_message}")
                self._redo(world)
                k = world.iteration
                asked = world.follow(commands[k])
                if k >= since and not self._doubt:
                    self._compare(asked, commands[k], k)
                start, now = now, perf_counter()
                self._cost = max(now - start, 0.9 * self._cost)
        return True

    def _redo(self, world: World) -> None:
        """Do to a world what was done at this row, unless that was done already."""
        row, log = world.iteration, world.hands.log
        if log and log[-1].row == row:
            return
        for intervention in self._interventions(row):
            if isinstance(intervention, Change):
                scenario = carried(world.scenario, intervention.scenario)
                world.change(scenario, world.control, dict(intervention.moved))
            else:
                world.hands.redo(intervention)

    def _interventions(self, row: int) -> list[Intervention]:
        log = self._world.hands.log
        first, last = (side(log, row, key=_row) for side in (bisect_left, bisect_right))
        return log[first:last]

    def _compare(self, asked: Float, given: Float, row: int) -> None:
        """Note where a law asks for another command than it did, unless hands drove its robot."""
        others = set(np.flatnonzero((asked != given).any(axis=0)).tolist()) - self._driven
        if others:
            name = self._start.robots[min(others)].name
            self._doubt = (
                f"asked again, the law of {name} gave another command at step {row}: it depends on "
                "something outside of the world, such as random numbers that are not robot.rng. "
                "All moved as before, but what the law remembers may be different"
            )


@dataclass(frozen=True, slots=True)
class _Line:
    """Which rows of a branch are the same as another's.

    parts: the branches that it is made of: their numbers, and the rows from which on. since: the
    row from which on its laws are those of the experiment as it is now.
    """

    parts: tuple[tuple[int, int], ...]
    since: int = 0

    def off(self, number: int, row: int) -> _Line:
        """Return the line of a new branch off this one, whose laws are those of now."""
        parts = [part for part in self.parts if part[1] <= row]
        return _Line((*parts, (number, row)), min(self.since, row))

    def common(self, other: _Line) -> int:
        """Return up to which row this and another are the same."""
        shared = 0
        for mine, others in zip(self.parts, other.parts, strict=False):
            if mine != others:
                break
            shared += 1
        rest = [*self.parts[shared:][:1], *other.parts[shared:][:1]]
        return min((row for _, row in rest), default=NEVER)


def _row(intervention: Intervention) -> int:
    return intervention.row


def _not_the_same(row: int) -> str:
    return (
        f"can't go back: run again, things were not the same at step {row}. Does a law, a sensor "
        "or an add-on depend on something outside of the world?"
    )


def _closed(world: World) -> Record:
    """Return the record of a world, which says that the window was closed if it was not over."""
    return (
        world.record if world.over else replace(world.record, over_message="The window was closed")
    )


@contextmanager
def _quiet() -> Iterator[None]:
    """Let nothing be printed twice, and nobody be asked for input again."""
    with Path(os.devnull).open("w", encoding="utf-8") as nothing:
        stdin, sys.stdin = sys.stdin, io.StringIO()
        try:
            with redirect_stdout(nothing), redirect_stderr(nothing):
                yield
        finally:
            sys.stdin = stdin
