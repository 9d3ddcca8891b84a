"""Run a record again, and see whether the numbers are the same."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mars2d.contact import CONTACT
from mars2d.errors import InputError
from mars2d.record import Record
from mars2d.world import World

__all__ = ["Departure", "rerun"]


@dataclass(frozen=True)
class Departure:
    """Where a record and itself run again part: the row, and by how much (metres or radians)."""

    row: int
    distance: float


def rerun(record: Record) -> Departure | None:
    """Run the record's scenario again under its commands; None when all is the same to the bit.

    Poses and contacts are compared. Raises InputError for a record with a drive of the user's own,
    which a file does not hold.
    """
    drives = [part for part in record.missing if part.startswith("drive")]
    if drives:
        raise InputError(f"can't be run again: the file does not hold the {', '.join(drives)}")
    # The workspace and the stop time have ended the run, or not: the record says how long it was.
    scenario = record.scenario.replace(stop_time=record.scenario.stop_time + 1e3)
    if scenario.on_exit == "stop":
        scenario = scenario.replace(on_exit="ignore")
    world = World(scenario, seed=record.seed)
    for row, (pose, command) in enumerate(zip(record.pose, record.command, strict=True)):
        if not np.array_equal(world.pose, pose):
            return Departure(row, float(np.abs(world.pose - pose).max()))
        if row < len(record) - 1:
            world.step(command)
    return _contacts_depart(record, world.record)


def _contacts_depart(first: Record, second: Record) -> Departure | None:
    """Return where the contacts of two records with the same poses part."""
    end = first.time[-1] if len(first) else 0.0
    mine, other = (r.contacts[r.contacts["time"] <= end] for r in (first, second))
    same = len(mine) == len(other) and all(
        np.array_equal(mine[name], other[name]) for name in CONTACT.names or ()
    )
    return None if same else Departure(len(first) - 1, 0.0)
