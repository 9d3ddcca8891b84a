"""Shapes drawn with smooth edges, in pixels.

A shape that is drawn enlarged on a surface of its own and averaged by `smoothscale` has exact
coverage, for any shape, width and opacity.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from math import ceil, floor

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.output.raster.strokes import clip_lines, hairlines

Float = NDArray[np.float64]
Rgba = tuple[int, int, int, int]
LARGE_AREA = 40_000
"""The area from which lines are drawn without enlargement, pixels."""


@cache
def rgba(color: str) -> Rgba:
    """Return ``#rrggbb`` or ``#rrggbbaa`` as four numbers from 0 to 255."""
    digits = color[1:] + ("ff" if len(color) == 7 else "")
    return int(digits[:2], 16), int(digits[2:4], 16), int(digits[4:6], 16), int(digits[6:8], 16)


def box_round(x: float, y: float, reach: float) -> pygame.Rect:
    """Return the rectangle of whole pixels that holds a circle and its soft edge."""
    left, top = floor(x - reach - 1), floor(y - reach - 1)
    return pygame.Rect(left, top, ceil(x + reach + 1) - left, ceil(y + reach + 1) - top)


MAX_PIXEL = 1e8


def extent_of(points: Float, margin: float) -> pygame.Rect:
    """Return the rectangle of whole pixels that holds points (k, 2) and a margin."""
    low, high = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    left, top = (floor(max(x - margin, -MAX_PIXEL)) for x in low)
    right, bottom = (ceil(min(x + margin, MAX_PIXEL)) for x in high)
    return pygame.Rect(left, top, right - left, bottom - top)


class Enlarged:
    """A surface on which shapes are drawn `factor` times larger, with its corner at (left, top)."""

    def __init__(self, surface: pygame.Surface, left: float, top: float, factor: float) -> None:
        self.surface, self.corner, self.factor = surface, (left, top), factor

    def _placed(self, points: Float) -> list[tuple[float, float]]:
        """Return points on the enlarged surface; pygame's pixel centres are whole numbers."""
        placed: list[tuple[float, float]] = ((points - self.corner) * self.factor - 0.5).tolist()
        return placed

    def disc(self, color: Rgba, x: float, y: float, radius: float, width: float = 0.0) -> None:
        """Draw a disc, or with a width a ring within the radius."""
        # Unlike lines and polygons, circles are centred on the corners between pixels.
        left, top = self.corner
        center = round((x - left) * self.factor), round((y - top) * self.factor)
        # A width of 0 would fill the ring.
        thick = max(1, round(width * self.factor)) if width > 0 else 0
        pygame.draw.circle(self.surface, color, center, max(radius * self.factor, 0.5), thick)

    def polygon(self, color: Rgba, points: Float) -> None:
        """Fill a polygon (k, 2)."""
        if len(points) > 2:
            pygame.draw.polygon(self.surface, color, self._placed(points))

    def box(self, color: Rgba, box: pygame.Rect, radius: float) -> None:
        """Fill a box with round corners."""
        (left, top), factor = self.corner, self.factor
        place = pygame.Rect(
            (box.left - left) * factor, (box.top - top) * factor,
            box.width * factor, box.height * factor,
        )  # fmt: skip
        pygame.draw.rect(self.surface, color, place, border_radius=round(radius * factor))

    def lines(self, color: Rgba, pieces: Sequence[Float], width: float) -> None:
        """Draw polylines (k, 2) with round joints and ends."""
        thick = max(1, round(width * self.factor))
        for piece in pieces:
            points = self._placed(piece)
            if len(points) > 1:
                pygame.draw.lines(self.surface, color, False, points, thick)
            if thick > 2:
                for x, y in points:  # round joints and ends
                    center = round(x + 0.5), round(y + 0.5)
                    pygame.draw.circle(self.surface, color, center, thick / 2)

    def hairlines(self, color: Rgba, pieces: Sequence[Float], width: float) -> None:
        """Draw polylines that span much of the picture, without enlargement."""
        for piece in pieces:
            hairlines(self.surface, color, (piece - self.corner) * self.factor - 0.5, width)


Draw = Callable[[Enlarged], object]


def cover(
    surface: pygame.Surface, color: Rgba, box: pygame.Rect, draw: Draw, factor: int = 0
) -> None:
    """Draw within `box` of a surface with smooth edges; see `layer`."""
    box = box.clip(surface.get_clip())
    if box.width > 0 and box.height > 0:
        surface.blit(layer(color, box, draw, factor), box.topleft)


def layer(color: Rgba, box: pygame.Rect, draw: Draw, factor: int = 0) -> pygame.Surface:
    """Return a transparent surface of the size of `box`, with a drawing on it.

    color: of its edge, so that averaging changes the opacity alone. factor: the scale at which it
    is drawn before it is averaged; 0 chooses by the size.
    """
    if factor == 0:
        factor = 4 if box.width * box.height < 250_000 else 2
    large = pygame.Surface((box.width * factor, box.height * factor), pygame.SRCALPHA, 32)
    large.fill((*color[:3], 0))
    draw(Enlarged(large, box.left, box.top, factor))
    return large if factor == 1 else pygame.transform.smoothscale(large, box.size)


def in_sight(surface: pygame.Surface) -> tuple[float, float, float, float]:
    """Return the box of pixels outside which shapes need not be drawn."""
    clip = surface.get_clip()
    return clip.left - 50.0, clip.top - 50.0, clip.right + 50.0, clip.bottom + 50.0


def ring(x: float, y: float, radius: float) -> Float:
    """Return the corners of a closed polygon close to a circle, (k, 2)."""
    angles = np.linspace(0, 2 * np.pi, int(min(max(radius, 60), 1500)))
    return np.column_stack([x + radius * np.cos(angles), y + radius * np.sin(angles)])


def stroke(surface: pygame.Surface, color: Rgba, pieces: list[Float], width: float) -> None:
    """Draw polylines as one shape: where they cross, their opacity does not add up."""
    box = in_sight(surface)
    pieces = [part for piece in pieces for part in clip_lines(piece, box) if len(part)]
    if pieces:
        extent = extent_of(np.vstack(pieces), width / 2 + 1)
        if extent.width * extent.height > LARGE_AREA:
            cover(surface, color, extent, lambda on: on.hairlines(color, pieces, width), factor=1)
        else:
            cover(surface, color, extent, lambda on: on.lines(color, pieces, width))


def mark(
    marker: str, color: Rgba, x: float, y: float, ui: float, width: float
) -> tuple[Draw, float]:
    """Return what draws one of the marks ``. o x + * s``, and its radius, pixels."""
    if marker == ".":
        return lambda on: on.disc(color, x, y, 2.2 * ui), 2.2 * ui
    if marker == "o":
        reach = 3.2 * ui + width
        return lambda on: on.disc(color, x, y, reach - width / 2, width), reach
    r = 3.2 * ui
    spokes = {
        "x": [(-r, -r, r, r), (-r, r, r, -r)],
        "+": [(-r, 0, r, 0), (0, -r, 0, r)],
        "*": [(0, -r, 0, r), (-0.87 * r, -r / 2, 0.87 * r, r / 2),
              (-0.87 * r, r / 2, 0.87 * r, -r / 2)],
        "s": [(-r, -r, r, -r), (r, -r, r, r), (r, r, -r, r), (-r, r, -r, -r)],
    }[marker]  # fmt: skip
    pieces = [np.array([(x + a, y + b), (x + c, y + d)]) for a, b, c, d in spokes]
    return lambda on: on.lines(color, pieces, width), r + width
