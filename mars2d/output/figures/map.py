"""A picture of a map read from a file: its pieces in the colours of their layers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mars2d.addons.maps import Drawing
from mars2d.core.plane import grid_step
from mars2d.core.scene import PALETTE
from mars2d.output.figures.figure import GRID, INK, MUTED, label, new_figure, save_drawing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LONG_SIDE, MIN_SIDE = 8.0, 1.6
"""The longer side of the drawing, and the least length of the other, inches."""

REST_COLOR = "#aab2bb"
"""The colour of layers beyond those of PALETTE, which are not named in the legend."""

NAME_LIMIT = 30


def save_map(drawing: Drawing, path: str | Path) -> Path:
    """Save a picture of a map as ``.png``, ``.pdf`` or ``.svg`` and return its path.

    Raises InputError for another suffix, and for a path that can't be written.
    """
    return save_drawing(lambda: plot_map(drawing), path)


def plot_map(drawing: Drawing) -> Figure:
    """Draw a map, areas filled and walls as lines, in a new figure with axes in metres."""
    width, height = (max(side, max(drawing.size) / 20) for side in drawing.size)
    scale = LONG_SIDE / max(width, height)
    legend = 0.5 + 0.075 * min(max(map(len, drawing.layers), default=0), NAME_LIMIT + 6)
    size = max(scale * width, MIN_SIDE) + 0.9 + legend, max(scale * height, MIN_SIDE) + 0.9
    figure = new_figure(*size)
    ax = figure.add_subplot()
    _dress(ax, drawing)
    names = list(drawing.layers)
    colors = {names[0]: INK} if len(names) == 1 else dict(zip(names, PALETTE, strict=False))
    for name in reversed(names):  # the layers with most pieces on top
        _paint(ax, drawing, name, colors.get(name, REST_COLOR))
    if len(names) > 1:
        _add_legend(ax, drawing, colors)
    return figure


def _dress(ax: Axes, drawing: Drawing) -> None:
    """Set limits, grid, ticks and title."""
    from matplotlib.ticker import MultipleLocator

    xmin, xmax, ymin, ymax = drawing.bounds
    longer = max(drawing.size)
    margin = 0.03 * longer
    ax.set_aspect("equal")
    ax.set_xlim(xmin - margin, xmax + margin)
    ax.set_ylim(ymin - margin, ymax + margin)
    step = grid_step(longer / 12)
    ax.xaxis.set_major_locator(MultipleLocator(step))
    ax.yaxis.set_major_locator(MultipleLocator(step))
    ax.set_axisbelow(True)
    ax.grid(visible=True, color=GRID, linewidth=0.6)
    ax.spines[:].set(color=GRID, linewidth=0.8)
    ax.tick_params(length=0, labelsize=9, labelcolor=MUTED)
    label(ax)
    width, height = drawing.size
    title = f"{drawing.source}, {width:.3g} m x {height:.3g} m"
    ax.set_title(title, fontsize=12, color=INK, parse_math=False)


def _paint(ax: Axes, drawing: Drawing, layer: str, color: str) -> None:
    """Paint the pieces of one layer."""
    import shapely
    from matplotlib.collections import LineCollection, PathCollection
    from matplotlib.path import Path as Outline

    walls, areas = [], []
    for piece in drawing.pieces:
        if piece.layer != layer:
            continue
        if piece.geometry.geom_type == "Polygon":
            rings = [shapely.get_coordinates(r) for r in shapely.get_rings(piece.geometry)]
            closed = [Outline(ring, closed=True) for ring in rings]
            areas.append(Outline.make_compound_path(*closed))
        else:
            walls.append(np.asarray(shapely.get_coordinates(piece.geometry)))
    ax.add_collection(
        PathCollection(areas, facecolor=color, edgecolor=color, linewidth=0.3, alpha=0.85),
        autolim=False,
    )
    ax.add_collection(
        LineCollection(walls, colors=color, linewidth=1.2, capstyle="round"), autolim=False
    )


def _add_legend(ax: Axes, drawing: Drawing, colors: dict[str, str]) -> None:
    """Add a legend of the layers beside the drawing, with their numbers of pieces."""
    from matplotlib.lines import Line2D

    rows = [(color, f"{_short(name)}  {drawing.layers[name]}") for name, color in colors.items()]
    rest = [count for name, count in drawing.layers.items() if name not in colors]
    if rest:
        rows.append((REST_COLOR, f"{len(rest)} more  {sum(rest)}"))
    handles = [Line2D([], [], color=color, linewidth=4) for color, _ in rows]
    legend = ax.legend(
        handles, ["layer"] * len(rows), loc="upper left", bbox_to_anchor=(1.0, 1.0),
        borderaxespad=0.3, frameon=False, fontsize=9, labelcolor=INK, handlelength=1.0,
    )  # fmt: skip
    for text, (_, said) in zip(legend.get_texts(), rows, strict=True):
        text.set_parse_math(False)
        text.set_text(said)


def _short(name: str) -> str:
    """Return a layer's name; a long one keeps its end, since bound drawings add a prefix."""
    return name if len(name) <= NAME_LIMIT else f"…{name[1 - NAME_LIMIT :]}"
