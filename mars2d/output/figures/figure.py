"""Figures of records with matplotlib, for reports and papers: the end of a run, or snapshots."""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from io import BytesIO
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from numpy.typing import ArrayLike

from mars2d.core.errors import InputError, shown
from mars2d.core.files import atomic_write
from mars2d.core.plane import grid_step
from mars2d.core.scene import Circle, Line, Polygon, Scene, Shape, faded
from mars2d.output.figures.artists import SHAPES, paint, points_per_metre
from mars2d.output.figures.extent import View, rows_at
from mars2d.output.figures.legend import BESIDE, Entry, add_legend, legend_width, plain_name
from mars2d.output.figures.style import GRID, INK, MUTED, SMALL, TITLE, points
from mars2d.output.layers.table import Layers

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from mars2d.record.frame import Frame
    from mars2d.record.rows import Rows
    from mars2d.scenario.scenario import Scenario

Layout = Literal["constrained"] | None

SUFFIXES = (".png", ".pdf", ".svg")
"""The formats of `save_figure`."""

LEGEND_LIMIT = 8
"""The most robots with a legend; beyond, base colours recur."""

FAINT_AREA = 0.1
"""The highest opacity of an area that a sensor covers."""

WORKSPACE = 1.0
"""The zorder of the workspace; the grid has 1.5, shapes have 2."""

LETTERS = 0.65
"""The height of letters on a drawing, as a share of that in the window."""

TICK_SPACING = 28.0  # points between ticks, at least

ROOM, PANEL_ROOM = (5.2, 4.8), 3.2
"""The room for one drawing, and that for each of several, inches."""


def plot_paths(record: Rows, ax: Axes | None = None, *, layers: Layers | None = None) -> Axes:
    """Draw all layers at the end of a record: paths, initial poses hollow, final ones filled.

    ax: matplotlib axes to draw on; by default those of a new figure, which belongs to no window
    and which a notebook shows. layers: the switches; by default those of the animation, with paths,
    and with sensors if there are few robots. Heights of text follow matplotlib's ``font.size``.
    Returns the axes. Raises InputError if the record has no rows.

    >>> import mars2d
    >>> ax = mars2d.run("random_walk", stop_time=10).plot()
    >>> ax.get_xlabel(), ax.get_title()
    ('x [m]', 'Random movements, t = 10 s')
    """
    view, scenario = View.of(record, len(record) - 1), record.scenario
    layers, entries = layers or layers_of(scenario, paths=True), robots_of(scenario)
    if ax is None:
        (ax,) = new_axes(view, beside=legend_width(entries))
    check_axes(ax)
    if ax.has_data():  # a second record on top of a first one
        view = view.union((*ax.get_xlim(), *ax.get_ylim()))
    dress(ax, scenario, view, layers)
    label(ax)
    add_legend(ax, entries, **BESIDE)
    heading = f"{scenario.title}, {_time(float(record.time[-1]))}"
    letters = int(ax.get_window_extent().width / ax.figure.dpi * 144 / points(TITLE))
    title = textwrap.fill(heading, max(20, letters), max_lines=3, placeholder=" …")
    ax.set_title(title, fontsize=points(TITLE), color=INK, parse_math=False)
    paint_frame(ax, record.frame(-1), layers)
    return ax


