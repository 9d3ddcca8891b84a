"""``.npz``: the columns as arrays of numpy, compressed, and a header in JSON; no pickles."""

from __future__ import annotations

from pathlib import Path
from typing import Any, BinaryIO
from zipfile import ZipFile

import numpy as np

from mars2d.core.files import atomic_write
from mars2d.output.formats import header as headers
from mars2d.output.formats.guard import check_size, reading
from mars2d.record.rows import Rows

HEADER = "header"


def write(record: Rows, path: Path) -> None:
    """Write a record to a file. Raises InputError where it can't be written."""
    with atomic_write(path) as file:
        pack(record, file)


def pack(record: Rows, file: BinaryIO) -> None:
    """Write a record to an open file."""
    text = headers.as_text(headers.of_record(record)).encode()
    columns: dict[str, Any] = {HEADER: np.frombuffer(text, dtype=np.uint8), **record.columns()}
    np.savez_compressed(file, allow_pickle=False, **columns)


def read(path: Path, largest: int) -> Rows:
    """Read the record in a file; InputError where there is none, or it is larger than allowed."""
    with reading(path), path.open("rb") as file:
        return unpacked(file, path, largest)


def unpacked(file: BinaryIO, path: Path, largest: int) -> Rows:
    """Return the record in an open file; path: for the message of one that is too large."""
    with ZipFile(file) as archive:
        check_size(path, sum(each.file_size for each in archive.infolist()), largest)
    file.seek(0)
    with np.load(file, allow_pickle=False) as data:
        header = headers.of_text(data[HEADER].tobytes())
        return headers.to_record(header, {name: data[name] for name in data if name != HEADER})
