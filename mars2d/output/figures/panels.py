"""Panels over time, one below the other: figure, axes, titles, legends and curves."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from math import ceil
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError, counted
from mars2d.output.figures.figure import (
    check_axes,
    new_figure,
    show_in_notebooks,
    style_ticks,
)
from mars2d.output.figures.legend import Entry, add_legend
from mars2d.output.figures.style import GRID, INK, LINE, MUTED, SMALL, TITLE, points
from mars2d.output.signals import thinned

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable

    from mars2d.record.rows import Rows

Float = NDArray[np.float64]

WIDTH, PANEL = 7.6, 1.45
"""The width of a figure, and the height of a panel, inches."""

VERTICES = 15_000
"""The most points in a panel, over all its curves, approximately."""

CAPTION_LETTERS, CAPTION_HEIGHT = 12, 0.5
"""The letters in a line of a caption, at most, and its height as a share of the panel's."""

LETTER_WIDTH = 0.56
"""The approximate width of a letter, in text heights."""


def panels(
    record: Rows,
    axes: Sequence[Axes] | None,
    names: Sequence[str],
    heights: Sequence[float] = (),
    rows: slice = slice(None),
) -> list[Axes]:
    """Return dressed axes for panels below each other: those given, or those of a new figure.

    names: the panels' contents, for the error if the number of axes differs. heights: the relative
    heights of the panels. rows: the rows that are drawn. Notebooks show the axes of a new figure.
    """
    if axes is not None:
        given = checked_axes(axes, len(names), f"({', '.join(names)})")
    else:
        tall = sum(heights) if heights else len(names)
        grid = {"height_ratios": list(heights) or [1] * len(names)}
        made = new_figure(WIDTH, tall * PANEL + 0.9).subplots(
            len(names), 1, sharex=True, squeeze=False, gridspec_kw=grid
        )
        given = list(made.ravel())
        show_in_notebooks(*given)
    begin, end = record.time[rows][[0, -1]].tolist()
    for ax in given:
        ax.set_xlim(begin, end if end > begin else begin + record.scenario.sampling_time)
        frame_panel(ax, [1, 2, 4, 5, 10])
        if ax is given[-1] or not ax.get_shared_x_axes().joined(ax, given[-1]):
            ax.set_xlabel("time [s]", color=INK, fontsize=points())
    return given


def checked_axes(axes: Sequence[Axes], count: int, panels: str) -> list[Axes]:
    """Return axes that are given. Raises InputError where they are not one for each panel.

    panels: what they are, for the error.
    """
    given = list(np.ravel(np.asarray(axes, dtype=object)))
    for ax in given:
        check_axes(ax)
    if len(given) != count:
        needed = f"{counted(count, 'panel')} {panels}"
        raise InputError(f"axes: {len(given)} of them, for {needed}: one for each")
    return given


def frame_panel(ax: Axes, steps: Sequence[float]) -> None:
    """Set grid, ticks and spines of a panel. steps: those between ticks of its values, 1 to 10."""
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    ax.set_facecolor("white")
    ax.grid(visible=True, color=GRID, linewidth=0.6)
    ax.set_axisbelow(True)
    style_ticks(ax)
    ax.spines[:].set(color=LINE, linewidth=0.8)
    ax.spines[["top", "right"]].set_visible(False)
    bins = int(np.clip(size_of(ax)[1] / (2.4 * points(SMALL)), 2, 5))
    ax.yaxis.set_major_locator(MaxNLocator(nbins=bins, steps=steps, min_n_ticks=2))
    ax.yaxis.set_major_formatter(FuncFormatter(short_number))


def short_number(value: float, _: int = 0) -> str:
    """Return a number for a tick: short, without rounding errors."""
    return f"{round(value, 12) + 0.0:g}".replace("-", "\N{MINUS SIGN}")


def caption(ax: Axes, name: str, unit: str) -> None:
    """Write a panel's name and unit beside its axis of values, horizontally."""
    text = f"{name} [{unit}]" if unit else name
    if len(text) > CAPTION_LETTERS:
        lines = max(2, int(CAPTION_HEIGHT * size_of(ax)[1] / (1.2 * points())))
        short = shortened(name, lines * CAPTION_LETTERS)
        parts = textwrap.wrap(short, CAPTION_LETTERS)
        text = "\n".join([*parts, *([f"[{unit}]"] if unit else [])])
    ax.set_ylabel(
        text, color=INK, fontsize=points(), rotation=0, ha="right", va="center",
        linespacing=1.2, parse_math=False,
    )  # fmt: skip


