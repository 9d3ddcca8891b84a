"""Records as files: one module per format. Exports, for other programs, are not read back."""

from __future__ import annotations

import os
import tempfile
from contextlib import suppress
from importlib import import_module
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mars2d.core.description import real
from mars2d.core.errors import InputError, shown
from mars2d.core.files import file_beside
from mars2d.output.formats.guard import reading
from mars2d.record.rows import Rows

if TYPE_CHECKING:
    from mars2d.output.formats.mcap import Log

__all__ = [
    "EXPORT",
    "FORMATS",
    "SUFFIXES",
    "is_streamed",
    "load",
    "log_to",
    "require",
    "rescued",
    "save",
    "save_branches",
    "save_or_rescue",
]


FORMATS = {
    ".npz": "npz",
    ".csv": "table",
    ".mcap": "mcap",
    ".mat": "mat",
}
"""The modules of this folder by the endings of files.

Each has ``write(record, path)``; if the format is read back, also ``read(path, largest)``; if it
needs an extra, also ``require(path)``, which raises MissingExtraError where a library is missing.
"""

EXPORT = ".mat"
"""The ending of files for other programs, which MARS2D does not read."""

SUFFIXES = tuple(suffix for suffix in FORMATS if suffix != EXPORT)
"""The endings of files that are read back."""


def save(record: Rows, path: str | Path) -> Path:
    """Write a record in the format that the path's ending names; see `Record.save`."""
    target = _path(path)
    _module(target).write(record, target)
    return target


def load(path: str | Path, largest: float) -> Rows:
    """Read a record in the format that the path's ending names; see `mars2d.load`."""
    source = _path(path)
    limit = int(real("largest", largest, "a number of bytes"))
    with reading(source):
        file_beside(source, None, "a record", SUFFIXES)
    module = _module(source)
    if source.suffix.lower() == EXPORT:
        raise InputError(
            f"{source}: an export for other programs; expected a record: {' or '.join(SUFFIXES)}"
        )
    record: Rows = module.read(source, limit)
    return record


def is_streamed(path: Path) -> bool:
    """Return whether the path's ending names a format that is written while the run goes on."""
    return path.suffix.lower() == ".mcap"


def log_to(path: Path | None) -> Log | None:
    """Return a log that writes to the path while the run goes on; None for other formats.

    Raises InputError where it can't be written, MissingExtraError where a library is missing.
    """
    if path is None or not is_streamed(path):
        return None
    log: Log = _module(path).Log(path)
    return log


def require(path: Path) -> None:
    """Raise MissingExtraError where a library is missing that the path's format needs."""
    needs = getattr(_module(path), "require", None)
    if needs is not None:
        needs(path)


def _path(path: str | Path) -> Path:
    if not isinstance(path, (str, Path)):
        raise InputError(f"path = {shown(path)}: expected the name of a file, such as 'run.npz'")
    return Path(path)


def _module(path: Path) -> Any:
    name = FORMATS.get(path.suffix.lower())
    if name is None:
        *others, last = FORMATS
        known = f"{', '.join(others)} or {last}"
        raise InputError(f"{path}: expected a record: a name that ends in {known}")
    return import_module(f"mars2d.output.formats.{name}")


# -- records that can't be saved where they should be -----------------------------------------


def save_or_rescue(record: Rows, path: Path) -> None:
    """Save a record; where that fails, keep it elsewhere.

    Raises InputError, which says why it failed and where the record is now. The error's `record` is
    the record.
    """
    try:
        save(record, path)
    except InputError as error:
        place = rescued(record, path)
        kept = "and nowhere else either" if place is None else f"the record is kept as {place}"
        failure = InputError(f"{error}; {kept}")
        failure.record = record
        raise failure from error


def save_branches(record: Rows, beside: Path) -> list[Path]:
    """Save the branches of a record beside it, under free names; return these."""
    saved = []
    for branch in record.branches:
        names = (beside.with_stem(f"{beside.stem}_branch{k}") for k in count(1))
        saved.append(save(branch, next(name for name in names if not name.exists())))
    return saved


def rescued(record: Rows, path: Path) -> Path | None:
    """Save a record under a new name in the folder for temporary files; None if there is no room.

    path: where it should have been saved. The new file is an .npz, which can hold every record.
    """
    with suppress(OSError, InputError):
        file, name = tempfile.mkstemp(".npz", f"{path.stem[:50]}_")
        os.close(file)
        place = Path(name)
        try:
            return save(record, place)
        except BaseException:
            place.unlink(missing_ok=True)
            raise
    return None
