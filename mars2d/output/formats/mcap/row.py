"""The rows of a record as messages of a log, each with all that happened in its step."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator, Mapping, Sequence
from math import prod
from typing import Any, NamedTuple
from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from mars2d.record import interventions
from mars2d.record.contact import CONTACT
from mars2d.record.interventions import Intervention
from mars2d.record.message import MESSAGE
from mars2d.record.rows import COLUMNS, Rows


class Row(NamedTuple):
    """A row of a record, with the contacts and messages of the control step that began there.

    columns: those of `COLUMNS`, and ``sensor:NAME`` of each sensor. contents: the texts that no
    earlier row has. changes: the interventions at this row, as JSON.
    """

    row: int
    columns: Mapping[str, NDArray[Any]]
    contacts: NDArray[np.void]
    messages: NDArray[np.void]
    contents: Sequence[str]
    changes: Sequence[str]

    @property
    def time(self) -> float:
        """When it was, seconds."""
        return float(self.columns["time"])


# -- a record cut into rows -------------------------------------------------------------------


def cut(record: Rows, start: int = 0) -> Iterator[Row]:
    """Yield the rows of a record from `start` on."""
    contacts = _ends(record.contact_rows - 1, len(record))
    rounding = 1e-6 * record.scenario.sampling_time
    sent = np.searchsorted(record.time, record.messages["time"] + rounding, side="left") - 1
    messages = _ends(sent, len(record))
    # A text comes with the first message that has it; messages are in the order of their texts.
    contents = np.zeros(len(record) + 1, dtype=int)
    last = np.maximum.accumulate(np.concatenate([[-1], record.messages["content"]]))
    contents[1:] = 1 + last[messages[1:]]
    contents[-1] = len(record.contents)
    columns = {name: getattr(record, name) for name in COLUMNS}
    columns |= {f"sensor:{name}": values for name, values in record.sensors.items()}
    for k in range(start, len(record)):
        yield Row(
            row=k,
            columns={name: values[k] for name, values in columns.items()},
            contacts=record.contacts[contacts[k] : contacts[k + 1]],
            messages=record.messages[messages[k] : messages[k + 1]],
            contents=record.contents[contents[k] : contents[k + 1]],
            changes=changes_at(record.interventions, k),
        )


def changes_at(done: Sequence[Intervention], row: int) -> list[str]:
    """Return the interventions at a row, as texts of JSON."""
    found = []
    for each in reversed(done):
        if each.row < row:
            break
        if each.row == row:
            found.append(json.dumps(interventions.to_plain(each)))
    return found[::-1]


def _ends(rows: NDArray[np.intp], count: int) -> NDArray[np.intp]:
    """Return where each row's entries begin in a list of entries, (count + 1,).

    rows: of the entries, (m,), almost in order. The entries of row k go from item k of the result
    to item k + 1. The last row has all later entries.
    """
    rows = np.maximum.accumulate(np.clip(rows, 0, None), dtype=np.intp)
    ends = np.searchsorted(rows, np.arange(count + 1), side="left")
    ends[-1] = len(rows)
    return ends


def nanoseconds(time: float) -> int:
    """Return a simulated time [s] in nanoseconds, as MCAP counts."""
    return round(float(time) * 1e9)  # rounding numbers of numpy is slow


# -- rows as messages -------------------------------------------------------------------------

CRC = struct.Struct("<I")
"""How a row ends: the check sum of all bytes before it."""

TABLES = {"contacts": CONTACT, "messages": MESSAGE}


def encoded(row: Row) -> bytes:
    """Return a row as a message: a line of JSON that tells of its arrays, and their bytes."""
    texts = json.dumps([row.row, list(row.contents), list(row.changes)])
    tables = {"texts": texts.encode(), **{name: getattr(row, name).tobytes() for name in TABLES}}
    arrays = {name: np.frombuffer(data, np.uint8) for name, data in tables.items()}
    arrays |= {name: np.asarray(values) for name, values in row.columns.items()}
    told = [(name, values.dtype.str, values.shape) for name, values in arrays.items()]
    parts = [json.dumps(told).encode(), b"\n", *(values.tobytes() for values in arrays.values())]
    data = b"".join(parts)
    return data + CRC.pack(crc32(data))


def decoded(data: bytes) -> Row:
    """Return the row in a message.

    Raises various exceptions, such as ValueError, where there is none.
    """
    body = data[: -CRC.size]
    if data[-CRC.size :] != CRC.pack(crc32(body)):
        raise ValueError("check sum of a row")
    start = body.index(b"\n") + 1
    arrays: dict[str, NDArray[Any]] = {}
    for name, kind, shape in json.loads(body[:start]):
        count = prod(shape)
        arrays[name] = np.frombuffer(body, kind, count, start).reshape(shape)
        start += arrays[name].nbytes
    number, contents, changes = json.loads(arrays.pop("texts").tobytes())
    tables = {name: arrays.pop(name).view(dtype) for name, dtype in TABLES.items()}
    return Row(row=number, columns=arrays, contents=contents, changes=changes, **tables)
