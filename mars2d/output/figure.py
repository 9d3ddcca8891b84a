"""Figures of records with matplotlib: the paths, or snapshots of them, for reports and papers."""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from io import BytesIO
from math import ceil, log
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d import frame as seen
from mars2d.errors import InputError, shown
from mars2d.forces import FORCE, LABEL_SIZE, force_scale, forces, in_newtons, round_force
from mars2d.geometry import grid_step
from mars2d.links import messages
from mars2d.output.artists import paint, points_per_metre
from mars2d.output.extent import View
from mars2d.scene import Line, Polygon, Scene, Shape, Text, faded

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from mars2d.frame import Frame
    from mars2d.record import Record
    from mars2d.scenario import Scenario

__all__ = [
    "SUFFIXES",
    "View",
    "dress",
    "label",
    "new_figure",
    "paint_row",
    "plot_paths",
    "plot_snapshots",
    "save_drawing",
    "save_figure",
]

Float = NDArray[np.float64]
Layout = Literal["constrained"] | None

SUFFIXES = (".png", ".pdf", ".svg")
"""The formats of `save_figure`."""

LEGEND_LIMIT = 8
"""With more robots than this there is no legend: base colours recur."""

PANEL_LIMIT = 64
NAME_LIMIT = 24

INK = "#1f2933"
MUTED = "#616e7c"
GRID = "#e6e9ed"

WORKSPACE = 1.0
"""Its level in matplotlib's order of drawing: the grid lies above it, at 1.5, the shapes at 2."""

TICK_SPACING = 28.0  # points between ticks, at least


def plot_paths(record: Record, ax: Axes | None = None) -> Axes:
    """Draw the paths of a record: initial poses hollow, final poses filled, obstacles and grid.

    ax: matplotlib axes to draw on; by default those of a new figure, which belongs to no window
    and which a notebook shows. Returns the axes. Raises InputError if the record has no rows.

    >>> import mars2d
    >>> ax = mars2d.run("random_walk", stop_time=10).plot()
    >>> ax.get_xlabel(), ax.get_title()
    ('x [m]', 'Random movements, t = 10 s')
    """
    view = View.of(record, len(record) - 1)
    own = ax is None
    if ax is None:
        legend_width = _legend_width(record.scenario)
        width, height = view.inches(5.2, 4.8)
        figure = new_figure(width + 0.8 + legend_width, height + 0.9)
        ax = figure.add_subplot()
    else:
        _check_axes(ax)
        if ax.has_data():  # a second record over a first one
            view = view.union((*ax.get_xlim(), *ax.get_ylim()))
    dress(ax, record.scenario, view)
    label(ax)
    title = f"{record.scenario.title}, {_time(float(record.time[-1]))}"
    _set_title(ax, title)
    _add_legend(ax, record.scenario)
    if own:
        ax.get_figure().draw_without_rendering()  # type: ignore[union-attr]
        _show_in_notebooks(ax)
    paint_row(ax, record, len(record) - 1)
    return ax


def plot_snapshots(record: Record, times: ArrayLike, figure: Figure | None = None) -> Figure:
    """Draw the paths until each of some times, one panel a time.

    times: seconds, within the record; the panel shows the last row that is not after it. figure:
    a matplotlib figure to draw on, by default a new one. Returns the figure. Raises InputError for
    a time outside of the record, and if the record has no rows.
    """
    rows = _rows_at(record, times)
    scenario = record.scenario
    view = View.of(record, max(rows))
    cols = _columns(len(rows), view.width / view.height)
    lines = ceil(len(rows) / cols)
    own = figure is None
    if figure is None:
        room = min(3.2, 9.6 / cols)
        width, height = view.inches(room, room)
        figure = new_figure(
            cols * (width + 0.25) + 0.6 + _legend_width(scenario), lines * (height + 0.4) + 0.9
        )
    panels = figure.subplots(lines, cols, squeeze=False).ravel().tolist()
    for unused in panels[len(rows) :]:
        unused.remove()
    for k, (ax, row) in enumerate(zip(panels, rows, strict=False)):
        dress(ax, scenario, view)
        label(ax, below=k + cols >= len(rows), beside=k % cols == 0)
        ax.set_title(_time(float(record.time[row])), fontsize=10, color=INK)
    _add_legend(panels[min(cols, len(rows)) - 1], scenario)
    heading = _wrapped(scenario.title, figure.bbox.width / figure.dpi)
    figure.suptitle(heading, fontsize=12, color=INK, parse_math=False)
    if own:
        figure.draw_without_rendering()
        figure.__dict__["_repr_png_"] = partial(_png, figure)
    for ax, row in zip(panels, rows, strict=False):
        paint_row(ax, record, row)
    return figure


