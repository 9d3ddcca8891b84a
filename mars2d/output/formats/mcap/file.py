"""The file of a log while a run goes on: it grows by whole ticks."""

from __future__ import annotations

import os
from pathlib import Path
from time import monotonic

from mars2d.record.columns import DiskError

__all__ = ["File"]

GLANCE = 1.0
"""The seconds between two looks whether the file still has its name."""


class File:
    """A file that takes what was written to it in one piece, when it is told to.

    What it has taken stays where the process is killed. Raises DiskError where it can't be written,
    or where somebody has moved or deleted it; what it has taken before is kept.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        flags = os.O_RDWR | os.O_CREAT | os.O_TRUNC | getattr(os, "O_BINARY", 0)
        try:
            self._file = os.open(path, flags, 0o666)
        except OSError as error:
            raise self._error(error) from error
        self._pending = bytearray()
        self._taken = 0
        self._broken = False
        self._glanced = monotonic()

    def write(self, data: bytes) -> int:
        """Keep bytes until they are taken."""
        self._pending += data
        return len(data)

    def tell(self) -> int:
        """Return how many bytes there are."""
        return self._taken + len(self._pending)

    def take(self) -> None:
        """Take all that was written since it was called last, or nothing of it."""
        if monotonic() - self._glanced > GLANCE:
            self.check()
        try:
            if self._broken:  # by Ctrl-C, after some of it was taken
                os.lseek(self._file, self._taken, os.SEEK_SET)
            self._broken = True
            rest = memoryview(self._pending)
            while rest:
                rest = rest[os.write(self._file, rest) :]
        except OSError as error:
            self._drop()
            raise self._error(error) from error
        self._taken += len(self._pending)
        self._pending = bytearray()
        self._broken = False

    def check(self) -> None:
        """Raise DiskError if the file is not there any more under its name."""
        self._glanced = monotonic()
        try:
            there = os.path.samestat(self._path.stat(), os.fstat(self._file))
        except OSError:
            there = False
        if not there:
            self._pending = bytearray()
            raise DiskError(f"{self._path}: it was deleted or moved while it was written")

    def close(self) -> None:
        """Close the file as it is."""
        os.close(self._file)

    def _drop(self) -> None:
        """Forget what could not be taken whole."""
        self._pending = bytearray()
        os.ftruncate(self._file, self._taken)

    def _error(self, error: OSError) -> DiskError:
        return DiskError(f"{self._path}: can't be written: {error.strerror or error}")
