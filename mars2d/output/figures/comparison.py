"""Runs of one experiment with each physics: their drift apart, as numbers and as a figure."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass
from functools import cached_property, reduce
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError, counted
from mars2d.output.figures.extent import View
from mars2d.output.figures.figure import (
    INK,
    MUTED,
    dress,
    label,
    new_figure,
    paint_frame,
    save_drawing,
)
from mars2d.output.figures.legend import Entry, add_legend
from mars2d.output.figures.panels import caption, frame_panel, say
from mars2d.output.figures.style import SCREEN

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
    "ideal": "robots pass through each other",
}

COLORS = {"contact": INK, "stop": "#b45309", "ideal": "#6d28d9"}
"""The colours of titles and curves: dark, unlike those of robots."""

NO_DRIFT = 1e-6
"""The drift below which two runs agree, metres."""

LOG_RATIO = 30.0
"""The ratio of the two largest drifts from which the axis is logarithmic."""

FOOT_ROOM = 0.01
"""The start of a logarithmic axis, as a share of the smaller of the two largest drifts."""


@dataclass(frozen=True, eq=False)
class Drift:
    """The distance of each body between two runs, at the times that both runs have.

    time: (T,) seconds. distance: (T, k) metres between the two places of each body, robots first,
    then props.
    """

    time: Float
    distance: Float

    @classmethod
    def between(cls, first: Rows, second: Rows) -> Drift:
        """Return the drift of two runs of the same bodies."""
        rows = min(len(first), len(second))
        apart = _places(second)[:rows] - _places(first)[:rows]
        return cls(first.time[:rows], np.hypot(apart[:, 0], apart[:, 1]))

    @cached_property
    def max(self) -> Float:
        """The largest drift of any body, (T,) metres."""
        furthest: Float = self.distance.max(axis=1)
        return furthest

    @cached_property
    def mean(self) -> Float:
        """The mean drift of the bodies, (T,) metres."""
        mean: Float = self.distance.mean(axis=1)
        return mean


def _places(record: Rows) -> Float:
    """Return the positions of a run's bodies, (T, 2, k) metres."""
    return np.concatenate([record.pose[:, :2], record.prop_pose[:, :2]], axis=2)


@dataclass(frozen=True, eq=False)
class Comparison:
    """Three runs of an experiment with the same seed, which differ only in `Scenario.physics`.

    Raises InputError for runs without rows, or with different bodies or sampling times.
    """

    contact: Rows
    stop: Rows
    ideal: Rows

    def __post_init__(self) -> None:
        for mode, record in self.records.items():
            if len(record) == 0:
                raise InputError(f"{mode}: the record has no rows, so there is nothing to compare")
            if _places(record).shape[1:] != _places(self.contact).shape[1:]:
                raise InputError(f"{mode}: expected the same bodies as in the run with contact")
            if record.scenario.sampling_time != self.contact.scenario.sampling_time:
                raise InputError(f"{mode}: expected the sampling time of the run with contact")

    @property
    def records(self) -> dict[str, Rows]:
        """The runs by their physics."""
        return {"contact": self.contact, "stop": self.stop, "ideal": self.ideal}

    @cached_property
    def drifts(self) -> dict[str, Drift]:
        """The drift of the runs with "stop" and "ideal" from the run with "contact"."""
        return {mode: Drift.between(self.contact, self.records[mode]) for mode in MODES[1:]}

    @property
    def end(self) -> float:
        """The end of the longest run, seconds."""
        return max(float(record.time[-1]) for record in self.records.values())

    @cached_property
    def view(self) -> View:
        """The part of the plane that holds all three runs."""
        views = [View.of(record, len(record) - 1) for record in self.records.values()]
        return reduce(lambda a, b: a.union((b.xmin, b.xmax, b.ymin, b.ymax)), views)

    def save_figure(self, path: str | Path) -> Path:
        """Save the figure as .png, .pdf or .svg and return its path.

        Raises InputError for another suffix or a path that can't be written.
        """
        return save_drawing(lambda: plot_comparison(self), path, trim=False)


# -- the figure -----------------------------------------------------------------------------------

WIDTH, DRIFT = 11.0, 1.9
"""The width of the figure and the height of the drift, inches."""


