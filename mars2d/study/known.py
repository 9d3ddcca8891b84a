"""The rows of a study that its file has already, by their numbers in the study."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from mars2d.core.errors import Mars2dError, nearest
from mars2d.study.code import code_of, code_of_run
from mars2d.study.job import opened
from mars2d.study.kept import kept_as
from mars2d.study.prepare import Study
from mars2d.study.results import AnotherStudyError, Results, another
from mars2d.study.table import Result, Table, cell, cells_of, load_table, save_table


def table_of(study: Study, rows: dict[int, Result]) -> Table:
    """Return a study's table with the given rows, in order."""
    results = tuple(result for _, result in sorted(rows.items()))
    return Table(study.title, tuple(study.plan.settings), study.measures, results, study.units)


@contextmanager
def known_rows(
    study: Study, out: Path | None, retry: bool
) -> Iterator[tuple[dict[int, Result], Results | None]]:
    """Yield the rows that the file holds, by number, and the file, which is locked.

    Before any row is added, the rows in the file get their numbers in this study.
    """
    if out is None:
        yield {}, None
        return
    blank = table_of(study, {})
    try:
        rows = _put_right(study, out, retry)
    except AnotherStudyError:
        if not _measurable_anew(study, out):
            raise
        save_table(blank, out)
        rows = {}
    with Results(out, blank) as file:
        yield rows, file


def _put_right(study: Study, out: Path, retry: bool) -> dict[int, Result]:
    """Return the rows of a file by their numbers in a study, and number them so in the file."""
    with Results(out, table_of(study, {})) as file:
        rows = _rows_of(study, file.known, out)
        if retry:
            rows = {row: result for row, result in rows.items() if not result.error}
        if tuple(rows.values()) != file.known:
            file.put_in_order(table_of(study, rows))
    return rows


def _measurable_anew(study: Study, out: Path) -> bool:
    """Return whether a file has only runs of this study's plan, whose records are kept."""
    there = load_table(out)
    same = there.experiment == study.title and there.settings == tuple(study.plan.settings)
    if not study.blank.records or not same:
        return False
    planned = {(cells_of(options), seed) for options, seed in study.plan.runs()}
    made = {(cells_of(result.options), result.seed) for result in there.results if result.digest}
    return made <= planned and all(_are_kept(study, each) for each in there.points().values())


def _are_kept(study: Study, results: tuple[Result, ...]) -> bool:
    """Return whether the records of the runs at a point are kept, except for those that failed."""
    job = dataclasses.replace(study.blank, options=results[0].options, seed=results[0].seed)
    try:
        code = code_of_run(opened(job))
    except Mars2dError:
        return False
    return all(
        kept_as(code, result.options, result.seed, job.records).is_file()
        for result in results
        if result.digest
    )


def _rows_of(study: Study, known: tuple[Result, ...], out: Path) -> dict[int, Result]:
    """Return the rows of a file by their numbers in a study; refuse those of another study."""
    places = {
        (cells_of(options), seed): row for row, (options, seed) in enumerate(study.plan.runs(), 1)
    }
    rows = {}
    for result in known:
        row = places.get((cells_of(result.options), result.seed))
        if row is None:
            raise another(out, _difference(study, result))
        rows[row] = dataclasses.replace(result, row=row)
    for row in _one_of_each(rows):
        _refuse_other_code(study, rows[row], out)
    return rows


def _difference(study: Study, result: Result) -> str:
    """Say why a row is not of a study: its plan lacks a value or the seed."""
    for name, values in study.plan.settings.items():
        value, known = cell(result.options[name]), [*map(cell, values)]
        if value not in known:
            return f"it has {name} = {value}, which this one has not{nearest(value, known, 1.0)}"
    return f"it has the seed {result.seed}, which this one has not: seeds may only become more"


def _one_of_each(rows: dict[int, Result]) -> Iterator[int]:
    """Yield few rows that together have each pair of a code and a setting's value."""
    seen: set[tuple[str, str, str]] = set()
    for row, result in sorted(rows.items()):
        pairs = {(result.code, name, cell(value)) for name, value in result.options.items()}
        pairs.add((result.code, "", ""))
        if result.code and not pairs <= seen:
            seen |= pairs
            yield row


def _refuse_other_code(study: Study, result: Result, out: Path) -> None:
    """Raise InputError if the experiment has changed since a row was made."""
    point = cells_of(result.options)
    code = study.codes.get(point)
    if code is None:
        job = dataclasses.replace(study.blank, options=result.options, seed=result.seed)
        try:
            code = code_of(opened(job), job.code)
        except Mars2dError:
            code = "none"
        study.codes[point] = code
    if code != result.code:
        raise another(
            out,
            f"{study.title}, what it reads, or MARS2D has changed since row {result.row} was made",
        )
