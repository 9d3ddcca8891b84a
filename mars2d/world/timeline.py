"""A run in which one can go back, look at the past, and go on from there."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError, LawError
from mars2d.record.columns import DiskError
from mars2d.record.frame import Frame
from mars2d.record.interventions import Intervention, of_one_hand
from mars2d.scenario.changes import alike, hindrances, merged
from mars2d.scenario.experiment import Experiment
from mars2d.scenario.scenario import Scenario
from mars2d.world.branch import NEVER, Branch, Progress, options_of
from mars2d.world.loop import open_world, watch_by
from mars2d.world.moments import moments_of
from mars2d.world.record import Record
from mars2d.world.world import Watcher, World

if TYPE_CHECKING:
    from mars2d.output.formats.mcap import Log


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

    branch: the present one. row: that is looked at. experiment: its laws, as its file was last
    read, its options, and its scenario at the start. others: the branches that can be shown, of
    this run and of earlier ones that hands changed; the next one first.
    """

    def __init__(
        self,
        experiment: Experiment,
        watchers: Sequence[Watcher] = (),
        log: Log | None = None,
    ) -> None:
        self._watchers, self._log = watchers, log
        self.others: list[Branch] = []
        self._seen: tuple[World, int, Record] | None = None
        self._begin(experiment)
        with suppress(LawError):  # of a sensor at the start: it is kept as `error`
            self.world.observe()

    def restart(self, experiment: Experiment | None = None) -> None:
        """Start again, with the experiment as its file is now, or as given.

        A run in which hands did something is kept, with its branches, among the `others`.
        """
        again = self.experiment.reopened() if experiment is None else experiment
        before = [self.branch] if self.touched else []
        self._begin(again)
        self.others = before + self.others
        self._forget()
        self.world.observe()

    def _begin(self, experiment: Experiment) -> None:
        """Begin a run of an experiment whose laws have not been asked yet."""
        world = open_world(experiment, self._watchers)
        self.row, self.experiment = 0, experiment
        self.branch = Branch(world, experiment, [(object(), 0)])
        self._write()

    # -- the present row -------------------------------------------------------------------------

    @property
    def world(self) -> World:
        """The world of the present branch, which is at its newest row."""
        return self.branch.world

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
        first, *others = (
            each.world.record
            if each.world.over
            else replace(each.world.record, over_message="The window was closed")
            for each in (self.branch, *self.others)
        )
        return replace(first, branches=tuple(others))

    @property
    def touched(self) -> bool:
        """Whether hands did anything in this run, so that it can't just be run again."""
        return bool(self.branches or self.world.operator.log)

    @property
    def changed(self) -> bool:
        """Whether hands did anything in this run or in one of the `others`."""
        return any(each.world.operator.log for each in (self.branch, *self.others))

    @property
    def recorded(self) -> Record:
        """The record of the present branch so far, kept as long as nothing is run."""
        world = self.world
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
        elif not self.world.over:
            self.world.step()
            self.branch.keep()
            self.row = self.newest
            self._write()
            self.world.observe()

    def _write(self, same: int = 0) -> None:
        """Let the log write the new rows. same: the number of rows that it has already.

        A DiskError ends the run.
        """
        try:
            if self._log is not None:
                self._log.follow(self.world, same)
        except DiskError as error:
            self.world.break_off(f"Error: {error}")
            raise

    def go(self, row: int) -> None:
        """Look at a row, or the nearest one that there is."""
        self.row = min(max(row, 0), self.newest)

    # -- branches -----------------------------------------------------------------------------

    @property
    def branches(self) -> list[Branch]:
        """Those of the others that are of this run, the one left longest ago first."""
        return [each for each in self.others if each.parts[0] == self.branch.parts[0]]

    @property
    def needs_way_back(self) -> bool:
        """Whether a world has to be made again before something can be changed at this row."""
        return self.row < self.newest or self.world.over

    def change(
        self,
        act: Callable[[World], None],
        progress: Progress = lambda _: True,
        experiment: Experiment | None = None,
    ) -> None:
        """Do something to the world at the present row; in the past, to one that is as it was.

        That goes on, and the rows after it become a branch. progress: called with the share of the
        way back that is done; if it returns False, nothing changes. Nor does it where an InputError
        is raised, by `act` or because the world does not become the same again. experiment: with
        which it goes on; None: the present one. Other laws are asked along all rows, while the
        robots do what they did: so they remember the run, and going back stays exact.
        """
        branch, before, after = self.branch, self.branch.experiment, experiment or self.experiment
        if self.needs_way_back or not branch.decides_as(after):
            branch = branch.off(self.row, progress, after)
            branch.world.operator.let_go()
        world, held = branch.world, options_of(branch.world)
        if after is not before or held != after.options:  # which were set later than this row
            before = before if held == before.options else before.with_options(held)
            wanted = merged(before.scenario, after.scenario, world.scenario)
            made = {k: v for k, v in after.options.items() if k not in held or held[k] != v}
            if self.row or wanted != world.scenario or made:
                world.change(wanted, world.control, options=made)  # so the record tells of it
        act(world)
        self._adopt(branch, after)

    def within(self, progress: Progress = lambda _: True) -> list[Frame]:
        """Return the moments within the control step that follows the present row.

        See `mars2d.world.moments`. Nothing is recorded. Raises InputError as `change` does.
        """
        world = self.branch.off(self.row, progress, self.branch.experiment).world
        known = self.row < self.newest
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
        experiment, held = self.experiment, options_of(self.world, done)
        if held != experiment.options:
            experiment = experiment.with_options(held)
        branch = self.branch.off(log[done].row, progress, experiment, done)
        branch.world.operator.let_go()
        self._adopt(branch, experiment)
        return log[done]

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
        after = self.experiment.with_options({**self.experiment.options, **options})
        begun, reason = self.newest > 0 or self.touched, ""
        if begun:
            moved = [f"{name} starts elsewhere" for name in self._moved(after)]
            ended = ["the run is over"] * (self.over and self.world.finished)
            reason = next(filter(None, [*ended, self._needs_start(after), *moved]), "")
        if begun and not reason:
            self.change(lambda _: None, progress, after)
        elif restart or not reason:
            self.restart(after)
        return reason

    def _needs_start(self, experiment: Experiment) -> str:
        """Return the reason why the run can't go on with an experiment, or ""."""
        return next(hindrances(self.experiment.scenario, experiment.scenario, alike), "")

    def _moved(self, experiment: Experiment) -> list[str]:
        """Return the names of bodies that start elsewhere in an experiment."""
        pairs = zip(self.experiment.scenario.bodies, experiment.scenario.bodies, strict=False)
        return [str(after.name) for before, after in pairs if before.pose != after.pose]

    def take(self, experiment: Experiment, progress: Progress = lambda _: True) -> str:
        """Go on from the present row with an experiment read again, or start again if need be.

        At the end it holds for what is changed from then on. Returns the effect in words. Raises
        InputError, and changes nothing, where a law fails on the way.
        """
        if reason := self._needs_start(experiment):
            self.restart(experiment)
            return f"started again: {reason}"
        moved, effect = self._moved(experiment), "in effect from now on"
        if self.over and self.world.finished:
            self.experiment, effect = experiment, "in effect where you go back and change something"
            self._forget()
        else:
            self.change(lambda _: None, progress, experiment)
        there = f"R starts {', '.join(moved)} from there; all else is " if moved else ""
        return f"{there}{effect}; R runs it from the start"

    def _adopt(self, branch: Branch, experiment: Experiment) -> None:
        """Go on with a branch; the one before becomes another one.

        It does not where it has the same rows, unless they ended as they should.
        """
        before, row = self.branch, branch.world.iteration
        branch.experiment = self.experiment = experiment
        if branch is not before:
            if row < before.world.iteration or before.world.finished:
                self.others.append(before)
            self.branch, self.row = branch, row
            branch.world.watch = watch_by(self._watchers)
            self._write(row)
        self._forget()

    def _forget(self) -> None:
        """Drop snapshots of other branches, and let those of older files be repeated with these."""
        for each in (self.branch, *self.others):
            older = each.experiment.source.written != self.experiment.source.written
            each.since = NEVER if older else each.since
            if older or each is not self.branch:
                each.snapshots = {}

    def show(self, other: Branch) -> None:
        """Go to one of the others, at the same row if it has it; of another run, at the newest."""
        before, common = self.branch, self.branch.common(other)
        row = self.row if other in self.branches else other.world.iteration
        if other.experiment is before.experiment:
            other.snapshots = before.upto(common)
        before.snapshots = {}
        self.others.remove(other)
        self.others.append(before)
        self.branch, self.experiment = other, other.experiment
        self._write(common)
        self.go(row)
