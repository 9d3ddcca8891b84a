"""Tables: what many runs of an experiment came to, one row a run."""

from __future__ import annotations

import html
from collections.abc import Mapping
from dataclasses import dataclass
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import MissingExtraError, counted

if TYPE_CHECKING:
    from pandas import DataFrame

__all__ = ["Result", "Table", "key_of"]

Float = NDArray[np.float64]

SHOWN = 20
"""The rows of a table that a notebook shows."""


@dataclass(frozen=True)
class Result:
    """What one run came to.

    row: its number in the study, from 1. options: the value of each setting, by name. seed: of all
    its random streams. measures: what was measured, by name: numbers or words; None where it was
    not. error: what went wrong, one line, or empty. digest: of its record, or empty. code: the
    first digits of a hash of all files that its experiment read.
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
    """What a study came to: its runs in order, each with its settings, seed and measures.

    experiment: what was run. settings, measures: their names, in order.
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

    def points(self) -> dict[tuple[Any, ...], tuple[Result, ...]]:
        """Return the runs of each point, which is the values of all settings, in order.

        A list among the values is a tuple here.
        """
        points: dict[tuple[Any, ...], list[Result]] = {}
        for result in self.results:
            point = tuple(key_of(result.options[name]) for name in self.settings)
            points.setdefault(point, []).append(result)
        return {point: tuple(results) for point, results in points.items()}

    @staticmethod
    def values(results: tuple[Result, ...], measure: str) -> Float:
        """Return a measure of some runs, (k,); nan where there is none, or where it is a word."""
        found = (result.measures.get(measure) for result in results)
        return np.array([nan if v is None or isinstance(v, str) else v for v in found], dtype=float)

    # -- what programs read ------------------------------------------------------------------------

    def to_frame(self) -> DataFrame:
        """Return a table of pandas: one row a run; settings, seed and measures are columns.

        Raises MissingExtraError without pandas.
        """
        try:
            import pandas as pd
        except ImportError:
            raise MissingExtraError('tables need pandas: pip install "mars2d[data]"') from None
        rows = [
            {
                "row": result.row,
                **result.options,
                "seed": result.seed,
                **{name: result.measures.get(name) for name in self.measures},
                "digest": result.digest,
                "code": result.code,
                "error": result.error,
            }
            for result in self.results
        ]
        columns = ["row", *self.settings, "seed", *self.measures, "digest", "code", "error"]
        frame = pd.DataFrame(rows, columns=columns).set_index("row")
        for name in self.measures:  # a measure that is nowhere is a column of nan, not of objects
            if frame[name].isna().all():
                frame[name] = frame[name].astype(float)
        return frame

    def save(self, path: str | Path) -> Path:
        """Write the table as a .csv file, which `load_table` reads again, and return its path.

        Raises InputError where it can't be written.
        """
        from mars2d.study.results import save_table

        return save_table(self, path)

    @staticmethod
    def load(path: str | Path) -> Table:
        """Return the table that a .csv file of a study holds; see `mars2d.study.results`."""
        from mars2d.study.results import load_table

        return load_table(path)

    # -- what people look at -----------------------------------------------------------------------

    def summary(self, confidence: float = 0.95) -> str:
        """Return the means of each point with their intervals, as text."""
        from mars2d.study.summary import summary

        return summary(self, confidence)

    def compare(self, setting: str, confidence: float = 0.95) -> str:
        """Return how the values of a setting differ from its first one, seed by seed, as text."""
        from mars2d.study.summary import comparison

        return comparison(self, setting, confidence)

    def plot(self, axes: Any = None, *, confidence: float = 0.95, **how: Any) -> Any:
        """Draw the measures over the settings, with intervals; see `mars2d.study.figure`."""
        from mars2d.study.figure import plot_study

        return plot_study(self, axes, confidence=confidence, **how)

    def _repr_html_(self) -> str:
        """Return the first rows as a table, for a notebook."""
        names = ["row", *self.settings, "seed", *self.measures]
        errors = ["error"] if self.failed else []
        lines = [_line("th", [*names, *errors])]
        for result in self.results[:SHOWN]:
            measured = [result.measures.get(name) for name in self.measures]
            settings = [result.options[name] for name in self.settings]
            cells = [result.row, *settings, result.seed, *measured]
            lines.append(_line("td", [*cells, *([result.error] if errors else [])]))
        left = len(self) - SHOWN
        more = f"<p>and {counted(left, 'row')} more</p>" if left > 0 else ""
        title = html.escape(repr(self)[1:-1])
        return f"<p>{title}</p><table>{''.join(lines)}</table>{more}"


def key_of(value: Any) -> Any:
    """Return what a setting's value is told apart by: itself, but for lists, which are tuples."""
    if isinstance(value, (list, tuple)):
        return tuple(map(key_of, value))
    return repr(value) if isinstance(value, (dict, set)) else value


def _line(tag: str, cells: list[Any]) -> str:
    texts = ("" if cell is None else _text(cell) for cell in cells)
    return f"<tr>{''.join(f'<{tag}>{text}</{tag}>' for text in texts)}</tr>"


def _text(cell: Any) -> str:
    return html.escape(f"{cell:.6g}" if isinstance(cell, float) else str(cell))
