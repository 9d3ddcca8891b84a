"""A run that is written down while it goes on, step by step, so that nothing of it can be lost."""

from __future__ import annotations

import os
import struct
from collections.abc import Callable, Sequence
from pathlib import Path
from time import monotonic
from types import TracebackType
from typing import Any, Protocol

import numpy as np

from mars2d.core.errors import InputError
from mars2d.core.files import REPLACED_OPEN, growing
from mars2d.core.interrupt import interrupts
from mars2d.core.scene import Scene
from mars2d.output.formats import header as headers
from mars2d.output.formats.mcap.foxglove import nanoseconds
from mars2d.output.formats.mcap.row import Row, changes_at, cut
from mars2d.output.formats.mcap.writing import Tape, pack, require
from mars2d.record.columns import DiskError, Scratch
from mars2d.record.contact import CONTACT
from mars2d.record.interventions import Intervention
from mars2d.record.message import MESSAGE
from mars2d.record.recorder import Recorder
from mars2d.record.rows import Rows
from mars2d.scenario.scenario import Scenario

OPCODE = 5
"""The kind of an operation that is a message."""

HEAD = struct.Struct("<BQHIQQ")
"""How the operation of a message begins: its kind and length, channel, sequence, two times."""

LENGTH_FROM = 9
"""The length of an operation counts the bytes after its kind and the length itself."""

NO_CONTACTS, NO_MESSAGES = np.empty(0, dtype=CONTACT), np.empty(0, dtype=MESSAGE)

CHECK_EVERY = 1.0
"""The seconds between two checks that the file still has its name."""


class _Operator(Protocol):
    @property
    def log(self) -> Sequence[Intervention]:
        """What was done to the world from outside."""


class Logged(Protocol):
    """The members of a `World` that a log reads."""

    @property
    def filename(self) -> str:
        """The file of the experiment, or ""."""

    @property
    def recorder(self) -> Recorder:
        """What writes the rows."""

    @property
    def record(self) -> Rows:
        """The record so far."""

    @property
    def scenario(self) -> Scenario:
        """The scenario as it is now."""

    @property
    def seed(self) -> int:
        """The seed of the run."""

    @property
    def operator(self) -> _Operator:
        """What acts on the world from outside."""


def newest_row(world: Logged, counts: tuple[int, int, int, int]) -> Row:
    """Return the row of a world that follows those that are known.

    counts: of the rows, contacts, messages and contents that are known.
    """
    recorder = world.recorder
    k, contacts, messages, contents = counts
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
        changes=changes_at(world.operator.log, k),
    )


