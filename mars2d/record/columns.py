"""Columns that grow: in memory, or in files that nobody else sees."""

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

from mars2d.core.errors import InputError

__all__ = ["Column", "DiskError", "Scratch", "Storage", "Texts", "blocks"]

RESERVED = 2**25
"""How much memory a column takes before it grows, bytes."""

WINDOW = 2**18
"""How much of a column in a file stays in memory after it was written, bytes."""

FIRST, STEP = 2**16, 2**22
"""By how much a file of a column grows at first, and once it has grown, at least, bytes."""

BLOCK = 2**20
"""How much is read at once of what may be larger than memory, bytes."""


class DiskError(InputError):
    """What a run records can't be kept any more: the disk is full, or a file is gone."""


class Column:
    """An array that rows are appended to, its capacity doubling.

    Rows that were written are not changed again, so a view of them stays as it is.
    """

    def __init__(self, shape: tuple[int, ...], dtype: Any, capacity: int) -> None:
        row = max(1, prod(shape) * np.dtype(dtype).itemsize)
        self._rows = np.zeros((max(1, min(capacity, RESERVED // row)), *shape), dtype=dtype)
        self.shape, self.dtype = shape, self._rows.dtype

    def write(self, row: int, value: Any) -> None:
        """Write one row, at most the next one."""
        if row >= len(self._rows):
            self._grow(row, row + 1)
        self._rows[row] = value

    def write_block(self, row: int, values: NDArray[Any]) -> None:
        """Write some rows, beginning with at most the next one."""
        end = row + len(values)
        if end > len(self._rows):
            self._grow(row, end)
        self._rows[row:end] = values

    def row(self, row: int) -> Any:
        """Return one row, to be read only."""
        return self._rows[row]

    def upto(self, count: int) -> NDArray[Any]:
        """Return the first rows, as a view that can't be written."""
        view = self._rows[:count]
        view.flags.writeable = False
        return view

    def _grow(self, filled: int, rows: int) -> None:
        """Make room for more rows; the first `filled` ones hold something."""
        grown = np.zeros((2 * rows, *self.shape), dtype=self.dtype)
        grown[:filled] = self._rows[:filled]
        self._rows = grown


Storage = Callable[[tuple[int, ...], Any, int], Column]
"""What makes a column: of the shape of a row, the kind of its numbers, and how many rows."""


class Scratch:
    """Makes columns in files of a folder that have no name and are gone with the process.

    So what is recorded takes no memory, however much it is. Raises DiskError where there is no
    room.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def __call__(self, shape: tuple[int, ...], dtype: Any, capacity: int) -> Column:
        """Return a column; one whose rows are empty takes no file."""
        if prod(shape) == 0:
            return Column(shape, dtype, capacity)
        return _FileColumn(self._folder, shape, dtype)


class _FileColumn(Column):
    """A column in a file, which is mapped into memory; only its end stays there."""

    def __init__(self, folder: Path, shape: tuple[int, ...], dtype: Any) -> None:
        self.shape, self.dtype = shape, np.dtype(dtype)
        self._folder = folder
        self._row = prod(shape) * self.dtype.itemsize
        self._rows = np.zeros((0, *shape), dtype=dtype)
        self._size = 0

    def _grow(self, filled: int, rows: int) -> None:  # noqa: ARG002
        if rows * self._row > self._size:
            self._extend(rows * self._row)
        _let_go(self._map)
        # What is mapped is shown piece by piece, so that this is called after each piece.
        end = min(self._size // self._row, rows + WINDOW // self._row)
        self._rows = np.ndarray((end, *self.shape), self.dtype, self._map)

    def _extend(self, least: int) -> None:
        """Map more of the file. Views of what was mapped before show the same file."""
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
    """Make a file longer by bytes that the disk really has.

    Else a full disk would end the process when a page of the mapped file can't be written.
    """
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(file, start, count)
        return
    os.lseek(file, start, os.SEEK_SET)
    while count > 0:
        count -= os.write(file, bytes(min(count, BLOCK)))


def _let_go(mapped: mmap.mmap) -> None:
    """Let pages of a file leave the memory; they are read again when they are looked at."""
    if hasattr(mmap, "MADV_DONTNEED"):
        mapped.madvise(mmap.MADV_DONTNEED)


def blocks(column: NDArray[Any]) -> Iterator[NDArray[Any]]:
    """Yield an array piece by piece; of one that is kept in a file, no more stays in memory."""
    mapped: Any = column
    while isinstance(mapped, np.ndarray):
        mapped = mapped.base
    row = prod(column.shape[1:]) * column.dtype.itemsize
    count = max(1, BLOCK // max(1, row))
    for start in range(0, len(column), count):
        yield column[start : start + count]
        if isinstance(mapped, mmap.mmap):
            _let_go(mapped)


class Texts(Sequence[str]):
    """Texts one after the other, as bytes of UTF-8; each is made when it is asked for."""

    def __init__(self, storage: Storage = Column) -> None:
        self._data = storage((), np.uint8, 1024)
        self._ends = storage((), np.int64, 64)
        self._sizes = storage((), np.int64, 64)
        self._count = self._end = 0

    @classmethod
    def of(cls, texts: Sequence[str]) -> Texts:
        """Return texts as such; what is that already stays as it is."""
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
        """Return the texts so far, to which nothing is added any more."""
        return copy(self)

    @property
    def data(self) -> NDArray[np.uint8]:
        """All texts as bytes, one after the other."""
        return self._data.upto(self._end)

    @property
    def sizes(self) -> NDArray[np.int64]:
        """How many bytes each text has."""
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
