"""Figures of contacts: the pairs that touched, when, and with which force."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import counted
from mars2d.output.figures.extent import check_rows
from mars2d.output.figures.legend import Entry, plain_name
from mars2d.output.figures.panels import (
    caption,
    color_bar,
    curve,
    name_curves,
    name_rows,
    panels,
    say,
    set_span,
    width_of,
)
from mars2d.output.figures.style import MUTED, SMALL, curve_color, points

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from mars2d.record.rows import Rows
    from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]
Index = NDArray[np.intp]

TIME_CELLS = 500
"""The number of intervals of time; a pair's bar shows the largest force in each."""

ROWS = 16
"""The most bars, one below the other, that can be told apart."""

BAR_HEIGHT = 0.62
"""The height of a bar, as a share of its line."""


def plot_contacts(record: Rows, axes: Sequence[Axes] | None = None) -> list[Axes]:
    """Draw the times at which pairs touched, and the normal force of all contacts over time.

    In the upper panel each pair has a line, in the order of first contact, with a bar for each time
    that it stayed in touch. A bar's colour is the mean normal force over a control step: the normal
    impulse divided by the sampling time. Of more than 16 pairs, those with the largest impulse over
    the run are drawn, and a note gives the number of the others. The lower panel shows the sum of
    the normal forces of all pairs; it is left out where no forces act, for example with physics
    "stop".

    axes: one for each panel; by default those of a new figure. Returns the axes. If
    there were no contacts, the first says so. Raises InputError for a record without rows.
    """
    check_rows(record)
    touches = record.pair_forces
    force = bool(touches["normal_force"].any())
    both = np.column_stack([touches["a"], touches["b"]]).astype(np.intp)
    pairs, group = np.unique(both, axis=0, return_inverse=True)
    group = group.ravel()
    chosen = _chosen(touches, group, len(pairs), ROWS)
    line = np.full(len(pairs), -1)
    line[chosen] = np.arange(len(chosen))
    names = ["pairs", "normal force"] if force else ["pairs"]
    tall = max(0.9, 0.17 * (len(chosen) + 1))
    axes = panels(record, axes, names, [tall, 1.0][: len(names)])
    if len(chosen):
        _timeline(axes[0], record, pairs[chosen], line[group])
        if len(chosen) < len(pairs):
            axes[0].text(
                1.0, 1.0, f"and {counted(len(pairs) - len(chosen), 'more pair')}", ha="right",
                va="bottom", transform=axes[0].transAxes, fontsize=points(SMALL),
                color=MUTED,
            )  # fmt: skip
    else:
        lasted = f"{float(record.time[-1] - record.time[0]):.4g} s"
        say(axes[0], f"no contacts: nothing touched in {lasted}")
        for ax in axes:
            ax.set_axis_off()
    if len(axes) == 2 and len(chosen):
        total = normal_force(record)
        entry = Entry("", curve_color(0), "-", width_of(1))
        curve(axes[1], record.time, total, entry, held="pre")
        set_span(axes[1], 0.0, float(total.max()))
        axes[1].set_ylim(0, None)
        caption(axes[1], "normal force of all", "N")
    name_curves(axes[0], record.scenario.title, [])
    return axes


def normal_force(record: Rows) -> Float:
    """Return the sum of all normal forces, (T,) N, averaged over the step before each row.

    This is the normal impulse of the control step that led to the row, over the sampling time.
    """
    pairs = record.pair_forces
    force = np.bincount(pairs["row"], pairs["normal_force"], len(record))
    return np.asarray(force[: len(record)])


def pair_name(scenario: Scenario, a: int, b: int) -> str:
    """Return the names of a pair of bodies, joined by a dash."""
    return " \N{EN DASH} ".join(plain_name(scenario.body_name(body)) for body in (a, b))


def _chosen(touches: NDArray[np.void], group: Index, count: int, most: int) -> Index:
    """Return the `most` pairs of the largest impulse, in the order of first contact."""
    impulse = np.bincount(group, touches["normal_force"], count)
    lasted = np.bincount(group, touches["until"] - touches["time"], count)
    first = np.full(count, np.inf)
    np.minimum.at(first, group, touches["time"])
    which = np.lexsort((first, -lasted, -impulse))[:most]
    return np.asarray(which[np.lexsort((which, first[which]))])


def _timeline(ax: Axes, record: Rows, pairs: Index, lines: Index) -> None:
    """Draw a bar for each time that a pair stayed in touch, coloured by its force.

    lines: of each of the record's `pair_forces`, from the top; -1 if it is not drawn.
    """
    import matplotlib as mpl
    from matplotlib.collections import PolyCollection

    touches, lines = record.pair_forces[lines >= 0], lines[lines >= 0]
    step, end = record.scenario.sampling_time, float(record.time[-1])
    width = max(end - float(record.time[0]), step) / TIME_CELLS
    cell = np.floor(touches["time"] / width).astype(np.intp)
    # A pair has one bar for each interval, even if it parted in between.
    keys, group = np.unique(np.column_stack([lines, cell]), axis=0, return_inverse=True)
    group = group.ravel()
    begin, until, force = (np.full(len(keys), v) for v in (np.inf, -np.inf, 0.0))
    np.minimum.at(begin, group, touches["time"])
    np.maximum.at(until, group, touches["until"])
    np.maximum.at(force, group, touches["normal_force"])
    until = np.maximum(until, begin + 1.5 * width)  # so that the shortest touch is visible
    middle = len(pairs) - 0.5 - keys[:, 0]
    low, high = middle - BAR_HEIGHT / 2, middle + BAR_HEIGHT / 2
    corners = [(begin, low), (until, low), (until, high), (begin, high)]
    bars: Any = np.moveaxis(np.array(corners), 2, 0)
    cmap = mpl.colors.ListedColormap(mpl.colormaps["YlOrRd"](np.linspace(0.35, 1.0, 256)))
    collection = PolyCollection(bars, edgecolor="face", linewidth=0.3, zorder=3)
    strongest = float(force.max())
    if strongest > 0:
        collection.set(cmap=cmap, array=force, clim=(0.0, strongest))
    else:
        collection.set(facecolor=MUTED, edgecolor=MUTED)
    ax.add_collection(collection)
    if strongest > 0:
        color_bar(ax, collection, "normal force [N]")
    name_rows(ax, [pair_name(record.scenario, a, b) for a, b in pairs], len(pairs))
