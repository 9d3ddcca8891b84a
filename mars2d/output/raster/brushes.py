"""Brushes: functions that draw shapes, in pixels, several times enlarged.

A shape that is drawn enlarged on a surface of its own and averaged by `smoothscale` has exact
coverage, for any shape, width and opacity.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import ceil, floor

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.output.raster.strokes import clip_lines, hairlines

Float = NDArray[np.float64]
Rgba = tuple[int, int, int, int]
Draw = Callable[[pygame.Surface, float, float, float, Rgba], None]
"""Draws on a surface that is enlarged by `factor`, with its corner at (left, top)."""
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


def cover(
    surface: pygame.Surface, color: Rgba, box: pygame.Rect, draw: Draw, factor: int = 0
) -> None:
    """Draw within `box` of a surface with smooth edges; see `layer`."""
    box = box.clip(surface.get_clip())
    if box.width > 0 and box.height > 0:
        surface.blit(layer(color, box, draw, factor), box.topleft)


def layer(color: Rgba, box: pygame.Rect, draw: Draw, factor: int = 0) -> pygame.Surface:
    """Return a transparent surface of the size of `box`, with a drawing on it.

    factor: the scale at which it is drawn before it is averaged; 0 chooses by the size.
    """
    if factor == 0:
        factor = 4 if box.width * box.height < 250_000 else 2
    large = pygame.Surface((box.width * factor, box.height * factor), pygame.SRCALPHA, 32)
    draw_on(large, color, box, draw, factor)
    return large if factor == 1 else pygame.transform.smoothscale(large, box.size)


def draw_on(
    large: pygame.Surface, color: Rgba, box: pygame.Rect, draw: Draw, factor: int = 1
) -> None:
    """Draw within `box` on a surface that is `factor` times larger."""
    # The colour without opacity, so that averaging changes the opacity alone.
    large.fill((*color[:3], 0))
    draw(large, box.left, box.top, factor, color)


def scaled(points: Float, left: float, top: float, factor: float) -> list[tuple[float, float]]:
    """Return points on the enlarged surface; pygame's pixel centres are whole numbers."""
    large: list[tuple[float, float]] = ((points - (left, top)) * factor - 0.5).tolist()
    return large


def in_sight(surface: pygame.Surface) -> tuple[float, float, float, float]:
    """Return the box of pixels outside which shapes need not be drawn."""
    clip = surface.get_clip()
    return clip.left - 50.0, clip.top - 50.0, clip.right + 50.0, clip.bottom + 50.0


def ring(x: float, y: float, radius: float) -> Float:
    """Return the corners of a closed polygon close to a circle, (k, 2)."""
    angles = np.linspace(0, 2 * np.pi, int(min(max(radius, 60), 1500)))
    return np.column_stack([x + radius * np.cos(angles), y + radius * np.sin(angles)])


def disc(x: float, y: float, radius: float, width: float = 0.0) -> Draw:
    """Return a brush for a disc, or with a width for a ring within the radius."""

    def draw(large: pygame.Surface, left: float, top: float, factor: float, color: Rgba) -> None:
        # Unlike lines and polygons, circles are centred on the corners between pixels.
        center = (round((x - left) * factor), round((y - top) * factor))
        # A width of 0 would fill the ring.
        thick = max(1, round(width * factor)) if width > 0 else 0
        pygame.draw.circle(large, color, center, max(radius * factor, 0.5), thick)

    return draw


def filled(points: Float) -> Draw:
    """Return a brush for a filled polygon (k, 2)."""

    def draw(large: pygame.Surface, left: float, top: float, factor: float, color: Rgba) -> None:
        outline = scaled(points, left, top, factor)
        if len(outline) > 2:
            pygame.draw.polygon(large, color, outline)

    return draw


def edged(points: Float, fill: Rgba, edge: float) -> Draw:
    """Return a brush for a polygon (k, 2), filled over an edge in the ink."""
    ring = np.vstack([points, points[:1]])
    around, inside = stroked([ring], 2 * edge), filled(points)

    def draw(large: pygame.Surface, left: float, top: float, factor: float, color: Rgba) -> None:
        if edge:
            around(large, left, top, factor, color)
        inside(large, left, top, factor, fill)

    return draw


