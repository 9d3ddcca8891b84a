"""The grid of the plane and its labels in metres."""

from __future__ import annotations

from math import ceil, floor, log10

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.core.plane import grid_step
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.theme import Theme

Bounds = tuple[float, float, float, float]
Float = NDArray[np.float64]

MIN_SPACING = 42
"""Points between grid lines, at least."""


def ticks(low: float, high: float, step: float) -> Float:
    """Return the multiples of `step` from `low` to `high`, both included."""
    first, last = ceil(low / step - 1e-6), floor(high / step + 1e-6)
    return np.arange(first, min(last, first + 2000) + 1, dtype=np.float64) * step


def label(value: float, step: float) -> str:
    r"""Return a tick's value with as many decimals as its step has, and a true minus sign.

    >>> label(0.5, 0.5), ascii(label(-2.0, 1.0))
    ('0.5', "'\\u22122'")
    """
    decimals = max(0, -floor(log10(step) + 1e-9))
    text = f"{value + 0.0:.{decimals}f}"
    return text.replace("-", "\N{MINUS SIGN}") if float(text) != 0 else text.lstrip("-")


def draw_grid(surface: pygame.Surface, camera: Camera, bounds: Bounds, painter: Painter) -> None:
    """Draw lines one pixel wide within bounds (xmin, xmax, ymin, ymax), metres."""
    theme = painter.theme
    shown = _visible(surface.get_clip(), camera, bounds)
    if shown is None:
        return
    left, top, right, bottom = shown
    step = grid_step(MIN_SPACING * painter.ui / camera.scale)
    xmin, xmax, ymin, ymax = _metres(camera, *shown)
    for x in ticks(xmin, xmax, step).tolist():
        px = round(camera.x + camera.scale * x)
        color = theme.grid_axis if abs(x) < step / 2 else theme.grid
        pygame.draw.line(surface, color, (px, round(top)), (px, round(bottom) - 1))
    for y in ticks(ymin, ymax, step).tolist():
        py = round(camera.y - camera.scale * y)
        color = theme.grid_axis if abs(y) < step / 2 else theme.grid
        pygame.draw.line(surface, color, (round(left), py), (round(right) - 1, py))


def labels(
    clip: pygame.Rect, camera: Camera, bounds: Bounds, painter: Painter
) -> list[tuple[pygame.Surface, tuple[int, int]]]:
    """Return the labels in metres, as images and their places.

    They lie along the left and lower side of the part of `bounds` that is visible in `clip`.
    """
    fonts, theme, ui = painter.fonts, painter.theme, painter.ui
    size, gap = 12 * ui, round(7 * ui)
    step = grid_step(MIN_SPACING * ui / camera.scale)
    shown = _visible(clip, camera, bounds)
    if shown is None:
        return []
    left, _, _, bottom = shown
    xmin, xmax, ymin, ymax = _metres(camera, *shown)
    xs, ys = ticks(xmin, xmax, step).tolist(), ticks(ymin, ymax, step).tolist()
    widest = max((fonts.width(label(y, step), size) for y in ys), default=0)
    below = min(round(bottom) + gap, clip.bottom - round(size * 1.7))
    beside = max(round(left) - gap, clip.left + widest + gap)
    result = []
    for x in xs:
        image = fonts.render(label(x, step), size, theme.muted)
        place = image.get_rect(midtop=(round(camera.x + camera.scale * x), below))
        if below >= bottom or beside + gap <= place.left:
            result.append(_on_plate(image, place, theme if below < bottom else None))
    for y in ys:
        image = fonts.render(label(y, step), size, theme.muted)
        place = image.get_rect(midright=(beside, round(camera.y - camera.scale * y)))
        if beside <= left or place.bottom <= below:
            result.append(_on_plate(image, place, theme if beside > left else None))
    return result


def _on_plate(
    image: pygame.Surface, place: pygame.Rect, theme: Theme | None
) -> tuple[pygame.Surface, tuple[int, int]]:
    """Put a label on a plate in the theme's page colour; without a theme, leave it as it is."""
    if theme is None:
        return image, place.topleft
    larger = place.inflate(8, 2)
    result = pygame.Surface(larger.size, 0, 32)
    result.fill(theme.page)
    result.blit(image, (4, 1))
    result.set_alpha(215)
    return result, larger.topleft


def _visible(
    clip: pygame.Rect, camera: Camera, bounds: Bounds
) -> tuple[float, float, float, float] | None:
    """Return the visible part of bounds, (left, top, right, bottom) in pixels, or None."""
    (left, top), (right, bottom) = camera.to_pixels(
        [(bounds[0], bounds[3]), (bounds[1], bounds[2])]
    ).tolist()
    left, right = max(left, clip.left), min(right, clip.right)
    top, bottom = max(top, clip.top), min(bottom, clip.bottom)
    return (left, top, right, bottom) if left < right and top < bottom else None


def _metres(camera: Camera, left: float, top: float, right: float, bottom: float) -> Bounds:
    """Return (xmin, xmax, ymin, ymax), metres, of a rectangle of pixels."""
    (xmin, ymax), (xmax, ymin) = camera.to_world([(left, top), (right, bottom)]).tolist()
    return xmin, xmax, ymin, ymax