def plot_snapshots(record: Rows, times: ArrayLike, *, layers: Layers | None = None) -> Figure:
    """Draw the paths up to each of some times, one panel each, in a new figure; return it.

    times: seconds, within the record; a panel shows the last row at or before its time. layers: as
    in `plot_paths`. Raises InputError for a time outside the record, and if the record has no rows.
    """
    rows, scenario = rows_at(record, times), record.scenario
    view, entries = View.of(record, max(rows)), robots_of(scenario)
    layers = layers or layers_of(scenario)
    # the whole about twice as wide as high, no line much emptier than the others
    most = ceil((2 * len(rows) * view.height / view.width) ** 0.5)
    cols = ceil(len(rows) / ceil(len(rows) / min(len(rows), most, 4)))
    axes = new_axes(view, len(rows), cols, legend_width(entries))
    add_legend(axes[min(cols, len(axes)) - 1], entries, **BESIDE)
    for k, (ax, row) in enumerate(zip(axes, rows, strict=True)):
        frame = record.frame(row)
        dress(ax, scenario, view, layers)
        label(ax, below=k + cols >= len(axes), beside=k % cols == 0)
        ax.set_title(_time(frame.time), fontsize=points(), color=INK)
        paint_frame(ax, frame, layers)
    figure: Any = axes[0].get_figure()
    heading = textwrap.shorten(scenario.title, 80, placeholder=" …")
    figure.suptitle(heading, y=0.99, fontsize=points(TITLE), color=INK, parse_math=False)
    return axes[0].get_figure()  # type: ignore[return-value]


def new_axes(view: View, count: int = 1, cols: int = 1, beside: float = 0.0) -> list[Axes]:
    """Return axes for drawings of one view in a new figure, in columns, each as large as fits.

    beside: the room at the right, for a legend, inches.
    """
    one, unit, lines = count == 1, points() / 10, ceil(count / cols)
    width, height = view.inches(*(ROOM if one else (min(PANEL_ROOM, 3 * PANEL_ROOM / cols),) * 2))
    left, below, above = 0.65 * unit, 0.55 * unit, (0.55 if one else 0.75) * unit
    across, up = width + 0.2 * unit, height + 0.4 * unit
    wide = left + cols * across + beside
    tall = above + below + (lines - 1) * up + height
    figure = new_figure(wide, tall, layout=None)
    axes = []
    for k in range(count):
        line, col = divmod(k, cols)
        x, y = left + col * across, below + (lines - 1 - line) * up
        axes.append(figure.add_axes((x / wide, y / tall, width / wide, height / tall)))
    show_in_notebooks(*axes)
    return axes


def save_figure(record: Rows, path: str | Path, times: ArrayLike | None = None) -> Path:
    """Save a figure of a record as ``.png``, ``.pdf`` or ``.svg`` and return its path.

    times: seconds, for snapshots at these times; None: the paths of the whole run. The same record
    gives the same bytes. Raises InputError for another suffix, a path that can't be written, a
    record without rows, or a time outside it.
    """

    def draw() -> Any:
        return plot_paths(record).get_figure() if times is None else plot_snapshots(record, times)

    return save_drawing(draw, path)


