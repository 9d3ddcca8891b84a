"""Arrows whose length is a quantity; longer ones than the longest are shortened by one rule."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Anchor, Line, Scene

Float = NDArray[np.float64]

EDGE = "#ffffff"
"""The colour of the thin edges that set arrows off from their background."""

LABEL_SIZE = 13.0
"""The height of the number beside an arrow, points."""

CUT_WIDTH = 2.0
"""The width of the strokes of a cut, points."""

LONGEST = 2.5
"""The length of the longest arrow, as a multiple of that of the quantity's usual bound."""


def shortening(length: Float, longest: float) -> Float:
    """Return the factors by which arrows of these lengths are drawn shorter; 1 for most.

    The rule: an arrow longer than `longest` is drawn that long, with a cut through it.
    """
    return np.asarray(longest / np.maximum(length, longest))


def arrow(
    scene: Scene,
    start: Float,
    way: Float,
    *,
    fill: str,
    width: float,
    edge: str | None = EDGE,
    shortened: bool = False,
) -> None:
    """Draw an arrow from a point along `way`, both (2,) metres; a cut says that it is shortened."""
    scene.arrow(start, start + way, fill=fill, stroke=edge, width=width)
    if shortened:
        _cut(scene, start, way)


def _cut(scene: Scene, start: Float, way: Float) -> None:
    """Draw a gap across an arrow that is not as long as it should be."""
    slant = 0.06 * np.array([way[0] - way[1], way[0] + way[1]])
    for share in (0.42, 0.5):
        middle = start + share * way
        scene.line([middle - slant, middle + slant], stroke=EDGE, width=CUT_WIDTH)


def has_cut(scene: Scene) -> bool:
    """Return whether an arrow of a layer is shortened."""
    return any(
        isinstance(shape, Line) and (shape.stroke, shape.width) == (EDGE, CUT_WIDTH)
        for shape in scene.shapes
    )


def beside(scene: Scene, point: Float, way: Float, words: str, color: str) -> None:
    """Write a number beside a point, along `way`: beyond the tip of an arrow, for example."""
    across = abs(way[0]) > abs(way[1])
    side: Anchor = ("left" if way[0] > 0 else "right") if across else "above"
    if not across and way[1] < 0:
        side = "below"
    scene.text(point, words, color=color, size=LABEL_SIZE, anchor=side, halo=EDGE)
