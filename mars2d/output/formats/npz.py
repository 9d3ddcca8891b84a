"""``.npz``: the columns as arrays of numpy, compressed, and a header in JSON; no pickles."""

from __future__ import annotations

from math import prod
from pathlib import Path
from typing import Any
from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile

import numpy as np
from numpy.typing import NDArray

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
        long = archive.getinfo(f"{HEADER}.npy").file_size
        check_size(path, headers.OBJECTS * long, largest)
        header = headers.of_text(path, _array(archive, HEADER).tobytes(), largest)
        names = headers.names_in(header)
        sizes = [archive.getinfo(f"{name}.npy").file_size for name in {HEADER, *names}]
        check_size(path, sum(sizes), largest)
        return headers.to_record(header, {name: _array(archive, name) for name in names})


def _array(archive: ZipFile, name: str) -> NDArray[Any]:
    """Return an array of an archive. Raises ValueError if it isn't as large as it claims to be.

    numpy's own reader takes as much memory as is claimed before it reads.
    """
    place = archive.getinfo(f"{name}.npy")
    if place.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
        raise ValueError(name)  # others decompress without a limit
    with archive.open(place) as file:
        version = np.lib.format.read_magic(file)
        heads = {(1, 0): np.lib.format.read_array_header_1_0,
                 (2, 0): np.lib.format.read_array_header_2_0}  # fmt: skip
        shape, fortran, dtype = heads[version](file)
        size = prod(shape) * dtype.itemsize
        if dtype.hasobject or size != place.file_size - file.tell():
            raise ValueError(name)
        flat = np.frombuffer(file.read(size), dtype=dtype)
    return flat.reshape(shape, order="F" if fortran else "C")