def save_figure(record: Record, path: str | Path, times: ArrayLike | None = None) -> Path:
    """Save a figure of a record as ``.png``, ``.pdf`` or ``.svg`` and return its path.

    times: seconds; when given, snapshots at these times, else the paths of the whole run. The same
    record gives the same bytes. Raises InputError for another suffix, a path that can't be
    written, a record without rows, or a time outside of it.
    """

    def draw() -> Any:
        return plot_paths(record).get_figure() if times is None else plot_snapshots(record, times)

    return save_drawing(draw, path)


def save_drawing(draw: Callable[[], Figure], path: str | Path, *, trim: bool = True) -> Path:
    """Save the figure that `draw` returns as ``.png``, ``.pdf`` or ``.svg`` and return its path.

    trim: cut off what is blank around the drawing. Raises InputError as `save_figure`.
    """
    import matplotlib as mpl

    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        known = f"{', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]}"
        raise InputError(f"{path}: a figure is saved as {known}, this ends in {path.suffix!r}")
    if not path.parent.is_dir():
        raise InputError(f"{path}: can't be written: there is no folder {path.parent}")
    # Without the date, and with ids that do not depend on chance.
    dates = {".pdf": {"CreationDate": None}, ".svg": {"Date": None}}
    with mpl.rc_context({"svg.hashsalt": "mars2d", "pdf.fonttype": 42}):
        file = BytesIO()  # so that nothing half written stays behind
        draw().savefig(
            file, format=suffix[1:], dpi=200, bbox_inches="tight" if trim else None,
            pad_inches=0.1, metadata=dates.get(suffix),
        )  # fmt: skip
    try:
        path.write_bytes(file.getvalue())
    except OSError as error:
        raise InputError(f"{path}: can't be written: {error.strerror}") from error
    return path


