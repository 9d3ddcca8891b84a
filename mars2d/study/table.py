"""Tables: the results of many runs of an experiment, one row a run, in memory and as .csv files.

Columns: ``row``, ``experiment``, the settings, ``seed``, the measures, ``digest``, ``code``,
``error``. The file format is that of RFC 4180.
"""

from __future__ import annotations

import csv
import dataclasses
import io
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError, counted, one_line, shown
from mars2d.core.extras import extra
from mars2d.core.files import atomic_write
from mars2d.scenario.options import parse_option
from mars2d.study.measures import UNITS
from mars2d.study.units import unit_of_field

if TYPE_CHECKING:
    from pandas import DataFrame

Float = NDArray[np.float64]

FIRST, SEED, LAST = ("row", "experiment"), "seed", ("digest", "code", "error")
"""The columns of every table; the settings stand before the seed, the measures after it."""

LINE_END = "\r\n"


@dataclass(frozen=True)
class Result:
    """The result of one run.

    row: its number in the study, from 1. options: the value of each setting, by name. seed: that of
    all its random streams. measures: numbers or words by name; None where there was nothing to
    measure. error: one line, or empty. digest: of its record, or empty. code: the first digits of a
    hash of all files that its experiment read.
    """

    row: int
    options: Mapping[str, Any]
    seed: int
    measures: Mapping[str, float | str | None]
    error: str = ""
    digest: str = ""
    code: str = ""


@dataclass(frozen=True)
class Table:
    """The results of a study: its runs in order, each with its settings, seed and measures.

    experiment: the name of the experiment. settings, measures: their names, in order.
    """

    experiment: str
    settings: tuple[str, ...]
    measures: tuple[str, ...]
    results: tuple[Result, ...]

    def __len__(self) -> int:
        return len(self.results)

    def __repr__(self) -> str:
        failed = f", {len(self.failed)} of them failed" if self.failed else ""
        return f"<Table of {self.experiment}: {counted(len(self), 'run')}{failed}>"

    @property
    def failed(self) -> tuple[Result, ...]:
        """The runs that have an error."""
        return tuple(result for result in self.results if result.error)

    def unit(self, name: str) -> str:
        """Return the unit of a setting that is a field, or of a built-in measure; or ""."""
        return unit_of_field(name) if name in self.settings else UNITS.get(name, "")

    def points(self) -> dict[tuple[Any, ...], tuple[Result, ...]]:
        """Return the runs of each point, in order; a point is the tuple of all settings' values.

        A list among the values becomes a tuple.
        """
        points: dict[tuple[Any, ...], list[Result]] = {}
        for result in self.results:
            point = tuple(key_of(result.options[name]) for name in self.settings)
            points.setdefault(point, []).append(result)
        return {point: tuple(results) for point, results in points.items()}

    @staticmethod
    def values(results: tuple[Result, ...], measure: str) -> Float:
        """Return a measure of some runs, (k,); nan where it is missing or a word."""
        found = (result.measures.get(measure) for result in results)
        return np.array([nan if v is None or isinstance(v, str) else v for v in found], dtype=float)

    def to_frame(self) -> DataFrame:
        """Return a table of pandas: one row a run; settings, seed and measures are columns.

        Raises MissingExtraError without pandas.
        """
        with extra("data", "tables need pandas"):
            import pandas as pd
        columns = ["row", *self.settings, SEED, *self.measures, *LAST]
        rows = map(_columns_of, self.results)
        frame = pd.DataFrame(rows, columns=columns).set_index("row")
        for name in self.measures:  # a measure without any value is a column of nan, not of objects
            if frame[name].isna().all():
                frame[name] = frame[name].astype(float)
        return frame

    def save(self, path: str | Path) -> Path:
        """Write the table as a .csv file, which `load` reads, and return its path.

        Raises InputError if the table can't be written.
        """
        target = Path(path)
        if target.suffix.lower() != ".csv":
            raise InputError(f"{target}: expected a name that ends in .csv")
        lines = [file_header(self), *(file_line(self, result) for result in self.results)]
        with atomic_write(target) as file:
            file.write(b"".join(lines))
        return target

    @staticmethod
    def load(path: str | Path) -> Table:
        """Return the table in a file that a study wrote, sorted by row number.

        An incomplete last line is left out. Raises InputError for any other file.
        """
        source = Path(path)
        try:
            data = source.read_bytes()
        except OSError as error:
            raise InputError(f"{source}: can't be read: {error.strerror or error}") from error
        return parse_table(data[: data.rfind(b"\n") + 1], source)


