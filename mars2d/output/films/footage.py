"""The frames of a film, from a record or taken while the run goes on."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError
from mars2d.core.scene import Scene
from mars2d.record.frame import Frame, between
from mars2d.scenario.scenario import Scenario

MAX_FRAMES = 100_000
"""The most frames of a film: more than an hour."""


@dataclass(frozen=True)
class Cut:
    """The part of a run that a film shows: from start to end [s], a frame every `step` seconds.

    The last frame is the end, however soon it follows the one before.
    """

    start: float
    end: float
    step: float

    @classmethod
    def of(
        cls,
        last: float,
        speed: float,
        fps: float,
        start: float | None = None,
        end: float | None = None,
        what: str = "the experiment",
    ) -> Self:
        """Return a part of `what`, which goes from 0 to `last` seconds; by default all of it.

        speed: simulated seconds per second of the film. fps: frames per second of the film. Raises
        InputError for a part that does not exist, or that has more than `MAX_FRAMES` frames.
        """
        for name, value in (("speed", speed), ("fps", fps)):
            if real(name, value, "a number > 0") <= 0:
                raise wrong(name, value, "a number > 0")
        first = 0.0 if start is None else real("start", start, "seconds")
        stop = last if end is None else real("end", end, "seconds")
        slack = 1e-9 * max(1.0, last)
        part = (
            f"a film from {first:g} s on" if end is None else f"a film from {first:g} to {stop:g} s"
        )
        if not (0 <= first <= last + slack and stop <= last + slack):
            raise InputError(f"{part}: {what} goes from 0 to {last:g} s")
        if stop < first or (stop == first and not (start is None and end is None)):
            raise InputError(f"{part}: expected an end after its start")
        cut = cls(first, min(stop, last), speed / fps)
        if not (cut.end - cut.start) / cut.step <= MAX_FRAMES:
            raise InputError(
                f"a film of {cut.end - cut.start:g} s at {speed:g} times real time would have "
                f"{(cut.end - cut.start) / cut.step:.3g} frames: expected a speed, or a part, that "
                f"makes at most {MAX_FRAMES:,}"
            )
        return cut

    @property
    def count(self) -> int:
        """The number of frames."""
        return int((self.end - self.start) / self.step + 1e-9) + 2

    @property
    def moments(self) -> NDArray[np.float64]:
        """The time of each frame (count,), seconds."""
        return np.append(self.start + self.step * np.arange(self.count - 1), self.end)


def shots(
    cut: Cut, sampling_time: float, last: int, frame: Callable[[int], Frame]
) -> Iterator[Frame]:
    """Yield the frames of a film, also between the sampling times.

    frame: returns the frame of a row, from 0 to `last`; called once for each row, in order.
    """
    seen: dict[int, Frame] = {}
    for time in cut.moments.tolist():
        row = min(int(time / sampling_time + 1e-9), last)
        rows = (row,) if row == last else (row, row + 1)
        # The same objects as long as they are seen, so that painters can keep what they draw.
        seen = {each: seen.get(each) or frame(each) for each in rows}
        on_time = row == last or time - row * sampling_time < 1e-9 * max(1.0, time)
        yield seen[row] if on_time else between(seen[row], seen[row + 1], time)


class Footage:
    """Takes the frames of a run that a film needs; add it to the run's watchers.

    Unlike those of a record, frames of a live run have the drawings of add-ons.
    """

    def __init__(
        self,
        scenario: Scenario,
        speed: float,
        fps: float,
        start: float | None = None,
        end: float | None = None,
    ) -> None:
        """Choose the part of the run; see `Cut.of`. The run may end before the part does."""
        self.speed = speed
        self._sampling_time = scenario.sampling_time
        last = scenario.last_iteration * scenario.sampling_time
        self._cut = Cut.of(last, speed, fps, start, end)
        self._frames: dict[int, Frame] = {}
        rows = np.floor(self._cut.moments / self._sampling_time + 1e-9).astype(int)
        # Each moment lies between two rows, and both are needed.
        self._wanted = {*rows.tolist(), *(rows + 1).tolist()}

    def __call__(self, world: Any) -> None:
        """Take the frame of a `World`, if the film needs it."""
        if world.iteration in self._wanted:
            self.take(world.frame)

    def take(self, frame: Frame) -> None:
        """Take a frame, with the present drawings of the add-ons."""
        if frame.draw_addons is not None:
            scene = Scene()
            frame.draw_addons(scene)
            frame = dataclasses.replace(
                frame, draw_addons=lambda target: target.extend(scene.shapes)
            )
        self._frames[frame.iteration] = frame

    def frames(self, last: Frame) -> Iterator[Frame]:
        """Yield the film's frames; `last` is the end of the run.

        Raises InputError where the run ended before the film's start.
        """
        cut = self._until(last)
        self.take(last)
        yield from shots(cut, self._sampling_time, last.iteration, self._frames.__getitem__)

    def count(self, last: Frame) -> int:
        """Return the number of the film's frames."""
        return self._until(last).count

    def _until(self, last: Frame) -> Cut:
        """Return the part as far as the run got."""
        if last.time < self._cut.start:
            raise InputError(
                f"a film from {self._cut.start:g} s on: the run ended at {last.time:g} s"
            )
        return dataclasses.replace(self._cut, end=min(self._cut.end, last.time))
