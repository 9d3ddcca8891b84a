"""Contacts and messages of a record, as columns of a replay."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.output.layers.forces import FAINTEST, MOST, force_scale, mean_forces
from mars2d.output.pages.replay.columns import Columns, Int, rounded

if TYPE_CHECKING:
    from mars2d.record.record import Record

__all__ = ["pack_contacts", "pack_messages"]

Float = NDArray[np.float64]

FORCES = 2000
"""Forces are rounded to the strongest drive's over this."""


def pack_contacts(record: Record, kept: Int, every: int, step: float) -> tuple[Columns, int]:
    """Return the contacts of each so-manieth row as columns, the strongest of each row.

    Where they touch is said relative to body a, which has moved on since they did.
    """
    columns, dt = Columns(), record.scenario.sampling_time
    strongest = force_scale(record.scenario).strongest
    rows = record.contact_rows
    place = np.searchsorted(kept, rows)
    at = np.minimum(place, len(kept) - 1)
    chosen = np.flatnonzero((kept[at] == rows) & (at % every == 0))
    contacts, at = record.contacts[chosen], at[chosen]
    force = mean_forces(contacts, dt)
    size = np.hypot(force[:, 0], force[:, 1])
    order = np.lexsort((-size, at))
    rank = np.arange(len(order)) - np.searchsorted(at[order], at[order], side="left")
    order = order[(rank < MOST) & (size[order] >= FAINTEST * strongest)]
    contacts, at, force = contacts[order], at[order], force[order]
    offset = contacts["point"] - _centers(record, contacts["time"] / dt, contacts["a"])
    columns.add("contacts:row", at, order=1, every=every)
    columns.add("contacts:a", contacts["a"].astype(int), order=1)
    columns.add("contacts:b", contacts["b"].astype(int), order=1)
    columns.add("contacts:offset", rounded(offset, step), order=1, step=step)
    newton = strongest / FORCES
    columns.add("contacts:force", rounded(force, newton), order=1, step=newton)
    return columns, len(at)


def _centers(record: Record, at: Float, bodies: Int) -> Float:
    """Return where bodies were at times in control steps, (c, 2) metres."""
    robots = len(record.scenario.robots)
    at = np.clip(at, 0, len(record) - 1)
    before = at.astype(int)
    after = np.minimum(before + 1, len(record) - 1)
    result = np.empty((len(at), 2))
    for poses, first, mine in (
        (record.pose, 0, bodies < robots),
        (record.prop_pose, robots, bodies >= robots),
    ):
        body, share = bodies[mine] - first, (at - before)[mine, None]
        start, end = poses[before[mine], :2, body], poses[after[mine], :2, body]
        result[mine] = start + share * (end - start)
    return result


def pack_messages(record: Record, every: int) -> tuple[Columns, int]:
    """Return the messages as columns, of which one in `every` is kept; times in 1/100 steps."""
    columns, dt = Columns(), record.scenario.sampling_time / 100
    messages: NDArray[Any] = record.messages[::every]
    flight = rounded(messages["arrival"] - messages["time"], dt)
    columns.add("messages:time", rounded(messages["time"], dt), order=1, step=dt, every=every)
    columns.add("messages:flight", flight, step=dt)
    for name in ("sender", "receiver", "status"):
        columns.add(f"messages:{name}", messages[name].astype(int), order=1)
    return columns, len(messages)
