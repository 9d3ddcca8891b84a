"""What the studies ask of experiments and of their records."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from mars2d.record.record import Record
from mars2d.scenario.experiment import open_experiment
from mars2d.world.loop import simulate

__all__ = ["addon", "run", "some_rows", "top_speed"]

ROWS = 200
"""How many instants a curve over time has where each of them costs a Voronoi diagram."""


def run(experiment: str, options: Mapping[str, Any], seed: int) -> Record:
    """Return the record of an example with other options."""
    return simulate(open_experiment(experiment, options), seed).record


def some_rows(record: Record) -> list[int]:
    """Return rows of a record, evenly spread, the first and the last among them."""
    rows: list[int] = np.unique(np.linspace(0, len(record) - 1, ROWS).round().astype(int)).tolist()
    return rows


def addon(record: Record, kind: type) -> Any:
    """Return the add-on of that class."""
    return next(each for each in record.scenario.addons if isinstance(each, kind))


def top_speed(record: Record, robot: int) -> float:
    """Return how fast a robot may go, m/s."""
    drive: Any = record.scenario.robots[robot].drive
    return float(drive.max_linear_speed)
