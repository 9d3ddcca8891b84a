"""Numbers over time packed into few bytes: rounded, differenced and deflated."""

from __future__ import annotations

import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]
Int = NDArray[np.int64]

MAX_NUMBER = 2**28
"""The largest whole number: second differences then fit into 32 bits."""

MISSING = -MAX_NUMBER
"""Stands for a number that is missing or infinite."""


class Columns:
    """Columns packed one after the other; `index` has the place and the format of each.

    size: their bytes. beside: the approximate bytes of the plain data that belongs to them.
    """

    def __init__(self) -> None:
        """Start with none."""
        self.index: dict[str, dict[str, Any]] = {}
        self._parts: list[bytes] = []
        self.size = self.beside = 0

    def add(self, name: str, values: NDArray[Any], order: int = 0, **more: Any) -> None:
        """Pack whole numbers (T, ...), each series by its differences in time of an order 0 to 2.

        more: other entries for the reader, such as a step.
        """
        shape = np.shape(values)
        width = int(np.prod(shape[1:]))
        series = np.asarray(values, dtype=np.int64).reshape(shape[0], width).T
        for _ in range(order):
            series = np.diff(series, axis=1, prepend=0)
        packed = zlib.compress(series.astype("<i4").tobytes(), 6)
        entry = {"shape": list(shape), "order": order, **more}
        self.index[name] = {"at": self.size, "bytes": len(packed), **entry}
        self._parts.append(packed)
        self.size += len(packed)

    def take(self, other: Columns) -> None:
        """Add the columns of another."""
        for name, entry in other.index.items():
            self.index[name] = {**entry, "at": entry["at"] + self.size}
        self._parts += other._parts
        self.size += other.size
        self.beside += other.beside

    def packed(self) -> bytes:
        """Return the bytes of all columns."""
        return b"".join(self._parts)


def rounded(values: NDArray[Any], step: float) -> Int:
    """Return numbers in whole steps; those that are not finite as `MISSING`."""
    finite = np.isfinite(values)
    steps = np.rint(np.where(finite, values, 0.0) / step)
    kept = np.clip(steps, 1 - MAX_NUMBER, MAX_NUMBER)
    return np.where(finite, kept, MISSING).astype(np.int64)