def save_drawing(draw: Callable[[], Figure], path: str | Path) -> Path:
    """Save the figure that `draw` returns as ``.png``, ``.pdf`` or ``.svg`` and return its path.

    Fonts are embedded in a .pdf. Raises InputError as `save_figure`.
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
            made, format=suffix[1:], dpi=200, bbox_inches="tight", pad_inches=0.1,
            metadata=dates.get(suffix),
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


def dress(ax: Axes, scenario: Scenario, view: View, layers: Layers | None = None) -> None:
    """Set limits, grid and ticks for an experiment."""
    grid = (layers or layers_of(scenario)).grid
    ax.set_aspect("equal")
    ax.set_xlim(view.xmin, view.xmax)
    ax.set_ylim(view.ymin, view.ymax)
    ax.set_facecolor("white")
    ax.set_axisbelow("line")  # the grid between WORKSPACE and SHAPES
    style_ticks(ax)
    _set_ticks(ax)
    ax.callbacks.connect("xlim_changed", _set_ticks)
    ax.callbacks.connect("ylim_changed", _set_ticks)
    ax.grid(visible=grid)
    if grid:
        ax.grid(color=GRID, linewidth=0.6)
    ax.spines[:].set(color=GRID, linewidth=0.8, visible=scenario.workspace is None)


def style_ticks(ax: Axes) -> None:
    """Style the labels of ticks, including those made later."""
    ax.tick_params(which="both", length=0, labelsize=points(SMALL), labelcolor=MUTED)


def _set_ticks(ax: Axes) -> None:
    """Set ticks at the same distance on both axes: 1, 2 or 5 times a power of ten metres."""
    from matplotlib.ticker import MultipleLocator

    step = grid_step(TICK_SPACING * points() / 10 / points_per_metre(ax))
    ax.xaxis.set_major_locator(MultipleLocator(step))
    ax.yaxis.set_major_locator(MultipleLocator(step))


def label(ax: Axes, *, below: bool = True, beside: bool = True) -> None:
    """Label the axes below and beside the drawing, where there is no other panel."""
    ax.tick_params(labelbottom=below, labelleft=beside)
    if below:
        ax.set_xlabel("x [m]", color=INK, fontsize=points())
    if beside:
        ax.set_ylabel("y [m]", color=INK, fontsize=points())


def paint_frame(ax: Axes, now: Frame, layers: Layers | None = None) -> None:
    """Paint the layers of a frame; layers: the switches, as in `plot_paths`."""
    scenario = now.scenario
    _set_ticks(ax)  # again: the layout is known now
    level = WORKSPACE  # the grid lies between this and the level of all later layers
    for layer in (layers or layers_of(scenario)).seen(scenario.animation):
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
        elif layer.name == "sensors" or (
            layer.name == "trails" and len(scenario.robots) > LEGEND_LIMIT
        ):
            shapes = [_faint(shape) for shape in shapes]
        own = layer.name in ("floor", "addons", "theory")
        before = len(ax.patches)
        scale = _scale(layer.name, ax, scenario)
        paint(Scene(shapes), ax, scale=scale, words=scale if own else LETTERS, level=level)
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


def _scale(layer: str, ax: Axes, scenario: Scenario) -> float:
    """Return the factor for the widths of a layer's lines, which grow thinner with the robots."""
    radius = min(robot.radius for robot in scenario.robots) * points_per_metre(ax)
    robots = min(max(radius / 9, 0.1), 0.7) if scenario.animation.show_real_shape else 0.6
    own = {"trails": 0.55, "sensors": 0.4, "floor": 1.0}
    return robots if layer in ("starts", "props", "robots") else own.get(layer, 0.7)


def _faint(shape: Shape) -> Shape:
    """Return a shape with fainter lines and areas, so that what matters more stands out."""
    if isinstance(shape, (Circle, Polygon)) and shape.fill and len(shape.fill) > len("#rrggbb"):
        opacity = int(shape.fill[7:], 16) / 255
        return replace(shape, fill=faded(shape.fill, min(opacity, FAINT_AREA)))
    return replace(shape, stroke=faded(shape.stroke, 0.5)) if isinstance(shape, Line) else shape


def _time(seconds: float) -> str:
    return f"t = {seconds:.10g} s"


def robots_of(scenario: Scenario) -> list[Entry]:
    """Return the legend of robots, as one entry if they look alike; none of many."""
    alike: dict[str, list[str]] = {}
    for robot, color in zip(scenario.robots, scenario.colors, strict=True):
        alike.setdefault(color, []).append(str(robot.name))
    if len(scenario.robots) > LEGEND_LIMIT:
        return []
    names = {
        color: ", ".join(those) if len(those) < 3 else f"{those[0]} and {len(those) - 1} alike"
        for color, those in alike.items()
    }
    return [Entry(plain_name(name), color, "", 1.5, "o") for color, name in names.items()]


def show_in_notebooks(*axes: Axes) -> None:
    """Let notebooks show axes or their figure, by the method `_repr_png_`."""
    for ax in axes:
        figure: Any = ax.get_figure()
        ax.__dict__["_repr_png_"] = figure.__dict__["_repr_png_"] = partial(_png, figure)


def _png(figure: Figure) -> bytes:
    file = BytesIO()
    figure.savefig(file, format="png", dpi=120, bbox_inches="tight", pad_inches=0.1)
    return file.getvalue()
