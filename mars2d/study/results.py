"""The file of a study that is running: a .csv table that grows by a row whenever a run is done.

The rows are in the order in which runs end; the whole file is put in order when all are done. If a
process is killed in the middle of a line, that line is left out.
"""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from mars2d.core.errors import InputError
from mars2d.core.files import REPLACED_OPEN, growing, writing
from mars2d.study.table import Result, Table, file_header, file_line, parse_table, save_table


class AnotherStudyError(InputError):
    """A file holds the rows of another study."""


class Results:
    """A study's file, open for writing by this process alone; `known` holds the rows it had.

    The columns are those of `blank`, a table without rows. Raises InputError if the file has other
    columns or another experiment, if another process writes to it, or if it can't be written.
    """

    def __init__(self, path: Path, blank: Table) -> None:
        self._path, self._blank = path, blank
        self.known: tuple[Result, ...] = ()

    def __enter__(self) -> Results:
        self._file = growing(self._path)
        try:
            self._resume()
        except BaseException:
            self._file.close()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        with suppress(OSError):  # a full disk, which `add` has reported already
            self._file.close()

    def add(self, result: Result) -> None:
        """Write one row, and hand it to the operating system before returning."""
        self._write(file_line(self._blank, result))

    def put_in_order(self, table: Table) -> None:
        """Replace the file by a whole table; nothing can be added afterwards."""
        if not REPLACED_OPEN:
            self._file.close()
        save_table(table, self._path, self._file)

    def _resume(self) -> None:
        """Read the rows; cut off an incomplete line, and begin an empty file with the header."""
        self._file.seek(0)
        data = self._file.read()
        whole = data[: data.rfind(b"\n") + 1]
        if len(whole) < len(data):
            self._file.truncate(len(whole))
        if not whole:
            self._write(file_header(self._blank))
            return
        there = parse_table(whole, self._path)
        _refuse_another(there, self._blank, self._path)
        self.known = there.results

    def _write(self, line: bytes) -> None:
        with writing(self._path):
            self._file.write(line)
            self._file.flush()


def _refuse_another(there: Table, wanted: Table, path: Path) -> None:
    """Raise InputError, which names the difference, unless both tables are of the same study."""
    pairs = {
        "settings": (", ".join(there.settings), ", ".join(wanted.settings)),
        "measures": (", ".join(there.measures), ", ".join(wanted.measures)),
    }
    if there.results:
        pairs = {"experiment": (there.experiment, wanted.experiment)} | pairs
    for what, (old, new) in pairs.items():
        if old != new:
            raise another(path, f"its {what}: {old or 'none'}; now: {new or 'none'}")


def another(path: Path, why: str) -> AnotherStudyError:
    """Return the error for a file that holds another study."""
    said = f"{path}: holds another study; {why}. Give another --out, or delete it"
    return AnotherStudyError(said)
