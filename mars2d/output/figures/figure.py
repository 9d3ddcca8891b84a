"""Figures of records with matplotlib, for reports and papers: the end of a run, or snapshots."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from io import BytesIO
from math import ceil, log
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.errors import InputError, shown
from mars2d.core.files import atomic_write
from mars2d.core.plane import grid_step
from mars2d.core.scene import Circle, Line, Polygon, Scene, Shape, faded
from mars2d.output.figures.artists import SHAPES, paint, points_per_metre
from mars2d.output.figures.extent import View, rows_at
from mars2d.output.figures.legend import (
    BESIDE,
    Entry,
    add_legend,
    column_width,
    plain_name,
    sign_scale,
)
from mars2d.output.figures.style import SCREEN, Style, style_of
from mars2d.output.layers.arrows import Sign, has_cut
from mars2d.output.layers.forces import forces
from mars2d.output.layers.impulses import impulses
from mars2d.output.layers.legend import legends
from mars2d.output.layers.table import Layers
from mars2d.output.layers.trails import trails
from mars2d.output.layers.velocities import velocities

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from mars2d.record.frame import Frame
    from mars2d.record.rows import Rows
    from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]
Layout = Literal["constrained"] | None

SUFFIXES = (".png", ".pdf", ".svg")
"""The formats of `save_figure`."""

LEGEND_LIMIT = 8
"""The most robots with a legend; beyond, base colours recur."""

CROWD = 60
"""With more robots, paths are thinner."""

FAINT_AREA = 0.1
"""The highest opacity of an area that a sensor covers."""

INK, MUTED, GRID = SCREEN.ink, SCREEN.muted, SCREEN.grid

WORKSPACE = 1.0
"""The zorder of the workspace; the grid has 1.5, shapes have 2."""

ARROWS = {"forces": forces, "impulses": impulses, "velocities": velocities}
"""The layers whose arrows have a scale in the legend."""

MAX_ARROW = 44.0
"""The greatest length of an arrow in the legend, points of the window."""

TICK_SPACING = 28.0  # points between ticks, at least


def plot_paths(
    record: Rows, ax: Axes | None = None, *, style: str = "screen", layers: Layers | None = None
) -> Axes:
    """Draw all layers at the end of a record: paths, initial poses hollow, final ones filled.

    ax: matplotlib axes to draw on; by default those of a new figure, which belongs to no window
    and which a notebook shows. style: a name in `figures.style.STYLES`. layers: the switches; by
    default those of the animation, with paths, and with sensors if there are few robots. Returns
    the axes.
    Raises InputError if the record has no rows.

    >>> import mars2d
    >>> ax = mars2d.run("random_walk", stop_time=10).plot()
    >>> ax.get_xlabel(), ax.get_title()
    ('x [m]', 'Random movements, t = 10 s')
    """
    look, last = style_of(style), len(record) - 1
    view = View.of(record, last)
    layers = layers or layers_of(record.scenario, paths=True)
    with look.fonts():
        if own := ax is None:
            ax = new_figure(*_page(look, view)).add_subplot()
        check_axes(ax)
        if ax.has_data():  # a second record on top of a first one
            view = view.union((*ax.get_xlim(), *ax.get_ylim()))
        title = f"{record.scenario.title}, {_time(float(record.time[-1]))}"
        _draw([ax], look.restyled(record), [last], view, look, layers, title=title, own=own)
    return ax


def plot_snapshots(
    record: Rows,
    times: ArrayLike,
    figure: Figure | None = None,
    *,
    style: str = "screen",
    layers: Layers | None = None,
) -> Figure:
    """Draw the paths up to each of some times, one panel each.

    times: seconds, within the record; a panel shows the last row at or before its time. figure:
    a matplotlib figure to draw on, by default a new one. style, layers: as in `plot_paths`. Returns
    the figure. Raises InputError for a time outside the record, and if the record has no rows.
    """
    look, rows = style_of(style), rows_at(record, times)
    view, layers = View.of(record, max(rows)), layers or layers_of(record.scenario)
    cols = _columns(len(rows), view.width / view.height, look.page)
    lines = ceil(len(rows) / cols)
    with look.fonts():
        if own := figure is None:
            figure = new_figure(*_page(look, view, cols=cols, lines=lines))
        axes = figure.subplots(lines, cols, squeeze=False).ravel().tolist()
        for unused in axes[len(rows) :]:
            unused.remove()
        _draw(axes[: len(rows)], look.restyled(record), rows, view, look, layers, cols, own=own)
    return figure


def _draw(
    axes: Sequence[Axes],
    record: Rows,
    rows: Sequence[int],
    view: View,
    look: Style,
    layers: Layers,
    cols: int = 1,
    *,
    title: str = "",
    own: bool,
) -> None:
    """Draw rows on axes in columns, with a legend beside the first line of them.

    title: of the only axes; without it each has its time, and the figure the scenario's title. own:
    whether the figure is a new one, which is made as large as the legend needs.
    """
    figure: Any = axes[0].get_figure()
    for k, ax in enumerate(axes):
        dress(ax, record.scenario, view, look, layers)
        label(ax, below=k + cols >= len(axes), beside=k % cols == 0, look=look)
    frames = [record.frame(row) for row in rows]
    entries = _entries(frames, layers, look, points_per_metre(axes[0]))
    add_legend(axes[min(cols, len(axes)) - 1], entries, look, **BESIDE)
    if own:
        lines = ceil(len(axes) / cols)
        figure.set_size_inches(_page(look, view, legend_size(entries, look), cols, lines))
    if title and look.title:
        axes[0].apply_aspect()
        room = 1.25 * axes[0].get_window_extent().width / figure.dpi
        heading = _wrapped(title, room, look)
        axes[0].set_title(heading, fontsize=look.title, color=look.ink, parse_math=False)
    elif not title:
        for ax, frame in zip(axes, frames, strict=True):
            ax.set_title(_time(frame.time), fontsize=look.label, color=look.ink)
        if look.title:
            heading = _wrapped(record.scenario.title, figure.bbox.width / figure.dpi, look)
            figure.suptitle(heading, fontsize=look.title, color=look.ink, parse_math=False)
    if own:
        figure.draw_without_rendering()  # the scale is known from the layout
        show_in_notebooks(axes[0])
    for ax, frame in zip(axes, frames, strict=True):
        paint_frame(ax, frame, look, layers)


def _page(
    look: Style,
    view: View,
    legend: tuple[float, float] = (0.0, 0.0),
    cols: int = 1,
    lines: int = 1,
) -> tuple[float, float]:
    """Return the size of a figure with drawings in columns and lines, and a legend, inches."""
    if look.page is not None:
        return look.page
    one, beside = cols * lines == 1, 0.8 * look.label / SCREEN.label + legend[0]
    fixed = look.single if one else look.full
    if fixed is None:
        room = (5.2, 4.8) if one else (min(3.2, 9.6 / cols),) * 2
        width, height = view.inches(*room)
        gap = (0.0, 0.0) if one else (0.25, 0.4)
        wide, tall = cols * (width + gap[0]), lines * (height + gap[1])
        return wide + beside, max(tall, legend[1]) + 0.9
    _, height = view.inches((fixed - beside) / cols - 0.1, 1.5 * fixed)
    return fixed, max(lines * (height + 0.25), legend[1]) + 0.4


def save_figure(
    record: Rows, path: str | Path, times: ArrayLike | None = None, *, style: str = "screen"
) -> Path:
    """Save a figure of a record as ``.png``, ``.pdf`` or ``.svg`` and return its path.

    times: seconds, for snapshots at these times; None: the paths of the whole run. style: as in
    `plot_paths`. The same record gives the same bytes. Raises InputError for another suffix, a path
    that can't be written, a record without rows, or a time outside it.
    """
    look = style_of(style)

    def draw() -> Any:
        if times is None:
            return plot_paths(record, style=style).get_figure()
        return plot_snapshots(record, times, style=style)

    return save_drawing(draw, path, trim=look.trim, dpi=look.dpi)


def save_drawing(
    draw: Callable[[], Figure], path: str | Path, *, trim: bool = True, dpi: int = SCREEN.dpi
) -> Path:
    """Save the figure that `draw` returns as ``.png``, ``.pdf`` or ``.svg`` and return its path.

    trim: cut off blank margins. dpi: pixels per inch of a .png. Fonts are embedded in a .pdf.
    Raises InputError as `save_figure`.
    """
    import matplotlib as mpl

    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        known = f"{', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]}"
        raise InputError(f"{path}: a figure is saved as {known}, this ends in {path.suffix!r}")
    if not path.parent.is_dir():
        raise InputError(f"{path}: can't be written: there is no folder {path.parent}")
    # Without the date, and with ids that are not random.
    dates = {".pdf": {"CreationDate": None}, ".svg": {"Date": None}}
    with mpl.rc_context({"svg.hashsalt": "mars2d", "pdf.fonttype": 42}):
        made = BytesIO()  # on a full disk, errors of matplotlib would hide the cause
        draw().savefig(
            made, format=suffix[1:], dpi=dpi, bbox_inches="tight" if trim else None,
            pad_inches=0.1, metadata=dates.get(suffix),
        )  # fmt: skip
    with atomic_write(path) as file:
        file.write(made.getbuffer())
    return path


def new_figure(width: float, height: float, *, layout: Layout = "constrained") -> Figure:
    """Return a new figure [inches], unknown to pyplot."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout=layout, facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def check_axes(ax: object) -> None:
    """Raise InputError for anything but plain axes."""
    from matplotlib.axes import Axes

    if not isinstance(ax, Axes) or ax.name != "rectilinear":
        raise InputError(
            f"ax = {shown(ax)}: expected plain axes of matplotlib, such as plt.subplots()[1]"
        )


