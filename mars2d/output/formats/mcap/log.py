"""A run that is written down while it goes on, step by step, so that nothing of it can be lost."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np

from mars2d.core.errors import InputError
from mars2d.core.files import REPLACED_OPEN, growing
from mars2d.core.interrupt import interrupts
from mars2d.core.scene import Scene
from mars2d.output.formats import header as headers
from mars2d.output.formats.mcap.row import Row, changes_at, cut
from mars2d.output.formats.mcap.writing import Tape, require, write_whole
from mars2d.record.columns import DiskError
from mars2d.record.contact import CONTACT
from mars2d.record.message import MESSAGE
from mars2d.record.recorder import Recorder
from mars2d.record.rows import Rows

NO_CONTACTS, NO_MESSAGES = np.empty(0, dtype=CONTACT), np.empty(0, dtype=MESSAGE)


def newest_row(world: Any, counts: tuple[int, int, int, int]) -> Row:
    """Return the row of a `World` that follows those that are known.

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
        columns=columns | {f"sensor:{name}": values for name, values in readings.items()},
        contacts=recorder.contacts()[contacts:] if now[0] > contacts else NO_CONTACTS,
        messages=sent[messages:],
        contents=texts[contents:],
        changes=changes_at(world.operator.log, k),
    )


class Log:
    """Writes the record of a world to an MCAP file, each control step when it is done.

    >>> with Log("run.mcap") as log:  # doctest: +SKIP
    ...     world = World(scenario, control)
    ...     while not world.over:
    ...         world.step()
    ...         log.follow(world)

    If the process is killed, the file has all steps that were followed. At the end it is packed:
    compressed, and with an index.

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
        self._file = growing(self.path, afresh=True)
        # Without indices the writer keeps nothing in memory.
        self._writer: Any = Writer(
            self._file,
            index_types=IndexType.NONE,
            use_chunking=False,
            use_statistics=False,
            use_summary_offsets=False,
            repeat_channels=False,
            repeat_schemas=False,
        )
        self._tape = Tape(self._writer)
        self._world: Any = None
        self._counts = 0, 0, 0, 0  # of the rows, contacts, messages and contents in the file

    def follow(self, world: Any, same: int = 0) -> None:
        """Write the rows that a `World` has recorded since the last call. Raises DiskError.

        same: if this is another world than before, how many of its rows are the same as that one's.
        """
        if self._file.closed:
            raise DiskError(f"{self.path}: this log is closed")
        with interrupts(held=""), self._written():
            self._follow(world, same)
            self._file.flush()

    def _follow(self, world: Any, same: int = 0) -> None:
        recorder, other = world.recorder, world is not self._world
        if other:
            self._begin(world, same)
        known = self._counts[0]
        if recorder.rows > known + 1 or other:
            record = world.record
            for row in cut(record, known):
                self._tape.add(row, record.scenario_at(row.row))
        elif recorder.rows > known:
            self._tape.add(newest_row(world, self._counts), world.scenario)
        self._counts = recorder.counts

    def _begin(self, world: Any, same: int) -> None:
        """Continue with another world, of which the first `same` rows are written already."""
        self._world, recorder = world, world.recorder
        start = min(same, recorder.rows)
        self._counts = start, 0, 0, 0
        empty = Recorder(
            recorder.scenario, versions=recorder.versions, options=recorder.options
        ).record(world.seed, "not over", False, world.filename, Scene())
        header = headers.of_record(empty) | {"sensor_robots": recorder.sensor_robots}
        self._tape.begin(header, recorder.scenario, start)

    def close(self, record: Rows | None = None) -> None:
        """Write how the run ended, and pack the file. Raises DiskError where that fails.

        record: of the world, if it tells more of the end than the world does.
        """
        if self._file.closed:
            return
        try:
            with interrupts(held=""), self._written():
                if self._world is not None:
                    self._follow(self._world)
                    record = self._world.record if record is None else record
                    self._tape.end(record)
                self._writer.finish()
                self._file.flush()
            if record is not None:  # Ctrl-C is not held: this may take long
                if not REPLACED_OPEN:
                    self._shut()
                with self._written("complete, but it can't be packed"):
                    write_whole(record, self.path)
        finally:
            self._shut()

    @contextmanager
    def _written(self, why: str = "can't be written") -> Iterator[None]:
        """Close the file where something fails; make the system's errors a DiskError."""
        try:
            yield
        except (OSError, MemoryError, InputError) as error:
            self._shut()
            reason = error.__cause__ or error
            text = f"{self.path}: {why}: {getattr(reason, 'strerror', None) or reason}"
            failure = error if isinstance(error, DiskError) else DiskError(text)
            failure.record = None if self._world is None else self._world.record
            raise failure from reason

    def _shut(self) -> None:
        with suppress(OSError):  # what can't be written is lost
            self._file.close()

    def __enter__(self) -> Log:
        self._interrupts = interrupts()
        self._interrupts.__enter__()
        return self

    def __exit__(self, *_: object) -> None:
        try:
            self.close()
        finally:
            self._interrupts.__exit__(None)
