"""Files: written so that they appear complete, and the user's files found and noted."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import BinaryIO

from mars2d.core.errors import InputError, nearest

__all__ = ["atomic_write", "file_beside", "files_read", "note_file"]


@contextmanager
def atomic_write(target: Path) -> Iterator[BinaryIO]:
    """Open a temporary file beside `target`, which replaces it once everything is written.

    If writing fails, the previous file is left untouched. Raises InputError if the file can't be
    written, for example because the disk is full.
    """
    if target.is_dir():
        raise InputError(f"{target}: can't be written: this is a folder")
    if target.exists() and not os.access(target, os.W_OK):
        raise InputError(f"{target}: can't be written: it may only be read")
    part = target.with_name(f".{target.name}.part")
    try:
        try:
            with part.open("w+b") as file:
                yield file
            part.replace(target)
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        raise InputError(f"{target}: can't be written: {error.strerror or error}") from error


_files: ContextVar[tuple[set[Path], ...]] = ContextVar("files", default=())


@contextmanager
def files_read() -> Iterator[set[Path]]:
    """Collect the user's files that are read within the block: experiments, laws, maps, modules."""
    files: set[Path] = set()
    token = _files.set((*_files.get(), files))
    try:
        yield files
    finally:
        _files.reset(token)


def note_file(path: Path) -> None:
    """Add a file to those that each enclosing `files_read` collects."""
    for files in _files.get():
        files.add(path.absolute())


def file_beside(path: Path, caller: Path | None, what: str, suffixes: Sequence[str]) -> Path:
    """Return the path of a file beside the caller's file or, failing that, in the current folder.

    caller: a file of the user's code, or None. what: a description of the file for messages, with
    its article. suffixes: the suffixes of such files, used to suggest a name. Raises InputError,
    with the nearest name, if there is no such file.
    """
    beside = [caller.parent] if caller is not None and caller.is_file() else []  # or a notebook
    folders = [*beside, Path()]
    for folder in folders:
        if (folder / path).is_file():
            note_file(folder / path)
            return folder / path
        if (folder / path).is_dir():
            ends = " or ".join(suffixes)
            raise InputError(f"{path}: a folder; expected {what}, a file that ends in {ends}")
    known = {
        str(path.parent / file.name)
        for folder in folders
        if (folder / path).parent.is_dir()
        for file in (folder / path).parent.iterdir()
        if file.suffix.lower() in suffixes
    }
    where = ""
    if beside and caller is not None and not path.is_absolute():
        where = f" beside {caller.name} or in the current folder"
    raise InputError(f"{path}: there is no such file{where}{nearest(path, known)}")
