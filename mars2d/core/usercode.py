"""Calls of the user's code: what it raises becomes an error that points at its line."""

from __future__ import annotations

import functools
import inspect
import sysconfig
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from types import TracebackType
from typing import Any

from mars2d.core.errors import InputError, LawError, described, nearest

__all__ = [
    "called",
    "definition",
    "file_beside",
    "files_read",
    "name_of",
    "note_file",
    "users_line",
]

_PACKAGE = Path(__file__).parents[1]
_STANDARD_LIBRARY = Path(sysconfig.get_path("stdlib"))


class called:  # noqa: N801 - used like a function, as contextlib's are
    """Run the user's code so that what it raises becomes a LawError with its file and line.

    At the start, before anything is done, an InputError of one of MARS2D's own parts stays what it
    is: no code of the user's is at fault.
    """

    def __init__(self, name: str, function: Callable[..., Any]) -> None:
        """Take what is called, and by which name messages call it."""
        self._name, self._function = name, function

    def __enter__(self) -> None:
        pass

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        tb: TracebackType | None,
    ) -> None:
        if error is None or not isinstance(error, (Exception, SystemExit)):
            return  # nothing, or Ctrl-C
        where = users_line(traceback.extract_tb(tb)) or definition(self._function)
        if isinstance(error, LawError):
            error.where = error.where or where
            return
        at_start = getattr(self._function, "__name__", "") == "on_start"
        if isinstance(error, InputError) and where is None and at_start:
            return
        wrapped = LawError(f"{self._name} raised {described(error)}")
        wrapped.where = where
        raise wrapped from error


def users_line(stack: traceback.StackSummary) -> str | None:
    """Return the innermost place of a traceback or stack that lies in the user's own code."""
    steps = [step for step in stack if _is_users(Path(step.filename))]
    return _place(steps[-1].filename, steps[-1].lineno or 0) if steps else None


def _is_users(path: Path) -> bool:
    compiled = path.suffix == ".pyx"  # numpy's random generators, say
    others = compiled or _is_ours(path) or path.is_relative_to(_STANDARD_LIBRARY)
    return not (others or "site-packages" in path.parts or str(path).startswith("<"))


def _is_ours(path: Path) -> bool:
    return path.is_relative_to(_PACKAGE) and not path.is_relative_to(_PACKAGE / "examples")


def name_of(function: Callable[..., Any]) -> str:
    """Return the name of a function, also of one in a functools.partial; else that of its class."""
    function = _whole(function)
    return str(getattr(function, "__name__", type(function).__name__))


def _whole(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return the function that a functools.partial calls; any other as it is."""
    while isinstance(function, functools.partial):
        function = function.func
    return function


def definition(function: Callable[..., Any]) -> str | None:
    """Return where a function is defined, if it is Python's and not our own."""
    code = getattr(inspect.unwrap(_whole(function)), "__code__", None)
    if code is None or _is_ours(Path(code.co_filename)):
        return None
    return _place(code.co_filename, code.co_firstlineno)


def _place(filename: str, line: int) -> str:
    return f"{Path(filename).name}, line {line}"


_files: ContextVar[tuple[set[Path], ...]] = ContextVar("files", default=())


@contextmanager
def files_read() -> Iterator[set[Path]]:
    """Collect the user's files, experiments, laws, maps and modules, that are read meanwhile."""
    files: set[Path] = set()
    token = _files.set((*_files.get(), files))
    try:
        yield files
    finally:
        _files.reset(token)


def note_file(path: Path) -> None:
    """Note that a file of the user's is read, for whoever collects these."""
    for files in _files.get():
        files.add(path.absolute())


def file_beside(path: Path, caller: Path | None, what: str, suffixes: Sequence[str]) -> Path:
    """Return the file that lies beside the caller's file, or else in the current folder.

    caller: a file of the user's code, or None. what: what the file is, with its article. suffixes:
    how such files end. Raises InputError, with the nearest name.
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