def name_curves(ax: Axes, title: str, entries: Sequence[Entry]) -> None:
    """Write a title above the first panel, and a legend between them."""
    room = size_of(ax)[0]
    above = 0.0
    if entries:
        widest = max(len(entry.name) for entry in entries)
        each = points(SMALL) * (3.7 + LETTER_WIDTH * widest)
        cols = max(1, min(len(entries), int(room / each)))
        lines = ceil(len(entries) / cols)
        place = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0)}
        add_legend(ax, entries, ncols=ceil(len(entries) / lines), **place)
        above = lines * points(SMALL) * 1.5
    letters = max(20, letters_in(room, points(TITLE)))
    ax.set_title(
        textwrap.fill(title, letters, max_lines=2, placeholder=" …"), loc="left",
        fontsize=points(TITLE), color=INK, pad=6 + above, parse_math=False,
    )  # fmt: skip


def curve(
    ax: Axes, time: Float, values: Float, entry: Entry, held: str = "", *, many: int = 1,
    wraps: bool = False, level: float = 3.0,
) -> None:  # fmt: skip
    """Draw values (T,) over time, with gaps for nan and inf; a value between two gaps is a dot.

    held: "post" if a value holds until the next one, "pre" if it has held since the one before.
    many: the number of curves in the panel. A long curve is thinned to its extremes. wraps: whether
    the values are angles, so that no line joins pi and -pi.
    """
    kept = thinned(values, int(np.clip(VERTICES / many, 150, 5000)) // 5)
    time, values = time[kept], values[kept]
    if wraps:
        jumps = np.flatnonzero(np.abs(np.diff(values)) > np.pi) + 1
        time, values = np.insert(time, jumps, time[jumps]), np.insert(values, jumps, np.nan)
    finite = np.isfinite(values)
    near = np.concatenate([[False], finite, [False]])
    alone = finite & ~(near[2:] | near[:-2])
    ax.plot(
        time, np.where(finite, values, np.nan), color=entry.color, linestyle=entry.dash,
        linewidth=entry.width, drawstyle=f"steps-{held}" if held else "default",
        solid_joinstyle="round", zorder=level,
    )  # fmt: skip
    if alone.any():
        ax.plot(
            time[alone], values[alone], linestyle="none", marker="o", color=entry.color,
            markersize=2.2 * entry.width, markeredgewidth=0, zorder=level,
        )  # fmt: skip


def name_rows(ax: Axes, names: Sequence[str], count: int) -> None:
    """Name the rows of bars of a panel, the first on top; without names it has no ticks."""
    ax.set_ylim(0, count)
    ax.set_yticks(np.arange(len(names)) + 0.5, names[::-1])
    for text in ax.get_yticklabels():
        text.set_parse_math(False)
    ax.grid(visible=False, axis="y")


def set_span(ax: Axes, low: float, high: float) -> None:
    """Set the limits of a panel's values to `low` and `high` with a margin.

    Differences as small as rounding errors are not enlarged.
    """
    if not low <= high:  # there are none
        low, high = 0.0, 1.0
    least = max(1e-6, 1e-4 * max(abs(low), abs(high)))
    if high - low < least:
        middle, least = (low + high) / 2, max(0.1, 0.1 * abs(low))
        low, high = middle - least, middle + least
    margin = 0.06 * (high - low)
    ax.set_ylim(low - margin, high + margin)


def color_bar(ax: Axes, image: ScalarMappable, text: str) -> None:
    """Add a colour bar at the right side of axes, without changing their size."""
    bar = ax.figure.colorbar(image, cax=ax.inset_axes((1.012, 0.0, 0.014, 1.0)))
    bar.outline.set_visible(False)
    style_ticks(bar.ax)
    bar.ax.tick_params(pad=2)
    bar.set_label(text, color=INK, fontsize=points(SMALL), parse_math=False)


def say(ax: Axes, text: str) -> None:
    """Write the reason why axes are empty in their middle."""
    ax.text(
        0.5, 0.5, text, transform=ax.transAxes, ha="center", va="center", wrap=True,
        fontsize=points(), color=MUTED, parse_math=False,
    )  # fmt: skip


def width_of(many: int, few: int = 8) -> float:
    """Return the width of one of `many` curves, points."""
    return 1.5 if many <= few else 0.7


def letters_in(length: float, height: float) -> int:
    """Return how many letters have room in a length; both it and their height in points."""
    return max(1, int(length / (LETTER_WIDTH * height)))


def size_of(ax: Axes) -> tuple[float, float]:
    """Return the width and the height of axes, points; approximate before the layout."""
    box, points = ax.get_window_extent(), 72 / ax.figure.dpi
    return box.width * points, box.height * points


def shortened(text: str, letters: int) -> str:
    """Return a text on one line, without its middle if it has more letters than this.

    >>> shortened("laws/group_a/pursuit.py", 16)
    'laws/g…ursuit.py'
    """
    text = " ".join(text.split())
    if len(text) <= letters:
        return text
    start = (letters - 1) * 2 // 5
    return f"{text[:start]}…{text[len(text) - (letters - 1 - start) :]}"
