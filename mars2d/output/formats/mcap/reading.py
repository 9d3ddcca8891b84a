"""Records read from logs, whole or broken off, and from other files that end in .mcap."""

from __future__ import annotations

import json
import struct
from array import array
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError
from mars2d.output.formats import header as headers
from mars2d.output.formats.guard import check_size, reading
from mars2d.output.formats.mcap.row import Row, decoded
from mars2d.output.formats.mcap.scanning import MAGIC, Torn, scan
from mars2d.output.formats.mcap.writing import BEGIN, END, TOPIC, require
from mars2d.record.contact import CONTACT
from mars2d.record.energy import WORK
from mars2d.record.message import MESSAGE as MESSAGES
from mars2d.record.message import as_of
from mars2d.record.rows import Rows

BROKEN_OFF = "The log breaks off here: the run was killed, or still goes on"
"""The `over_message` of a record whose log does not tell how the run ended."""

SIZES = {
    "pose": 3, "command": 2, "prop_pose": 3, "effort": 1, "velocity": 3, "prop_velocity": 3,
    "work": 1,
}  # fmt: skip
"""How many numbers a body, or whatever works on bodies, has in each column."""


def read(path: Path, largest: int) -> Rows:
    """Read the record in a file; InputError where there is none, or it is larger than allowed.

    A log that breaks off anywhere has all rows up to there; its `Record.over_message` says so.
    """
    require(path)
    with reading(path), path.open("rb") as file:
        from mcap.records import Channel, Message, Metadata

        rows, count, size = _Rows(), 0, 0
        header: Any = None
        end: Any = None
        channels: set[int] = set()
        try:
            for told in scan(path, file):
                if isinstance(told, Message):
                    if told.channel_id in channels:
                        size += len(told.data)
                        check_size(path, size, largest)
                        rows.add(decoded(told.data))
                elif isinstance(told, Channel):
                    if told.topic == TOPIC:
                        channels.add(told.id)
                elif isinstance(told, Metadata):
                    if told.name == BEGIN:
                        header = json.loads(told.metadata["header"])
                        headers.check_format(header)
                        headers.check_sums(header, header["format"])
                        rows.cut(int(told.metadata["row"]))
                    elif told.name == END:
                        end, count = json.loads(told.metadata["end"]), int(told.metadata["rows"])
                        headers.check_sums(end, header["format"])
        except Torn:
            if len(rows) < count:
                end = None
        if header is None:
            raise InputError(_why_nothing(path, channels))
        return rows.record(header, end)


def _why_nothing(path: Path, channels: set[int]) -> str:
    """Return why a file holds no run. channels: those for rows in the file."""
    if path.stat().st_size < len(MAGIC):
        return "empty: the run was killed before it began"
    if channels:
        return "holds no rows: the run ended before its first one"
    return "an MCAP file, but not of MARS2D: it has no rows of a run"


class _Rows:
    """The rows of a log while it is read, column by column."""

    def __init__(self) -> None:
        self._count = 0
        self._columns = {name: bytearray() for name in ("time", "command_time", *SIZES)}
        self._sensors: dict[str, tuple[tuple[int, ...], np.dtype[Any], bytearray]] = {}
        self._contacts, self._messages = bytearray(), bytearray()
        self._contents: list[str] = []
        self._changes: list[tuple[int, str]] = []
        # Lists of which a row has any number of items, each with the ends of all rows' items.
        lists: list[Any] = [self._contacts, self._messages, self._contents]
        self._lists = [(array("q"), things) for things in lists]

    def __len__(self) -> int:
        return self._count

    def add(self, row: Row) -> None:
        """Add a row. If there is one of its number already, it replaces that and all later ones."""
        if row.row != self._count:
            self.cut(row.row)
        for name in ("time", "command_time"):
            self._columns[name] += struct.pack("<d", getattr(row, name))
        for name in SIZES:
            values = getattr(row, name)
            if self._count and len(self._columns[name]) != self._count * values.nbytes:
                raise ValueError(name)
            self._columns[name] += values.tobytes()
        self._add_readings(row)
        self._contacts += row.contacts.tobytes()
        self._messages += row.messages.tobytes()
        self._contents += row.contents
        self._changes += [(row.row, change) for change in row.changes]
        for ends, things in self._lists:
            ends.append(len(things))
        self._count += 1

    def _add_readings(self, row: Row) -> None:
        if self._count == 0:
            self._sensors = {
                name: (values.shape, values.dtype, bytearray())
                for name, values in row.readings.items()
            }
        if row.readings.keys() != self._sensors.keys():
            raise ValueError("sensors")
        for name, values in row.readings.items():
            shape, dtype, data = self._sensors[name]
            if (values.shape, values.dtype) != (shape, dtype):
                raise ValueError(name)
            data += values.tobytes()

    def cut(self, count: int) -> None:
        """Drop all rows from `count` on. Raises ValueError where there are fewer."""
        if not 0 <= count <= self._count:
            raise ValueError("a row that does not follow the one before")
        columns = [*self._columns.values(), *(data for _, _, data in self._sensors.values())]
        for data in columns if self._count else ():
            del data[len(data) // self._count * count :]
        for ends, things in self._lists:
            del things[ends[count - 1] if count else 0 :]
            del ends[count:]
        self._changes = [each for each in self._changes if each[0] < count]
        self._count = count

    def record(self, header: dict[str, Any], end: dict[str, Any] | None) -> Rows:
        """Return the record. Raises the exceptions of `headers.to_record`.

        end: how the run ended, None where the log does not tell.
        """
        changes = [json.loads(text) for _, text in self._changes]
        robots = header["sensor_robots"]
        whole = header | {
            "interventions": [*header["interventions"], *changes],
            "messages": bool(self._contents),
            "sensor_robots": {name: robots[name] for name in robots if name in self._sensors},
        }
        whole |= end or {"over_message": BROKEN_OFF, "finished": False}
        return headers.to_record(whole, self._all(header), torn=end is None)

    def _all(self, header: dict[str, Any]) -> dict[str, NDArray[Any]]:
        """Return the columns as `Record.columns` does."""
        n, scenario = self._count, header["scenario"]
        robots, props = len(scenario["robots"]), len(scenario.get("props", ()))
        columns = {name: np.frombuffer(self._columns[name]) for name in headers.columns_in(header)}
        for name, numbers in SIZES.items():
            if name not in columns:
                continue
            bodies = props if name.startswith("prop_") else robots
            bodies = len(WORK) if name == "work" else bodies
            shape = (n, bodies) if numbers == 1 else (n, numbers, bodies)
            columns[name] = columns[name].reshape(shape)
        for name, (reading_shape, dtype, data) in self._sensors.items():
            columns[f"sensor:{name}"] = np.frombuffer(data, dtype).reshape(n, *reading_shape)
        contacts = np.frombuffer(self._contacts, CONTACT)
        columns |= {f"contact:{name}": contacts[name] for name in CONTACT.names or ()}
        now = columns["time"][-1] if n else 0.0
        messages = as_of(np.frombuffer(self._messages, MESSAGES), now)
        columns |= {f"message:{name}": messages[name] for name in MESSAGES.names or ()}
        texts = [text.encode() for text in self._contents]
        columns["contents"] = np.frombuffer(b"".join(texts), dtype=np.uint8)
        columns["content_sizes"] = np.array([len(text) for text in texts], dtype=np.int64)
        return columns
