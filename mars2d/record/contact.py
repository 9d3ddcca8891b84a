"""Contacts as data: who touched whom, when, where, how hard, and for how long."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["CONTACT", "EPISODE", "episodes", "rows_of"]

Float = NDArray[np.float64]
Int = NDArray[np.int64]

CONTACT = np.dtype(
    [
        ("time", "f8"),  # s, when the bodies were first in touch during the control step
        ("duration", "f8"),  # s, for how long they touched during the control step
        ("a", "i4"),  # index of a body: robots first, then props
        ("b", "i4"),  # index of another body, a < b; or -1 - k for obstacle k
        ("point", "f8", (2,)),  # m, on the surface of a
        ("normal", "f8", (2,)),  # unit vector from a to b
        ("impulse", "f8"),  # N s, over the control step: the length of its sum
        ("normal_impulse", "f8"),  # N s, that part of it along the normal
        ("tangential_impulse", "f8"),  # N s, on b, along the normal turned by +90 degrees
        ("speed", "f8"),  # m/s, at which they approached when they came to touch; 0 if they did
        ("slip", "f8"),  # m/s, of b along a then, along the normal turned by +90 degrees
        ("began", "?"),  # whether they did not touch in the control step before
        ("ended", "?"),  # whether they had parted by the end of the control step
    ]
)
"""A row for each pair and control step in which the pair touched."""

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
"""A row for each time that a pair touched until it parted."""


def episodes(contacts: NDArray[np.void]) -> NDArray[np.void]:
    """Return the episodes of contacts, each from touch to parting: a row (dtype EPISODE) each.

    contacts: rows of dtype CONTACT, in the order of time, such as ``record.contacts``.
    """
    key = _key(contacts["a"], contacts["b"])
    order = np.lexsort((contacts["time"], key))
    rows = contacts[order]
    group = np.cumsum(rows["began"] | (np.diff(key[order], prepend=-1) != 0)) - 1
    count = int(group[-1]) + 1 if len(rows) else 0
    first = np.searchsorted(group, np.arange(count))
    last = np.searchsorted(group, np.arange(count), side="right") - 1
    result = np.zeros(count, dtype=EPISODE)
    result["began"] = rows["time"][first]
    result["ended"] = rows["time"][last] + rows["duration"][last]
    for name in ("a", "b", "speed"):
        result[name] = rows[name][first]
    for name in ("normal_impulse", "tangential_impulse"):
        result[name] = np.bincount(group, rows[name], count)
    return result[np.argsort(result["began"], kind="stable")]


def rows_of(contacts: NDArray[np.void], time: Float, sampling_time: float) -> NDArray[np.intp]:
    """Return the row of a record at the end of each contact's control step, (c,).

    contacts: (c,) of dtype CONTACT. time: (T,) seconds, of the rows; contacts after the last row
    get T. A contact that begins at the very end of a control step belongs to it, and so does one
    that went on from before, whose time is the step's start.
    """
    rounding = 1e-6 * sampling_time
    within = contacts["time"] + np.where(contacts["began"], -rounding, rounding)
    return np.searchsorted(time, within, side="left")


def _key(a: Int, b: Int) -> Int:
    """Return a number for each pair, which sorts pairs by a, then by b."""
    return (np.asarray(a, dtype=np.int64) << 32) + np.asarray(b, dtype=np.int64) + (1 << 31)
