"""Columns that grow, in memory or in unnamed files."""

from __future__ import annotations

import mmap
import os
from collections.abc import Callable, Iterator, Sequence
from copy import copy
from math import prod
from pathlib import Path
from typing import Any, overload
from weakref import finalize

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arrays import sealed
from mars2d.core.errors import InputError

MAX_RESERVED = 2**25
"""The most memory that a column takes before it grows, bytes."""

WINDOW = 2**18
"""How much of a column in a file stays in memory after it was written, bytes."""

FIRST, STEP = 2**16, 2**22
"""The least growth of a column's file, at first and when it is large, bytes."""

BLOCK = 2**20
"""How much of a column that may be larger than memory is read at once, bytes."""


class DiskError(InputError):
    """A run's record can't be kept any more: the disk is full, or a file is gone."""


class Column:
    """An array to which rows are appended; its capacity doubles when it is full.

    Rows that were written are never changed, so a view of them stays valid.
    """

    def __init__(self, shape: tuple[int, ...], dtype: Any, capacity: int) -> None:
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


Storage = Callable[[tuple[int, ...], Any, int], Column]
"""Makes a column from the shape of a row, the type of its numbers, and the expected rows."""


class Scratch:
    """Makes columns in unnamed files of a folder, which vanish with the process.

    Such columns take no memory, however long they are. Raises DiskError where there is no room.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def __call__(self, shape: tuple[int, ...], dtype: Any, capacity: int) -> Column:
        """Return a column, in memory if its rows are empty."""
        if prod(shape) == 0:
            return Column(shape, dtype, capacity)
        return _FileColumn(self._folder, shape, dtype)


class _FileColumn(Column):
    """A column in a file that is mapped into memory, of which only the end stays there.

    A short one is in memory: it needs no file, of which a process may have only so many.
    """

    def __init__(self, folder: Path, shape: tuple[int, ...], dtype: Any) -> None:
        self.shape, self.dtype = shape, np.dtype(dtype)
        self._folder = folder
        self._row = prod(shape) * self.dtype.itemsize
        self._rows = np.zeros((0, *shape), dtype=dtype)
        self._size = 0

    def _grow(self, filled: int, rows: int) -> None:
        if self._size == 0 and 2 * rows * self._row <= FIRST:
            super()._grow(filled, rows)
            return
        in_memory = self._rows[: filled if self._size == 0 else 0]
        if rows * self._row > self._size:
            self._extend(rows * self._row)
        _let_go(self._map)
        # The array ends a window further on, so that this is called again after each window.
        end = min(self._size // self._row, rows + WINDOW // self._row)
        self._rows = np.ndarray((end, *self.shape), self.dtype, self._map)
        self._rows[: len(in_memory)] = in_memory

    def _extend(self, least: int) -> None:
        """Make the file longer and map it again. Views of the former map show the same file."""
        from tempfile import TemporaryFile

        more = max(FIRST, min(self._size, STEP), self._size // 8)
        size = -(-max(least, self._size + more) // FIRST) * FIRST
        try:
            if self._size == 0:
                self._file = TemporaryFile(dir=self._folder, buffering=0)  # noqa: SIM115
                finalize(self, self._file.close)
            _reserve(self._file.fileno(), self._size, size - self._size)
            self._map = mmap.mmap(self._file.fileno(), size)
        except OSError as error:
            raise self._full(error) from error
        self._size = size

    def _full(self, error: OSError) -> DiskError:
        reason = error.strerror or error
        return DiskError(f"{self._folder}: no room for the columns of the run: {reason}")


def _reserve(file: int, start: int, count: int) -> None:
    """Make a file longer by bytes for which the disk has room.

    Otherwise a full disk ends the process when a page of the mapped file can't be written.
    """
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(file, start, count)
        return
    os.lseek(file, start, os.SEEK_SET)
    while count > 0:
        count -= os.write(file, bytes(min(count, BLOCK)))


def _let_go(mapped: mmap.mmap) -> None:
    """Let the pages of a mapped file leave the memory; they are read again when needed."""
    if hasattr(mmap, "MADV_DONTNEED"):
        mapped.madvise(mmap.MADV_DONTNEED)


def blocks(column: NDArray[Any]) -> Iterator[NDArray[Any]]:
    """Yield an array piece by piece. If it is kept in a file, only a piece stays in memory."""
    mapped: Any = column
    while isinstance(mapped, (np.ndarray, memoryview)):
        mapped = mapped.base if isinstance(mapped, np.ndarray) else mapped.obj
    row = prod(column.shape[1:]) * column.dtype.itemsize
    count = max(1, BLOCK // max(1, row))
    for start in range(0, len(column), count):
        yield column[start : start + count]
        if isinstance(mapped, mmap.mmap):
            _let_go(mapped)


class Texts(Sequence[str]):
    """Texts, kept one after the other as bytes of UTF-8; each is decoded when it is asked for."""

    def __init__(self, storage: Storage = Column) -> None:
        self._data = storage((), np.uint8, 1024)
        self._ends = storage((), np.int64, 64)
        self._sizes = storage((), np.int64, 64)
        self._count = self._end = 0

    @classmethod
    def of(cls, texts: Sequence[str]) -> Texts:
        """Return texts as `Texts`, and `Texts` as they are."""
        if isinstance(texts, Texts):
            return texts
        result = cls()
        for text in texts:
            result.append(text)
        return result

    def append(self, text: str) -> None:
        """Add a text."""
        data = np.frombuffer(text.encode(), dtype=np.uint8)
        self._data.write_block(self._end, data)
        self._end += len(data)
        self._ends.write(self._count, self._end)
        self._sizes.write(self._count, len(data))
        self._count += 1

    def snapshot(self) -> Texts:
        """Return the texts so far; later ones are not added to them."""
        return copy(self)

    @property
    def data(self) -> NDArray[np.uint8]:
        """All texts as bytes, one after the other."""
        return self._data.upto(self._end)

    @property
    def sizes(self) -> NDArray[np.int64]:
        """The number of bytes of each text."""
        return self._sizes.upto(self._count)

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, index: int) -> str: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[str, ...]: ...

    def __getitem__(self, index: int | slice) -> str | tuple[str, ...]:
        if isinstance(index, slice):
            return tuple(self[i] for i in range(*index.indices(self._count)))
        end = int(self._ends.upto(self._count)[index])
        return self.data[end - int(self.sizes[index]) : end].tobytes().decode()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, (tuple, list, Texts)) and tuple(self) == tuple(other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return repr(tuple(self))