class Log:
    """Writes the record of a world to an MCAP file, each control step when it is done.

    >>> with Log("run.mcap") as log:  # doctest: +SKIP
    ...     world = World(scenario, control, storage=log.storage)
    ...     while not world.over:
    ...         world.step()
    ...         log.follow(world)

    If the process is killed, the file has all steps that were followed. At the end it is packed:
    compressed, and with an index. storage: keeps the columns of a world in files beside the log, so
    that a long run takes no memory.

    Raises DiskError where the file can't be written any more; the error's `record` has all that was
    recorded, and the file can be read up to the last whole step.
    """

    def __init__(self, path: str | Path) -> None:
        """Open the file. Raises InputError where it can't be written."""
        self.path = Path(path)
        require(self.path)
        from mcap.writer import IndexType, Writer

        if not self.path.parent.is_dir():
            raise InputError(f"{self.path}: there is no folder {self.path.parent}")
        self.storage = Scratch(self.path.parent)
        self._file = _File(self.path)
        # Without indices the writer keeps nothing in memory.
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
        self._world: Logged | None = None
        self._counts = 0, 0, 0, 0  # of the rows, contacts, messages and contents in the file
        self._begun: list[int] = []  # the first row of each world that was followed
        self._open = True

    def follow(self, world: Logged, same: int = 0) -> None:
        """Write the rows that a world has recorded since the last call. Raises DiskError.

        same: if this is another world than before, how many of its rows are the same as that one's.
        """
        with interrupts(held=""):
            self._follow(world, same)

    def _follow(self, world: Logged, same: int = 0) -> None:
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
            self._add(newest_row(world, self._counts), world.scenario)
        self._counts = recorder.counts
        self._do(self._file.take)

    def _begin(self, world: Logged, same: int) -> None:
        """Continue with another world, of which the first `same` rows are written already."""
        self._world, recorder = world, world.recorder
        start = min(same, recorder.rows)
        self._counts = start, 0, 0, 0
        self._begun.append(start)
        empty = Recorder(
            recorder.scenario, versions=recorder.versions, options=recorder.options
        ).record(world.seed, "not over", False, world.filename, Scene())
        robots = recorder.sensor_robots
        self._header = headers.of_record(empty) | {"sensor_robots": robots}
        self._tape.begin(self._header, recorder.scenario, robots, start)

    def _add(self, row: Row, scenario: Scenario) -> None:
        ns, number = nanoseconds(row.time), row.row & 0xFFFFFFFF
        parts: list[bytes] = []
        for channel, data in self._tape.messages(row, scenario):
            length = HEAD.size - LENGTH_FROM + len(data)
            parts += (HEAD.pack(OPCODE, length, channel, number, ns, ns), data)
        self._file.write(b"".join(parts))

    def close(self, record: Rows | None = None) -> None:
        """Write how the run ended, and pack the file. Raises DiskError where that fails.

        record: of the world, if it tells more of the end than the world does.
        """
        if not self._open:
            return
        with interrupts(held=""):  # but not while it is packed: that may take long
            try:
                if self._world is not None:
                    self._follow(self._world)
                    self._tape.end(self._world.record if record is None else record)
                self._writer.finish()
                self._do(self._file.take)
                self._do(self._file.check)
            except BaseException:
                self._shut()
                raise
        try:
            if self._world is not None:
                if not REPLACED_OPEN:
                    self._shut()
                self._do(lambda: pack(self.path, self._header, self._begun, self._file.held))
        finally:
            self._shut()

    def _do(self, act: Callable[[], None]) -> None:
        """Do something with the file. If it fails, close the log and give the error the record."""
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
        self._interrupts = interrupts()
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
            self._interrupts.__exit__(None)


class _File:
    """A file that collects written data, and hands it to the system on request.

    What the system has is kept when the process is killed. Raises DiskError where the file can't be
    written, or where somebody has moved or deleted it; what was there before is kept. It is locked:
    nothing else logs to it meanwhile.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self.held = growing(path, afresh=True)
        self._file = self.held.fileno()
        self._pending = bytearray()
        self._taken = 0
        self._broken = False
        self._checked = monotonic()

    def write(self, data: bytes) -> int:
        """Keep bytes until `take` is called."""
        self._pending += data
        return len(data)

    def tell(self) -> int:
        """Return the number of bytes that were written."""
        return self._taken + len(self._pending)

    def take(self) -> None:
        """Hand over all that was written since the last call, or nothing of it."""
        if monotonic() - self._checked > CHECK_EVERY:
            self.check()
        try:
            if self._broken:  # by Ctrl-C, after a part was written
                os.lseek(self._file, self._taken, os.SEEK_SET)
            self._broken = True
            rest = memoryview(self._pending)
            while rest:
                rest = rest[os.write(self._file, rest) :]
        except OSError as error:
            self._drop()
            raise self._error(error) from error
        self._taken += len(self._pending)
        self._pending = bytearray()
        self._broken = False

    def check(self) -> None:
        """Raise DiskError if the file is no longer there under its name."""
        self._checked = monotonic()
        try:
            there = os.path.samestat(self._path.stat(), os.fstat(self._file))
        except OSError:
            there = False
        if not there:
            self._pending = bytearray()
            raise DiskError(f"{self._path}: it was deleted or moved while it was written")

    def close(self) -> None:
        """Close the file as it is, without the data not handed over yet."""
        self.held.close()

    def _drop(self) -> None:
        """Forget data that could not be written whole."""
        self._pending = bytearray()
        os.ftruncate(self._file, self._taken)

    def _error(self, error: OSError) -> DiskError:
        return DiskError(f"{self._path}: can't be written: {error.strerror or error}")
