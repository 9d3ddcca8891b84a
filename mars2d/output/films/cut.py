"""The part of a run that a film shows, and the moments of its frames."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError

__all__ = ["Cut"]

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
        if not (0 <= first <= last + slack and stop <= last + slack):
            part = f"from {first:g} s on" if end is None else f"from {first:g} to {stop:g} s"
            raise InputError(f"a film {part}: {what} goes from 0 to {last:g} s")
        if stop < first or (stop == first and not (start is None and end is None)):
            raise InputError(
                f"a film from {first:g} to {stop:g} s: expected an end after its start"
            )
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
