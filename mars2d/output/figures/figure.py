"""Figures of records with matplotlib, for reports and papers: the end of a run, or snapshots."""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from io import BytesIO
from math import ceil, log
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.errors import InputError, shown
from mars2d.core.files import atomic_write
from mars2d.core.plane import grid_step
from mars2d.core.scene import Circle, Line, Polygon, Scene, Shape, Text, faded
from mars2d.output.figures.artists import SHAPES, paint, points_per_metre
from mars2d.output.figures.extent import View, rows_at
from mars2d.output.figures.style import SCREEN, Style, style_of
from mars2d.output.layers.arrows import EDGE, LABEL_SIZE, arrow, has_cut
from mars2d.output.layers.forces import forces
from mars2d.output.layers.impulses import impulses
from mars2d.output.layers.legend import SIGNED, legends, sign_rows
from mars2d.output.layers.placement import Box, placed_names
from mars2d.output.layers.table import Layers
from mars2d.output.layers.trails import trails
from mars2d.output.layers.velocities import velocities

if TYPE_CHECKING:
    from matplotlib.artist import Artist
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

NAME_LIMIT = 24

FAINT_AREA = 0.1
"""The highest opacity of an area that a sensor covers."""

INK, MUTED, GRID = SCREEN.ink, SCREEN.muted, SCREEN.grid

WORKSPACE = 1.0
"""The zorder of the workspace; the grid has 1.5, shapes have 2."""

ARROWS = {"forces": forces, "impulses": impulses, "velocities": velocities}
"""The layers whose arrows have a scale in a corner."""

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
    look = style_of(style)
    view = View.of(record, len(record) - 1)
    record = look.restyled(record)
    layers = layers or layers_of(record.scenario, paths=True)
    own = ax is None
    with look.fonts():
        if ax is None:
            width, height = _page(look, record.scenario, view)
            ax = new_figure(width, height).add_subplot()
        else:
            check_axes(ax)
            if ax.has_data():  # a second record on top of a first one
                view = view.union((*ax.get_xlim(), *ax.get_ylim()))
        dress(ax, record.scenario, view, look, layers)
        label(ax, look=look)
        _set_title(ax, f"{record.scenario.title}, {_time(float(record.time[-1]))}", look)
        _add_legend(ax, record.scenario, look)
        if own:
            ax.get_figure().draw_without_rendering()  # type: ignore[union-attr]
            show_in_notebooks(ax)
        paint_row(ax, record, len(record) - 1, look, layers)
    return ax


def _page(look: Style, scenario: Scenario, view: View) -> tuple[float, float]:
    """Return the size of a figure with one drawing, inches."""
    if look.page is not None:
        return look.page
    beside = 0.8 * look.label / SCREEN.label + _legend_width(scenario, look)
    if look.single is None:
        width, height = view.inches(5.2, 4.8)
        return width + beside, height + 0.9
    _, height = view.inches(look.single - beside, 1.5 * look.single)
    return look.single, height + 0.5


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
    look = style_of(style)
    rows = rows_at(record, times)
    with look.fonts():
        return _snapshots(look.restyled(record), rows, figure, look, layers)


def _snapshots(
    record: Rows, rows: list[int], figure: Figure | None, look: Style, layers: Layers | None
) -> Figure:
    scenario = record.scenario
    view = View.of(record, max(rows))
    ratio = view.width / view.height
    cols = _columns(len(rows), ratio, look.page)
    lines = ceil(len(rows) / cols)
    own = figure is None
    if figure is None:
        figure = new_figure(*_page_of_panels(look, scenario, view, cols, lines))
    panels = figure.subplots(lines, cols, squeeze=False).ravel().tolist()
    for unused in panels[len(rows) :]:
        unused.remove()
    for k, (ax, row) in enumerate(zip(panels, rows, strict=False)):
        dress(ax, scenario, view, look, layers)
        label(ax, below=k + cols >= len(rows), beside=k % cols == 0, look=look)
        ax.set_title(_time(float(record.time[row])), fontsize=look.label, color=look.ink)
    _add_legend(panels[min(cols, len(rows)) - 1], scenario, look)
    if look.title:
        heading = _wrapped(scenario.title, figure.bbox.width / figure.dpi, look)
        figure.suptitle(heading, fontsize=look.title, color=look.ink, parse_math=False)
    if own:
        figure.draw_without_rendering()
        figure.__dict__["_repr_png_"] = partial(_png, figure)
    for ax, row in zip(panels, rows, strict=False):
        paint_row(ax, record, row, look, layers)
    return figure