def outlined(points: Float, fill: Rgba, width: float) -> Draw:
    """Return a brush for a filled polygon (k, 2) with its edge on top in the ink."""
    inside, around = filled(points), stroked([np.vstack([points, points[:1]])], width)

    def draw(large: pygame.Surface, left: float, top: float, factor: float, color: Rgba) -> None:
        inside(large, left, top, factor, fill)
        around(large, left, top, factor, color)

    return draw


def rounded(box: pygame.Rect, radius: float) -> Draw:
    """Return a brush for a filled box with round corners."""

    def draw(large: pygame.Surface, left: float, top: float, factor: float, color: Rgba) -> None:
        place = pygame.Rect(
            (box.left - left) * factor, (box.top - top) * factor,
            box.width * factor, box.height * factor,
        )  # fmt: skip
        pygame.draw.rect(large, color, place, border_radius=round(radius * factor))

    return draw


def stroke(surface: pygame.Surface, color: Rgba, pieces: list[Float], width: float) -> None:
    """Draw polylines as one shape: where they cross, their opacity does not add up."""
    box = in_sight(surface)
    pieces = [part for piece in pieces for part in clip_lines(piece, box) if len(part)]
    if pieces:
        extent = extent_of(np.vstack(pieces), width / 2 + 1)
        large = extent.width * extent.height > LARGE_AREA
        draw = drawn_finely(pieces, width) if large else stroked(pieces, width)
        cover(surface, color, extent, draw, factor=1 if large else 0)


def hairline(
    surface: pygame.Surface, color: Rgba, x0: float, y0: float, x1: float, y1: float
) -> None:
    """Draw a straight line a pixel wide, as `stroke` does but quickly."""
    if color[3] == 255:
        pygame.draw.aaline(surface, color, (x0 - 0.5, y0 - 0.5), (x1 - 0.5, y1 - 0.5))
        return
    left, top = floor(min(x0, x1)) - 2, floor(min(y0, y1)) - 2
    box = pygame.Rect(left, top, ceil(max(x0, x1)) + 2 - left, ceil(max(y0, y1)) + 2 - top)
    box = box.clip(surface.get_clip())
    if box.width > 0 and box.height > 0:
        patch = pygame.Surface(box.size, pygame.SRCALPHA, 32)
        patch.fill((*color[:3], 0))
        dx, dy = box.left + 0.5, box.top + 0.5
        pygame.draw.aaline(patch, color, (x0 - dx, y0 - dy), (x1 - dx, y1 - dy))
        surface.blit(patch, box)


def stroked(pieces: list[Float], width: float) -> Draw:
    """Return a brush for polylines (k, 2) with round joints and ends."""

    def draw(large: pygame.Surface, left: float, top: float, factor: float, color: Rgba) -> None:
        thick = max(1, round(width * factor))
        for piece in pieces:
            points = scaled(piece, left, top, factor)
            if len(points) > 1:
                pygame.draw.lines(large, color, False, points, thick)
            if thick > 2:
                for x, y in points:  # round joints and ends
                    pygame.draw.circle(large, color, (round(x + 0.5), round(y + 0.5)), thick / 2)

    return draw


def drawn_finely(pieces: list[Float], width: float) -> Draw:
    """Return a brush for polylines without enlargement, for those that span much of the picture."""

    def draw(large: pygame.Surface, left: float, top: float, factor: float, color: Rgba) -> None:
        for piece in pieces:
            hairlines(large, color, (piece - (left, top)) * factor - 0.5, width)

    return draw


def mark(marker: str, x: float, y: float, ui: float, width: float) -> tuple[Draw, float]:
    """Return a brush for one of the marks ``. o x + * s``, and its radius, pixels."""
    if marker == ".":
        return disc(x, y, 2.2 * ui), 2.2 * ui
    if marker == "o":
        return disc(x, y, 3.2 * ui + width / 2, width), 3.2 * ui + width
    r = 3.2 * ui
    spokes = {
        "x": [(-r, -r, r, r), (-r, r, r, -r)],
        "+": [(-r, 0, r, 0), (0, -r, 0, r)],
        "*": [(0, -r, 0, r), (-0.87 * r, -r / 2, 0.87 * r, r / 2),
              (-0.87 * r, r / 2, 0.87 * r, -r / 2)],
        "s": [(-r, -r, r, -r), (r, -r, r, r), (r, r, -r, r), (-r, r, -r, -r)],
    }[marker]  # fmt: skip
    pieces = [np.array([(x + a, y + b), (x + c, y + d)]) for a, b, c, d in spokes]
    return stroked(pieces, width), r + width
