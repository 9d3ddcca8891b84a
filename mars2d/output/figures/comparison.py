"""Runs of one experiment with each physics: their drift apart, as numbers and as a figure."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import counted
from mars2d.output.figures.extent import View
from mars2d.output.figures.figure import dress, label, new_figure, paint_frame
from mars2d.output.figures.legend import Entry, add_legend
from mars2d.output.figures.panels import caption, frame_panel, say
from mars2d.output.figures.style import INK, MUTED, points

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from mars2d.record.rows import Rows

Float = NDArray[np.float64]

MODES = ("contact", "stop", "ideal")
"""The values of Scenario.physics, in the order of the panels."""

MEANINGS = {
    "contact": "forces push, turn and slow",
    "stop": "a robot stops before it overlaps",
    "ideal": "bodies pass through each other",
}
COUNTED = {"contact": "collision", "stop": "stop", "ideal": "overlap"}
"""What begins where two bodies meet."""

COLORS = {"contact": INK, "stop": "#b45309", "ideal": "#6d28d9"}
"""The colours of titles and curves: dark, unlike those of robots."""

CURVES = (("max", "-", 2.2), ("mean", "--", 1.5))
"""The curves of a drift: its attribute, the style of the line, and its width, points."""

NO_DRIFT = 1e-6
"""The drift below which two runs agree, metres."""


@dataclass(frozen=True, eq=False)
class Drift:
    """How far the bodies of two runs are apart, at the times that both runs have.

    time: (T,) seconds. max, mean: (T,) metres, of the distances between the two places of a body,
    over robots and props.
    """

    time: Float
    max: Float
    mean: Float

    @classmethod
    def between(cls, first: Rows, second: Rows) -> Drift:
        """Return the drift of two runs of the same bodies."""
        rows = min(len(first), len(second))
        one, other = (run.all_poses[:rows, :2] for run in (first, second))
        distance = np.hypot(*(other - one).swapaxes(0, 1))
        return cls(first.time[:rows], distance.max(axis=1), distance.mean(axis=1))


def drifts(records: Mapping[str, Rows]) -> dict[str, Drift]:
    """Return the drift of the runs with "stop" and "ideal" from the run with "contact".

    records: runs of an experiment with the same seed, by their physics.
    """
    return {mode: Drift.between(records["contact"], records[mode]) for mode in MODES[1:]}


# -- the figure -----------------------------------------------------------------------------------

WIDTH, DRIFT = 11.0, 1.9
"""The width of the figure and the height of the drift, inches."""


def plot_comparison(records: Mapping[str, Rows]) -> Figure:
    """Draw the paths of the three runs side by side at one scale, and the drift below them.

    records: runs of an experiment with the same seed, by their physics. Returns a matplotlib figure
    that pyplot does not know of.
    """
    views = [View.of(record, len(record) - 1) for record in records.values()]
    view = reduce(View.union, views)
    _, height = view.inches(3.2, 4.2)
    figure = new_figure(WIDTH, height + DRIFT + 2.6)
    places, heights = [[*MODES], ["drift"] * len(MODES)], [height, DRIFT]
    axes = figure.subplot_mosaic(places, height_ratios=heights)  # type: ignore[arg-type]
    for mode, record in records.items():
        dress(axes[mode], record.scenario, view)
        label(axes[mode], beside=mode == MODES[0])
        _title(axes[mode], mode, record)
    plot_drift(records, axes["drift"])
    first = records["contact"]
    title = textwrap.shorten(first.scenario.title, 80, placeholder=" …")
    seed = f"seed {first.seed}"
    figure.suptitle(f"{title}, {seed}", fontsize=15, color=INK, parse_math=False)
    figure.draw_without_rendering()  # the scale is known from the layout
    for mode, record in records.items():
        paint_frame(axes[mode], record.frame(-1))
    return figure


def _title(ax: Axes, mode: str, record: Rows) -> None:
    """Write the physics, the number of collisions and the end of a run above its panel."""
    done = f"{counted(record.collisions, COUNTED[mode])}, {counted(record.steps, 'step')}"
    said = [done, *textwrap.wrap(record.over_message, 44, max_lines=2, placeholder=" …")]
    color, pad = COLORS[mode], 9 + 13 * len(said)
    ax.set_title(mode, loc="left", fontsize=15, color=color, fontweight="bold", pad=pad)
    ax.annotate(
        "\n".join(said), (0, 1), xytext=(0, 6), xycoords="axes fraction",
        textcoords="offset points", fontsize=9.5, color=MUTED, parse_math=False,
    )  # fmt: skip


def plot_drift(records: Mapping[str, Rows], ax: Axes) -> None:
    """Draw the drift of "stop" and "ideal" from "contact" over time."""
    found = drifts(records)
    most = max(float(drift.max.max()) for drift in found.values())
    frame_panel(ax, [1, 2, 5, 10])
    end = max(float(record.time[-1]) for record in records.values())
    ax.set_xlim(0, end if end > 0 else 1)
    ax.set_xlabel("time [s]", color=INK, fontsize=points())
    caption(ax, "drift", "m")
    ax.set_ylim(0, 1.06 * most if most >= NO_DRIFT else 1)
    entries = []
    for mode, drift in found.items():
        for name, dash, width in CURVES:
            entries.append(Entry(f"{mode}, {name}", COLORS[mode], dash, width))
            ax.plot(
                drift.time, getattr(drift, name), color=COLORS[mode], linestyle=dash,
                linewidth=width, clip_on=False, marker="o", markersize=6.5, markeredgecolor="white",
                markeredgewidth=0.8, markevery=[-1], zorder=3, label=f"{mode}, {name}",
            )  # fmt: skip
    body = "robot or prop" if records["contact"].scenario.props else "robot"
    title = f"How far each {body} is from where contact puts it"
    ax.set_title(title, loc="left", fontsize=11, color=INK, pad=8)
    place = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0)}
    add_legend(ax, entries, ncols=len(entries), **place)
    if most < NO_DRIFT:
        say(ax, "no drift: the three runs agree")