def _page_of_panels(
    look: Style, scenario: Scenario, view: View, cols: int, lines: int
) -> tuple[float, float]:
    """Return the size of a figure with drawings in columns and lines, inches."""
    if look.page is not None:
        return look.page
    beside = 0.6 + _legend_width(scenario, look)
    if look.full is None:
        room = min(3.2, 9.6 / cols)
        width, height = view.inches(room, room)
        return cols * (width + 0.25) + beside, lines * (height + 0.4) + 0.9
    _, height = view.inches((look.full - beside) / cols - 0.1, look.full)
    return look.full, lines * (height + 0.25) + 0.4


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
        figure, made = (
            draw(),
            BytesIO(),
        )  # in memory: on a full disk, errors of matplotlib would hide the cause
        figure.savefig(
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
    """Set limits, grid and ticks."""
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
    layers = layers or layers_of(scenario)
    if layers.grid:
        ax.grid(visible=True, color=look.grid, linewidth=0.6 * look.stroke)
    else:
        ax.grid(visible=False)
    edge = scenario.workspace is None
    ax.spines[:].set(color=look.grid, linewidth=0.8 * look.stroke, visible=edge)


def style_ticks(ax: Axes, look: Style) -> None:
    """Style the labels of ticks, including those made later."""
    ax.tick_params(which="both", length=0, labelsize=look.small, labelcolor=look.muted)
    if look.family:
        ax.tick_params(which="both", labelfontfamily=list(look.family))


def line_style(dash: str) -> Any:
    """Return Matlab's name of a line style, typed for matplotlib, which uses the same names."""
    return dash


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


def paint_row(
    ax: Axes, record: Rows, row: int, look: Style = SCREEN, layers: Layers | None = None
) -> None:
    """Paint the layers at a row; layers: the switches, as in `plot_paths`."""
    now = record.frame(row)
    animation = record.scenario.animation
    layers = layers or layers_of(record.scenario)
    _set_ticks(ax, TICK_SPACING * look.small / SCREEN.small)  # again: the layout is known now
    scales = _scales(ax, record.scenario, look)
    words = 0.65 * look.small / SCREEN.small
    level = WORKSPACE  # the grid lies between this and the level of all later layers
    for layer in layers.seen(animation):
        if layer.name in ("edge", "obstacles"):
            level = SHAPES
        if layer.shapes is None:
            continue
        scene = layer.shapes(now)
        if layer.name == "names":
            scene = _names_apart(scene, ax, now, words, layers)
        if layer.name == "workspace":  # its edge is a layer of its own
            scene = Scene([_without_edge(shape) for shape in scene.shapes])
        elif layer.name == "trails":
            scene = _told_apart(now, look)
        elif layer.name == "sensors":
            scene = Scene([_faint(shape) for shape in scene.shapes])
        scale = scales.get(layer.name, scales["bodies"])
        texts = scale if layer.name in ("floor", "addons", "theory") else words
        before = len(ax.patches)
        lines: list[Shape] = [each for each in scene.shapes if not isinstance(each, Text)]
        paint(Scene(lines), ax, scale=scale, level=level)
        letters: list[Shape] = [each for each in scene.shapes if isinstance(each, Text)]
        paint(Scene(letters), ax, scale=texts, level=level)
        if layer.name == "workspace" and scene.shapes:
            for line in (*ax.get_xgridlines(), *ax.get_ygridlines()):
                line.set_clip_path(ax.patches[before])
    _paint_legend(ax, now, layers, scales["bodies"], words)
    _paint_signs(ax, now, layers, words)


def _names_apart(names: Scene, ax: Axes, now: Frame, words: float, layers: Layers) -> Scene:
    """Return the names of bodies, none over another or over a force that is drawn.

    words: the factor for the size of text.
    """
    (xmin, xmax), (ymin, ymax) = ax.get_xlim(), ax.get_ylim()
    view = Box((xmin + xmax) / 2, (ymin + ymax) / 2, (xmax - xmin) / 2, (ymax - ymin) / 2)
    scenes = [drawn(now) for name, drawn in ARROWS.items() if getattr(layers, name)]
    scenes += _arrow_legend(ax, now, layers)
    others = [shape for scene in scenes for shape in scene.shapes]
    return placed_names(names, now, words / points_per_metre(ax), view, others)


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


def _paint_legend(ax: Axes, now: Frame, layers: Layers, scale: float, words: float) -> None:
    """Paint the scales of forces and impulses in a corner."""
    arrows, text = _arrow_legend(ax, now, layers)
    paint(arrows, ax, scale=scale)
    paint(text, ax, scale=words)


def _paint_signs(ax: Axes, now: Frame, layers: Layers, words: float) -> None:
    """Paint the legend of the layers' signs in a corner, above the scale of forces, if any."""
    shown = [
        legend
        for legend in legends(now.scenario)
        if legend.layer in SIGNED and getattr(layers, legend.layer)
    ]
    (xmin, xmax), (ymin, ymax) = ax.get_xlim(), ax.get_ylim()
    up = 0.13 if layers.forces else 0.05
    corner = xmin + 0.02 * (xmax - xmin), ymin + up * (ymax - ymin)
    paint(sign_rows(shown, corner, words / points_per_metre(ax)), ax, scale=words)


def _arrow_legend(ax: Axes, now: Frame, layers: Layers) -> tuple[Scene, Scene]:
    """Return arrows of round sizes in a corner, one above the other, and their numbers.

    That of forces is always there, others where they are needed: that of impulses after a blow, and
    one with a cut where an arrow is shortened.
    """
    rows: list[tuple[Float, str, str, bool]] = []
    (xmin, xmax), (ymin, ymax) = ax.get_xlim(), ax.get_ylim()
    for legend in legends(now.scenario):
        ruler, drawn = legend.ruler, ARROWS.get(legend.layer)
        if ruler is None or drawn is None or not getattr(layers, legend.layer):
            continue
        scene = drawn(now)
        if not scene.shapes and legend.layer != "forces":
            continue
        length, words = ruler.within(0.14 * (xmax - xmin))
        rows.append((np.array([length, 0.0]), words, ruler.color, False))
        if has_cut(scene):
            way = np.array([0.06 * (xmax - xmin), 0.0])
            rows.append(
                (way, f"over {ruler.in_words(ruler.longest / ruler.unit)}", ruler.color, True)
            )
    pictures, text = Scene(), Scene()
    foot, line = ymin + 0.05 * (ymax - ymin), 1.7 * LABEL_SIZE / points_per_metre(ax)
    for k, (way, words, color, shortened) in enumerate(rows):
        tail = np.array([xmin + 0.03 * (xmax - xmin), foot + k * line])
        arrow(pictures, tail, way, fill=color, width=3.0, shortened=shortened)
        text.text(tail + way, words, color=color, size=LABEL_SIZE, anchor="left", halo=EDGE)
    return pictures, text


def _told_apart(now: Frame, look: Style) -> Scene:
    """Return the paths: without colours with a line style for each robot, and paler for many."""
    scenario, styles = now.scenario, None
    if look.greys and scenario.animation.wake_style == "-":
        styles = [look.dash(k) for k in range(len(scenario.robots))]
    paths = trails(now, styles)
    if len(scenario.robots) > LEGEND_LIMIT:
        paths = Scene([_paler(shape) for shape in paths.shapes])
    return paths


def _paler(shape: Shape) -> Shape:
    """Return a fainter line, so that robots stand out from their paths."""
    return replace(shape, stroke=faded(shape.stroke, 0.5)) if isinstance(shape, Line) else shape


def _without_edge(shape: Shape) -> Shape:
    """Return a polygon's area alone."""
    return replace(shape, stroke=None) if isinstance(shape, Polygon) else shape


def _faint(shape: Shape) -> Shape:
    """Return a sensor's shape with faint lines and areas, so that paths stand out."""
    if isinstance(shape, (Circle, Polygon)) and shape.fill and len(shape.fill) > len("#rrggbb"):
        opacity = int(shape.fill[7:], 16) / 255
        return replace(shape, fill=faded(shape.fill, min(opacity, FAINT_AREA)))
    return _paler(shape)


def _set_title(ax: Axes, title: str, look: Style) -> None:
    if not look.title:
        return
    ax.apply_aspect()
    room = 1.25 * ax.get_window_extent().width / ax.get_figure().dpi  # type: ignore[union-attr]
    ax.set_title(_wrapped(title, room, look), fontsize=look.title, color=look.ink, parse_math=False)


def _wrapped(title: str, room: float, look: Style) -> str:
    """Return a title wrapped to a width, inches."""
    letters = max(20, int(room * 120 / look.title))
    return textwrap.fill(title, letters, max_lines=3, placeholder=" …")


def _time(seconds: float) -> str:
    return f"t = {seconds:.10g} s"


class _Entry(NamedTuple):
    """An entry of the legend: a name, and the first robot that it stands for."""

    name: str
    robot: int


def _entries(scenario: Scenario, look: Style) -> list[_Entry]:
    """Return an entry for robots that look alike, or none if there are too many robots."""
    if len(scenario.robots) > LEGEND_LIMIT:
        return []
    alike: dict[object, list[int]] = {}
    for i, color in enumerate(scenario.colors):
        alike.setdefault(i if look.greys else color, []).append(i)
    names = [str(robot.name) for robot in scenario.robots]
    return [
        _Entry(plain_name(_joined([names[i] for i in same])), same[0]) for same in alike.values()
    ]


def _joined(names: list[str]) -> str:
    """Return the names of robots that look alike as one: with their number, if they are many."""
    return ", ".join(names) if len(names) < 3 else f"{names[0]} and {len(names) - 1} alike"


def plain_name(name: str) -> str:
    """Return a name for a legend: on one line, and shortened if long."""
    name = " ".join(name.split())
    return name if len(name) <= NAME_LIMIT else name[: NAME_LIMIT - 1] + "…"


def _legend_width(scenario: Scenario, look: Style) -> float:
    """Return the approximate width of the legend, inches."""
    names = [entry.name for entry in _entries(scenario, look)]
    return (0.3 + 0.075 * max(map(len, names))) * look.small / SCREEN.small if names else 0.0


def _add_legend(ax: Axes, scenario: Scenario, look: Style) -> None:
    """Add a legend of the robots beside the drawing, if they are few."""
    from matplotlib.lines import Line2D

    entries = _entries(scenario, look)
    if not entries:
        return
    handles: list[Artist] = [
        Line2D(
            [], [], linestyle=line_style(look.dash(entry.robot) if look.greys else ""),
            linewidth=1.5 * look.stroke, marker="o", markersize=6 * look.small / SCREEN.small,
            color=scenario.colors[entry.robot], markeredgewidth=0,
        )
        for entry in entries
    ]  # fmt: skip
    legend = ax.legend(
        handles, ["robot"] * len(entries), loc="upper left",
        bbox_to_anchor=(1.0, 1.0), borderaxespad=0.3,
        frameon=False, fontsize=look.small, labelcolor=look.ink,
        handletextpad=0.6 if look.greys else 0.1, handlelength=3.0 if look.greys else 1.5,
    )  # fmt: skip
    for text, entry in zip(legend.get_texts(), entries, strict=True):
        text.set_parse_math(False)
        text.set_text(entry.name)  # only now: a legend leaves out labels that begin with "_"


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


def show_in_notebooks(ax: Axes) -> None:
    """Let notebooks show the axes or their figure, by the method `_repr_png_`."""
    figure: Any = ax.get_figure()
    ax.__dict__["_repr_png_"] = figure.__dict__["_repr_png_"] = partial(_png, figure)


def _png(figure: Figure) -> bytes:
    file = BytesIO()
    figure.savefig(file, format="png", dpi=120, bbox_inches="tight", pad_inches=0.1)
    return file.getvalue()
