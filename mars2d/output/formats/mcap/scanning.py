"""The operations in an MCAP file, read one after the other up to where the file breaks off.

The library's own readers take as much memory as a file claims, and stop at a chunk that is cut off.
Here memory is taken for bytes that are there. Source: MCAP Format Specification, version 0.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import IO, Any, NamedTuple, Protocol
from zlib import crc32

from mars2d.core.errors import InputError
from mars2d.core.extras import extra
from mars2d.output.formats.guard import check_size

MAGIC = b"\x89MCAP0\r\n"

SCHEMA, CHANNEL, MESSAGE, CHUNK, METADATA, DATA_END = 3, 4, 5, 6, 12, 15

MESSAGE_HEAD = struct.Struct("<HIQQ")
"""How a message begins: channel, sequence, two times."""

SKIP_SIZE = 2**16
"""How much is read at once of a part that is passed over, bytes."""

SHARE = 16
"""How many times as large as the data that are read all chunks may be: the rest is Foxglove's."""


class Torn(Exception):  # noqa: N818
    """The file breaks off."""


class Operation(NamedTuple):
    """One operation: its kind, and its bytes."""

    kind: int
    data: bytes


def parsed(operation: Operation) -> Any:
    """Return a schema, a channel or metadata as the record of the library `mcap`."""
    from mcap import records
    from mcap.data_stream import ReadDataStream

    stream = ReadDataStream(BytesIO(operation.data))
    kinds: dict[int, Any] = {
        SCHEMA: records.Schema,
        CHANNEL: records.Channel,
        METADATA: records.Metadata,
    }
    return kinds[operation.kind].read(stream)


class _Source(Protocol):
    def read(self, size: int, /) -> bytes:
        """Return some bytes, fewer at the end."""


class _Reader:
    """Reads just as many bytes as asked for, or raises Torn.

    left: how many bytes there should be. crc: the check sum of those that were read.
    """

    def __init__(self, source: _Source, left: int) -> None:
        self._source, self.left = source, left
        self.crc = 0

    def read(self, size: int) -> bytes:
        if size > self.left:
            raise Torn
        parts, wanted = [], size
        while wanted:
            piece = self._source.read(min(wanted, 2**20))
            if not piece:
                raise Torn
            parts.append(piece)
            wanted -= len(piece)
        self.left -= size
        data = b"".join(parts)
        self.crc = crc32(data, self.crc)
        return data

    def skip(self, size: int) -> None:
        while size:
            size -= len(self.read(min(size, SKIP_SIZE)))


def scan(
    path: Path, file: IO[bytes], largest: int, channels: set[int] | None = None
) -> Iterator[Operation]:
    """Yield the operations up to the end of the data: schemas, channels, messages, metadata.

    largest: the most data that are read, bytes. channels: whose messages are yielded, by default
    all; the caller may add to them meanwhile. Raises Torn where the file breaks off, InputError
    where it holds too much, ValueError where it is damaged.
    """
    size = path.stat().st_size
    reader = _Reader(file, size)
    head = reader.read(min(size, len(MAGIC)))
    if not MAGIC.startswith(head):
        raise InputError(f"{path}: this is no MCAP file")
    if head != MAGIC:
        raise Torn
    budget = _Budget(path, largest)
    yield from _operations(reader, budget, channels)


class _Budget:
    """Adds up how much is read, and refuses more than allowed."""

    def __init__(self, path: Path, largest: int) -> None:
        self._path, self._largest = path, largest
        self._read = self._unpacked = 0

    def read(self, size: int) -> None:
        self._read += size
        check_size(self._path, self._read, self._largest)

    def unpack(self, size: int) -> None:
        check_size(self._path, size, self._largest)
        self._unpacked += size
        check_size(self._path, self._unpacked // SHARE, self._largest)


def _operations(reader: _Reader, budget: _Budget, channels: set[int] | None) -> Iterator[Operation]:
    while reader.left:
        kind, size = struct.unpack("<BQ", reader.read(9))
        if size > reader.left:
            raise Torn
        if kind == DATA_END:
            return
        if kind == CHUNK:
            yield from _chunk(reader, size, budget, channels)
        elif kind == MESSAGE:
            head = reader.read(2)
            if channels is None or int.from_bytes(head, "little") in channels:
                budget.read(size)
                yield Operation(kind, head + reader.read(size - 2))
            else:
                reader.skip(size - 2)
        elif kind in (SCHEMA, CHANNEL, METADATA):
            budget.read(size)
            yield Operation(kind, reader.read(size))
        else:
            reader.skip(size)
    raise Torn


def _chunk(
    reader: _Reader, size: int, budget: _Budget, channels: set[int] | None
) -> Iterator[Operation]:
    """Yield the operations in a chunk, unpacking it as it is read."""
    before = reader.left
    _, _, unpacked, crc, named = struct.unpack("<QQQII", reader.read(32))
    kind = str(reader.read(named), "ascii")
    (packed,) = struct.unpack("<Q", reader.read(8))
    if before - reader.left + packed != size:
        raise ValueError("the sizes of a chunk")
    budget.unpack(unpacked)
    part = _Part(reader, packed)
    inner = _Reader(_unpacker(kind, part), unpacked)
    try:
        yield from _whole(inner, budget, channels)
    except Torn:
        raise ValueError("a chunk that holds less than it claims") from None
    if crc and inner.crc != crc:
        raise ValueError("check sum of a chunk")
    reader.skip(part.left)


def _whole(reader: _Reader, budget: _Budget, channels: set[int] | None) -> Iterator[Operation]:
    """Yield the operations in a chunk, which just ends."""
    try:
        yield from _operations(reader, budget, channels)
    except Torn:
        if reader.left:
            raise


class _Part:
    """The next bytes of a reader, as a file."""

    def __init__(self, reader: _Reader, size: int) -> None:
        self._reader, self.left = reader, size

    def read(self, size: int = -1, /) -> bytes:
        size = self.left if size < 0 else min(size, self.left)
        self.left -= size
        return self._reader.read(size)


def _unpacker(kind: str, part: _Part) -> _Source:
    if kind == "":
        return part
    if kind != "zstd":
        raise InputError(f"its chunks are compressed by {kind!r}; expected zstd, or none")
    with extra("log", "a packed log needs zstandard"):
        import zstandard
    unpacker: Any = zstandard.ZstdDecompressor(max_window_size=2**27)
    source: _Source = unpacker.stream_reader(part)
    return source