def new_figure(width: float, height: float, *, layout: Layout = "constrained") -> Figure:
    """Return a figure [inches] that pyplot does not know of."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout=layout, facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def _check_axes(ax: object) -> None:
    from matplotlib.axes import Axes

    if not isinstance(ax, Axes) or ax.name != "rectilinear":
        raise InputError(
            f"ax = {shown(ax)}: expected plain axes of matplotlib, as plt.subplots()[1]"
        )


def dress(ax: Axes, scenario: Scenario, view: View) -> None:
    """Set limits, grid and ticks, and paint what never moves."""
    ax.set_aspect("equal")
    ax.set_xlim(view.xmin, view.xmax)
    ax.set_ylim(view.ymin, view.ymax)
    ax.set_facecolor("white")
    ax.set_axisbelow("line")  # the grid between WORKSPACE and SHAPES
    ax.tick_params(length=0, labelsize=9, labelcolor=MUTED)
    _set_ticks(ax)
    ax.callbacks.connect("xlim_changed", _set_ticks)
    ax.callbacks.connect("ylim_changed", _set_ticks)
    if scenario.animation.grid:
        ax.grid(visible=True, color=GRID, linewidth=0.6)
    else:
        ax.grid(visible=False)
    ax.spines[:].set(color=GRID, linewidth=0.8, visible=scenario.workspace is None)
    for shape in seen.workspace(scenario).shapes:
        if isinstance(shape, Polygon):  # its outline is the frame of the grid
            paint(Scene([replace(shape, stroke=None)]), ax, level=WORKSPACE)
            for line in (*ax.get_xgridlines(), *ax.get_ygridlines()):
                line.set_clip_path(ax.patches[-1])
            paint(Scene([replace(shape, fill=None)]), ax, scale=0.75)
    paint(seen.floor(scenario), ax, level=WORKSPACE)
    paint(seen.obstacles(scenario), ax, scale=0.6)


def _set_ticks(ax: Axes) -> None:
    """Set the ticks of both axes at the same distance: 1, 2 or 5 times a power of ten metres."""
    from matplotlib.ticker import MultipleLocator

    step = grid_step(TICK_SPACING / points_per_metre(ax))
    ax.xaxis.set_major_locator(MultipleLocator(step))
    ax.yaxis.set_major_locator(MultipleLocator(step))


def label(ax: Axes, *, below: bool = True, beside: bool = True) -> None:
    """Label the axes below and beside the drawing, where there is no other panel."""
    ax.tick_params(labelbottom=below, labelleft=beside)
    if below:
        ax.set_xlabel("x [m]", color=INK, fontsize=10)
    if beside:
        ax.set_ylabel("y [m]", color=INK, fontsize=10)


def paint_row(ax: Axes, record: Record, row: int) -> None:
    """Paint the paths until a row, the initial poses, and the robots as they are then."""
    scenario = record.scenario
    now = record.frame(row)
    _set_ticks(ax)  # again, now that the layout is known
    few = len(scenario.robots) <= LEGEND_LIMIT
    radius = min(robot.radius for robot in scenario.robots) * points_per_metre(ax)
    drawn = scenario.animation.show_real_shape
    scale = min(max(radius / 9, 0.1), 0.75) if drawn else 0.75 if few else 0.5
    paint(seen.addons(now), ax, scale=0.75)
    if scenario.animation.wake:
        trails = seen.trails(now)
        if not few:
            trails = Scene([_paler(shape) for shape in trails.shapes])
        paint(trails, ax, scale=0.55 if few else 0.4)
    if scenario.animation.theory:  # above the paths, as in the window: they may cover it
        paint(seen.theory(now), ax, scale=0.75)
    if scenario.animation.show_initial_pose:
        paint(seen.initial_poses(scenario), ax, scale=min(1.3 * scale, 0.75))
    paint(messages(now), ax, scale=max(0.4, scale))
    paint(seen.props(now), ax, scale=min(scale, 0.6))
    paint(seen.robots(now), ax, scale=scale)
    paint(seen.joints(now), ax, scale=max(0.4, scale))
    if scenario.animation.forces:
        _paint_forces(ax, now, max(0.4, scale))


def _paint_forces(ax: Axes, now: Frame, scale: float) -> None:
    """Paint the forces of the last control step, and how long some round force is."""
    shapes = forces(now).shapes
    (xmin, xmax), (ymin, ymax) = ax.get_xlim(), ax.get_ylim()
    length = force_scale(now.scenario).newton
    force = round_force(0.14 * (xmax - xmin) / length)
    tail = (xmin + 0.03 * (xmax - xmin), ymin + 0.05 * (ymax - ymin))
    tip = (tail[0] + force * length, tail[1])
    legend = Scene()
    legend.arrow(tail, tip, fill=FORCE, stroke="#ffffff")
    legend.text(tip, in_newtons(force), color=FORCE, size=LABEL_SIZE, anchor="left", halo="#ffffff")
    shapes += legend.shapes
    paint(Scene([shape for shape in shapes if not isinstance(shape, Text)]), ax, scale=scale)
    paint(Scene([shape for shape in shapes if isinstance(shape, Text)]), ax, scale=0.65)


def _paler(shape: Shape) -> Shape:
    """Return a line more faint, so that in a crowd the robots stand out from their paths."""
    return replace(shape, stroke=faded(shape.stroke, 0.5)) if isinstance(shape, Line) else shape


def _set_title(ax: Axes, title: str) -> None:
    ax.apply_aspect()
    room = 1.25 * ax.get_window_extent().width / ax.get_figure().dpi  # type: ignore[union-attr]
    ax.set_title(_wrapped(title, room), fontsize=12, color=INK, parse_math=False)


def _wrapped(title: str, room: float) -> str:
    """Return a title of 12 points in lines that fit into some room, inches."""
    return textwrap.fill(title, max(20, int(room * 10)), max_lines=3, placeholder=" …")


def _time(seconds: float) -> str:
    return f"t = {seconds:.10g} s"


def _names(scenario: Scenario) -> list[str]:
    """Return the robots' names as they stand in a legend, or none if there are too many."""
    if len(scenario.robots) > LEGEND_LIMIT:
        return []
    names = [" ".join(str(robot.name).split()) for robot in scenario.robots]
    return [name if len(name) <= NAME_LIMIT else name[: NAME_LIMIT - 1] + "…" for name in names]


