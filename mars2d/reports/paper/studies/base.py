"""What the studies share: charts in the looks of the pictures, runs, and rows of records."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from mars2d.output.figures.figure import GRID, INK, MUTED, new_figure
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.prediction import Prediction
from mars2d.world.loop import simulate
from mars2d.world.record import Record

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure as Drawing
    from numpy.typing import ArrayLike

MEASURED, BAD = "#0072b2", "#b42318"
"""The colours of measurements, and of a limit."""

OTHERS = ("#d55e00", "#0072b2", "#009e73")
"""The colours of several measured curves."""

FRAME = "#c3cad2"
"""The colour of the axes."""


@dataclass(frozen=True)
class Study:
    """A chart of numbers from one or several runs.

    title, shows, alt: the chart's title, caption and alternative text. draw: returns a new drawing
    at each call. predictions: those of formulas about the numbers. columns: the numbers.
    """

    title: str
    shows: str
    alt: str
    draw: Callable[[], Drawing]
    predictions: tuple[Prediction, ...] = ()
    columns: Mapping[str, Sequence[float]] = field(default_factory=dict)


def charts(
    count: int = 1, *, width: float = 7.6, height: float = 3.0
) -> tuple[Drawing, list[Axes]]:
    """Return a figure of several charts side by side, and their axes.

    width, height: of the whole figure, inches. The figure is not known to pyplot.
    """
    figure = new_figure(width, height)
    axes = figure.subplots(1, count, squeeze=False).ravel().tolist()
    for ax in axes:
        ax.grid(visible=True, color=GRID, linewidth=0.6)
        ax.set_axisbelow(True)
        ax.tick_params(which="both", length=0, labelsize=9, labelcolor=MUTED)
        ax.spines[:].set(color=FRAME, linewidth=0.8)
        ax.spines[["top", "right"]].set_visible(False)
    return figure, axes


def name(ax: Axes, title: str, x: str, y: str) -> None:
    """Give a chart its title, labels of its axes, and a legend in a line above it."""
    ax.set_xlabel(x, color=INK, fontsize=10)
    ax.set_ylabel(y, color=INK, fontsize=10)
    ax.set_title(title, loc="left", fontsize=11, color=INK, pad=24)
    handles, labels = ax.get_legend_handles_labels()
    if handles:
        legend = ax.legend(
            handles, labels, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=len(labels),
            frameon=False, fontsize=8.5, labelcolor=INK, borderaxespad=0.2, handlelength=1.8,
            columnspacing=1.0, handletextpad=0.4, borderpad=0.0,
        )  # fmt: skip
        legend.set_in_layout(False)


def from_zero(ax: Axes, time: ArrayLike, values: ArrayLike, title: str, unit: str) -> None:
    """Draw measured values over time [s] on an axis from zero, with title and labels."""
    ax.plot(time, values, color=MEASURED, linewidth=1.8)
    ax.set_ylim(0, None)
    name(ax, title, "time [s]", unit)


def logarithmic(axis: Axis) -> None:
    """Make an axis logarithmic, labelled with plain numbers 1, 2 and 5 times powers of ten."""
    from matplotlib.ticker import LogLocator, NullLocator

    across = axis is axis.axes.xaxis
    axis.axes.set(**{"xscale" if across else "yscale": "log"})
    low, high = axis.get_view_interval()
    few = high < 200 * low
    axis.set_major_locator(LogLocator(subs=(1, 2, 5) if few else (1,), numticks=12))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter("{x:g}")


# -- runs and records

ROWS = 200
"""The number of points of a curve over time if each needs a Voronoi diagram."""


def run(experiment: str, options: Mapping[str, Any], seed: int) -> Record:
    """Return the record of an example with other options."""
    return simulate(open_experiment(experiment, options, seed=seed)).record


def some_rows(record: Record) -> list[int]:
    """Return evenly spread rows of a record, including the first and the last."""
    rows: list[int] = np.unique(np.linspace(0, len(record) - 1, ROWS).round().astype(int)).tolist()
    return rows


def addon(record: Record, kind: type) -> Any:
    """Return the scenario's add-on of a class."""
    return next(each for each in record.scenario.addons if isinstance(each, kind))


def top_speed(record: Record, robot: int) -> float:
    """Return the speed limit of a robot, m/s."""
    drive: Any = record.scenario.robots[robot].drive
    return float(drive.max_linear_speed)
