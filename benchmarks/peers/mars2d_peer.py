"""MARS2D itself: rigid bodies with contact forces and friction, everything recorded.

What was set, and how: `world_of` of benchmarks/worlds.py builds the scene as its peers get it.
"default" is the `max_overlap` that users get, 1 mm; "loose" is 20 mm, with which there is about one
substep a control step. The law is asked at each control step. Poses, commands, readings and
contacts with their impulses are recorded at each.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
from peer import Float, Simulator, main
from worlds import SETTINGS, world_of


class Mars2d(Simulator):
    """A scene in MARS2D."""

    SETTINGS: ClassVar[tuple[str, ...]] = tuple(SETTINGS)

    def build(self) -> None:
        self._world = world_of(self.scene, SETTINGS[self.setting])

    def advance(self) -> None:
        self._world.step()
        self.command = self._world.command

    def poses(self) -> Float:
        return np.concatenate([self._world.pose, self._world.prop_pose], axis=1).T

    def near(self) -> Sequence[bool]:
        self._world.observe()
        return [robot.sense.proximity for robot in self._world.robots]

    def ranges(self) -> Sequence[Any]:
        self._world.observe()
        return [robot.sense.range_finder for robot in self._world.robots]


if __name__ == "__main__":
    main(Mars2d)
