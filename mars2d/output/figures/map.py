"""A picture of a map read from a file: its pieces in the colours of their layers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from mars2d.addons.maps import Drawing
from mars2d.core.scene import PALETTE
from mars2d.output.figures.extent import View
from mars2d.output.figures.figure import dress_plane, label, new_axes, save_drawing
from mars2d.output.figures.legend import BESIDE, Entry, add_legend, legend_width
from mars2d.output.figures.style import INK, TITLE, points

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ROOM = (8.0, 8.0)
"""The room for the drawing, inches."""

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
    names, counts = list(drawing.layers), drawing.layers
    colors = {names[0]: INK} if len(names) == 1 else dict(zip(names, PALETTE, strict=False))
    rows = [(color, f"{_short(name)}  {counts[name]}") for name, color in colors.items()]
    rest = [count for name, count in counts.items() if name not in colors]
    if rest:
        rows.append((REST_COLOR, f"{len(rest)} more  {sum(rest)}"))
    entries = [Entry(said, color, "-", 4.0) for color, said in rows] if len(names) > 1 else []
    margin, least = 0.03 * max(drawing.size), max(drawing.size) / View.RATIO
    xmin, xmax, ymin, ymax = drawing.bounds
    more_x, more_y = (margin + max(0.0, least - side) / 2 for side in drawing.size)
    view = View(xmin - more_x, xmax + more_x, ymin - more_y, ymax + more_y)
    (ax,) = new_axes(view, beside=legend_width(entries), room=ROOM)
    dress_plane(ax, view)
    label(ax)
    title = f"{drawing.source}, {drawing.size[0]:.3g} m x {drawing.size[1]:.3g} m"
    ax.set_title(title, fontsize=points(TITLE), color=INK, parse_math=False)
    for name in reversed(names):  # the layers with most pieces on top
        _paint(ax, drawing, name, colors.get(name, REST_COLOR))
    add_legend(ax, entries, **BESIDE)
    return ax.figure  # type: ignore[return-value]


def _paint(ax: Axes, drawing: Drawing, layer: str, color: str) -> None:
    """Paint the pieces of one layer."""
    import shapely
    from shapely.plotting import plot_line, plot_polygon

    pieces = [piece.geometry for piece in drawing.pieces if piece.layer == layer]
    areas = [piece for piece in pieces if piece.geom_type == "Polygon"]
    walls = [piece for piece in pieces if piece.geom_type != "Polygon"]
    look = {"ax": ax, "add_points": False, "color": color, "zorder": 2}
    if areas:
        plot_polygon(shapely.MultiPolygon(areas), linewidth=0.3, alpha=0.85, **look)
    if walls:
        plot_line(shapely.MultiLineString(walls), linewidth=1.2, capstyle="round", **look)


def _short(name: str) -> str:
    """Return a layer's name; a long one keeps its end, since bound drawings add a prefix."""
    return name if len(name) <= NAME_LIMIT else f"…{name[1 - NAME_LIMIT :]}"
