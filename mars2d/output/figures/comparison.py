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
    paint_row,
    save_drawing,
)

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

WIDTH = 11.0
LEFT, RIGHT, GAP = 0.75, 0.25, 0.3
HEAD, TITLES, LABELS, DRIFT, FOOT = 0.55, 0.95, 0.95, 1.9, 0.6
"""The heights of the heading, the titles, the gap for labels, the drift and the foot, inches."""


def plot_comparison(comparison: Comparison) -> Figure:
    """Draw the paths of the three runs side by side at one scale, and the drift below them.

    Returns a matplotlib figure that pyplot does not know of.
    """
    column = (WIDTH - LEFT - RIGHT - 2 * GAP) / 3
    width, height = comparison.view.inches(column, 1.3 * column)
    tall = HEAD + TITLES + height + LABELS + DRIFT + FOOT
    figure = new_figure(WIDTH, tall, layout=None)

    def place(left: float, bottom: float, wide: float, high: float) -> Axes:
        return figure.add_axes((left / WIDTH, bottom / tall, wide / WIDTH, high / tall))

    _head(figure, comparison)
    for k, (mode, record) in enumerate(comparison.records.items()):
        left = LEFT + k * (column + GAP)
        ax = place(left + (column - width) / 2, FOOT + DRIFT + LABELS, width, height)
        dress(ax, record.scenario, comparison.view)
        label(ax, beside=k == 0)
        _title(figure, (left + column / 2) / WIDTH, 1 - HEAD / tall, mode, record)
        paint_row(ax, record, len(record) - 1)
    plot_drift(comparison, place(LEFT, FOOT, WIDTH - LEFT - RIGHT, DRIFT))
    return figure


def _head(figure: Figure, comparison: Comparison) -> None:
    """Write the experiment's title and the seed across the top."""
    wide, tall = figure.get_size_inches()
    title = textwrap.shorten(comparison.contact.scenario.title, 80, placeholder=" …")
    level = 1 - 0.3 / tall
    figure.text(
        LEFT / wide, level, title, fontsize=15, fontweight="bold", color=INK, va="center",
        parse_math=False,
    )  # fmt: skip
    figure.text(
        1 - RIGHT / wide, level, f"seed {comparison.contact.seed}", fontsize=11, color=MUTED,
        va="center", ha="right",
    )  # fmt: skip


def _title(figure: Figure, x: float, y: float, mode: str, record: Rows) -> None:
    """Write the physics, the number of collisions and the end of a run above its panel."""
    tall = figure.get_size_inches()[1]
    done = f"{counted(record.collisions, 'collision')}, {counted(len(record) - 1, 'step')}"
    ended = textwrap.fill(record.over_message, 44, max_lines=2, placeholder=" …")
    lines = [
        (0.20, mode, 15, COLORS[mode], "bold", "baseline"),
        (0.46, done, 11, INK, "normal", "baseline"),
        (0.56, ended, 9.5, MUTED, "normal", "top"),
    ]
    for down, text, size, color, weight, level in lines:
        figure.text(
            x, y - down / tall, text, fontsize=size, color=color, fontweight=weight,
            ha="center", va=level, linespacing=1.25, parse_math=False,
        )  # fmt: skip


def plot_drift(comparison: Comparison, ax: Axes) -> list[Float]:
    """Draw the drift of "stop" and "ideal" from "contact" over time.

    The scale is linear, unless one of the two would lie flat on the axis. Returns the curves, each
    (T, 2) in seconds and metres: the largest and the mean drift of "stop", then of "ideal".
    """
    peaks = {mode: float(drift.max.max()) for mode, drift in comparison.drifts.items()}
    _dress_drift(ax, comparison.end, list(peaks.values()))
    low = ax.get_ylim()[0]
    curves = []
    for mode, drift in comparison.drifts.items():
        color = COLORS[mode]
        for values, style, width, name in (
            (drift.max, "-", 2.2, "max"),
            (drift.mean, (0, (3, 1.4)), 1.5, "mean"),
        ):
            shown = np.where(values < low, np.nan, values)
            ax.plot(
                drift.time, shown, color=color, linestyle=style, linewidth=width, clip_on=False,
                marker="o", markersize=6.5, markeredgecolor="white", markeredgewidth=0.8,
                markevery=[-1], zorder=3, label=f"{mode}, {name}",
            )  # fmt: skip
            curves.append(np.column_stack([drift.time, shown]))
    ax.set_title(
        f"How far each {_body(comparison)} is from where contact puts it",
        loc="left", fontsize=11, color=INK, pad=8,
    )  # fmt: skip
    legend = ax.legend(
        loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=4, frameon=False, fontsize=10,
        labelcolor=INK, borderaxespad=0.3, handlelength=2.0, columnspacing=1.4, handletextpad=0.5,
    )  # fmt: skip
    for line in legend.get_lines():
        line.set_marker("")
    if max(peaks.values()) < NO_DRIFT:
        ax.text(
            0.5, 0.5, "no drift: the three runs agree", transform=ax.transAxes,
            ha="center", va="center", fontsize=11, color=MUTED,
        )  # fmt: skip
    return curves


def _dress_drift(ax: Axes, end: float, peaks: list[float]) -> None:
    """Set the limits, the scale and the grid of the drift."""
    low, high = min(peaks), max(peaks)
    ax.set_xlim(0, end if end > 0 else 1)
    if high < NO_DRIFT:
        ax.set_ylim(0, 1)
        ax.set_yticks([0])
    elif low > NO_DRIFT and high > LOG_RATIO * low:
        ax.set_yscale("log")
        ax.yaxis.set_major_formatter("{x:g}")
        ax.set_ylim(low * FOOT_ROOM, high * 2)
    else:
        ax.set_ylim(0, high * 1.06)
    ax.grid(visible=True, color="#e6e9ed", linewidth=0.6)
    ax.set_axisbelow(True)
    ax.tick_params(which="both", length=0, labelsize=9, labelcolor=MUTED)
    ax.spines[:].set(color="#c3cad2", linewidth=0.8)
    ax.spines[["top", "right"]].set_visible(False)
    ax.set_xlabel("time [s]", color=INK, fontsize=10)
    ax.set_ylabel("drift [m]", color=INK, fontsize=10)


def _body(comparison: Comparison) -> str:
    """Return the kinds of bodies that drift, in words."""
    robots = len(comparison.contact.scenario.robots)
    return "robot" if comparison.drifts["stop"].distance.shape[1] == robots else "robot or prop"
