"""The numbers that a replay's panel says of a body: commands, contacts and readings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mars2d.core.quantity import UNKNOWN, Quantity
from mars2d.output.layers.forces import FAINTEST, MAX_CONTACTS, force_scale, mean_forces
from mars2d.output.pages.replay.columns import Columns, Int, rounded
from mars2d.output.pages.replay.sensors import Carried
from mars2d.scenario.robot import Robot
from mars2d.sensors.base import Sensor

if TYPE_CHECKING:
    from mars2d.record.record import Record

__all__ = ["commands_of", "pack_contacts", "pack_readings"]

FORCES = 2000
"""Forces are rounded to the strongest drive's over this."""

MAX_NUMBERS = 8
"""Readings of more numbers are not said in words."""


def commands_of(robot: Robot) -> list[list[str]]:
    """Return the names, units and kinds of the two numbers of a robot's command."""
    quantities = robot.drive.quantities or UNKNOWN
    return [[quantity.symbol, quantity.unit, quantity.kind] for quantity in quantities]


def pack_contacts(record: Record, kept: Int, every: int) -> tuple[Columns, int]:
    """Return the contacts of one row in `every` as columns, the strongest of each row."""
    columns = Columns()
    strongest = force_scale(record.scenario).strongest
    rows = record.contact_rows
    place = np.searchsorted(kept, rows)
    at = np.minimum(place, len(kept) - 1)
    chosen = np.flatnonzero((kept[at] == rows) & (at % every == 0))
    contacts, at = record.contacts[chosen], at[chosen]
    size = np.linalg.norm(mean_forces(contacts, record.scenario.sampling_time), axis=1)
    order = np.lexsort((-size, at))
    rank = np.arange(len(order)) - np.searchsorted(at[order], at[order], side="left")
    order = order[(rank < MAX_CONTACTS) & (size[order] >= FAINTEST * strongest)]
    contacts, at, size = contacts[order], at[order], size[order]
    columns.add("contacts:row", at, order=1, every=every)
    columns.add("contacts:a", contacts["a"].astype(int), order=1)
    columns.add("contacts:b", contacts["b"].astype(int), order=1)
    newton = strongest / FORCES
    columns.add("contacts:force", rounded(size, newton), order=1, step=newton)
    return columns, len(at)


def pack_readings(sensors: list[Carried], every: int) -> tuple[Columns, list[dict[str, Any]]]:
    """Return the readings of few numbers as columns, and how they are to be said in words."""
    columns = Columns()
    found: list[dict[str, Any]] = []
    for each in sensors:
        values = each.readings[::every].reshape(len(each.readings[::every]), -1).astype(float)
        if not 0 < values.shape[1] <= MAX_NUMBERS:
            continue
        finite = values[np.isfinite(values)]
        step = max(float(np.abs(finite).max(initial=0.0)), 1e-6) / 2**15
        name = f"reading{len(found)}"
        columns.add(name, rounded(values, step), order=1, step=step, every=every)
        found.append({
            "name": each.name,
            "robot": each.robot,
            "column": name,
            "parts": [_part(q) for q in _quantities(each.sensor, values.shape[1])],
        })  # fmt: skip
    return columns, found


def _quantities(sensor: Sensor, count: int) -> list[Quantity]:
    """Return what each number of a reading is."""
    stated = list(sensor.quantities) or [Quantity("value")]
    if count % len(stated) == 0 and len(stated) > 1:
        return stated * (count // len(stated))
    first = stated[0]
    if count == 1:
        return [first]
    return [Quantity(f"{first.name} {k}", first.unit, first.kind) for k in range(count)]


def _part(quantity: Quantity) -> list[str]:
    return [quantity.name, quantity.unit, quantity.kind]
