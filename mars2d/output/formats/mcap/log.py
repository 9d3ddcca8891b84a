"""A run written down while it goes on, tick by tick, so that nothing of it can be lost."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

import numpy as np

from mars2d.core.errors import InputError
from mars2d.core.interrupt import noted_interrupts, unbroken
from mars2d.core.scene import Scene
from mars2d.output.formats import header as headers
from mars2d.output.formats.mcap.cutting import changes_at, cut
from mars2d.output.formats.mcap.file import File
from mars2d.output.formats.mcap.packing import pack
from mars2d.output.formats.mcap.row import Row
from mars2d.output.formats.mcap.tape import Tape, require
from mars2d.output.formats.mcap.topics import nanoseconds
from mars2d.record.columns import DiskError, Scratch
from mars2d.record.contact import CONTACT
from mars2d.record.message import MESSAGE as MESSAGES
from mars2d.record.record import Record
from mars2d.record.recorder import Recorder
from mars2d.scenario.scenario import Scenario

if TYPE_CHECKING:
    from mars2d.world.world import World

__all__ = ["Log"]

MESSAGE = struct.Struct("<BQHIQQ")
"""How a message begins in MCAP: operation, length, channel, sequence, two times."""

NO_CONTACTS, NO_MESSAGES = np.empty(0, dtype=CONTACT), np.empty(0, dtype=MESSAGES)

OPCODE, HEAD = 5, MESSAGE.size - 9


class Log:
    """Writes what a world records to an MCAP file, each control step when it is done.

    >>> with Log("run.mcap") as log:  # doctest: +SKIP
    ...     world = World(scenario, control, storage=log.storage)
    ...     while not world.over:
    ...         world.step()
    ...         log.follow(world)

    Where the process is killed, the file has all steps that were followed. At the end it is packed:
    compressed, and with an index. storage: keeps the columns of a world beside the file, so that a
    long run takes no memory.

    Raises DiskError, whose `record` has all that was recorded, where the file can't be written any
    more: it stays readable up to the last whole step.
    """

    def __init__(self, path: str | Path) -> None:
        """Open the file. Raises InputError where it can't be written."""
        self.path = Path(path)
        require(self.path)
        from mcap.writer import IndexType, Writer

        if self.path.is_dir():
            raise InputError(f"{self.path}: can't be written: this is a folder")
        if not self.path.parent.is_dir():
            raise InputError(f"{self.path}: there is no folder {self.path.parent}")
        self.storage = Scratch(self.path.parent)
        self._file = File(self.path)
        # Of what it has no index for, a writer remembers nothing.
        writer: Any = Writer(
            self._file,  # type: ignore[arg-type]
            index_types=IndexType.NONE,
            use_chunking=False,
            use_statistics=False,
            use_summary_offsets=False,
            repeat_channels=False,
            repeat_schemas=False,
        )
        self._writer, self._tape = writer, Tape(writer)
        self._world: World | None = None
        self._counts = 0, 0, 0, 0  # of rows, contacts, messages and contents that are written
        self._begun: list[int] = []  # the row at which each world was begun that was followed
        self._open = True

    def follow(self, world: World, same: int = 0) -> None:
        """Write what a world has recorded since it was called last.

        same: of another world than before, how many rows are the same: it goes on from there.
        Raises DiskError.
        """
        with unbroken:
            self._follow(world, same)

    def _follow(self, world: World, same: int = 0) -> None:
        if not self._open:
            raise DiskError(f"{self.path}: this log is closed")
        other = world is not self._world
        if other:
            self._begin(world, same)
        recorder, written = world.recorder, self._counts[0]
        if recorder.rows > written + 1 or other:
            record = world.record
            for row in cut(record, written):
                self._add(row, record.scenario_at(row.row))
        elif recorder.rows > written:
            self._add(self._next(world), world.scenario)
        self._counts = recorder.counts
        self._do(self._file.take)

    def _begin(self, world: World, same: int) -> None:
        """Go on with another world."""
        self._world, recorder = world, world.recorder
        start = min(same, recorder.rows)
        self._counts = start, 0, 0, 0
        self._begun.append(start)
        empty = Recorder(recorder.scenario, versions=recorder.versions).record(
            world.seed, "not over", False, world.filename, Scene()
        )
        robots = recorder.sensor_robots
        self._header = headers.of_record(empty) | {"sensor_robots": robots}
        self._tape.begin(self._header, recorder.scenario, robots, start)

    def _next(self, world: World) -> Row:
        """Return the one row that is new."""
        recorder = world.recorder
        k, contacts, messages, contents = self._counts
        columns, readings = recorder.row(k)
        _, *now = recorder.counts
        talked = now[1:] != [messages, contents]
        sent, texts = recorder.messages() if talked else (NO_MESSAGES, ())
        return Row(
            row=k,
            **columns,
            readings=readings,
            contacts=recorder.contacts()[contacts:] if now[0] > contacts else NO_CONTACTS,
            messages=sent[messages:],
            contents=texts[contents:],
            changes=changes_at(world.hands.log, k),
        )

    def _add(self, row: Row, scenario: Scenario) -> None:
        ns, number = nanoseconds(row.time), row.row & 0xFFFFFFFF
        parts: list[bytes] = []
        for channel, data in self._tape.messages(row, scenario):
            parts += (MESSAGE.pack(OPCODE, HEAD + len(data), channel, number, ns, ns), data)
        self._file.write(b"".join(parts))

    def close(self, record: Record | None = None) -> None:
        """Write how the run ended, and pack the file. Raises DiskError where that can't be.

        record: that of the world, where it tells more of the end than the world does.
        """
        if not self._open:
            return
        with unbroken:  # but packing may take long, and what is not packed is complete
            try:
                if self._world is not None:
                    self._follow(self._world)
                    self._tape.end(self._world.record if record is None else record)
                self._writer.finish()
                self._do(self._file.take)
                self._do(self._file.check)
            finally:
                self._shut()
        if self._world is not None:
            self._do(lambda: pack(self.path, self._header, self._begun))

    def _do(self, act: Callable[[], None]) -> None:
        """Do something with the file; an error has what was recorded, and nothing more is done."""
        try:
            act()
        except InputError as error:
            self._shut()
            error.record = None if self._world is None else self._world.record
            raise

    def _shut(self) -> None:
        if self._open:
            self._open = False
            self._file.close()

    def __enter__(self) -> Log:
        self._interrupts = noted_interrupts()
        self._interrupts.__enter__()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            self.close()
        finally:
            self._interrupts.__exit__()
