"""Results on disk: a study's table as a .csv file, which grows row by row while it runs.

Columns: ``row``, ``experiment``, the settings, ``seed``, the measures, ``digest``, ``code``,
``error``; see RFC 4180. A row is written as soon as its run is done, and the file is put in order
when all are. Where a process was killed in the middle of a line, that line is left out.
"""

from __future__ import annotations

import csv
import io
import os
import sys
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import BinaryIO

from mars2d.core.errors import InputError, shown
from mars2d.core.files import atomic_write
from mars2d.study.plan import cell, value_in, word_cell, word_in
from mars2d.study.table import Result, Table

__all__ = [
    "FIRST",
    "LAST",
    "SEED",
    "Results",
    "another",
    "is_table",
    "load_table",
    "lock",
    "save_table",
]

FIRST, SEED, LAST = ("row", "experiment"), "seed", ("digest", "code", "error")
"""The columns that each table has: the settings stand before the seed, the measures after it."""

END = "\r\n"

LOCK_AT = 2**40
"""The byte that is locked where a system locks bytes: far behind all that anybody reads."""


class Results:
    """A study's file, open to be written by this process alone; `known` is what it held.

    The columns are those of `blank`, a table without rows. Raises InputError where the file is of
    other columns or another experiment, where another process writes to it, or where it can't be
    written.
    """

    def __init__(self, path: Path, blank: Table) -> None:
        self._path, self._blank = path, blank
        self.known: tuple[Result, ...] = ()

    def __enter__(self) -> Results:
        if self._path.exists() and not self._path.is_file():
            raise InputError(f"{self._path}: expected a file; this is a device or a folder")
        try:
            self._file: BinaryIO = self._path.open("a+b")
        except OSError as error:
            raise _unwritable(self._path, error) from error
        try:
            lock(self._file, self._path)
            self._resume()
        except BaseException:
            self._file.close()
            raise
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        tb: TracebackType | None,
    ) -> None:
        with suppress(OSError):  # a full disk, of which `add` has told already
            self._file.close()

    def add(self, result: Result) -> None:
        """Write one row, which is in the system's hands when this returns."""
        self._write(_line(_cells(self._blank, result)))

    def _resume(self) -> None:
        """Read what is there; what is no whole line is taken away, and the header added."""
        self._file.seek(0)
        data = self._file.read()
        whole = data[: data.rfind(b"\n") + 1]
        if len(whole) < len(data):
            self._file.truncate(len(whole))
        if not whole:
            self._write(_line(_header(self._blank)))
            return
        there = _parse(whole, self._path)
        _refuse_another(there, self._blank, self._path)
        self.known = there.results

    def _write(self, line: str) -> None:
        try:
            self._file.write(_bytes(line))
            self._file.flush()
        except OSError as error:
            raise _unwritable(self._path, error) from error


def _refuse_another(there: Table, wanted: Table, path: Path) -> None:
    """Raise InputError, which says what differs, unless both tables are of the same study."""
    pairs = {
        "settings": (", ".join(there.settings), ", ".join(wanted.settings)),
        "measures": (", ".join(there.measures), ", ".join(wanted.measures)),
    }
    if there.results:
        pairs = {"experiment": (there.experiment, wanted.experiment)} | pairs
    for what, (old, new) in pairs.items():
        if old != new:
            raise another(path, f"its {what}: {old or 'none'}; now: {new or 'none'}")


def another(path: Path, why: str) -> InputError:
    """Return the error that says: the file there is of another study, and what to do."""
    return InputError(f"{path}: holds another study; {why}. Give another --out, or delete it")


# -- whole files -----------------------------------------------------------------------------------


def save_table(table: Table, path: str | Path) -> Path:
    """Write a table as a file at once, and return its path."""
    target = Path(path)
    if target.suffix.lower() != ".csv":
        raise InputError(f"{target}: expected a name that ends in .csv")
    lines = [_line(_header(table)), *(_line(_cells(table, result)) for result in table.results)]
    with atomic_write(target) as file:
        file.write(_bytes("".join(lines)))
    return target


def load_table(path: str | Path) -> Table:
    """Return the table in a file that a study wrote, its rows by their numbers.

    Raises InputError where it is none. A line that was broken off is left out.
    """
    source = Path(path)
    try:
        data = source.read_bytes()
    except OSError as error:
        raise InputError(f"{source}: can't be read: {error.strerror or error}") from error
    return _parse(data[: data.rfind(b"\n") + 1], source)


