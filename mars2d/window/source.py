"""Where a window's frames come from: a live experiment or a recorded one."""

from __future__ import annotations

from typing import Protocol

from mars2d.record.frame import Frame
from mars2d.record.record import Record
from mars2d.scenario.scenario import Scenario

__all__ = ["Playback", "Source"]


class Source(Protocol):
    """What the window plays: a sequence of frames, one a sampling time.

    A `mars2d.world.timeline.Timeline` is one that can be changed, see there.
    """

    @property
    def scenario(self) -> Scenario:
        """What is played."""

    @property
    def frame(self) -> Frame:
        """The present instant."""

    @property
    def row(self) -> int:
        """Which row that is."""

    @property
    def newest(self) -> int:
        """The last row that there is as yet."""

    @property
    def over(self) -> bool:
        """Whether there is no further frame."""

    def advance(self) -> None:
        """Go on by one sampling time. Raises Mars2dError when a law fails; nothing when over."""

    def go(self, row: int) -> None:
        """Go to a row, or to the nearest one that there is."""

    def restart(self) -> None:
        """Go back to the start."""


class Playback:
    """A recorded run, row by row."""

    def __init__(self, record: Record) -> None:
        self._record = record
        self.row = 0

    @property
    def scenario(self) -> Scenario:
        """What was simulated."""
        return self._record.scenario_at(self.row)

    @property
    def frame(self) -> Frame:
        """The present row."""
        return self._record.frame(self.row)

    @property
    def newest(self) -> int:
        """The last row."""
        return len(self._record) - 1

    @property
    def over(self) -> bool:
        """Whether this is the last row."""
        return self.row == self.newest

    def advance(self) -> None:
        """Go on by one row."""
        self.go(self.row + 1)

    def go(self, row: int) -> None:
        """Go to a row, or to the nearest one that there is."""
        self.row = min(max(row, 0), self.newest)

    def restart(self) -> None:
        """Go back to the first row."""
        self.row = 0
