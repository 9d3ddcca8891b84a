"""The axes of a study's panels: their scales, their ticks and the names of values and settings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mars2d.output.figures.labels import fits, shortened, wrapped
from mars2d.output.figures.panels import frame_panel, letters_in, short_number, size_of
from mars2d.output.figures.style import INK, SMALL, points
from mars2d.study.layout import Layout
from mars2d.study.table import Table
from mars2d.study.text import in_words
from mars2d.study.units import with_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

VALUE_LINES = 3
"""The most lines of a value's name below its tick; where it needs more, it is turned."""

NAME_LINES = 4
"""About how many lines the name of a setting may have."""

TURNED_LETTERS, TURNED_SHARE = 28, 0.4
"""The most letters of a name that is turned, and its length as a share of the figure's height."""


def dress(ax: Axes, layout: Layout) -> None:
    """Set the scale, limits and ticks of the axis, grid and spines."""
    from matplotlib.ticker import FuncFormatter, NullLocator

    if layout.logarithmic:
        ax.set_xscale("log")
        ax.xaxis.set_minor_locator(NullLocator())
    ax.set_xlim(*layout.limits())
    if layout.roomy() or not layout.numeric:
        _name_values(ax, layout)
    else:
        ax.xaxis.set_major_formatter(FuncFormatter(short_number))
    frame_panel(ax, [1, 2, 2.5, 5, 10])


def _name_values(ax: Axes, layout: Layout) -> None:
    """Write each value below its tick: on several lines, or turned, where there is little room."""
    scaled, (low, high) = layout.scaled(), ax.get_xlim()
    span = np.log10(high / low) if layout.logarithmic else high - low
    gaps = np.diff(np.sort(scaled)) / span
    room = size_of(ax)[0] * float(gaps.min() if len(gaps) else 1.0)
    names = [in_words(value) for value in layout.values] or [""]
    letters = letters_in(room, points(SMALL))
    turned: dict[str, Any] = {}
    if all(fits(name, letters - 1, VALUE_LINES) for name in names):
        names = [wrapped(name, letters - 1) for name in names]
    else:
        length = TURNED_SHARE * ax.figure.bbox.height * 72 / ax.figure.dpi
        letters = min(TURNED_LETTERS, letters_in(length, points(SMALL)))
        names = [shortened(name, letters) for name in names]
        turned = {"rotation": 35, "ha": "right", "rotation_mode": "anchor"}
        if room < 2.2 * points(SMALL):
            turned = {"rotation": 90}
    step = int(np.ceil(1.2 * points(SMALL) / room))
    places = 10**scaled if layout.logarithmic else scaled
    ax.set_xticks(
        places[::step].tolist(), names[::step], parse_math=False, linespacing=1.2, **turned
    )


def scale_to_100(ax: Axes) -> None:
    """Give an axis of values the limits and ticks of a share, in percent."""
    few = size_of(ax)[1] < 5 * 2.4 * points(SMALL)
    ax.set_ylim(-6, 106)
    ax.set_yticks([0, 50, 100] if few else [0, 25, 50, 75, 100])


def name_axis(ax: Axes, table: Table, layout: Layout, column: int) -> None:
    """Label a panel's axis, and below it the value in which the panel differs from others."""
    name = "all runs"
    if layout.axis is not None:
        setting = table.settings[layout.axis]
        name = with_unit(setting, table.unit(setting))
    title = layout.columns[column][0]
    letters = letters_in(size_of(ax)[0], points())
    parts = [shortened(part, NAME_LINES * letters) for part in (name, title) if part]
    text = "\n".join(wrapped(part, letters) for part in parts)
    ax.set_xlabel(text, color=INK, fontsize=points(), linespacing=1.2, parse_math=False)