def _columns_of(result: Result) -> dict[str, Any]:
    """Return the values of a run by the names of their columns."""
    own = {name: getattr(result, name) for name in ("row", SEED, *LAST)}
    return {**result.options, **result.measures, **own}


# -- writing files ---------------------------------------------------------------------------------


def file_header(table: Table) -> bytes:
    """Return the first line of a table's file."""
    return _line([*FIRST, *table.settings, SEED, *table.measures, *LAST])


def file_line(table: Table, result: Result) -> bytes:
    """Return a run's line in a table's file."""
    values = [cell(result.options[name]) for name in table.settings]
    found = (result.measures.get(name) for name in table.measures)
    measured = ["" if value is None else str(value) for value in found]
    error = one_line(" ".join(result.error.split()))
    own = str(result.row), table.experiment
    return _line([*own, *values, str(result.seed), *measured, result.digest, result.code, error])


def _line(cells: Iterable[str]) -> bytes:
    text = io.StringIO()
    csv.writer(text, lineterminator=LINE_END).writerow(cells)
    return text.getvalue().encode(errors="backslashreplace")  # file names may hold any bytes


# -- reading files ---------------------------------------------------------------------------------


def parse_table(data: bytes, path: Path) -> Table:
    """Return the table in the content of a file. Raises InputError, which names the line."""
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: expected a table in UTF-8; {error.reason}") from error
    csv.field_size_limit(max(csv.field_size_limit(), len(text)))  # no cell is longer than the text
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    try:
        header = next(reader, [])
        blank, results = _blank(header), list[Result]()
        for cells in filter(None, reader):
            results.append(_result(cells, blank, len(header)))
            blank = dataclasses.replace(blank, experiment=cells[1])
    except (csv.Error, InputError) as error:
        at = f", line {reader.line_num}" if reader.line_num > 1 else ""
        raise InputError(f"{path}{at}: {error}") from error
    return dataclasses.replace(blank, results=tuple(sorted(results, key=lambda each: each.row)))


def _blank(header: list[str]) -> Table:
    """Return the table with these headings, without rows."""
    if (*header[:2], *header[-3:]) != (*FIRST, *LAST) or header.count(SEED) != 1:
        expected = f"{', '.join(FIRST)}, settings, seed, measures, {', '.join(LAST)}"
        found = f"; it begins with {shown(','.join(header))}" if header else "; it is empty"
        raise InputError(f"is no table of a study: expected columns {expected}{found}")
    at = header.index(SEED)
    return Table("", tuple(header[2:at]), tuple(header[at + 1 : -3]), ())


def _result(cells: list[str], blank: Table, width: int) -> Result:
    """Return the run in the cells of a row, of which a table has `width`."""
    if len(cells) != width:
        raise InputError(f"{len(cells)} cells, expected {width}")
    if blank.experiment not in ("", cells[1]):
        before = f"where the rows before have {shown(blank.experiment)}"
        raise InputError(f"experiment {shown(cells[1])}, {before}")
    values, (seed, *found) = cells[2 : 2 + len(blank.settings)], cells[2 + len(blank.settings) : -3]
    for name, text in (("row", cells[0]), (SEED, seed)):
        if not text.isdecimal():
            raise InputError(f"{name} = {shown(text)}: expected a whole number")
    options = dict(zip(blank.settings, map(value_in, values), strict=True))
    measured = dict(zip(blank.measures, map(_measured, found), strict=True))
    digest, code, error = cells[-3:]
    return Result(int(cells[0]), options, int(seed), measured, error, digest, code)


def _measured(text: str) -> float | str | None:
    for kind in (int, float):
        with suppress(ValueError):
            return kind(text)
    return text or None


# -- cells -----------------------------------------------------------------------------------------


def cell(value: Any) -> str:
    """Return a setting's value as the text of a cell; `value_in` reads it back.

    >>> [cell(value) for value in (0.5, "a.py", "0.5", (1, 2))]
    ['0.5', 'a.py', "'0.5'", '(1, 2)']
    """
    if isinstance(value, str) and value_in(value) == value and value.isprintable():
        return value
    return repr(value)


def value_in(text: str) -> Any:
    """Return the value in a cell: a Python literal, or else a word."""
    return parse_option(f"_={text}")[1]


def cells_of(options: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the cells of a point, which identify it."""
    return tuple(map(cell, options.values()))


def key_of(value: Any) -> Any:
    """Return a hashable key that identifies a setting's value; a list has the key of a tuple."""
    if isinstance(value, (list, tuple)):
        return tuple(map(key_of, value))
    return repr(value) if isinstance(value, (dict, set)) else value
