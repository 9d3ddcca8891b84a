"""Records that can't be saved where they were to be: they are kept somewhere else."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from mars2d.core.errors import InputError
from mars2d.output import formats
from mars2d.record.record import Record

__all__ = ["rescued", "save_or_rescue"]


def save_or_rescue(record: Record, path: Path) -> None:
    """Save a record; where that can't be, keep it elsewhere.

    Raises the InputError that says why and where it is now; its `record` is the record.
    """
    try:
        formats.save(record, path)
    except InputError as error:
        place = rescued(record, path)
        kept = "and nowhere else either" if place is None else f"the record is kept as {place}"
        failure = InputError(f"{error}; {kept}")
        failure.record = record
        raise failure from error


def rescued(record: Record, path: Path) -> Path | None:
    """Save a record under a new name where there is room, and return that; None if there is none.

    path: where it was to be. Only an .npz holds all records, so it becomes one.
    """
    for folder in _folders():
        with suppress(OSError, InputError):
            file, name = tempfile.mkstemp(".npz", f"{path.stem}_", folder)
            os.close(file)
            place = Path(name)
            try:
                return formats.save(record, place)
            except BaseException:
                place.unlink(missing_ok=True)
                raise
    return None


def _folders() -> Iterator[Path]:
    """Yield where there may be room: for temporary files, at home, in memory."""
    with suppress(OSError):  # where nothing can be written there
        yield Path(tempfile.gettempdir())
    with suppress(RuntimeError):  # for somebody without a home
        yield Path.home()
    yield Path("/dev/shm")
