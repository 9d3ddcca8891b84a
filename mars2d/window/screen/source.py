"""The source of a window's frames: a live experiment or a record."""

from __future__ import annotations

from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario
from mars2d.world.record import Record


class Source(Protocol):
    """A sequence of frames, one per sampling time, that a window plays.

    A `mars2d.world.timeline.Timeline` is a source that can be changed.
    """

    @property
    def scenario(self) -> Scenario:
        """The scenario of the present row."""

    @property
    def frame(self) -> Frame:
        """The frame of the present row."""

    @property
    def contacts(self) -> NDArray[np.void]:
        """The contacts of all rows, as `Record.contacts`."""

    @property
    def recorded(self) -> Record:
        """The record of all rows that are done."""

    @property
    def row(self) -> int:
        """The present row."""

    @property
    def newest(self) -> int:
        """The last row so far."""

    @property
    def over(self) -> bool:
        """Whether there is no further row."""

    def advance(self) -> None:
        """Advance by one row; do nothing when over. Raises Mars2dError when a law fails."""

    def go(self, row: int) -> None:
        """Go to a row, or to the nearest one that there is."""

    def restart(self) -> None:
        """Go back to the start."""


class Playback:
    """A recorded run, row by row."""

    def __init__(self, record: Record) -> None:
        self.record = record
        self.row = 0

    @property
    def scenario(self) -> Scenario:
        """What was simulated."""
        return self.record.scenario_at(self.row)

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """(xmin, xmax, ymin, ymax) of the workspace [m]; without one, of all ways of the bodies."""
        scenario = self.record.scenario
        if scenario.workspace is not None:
            return scenario.bounds
        poses = self.record.all_poses
        low, high = (find(poses[:, :2], axis=(0, 2)) for find in (np.nanmin, np.nanmax))
        xmin, xmax, ymin, ymax = scenario.bounds
        return (
            min(xmin, float(low[0]) - 1), max(xmax, float(high[0]) + 1),
            min(ymin, float(low[1]) - 1), max(ymax, float(high[1]) + 1),
        )  # fmt: skip

    @property
    def recorded(self) -> Record:
        """The record."""
        return self.record

    @property
    def contacts(self) -> NDArray[np.void]:
        """The contacts of all rows."""
        return self.record.contacts

    @property
    def frame(self) -> Frame:
        """The present row."""
        return self.record.frame(self.row)

    @property
    def newest(self) -> int:
        """The last row."""
        return len(self.record) - 1

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
