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

    def __init__(self, outline: Int) -> None:
        """Take, for each segment, the number of the obstacle that it belongs to, (S,)."""
        self._outline = outline
        self._times: list[float] = []
        self._bodies: list[Int] = []
        self._values: list[Float] = []
        self._touching: list[Int] = []
        self._before: Int = np.empty(0, dtype=np.int64)

    def add(
        self, time: float, bodies: Int, values: Float, touching: tuple[Int, Int, Int, Int]
    ) -> None:
        """Note what the solver lists after one substep, and which pairs do touch.

        bodies: (k, 2), robots as 0, 1, ..., obstacles as -1, -2, ...; values: (k, 8) = impulse,
        normal, point on the first body, point on the second; touching: robots (i, j), and robots
        and the segments that they touch.
        """
        i, j, disc, segment = touching
        robots = _key(np.minimum(i, j), np.maximum(i, j))
        walls = _key(disc, -1 - self._outline[segment])
        self._times.append(time)
        self._bodies.append(bodies)
        self._values.append(values)
        self._touching.append(np.concatenate([robots, walls]))

    def take(self) -> NDArray[np.void]:
        """Return the contacts since the last call, one row (dtype CONTACT) a pair."""
        if not self._times:
            self._before = self._before[:0]
            return np.empty(0, dtype=CONTACT)
        substep = np.repeat(np.arange(len(self._times)), [len(rows) for rows in self._bodies])
        bodies, values = np.concatenate(self._bodies), np.concatenate(self._values)
        swap = (bodies[:, 0] < 0) | ((bodies[:, 1] >= 0) & (bodies[:, 1] < bodies[:, 0]))
        a, b = np.where(swap, bodies[:, ::-1].T, bodies.T)
        sign = np.where(swap, -1.0, 1.0)[:, None]

        key = _key(a, b)
        live = np.zeros(len(key), dtype=bool)
        for k, touching in enumerate(self._touching):
            mine = substep == k
            live[mine] = np.isin(key[mine], touching)
        impulse = values[:, 0:2] * sign
        point = np.where(swap[:, None], values[:, 6:8], values[:, 4:6])
        # The solver lists them in the order of addresses in memory: put them in one that is always
        # the same, the strongest of a pair and substep first.
        rows = np.flatnonzero(live)
        strength = np.hypot(impulse[rows, 0], impulse[rows, 1])
        x, y = point[rows].T
        rows = rows[np.lexsort((y, x, -strength, key[rows], substep[rows]))]
        pairs, first, group = np.unique(key[rows], return_index=True, return_inverse=True)
        row = rows[first]

        result = np.zeros(len(pairs), dtype=CONTACT)
        result["time"] = np.array(self._times)[substep[row]]
        result["a"], result["b"] = a[row], b[row]
        result["normal"] = (values[:, 2:4] * sign)[row]
        result["point"] = point[row]
        total = [np.bincount(group.ravel(), impulse[rows, k], len(pairs)) for k in (0, 1)]
        result["impulse"] = np.hypot(*total)
        result["began"] = ~np.isin(pairs, self._before)
        self._before = pairs
        for notes in (self._times, self._bodies, self._values, self._touching):
            notes.clear()
        return result


def _key(a: Int, b: Int) -> Int:
    """Return one number a pair (a, b); those of a come in order, then those of b."""
    return (np.asarray(a, dtype=np.int64) << 32) + np.asarray(b, dtype=np.int64) + (1 << 31)
