"""The source of a window's frames: a live experiment, a record, or three runs in step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import Mars2dError
from mars2d.output.figures.comparison import MODES, Drift, drifts
from mars2d.record.contact import met
from mars2d.record.frame import Frame, between
from mars2d.record.interventions import Intervention
from mars2d.scenario.scenario import Scenario
from mars2d.world.record import Record
from mars2d.world.timeline import Timeline

RECORDING = "this is a recording: it can be looked at, not changed"


class Playback:
    """A recorded run, row by row."""

    def __init__(self, record: Record) -> None:
        self.recorded = record
        self.row = 0

    @property
    def scenario(self) -> Scenario:
        """What was simulated."""
        return self.recorded.scenario_at(self.row)

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """(xmin, xmax, ymin, ymax) of the workspace [m]; without one, of all ways of the bodies."""
        scenario = self.recorded.scenario
        if scenario.workspace is not None:
            return scenario.bounds
        poses = self.recorded.all_poses
        low, high = (find(poses[:, :2], axis=(0, 2)) for find in (np.nanmin, np.nanmax))
        xmin, xmax, ymin, ymax = scenario.bounds
        return (
            min(xmin, float(low[0]) - 1), max(xmax, float(high[0]) + 1),
            min(ymin, float(low[1]) - 1), max(ymax, float(high[1]) + 1),
        )  # fmt: skip

    @property
    def contacts(self) -> NDArray[np.void]:
        """The contacts of all rows."""
        return self.recorded.contacts

    @property
    def frame(self) -> Frame:
        """The present row."""
        return self.recorded.frame(self.row)

    @property
    def newest(self) -> int:
        """The last row."""
        return len(self.recorded) - 1

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


Float = NDArray[np.float64]


class Trio:
    """A source of three runs, live or recorded, that go on and back together.

    A run that has ended earlier stands still while others go on. What the source shows is the run
    with contact, or the longest one where that goes on without it. runs: by their physics; laws of
    live ones share nothing.
    """

    def __init__(self, runs: Mapping[str, Timeline | Playback]) -> None:
        self.runs = runs
        self._begin()

    def _begin(self) -> None:
        """Begin at the first row, with nothing measured."""
        self.row = 0
        self._before: dict[str, Frame] = {}  # the frames a row earlier, after going on by one
        self._met = {mode: (0, np.zeros(0)) for mode in MODES}  # contacts read, times of collisions
        self._drifts: tuple[list[int], dict[str, Drift]] = [], {}  # of how many rows

    @property
    def _leading(self) -> Timeline | Playback:
        """The run that has got farthest, the one with contact before all others."""
        return max(self.runs.values(), key=lambda run: run.newest)

    # -- a source -----------------------------------------------------------------------------

    @property
    def scenario(self) -> Scenario:
        """The scenario of the run that is shown."""
        return self._leading.scenario

    @property
    def frame(self) -> Frame:
        """The frame of the run that is shown."""
        return self._leading.frame

    @property
    def contacts(self) -> NDArray[np.void]:
        """The contacts of the run with contact."""
        return self.runs["contact"].contacts

    @property
    def recorded(self) -> Record:
        """The record of the run that is shown."""
        return self._leading.recorded

    @property
    def newest(self) -> int:
        """The last row so far, of the longest run."""
        return self._leading.newest

    @property
    def over(self) -> bool:
        """Whether all runs have come to their ends."""
        return self.row == self.newest and all(run.over for run in self.runs.values())

    def advance(self) -> None:
        """Go on by one row in all runs; an error of one is raised after the others have gone on."""
        if self.over:
            return
        self._before = {mode: run.frame for mode, run in self.runs.items()}
        failed: Mars2dError | None = None
        for mode, run in self.runs.items():
            try:
                run.advance()
            except Mars2dError as error:
                error.where = ": ".join(filter(None, [f"physics = {mode!r}", error.where]))
                failed = failed or error
        self.row = min(self.row + 1, self.newest)
        if failed is not None:
            raise failed

    def go(self, row: int) -> None:
        """Look at a row, or the nearest one that there is; at the last one of shorter runs."""
        self.row = min(max(row, 0), self.newest)
        self._before = {}
        for run in self.runs.values():
            run.go(self.row)

    def restart(self) -> None:
        """Begin all runs again, with the experiment's file as it is now."""
        for run in self.runs.values():
            run.restart()
        self._begin()

    # -- side by side -------------------------------------------------------------------------

    def frames(self, time: float) -> dict[str, Frame]:
        """Return the frame of each run at a time [s] since the row before the present one."""
        return {
            mode: between(self._before.get(mode, run.frame), run.frame, time)
            for mode, run in self.runs.items()
        }

    def collisions(self, time: float) -> dict[str, int]:
        """Return how many times two bodies had begun to touch up to a time [s], by physics."""
        for mode, run in self.runs.items():
            read, times = self._met[mode]
            contacts = run.contacts
            new = contacts[read:]
            times = np.append(times, np.sort(new["time"][met(new)]))
            self._met[mode] = len(contacts), times
        return {
            mode: int(times.searchsorted(time, side="right"))
            for mode, (_, times) in self._met.items()
        }

    @property
    def drifts(self) -> dict[str, Drift]:
        """The drift of the runs with "stop" and "ideal" so far from that with "contact"."""
        rows = [run.newest for run in self.runs.values()]
        if self._drifts[0] != rows:
            records = {mode: run.recorded for mode, run in self.runs.items()}
            self._drifts = rows, drifts(records)
        return self._drifts[1]


Source = Timeline | Playback | Trio
"""A sequence of frames, one per sampling time, that a window plays."""


def done_in(source: Source) -> Sequence[Intervention]:
    """Return what was done by hand in a run."""
    if isinstance(source, Timeline):
        return source.world.operator.log
    return source.recorded.interventions if isinstance(source, Playback) else ()
