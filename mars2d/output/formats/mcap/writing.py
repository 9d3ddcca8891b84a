"""What an MCAP file holds of a run, and whole files: compressed in chunks, with an index."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mars2d.core.extras import extra
from mars2d.core.files import atomic_write
from mars2d.output.formats import header as headers
from mars2d.output.formats.mcap.row import Row, cut, encoded, nanoseconds
from mars2d.record.rows import Rows
from mars2d.scenario.scenario import Scenario

if TYPE_CHECKING:
    from mcap.writer import Writer

TOPIC = "/mars2d/row"
"""The topic of the rows."""

BEGIN, END = "mars2d", "mars2d end"
"""The names of the metadata before the first row, and after the last."""

CHUNK_SIZE = 2**20
"""How much is compressed in one piece, bytes."""


def require(path: Path) -> None:
    """Raise MissingExtraError where a library is missing that a log needs."""
    with extra("log", f"{path}: a log needs mcap"):
        import foxglove  # noqa: F401
        import mcap  # noqa: F401


class Tape:
    """Writes a run with a writer of MCAP: how it began, its rows, how it ended.

    A run begins with metadata that hold the header of its record. Each row is one message, which
    has all that the record needs; Foxglove's messages repeat the parts that it shows. The metadata
    at the end have the digest.
    """

    def __init__(self, writer: Writer) -> None:
        self._writer = writer
        self._channels: dict[str, int] = {}
        self._schemas: dict[str, int] = {}
        writer.start(profile="", library="mars2d")
        self._channels[TOPIC] = writer.register_channel(TOPIC, "mars2d", 0)

    def begin(self, header: Mapping[str, Any], scenario: Scenario, row: int = 0) -> None:
        """Write the header of the rows from `row` on; they replace such rows that were before."""
        from mars2d.output.formats.mcap.foxglove import Topics

        self._writer.add_metadata(BEGIN, {"header": headers.as_text(header), "row": str(row)})
        self._topics = Topics(scenario, header["sensor_robots"])

    def add(self, row: Row, scenario: Scenario) -> None:
        """Write a row. scenario: as it is at that row."""
        ns, number = nanoseconds(row.time), row.row & 0xFFFFFFFF
        for topic, message in self._topics.messages(row, scenario):
            if topic not in self._channels:
                self._open(topic, message.get_schema())
            self._writer.add_message(self._channels[topic], ns, message.encode(), ns, number)
        self._writer.add_message(self._channels[TOPIC], ns, encoded(row), ns, number)

    def end(self, record: Rows) -> None:
        """Write how the run ended."""
        header = headers.of_record(record)
        told = {name: header[name] for name in ("over_message", "finished", "digest")}
        self._writer.add_metadata(END, {"end": headers.as_text(told), "rows": str(len(record))})

    def _open(self, topic: str, schema: Any) -> None:
        name = schema.name
        if name not in self._schemas:
            self._schemas[name] = self._writer.register_schema(name, "protobuf", schema.data)
        number = self._writer.register_channel(topic, "protobuf", self._schemas[name])
        self._channels[topic] = number


def write(record: Rows, path: Path) -> None:
    """Write a record to a file. Raises InputError where it can't be written."""
    require(path)
    write_whole(record, path)


def write_whole(record: Rows, path: Path) -> None:
    """Write the record of a whole run, compressed and with an index."""
    from mcap.writer import Writer

    header = headers.of_record(record)
    if len(record):
        header["interventions"] = []  # they come with their rows
    with atomic_write(path) as file:
        writer: Any = Writer(file, chunk_size=CHUNK_SIZE)
        tape = Tape(writer)
        tape.begin(header, record.scenario)
        for row in cut(record):
            tape.add(row, record.scenario_at(row.row))
        tape.end(record)
        writer.finish()
