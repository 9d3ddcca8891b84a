"""The layout of a study's figure: which setting is the axis, and which make lines."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError, nearest
from mars2d.study.table import Table
from mars2d.study.text import Point, assigned

Float = NDArray[np.float64]

MAX_LINES = 8
"""How many lines a panel may have."""

DODGE, MAX_SPREAD = 0.024, 0.5
"""How far lines are moved apart at the same value, so that no interval covers another: the distance
of two as a share of the axis, and that of all, at most, as a share of the gap between values."""


@dataclass(frozen=True)
class Layout:
    """The places of points in the figure of a study.

    axis: the place in a point of the setting along the axis, or None if none varies. values: those
    of that setting. lines: their points, by their names.
    """

    axis: int | None
    values: tuple[Any, ...]
    lines: dict[str, tuple[Point, ...]]

    @property
    def numeric(self) -> bool:
        """Whether the axis shows numbers; otherwise it shows words, evenly spaced."""
        return self.axis is not None and all(map(_is_number, self.values))

    @property
    def logarithmic(self) -> bool:
        """Whether the numbers are more evenly spaced on a logarithmic scale, such as 4, 8, 16."""
        if not self.numeric or len(self.values) < 3 or min(self.values) <= 0:
            return False
        values = np.sort(np.array(self.values, dtype=float))
        steps = np.diff(values), np.diff(np.log(values))
        even, even_ratio = (float(each.std() / each.mean()) for each in steps)
        return even_ratio < 0.9 * even

    def scaled(self) -> Float:
        """Return the positions of the values along the axis, (k,), on a linear scale."""
        if not self.numeric:
            return np.arange(max(1, len(self.values)), dtype=float)
        values = np.array(self.values, dtype=float)
        return np.log10(values) if self.logarithmic else values

    def place(self, point: Point, line: str) -> float:
        """Return where a point of a line is drawn: at its value, moved by the line's dodge."""
        scaled, count = self.scaled(), len(self.lines)
        k = self.values.index(point[self.axis]) if self.axis is not None else 0
        gap = float(np.diff(np.sort(scaled)).min()) if len(scaled) > 1 else 1.0
        dodge = min(MAX_SPREAD * gap / count, DODGE * (float(np.ptp(scaled)) or 5.0))
        moved = scaled[k] + ([*self.lines].index(line) - (count - 1) / 2) * dodge
        return float(10**moved if self.logarithmic else moved)

    def limits(self) -> tuple[float, float]:
        """Return the ends of the axis."""
        scaled = self.scaled()
        low, high = float(scaled.min()), float(scaled.max())
        margin = 0.07 * (high - low) if self.numeric and high > low else 0.5
        ends = low - margin, high + margin
        return (10 ** ends[0], 10 ** ends[1]) if self.logarithmic else ends

    def roomy(self) -> bool:
        """Return whether there is room for a tick at each value."""
        scaled = np.sort(self.scaled())
        gaps = np.diff(scaled) / (float(np.ptp(scaled)) or 1.0)
        return len(scaled) < 2 or (len(scaled) <= 10 and float(gaps.min()) > 0.05)


def layout_of(table: Table, x: str | None = None) -> Layout:
    """Return the layout for the figure of a study.

    x: the setting along the axis; by default the first with several numbers, else with several
    values. Raises InputError for an unknown setting, and for more lines than a figure can show.
    """
    settings, every = table.settings, list(table.points())

    values = [tuple(dict.fromkeys(column)) for column in zip(*every, strict=True)]
    several = [k for k, found in enumerate(values) if len(found) > 1]
    if x is not None and x not in settings:
        raise InputError(f"figure: x = {x!r}: there is no such setting{nearest(x, settings)}")
    numeric = [k for k in several if all(map(_is_number, values[k]))]
    axis = settings.index(x) if x is not None else next(iter([*numeric, *several]), None)
    others = [k for k in several if k != axis]
    lines: dict[str, tuple[Point, ...]] = defaultdict(tuple)
    for point in every:
        named = (assigned(settings[k], point[k], table.unit(settings[k])) for k in others)
        lines[", ".join(named)] += (point,)
    if len(lines) > MAX_LINES:
        sizes = " x ".join(f"{len(values[k])} of {settings[k]}" for k in others)
        raise InputError(
            f"figure: {sizes} are too many lines: at most {MAX_LINES}; draw fewer values, or "
            "another setting along the axis"
        )
    return Layout(axis, values[axis] if axis is not None else (), lines)


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)
