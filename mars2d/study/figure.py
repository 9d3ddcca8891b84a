"""Figures of studies: measures over a setting, with means, intervals and a dot for each run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError, counted
from mars2d.output.figures.figure import new_figure, save_drawing, show_in_notebooks
from mars2d.output.figures.legend import Entry
from mars2d.output.figures.panels import (
    PANEL,
    caption,
    checked_axes,
    frame_panel,
    letters_in,
    name_curves,
    say,
    set_span,
    short_number,
    shortened,
    size_of,
)
from mars2d.output.figures.style import DASHES, INK, MUTED, SMALL, curve_color, points
from mars2d.study.estimates import Estimate, estimates
from mars2d.study.layout import Layout, layout_of
from mars2d.study.statistics import confident
from mars2d.study.table import Table
from mars2d.study.text import in_words
from mars2d.study.units import with_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Float = NDArray[np.float64]

MAX_DOTS = 400
"""How many runs of a point are shown as dots, at most; of more runs, every k-th is shown."""

MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")

MARKER_SIZE = 0.6
"""The size of a marker, in heights of small text."""

LEGEND = 0.6
"""The longest name in a legend, as a share of the figure's width."""

TURNED_LETTERS = 28
"""The most letters of a value's name that is turned."""

PANEL_HEIGHT = 1.5
"""The height of a panel, in heights of a panel over time."""


def plot_study(
    table: Table,
    axes: Sequence[Axes] | None = None,
    *,
    confidence: float = 0.95,
    x: str | None = None,
) -> list[Axes]:
    """Draw the measures of a study over a setting, one panel a mean or share; return the axes.

    Means and shares have intervals of the given confidence, and each run is a faint dot. A mean of
    only some runs, because others have no number, is hollow; the panel below shows their share.
    x: the setting along the axis, by default the first with several numbers; each combination of
    the others is a line. axes: one for each panel; by default those of a new figure.
    Raises InputError if there is nothing to draw, or too much.
    """
    confidence = confident(confidence)
    shown = estimates(table, both=False)
    if not table.results or not shown:
        what = "measures" if table.results else "runs"
        raise InputError(f"figure: the study of {table.experiment} has no {what}")
    layout = layout_of(table, x)
    drawing = _Drawing(table, layout, confidence)
    panels = _panels(axes, shown)
    for ax, estimate in zip(panels, shown, strict=True):
        _dress(ax, layout)
        drawing.panel(ax, estimate)
        caption(ax, estimate.label, "%" if estimate.share else estimate.unit)
        if axes is not None or ax is panels[-1]:
            _name_axis(ax, table, layout)
        else:
            ax.tick_params(labelbottom=False)
    kinds = " and ".join(sorted({"shares" if each.share else "means" for each in shown}))
    title = f"{table.experiment}: {kinds} with {100 * confidence:.4g} % intervals"
    if table.failed:
        title += f", {counted(len(table.failed), 'run')} failed"
    name_curves(panels[0], title, drawing.entries(panels[0], shown))
    if axes is None:
        show_in_notebooks(*panels)
    return panels


def save_study_figure(table: Table, path: str | Path, *, confidence: float = 0.95) -> Path:
    """Save the figure of `plot_study` as ``.png``, ``.pdf`` or ``.svg`` and return its path.

    The same table gives the same bytes. Raises InputError as `plot_study` does, for any other
    suffix, and if the file can't be written.
    """

    def draw() -> Any:
        return plot_study(table, confidence=confidence)[0].figure

    return save_drawing(draw, path)


# -- panels ----------------------------------------------------------------------------------------


def _panels(axes: Sequence[Axes] | None, shown: Sequence[Estimate]) -> list[Axes]:
    """Return the axes of the panels: those given, or those of a new figure."""
    tall = len(shown)
    if axes is not None:
        return list(checked_axes(axes, tall, f"({', '.join(each.label for each in shown)})"))
    figure = new_figure(7.0, tall * PANEL_HEIGHT * PANEL + 0.9)
    return list(figure.subplots(tall, 1, sharex=True, squeeze=False)[:, 0])


def _dress(ax: Axes, layout: Layout) -> None:
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
    """Write each value below its tick, turned where there is little room."""
    scaled = layout.scaled()
    names = [in_words(value) for value in layout.values] or [""]
    letters = letters_in(size_of(ax)[0] / len(names), points(SMALL))
    turned: dict[str, Any] = {}
    if max(map(len, names)) >= letters:
        names = [shortened(name, TURNED_LETTERS) for name in names]
        turned = {"rotation": 35, "ha": "right", "rotation_mode": "anchor"}
    places = 10**scaled if layout.logarithmic else scaled
    ax.set_xticks(places.tolist(), names, parse_math=False, **turned)


