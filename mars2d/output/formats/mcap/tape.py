"""What an MCAP file holds of a run, and in which order: by it are logs and records written."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mars2d.core.errors import MissingExtraError
from mars2d.output.formats import header as headers
from mars2d.output.formats.mcap.row import Row, encoded, schema
from mars2d.output.formats.mcap.topics import Topics
from mars2d.record.record import Record
from mars2d.scenario.scenario import Scenario

if TYPE_CHECKING:
    from mcap.writer import Writer

__all__ = ["BEGIN", "END", "TOPIC", "Tape", "require"]

TOPIC = "/mars2d/row"
"""Where the rows are."""

BEGIN, END = "mars2d", "mars2d end"
"""The names of what is said before the first row, and after the last."""


def require(path: Path) -> None:
    """Raise MissingExtraError where a library is missing that a log is written by."""
    try:
        import foxglove_schemas_protobuf  # noqa: F401
        import google.protobuf  # noqa: F401
        import mcap  # noqa: F401
    except ImportError:
        raise MissingExtraError(f'{path}: a log needs mcap: pip install "mars2d[log]"') from None


class Tape:
    """Writes by a writer of MCAP: what a run is, its rows, how it ended.

    A run begins with metadata that hold the header of its record. Each row is one message, which
    has all that the record needs; Foxglove's messages repeat what they show. The end has the
    digest.
    """

    def __init__(self, writer: Writer) -> None:
        self._writer = writer
        self._channels: dict[str, int] = {}
        self._schemas: dict[str, int] = {}
        writer.start(profile="", library="mars2d")
        self._row = self._channel(TOPIC, "mars2d.Row", schema)

    def begin(
        self,
        header: Mapping[str, Any],
        scenario: Scenario,
        sensor_robots: Mapping[str, tuple[int, ...]],
        row: int = 0,
    ) -> None:
        """Say what the rows from `row` on belong to; rows from there on that were before do not."""
        self._writer.add_metadata(BEGIN, {"header": headers.as_text(header), "row": str(row)})
        self._topics = Topics(scenario, sensor_robots, self._foxglove)

    def messages(self, row: Row, scenario: Scenario) -> Iterator[tuple[int, bytes]]:
        """Yield the messages of a row, and of each the channel. scenario: as it is by then."""
        yield from self._topics.messages(row, scenario)
        yield self._row, encoded(row)

    def end(self, record: Record) -> None:
        """Say how the run ended."""
        header = headers.of_record(record)
        told = {name: header[name] for name in ("over_message", "finished", "digest")}
        self._writer.add_metadata(END, {"end": headers.as_text(told), "rows": str(len(record))})

    def _channel(self, topic: str, name: str, schema: Any) -> int:
        if topic not in self._channels:
            if name not in self._schemas:
                added = self._writer.register_schema(name, "protobuf", schema())
                self._schemas[name] = added
            number = self._writer.register_channel(topic, "protobuf", self._schemas[name])
            self._channels[topic] = number
        return self._channels[topic]

    def _foxglove(self, topic: str, kind: Any) -> int:
        descriptor = kind.DESCRIPTOR
        return self._channel(topic, descriptor.full_name, lambda: _files(descriptor.file))


def _files(file: Any) -> bytes:
    """Return the schema in a file of Protocol Buffers, with all that it needs."""
    from google.protobuf.descriptor_pb2 import FileDescriptorSet

    found: dict[str, Any] = {}

    def add(each: Any) -> None:
        if each.name not in found:
            for needed in each.dependencies:
                add(needed)
            found[each.name] = each

    add(file)
    files = FileDescriptorSet()
    for each in found.values():
        each.CopyToProto(files.file.add())
    return bytes(files.SerializeToString())
