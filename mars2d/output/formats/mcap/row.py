"""The message in which a row of a record is kept, exactly, with all that happened in its step."""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple
from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from mars2d.output.formats.mcap.wire import block, fields, packed, unpacked, varint
from mars2d.record.contact import CONTACT
from mars2d.record.message import MESSAGE

__all__ = ["Row", "decoded", "encoded", "schema"]

Float = NDArray[np.float64]

NAMES = ("row", "time", "command_time", "pose", "command", "prop_pose", "effort", "readings",
         "contacts", "messages", "contents", "changes")  # fmt: skip
"""The fields of a row, numbered from 1 on."""

ROW, TIME, COMMAND_TIME, POSE, COMMAND, PROP_POSE, EFFORT, READINGS, CONTACTS, MESSAGES, \
    CONTENTS, CHANGES = range(1, len(NAMES) + 1)  # fmt: skip
CRC = 15
SENSOR, SHAPE, NUMBERS, FLAGS = range(1, 5)

TAIL = 5
"""The bytes of the last field, the check sum of all before it."""


class Row(NamedTuple):
    """A row of a record, with the contacts and messages of the control step that began there.

    The numbers of `pose`, `command` and `prop_pose` come quantity by quantity. contents: the texts
    that no row before had. changes: the interventions at this row, as JSON.
    """

    row: int
    time: float
    command_time: float
    pose: Float
    command: Float
    prop_pose: Float
    effort: Float
    readings: Mapping[str, NDArray[Any]]
    contacts: NDArray[np.void]
    messages: NDArray[np.void]
    contents: Sequence[str]
    changes: Sequence[str]


def encoded(row: Row) -> bytes:
    """Return a row as a message of Protocol Buffers, see `schema`."""
    parts = [
        bytes([ROW << 3]),
        varint(row.row),
        struct.pack("<BdBd", TIME << 3 | 1, row.time, COMMAND_TIME << 3 | 1, row.command_time),
        packed(POSE, row.pose),
        packed(COMMAND, row.command),
        packed(PROP_POSE, row.prop_pose),
        packed(EFFORT, row.effort),
    ]
    parts += [block(READINGS, _readings(name, values)) for name, values in row.readings.items()]
    if len(row.contacts):
        parts.append(block(CONTACTS, _table(row.contacts)))
    if len(row.messages):
        parts.append(block(MESSAGES, _table(row.messages)))
    parts += [block(CONTENTS, text.encode()) for text in row.contents]
    parts += [block(CHANGES, text.encode()) for text in row.changes]
    data = b"".join(parts)
    return data + struct.pack("<BI", CRC << 3 | 5, crc32(data))


def _readings(name: str, values: NDArray[Any]) -> bytes:
    numbers = FLAGS if values.dtype.kind == "b" else NUMBERS
    shape = np.array(values.shape, dtype=np.uint32)
    return block(SENSOR, name.encode()) + packed(SHAPE, shape) + packed(numbers, values)


def _table(rows: NDArray[np.void]) -> bytes:
    """Return rows of a structured array field by field."""
    return b"".join(packed(i, rows[name]) for i, name in enumerate(rows.dtype.names or (), start=1))


def decoded(data: bytes) -> Row:
    """Return the row of a message; raises what it may, such as ValueError, where that is none.

    Its arrays are flat, but for the readings.
    """
    body = memoryview(data)[:-TAIL]
    if data[-TAIL:] != struct.pack("<BI", CRC << 3 | 5, crc32(body)):
        raise ValueError("check sum of a row")
    double = np.dtype(float)
    found: dict[int, Any] = {CONTACTS: np.empty(0, CONTACT), MESSAGES: np.empty(0, MESSAGE)}
    found |= {READINGS: {}, CONTENTS: [], CHANGES: []}
    for field, value in fields(body):
        if field == ROW:
            found[field] = value
            continue
        assert isinstance(value, memoryview)
        if field in (TIME, COMMAND_TIME):
            (found[field],) = struct.unpack("<d", value)
        elif field == READINGS:
            name, values = _as_readings(value)
            found[field][name] = values
        elif field == CONTACTS:
            found[field] = _as_table(value, CONTACT)
        elif field == MESSAGES:
            found[field] = _as_table(value, MESSAGE)
        elif field in (CONTENTS, CHANGES):
            found[field].append(str(value, "utf-8"))
        else:
            found[field] = unpacked(value, double)
    return Row(*(found[field] for field in range(1, len(NAMES) + 1)))