def dress(
    ax: Axes,
    scenario: Scenario,
    view: View,
    look: Style = SCREEN,
    layers: Layers | None = None,
) -> None:
    """Set limits, grid and ticks for an experiment."""
    dress_plane(ax, view, look, grid=(layers or layers_of(scenario)).grid)
    ax.spines[:].set(visible=scenario.workspace is None)


def dress_plane(ax: Axes, view: View, look: Style = SCREEN, *, grid: bool = True) -> None:
    """Set limits, grid and ticks of a part of the plane."""
    ax.set_aspect("equal")
    ax.set_xlim(view.xmin, view.xmax)
    ax.set_ylim(view.ymin, view.ymax)
    ax.set_facecolor("white")
    ax.set_axisbelow("line")  # the grid between WORKSPACE and SHAPES
    style_ticks(ax, look)
    set_ticks = partial(_set_ticks, spacing=TICK_SPACING * look.small / SCREEN.small)
    set_ticks(ax)
    ax.callbacks.connect("xlim_changed", set_ticks)
    ax.callbacks.connect("ylim_changed", set_ticks)
    ax.grid(visible=grid)
    if grid:
        ax.grid(color=look.grid, linewidth=0.6 * look.stroke)
    ax.spines[:].set(color=look.grid, linewidth=0.8 * look.stroke)


