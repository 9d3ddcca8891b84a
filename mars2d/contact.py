"""Contacts as data: who touched whom, when, where, how hard."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["CONTACT", "ContactLog"]

Float = NDArray[np.float64]
Int = NDArray[np.int64]

CONTACT = np.dtype(
    [
        ("time", "f8"),  # s, when the bodies were first in touch during the control step
        ("a", "i4"),  # index of a robot
        ("b", "i4"),  # index of another robot, a < b; or -1 - k for obstacle k
        ("point", "f8", (2,)),  # m, on the surface of a
        ("normal", "f8", (2,)),  # unit vector from a to b
        ("impulse", "f8"),  # N s, over the control step
        ("began", "?"),  # whether they did not touch in the control step before
    ]
)
"""One row a pair and control step in which the pair touched."""


class ContactLog:
    """Gathers the contacts of the substeps of a control step, and sums them up by pairs."""

    def __init__(self, obstacles: int) -> None:
        """Take the number of obstacles, which count as -1, -2, ... in the column b."""
        self._obstacles = obstacles
        self._rows: list[NDArray[np.void]] = []
        self._before: Int = np.empty(0, dtype=np.int64)

    def add(
        self, time: float, a: Int, b: Int, point: Float, normal: Float, impulse: Float
    ) -> None:
        """Note the contacts of one substep, each array one entry a pair; impulse (k, 2) in N s."""
        rows = np.zeros(len(a), dtype=_SUBSTEP)
        rows["time"], rows["a"], rows["b"] = time, a, b
        rows["point"], rows["normal"], rows["impulse"] = point, normal, impulse
        self._rows.append(rows)

    def take(self) -> NDArray[np.void]:
        """Return the contacts since the last call, one row (dtype CONTACT) a pair."""
        if not self._rows:
            self._before = self._before[:0]
            return np.empty(0, dtype=CONTACT)
        rows = np.concatenate(self._rows)
        self._rows.clear()
        keys = self.key(rows["a"], rows["b"])
        pairs, first, group = np.unique(keys, return_index=True, return_inverse=True)
        result = np.zeros(len(pairs), dtype=CONTACT)
        for column in ("time", "a", "b", "point", "normal"):
            result[column] = rows[column][first]
        total = np.zeros((len(pairs), 2))
        np.add.at(total, group.ravel(), rows["impulse"])
        result["impulse"] = np.hypot(total[:, 0], total[:, 1])
        result["began"] = ~np.isin(pairs, self._before)
        self._before = pairs
        return result

    def key(self, a: Int, b: Int) -> Int:
        """Return one number a pair (a, b), the same for each substep."""
        return (a.astype(np.int64) << 32) + b.astype(np.int64) + self._obstacles + 1


_SUBSTEP = np.dtype(
    [
        ("time", "f8"),
        ("a", "i4"),
        ("b", "i4"),
        ("point", "f8", (2,)),
        ("normal", "f8", (2,)),
        ("impulse", "f8", (2,)),
    ]
)
