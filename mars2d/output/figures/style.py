"""The looks that figures share: colours of text, axes and curves, and heights of text."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mars2d.scenario.scenario import Scenario

INK, MUTED, GRID, LINE = "#1f2933", "#616e7c", "#e6e9ed", "#c3cad2"
"""The colours of text, of ticks, of the grid, and of axes."""

CURVES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#7a5c2e")
"""The colours of curves that belong to no single robot."""

DASHES = ("-", "--", ":", "-.")
"""Line styles that tell curves of one colour apart, named as in matplotlib and Matlab."""

TITLE, SMALL = 1.2, 0.9
"""Heights of text: of titles, and of ticks and legends."""


def points(share: float = 1.0) -> float:
    """Return a height of text, points: a share of matplotlib's setting ``font.size``."""
    import matplotlib as mpl

    return share * float(mpl.rcParams["font.size"])


def curve_color(index: int) -> str:
    """Return the colour of a curve that belongs to no single robot."""
    return CURVES[index % len(CURVES)]


def robot_curve(scenario: Scenario, index: int) -> tuple[str, str]:
    """Return the colour and line style of a robot's curve; dashes tell equal colours apart."""
    colors = scenario.colors
    return colors[index], DASHES[colors[:index].count(colors[index]) % len(DASHES)]
