"""Legends of figures: curves and robots by their looks, and the signs of layers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from mars2d.output.figures.style import SCREEN, Style
from mars2d.output.layers.arrows import Sign

if TYPE_CHECKING:
    from matplotlib.axes import Axes

NAME_LIMIT = 24
BESIDE: dict[str, Any] = {
    "loc": "upper left", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.0, "borderpad": 0.4,
}  # fmt: skip
"""The place of a legend at the right side of its axes, with some room at its own right."""


class Entry(NamedTuple):
    """A curve's entry in a legend: its name, colour, line style, width [points] and marker."""

    name: str
    color: str
    dash: str
    width: float
    marker: str = ""
    hollow: bool = False


def add_legend(ax: Axes, entries: Sequence[Entry | Sign], look: Style, **place: Any) -> None:
    """Add a legend to axes, beside others that they have; place: options of matplotlib's."""
    if not entries:
        return
    from matplotlib.lines import Line2D

    from mars2d.output.figures.handler import SignHandler

    handles: list[Any] = [
        entry
        if isinstance(entry, Sign)
        else Line2D(
            [], [], color=entry.color, linestyle=_dash_of(entry), linewidth=entry.width,
            marker=entry.marker, markersize=0.67 * look.small,
            markerfacecolor="white" if entry.hollow else entry.color,
            markeredgewidth=entry.width if entry.hollow else 0.0,
        )
        for entry in entries
    ]  # fmt: skip
    legend = ax.legend(
        handles, [entry.name for entry in entries], frameon=False, fontsize=look.small,
        labelcolor=look.ink, handlelength=column_width(entries, look) / look.small,
        columnspacing=1.2, handletextpad=0.5, labelspacing=0.3,
        handler_map={Sign: SignHandler(sign_scale(look))},
        **({"borderpad": 0.0, "borderaxespad": 0.3} | place),
    )  # fmt: skip
    ax.add_artist(legend)  # a further one of these axes would take its place
    legend.set_clip_on(False)
    for text in legend.get_texts():
        text.set_parse_math(False)


def _dash_of(entry: Entry) -> Any:
    """Return an entry's line style, which Matlab and matplotlib name alike."""
    return entry.dash or "none"


def column_width(entries: Sequence[Entry | Sign], look: Style) -> float:
    """Return the width of the column of lines and signs in a legend, points."""
    lines = any(isinstance(entry, Entry) and entry.dash for entry in entries)
    own = look.small * ((3.2 if look.greys else 2.0) if lines else 1.0)
    rooms = [entry.room for entry in entries if isinstance(entry, Sign)]
    return max(own, sign_scale(look) * max(rooms, default=0.0))


def sign_scale(look: Style) -> float:
    """Return the factor for the size of signs, which are made for the window."""
    return 0.65 * look.small / SCREEN.small


def plain_name(name: str) -> str:
    """Return a name for a legend: on one line, and shortened if long."""
    name = " ".join(name.split())
    return name if len(name) <= NAME_LIMIT else name[: NAME_LIMIT - 1] + "…"
