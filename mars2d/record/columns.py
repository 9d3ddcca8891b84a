"""Columns that grow."""

from __future__ import annotations

from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arrays import sealed
from mars2d.core.errors import InputError

MAX_RESERVED = 2**25
"""The most memory that a column takes before it grows, bytes."""


class DiskError(InputError):
    """A run's record can't be kept any more: the disk is full, or a file is gone."""


class Column:
    """An array to which rows are appended; its capacity doubles when it is full.

    Rows that were written are never changed, so a view of them stays valid.
    """

    def __init__(self, shape: tuple[int, ...], dtype: Any, capacity: int) -> None:
        """Take the shape of a row, the type of its numbers, and how many rows are expected."""
        row = max(1, prod(shape) * np.dtype(dtype).itemsize)
        self._rows = np.zeros((max(1, min(capacity, MAX_RESERVED // row)), *shape), dtype=dtype)
        self.shape, self.dtype = shape, self._rows.dtype

    def write(self, row: int, value: Any) -> None:
        """Write a row, at most the one after the last."""
        if row >= len(self._rows):
            self._grow(row, row + 1)
        self._rows[row] = value

    def place(self, row: int) -> NDArray[Any]:
        """Return the array in which this row, and others up to its end, are to be written."""
        if row >= len(self._rows):
            self._grow(row, row + 1)
        return self._rows

    def write_block(self, row: int, values: NDArray[Any]) -> None:
        """Write several rows, of which the first is at most the one after the last."""
        end = row + len(values)
        if end > len(self._rows):
            self._grow(row, end)
        self._rows[row:end] = values

    def row(self, row: int) -> Any:
        """Return a row, which must not be changed."""
        return self._rows[row]

    def upto(self, count: int) -> NDArray[Any]:
        """Return the first `count` rows, as a view that can't be written."""
        return sealed(self._rows[:count])

    def _grow(self, filled: int, rows: int) -> None:
        """Make room for `rows` rows, and keep the first `filled` ones."""
        grown = np.zeros((2 * rows, *self.shape), dtype=self.dtype)
        grown[:filled] = self._rows[:filled]
        self._rows = grown