def _legend_width(scenario: Scenario) -> float:
    """Return about how wide the legend will be, inches."""
    names = _names(scenario)
    return 0.3 + 0.075 * max(map(len, names)) if names else 0.0


def _add_legend(ax: Axes, scenario: Scenario) -> None:
    """Name the robots beside the drawing, if they are few."""
    from matplotlib.lines import Line2D

    names = _names(scenario)
    if not names:
        return
    handles: list[Artist] = [
        Line2D([], [], linestyle="none", marker="o", markersize=6, color=color, markeredgewidth=0)
        for color in scenario.colors
    ]
    legend = ax.legend(
        handles, ["robot"] * len(names), loc="upper left",
        bbox_to_anchor=(1.0, 1.0), borderaxespad=0.3,
        frameon=False, fontsize=9, labelcolor=INK, handletextpad=0.1, handlelength=1.5,
    )  # fmt: skip
    for text, name in zip(legend.get_texts(), names, strict=True):
        text.set_parse_math(False)
        text.set_text(name)  # only now: a legend leaves out labels that begin with "_"


def _columns(count: int, ratio: float) -> int:
    """Return in how many columns to lay out panels whose width to height is `ratio`."""

    def fault(cols: int) -> float:
        lines = ceil(count / cols)
        return abs(log(cols * ratio / lines / 1.6)) + 0.3 * (cols * lines - count)

    return min(range(1, count + 1), key=fault)


def _rows_at(record: Record, times: ArrayLike) -> list[int]:
    """Return the last rows of a record that are not after the times [s]."""
    if len(record) == 0:
        raise InputError("the record has no rows: nothing ran, so there is nothing to draw")
    expected = "expected times in seconds, as [0, 2.5, 10]"
    try:
        wanted = np.atleast_1d(np.asarray(times))
    except ValueError:
        raise InputError(f"times = {shown(times)}: {expected}") from None
    if wanted.ndim != 1 or wanted.dtype.kind not in "iuf":
        raise InputError(f"times = {shown(times)}: {expected}")
    if not 1 <= len(wanted) <= PANEL_LIMIT:
        raise InputError(f"times: {len(wanted)} of them; a figure has 1 to {PANEL_LIMIT} panels")
    first, last = float(record.time[0]), float(record.time[-1])
    hair = 1e-6 * record.scenario.sampling_time  # 3 * 0.1 is a little more than 0.3
    for time in wanted.tolist():
        if not first - hair <= time <= last + hair:  # true for NaN as well
            raise InputError(
                f"times: {time:.10g} s is outside of the record, "
                f"which goes from {first:.10g} to {last:.10g} s"
            )
    rows = np.searchsorted(record.time, wanted.astype(float) + hair, side="right") - 1
    return [max(0, row) for row in rows.tolist()]


def _show_in_notebooks(ax: Axes) -> None:
    """Let a notebook show the axes, or their figure: it asks for the method _repr_png_."""
    figure: Any = ax.get_figure()
    ax.__dict__["_repr_png_"] = figure.__dict__["_repr_png_"] = partial(_png, figure)


def _png(figure: Figure) -> bytes:
    file = BytesIO()
    figure.savefig(file, format="png", dpi=120, bbox_inches="tight", pad_inches=0.1)
    return file.getvalue()
