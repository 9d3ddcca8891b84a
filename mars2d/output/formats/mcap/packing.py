"""Complete MCAP files: compressed in chunks, with an index, so that they open at once."""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from itertools import accumulate
from pathlib import Path
from typing import IO, Any

import numpy as np

from mars2d.core.errors import InputError
from mars2d.core.files import atomic_write
from mars2d.output.formats import header as headers
from mars2d.output.formats.mcap.cutting import cut
from mars2d.output.formats.mcap.scanning import CHANNEL, MESSAGE, METADATA, SCHEMA, scan
from mars2d.output.formats.mcap.tape import BEGIN, Tape
from mars2d.output.formats.mcap.topics import nanoseconds
from mars2d.output.formats.mcap.wording import metadata, text
from mars2d.output.formats.size import MOST
from mars2d.record.columns import DiskError
from mars2d.record.message import as_of
from mars2d.record.record import Record

__all__ = ["pack", "write"]

CHUNK = 2**20
"""How much is compressed in one piece, bytes."""

LATEST = 2**64 / 1e9 - 1
"""The times of an MCAP file go up to here, seconds: nanoseconds in 64 bits."""

NEVER = 2**64
"""A row that no run gets to."""


def write(record: Record, path: Path) -> None:
    """Write a record to a file. Raises InputError where it can't be written.

    That is so, too, for what no run gives, as the half of a record: it could not be read again.
    """
    _check_whole(record, path)
    header = headers.of_record(record)
    if len(record):
        header["interventions"] = []  # they come with their rows
    with atomic_write(path) as file:
        writer = _writer(file)
        tape = Tape(writer)
        tape.begin(header, record.scenario, record.sensor_robots)
        for row in cut(record):
            ns = nanoseconds(row.time)
            for channel, data in tape.messages(row, record.scenario_at(row.row)):
                writer.add_message(channel, ns, data, ns, row.row & 0xFFFFFFFF)
        tape.end(record)
        writer.finish()


def _check_whole(record: Record, path: Path) -> None:
    """Refuse a record whose times, or what became of its messages by the end, are of no run."""
    rows = len(record)
    start, end = (float(record.time[0]), float(record.time[-1])) if rows else (0.0, 0.0)
    then = as_of(record.messages, end)
    same = np.array_equal(then["status"], record.messages["status"])
    nothing = len(record.contacts) == len(record.messages) == 0
    done = all(each.row < rows for each in record.interventions)
    if not (same and start >= 0 and end <= LATEST and (nothing if rows == 0 else done)):
        raise InputError(
            f"{path}: can't be written: a log is of a whole run, and this record is not, as if "
            "rows had been cut off: save it as .npz"
        )


def pack(path: Path, header: Mapping[str, Any], begun: Sequence[int]) -> None:
    """Put a log that was written tick by tick into the order in which it is read best.

    header: of the run that it ends with. begun: the rows at which it went on with other worlds;
    rows that were left for them are left out. Raises DiskError, and leaves the file as it is.
    """
    # Of what each world wrote, the rows that no later one began before.
    ends = [*accumulate([NEVER, *begun[:0:-1]], min)][::-1]
    world = -1
    try:
        with path.open("rb") as source, atomic_write(path) as file:
            writer = _writer(file)
            writer.start(profile="", library="mars2d")
            for kind, data in scan(path, source, MOST):
                if kind == SCHEMA:
                    name, at = text(data, 2)
                    encoding, at = text(data, at)
                    writer.register_schema(name, encoding, data[at + 4 :])
                elif kind == CHANNEL:
                    topic, at = text(data, 4)
                    encoding, at = text(data, at)
                    writer.register_channel(topic, encoding, struct.unpack_from("<H", data, 2)[0])
                elif kind == METADATA:
                    name, told = metadata(data)
                    world += name == BEGIN
                    if name != BEGIN:
                        writer.add_metadata(name, told)
                    elif world == 0:
                        writer.add_metadata(BEGIN, {"header": headers.as_text(header), "row": "0"})
                elif kind == MESSAGE:
                    channel, row, time, _ = struct.unpack_from("<HIQQ", data)
                    if row < ends[world]:
                        writer.add_message(channel, time, data[22:], time, row)
            writer.finish()
    except (OSError, MemoryError, InputError) as error:
        reason = error.__cause__ or error
        raise DiskError(f"{path}: complete, but it can't be packed: {reason}") from error


def _writer(file: IO[bytes]) -> Any:
    from mcap.writer import Writer

    return Writer(file, chunk_size=CHUNK)
