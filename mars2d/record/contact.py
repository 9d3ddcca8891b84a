"""Contacts as data: who touched whom, when, where, how hard, and for how long."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]
Int = NDArray[np.int64]

CONTACT = np.dtype(
    [
        ("time", "f8"),  # s, when they were first in touch, by this normal, in the control step
        ("duration", "f8"),  # s, for how long they touched by it during the control step
        ("a", "i4"),  # index of a body: robots first, then props
        ("b", "i4"),  # index of another body, a < b; or -1 - k for obstacle k
        ("point", "f8", (2,)),  # m, on the surface of a, then
        ("normal", "f8", (2,)),  # unit vector from a to b: the mean, weighted by normal impulses
        ("impulse", "f8"),  # N s, over the control step: the length of its sum
        ("normal_impulse", "f8"),  # N s, that part of it along the normal
        ("tangential_impulse", "f8"),  # N s, on b, along the normal turned by +90 degrees
        ("speed", "f8"),  # m/s, at which they approached along it when this began; else 0
        ("slip", "f8"),  # m/s, of b along a then, along the normal turned by +90 degrees
        ("began", "?"),  # whether they did not touch by it when the control step began
        ("ended", "?"),  # whether they did not touch by it any more when the control step ended
    ]
)
"""A row for each control step in which a pair touched, and for each normal by which it did.

