"""The frames of a film, and what add-ons draw on them while the run goes on."""

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


class Drawings:
    """What add-ons draw while a run goes on; add it to the run's watchers.

    A record has their drawing at the end alone, since to draw takes time.
    """

    def __init__(self) -> None:
        """Start with none."""
        self._scenes: dict[int, Scene] = {}

    def __call__(self, world: Any) -> None:
        """Let the add-ons of a `World` draw."""
        scene = self._scenes[world.iteration] = Scene()
        world.simulation.draw_addons(scene)

    def on(self, frame: Frame) -> Frame:
        """Return a frame of the run's record with the drawing of its row, if there is one."""
        scene = self._scenes.get(frame.iteration)
        if scene is None:
            return frame
        return dataclasses.replace(frame, draw_addons=lambda to: to.extend(scene.shapes))
