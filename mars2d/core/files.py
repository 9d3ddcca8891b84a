"""Files: written so that they appear complete, and the user's files found and noted."""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager, suppress
from contextvars import ContextVar
from io import BufferedRandom
from pathlib import Path
from secrets import token_hex
from typing import BinaryIO

from mars2d.core.errors import InputError, nearest
from mars2d.core.lock import lock

REPLACED_OPEN = sys.platform != "win32"
"""Whether the system lets a file be replaced while it is open."""


DESCRIPTORS = Path("/proc/self/fd")
"""Where Linux has the open files of this process, also those without a name."""


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


def refuse_unwritable(target: Path) -> None:
    """Raise InputError for a file that can't be written."""
    why = why_unwritable(target)
    if why:
        raise InputError(f"{target}: can't be written: {why}")


@contextmanager
def writing(target: Path) -> Iterator[None]:
    """Turn errors of the system while a file is written into one line that names the file."""
    try:
        yield
    except OSError as error:
        raise InputError(f"{target}: can't be written: {error.strerror or error}") from error


@contextmanager
def atomic_write(target: Path, held: BinaryIO | None = None) -> Iterator[BinaryIO]:
    """Open a new file, which takes the place of `target` once everything is written.

    If writing fails, the previous file is left untouched. Its permissions are kept, and a symbolic
    link still points to it. held: the file that is replaced, where the caller has it by `growing`.
    Raises InputError if the file can't be written, for example because the disk is full, or because
    something else is adding to it.
    """
    refuse_unwritable(target)
    with _not_growing(target, held):
        pass  # else it would be known only after all the work
    with writing(target), closing(_Part(Path(os.path.realpath(target)))) as part:
        with part.path.open("r+b") as file:
            yield file
        with _not_growing(target, held):
            part.replace()


@contextmanager
def _not_growing(target: Path, held: BinaryIO | None) -> Iterator[None]:
    """Let nobody begin to add to a file within the block; InputError where somebody does.

    held: the file, if it is the caller who adds to it.
    """
    with ExitStack() as stack:
        if held is None:
            with suppress(OSError):  # there is no such file yet, or it can't be read
                file = stack.enter_context(target.open("rb"))
                lock(file, target, shared=True)
        if not REPLACED_OPEN:
            stack.close()
        yield


class _Part:
    """A file that is being written, beside that of which it takes the place.

    path: where it can be opened, by FFmpeg once more. It gets a name when it is complete. So a
    process that is killed leaves nothing behind, unless the system has no files without names:
    there it has a name that nobody can guess.
    """

    def __init__(self, target: Path) -> None:
        self._target = target
        self._name = target.with_name(f".mars2d-{token_hex(8)}.part")
        self._named = False
        try:
            DESCRIPTORS.stat()
            self.descriptor = os.open(target.parent, os.O_RDWR | os.O_TMPFILE, 0o666)
            self.path = DESCRIPTORS / str(self.descriptor)
        except (AttributeError, OSError):  # not Linux, or not on this file system
            flags = os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
            self.descriptor = os.open(self._name, flags, 0o666)
            self.path, self._named = self._name, True
        self._keep_permissions()

    def _keep_permissions(self) -> None:
        """Take over the owner and the permissions of the file that is to be replaced."""
        with suppress(AttributeError, OSError):  # not on Windows; only root gives files away
            before = self._target.stat()
            with suppress(OSError):
                os.fchown(self.descriptor, before.st_uid, before.st_gid)
            os.fchmod(self.descriptor, stat.S_IMODE(before.st_mode))

    def replace(self) -> None:
        """Take the place of the other file."""
        if not self._named:
            self._named = True
            folder = os.open(DESCRIPTORS, os.O_RDONLY)  # Python follows links from a folder only
            try:
                os.link(self.path.name, self._name, src_dir_fd=folder, follow_symlinks=True)
            finally:
                os.close(folder)
        os.close(self.descriptor)
        self.descriptor = -1
        self._name.replace(self._target)
        self._named = False

    def close(self) -> None:
        """Leave nothing behind."""
        if self.descriptor >= 0:
            os.close(self.descriptor)
        if self._named:
            self._name.unlink(missing_ok=True)


def growing(path: Path, *, afresh: bool = False) -> BufferedRandom:
    """Open a file to which data are added for a long time, and lock it until it is closed.

    It is made if it is not there. afresh: drop what it holds. Raises InputError where it can't be
    written, and where something else is writing to it.
    """
    refuse_unwritable(path)
    flags = os.O_RDWR | os.O_CREAT | (0 if afresh else os.O_APPEND)
    for name in ("O_BINARY", "O_NONBLOCK"):  # on Windows; elsewhere, lest a new pipe hangs it
        flags |= getattr(os, name, 0)
    while True:
        with writing(path):
            file = os.fdopen(os.open(path, flags, 0o666), "w+b" if afresh else "a+b")
        try:
            lock(file, path)
            if _is_at(path, file):
                if afresh:
                    file.truncate(0)
                return file
        except BaseException:
            file.close()
            raise
        file.close()  # it was replaced before it was locked


def _is_at(path: Path, file: BinaryIO) -> bool:
    """Return whether an open file is the one that has this name."""
    try:
        return os.path.samestat(path.stat(), os.fstat(file.fileno()))
    except FileNotFoundError:
        return False


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
        if (folder / path).exists():
            kind = "a folder" if (folder / path).is_dir() else "not a file"
            ends = " or ".join(suffixes)
            raise InputError(f"{path}: {kind}; expected {what}, a file that ends in {ends}")
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
    raise InputError(f"{path}: there is no such file{where}{nearest(path, known, 0.6)}")
