"""Three runs of an experiment in step, one with each physics, and how far apart they get."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import Mars2dError
from mars2d.output.figures.comparison import MODES
from mars2d.record.contact import met
from mars2d.record.frame import Frame, between
from mars2d.scenario.experiment import Experiment
from mars2d.scenario.scenario import Scenario
from mars2d.world.record import Record
from mars2d.world.timeline import Timeline

Float = NDArray[np.float64]


class Trio:
    """A source of three timelines that go on and back together.

    A run that has ended earlier stands still while others go on. What the source shows is the run
    with contact, or the longest one where that goes on without it.

    opened: returns the experiment of a physics, with laws that share nothing with the others'.
    """

    def __init__(self, opened: Callable[[str], Experiment]) -> None:
        """Build the three worlds; no law has been asked yet."""
        self.timelines: Mapping[str, Timeline] = {mode: Timeline(opened(mode)) for mode in MODES}
        self.row = 0
        self._before: dict[str, Frame] = {}  # the frames a row earlier, after going on by one
        self._measure_anew()

    @property
    def contact(self) -> Timeline:
        """The run with contact."""
        return self.timelines["contact"]

    @property
    def _leading(self) -> Timeline:
        """The run that has got farthest, the one with contact before all others."""
        return max(self.timelines.values(), key=lambda timeline: timeline.newest)

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
        return self.contact.contacts

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
        return self.row == self.newest and all(each.over for each in self.timelines.values())

    def advance(self) -> None:
        """Go on by one row in all runs; an error of one is raised after the others have gone on."""
        if self.over:
            return
        newest = self.newest
        self._before = {mode: timeline.frame for mode, timeline in self.timelines.items()}
        failed: Mars2dError | None = None
        for mode, timeline in self.timelines.items():
            try:
                timeline.advance()
            except Mars2dError as error:
                error.where = ": ".join(filter(None, [f"physics = {mode!r}", error.where]))
                failed = failed or error
        self.row = min(self.row + 1, self.newest)
        if self.newest > newest:
            self._measure()
        if failed is not None:
            raise failed

    def go(self, row: int) -> None:
        """Look at a row, or the nearest one that there is; at the last one of shorter runs."""
        self.row = min(max(row, 0), self.newest)
        self._before = {}
        for timeline in self.timelines.values():
            timeline.go(self.row)

    def restart(self) -> None:
        """Begin all runs again, with the experiment's file as it is now."""
        self.row, self._before = 0, {}
        for timeline in self.timelines.values():
            timeline.restart()
        self._measure_anew()

    # -- side by side -------------------------------------------------------------------------

    def frames(self, time: float) -> dict[str, Frame]:
        """Return the frame of each run at a time [s] since the row before the present one."""
        frames = {}
        for mode, timeline in self.timelines.items():
            now, before = timeline.frame, self._before.get(mode)
            frames[mode] = now if before is None else between(before, now, time)
        return frames

    @property
    def records(self) -> dict[str, Record]:
        """The records of the runs so far."""
        return {mode: timeline.record for mode, timeline in self.timelines.items()}

    @property
    def collisions(self) -> dict[str, int]:
        """How many times two bodies had begun to touch up to the present row, by physics."""
        return {mode: counts[min(self.row, len(counts) - 1)] for mode, counts in self._met.items()}

    @property
    def drifts(self) -> dict[str, Float]:
        """The largest and the mean distance of a body from where contact puts it, (T, 2) metres.

        By the physics "stop" and "ideal", at the rows that both runs have.
        """
        return {mode: np.array(rows).reshape(-1, 2) for mode, rows in self._drifts.items()}

    def _measure_anew(self) -> None:
        self._met: dict[str, list[int]] = {mode: [] for mode in MODES}
        self._drifts: dict[str, list[tuple[float, float]]] = {mode: [] for mode in MODES[1:]}
        self._measure()

    def _measure(self) -> None:
        """Count the collisions, and measure how far the runs are apart, at a row that is new."""
        for mode, timeline in self.timelines.items():
            counts, began = self._met[mode], int(met(timeline.frame.contacts).sum())
            if timeline.newest == self.row:
                counts.append(sum(counts[-1:]) + began)
        here = _places(self.contact.frame)
        for mode, rows in self._drifts.items():
            both = min(self.contact.newest, self.timelines[mode].newest)
            if len(rows) == self.row <= both:
                apart = np.hypot(*(_places(self.timelines[mode].frame) - here))
                rows.append((float(apart.max()), float(apart.mean())))


def _places(frame: Frame) -> Float:
    """Return where the bodies of a frame are, robots first, (2, k) metres."""
    return np.hstack([frame.pose[:2], frame.prop_pose[:2]])
