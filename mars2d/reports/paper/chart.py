"""Charts beside the pictures of the plane, in the same looks: measured solid, theory dashed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mars2d.core.scene import THEORY
from mars2d.output.figures.figure import GRID, INK, MUTED, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

__all__ = ["BAD", "MEASURED", "OTHERS", "THEORY", "charts", "from_zero", "logarithmic", "name"]

MEASURED, BAD = "#0072b2", "#b42318"
"""Colours: of what was measured, and of what is told from that and from theory."""

OTHERS = ("#d55e00", "#0072b2", "#009e73")
"""Colours of several curves that were measured."""

LINE = "#c3cad2"


def charts(count: int = 1, *, width: float = 7.6, height: float = 3.0) -> tuple[Figure, list[Axes]]:
    """Return a figure of some charts beside each other, and their axes.

    width, height: of the whole figure, inches. pyplot does not know of it.
    """
    figure = new_figure(width, height)
    axes = figure.subplots(1, count, squeeze=False).ravel().tolist()
    for ax in axes:
        ax.grid(visible=True, color=GRID, linewidth=0.6)
        ax.set_axisbelow(True)
        ax.tick_params(which="both", length=0, labelsize=9, labelcolor=MUTED)
        ax.spines[:].set(color=LINE, linewidth=0.8)
        ax.spines[["top", "right"]].set_visible(False)
    return figure, axes


def name(ax: Axes, title: str, x: str, y: str) -> None:
    """Name what a chart shows: its title, its axes, and its curves in a line above it."""
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
    """Draw what was measured over time [s], from zero on, and name it."""
    ax.plot(time, values, color=MEASURED, linewidth=1.8)
    ax.set_ylim(0, None)
    name(ax, title, "time [s]", unit)


def logarithmic(axis: Axis) -> None:
    """Make an axis logarithmic, with 1, 2 and 5 times each power of ten as plain numbers."""
    from matplotlib.ticker import LogLocator, NullLocator

    across = axis is axis.axes.xaxis
    axis.axes.set(**{"xscale" if across else "yscale": "log"})
    low, high = axis.get_view_interval()
    few = high < 200 * low
    axis.set_major_locator(LogLocator(subs=(1, 2, 5) if few else (1,), numticks=12))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter("{x:g}")
