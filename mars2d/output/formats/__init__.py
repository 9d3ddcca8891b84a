"""Records as files: one module a format, each reading what it writes, to the last bit."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from mars2d.core.errors import InputError, likely, shown
from mars2d.output.formats.header import reading
from mars2d.output.formats.size import LARGEST, check_limit
from mars2d.record.record import Record

if TYPE_CHECKING:
    from mars2d.output.formats.mcap import Log

__all__ = ["STREAMED", "SUFFIXES", "load", "log_to", "require", "save"]

_MODULES = {".npz": "npz", ".mat": "mat", ".csv": "table", ".nc": "netcdf", ".mcap": "mcap"}

SUFFIXES = tuple(_MODULES)
"""How the names of records may end."""

STREAMED = ".mcap"
"""How that of a record ends which is written while the run goes on."""


def save(record: Record, path: str | Path) -> Path:
    """Write a record in the format that the path's ending names; see `Record.save`."""
    target = _path(path)
    _module(target).write(record, target)
    return target


def load(path: str | Path, largest: float = LARGEST) -> Record:
    """Read a record in the format that the path's ending names; see `mars2d.load`."""
    source = _path(path)
    limit = check_limit(largest)
    with reading(source):
        if source.is_dir():
            raise InputError(f"{source}: a folder; expected a record, as run.npz")
        if not source.exists():
            beside = [str(p) for p in source.parent.glob("*") if p.suffix.lower() in SUFFIXES]
            raise InputError(f"{source}: there is no such file{likely(source, beside)}")
        if not source.is_file():  # but a pipe, say, which may never end
            raise InputError(f"{source}: not a file; expected a record, as run.npz")
    module = _module(source)
    record: Record = module.read(source, limit)
    return record


def log_to(path: Path | None) -> Log | None:
    """Return what writes a record while the run goes on, if that is what the path's ending says.

    Raises InputError where it can't be written, MissingExtraError where a library is missing.
    """
    if path is None or path.suffix.lower() != STREAMED:
        return None
    from mars2d.output.formats.mcap import Log

    return Log(path)


def require(path: Path) -> None:
    """Raise MissingExtraError where a library is missing that a format needs."""
    _module(path).require(path)


def _path(path: str | Path) -> Path:
    if not isinstance(path, (str, Path)) or "\0" in str(path):
        raise InputError(f"path = {shown(path)}: expected the name of a file, as 'run.npz'")
    return Path(path)


def _module(path: Path) -> ModuleType:
    name = _MODULES.get(path.suffix.lower())
    if name is None:
        known = f"{', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]}"
        raise InputError(f"{path}: expected a record: a name that ends in {known}")
    return import_module(f"mars2d.output.formats.{name}")
