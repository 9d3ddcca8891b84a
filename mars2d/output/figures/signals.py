"""Figures of columns of a record over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mars2d.core.description import real
from mars2d.core.errors import InputError
from mars2d.output.figures.extent import PANEL_LIMIT, check_rows
from mars2d.output.figures.figure import LEGEND_LIMIT
from mars2d.output.figures.legend import BESIDE, Entry, add_legend, plain_name
from mars2d.output.figures.panels import (
    caption,
    curve,
    name_curves,
    name_rows,
    panels,
    say,
    set_span,
    width_of,
)
from mars2d.output.figures.style import INK, curve_color, robot_curve
from mars2d.output.signals import Signal, chosen_robots, signals, without_nothing

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from mars2d.record.rows import Rows

Float = NDArray[np.float64]

DEFAULT = ("x", "y", "theta", "command")

LEAST_SPANS = {"effort": (0.0, 1.0), "speed": (0.0, 0.0), "clearance": (0.0, 0.05)}
"""The values that the axis of a column has at least; bodies at rest overlap slightly."""

ROWS = 16
"""The most bars, one below the other, that have names."""


def plot_signals(
    record: Rows,
    columns: Sequence[str | Sequence[str]] = (),
    robots: Sequence[str | int] | None = None,
    axes: Sequence[Axes] | None = None,
    *,
    start: float | None = None,
    end: float | None = None,
) -> list[Axes]:
    """Draw columns of a record over time, one panel each, and return the axes.

    columns: "x", "y" [m], "theta" [rad], as recorded, not wrapped; "speed" [m/s], the mean since
    the row before, from the poses; "command", both parts, or one of them, as "command.0" or, where
    all drives agree on its name, "command.v"; "effort"; "force" [N] and "impulse" [N s], the net
    ones of contacts in the control step before; "distance.NAME" [m], to a body; the name of a
    sensor, or parts of its reading, as "range_finder.90" (a beam) or "imu.ax" (a quantity);
    "prop.x", "prop.y", "prop.theta", "prop.speed"; "energy" [J], that of all bodies and the work of
    what has made it, "kinetic" of each body, "momentum" of all, "momentum.each" of each. By default
    x, y, theta and the command. robots: those wanted, by name or index; None: all. axes: one for
    each panel; by default those of a new figure. start, end: seconds, the part of the run that is
    drawn; by default all of it.

    Flags are bars where they are True. nan and inf are gaps. Of readings of many numbers, such as
    scans, parts can be drawn.

    Raises InputError for a record without rows, and for unknown columns, robots and times.
    """
    check_rows(record)
    rows = _rows(record, start, end)
    names = [columns] if isinstance(columns, str) else list(columns or DEFAULT)
    found = [replace(s, values=s.values[rows]) for s in signals(record, names, robots)]
    team = len(record.scenario.robots)
    bodies = [body for signal in found for body in signal.bodies]
    if robots is not None and all(body >= team for body in bodies):
        raise InputError("robots: all columns that were chosen are of props")
    order = chosen_robots(record, robots)
    return draw_signals(record, found, axes, rows=rows, order=order)


def draw_signals(
    record: Rows,
    found: Sequence[Signal],
    axes: Sequence[Axes] | None = None,
    *,
    rows: slice = slice(None),
    order: Sequence[int] | None = None,
) -> list[Axes]:
    """Draw signals of some rows of a record over time, and return the axes, as `plot_signals` does.

    order: robots, as the legend has them; by default that of the scenario. Raises InputError for a
    record without rows.
    """
    check_rows(record)
    robots = chosen_robots(record, order)
    if len(found) > PANEL_LIMIT // 4:
        raise InputError(
            f"columns: they need {len(found)} panels, and a figure has at most {PANEL_LIMIT // 4}: "
            "choose some columns, or some robots"
        )
    own = axes is None
    axes = panels(record, axes, [signal.name for signal in found], rows=rows)
    for ax, signal in zip(axes, found, strict=True):
        _draw(ax, record, rows, signal)
    name_curves(axes[0], record.scenario.title, _entries(record, robots, found))
    if own:
        axes[0].figure.align_ylabels(axes)
    return axes


def _rows(record: Rows, start: float | None, end: float | None) -> slice:
    """Return the rows from start to end, both inclusive, seconds."""
    last = float(record.time[-1])
    first = 0.0 if start is None else real("start", start, "seconds")
    final = last if end is None else real("end", end, "seconds")
    slack = 1e-6 * record.scenario.sampling_time  # times are rounded
    low, high = np.searchsorted(record.time, [first - slack, final + slack])
    if not (0 <= first <= final <= last + slack and low < high):
        raise InputError(
            f"signals from {first:g} to {final:g} s: expected a part of the run, which goes from 0 "
            f"to {last:g} s"
        )
    return slice(int(low), int(high))


def _draw(ax: Axes, record: Rows, rows: slice, signal: Signal) -> None:
    times = record.time[rows]
    signal = without_nothing(signal)
    values = signal.values.reshape(len(times), -1)
    each = values.shape[1] // max(1, len(signal.bodies))
    if values.dtype == np.bool_:
        _flags(ax, record, times, signal, values)
        return
    caption(ax, signal.name, signal.unit)
    many = values.shape[1]
    entries = _own_entries(signal)
    add_legend(ax, entries, **BESIDE)
    entries = entries or [_entry(record, signal.bodies[k // each], many) for k in range(many)]
    for k, entry in enumerate(entries):
        level = 3.0 if entry.dash == "-" else 3.1
        curve(
            ax, times, values[:, k], entry, signal.held, many=many, wraps=signal.wraps, level=level
        )
    finite = values[np.isfinite(values)]
    if not len(finite):
        say(ax, "nothing was measured")
    low, high = LEAST_SPANS.get(signal.name.split(".")[-1], (np.inf, -np.inf))
    set_span(ax, min(low, finite.min(initial=np.inf)), max(high, finite.max(initial=-np.inf)))


def _entry(record: Rows, body: int, many: int) -> Entry:
    """Return the style of the curve of a robot or a prop, and its name in a legend."""
    width = width_of(many, LEGEND_LIMIT)
    scenario = record.scenario
    robots = len(scenario.robots)
    name = plain_name(scenario.bodies[body].name)
    if body < robots:
        color, dash = robot_curve(scenario, body)
        return Entry(name, color, dash if many <= LEGEND_LIMIT else "-", width)
    return Entry(name, curve_color(body), "-", width)


def _own_entries(signal: Signal) -> list[Entry]:
    """Return the styles and names of the curves of a signal that belong to no body."""
    width = width_of(len(signal.curves), LEGEND_LIMIT)
    colors = [INK, *(curve_color(k) for k in range(len(signal.curves)))]
    # Dashes, so that curves that coincide can both be seen.
    return [
        Entry(name, colors[k], "--" if k % 2 else "-", width)
        for k, name in enumerate(signal.curves)
    ]


def _entries(record: Rows, robots: tuple[int, ...], shown: Sequence[Signal]) -> list[Entry]:
    """Return the legend of the bodies with curves, robots first, or none for too many."""
    curves = [s for s in shown if s.values.dtype != np.bool_]
    drawn = {body for signal in curves for body in signal.bodies}
    order = [robot for robot in robots if robot in drawn]
    order += sorted(body for body in drawn if body >= len(record.scenario.robots))
    return [_entry(record, b, 1) for b in order] if len(order) <= LEGEND_LIMIT else []


def _flags(ax: Axes, record: Rows, times: Float, signal: Signal, values: Float) -> None:
    """Draw bars where flags (T, rows) are True, one row each, the first on top."""
    count = values.shape[1]
    each = count // max(1, len(signal.bodies))
    step = record.scenario.sampling_time
    names = []
    for k in range(count):
        body = signal.bodies[k // each]
        names.append(record.scenario.bodies[body].name + (f" {k % each}" if each > 1 else ""))
        edges = np.diff(np.concatenate([[False], values[:, k], [False]]).astype(np.int8))
        first, after = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
        color = record.scenario.colors[body]
        bars = list(zip(times[first].tolist(), (step * (after - first)).tolist(), strict=True))
        ax.broken_barh(bars, (count - 0.85 - k, 0.7), facecolor=color, linewidth=0, zorder=3)
    caption(ax, signal.name, "")
    name_rows(ax, [plain_name(n) for n in names] if count <= ROWS else [], count)
    if not values.any():
        say(ax, "never")