def is_table(path: Path) -> bool:
    """Return whether a file begins as the table of a study does."""
    with path.open("rb") as file:
        return file.read(200).decode("utf-8-sig", "replace").startswith(",".join(FIRST) + ",")


def _parse(data: bytes, path: Path) -> Table:
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: expected a table in UTF-8; {error.reason}") from error
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    try:
        header = next(reader, [])
        settings, measures = _columns(header, path)
        results: list[Result] = []
        experiment = ""
        for cells in reader:
            if not cells:
                continue
            if len(cells) != len(header):
                fields = f"{len(cells)} cells, expected {len(header)}"
                raise InputError(f"{path}, line {reader.line_num}: {fields}")
            if experiment and cells[1] != experiment:
                raise InputError(
                    f"{path}, line {reader.line_num}: experiment {shown(cells[1])}, where the rows "
                    f"before have {shown(experiment)}"
                )
            experiment = cells[1]
            results.append(_result(cells, settings, measures, f"{path}, line {reader.line_num}"))
    except csv.Error as error:
        raise InputError(f"{path}, line {reader.line_num}: {error}") from error
    results.sort(key=lambda result: result.row)
    return Table(experiment, settings, measures, tuple(results))


def _columns(header: list[str], path: Path) -> tuple[tuple[str, ...], tuple[str, ...]]:
    ends = tuple(header[:2]), tuple(header[-3:])
    if ends != (FIRST, LAST) or header.count(SEED) != 1:
        expected = f"{', '.join(FIRST)}, settings, seed, measures, {', '.join(LAST)}"
        found = f"; it begins with {shown(','.join(header))}" if header else "; it is empty"
        raise InputError(f"{path}: is no table of a study: expected columns {expected}{found}")
    at = header.index(SEED)
    return tuple(header[2:at]), tuple(header[at + 1 : -3])


def _result(
    cells: list[str], settings: tuple[str, ...], measures: tuple[str, ...], where: str
) -> Result:
    row = _number(cells[0], "row", where)
    seed = _number(cells[2 + len(settings)], SEED, where)
    values = cells[2 : 2 + len(settings)]
    found = cells[3 + len(settings) : -3]
    digest, code, error = cells[-3:]
    return Result(
        row,
        {name: value_in(text) for name, text in zip(settings, values, strict=True)},
        seed,
        {name: _measured(text) for name, text in zip(measures, found, strict=True)},
        word_in(error),
        digest,
        code,
    )


def _number(text: str, name: str, where: str) -> int:
    if not text.isdecimal():
        raise InputError(f"{where}: {name} = {shown(text)}: expected a whole number")
    return int(text)


def _measured(text: str) -> float | str | None:
    if not text:
        return None
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return word_in(text)


# -- lines -----------------------------------------------------------------------------------------


def _header(table: Table) -> list[str]:
    return [*FIRST, *table.settings, SEED, *table.measures, *LAST]


def _cells(table: Table, result: Result) -> list[str]:
    measured = (result.measures.get(name) for name in table.measures)
    return [
        str(result.row),
        table.experiment,
        *(cell(result.options[name]) for name in table.settings),
        str(result.seed),
        *(_measure(value) for value in measured),
        result.digest,
        result.code,
        word_cell(" ".join(result.error.split())),
    ]


def _measure(value: float | str | None) -> str:
    if isinstance(value, str):
        return word_cell(value)
    return "" if value is None else str(value)


def _line(cells: Iterable[str]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator=END).writerow(cells)
    return text.getvalue()


def _bytes(text: str) -> bytes:
    return text.encode(errors="backslashreplace")  # a file's name may hold what is no letter


def _unwritable(path: Path, error: OSError) -> InputError:
    return InputError(f"{path}: can't be written: {error.strerror or error}")


def lock(file: BinaryIO, path: Path) -> None:
    """Take a file for this process until it is closed, by whatever end the process comes to.

    Raises InputError where another process has it. A file system that knows no locks has none.
    """
    try:
        if sys.platform == "win32":
            import msvcrt

            os.lseek(file.fileno(), LOCK_AT, os.SEEK_SET)
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (BlockingIOError, PermissionError):
        raise InputError(
            f"{path}: another process is writing to it: wait for its end, or give another --out"
        ) from None
    except OSError:
        return
