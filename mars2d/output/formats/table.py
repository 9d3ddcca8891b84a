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

MIXED = "damaged: its rows are not those of its bodies, in their order"
"""Why a table is refused whose rows were sorted or renamed."""

NAN = np.array(np.nan).view(np.uint64) << np.uint64(1)
"""The bits of numpy's NaN without its sign."""

Columns = Mapping[str, NDArray[Any]]


def write(record: Rows, path: Path) -> None:
    """Write a record to a file. Raises InputError where it can't be written."""
    columns, header = headers.numbers_of(record), headers.with_shapes(record)
    parts = _parts(header)
    in_table = headers.names_of_bodies(header)
    header["exact"] = {
        name: b64encode(column.tobytes()).decode()
        for name, column in columns.items()
        if name not in in_table or not _as_text_says_all(column)
    }
    text = headers.as_text(header)
    pieces = (text[i : i + PIECE_LENGTH] for i in range(0, len(text), PIECE_LENGTH))
    names = [str(body.name) for body in record.scenario.bodies]
    with atomic_write(path) as binary, io.TextIOWrapper(binary, "utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow([*KEYS, *parts, LAST])
        for rows in _blocks(len(record), len(names) * len(parts)):
            cells = [_cells(columns, column, rows, len(names)) for column in parts.values()]
            times = chain.from_iterable(
                repeat(t, len(names)) for t in columns["time"][rows].tolist()
            )
            bodies = names * (rows.stop - rows.start)
            last = chain(islice(pieces, len(bodies)), repeat(""))
            table.writerows(zip(times, bodies, *cells, last, strict=False))
        table.writerows([*repeat("", len(KEYS) + len(parts)), piece] for piece in pieces)


def read(path: Path, largest: int) -> Rows:
    """Read the record in a file; InputError where there is none, or it is larger than allowed."""
    with reading(path), path.open(encoding="utf-8-sig", newline="") as file:
        size = path.stat().st_size
        check_size(path, size, largest)
        csv.field_size_limit(max(csv.field_size_limit(), size))  # no cell is longer than the file
        text = "".join(_pieces(csv.reader(file, strict=True)))
        header = headers.of_text(text)
        file.seek(0)
        values, names = _values(header, csv.reader(file, strict=True))
        record = headers.restored(header, values)
        if names not in (None, [str(body.name) for body in record.scenario.bodies]):
            raise InputError(MIXED)
        return record


def _pieces(table: Iterator[list[str]]) -> Iterator[str]:
    for row in islice(table, 1, None):
        if not row[-1]:
            return
        yield row[-1]


def _values(
    header: Mapping[str, Any], table: Iterator[list[str]]
) -> tuple[dict[str, NDArray[Any]], list[str] | None]:
    """Return the columns in a table and its header, and the bodies' names in it, if it has rows.

    Columns in the header are there to the last bit.
    """
    shapes, parts = header["columns"], _parts(header)
    if next(table) != [*KEYS, *parts, LAST]:
        raise ValueError("names of columns")
    names = headers.names_of_bodies(header)
    found = {name: np.empty(shapes[name][1], shapes[name][0]) for name in names}
    bodies = shapes["pose"][1][2] + shapes["prop_pose"][1][2]
    called: list[str] | None = None
    for rows in _blocks(shapes["time"][1][0], bodies * len(parts)):
        count = rows.stop - rows.start
        lines = list(islice(table, count * bodies))
        cells = np.array(lines, dtype=object).reshape(count, bodies, len(parts) + 3)
        found["time"][rows] = cells[:, 0, 0].astype(np.float64)
        called = cells[0, :, 1].tolist() if called is None else called
        if (cells[:, :, 0] != cells[:, :1, 0]).any() or (cells[:, :, 1] != called).any():
            raise InputError(MIXED)
        for k, column in enumerate(parts.values(), len(KEYS)):
            for part in column:
                values = found[part.name][rows][(slice(None), *part.at)]
                texts = cells[:, list(part.bodies[: values.shape[1]]), k]
                values[...] = texts == "1" if values.dtype == np.bool_ else texts.astype(np.float64)
    if any(row and row[0] for row in table):
        raise ValueError("more rows than there are")
    for name, text in header["exact"].items():
        found[name] = np.frombuffer(b64decode(text, validate=True), shapes[name][0])
    return found, called


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


def _cells(columns: Columns, parts: list[Part], rows: slice, bodies: int) -> list[Any]:
    """Return the cells of a column of the table, for some of the record's rows."""
    cells = np.full((rows.stop - rows.start, bodies), "", dtype=object)
    for part in parts:
        values = columns[part.name][rows][(slice(None), *part.at)]
        cells[:, list(part.bodies)] = _written(values)
    return cells.ravel().tolist()


def _written(values: NDArray[Any]) -> NDArray[Any]:
    """Return values as objects that csv writes in full, and that R and pandas understand."""
    if values.dtype == np.bool_:
        return values.astype(np.int64).astype(object)
    written = values.astype(object)
    if not np.isfinite(values).all():
        negative = np.signbit(values)
        for odd, text in ((np.isnan(values), "NaN"), (np.isinf(values), "Inf")):
            written[odd & ~negative] = text
            written[odd & negative] = f"-{text}"
    return written


def _as_text_says_all(values: NDArray[Any]) -> bool:
    """Return whether every NaN has the usual bits: a text can't tell others apart."""
    if values.dtype == np.bool_:
        return True
    bits = values[np.isnan(values)].view(np.uint64)
    return bool((bits << np.uint64(1) == NAN).all())