def style_ticks(ax: Axes, look: Style) -> None:
    """Style the labels of ticks, including those made later."""
    ax.tick_params(which="both", length=0, labelsize=look.small, labelcolor=look.muted)
    if look.family:
        ax.tick_params(which="both", labelfontfamily=list(look.family))


def _set_ticks(ax: Axes, spacing: float) -> None:
    """Set ticks at the same distance on both axes: 1, 2 or 5 times a power of ten metres.

    spacing: the least distance between ticks, points.
    """
    from matplotlib.ticker import MultipleLocator

    step = grid_step(spacing / points_per_metre(ax))
    ax.xaxis.set_major_locator(MultipleLocator(step))
    ax.yaxis.set_major_locator(MultipleLocator(step))


def label(ax: Axes, *, below: bool = True, beside: bool = True, look: Style = SCREEN) -> None:
    """Label the axes below and beside the drawing, where there is no other panel."""
    ax.tick_params(labelbottom=below, labelleft=beside)
    if below:
        ax.set_xlabel("x [m]", color=look.ink, fontsize=look.label)
    if beside:
        ax.set_ylabel("y [m]", color=look.ink, fontsize=look.label)


def paint_frame(ax: Axes, now: Frame, look: Style = SCREEN, layers: Layers | None = None) -> None:
    """Paint the layers of a frame; layers: the switches, as in `plot_paths`."""
    scenario = now.scenario
    layers = layers or layers_of(scenario)
    _set_ticks(ax, TICK_SPACING * look.small / SCREEN.small)  # again: the layout is known now
    scales, words = _scales(ax, scenario, look), sign_scale(look)
    level = WORKSPACE  # the grid lies between this and the level of all later layers
    for layer in layers.seen(scenario.animation):
        if layer.name in ("edge", "obstacles"):
            level = SHAPES
        if layer.shapes is None:
            continue
        shapes = layer.shapes(now).shapes
        if layer.name == "workspace":  # its edge is a layer of its own
            shapes = [
                replace(shape, stroke=None) if isinstance(shape, Polygon) else shape
                for shape in shapes
            ]
        elif layer.name == "trails":
            shapes = _told_apart(now, look)
        elif layer.name == "sensors":
            shapes = [_faint(shape) for shape in shapes]
        scale = scales.get(layer.name, scales["bodies"])
        texts = scale if layer.name in ("floor", "addons", "theory") else words
        before = len(ax.patches)
        paint(Scene(shapes), ax, scale=scale, words=texts, level=level)
        if layer.name == "workspace" and shapes:
            for line in (*ax.get_xgridlines(), *ax.get_ygridlines()):
                line.set_clip_path(ax.patches[before])


