"""What a film is made of: frames of a live run, taken as it happens."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import numpy as np

from mars2d.errors import InputError
from mars2d.frame import Frame
from mars2d.scenario import Scenario
from mars2d.scene import Scene
from mars2d.view.player import between
from mars2d.world import World

__all__ = ["Footage"]


LONGEST = 100_000
"""The most frames of a film: over an hour."""


class Footage:
    """Takes those frames of a run that a film of it needs; add it to the run's watchers.

    Live frames hold what add-ons draw, which a record does not.
    """

    def __init__(self, scenario: Scenario, speed: float, fps: float) -> None:
        """Take simulated seconds per second of the film, and frames per second."""
        self.speed = speed
        self._sampling_time = scenario.sampling_time
        self._step = speed / fps
        self._frames: dict[int, Frame] = {}
        last = scenario.last_iteration
        count = last * self._sampling_time / self._step
        if not count <= LONGEST:
            raise InputError(
                f"a film at {speed:g} times real time would have {count:.3g} frames: "
                f"expected a speed that makes at most {LONGEST:,}"
            )
        moments = np.arange(0, last * self._sampling_time + self._step / 2, self._step)
        rows = np.floor(moments / self._sampling_time + 1e-9).astype(int)
        # Each moment lies between two rows, and both are needed.
        self._wanted = {*rows.tolist(), *(rows + 1).tolist()}

    def __call__(self, world: World) -> None:
        """Take the world's frame, if the film needs it."""
        if world.iteration in self._wanted:
            self.take(world.frame)

    def take(self, frame: Frame) -> None:
        """Take a frame, with what the add-ons draw now."""
        if frame.draw_addons is not None:
            scene = Scene()
            frame.draw_addons(scene)
            frame = dataclasses.replace(
                frame, draw_addons=lambda target: target.extend(scene.shapes)
            )
        self._frames[frame.iteration] = frame

    def frames(self, last: Frame) -> Iterator[Frame]:
        """Yield the film's frames, between the sampling times as well; `last` is the end."""
        self.take(last)
        for k in range(self.count(last) - 1):
            time = k * self._step
            row = min(int(time / self._sampling_time + 1e-9), last.iteration)
            now, then = self._frames[row], self._frames.get(row + 1)
            yield now if then is None else between(now, then, time)
        yield last

    def count(self, last: Frame) -> int:
        """Return how many frames the film has."""
        return int(last.time / self._step + 1e-9) + 2
