"""Files: written so that they appear complete, and the user's files found and noted."""

from __future__ import annotations

import os
import shutil
import stat
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from io import BufferedRandom
from pathlib import Path
from secrets import token_hex
from typing import BinaryIO

from mars2d.core.errors import InputError, nearest

REPLACED_OPEN = sys.platform != "win32"
"""Whether the system lets a file be replaced while it is open."""


def why_unwritable(target: Path) -> str:
    """Return why a file can't be written, as far as it can be told before, or an empty text."""
    try:
        mode = target.stat().st_mode
    except FileNotFoundError:
        return ""
    except OSError as error:
        return error.strerror or str(error)
    if stat.S_ISDIR(mode):
        return "this is a folder"
    if not stat.S_ISREG(mode):
        return "this is a pipe or a device; expected a file"
    return "" if os.access(target, os.W_OK) else "it may only be read"


@contextmanager
def writing(target: Path) -> Iterator[None]:
    """Turn errors of the system while a file is written into one line that names the file."""
    try:
        yield
    except OSError as error:
        raise InputError(f"{target}: can't be written: {error.strerror or error}") from error


@contextmanager
def atomic_write(target: Path) -> Iterator[BinaryIO]:
    """Open a new file, which takes the place of `target` once everything is written.

    If writing fails, the previous file is left untouched. Its permissions are kept, and a symbolic
    link still points to it. Raises InputError if the file can't be written, for example because the
    disk is full.
    """
    _refuse_unwritable(target)
    whole = Path(os.path.realpath(target))
    part = whole.with_name(f".mars2d-{token_hex(8)}.part")
    with writing(target):
        try:
            with part.open("x+b") as new:
                yield new
            with suppress(OSError):
                shutil.copymode(whole, part)
            part.replace(whole)
        finally:
            part.unlink(missing_ok=True)


def growing(path: Path, *, afresh: bool = False) -> BufferedRandom:
    """Open a file to which data are added for a long time; it is made if it is not there.

    afresh: drop what it holds. Raises InputError where it can't be written.
    """
    _refuse_unwritable(path)
    with writing(path):
        return path.open("w+b" if afresh else "a+b")


def _refuse_unwritable(target: Path) -> None:
    if why := why_unwritable(target):
        raise InputError(f"{target}: can't be written: {why}")


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
    where, near = "", nearest(path, known, 0.6)
    if not path.is_absolute():
        where = f" beside {caller.name} or in the current folder" if beside and caller else ""
        where += "" if near else f"{'' if where else ' in the current folder'}, {Path.cwd()}"
    raise InputError(f"{path}: there is no such file{where}{near}")
