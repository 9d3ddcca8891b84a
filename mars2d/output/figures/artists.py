"""Scenes as matplotlib artists: lines and patches on axes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import (
    Arrow,
    Circle,
    Image,
    Line,
    Polygon,
    Scene,
    Text,
    split_wake_style,
)
from mars2d.output.lines import MARK_SPACING, SHIFTS, TEXT_GAP, arrow_outline, spaced

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

Float = NDArray[np.float64]

SHAPES = 2.0
"""The default zorder of shapes."""

# Matlab's marks: matplotlib's name of each, whether it is filled, its diameter in points.
MARKS: dict[str, tuple[Any, bool, float]] = {
    ".": ("o", True, 4.4),
    "o": ("o", False, 6.4),
    "x": ("x", True, 6.4),
    "+": ("+", True, 6.4),
    "*": ((6, 2, 0), True, 6.4),
    "s": ("s", False, 6.0),
}


def paint(
    scene: Scene, ax: Axes, *, scale: float = 1.0, words: float | None = None, level: float = SHAPES
) -> None:
    """Paint the shapes of a scene on matplotlib axes, in metres, the first one lowest.

    scale: a factor for line widths and marks [points]. words: that for the heights of texts, by
    default the same. level: the zorder of all shapes. A circle's `pixels` are points of the page.
    If it also has a radius, they are converted to metres with the present limits of the axes, so
    set the limits first.
    """
    ppm = points_per_metre(ax)
    for shape in scene.shapes:
        if isinstance(shape, Text):
            _write(shape, ax, scale if words is None else words, level)
        elif isinstance(shape, Image):
            _show(shape, ax, level)
        else:
            for artist in artists(shape, scale, ppm):
                artist.set_zorder(level)
                artist.set_in_layout(False)  # it stays within the axes
                ax.add_artist(artist)


def artists(
    shape: Circle | Line | Polygon | Arrow, scale: float, ppm: float
) -> Iterator[Line2D | Patch]:
    """Yield the artists of a shape, the first one lowest; ppm: the points of a metre."""
    from matplotlib import patches
    from matplotlib.lines import Line2D

    if isinstance(shape, Line):
        yield _line(shape, scale, ppm)
        return
    fill, edge = shape.fill or "none", shape.stroke or "none"
    width = shape.width * scale if shape.stroke else 0.0
    colors: dict[str, Any] = {"facecolor": fill, "edgecolor": edge, "joinstyle": "round"}
    if isinstance(shape, Arrow):
        points = arrow_outline(shape.tail, shape.tip, shape.width * scale / ppm)
        yield patches.Polygon(points, linewidth=0.8 * width, **colors)
        yield patches.Polygon(points, linewidth=0.0, **colors)
    elif isinstance(shape, Polygon):
        if len(shape.points):
            yield patches.Polygon(shape.points, linewidth=width, **colors)
    elif shape.radius == 0:  # a mark, which keeps its size when zoomed
        (x, y), size = shape.center, 2 * shape.pixels * scale
        yield Line2D(
            [x], [y], linestyle="none", marker="o", markersize=size, markerfacecolor=fill,
            markeredgecolor=edge, markeredgewidth=width,
        )  # fmt: skip
    else:
        radius = shape.radius + shape.pixels * scale / ppm
        yield patches.Circle(shape.center, radius, linewidth=width, **colors)


def _show(shape: Image, ax: Axes, level: float) -> None:
    from matplotlib.image import AxesImage

    image = AxesImage(ax, extent=shape.bounds, origin="upper", zorder=level)
    image.set_data(shape.pixels)
    image.set_in_layout(False)
    ax.add_artist(image)


def _line(shape: Line, scale: float, ppm: float) -> Line2D:
    from matplotlib.lines import Line2D

    mark, dash = split_wake_style(shape.style)
    style: Any = dash or "none"  # Matlab and matplotlib name line styles alike
    line = Line2D(
        shape.points[:, 0], shape.points[:, 1], color=shape.stroke, linewidth=shape.width * scale,
        linestyle=style, solid_capstyle="butt" if len(shape.points) == 2 else "round",
        solid_joinstyle="round",
    )  # fmt: skip
    if mark:
        name, filled, size = MARKS[mark]
        line.set_marker(name)
        line.set_markersize(size * scale)
        line.set_markeredgewidth(0.0 if mark == "." else shape.width * scale)
        line.set_markerfacecolor(shape.stroke if filled else "none")
        line.set_markevery(spaced(shape.points, MARK_SPACING * scale / ppm).tolist())
    return line


def _write(shape: Text, ax: Axes, scale: float, level: float) -> None:
    dx, dy = SHIFTS.get(shape.anchor, (0, 0))
    label = ax.annotate(
        shape.text,
        shape.position,
        xytext=(dx * TEXT_GAP * scale, dy * TEXT_GAP * scale),
        textcoords="offset points",
        color=shape.color,
        fontsize=shape.size * scale,
        horizontalalignment="left" if dx > 0 else "right" if dx < 0 else "center",
        verticalalignment="bottom" if dy > 0 else "top" if dy < 0 else "center",
        annotation_clip=True,
        zorder=level,
    )
    if shape.halo:
        from matplotlib.patheffects import withStroke

        label.set_path_effects([withStroke(linewidth=2.5 * scale, foreground=shape.halo)])
    label.set_parse_math(False)
    label.set_clip_on(True)
    label.set_in_layout(False)


def points_per_metre(ax: Axes) -> float:
    """Return the points of the page per metre, with the present layout and limits."""
    figure: Any = ax.get_figure()
    box = ax.get_position(original=True)
    (xmin, xmax), (ymin, ymax) = ax.get_xlim(), ax.get_ylim()
    across = box.width * figure.bbox.width / abs(xmax - xmin)
    upwards = box.height * figure.bbox.height / abs(ymax - ymin)
    return float(72 / figure.dpi * min(across, upwards))
