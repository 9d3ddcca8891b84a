"""The rows of a record as messages of Protocol Buffers, each with all that happened in its step."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
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

KINDS = {"f": ("double", "<f8"), "i": ("sfixed32", "<i4"), "u": ("fixed32", "<u4"),
         "b": ("bool", "?")}  # fmt: skip
"""How arrays are stored, by the kinds of their numbers: as messages call it, and as numpy does."""


def _fields_of(dtype: np.dtype[Any]) -> dict[str, str]:
    """Return the fields of a message that holds the rows of a structured array."""
    return {name: f"{KINDS[dtype[name].base.kind][0]}[]" for name in dtype.names or ()}


FIELDS = {
    "Row": {
        "crc": "fixed32",
        "row": "uint64",
        **dict.fromkeys(COLUMNS, "double[]"),
        "readings": "Readings[]",
        "contacts": "Contacts",
        "messages": "Messages",
        "contents": "string[]",
        "changes": "string[]",
    },
    "Readings": {
        "sensor": "string",
        "shape": "fixed32[]",
        "numbers": "double[]",
        "flags": "bool[]",
    },
    "Contacts": _fields_of(CONTACT),
    "Messages": _fields_of(MESSAGE),
}
"""The fields of all messages, numbered from 1 on; [] marks arrays, which are flat."""

CRC = struct.Struct("<BI")
"""How a row ends: the tag of its field `crc`, and the check sum of all bytes before it."""

CRC_TAG = 1 << 3 | 5  # the first field, a fixed32


def schema() -> bytes:
    """Return the schema of a row, as a FileDescriptorSet of Protocol Buffers."""
    from google.protobuf.descriptor_pb2 import FieldDescriptorProto as Field
    from google.protobuf.descriptor_pb2 import FileDescriptorSet

    files = FileDescriptorSet()
    file = files.file.add(name="mars2d/row.proto", package="mars2d", syntax="proto3")
    for title, fields in FIELDS.items():
        message = file.message_type.add(name=title)
        for number, (name, kind) in enumerate(fields.items(), start=1):
            field = message.field.add(name=name, number=number)
            field.label = Field.LABEL_REPEATED if kind.endswith("[]") else Field.LABEL_OPTIONAL
            one = kind.removesuffix("[]")
            if one in FIELDS:
                field.type, field.type_name = Field.TYPE_MESSAGE, f".mars2d.{one}"
            else:
                field.type = Field.Type.Value(f"TYPE_{one.upper()}")
    return bytes(files.SerializeToString())


@cache
def _message_class() -> Any:
    """Return the class of a row's message, in which each array of numbers is one of bytes.

    Both are stored alike, so numpy's arrays are written and read as they are: none of their numbers
    is changed, nor becomes an object of Python. A field that is set is stored even if it is 0.
    """
    from google.protobuf.descriptor_pb2 import FileDescriptorSet
    from google.protobuf.descriptor_pool import DescriptorPool
    from google.protobuf.message_factory import GetMessageClass

    [file] = FileDescriptorSet.FromString(schema()).file
    file.syntax = "proto2"
    for message in file.message_type:
        for field in message.field:
            array = field.label == field.LABEL_REPEATED
            if array and field.type not in (field.TYPE_MESSAGE, field.TYPE_STRING):
                field.type, field.label = field.TYPE_BYTES, field.LABEL_OPTIONAL
    pool = DescriptorPool()
    pool.Add(file)
    return GetMessageClass(pool.FindMessageTypeByName("mars2d.Row"))


def encoded(row: Row) -> bytes:
    """Return a row as a message, see `schema`."""
    message = _message_class()(row=row.row, contents=row.contents, changes=row.changes)
    for name, values in row.columns.items():
        _, of_sensor, sensor = name.partition(":")
        if of_sensor:
            shape = _stored(np.array(values.shape, "<u4"))
            kind = "flags" if values.dtype.kind == "b" else "numbers"
            message.readings.add(sensor=sensor, shape=shape, **{kind: _stored(values)})
        else:
            setattr(message, name, _stored(values))
    for table, rows in ((message.contacts, row.contacts), (message.messages, row.messages)):
        if len(rows):
            for name in rows.dtype.names or ():
                setattr(table, name, _stored(rows[name]))
    data: bytes = message.SerializeToString()
    return data + CRC.pack(CRC_TAG, crc32(data))


def decoded(data: bytes) -> Row:
    """Return the row in a message; its columns are flat, but for those of sensors.

    Raises various exceptions, such as ValueError, where there is none.
    """
    body = data[: -CRC.size]
    if data[-CRC.size :] != CRC.pack(CRC_TAG, crc32(body)):
        raise ValueError("check sum of a row")
    message = _message_class().FromString(body)
    columns = {name: _restored(getattr(message, name), np.dtype(float)) for name in COLUMNS}
    return Row(
        row=message.row,
        columns=columns | {f"sensor:{each.sensor}": _readings(each) for each in message.readings},
        contacts=_table(message, "contacts", CONTACT),
        messages=_table(message, "messages", MESSAGE),
        contents=list(message.contents),
        changes=list(message.changes),
    )


def _stored(values: NDArray[Any]) -> bytes:
    """Return the bytes of an array, or of a number of numpy, as messages store them."""
    return values.astype(KINDS[values.dtype.kind][1], copy=False).tobytes()


def _restored(data: bytes, dtype: np.dtype[Any]) -> NDArray[Any]:
    """Return the array (k,) of a kind whose bytes `_stored` has made."""
    return np.frombuffer(data, KINDS[dtype.kind][1]).astype(dtype, copy=False)


def _readings(message: Any) -> NDArray[Any]:
    shape = _restored(message.shape, np.dtype(np.uint32)).tolist()
    if message.HasField("flags"):
        return _restored(message.flags, np.dtype(bool)).reshape(shape)
    return _restored(message.numbers, np.dtype(float)).reshape(shape)


def _table(message: Any, field: str, dtype: np.dtype[Any]) -> NDArray[np.void]:
    """Return the structured array in a field that holds its columns one by one."""
    if not message.HasField(field):
        return np.zeros(0, dtype=dtype)
    table = getattr(message, field)
    rows = np.zeros(len(table.time) // 8, dtype=dtype)
    for name in dtype.names or ():
        values = rows[name]
        values[...] = _restored(getattr(table, name), values.dtype).reshape(values.shape)
    return rows
