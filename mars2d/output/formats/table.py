"""``.csv``: one long table with a row for each time and body, which any program opens.

Its last column, `record`, holds everything that is not in the others, as pieces of JSON.
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
from mars2d.output.formats import header as headers
from mars2d.output.formats.columns import KEYS, LAST, Part, parts_of
from mars2d.output.formats.guard import check_size, reading
from mars2d.record.rows import Rows

PIECE_LENGTH = 30_000
"""The characters of JSON in a cell; a cell of a spreadsheet holds 32 767."""

BLOCK_CELLS = 50_000
"""How many cells of the table are made at once, approximately."""

NAN = np.array(np.nan).view(np.uint64) << np.uint64(1)
"""The bits of numpy's NaN without its sign."""


def write(record: Rows, path: Path) -> None:
    """Write a record to a file. Raises InputError where it can't be written."""
    header = headers.with_shapes(record)
    in_table = headers.names_of_bodies(header)
    header["exact"] = {
        name: b64encode(column.tobytes()).decode()
        for name, column in headers.numbers_of(record).items()
        if name not in in_table or not _as_text_says_all(column)
    }
    text = headers.as_text(header)
    pieces = (text[i : i + PIECE_LENGTH] for i in range(0, len(text), PIECE_LENGTH))
    parts = _parts(header)
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
        header = headers.of_text("".join(_pieces(csv.reader(file, strict=True))))
        file.seek(0)
        record = headers.restored(header, _values(header, csv.reader(file, strict=True)))
        parts = _parts(header)
        file.seek(0)
        table = csv.reader(file, strict=True)
        wanted = chain([[*KEYS, *parts]], _lines(record, parts), repeat([""] * (2 + len(parts))))
        for line, cells in zip(table, wanted, strict=False):
            if line[:-1] != cells:
                raise InputError(f"damaged: line {table.line_num} was changed since it was saved")
        return record


def _pieces(table: Iterator[list[str]]) -> Iterator[str]:
    for row in islice(table, 1, None):
        if not row[-1]:
            return
        yield row[-1]


def _values(header: Mapping[str, Any], table: Iterator[list[str]]) -> dict[str, NDArray[Any]]:
    """Return the columns in a table, and those of its header, which are there to the last bit."""
    shapes, parts = header["columns"], _parts(header)
    found = {
        name: np.empty(shapes[name][1], shapes[name][0]) for name in headers.names_of_bodies(header)
    }
    bodies = shapes["pose"][1][2] + shapes["prop_pose"][1][2]
    next(table)
    for rows in _blocks(shapes["time"][1][0], bodies * len(parts)):
        lines = list(islice(table, (rows.stop - rows.start) * bodies))
        cells = np.array(lines, dtype=object).reshape(-1, bodies, len(parts) + 3)
        found["time"][rows] = cells[:, 0, 0].astype(np.float64)
        for k, column in enumerate(parts.values(), len(KEYS)):
            for part in column:
                values = found[part.name][rows][(slice(None), *part.at)]
                texts = cells[:, list(part.bodies[: values.shape[1]]), k]
                values[...] = texts == "1" if values.dtype == np.bool_ else texts.astype(np.float64)
    for name, text in header["exact"].items():
        found[name] = np.frombuffer(b64decode(text, validate=True), shapes[name][0])
    return found


def _parts(header: Mapping[str, Any]) -> dict[str, list[Part]]:
    """Return the columns of the table of a record with this header."""
    shapes, sensors = header["columns"], header["sensor_robots"]
    robots, props = (shapes[name][1][2] for name in ("pose", "prop_pose"))
    readings = {name: shapes[f"sensor:{name}"][1] for name in sensors}
    return parts_of(robots, props, sensors, readings, headers.columns_in(header))


def _blocks(rows: int, width: int) -> Iterator[slice]:
    """Yield slices that divide rows into blocks. width: the cells of a row."""
    step = max(1, BLOCK_CELLS // max(1, width))
    return (slice(start, min(start + step, rows)) for start in range(0, rows, step))


def _lines(record: Rows, parts: Mapping[str, list[Part]]) -> Iterator[list[str]]:
    """Yield the lines of the table, each a list of cells."""
    columns = headers.numbers_of(record)
    names = [str(body.name) for body in record.scenario.bodies]
    for rows in _blocks(len(record), len(names) * len(parts)):
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


def _as_text_says_all(values: NDArray[Any]) -> bool:
    """Return whether every NaN has the usual bits: a text can't tell others apart."""
    if values.dtype == np.bool_:
        return True
    bits = values[np.isnan(values)].view(np.uint64)
    return bool((bits << np.uint64(1) == NAN).all())
