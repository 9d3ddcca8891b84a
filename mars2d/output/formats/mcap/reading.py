"""Records read from logs, whole or broken off, and from other files that end in .mcap."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

import numpy as np

from mars2d.core.errors import InputError
from mars2d.output.formats import header as headers
from mars2d.output.formats.guard import check_size, reading
from mars2d.output.formats.mcap.row import decoded
from mars2d.output.formats.mcap.writing import BEGIN, END, TOPIC, require
from mars2d.record.contact import CONTACT
from mars2d.record.message import MESSAGE, as_of, packed
from mars2d.record.rows import Rows, shapes_of

MAGIC = b"\x89MCAP0\r\n"

BROKEN_OFF = "The log breaks off here: the run was killed, or still goes on"
"""The `over_message` of a record whose log does not tell how the run ended."""


def read(path: Path, largest: int) -> Rows:
    """Read the record in a file; InputError where there is none, or it is larger than allowed.

    A log that breaks off anywhere has all rows up to there; its `Record.over_message` says so.
    """
    require(path)
    with reading(path), path.open("rb") as file:
        from mcap.records import Channel, Message, Metadata

        rows: list[bytes] = []
        count, size = 0, 0
        header: Any = None
        end: Any = None
        channels: set[int] = set()
        for told in records(path, file):
            if isinstance(told, Message) and told.channel_id in channels:
                size += len(told.data)
                check_size(path, size, largest)
                _cut(rows, told.sequence)
                rows.append(told.data)
            elif isinstance(told, Channel) and told.topic == TOPIC:
                channels.add(told.id)
            elif isinstance(told, Metadata) and told.name == BEGIN:
                header = headers.of_text(told.metadata["header"])
                _cut(rows, int(told.metadata["row"]))
            elif isinstance(told, Metadata) and told.name == END:
                end, count = json.loads(told.metadata["end"]), int(told.metadata["rows"])
                headers.check_sums(end)
        if header is None:
            if channels or path.stat().st_size < len(MAGIC):
                raise InputError("holds no rows: the run ended before its first one")
            raise InputError("an MCAP file, but not of MARS2D: it has no rows of a run")
        return _record(rows, header, end if len(rows) == count else None)


def records(path: Path, file: IO[bytes]) -> Iterator[Any]:
    """Yield the records of the library `mcap`, up to the end of the data or where the file ends.

    Raises InputError for another kind of file, and the library's errors where it is damaged.
    """
    from mcap.exceptions import EndOfFile, RecordLengthLimitExceeded
    from mcap.records import DataEnd
    from mcap.stream_reader import StreamReader

    class Whole:
        """A file that reads all bytes that are asked for; the library takes fewer."""

        def read(self, size: int) -> bytes:
            data = file.read(size)
            if len(data) < size:
                raise EndOfFile
            return data

    if not MAGIC.startswith(file.read(len(MAGIC))):
        raise InputError(f"{path}: this is no MCAP file")
    whole: Any = Whole()
    size = path.stat().st_size  # a record that claims to be longer breaks off
    reader = StreamReader(whole, skip_magic=True, validate_crcs=True, record_size_limit=size)
    try:
        for record in reader.records:
            if isinstance(record, DataEnd):
                return
            yield record
    except (EndOfFile, RecordLengthLimitExceeded):
        return


def _cut(rows: list[bytes], count: int) -> None:
    """Drop all rows from `count` on. Raises ValueError where there are fewer."""
    if count > len(rows):
        raise ValueError("a row that does not follow the one before")
    del rows[count:]


def _record(rows: list[bytes], header: dict[str, Any], end: dict[str, Any] | None) -> Rows:
    """Return the record of encoded rows. Raises the exceptions of `headers.to_record`.

    end: how the run ended, None where the log does not tell.
    """
    decoded_rows = [decoded(data) for data in rows]
    if [row.row for row in decoded_rows] != list(range(len(rows))):
        raise ValueError("rows")
    if rows:
        names = decoded_rows[0].columns
        columns = {name: np.stack([row.columns[name] for row in decoded_rows]) for name in names}
    else:
        robots, props = (len(header["scenario"].get(kind, ())) for kind in ("robots", "props"))
        columns = {name: np.empty((0, *s)) for name, s in shapes_of(robots, props, 2).items()}
    contacts = [np.empty(0, CONTACT), *(row.contacts for row in decoded_rows)]
    messages = [np.empty(0, MESSAGE), *(row.messages for row in decoded_rows)]
    contents = [text for row in decoded_rows for text in row.contents]
    changes = [json.loads(change) for row in decoded_rows for change in row.changes]
    touched = np.concatenate(contacts)
    columns |= {f"contact:{name}": touched[name] for name in CONTACT.names or ()}
    if contents:
        sent = as_of(np.concatenate(messages), columns["time"][-1])
        columns |= {f"message:{name}": sent[name] for name in MESSAGE.names or ()}
        columns |= packed(contents)
    carried = header["sensor_robots"]
    whole = header | {
        "interventions": [*header["interventions"], *changes],
        "sensor_robots": {name: carried[name] for name in carried if f"sensor:{name}" in columns},
    }
    whole |= end or {"over_message": BROKEN_OFF, "finished": False}
    return headers.to_record(whole, columns, torn=end is None)