Rows add up as vectors: what a body has got from all contacts of a control step is the sum, over its
rows, of ``normal_impulse * normal`` and ``tangential_impulse`` times the normal turned by +90
degrees, with the sign minus where the body is a.
"""

FORCE = np.dtype(
    [
        ("row", "i8"),  # of the record, at the end of the control step
        ("a", "i4"),
        ("b", "i4"),
        ("time", "f8"),  # s, when they were first in touch in the control step
        ("until", "f8"),  # s, when they were last
        ("force", "f8", (2,)),  # N, the mean on b over the control step, by all normals together
        ("normal_force", "f8"),  # N, the mean of what presses by each normal, added up
    ]
)
"""A row for each control step in which a pair touched, by whatever normals."""

ROUNDING = 1e-9
"""Seconds between touches of a pair that count as none."""

EPISODE = np.dtype(
    [
        ("began", "f8"),  # s
        ("ended", "f8"),  # s; when they last touched, if they had not parted at the end
        ("a", "i4"),
        ("b", "i4"),
        ("speed", "f8"),  # m/s, at which they met
        ("normal_impulse", "f8"),  # N s, over all of it
        ("tangential_impulse", "f8"),  # N s, on b
    ]
)
"""A row for each time that a pair touched, by whatever normals, until it parted."""


def mean_forces(contacts: NDArray[np.void], sampling_time: float) -> Float:
    """Return the mean force on b over the control step of each contact, (c, 2) newtons."""
    normal = contacts["normal"]
    tangent = np.column_stack([-normal[:, 1], normal[:, 0]])
    impulse = contacts["normal_impulse"][:, None] * normal
    impulse = impulse + contacts["tangential_impulse"][:, None] * tangent
    return np.asarray(impulse / sampling_time)


def pair_forces(
    contacts: NDArray[np.void], rows: NDArray[np.intp], sampling_time: float
) -> NDArray[np.void]:
    """Return what each pair exerted in each control step, dtype FORCE, by row, a and b.

    contacts: (c,) of dtype CONTACT. rows: (c,), the row at the end of each one's control step.
    """
    order = np.lexsort((contacts["b"], contacts["a"], rows))
    contacts = contacts[order]
    key = np.column_stack([rows[order], contacts["a"], contacts["b"]])
    first = np.flatnonzero(np.diff(key, axis=0, prepend=-1).any(axis=1))
    found = np.zeros(len(first), dtype=FORCE)
    if len(first):
        found["row"], found["a"], found["b"] = key[first].T
        found["time"] = np.minimum.reduceat(contacts["time"], first)
        found["until"] = np.maximum.reduceat(contacts["time"] + contacts["duration"], first)
        found["force"] = np.add.reduceat(mean_forces(contacts, sampling_time), first)
        pressed = np.add.reduceat(contacts["normal_impulse"], first)
        found["normal_force"] = pressed / sampling_time
    return found


def net_forces(pairs: NDArray[np.void], bodies: Sequence[int], steps: range) -> Float:
    """Return the net mean contact force on bodies in control steps, (steps, 2, bodies) newtons.

    pairs: of dtype FORCE. bodies: indices >= 0, each once. steps: the rows at the steps' ends.
    """
    net = np.zeros((len(steps), len(bodies), 2))
    place = np.full(max(bodies, default=0) + 1, -1)
    place[list(bodies)] = np.arange(len(bodies))
    pairs = pairs[(pairs["row"] >= steps.start) & (pairs["row"] < steps.stop)]
    for side, sign in (("a", -1.0), ("b", 1.0)):
        wanted = (pairs[side] >= 0) & (pairs[side] < len(place))
        wanted[wanted] = place[pairs[side][wanted]] >= 0
        mine = pairs[wanted]
        step, column = mine["row"] - steps.start, place[mine[side]]
        np.add.at(net, (step, column), sign * mine["force"])
    return net.swapaxes(1, 2)


def episodes(contacts: NDArray[np.void]) -> NDArray[np.void]:
    """Return the episodes of contacts, each from touch to parting: a row (dtype EPISODE) each.

    contacts: rows of dtype CONTACT, in the order of time, such as ``record.contacts``.
    """
    order, begins, until = _touching(contacts)
    rows, first = contacts[order], np.flatnonzero(begins)
    count, group = len(first), np.cumsum(begins) - 1
    result = np.zeros(count, dtype=EPISODE)
    result["began"] = rows["time"][first]
    result["ended"] = until[np.append(first[1:], len(rows))[:count] - 1]
    for name in ("a", "b", "speed"):
        result[name] = rows[name][first]
    for name in ("normal_impulse", "tangential_impulse"):
        result[name] = np.bincount(group, rows[name], count)
    return result[np.argsort(result["began"], kind="stable")]


def met(contacts: NDArray[np.void]) -> NDArray[np.bool_]:
    """Return with which rows (c,) two bodies came to touch that did not touch by another normal.

    contacts: (c,) of dtype CONTACT, in the order of time: of a record, or of single control steps.
    """
    order, begins, _ = _touching(contacts)
    found = np.zeros(len(contacts), dtype=bool)
    found[order] = begins
    return np.asarray(found & contacts["began"])


def met_or_parted(contacts: NDArray[np.void]) -> NDArray[np.bool_]:
    """Return with which rows (c,) of one control step two bodies came to touch, or parted."""
    found = met(contacts)
    pairs = np.stack([contacts["a"], contacts["b"]], axis=-1)
    for pair in np.unique(pairs, axis=0):
        mine = np.flatnonzero((pairs == pair).all(axis=1))
        found[mine[-1]] |= contacts["ended"][mine].all()
    return found


def rows_of(contacts: NDArray[np.void], time: Float, sampling_time: float) -> NDArray[np.intp]:
    """Return the row of a record at the end of each contact's control step, (c,).

    contacts: (c,) of dtype CONTACT. time: (T,) seconds, of the rows; contacts after the last row
    get T. A contact that begins at the very end of a control step belongs to it, and so does one
    that went on from before, whose time is the step's start.
    """
    rounding = 1e-6 * sampling_time
    within = contacts["time"] + np.where(contacts["began"], -rounding, rounding)
    return np.searchsorted(time, within, side="left")


def _touching(contacts: NDArray[np.void]) -> tuple[NDArray[np.intp], NDArray[np.bool_], Float]:
    """Return an order of rows by their pairs, and of rows in it which begin an episode.

    The third array says until when each row's pair had touched by then, s.
    """
    key = (contacts["a"].astype(np.int64) << 32) + contacts["b"]
    order = np.argsort(key, kind="stable")
    key, time, began = key[order], contacts["time"][order], contacts["began"][order]
    begins = np.diff(key, prepend=key[:1] - 1) != 0
    # the largest end of a pair's rows so far: a running maximum that no other pair's ends exceed
    ends, rank = np.unique(time + contacts["duration"][order], return_inverse=True)
    above = np.cumsum(begins) * len(ends)
    until = ends[np.maximum.accumulate(rank.ravel() + above) - above]
    begins[1:] |= began[1:] & (time[1:] > until[:-1] + ROUNDING)
    return order, begins, until
