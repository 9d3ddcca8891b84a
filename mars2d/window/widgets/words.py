"""Words on a line: labels from its left end, values from its right end."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import pygame

from mars2d.output.raster.painter import Painter

GAP = 8.0
"""The gap between two words, points."""


class Word(NamedTuple):
    """A word or more, and how it is written; size: of letters, points."""

    text: str
    color: str
    size: float = 12.5
    bold: bool = False


def write_line(
    surface: pygame.Surface,
    rect: pygame.Rect,
    painter: Painter,
    left: Sequence[Word] = (),
    right: Sequence[Word] = (),
) -> pygame.Rect:
    """Write words from both ends of a rectangle, in its middle; return what is free between.

    Those at the left are shortened where there is no room for them, or left out.
    """
    gap, free = round(GAP * painter.ui), rect.copy()
    for text, color, size, bold in reversed(right):
        place = painter.write(
            surface, text, size * painter.ui, color, bold=bold, midright=free.midright
        )
        free.width = place.left - gap - free.left
    for text, color, size, bold in left:
        short = painter.fonts.shorten(text, size * painter.ui, max(free.width, 0), bold=bold)
        if painter.fonts.width(short, size * painter.ui, bold=bold) > free.width:
            break
        place = painter.write(
            surface, short, size * painter.ui, color, bold=bold, midleft=free.midleft
        )
        free.width, free.left = free.right - place.right - gap, place.right + gap
    return free
