"""Legends of figures: curves and robots by their looks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from mars2d.output.figures.style import INK, SMALL, points

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


def add_legend(ax: Axes, entries: Sequence[Entry], **place: Any) -> None:
    """Add a legend to axes, beside others that they have; place: options of matplotlib's."""
    if not entries:
        return
    from matplotlib.lines import Line2D

    small = points(SMALL)
    dashes: list[Any] = [entry.dash or "none" for entry in entries]
    handles = [
        Line2D(
            [], [], color=entry.color, linestyle=dash, linewidth=entry.width,
            marker=entry.marker, markersize=0.67 * small,
            markerfacecolor="white" if entry.hollow else entry.color,
            markeredgewidth=entry.width if entry.hollow else 0.0,
        )
        for entry, dash in zip(entries, dashes, strict=True)
    ]  # fmt: skip
    before = ax.get_legend()
    legend = ax.legend(
        handles, [entry.name for entry in entries], frameon=False, fontsize=small, labelcolor=INK,
        handlelength=2.0 if any(entry.dash for entry in entries) else 1.0, columnspacing=1.2,
        handletextpad=0.5, labelspacing=0.3, **({"borderpad": 0.0, "borderaxespad": 0.3} | place),
    )  # fmt: skip
    if before is not None:
        ax.add_artist(before)  # whose place the new one takes
    legend.set_clip_on(False)
    for text in legend.get_texts():
        text.set_parse_math(False)


def legend_width(entries: Sequence[Entry]) -> float:
    """Return the approximate width of a legend, inches."""
    return points(SMALL) / 72 * (3.5 + 0.6 * max((len(each.name) for each in entries), default=-4))


def plain_name(name: str) -> str:
    """Return a name for a legend: on one line, and shortened if long."""
    name = " ".join(name.split())
    return name if len(name) <= NAME_LIMIT else name[: NAME_LIMIT - 1] + "…"