def plot_comparison(comparison: Comparison) -> Figure:
    """Draw the paths of the three runs side by side at one scale, and the drift below them.

    Returns a matplotlib figure that pyplot does not know of.
    """
    _, height = comparison.view.inches(3.2, 4.2)
    figure = new_figure(WIDTH, height + DRIFT + 2.6)
    places, heights = [[*MODES], ["drift"] * len(MODES)], [height, DRIFT]
    axes = figure.subplot_mosaic(places, height_ratios=heights)  # type: ignore[arg-type]
    for mode, record in comparison.records.items():
        dress(axes[mode], record.scenario, comparison.view)
        label(axes[mode], beside=mode == MODES[0])
        _title(axes[mode], mode, record)
    plot_drift(comparison, axes["drift"])
    title = textwrap.shorten(comparison.contact.scenario.title, 80, placeholder=" …")
    seed = f"seed {comparison.contact.seed}"
    figure.suptitle(f"{title}, {seed}", fontsize=15, color=INK, parse_math=False)
    figure.draw_without_rendering()  # the scale is known from the layout
    for mode, record in comparison.records.items():
        paint_frame(axes[mode], record.frame(-1))
    return figure


def _title(ax: Axes, mode: str, record: Rows) -> None:
    """Write the physics, the number of collisions and the end of a run above its panel."""
    done = f"{counted(record.collisions, 'collision')}, {counted(len(record) - 1, 'step')}"
    said = [done, *textwrap.wrap(record.over_message, 44, max_lines=2, placeholder=" …")]
    color, pad = COLORS[mode], 9 + 13 * len(said)
    ax.set_title(mode, loc="left", fontsize=15, color=color, fontweight="bold", pad=pad)
    ax.annotate(
        "\n".join(said), (0, 1), xytext=(0, 6), xycoords="axes fraction",
        textcoords="offset points", fontsize=9.5, color=MUTED, parse_math=False,
    )  # fmt: skip


def plot_drift(comparison: Comparison, ax: Axes) -> None:
    """Draw the drift of "stop" and "ideal" from "contact" over time.

    The scale is linear, unless one of the two would lie flat on the axis.
    """
    peaks = [float(drift.max.max()) for drift in comparison.drifts.values()]
    _set_limits(ax, comparison.end, min(peaks), max(peaks))
    low = ax.get_ylim()[0]
    entries = []
    for mode, drift in comparison.drifts.items():
        for values, dash, width, name in (
            (drift.max, "-", 2.2, "max"),
            (drift.mean, "--", 1.5, "mean"),
        ):
            entries.append(Entry(f"{mode}, {name}", COLORS[mode], dash, width))
            shown = np.where(values < low, np.nan, values)
            ax.plot(
                drift.time, shown, color=COLORS[mode], linestyle=dash, linewidth=width,
                clip_on=False, marker="o", markersize=6.5, markeredgecolor="white",
                markeredgewidth=0.8, markevery=[-1], zorder=3, label=f"{mode}, {name}",
            )  # fmt: skip
    title = f"How far each {_body(comparison)} is from where contact puts it"
    ax.set_title(title, loc="left", fontsize=11, color=INK, pad=8)
    place = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0)}
    add_legend(ax, entries, SCREEN, ncols=len(entries), **place)
    if max(peaks) < NO_DRIFT:
        say(ax, "no drift: the three runs agree", SCREEN)


def _set_limits(ax: Axes, end: float, low: float, high: float) -> None:
    """Set the limits and the scale of a drift whose two largest ones are these, metres."""
    frame_panel(ax, SCREEN, [1, 2, 5, 10])
    ax.set_xlim(0, end if end > 0 else 1)
    ax.set_xlabel("time [s]", color=INK, fontsize=SCREEN.label)
    caption(ax, "drift", "m", SCREEN)
    if low > NO_DRIFT and high > LOG_RATIO * low:
        ax.set_yscale("log")
        ax.yaxis.set_major_formatter("{x:g}")
        ax.set_ylim(low * FOOT_ROOM, high * 2)
    else:
        ax.set_ylim(0, 1.06 * high if high >= NO_DRIFT else 1)


def _body(comparison: Comparison) -> str:
    """Return the kinds of bodies that drift, in words."""
    robots = len(comparison.contact.scenario.robots)
    return "robot" if comparison.drifts["stop"].distance.shape[1] == robots else "robot or prop"
