"""A run in which one can go back, look at the past, and go on from there."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from copy import copy
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError, LawError
from mars2d.record.columns import DiskError
from mars2d.record.frame import Frame
from mars2d.record.interventions import Change, Intervention, of_one_hand
from mars2d.scenario.changes import alike, check_same, merged
from mars2d.scenario.experiment import Experiment
from mars2d.scenario.scenario import Scenario
from mars2d.world.loop import open_world, watch_by
from mars2d.world.moments import moments_of
from mars2d.world.past import Past, Progress, Track
from mars2d.world.record import Record
from mars2d.world.world import Watcher, World

if TYPE_CHECKING:
    from mars2d.output.formats.mcap import Log

NEVER = sys.maxsize
"""A row that no run reaches."""


class Timeline:
    """A run in a window: rows up to the newest can be looked at, and gone on from.

    A row is looked at as it was recorded. To change something there, a world is made that is as it
    was: a fork of the last snapshot before it, or else one from the start, goes on under the
    commands that were given then. Laws are asked again on the way, so that they remember what they
    did. The rows after it become another branch, to which one can go back.

    For a world from the start the experiment's file is run again, so no two worlds share what a law
    keeps in its module. What laws print is not repeated, but other effects outside of the world,
    such as writing a file, are.

    watchers: called at each control step. log: writes each row of the present branch to a file.

    world: at the newest row. row: the present one. branches: the worlds of the other branches, the
    one left longest ago first. remark: a warning about the last way back, or empty.
    """

    def __init__(
        self,
        experiment: Experiment,
        watchers: Sequence[Watcher] = (),
        log: Log | None = None,
    ) -> None:
        self._log = log
        self._watchers = watchers
        self._earlier: list[Timeline] = []  # those of runs in which hands did something
        self._begin(experiment)
        with suppress(LawError):  # of a sensor at the start: it is kept as `error`
            self._observe()

    def restart(self, experiment: Experiment | None = None) -> None:
        """Start again, with the experiment as its file is now, or as given.

        A run in which hands did something is kept, with its branches, as one of `others`.
        """
        again = self.experiment.reopened() if experiment is None else experiment
        before = [copy(self)] if self.touched else []
        self._begin(again)
        self._earlier += before
        self._observe()

    def _begin(self, experiment: Experiment) -> None:
        """Build the world of an experiment whose laws have not been asked yet."""
        self.world = open_world(experiment, self._watchers)
        self._past = Past(experiment)
        self.branches: list[World] = []
        self.row = 0
        self.remark = ""
        self._lines = {self.world: _Line(())}
        self._seen: tuple[World, int, Record] | None = None
        self._write()

    # -- the present row -------------------------------------------------------------------------

    @property
    def experiment(self) -> Experiment:
        """Its laws, as its file was last read, its options, and its scenario at the start."""
        return self._past.experiment

    @property
    def newest(self) -> int:
        """The row up to which was run."""
        return self.world.iteration

    @property
    def scenario(self) -> Scenario:
        """The scenario at the present row."""
        if self.row == self.newest:
            return self.world.scenario
        return self.recorded.scenario_at(self.row)

    @property
    def frame(self) -> Frame:
        """The frame of the present row."""
        if self.row == self.newest:
            return self.world.frame
        frame = self.recorded.frame(self.row)
        if not frame.over_message:
            return frame
        return replace(frame, over_message="", draw_addons=None)

    @property
    def contacts(self) -> NDArray[np.void]:
        """The contacts of all rows up to the newest."""
        return self.world.frame.contact_log()

    @property
    def over(self) -> bool:
        """Whether this is the newest row and nothing follows it."""
        return self.row == self.newest and self.world.over

    @property
    def error(self) -> LawError | None:
        """The error of a law, sensor or add-on at the newest row, or None."""
        return self.world.simulation.error

    @property
    def record(self) -> Record:
        """The record of the present branch, which holds those of the others as its `branches`.

        Where a run is not over, it says that the window was closed.
        """
        others = [*self.branches]
        for run in self._earlier:
            others += [run.world, *run.branches]
        return replace(_closed(self.world), branches=tuple(_closed(world) for world in others))

    @property
    def options(self) -> dict[str, Any]:
        """The options that hold at the newest row of the present branch, by name."""
        return options_of(self.world)

    @property
    def touched(self) -> bool:
        """Whether hands did anything in this run, so that it can't just be run again."""
        return bool(self.branches or self.world.operator.log or self._past.driven)

    @property
    def changed(self) -> bool:
        """Whether hands changed this run or one of `others`; to drive a robot is no change."""
        return any(world.operator.log for world in (self.world, *self.others))

    @property
    def recorded(self) -> Record:
        """The record of the present branch so far, kept as long as nothing is run."""
        world = self.world
        if self._seen is None or self._seen[:2] != (world, world.iteration):
            self._seen = world, world.iteration, world.record
        return self._seen[2]

    @property
    def _track(self) -> Track:
        """The rows of the present branch, as a world that is made again follows them."""
        return Track(self.world, self._lines[self.world].since)

    # -- going on, going back -----------------------------------------------------------------

    def advance(self) -> None:
        """Go on by one row: one that is recorded, or else by a control step.

        A LawError ends the run and carries its record.
        """
        if self.row < self.newest:
            self.row += 1
        elif not self.world.over:
            self._past.driven.update(self.world.operator.driven)
            self.world.step()
            if self._track.since < NEVER:  # its laws are those of the experiment
                self._past.keep(self.world)
            self.row = self.newest
            self._write()
            self._observe()

    def _write(self, same: int = 0) -> None:
        """Let the log write the new rows. same: the number of rows that it has already.

        A DiskError ends the run.
        """
        if self._log is None:
            return
        try:
            self._log.follow(self.world, same)
        except DiskError as error:
            self.world.break_off(f"Error: {error}")
            raise

    def go(self, row: int) -> None:
        """Look at a row, or the nearest one that there is."""
        self.row = min(max(row, 0), self.newest)

    def _observe(self) -> None:
        """Read the sensors for the present instant."""
        if not self.world.over:
            self.world.observe()

    # -- branches -----------------------------------------------------------------------------

    @property
    def needs_way_back(self) -> bool:
        """Whether a world has to be made again before something can be changed at this row."""
        return self.row < self.newest or self.world.over

    def change(self, act: Callable[[World], None], progress: Progress = lambda _: True) -> None:
        """Do something to the world at the present row; in the past, to one that is as it was.

        That goes on, and the rows after it become a branch. progress: called with the share of the
        way back that is done; if it returns False, nothing changes. Nor does it where an InputError
        is raised, by `act` or because the world does not become the same again.
        """
        self.remark = ""
        world = self.world
        if self.needs_way_back:
            world = self._past.world_at(self._track, self.row, progress)
            world.operator.let_go()
        if options_of(world) != self.experiment.options:  # they were set later than this row
            self._change_to(self.experiment, world)
        act(world)
        if world is not self.world:
            self._adopt(world)

    def within(self, progress: Progress = lambda _: True) -> list[Frame]:
        """Return the moments within the control step that follows the present row.

        See `mars2d.world.moments`. Nothing is recorded. Raises InputError as `change` does.
        """
        world, known = self._past.world_at(self._track, self.row, progress), self.row < self.newest
        command = self.world.history.command[self.row] if known else None
        return moments_of(world, self.frame, command)

    def undo(self, progress: Progress = lambda _: True) -> Intervention:
        """Go on from before the last thing that was done by hand; return that.

        The run with it becomes a branch. Raises InputError if there is nothing to undo, and as
        `change` does.
        """
        log = self.world.operator.log
        if not log:
            raise InputError("nothing was done by hand")
        done = len(log) - 1
        while done and of_one_hand(log[done - 1], log[done]):
            done -= 1
        row = log[done].row
        self._past.forget_after(row)
        past = self._with_options(options_of(self.world, done))
        world = past.world_at(replace(self._track, done=done), row, progress)
        world.operator.let_go()
        self.row, self._past = row, past
        self._adopt(world)
        return log[done]

    def _with_options(self, options: dict[str, Any]) -> Past:
        """Return the past, or that of the same run with other options."""
        if options == self.experiment.options:
            return self._past
        return self._past.with_laws_of(self.experiment.with_options(options))

    def check(self, experiment: Experiment) -> None:
        """Raise InputError for an experiment that `take` can't go on with."""
        check_same(self.experiment.scenario, experiment.scenario, alike)

    def set(
        self,
        options: Mapping[str, Any],
        progress: Progress = lambda _: True,
        *,
        restart: bool = True,
    ) -> str:
        """Set parameters of the experiment, by the names of ``--set``.

        The run goes on with them from the present row if it can, else it starts again; returns the
        reason for a new start, or "". restart: whether it may start again; else it stays as it is.
        Raises InputError, and changes nothing, where there are no such parameters, or no such
        values.
        """
        before = self.experiment
        after = before.with_options({**before.options, **options})
        begun = self.newest > 0 or self.touched
        reason = self._needs_start(after) if begun else ""
        if begun and not reason:
            self.take(after, progress)
        elif restart or not reason:
            self.restart(after)
        return reason

    def _needs_start(self, experiment: Experiment) -> str:
        """Return the reason why the run can't go on with an experiment, or ""."""
        if self.over and self.world.finished:
            return "the run is over"
        before, after = self.experiment.scenario, experiment.scenario
        try:
            self.check(experiment)
        except InputError as error:
            return str(error).partition(": ")[2]
        for one, other in zip(before.bodies, after.bodies, strict=True):
            if one.pose != other.pose:
                return f"{one.name} starts elsewhere"
        return ""

    def take(self, experiment: Experiment, progress: Progress = lambda _: True) -> str:
        """Go on from the present row with an experiment read again; return the effect, in words.

        Other laws are asked along all rows, while the robots do what they did: so the laws remember
        the run, and going back stays exact. Raises InputError, and changes nothing, where a new
        start is needed (see `changes.check_same`), and where a law fails on the way.
        """
        self.check(experiment)
        ended = self.over and self.world.finished
        goes_on = not self.needs_way_back and experiment.decides_as(self.experiment)
        if goes_on:  # with its laws as they are
            self._change_to(experiment, self.world)
            self._past.experiment = experiment
            return "in effect from now on; R runs it from the start"
        past = self._past.with_laws_of(experiment)
        if not ended:
            track = Track(self.world, NEVER)
            world = past.world_at(track, self.row, progress, past.opened(experiment))
            world.operator.let_go()
            self._change_to(experiment, world)
        self._past = past
        self._lines = {w: replace(line, since=NEVER) for w, line in self._lines.items()}
        if ended:
            return "in effect where you go back and change something; R runs it from the start"
        self._adopt(world)
        return "in effect from now on; R runs it from the start"

    def _change_to(self, experiment: Experiment, world: World) -> None:
        """Change a world where an experiment differs from the one whose options it has."""
        before, held = self.experiment, options_of(world)
        if held != before.options:
            before = before.with_options(held)
        wanted = merged(before.scenario, experiment.scenario, world.scenario)
        made = {k: v for k, v in experiment.options.items() if k not in held or held[k] != v}
        if self.row or wanted != world.scenario or made:
            world.change(wanted, world.control, options=made)  # so the record tells of it

    def _adopt(self, world: World) -> None:
        """Go on with a world at the present row; the one before becomes a branch.

        It does not where it has the same rows, unless they ended as they should.
        """
        before, row = self.world, self.row
        line = self._lines[before]
        if row < before.iteration or before.finished:
            self.branches.append(before)
        else:
            del self._lines[before]
        self._lines[world] = line.off(row)
        self.world = world
        self.remark = self._past.doubt
        self._past.forget_after(row)
        world.watch = watch_by(self._watchers)
        self._write(row)

    @property
    def others(self) -> list[World]:
        """The worlds that can be shown: those of other branches, then those of earlier runs."""
        return [*self.branches, *(run.world for run in self._earlier)]

    def show(self, other: World) -> None:
        """Go to one of `others`, at the same row if it has it."""
        if other not in self.branches:
            self._show_run(other)
            return
        self._past = self._with_options(options_of(other))
        self.branches.remove(other)
        self.branches.append(self.world)
        common = self._lines[self.world].common(self._lines[other])
        self._past.forget_after(common)
        self.world = other
        self._write(common)
        self.go(self.row)

    def _show_run(self, other: World) -> None:
        """Go to an earlier run; this one becomes one of them."""
        run = next(run for run in self._earlier if run.world is other)
        others = [each for each in self._earlier if each is not run]
        vars(self).update(vars(run), _earlier=[*others, copy(self)])
        self._write()

    def parted(self, other: World) -> int:
        """Return the row up to which another branch is the same as the present one."""
        return self._lines[self.world].common(self._lines[other])


@dataclass(frozen=True, slots=True)
class _Line:
    """The rows of a branch, as parts of branches, to find those that two have in common.

    parts: a mark of each branch that it went through, and the row at which that begins. since: the
    row from which on its laws are those of the experiment as it is now.
    """

    parts: tuple[tuple[object, int], ...]
    since: int = 0

    def off(self, row: int) -> _Line:
        """Return the line of a new branch off this one, whose laws are those of now."""
        parts = [part for part in self.parts if part[1] <= row]
        return _Line((*parts, (object(), row)), min(self.since, row))

    def common(self, other: _Line) -> int:
        """Return up to which row this and another are the same."""
        return min((row for _, row in {*self.parts} ^ {*other.parts}), default=NEVER)


def options_of(world: World, done: int | None = None) -> dict[str, Any]:
    """Return the options that hold at the newest row of a world; done: after so many changes."""
    options = dict(world.recorder.options)
    for each in world.operator.log[:done]:
        if isinstance(each, Change):
            options.update(each.options)
    return options


def _closed(world: World) -> Record:
    """Return the record of a world, which says that the window was closed if it was not over."""
    return (
        world.record if world.over else replace(world.record, over_message="The window was closed")
    )