def layers_of(scenario: Scenario, *, paths: bool = False) -> Layers:
    """Return the default layers of a figure, for many robots without sensors, which hide paths.

    paths: whether it is a figure of paths, which has them even where the animation has none.
    """
    few = len(scenario.robots) <= LEGEND_LIMIT
    layers = Layers.of(scenario.animation, sensors=few)
    return layers.switched(trails=True) if paths else layers


def _scales(ax: Axes, scenario: Scenario, look: Style) -> dict[str, float]:
    """Return the factor for the widths of lines, by layer; "bodies" stands for all others.

    Lines grow thinner with the robots, and in a crowd.
    """
    few = len(scenario.robots) <= LEGEND_LIMIT
    radius = min(robot.radius for robot in scenario.robots) * points_per_metre(ax)
    robots = min(max(radius / 9, 0.1), 0.75)
    if not scenario.animation.show_real_shape:
        robots = 0.75 if few else 0.5
    scales = {
        "workspace": 0.75,
        "floor": 1 / look.stroke,
        "edge": 0.75,
        "obstacles": 0.6,
        "starts": min(1.3 * robots, 0.75),
        "trails": 0.55 if few else 0.4 * min(1.0, (CROWD / len(scenario.robots)) ** 0.5),
        "sensors": 0.4,
        "addons": 0.75,
        "theory": 0.75,
        "props": min(robots, 0.6),
        "rings": 0.6,
        "robots": robots,
        "bodies": max(0.4, robots),
    }
    return {name: scale * look.stroke for name, scale in scales.items()}


def _told_apart(now: Frame, look: Style) -> list[Shape]:
    """Return the paths: without colours with a line style for each robot, and paler for many."""
    scenario, styles = now.scenario, None
    if look.greys and scenario.animation.wake_style == "-":
        styles = [look.dash(k) for k in range(len(scenario.robots))]
    paths = trails(now, styles).shapes
    return paths if len(scenario.robots) <= LEGEND_LIMIT else [_faint(shape) for shape in paths]


