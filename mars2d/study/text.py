"""Points, numbers and aligned columns of studies as text."""

from __future__ import annotations

from math import isfinite
from typing import Any

from mars2d.core.errors import counted
from mars2d.scenario.prediction import number
from mars2d.study.table import Table

TERMINAL_WIDTH = 80
"""Characters in a line of a table, if possible."""

Point = tuple[Any, ...]


def varied(table: Table) -> list[tuple[int, str]]:
    """Return (place in a point, name) of the settings that have several values."""
    several = [len({*values}) > 1 for values in zip(*table.points(), strict=True)]
    return [(k, name) for k, name in enumerate(table.settings) if k < len(several) and several[k]]


def in_words(value: Any) -> str:
    """Return a setting's value as text for people."""
    return f"{value:.10g}" if isinstance(value, float) else str(value)


def assigned(name: str, value: Any, unit: str = "") -> str:
    """Return a setting with its value and unit, such as ``speed = 0.5 m/s``."""
    return f"{name} = {in_words(value)} {f'[{unit}]' if ',' in unit else unit}".rstrip()


def head(table: Table, what: str) -> str:
    """Return the first line of a text: the number of runs, the experiment, constant settings."""
    places, points = {k for k, _ in varied(table)}, list(table.points())
    same = [
        f", {assigned(name, points[0][k], table.unit(name))}"
        for k, name in enumerate(table.settings if points else ())
        if k not in places
    ]
    return f"{counted(len(table.results), 'run')} of {table.experiment}{''.join(same)}: {what}"


def near(value: float, half_width: float) -> str:
    """Return a number rounded to two digits of its interval's half width."""
    if half_width > 0 and isfinite(half_width):
        return number(value, half_width)
    return f"{value:.4g}"


def percent(share: float, count: int) -> str:
    """Return a share of `count` runs in percent."""
    return f"{100 * share:z.{0 if count < 200 else 1}f}"


# -- tables ----------------------------------------------------------------------------------------


def side_by_side(left: list[list[str]], columns: list[list[str]]) -> list[str]:
    """Return tables that fit the terminal's width; each begins with the columns on the left.

    left: rows of cells, the headings first. columns: cells by column, each with its heading.
    """
    settings = [_justified(list(cells)) for cells in zip(*left, strict=True)]
    room = TERMINAL_WIDTH + 2 - sum(len(cells[0]) + 2 for cells in settings)
    tables, used = list[list[list[str]]](), room
    for column in map(_aligned, columns):
        width = len(column[0]) + 2
        if used + width > room:
            tables.append([])
            used = 0
        tables[-1].append(column)
        used += width
    return [
        "\n".join("  ".join(row).rstrip() for row in zip(*settings, *each, strict=True))
        for each in tables or [[]]
    ]


def _aligned(column: list[str]) -> list[str]:
    """Return cells of the same width, padded so that their first words end at the same place."""
    heading, *cells = column
    room = max((len(cell.partition(" ")[0]) for cell in cells), default=0)
    moved = [heading, *(" " * (room - len(cell.partition(" ")[0])) + cell for cell in cells)]
    return [cell.ljust(max(map(len, moved))) for cell in moved]


def _justified(column: list[str]) -> list[str]:
    """Return cells of the same width: numbers flush right, words flush left."""
    width = max(map(len, column))
    words = any(cell[:1].isalpha() for cell in column[1:])
    return [cell.ljust(width) if words else cell.rjust(width) for cell in column]
