"""Where a window's frames come from: a live experiment or a recorded one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

from mars2d.files import Experiment
from mars2d.frame import Frame
from mars2d.loop import open_world
from mars2d.record import Record
from mars2d.scenario import Scenario
from mars2d.world import Watcher

__all__ = ["Live", "Playback", "Source"]


class Source(Protocol):
    """What the window plays: a sequence of frames, one a sampling time."""

    @property
    def scenario(self) -> Scenario:
        """What is played."""

    @property
    def frame(self) -> Frame:
        """The present instant."""

    @property
    def over(self) -> bool:
        """Whether there is no further frame."""

    def advance(self) -> None:
        """Go on by one sampling time. Raises Mars2dError when a law fails; nothing when over."""

    def restart(self) -> None:
        """Go back to the start."""


class Live:
    """A live experiment: each advance is one control step of its world."""

    def __init__(
        self, experiment: Experiment, seed: int = 0, watchers: Sequence[Watcher] = ()
    ) -> None:
        self._experiment = experiment
        self._seed = seed
        self._watchers = watchers
        self.restart()

    def restart(self) -> None:
        """Build the world anew."""
        self._world = open_world(self._experiment, self._seed, self._watchers)
        self._observe()

    @property
    def scenario(self) -> Scenario:
        """What is simulated."""
        return self._world.scenario

    @property
    def frame(self) -> Frame:
        """The present instant."""
        return self._world.frame

    @property
    def over(self) -> bool:
        """Whether the experiment is over."""
        return self._world.over

    @property
    def record(self) -> Record:
        """The record so far; where it is not over, it says that the window was closed."""
        record = self._world.record
        if self._world.over:
            return record
        return replace(record, over_message="The window was closed")

    def advance(self) -> None:
        """Do one control step. A LawError ends the experiment and carries its record."""
        if not self._world.over:
            self._world.step()
            self._observe()

    def _observe(self) -> None:
        """Read the sensors of what is seen next."""
        if not self._world.over:
            self._world.observe()


class Playback:
    """A recorded run, row by row."""

    def __init__(self, record: Record) -> None:
        self._record = record
        self._row = 0

    @property
    def scenario(self) -> Scenario:
        """What was simulated."""
        return self._record.scenario

    @property
    def frame(self) -> Frame:
        """The present row."""
        return self._record.frame(self._row)

    @property
    def over(self) -> bool:
        """Whether this is the last row."""
        return self._row == len(self._record) - 1

    def advance(self) -> None:
        """Go on by one row."""
        self._row = min(self._row + 1, len(self._record) - 1)

    def restart(self) -> None:
        """Go back to the first row."""
        self._row = 0
