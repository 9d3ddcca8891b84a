"""Run a record again, and see whether the numbers are the same."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mars2d.record import Record
from mars2d.world import World

__all__ = ["Comparison", "rerun"]


@dataclass(frozen=True)
class Comparison:
    """How a record compares with itself run again.

    row: the first row whose poses depart, or None when all are the same to the last bit.
    distance: by how much the poses of that row depart at most, metres or radians.
    """

    row: int | None = None
    distance: float = 0.0

    @property
    def identical(self) -> bool:
        """Whether all poses are the same to the last bit."""
        return self.row is None


def rerun(record: Record) -> Comparison:
    """Run the record's scenario again under the record's commands, and compare all poses."""
    world = World(record.scenario, seed=record.seed)
    for row, (pose, command) in enumerate(zip(record.pose, record.command, strict=True)):
        if not np.array_equal(world.pose, pose):
            return Comparison(row, float(np.abs(world.pose - pose).max()))
        if world.over or row == len(record) - 1:
            break
        world.step(command)
    return Comparison()