def _as_readings(data: memoryview) -> tuple[str, NDArray[Any]]:
    found = dict(fields(data))
    numbers = FLAGS if FLAGS in found else NUMBERS
    values = unpacked(_bytes(found[numbers]), np.dtype(bool if numbers == FLAGS else float))
    shape = unpacked(_bytes(found[SHAPE]), np.dtype(np.uint32))
    return str(_bytes(found[SENSOR]), "utf-8"), values.reshape(shape.tolist())


def _as_table(data: memoryview, dtype: np.dtype[Any]) -> NDArray[np.void]:
    found = dict(fields(data))
    names = dtype.names or ()
    rows = np.zeros(len(_bytes(found[1])) // 8, dtype=dtype)  # both begin with a time
    for i, name in enumerate(names, start=1):
        rows[name] = unpacked(_bytes(found[i]), rows[name].dtype).reshape(rows[name].shape)
    return rows


def _bytes(value: memoryview | int) -> memoryview:
    if isinstance(value, int):
        raise ValueError("a number where bytes were expected")  # noqa: TRY004
    return value


def schema() -> bytes:
    """Return the schema of a row, as a FileDescriptorSet of Protocol Buffers."""
    from google.protobuf.descriptor_pb2 import FieldDescriptorProto as Field
    from google.protobuf.descriptor_pb2 import FileDescriptorSet

    files = FileDescriptorSet()
    file = files.file.add(name="mars2d/row.proto", package="mars2d", syntax="proto3")
    kinds = {"f": Field.TYPE_DOUBLE, "i": Field.TYPE_SFIXED32, "u": Field.TYPE_FIXED32,
             "b": Field.TYPE_BOOL}  # fmt: skip
    row = file.message_type.add(name="Row")
    special: dict[str, dict[str, Any]] = {
        "row": {"type": Field.TYPE_UINT64},
        "time": {"type": Field.TYPE_DOUBLE},
        "command_time": {"type": Field.TYPE_DOUBLE},
        "readings": _many(Field, type_name=".mars2d.Readings"),
        "contacts": {"type": Field.TYPE_MESSAGE, "type_name": ".mars2d.Contacts"},
        "messages": {"type": Field.TYPE_MESSAGE, "type_name": ".mars2d.Messages"},
        "contents": _many(Field, type=Field.TYPE_STRING),
        "changes": _many(Field, type=Field.TYPE_STRING),
    }
    numbers = _many(Field, type=Field.TYPE_DOUBLE)
    for number, name in enumerate(NAMES, start=1):
        row.field.add(name=name, number=number, **{"label": 1, **special.get(name, numbers)})
    row.field.add(name="crc", number=CRC, type=Field.TYPE_FIXED32, label=1)
    readings = file.message_type.add(name="Readings")
    readings.field.add(name="sensor", number=SENSOR, type=Field.TYPE_STRING, label=1)
    readings.field.add(name="shape", number=SHAPE, **_many(Field, type=Field.TYPE_FIXED32))
    readings.field.add(name="numbers", number=NUMBERS, **numbers)
    readings.field.add(name="flags", number=FLAGS, **_many(Field, type=Field.TYPE_BOOL))
    for title, dtype in (("Contacts", CONTACT), ("Messages", MESSAGE)):
        table = file.message_type.add(name=title)
        for number, name in enumerate(dtype.names or (), start=1):
            kind = kinds[dtype[name].base.kind]
            table.field.add(name=name, number=number, **_many(Field, type=kind))
    return bytes(files.SerializeToString())


def _many(field: Any, **options: Any) -> dict[str, Any]:
    """Return the options of a repeated field."""
    return {"type": field.TYPE_MESSAGE, **options, "label": field.LABEL_REPEATED}