def _faint(shape: Shape) -> Shape:
    """Return a shape with fainter lines and areas, so that what matters more stands out."""
    if isinstance(shape, (Circle, Polygon)) and shape.fill and len(shape.fill) > len("#rrggbb"):
        opacity = int(shape.fill[7:], 16) / 255
        return replace(shape, fill=faded(shape.fill, min(opacity, FAINT_AREA)))
    return replace(shape, stroke=faded(shape.stroke, 0.5)) if isinstance(shape, Line) else shape


def _wrapped(title: str, room: float, look: Style) -> str:
    """Return a title wrapped to a width, inches."""
    letters = max(20, int(room * 120 / look.title))
    return textwrap.fill(title, letters, max_lines=3, placeholder=" …")


def _time(seconds: float) -> str:
    return f"t = {seconds:.10g} s"


def _entries(
    frames: Sequence[Frame], layers: Layers, look: Style, ppm: float
) -> list[Entry | Sign]:
    """Return the legend: robots, as one entry if they look alike, unless many; then all signs."""
    scenario = frames[0].scenario
    alike: dict[object, list[int]] = {}
    for i, color in enumerate(scenario.colors):
        alike.setdefault(i if look.greys else color, []).append(i)
    entries: list[Entry | Sign] = []
    for first, *others in alike.values() if len(scenario.robots) <= LEGEND_LIMIT else ():
        names = [str(scenario.robots[i].name) for i in (first, *others)]
        name = ", ".join(names) if len(others) < 2 else f"{names[0]} and {len(others)} alike"
        dash = look.dash(first) if look.greys else ""
        color, width = scenario.colors[first], 1.5 * look.stroke
        entries.append(Entry(plain_name(name), color, dash, width, "o"))
    return entries + signs_of(frames, layers, look, ppm)


def signs_of(
    frames: Sequence[Frame], layers: Layers, look: Style, ppm: float
) -> list[Entry | Sign]:
    """Return what the arrows and signs of layers mean; ppm: the points of a metre.

    The arrow of forces is always there, others where they are needed: that of impulses after a
    blow, and one with a cut where an arrow is shortened.
    """
    found: list[Entry | Sign] = []
    for legend in legends(frames[0].scenario):
        if not getattr(layers, legend.layer):
            continue
        if legend.ruler is None:
            found += legend.signs
            continue
        scenes = [ARROWS[legend.layer](frame) for frame in frames]
        if legend.layer == "forces" or any(scene.shapes for scene in scenes):
            found.append(legend.ruler.sign(sign_scale(look) / ppm, MAX_ARROW))
        if any(map(has_cut, scenes)):
            found.append(legend.ruler.limit)
    return found


def legend_size(entries: Sequence[Entry | Sign], look: Style) -> tuple[float, float]:
    """Return the approximate width and height of a legend, inches."""
    if not entries:
        return 0.0, 0.0
    letters = 0.075 * max(len(each.name) for each in entries) * look.small / SCREEN.small
    wide = letters + (column_width(entries, look) + 1.3 * look.small) / 72
    return wide, len(entries) * 1.5 * look.small / 72


def _columns(count: int, ratio: float, page: tuple[float, float] | None) -> int:
    """Return the number of columns for panels whose ratio of width to height is `ratio`.

    page: the size of the figure, inches, if it is fixed: the panels are then as large as possible.
    """

    def fault(cols: int) -> float:
        lines = ceil(count / cols)
        if page is not None:
            return -min(page[0] / cols - 0.4, (page[1] / lines - 1.0) * ratio)  # less the text
        return abs(log(cols * ratio / lines / 1.6)) + 0.3 * (cols * lines - count)

    return min(range(1, count + 1), key=fault)


def show_in_notebooks(*axes: Axes) -> None:
    """Let notebooks show axes or their figure, by the method `_repr_png_`."""
    for ax in axes:
        figure: Any = ax.get_figure()
        ax.__dict__["_repr_png_"] = figure.__dict__["_repr_png_"] = partial(_png, figure)


def _png(figure: Figure) -> bytes:
    file = BytesIO()
    figure.savefig(file, format="png", dpi=120, bbox_inches="tight", pad_inches=0.1)
    return file.getvalue()
