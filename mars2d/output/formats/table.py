"""``.csv``: one long table with a row for each time and body, which any program opens.

Its last column, `record`, holds the record once more, as an .npz in base64: it is what is read.
"""

from __future__ import annotations

import csv
import io
from base64 import b64decode, b64encode
from collections.abc import Iterator, Mapping
from itertools import chain, islice, repeat
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError
from mars2d.core.files import atomic_write
from mars2d.output.formats import npz
from mars2d.output.formats.columns import KEYS, LAST, Part, parts_of
from mars2d.output.formats.guard import check_size, reading
from mars2d.record.rows import Rows

PIECE_LENGTH = 30_000
"""The characters of base64 in a cell; a cell of a spreadsheet holds 32 767."""

BLOCK_CELLS = 50_000
"""How many cells of the table are made at once, approximately."""


def write(record: Rows, path: Path) -> None:
    """Write a record to a file. Raises InputError where it can't be written."""
    packed = io.BytesIO()
    npz.pack(record, packed)
    text = b64encode(packed.getbuffer()).decode()
    pieces = (text[i : i + PIECE_LENGTH] for i in range(0, len(text), PIECE_LENGTH))
    parts = parts_of(record)
    with atomic_write(path) as binary, io.TextIOWrapper(binary, "utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow([*KEYS, *parts, LAST])
        table.writerows([*cells, next(pieces, "")] for cells in _lines(record, parts))
        table.writerows([*repeat("", len(KEYS) + len(parts)), piece] for piece in pieces)


def read(path: Path, largest: int) -> Rows:
    """Read the record in a file; InputError where there is none, or it is larger than allowed.

    The table must be the one that would be written: so other programs read the same numbers.
    """
    with reading(path), path.open(encoding="utf-8-sig", newline="") as file:
        size = path.stat().st_size
        check_size(path, size, largest)
        csv.field_size_limit(max(csv.field_size_limit(), size))  # no cell is longer than the file
        text = "".join(line[-1] for line in islice(csv.reader(file, strict=True), 1, None))
        record = npz.unpacked(io.BytesIO(b64decode(text, validate=True)), path, largest)
        parts = parts_of(record)
        file.seek(0)
        table = csv.reader(file, strict=True)
        blank = [""] * (len(KEYS) + len(parts))
        wanted = chain([[*KEYS, *parts]], _lines(record, parts), repeat(blank))
        for line in table:
            if line[:-1] != next(wanted):
                raise InputError(f"damaged: line {table.line_num} was changed since it was saved")
        if next(wanted) != blank:
            raise InputError("damaged: its last lines are missing")
        return record


def _lines(record: Rows, parts: Mapping[str, list[Part]]) -> Iterator[list[str]]:
    """Yield the lines of the table, each a list of cells."""
    columns = record.columns()
    names = [str(body.name) for body in record.scenario.bodies]
    step = max(1, BLOCK_CELLS // max(1, len(names) * len(parts)))
    for start in range(0, len(record), step):
        rows = slice(start, min(start + step, len(record)))
        cells = np.full((rows.stop - rows.start, len(names), 2 + len(parts)), "", dtype=object)
        cells[:, :, 0] = _texts(columns["time"][rows])[:, None]
        cells[:, :, 1] = names
        for k, where in enumerate(parts.values(), len(KEYS)):
            for part in where:
                values = columns[part.name][rows][(slice(None), *part.at)]
                cells[:, list(part.bodies), k] = _texts(values)
        yield from cells.reshape(-1, cells.shape[2]).tolist()


def _texts(values: NDArray[Any]) -> NDArray[np.object_]:
    """Return values as full texts that R and pandas understand."""
    if values.dtype == np.bool_:
        return np.where(values, "1", "0").astype(object)
    texts = np.array([repr(value) for value in values.ravel().tolist()], dtype=object)
    texts = texts.reshape(values.shape)
    if not np.isfinite(values).all():
        negative = np.signbit(values)
        for odd, text in ((np.isnan(values), "NaN"), (np.isinf(values), "Inf")):
            texts[odd & ~negative] = text
            texts[odd & negative] = f"-{text}"
    return texts
