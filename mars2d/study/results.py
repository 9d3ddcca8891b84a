"""The rows of a study that is running, and its file: a .csv table that grows row by row.

The rows are in the order in which runs end; the whole file is put in order when all are done. If a
process is killed in the middle of a line, that line is left out.
"""

from __future__ import annotations

import dataclasses
from contextlib import suppress
from pathlib import Path

from mars2d.core.errors import InputError, Mars2dError, nearest
from mars2d.core.files import REPLACED_OPEN, growing, writing
from mars2d.study.job import code_of, opened
from mars2d.study.kept import kept_as
from mars2d.study.study import Study
from mars2d.study.table import Result, Table, cell, cells_of, file_header, file_line, parse_table


class Results:
    """The rows of a study by number, and their file, open for writing.

    `rows` are at first those of the file, with their numbers in this study. path: of the file, or
    None. retry: leave out rows with an error. Raises InputError if the file holds another study, or
    if it can't be written.
    """

    def __init__(self, study: Study, path: Path | None, *, retry: bool = False) -> None:
        self._study, self._path, self._retry = study, path, retry
        settings, measures = tuple(study.plan.settings), study.measures
        self._blank = Table(study.title, settings, measures, ())
        self.rows: dict[int, Result] = {}

    def __enter__(self) -> Results:
        if self._path is not None:
            self._file = growing(self._path)
            try:
                self._resume(self._path)
            except BaseException:
                self._file.close()
                raise
        return self

    def __exit__(self, *_: object) -> None:
        if self._path is not None:
            with suppress(OSError):  # a full disk, which `add` has reported already
                self._file.close()

    def table(self) -> Table:
        """Return the rows in order."""
        results = tuple(result for _, result in sorted(self.rows.items()))
        return dataclasses.replace(self._blank, results=results)

    def add(self, result: Result) -> None:
        """Add a row; it is handed to the operating system before this returns."""
        self.rows[result.row] = result
        if self._path is not None:
            self._write(self._path, file_line(self._blank, result))

    def put_in_order(self) -> None:
        """Replace the file by the whole table; nothing can be added afterwards."""
        if self._path is not None:
            if not REPLACED_OPEN:
                self._file.close()
            self.table().save(self._path)

    def _write(self, path: Path, line: bytes) -> None:
        with writing(path):
            self._file.write(line)
            self._file.flush()

    def _resume(self, path: Path) -> None:
        """Read the rows; cut off an incomplete line, and begin an empty file with the header."""
        self._file.seek(0)
        data = self._file.read()
        whole = data[: data.rfind(b"\n") + 1]
        if len(whole) < len(data):
            self._file.truncate(len(whole))
        if not whole:
            self._write(path, file_header(self._blank))
            return
        there = parse_table(whole, path)
        different = self._difference(there)
        if not different:
            self.rows = self._numbered(there, path)
        elif not (different.startswith("its measures") and self._are_kept(there)):
            raise _another(path, different)
        if tuple(self.rows.values()) != there.results or different:
            self.put_in_order()
            self._file.close()
            self._file = growing(path)

    def _difference(self, there: Table) -> str:
        """Say what tells a file's study from this one; empty if that can't be seen from columns."""
        here = self._blank
        pairs = {
            "experiment": (there.experiment or here.experiment, here.experiment),
            "settings": (", ".join(there.settings), ", ".join(here.settings)),
            "measures": (", ".join(there.measures), ", ".join(here.measures)),
        }
        for what, (old, new) in pairs.items():
            if old != new:
                return f"its {what}: {old or 'none'}; now: {new or 'none'}"
        return ""

    def _are_kept(self, there: Table) -> bool:
        """Return whether the records of all runs in a file are kept, to be measured anew."""
        folder = self._study.blank.records
        places = self._places()
        return bool(folder) and all(
            (cells_of(run.options), run.seed) in places
            and kept_as(run.code, run.options, run.seed, folder).is_file()
            for run in there.results
            if run.digest
        )

    def _places(self) -> dict[tuple[tuple[str, ...], int], int]:
        """Return the numbers of all runs by the cells of their settings and their seeds."""
        runs = self._study.plan.runs()
        return {(cells_of(options), seed): row for row, (options, seed) in enumerate(runs, 1)}

    def _numbered(self, there: Table, path: Path) -> dict[int, Result]:
        """Return the rows of a file by their numbers in this study; refuse those of another."""
        places, rows = self._places(), {}
        for result in there.results:
            row = places.get((cells_of(result.options), result.seed))
            if row is None:
                raise _another(path, self._not_planned(result))
            if not (self._retry and result.error):
                rows[row] = dataclasses.replace(result, row=row)
        backwards = sorted(rows.values(), key=lambda each: -each.row)
        for code, result in {each.code: each for each in backwards if each.code}.items():
            job = self._study.blank
            job = dataclasses.replace(job, options=result.options, seed=result.seed)
            try:
                now = code_of(opened(job), job.code)
            except Mars2dError:
                now = "none"
            if now != code:
                what = f"{self._study.title}, what it reads, or MARS2D"
                raise _another(path, f"{what} has changed since row {result.row} was made")
        return dict(sorted(rows.items()))

    def _not_planned(self, result: Result) -> str:
        """Say why a row is not of this study: its plan lacks a value or the seed."""
        for name, values in self._study.plan.settings.items():
            value, known = cell(result.options[name]), [*map(cell, values)]
            if value not in known:
                hint = nearest(value, known, 1.0)
                return f"it has {name} = {value}, which this one has not{hint}"
        return f"it has the seed {result.seed}, which this one has not: seeds may only become more"


def _another(path: Path, why: str) -> InputError:
    """Return the error for a file that holds another study."""
    return InputError(f"{path}: holds another study; {why}. Give another --out, or delete it")
