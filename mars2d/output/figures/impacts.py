"""Figures of impacts: the velocities of two bodies before and after a touch, and their numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mars2d.core.errors import InputError
from mars2d.output.figures.figure import new_figure, show_in_notebooks
from mars2d.output.figures.legend import plain_name
from mars2d.output.figures.panels import checked_axes
from mars2d.output.figures.style import GRID, INK, MUTED, SMALL, curve_color, points
from mars2d.record.impacts import card

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from mars2d.record.rows import Rows
    from mars2d.scenario.scenario import Scenario

MOST = 4
"""The most impacts in a figure."""

WIDTH, HEIGHT, TABLE = 5.2, 4.2, 0.68
"""The size of one impact's panel, inches, and the share of it that its table takes."""


def plot_impacts(record: Rows, axes: Sequence[Axes] | None = None) -> list[Axes]:
    """Draw the impacts of a record, each in a panel: velocities as arrows, and a table.

    The arrows are the velocities of the centres of mass, before (hollow) and after (filled), with
    the normal to the right. Of more than four impacts, those of the largest impulses are drawn.
    axes: one for each of these; by default those of a new figure.
    Returns the axes. Raises InputError for a record without impacts.
    """
    found = record.impacts()
    if not len(found):
        raise InputError("plot_impacts: the record has no impacts: nothing came to touch")
    largest = np.argsort(-np.hypot(*found["impulse"].T), kind="stable")[:MOST]
    found = found[np.sort(largest)]
    if axes is None:
        columns = min(len(found), 2)
        rows = -(-len(found) // columns)
        figure = new_figure(WIDTH * columns, HEIGHT * rows)
        axes = list(figure.subplots(rows, columns, squeeze=False).ravel())
        for ax in axes[len(found) :]:
            ax.remove()
        axes = axes[: len(found)]
        show_in_notebooks(*axes)
    axes = checked_axes(axes, len(found), "of impacts")
    for ax, impact in zip(axes, found, strict=True):
        _panel(ax, record.scenario, impact)
    return axes


def _panel(ax: Axes, scenario: Scenario, impact: np.void) -> None:
    """Draw one impact in its axes."""
    from matplotlib.transforms import Bbox

    title, *rows = card(scenario, impact)
    a, b = map(plain_name, title[1:3])
    ax.set_title(f"{a} and {b} at {impact['time']:.4g} s", fontsize=points(), color=INK)
    ax.set_axis_off()
    ax.set(xlim=(-2, 2), ylim=(-2 / (1 - TABLE), 1))
    longest = max(np.hypot(*impact[when].reshape(2, 2).T).max() for when in ("before", "after"))
    for body, place in enumerate((-1.0, 1.0)):
        color = curve_color(body)
        for when, filled in (("before", False), ("after", True)):
            velocity = impact[when][body] / (longest or 1.0)
            if np.hypot(*velocity) < 0.01:
                continue
            ax.annotate(
                "", (place + velocity[0], velocity[1]), (place, 0.0),
                arrowprops={
                    "arrowstyle": "-|>", "linestyle": "-" if filled else "--", "edgecolor": color,
                    "facecolor": color if filled else "white", "linewidth": 1.6,
                    "shrinkA": 0, "shrinkB": 0,
                },
            )  # fmt: skip
        ax.plot([place], [0], "o", color=color, markersize=0.9 * points())
    table = ax.table(
        [list(row) for row in rows], colLabels=["dashed: before", a, b, title[3]],
        colWidths=[0.37, 0.18, 0.18, 0.27], cellLoc="right", bbox=Bbox.from_bounds(0, 0, 1, TABLE),
    )  # fmt: skip
    table.auto_set_font_size(False)
    for (row, column), cell in table.get_celld().items():
        text = cell.get_text()
        text.set(fontsize=points(SMALL), color=INK if row == 0 or column else MUTED)
        text.set_text(text.get_text().replace("-", "\N{MINUS SIGN}"))
        cell.set(edgecolor=GRID, linewidth=0.6)
        if column == 0:
            cell.set_text_props(ha="left")
