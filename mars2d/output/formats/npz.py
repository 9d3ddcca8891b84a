"""``.npz``: the columns as arrays of numpy, compressed, and a header in JSON; no pickles."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from zipfile import ZipFile

import numpy as np

from mars2d.core.files import atomic_write
from mars2d.output.formats import header as headers
from mars2d.output.formats.guard import check_size, reading
from mars2d.record.rows import Rows

HEADER = "header"


def write(record: Rows, path: Path) -> None:
    """Write a record to a file. Raises InputError where it can't be written."""
    text = headers.as_text(headers.of_record(record)).encode()
    columns: dict[str, Any] = {HEADER: np.frombuffer(text, dtype=np.uint8), **record.columns()}
    with atomic_write(path) as file:
        np.savez_compressed(file, allow_pickle=False, **columns)


def read(path: Path, largest: int) -> Rows:
    """Read the record in a file; InputError where there is none, or it is larger than allowed."""
    with reading(path), ZipFile(path) as archive:
        check_size(path, sum(each.file_size for each in archive.infolist()), largest)
        with np.load(path, allow_pickle=False) as data:
            header = headers.of_text(data[HEADER].tobytes())
            names = headers.names_in(header)
            return headers.to_record(header, {name: data[name] for name in names})
