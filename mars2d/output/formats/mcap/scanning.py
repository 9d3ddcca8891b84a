"""The records of an MCAP file, one after the other up to where the file ends or breaks off."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

from mars2d.core.errors import InputError

MAGIC = b"\x89MCAP0\r\n"


class Torn(Exception):  # noqa: N818
    """The file breaks off."""


class _Whole:
    """A file that reads all bytes that are asked for, or raises Torn; the library takes fewer."""

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file

    def read(self, size: int) -> bytes:
        """Return as many bytes."""
        data = self._file.read(size)
        if len(data) < size:
            raise Torn
        return data


def scan(path: Path, file: IO[bytes]) -> Iterator[Any]:
    """Yield the records of the library `mcap` up to the end of the data.

    Raises Torn where the file breaks off, InputError for another kind of file, and the library's
    errors where it is damaged.
    """
    from mcap.exceptions import RecordLengthLimitExceeded
    from mcap.records import DataEnd
    from mcap.stream_reader import StreamReader

    if not MAGIC.startswith(file.read(len(MAGIC))):
        raise InputError(f"{path}: this is no MCAP file")
    size = path.stat().st_size  # a record that claims to be longer breaks off
    whole: Any = _Whole(file)
    reader = StreamReader(whole, skip_magic=True, validate_crcs=True, record_size_limit=size)
    try:
        for record in reader.records:
            if isinstance(record, DataEnd):
                return
            yield record
    except RecordLengthLimitExceeded as error:
        raise Torn from error