def _name_axis(ax: Axes, table: Table, layout: Layout) -> None:
    """Label the axis with the setting along it."""
    name = "all runs"
    if layout.axis is not None:
        setting = table.settings[layout.axis]
        name = with_unit(setting, table.unit(setting))
    text = shortened(name, letters_in(size_of(ax)[0], points()))
    ax.set_xlabel(text, color=INK, fontsize=points(), parse_math=False)


@dataclass(frozen=True)
class _Drawing:
    """How the estimates of a study are drawn."""

    table: Table
    layout: Layout
    confidence: float

    def panel(self, ax: Axes, estimate: Estimate) -> None:
        """Draw an estimate into its panel."""
        found, spans = self.table.points(), [np.empty(0)]
        for name, line in self.layout.lines.items():
            places = np.array([self.layout.place(point, name) for point in line])
            runs = [estimate.values(found[point]) for point in line]
            if not estimate.share:
                spans += [self._dots(ax, places, runs, self._entry(name))]
            spans += [self._means(ax, places, runs, self._entry(name), estimate)]
        seen = np.concatenate(spans)
        seen = seen[np.isfinite(seen)]
        if estimate.share:
            ax.set_ylim(-6, 106)
            few = size_of(ax)[1] < 5 * 2.4 * points(SMALL)
            ax.set_yticks([0, 50, 100] if few else [0, 25, 50, 75, 100])
        else:
            set_span(ax, seen.min(initial=np.inf), seen.max(initial=-np.inf))
        if not len(seen):
            ax.set_yticks([])
            say(ax, "nothing was measured")

    def _dots(self, ax: Axes, places: Float, runs: Sequence[Float], entry: Entry) -> Float:
        """Draw each run as a dot, and return the runs' values."""
        for place, values in zip(places, runs, strict=True):
            kept = values[np.isfinite(values)]
            kept = kept[:: -(-len(kept) // MAX_DOTS) or 1]
            ax.plot(
                np.full(len(kept), place), kept, linestyle="none", marker="o", color=entry.color,
                markersize=0.35 * points(SMALL), markeredgewidth=0, alpha=0.22, zorder=2.2,
            )  # fmt: skip
        return np.concatenate(runs)

    def _means(
        self, ax: Axes, places: Float, runs: Sequence[Float], entry: Entry, estimate: Estimate
    ) -> Float:
        """Draw means or shares with their intervals, and return the bounds."""
        scale, small = 100.0 if estimate.share else 1.0, points(SMALL)
        found = [estimate.interval(values, self.confidence) for values in runs]
        mean, low, high = scale * np.array([(each.mean, each.low, each.high) for each in found]).T
        joined = np.isfinite(mean)
        ax.errorbar(
            places, mean, np.nan_to_num([mean - low, high - mean]), linestyle="none",
            color=entry.color, elinewidth=0.9 * entry.width, capsize=0.35 * small,
            capthick=0.9 * entry.width, zorder=3,
        )  # fmt: skip
        if self.layout.numeric:
            order = np.argsort(places[joined])
            ax.plot(
                places[joined][order], mean[joined][order], color=entry.color,
                linestyle=entry.dash, linewidth=entry.width, alpha=0.6, zorder=2.8,
            )  # fmt: skip
        for place, value, each, values in zip(places, mean, found, runs, strict=True):
            hollow = estimate.some and each.count < len(values)
            ax.plot(
                [place], [value], linestyle="none", marker=entry.marker, color=entry.color,
                markerfacecolor="white" if hollow else entry.color, markersize=MARKER_SIZE * small,
                markeredgewidth=entry.width, zorder=3.2, clip_on=False,
            )  # fmt: skip
        return np.concatenate([mean, low, high])

    def _entry(self, name: str) -> Entry:
        """Return a line's colour, line style and marker, each of which identifies it."""
        index = [*self.layout.lines].index(name)
        dash, marker = DASHES[index % len(DASHES)], MARKERS[index % len(MARKERS)]
        return Entry(name, curve_color(index), dash, 1.3, marker)

    def entries(self, above: Axes, shown: Sequence[Estimate]) -> list[Entry]:
        """Return the entries of the legend: several lines, and the meaning of hollow markers."""
        lines, wide = [*self.layout.lines], above.figure.bbox.width * 72 / above.figure.dpi
        letters = letters_in(LEGEND * wide, points(SMALL))
        entries = [self._entry(name) for name in (lines if len(lines) > 1 else ())]
        entries = [each._replace(name=shortened(each.name, letters)) for each in entries]
        if not self.layout.numeric:
            entries = [each._replace(dash="") for each in entries]
        means = [each for each in shown if each.some]
        runs = [mean.values(each) for mean in means for each in self.table.points().values()]
        if any(0 < np.isfinite(values).sum() < len(values) for values in runs):
            hollow = Entry("mean of some runs alone", MUTED, "", 1.3, "o", hollow=True)
            entries.append(hollow)
        return entries
