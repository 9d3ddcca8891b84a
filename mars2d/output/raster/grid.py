"""The grid of the plane and its labels in metres."""

from __future__ import annotations

from math import ceil, floor, log10

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.core.plane import grid_step
from mars2d.core.scene import Anchor, Scene
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter

Bounds = tuple[float, float, float, float]
Float = NDArray[np.float64]

MIN_SPACING, SIZE = 42, 12.0
"""The least distance of grid lines, and the height of their labels, points."""


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


def labels(clip: pygame.Rect, camera: Camera, bounds: Bounds, painter: Painter) -> Scene:
    """Return the labels in metres, as a scene for a camera of pixels, y upwards.

    They lie along the left and lower side of the part of `bounds` that is visible in `clip`.
    """
    scene, theme, ui = Scene(), painter.theme, painter.ui
    step = grid_step(MIN_SPACING * ui / camera.scale)
    shown = _visible(clip, camera, bounds)
    if shown is None:
        return scene
    left, _, _, bottom = shown
    xmin, xmax, ymin, ymax = _metres(camera, *shown)
    ys = [(y, label(y, step)) for y in ticks(ymin, ymax, step).tolist()]
    widest = max((painter.fonts.width(text, SIZE * ui) for _, text in ys), default=0)
    below = min(bottom + 4 * ui, clip.bottom - 1.7 * SIZE * ui)
    beside = max(left - 4 * ui, clip.left + widest + 7 * ui)

    def write(x: float, y: float, text: str, anchor: Anchor) -> None:
        scene.text((x, -y), text, color=theme.muted, size=SIZE, anchor=anchor, halo=theme.page)

    for x in ticks(xmin, xmax, step).tolist():
        write(camera.x + camera.scale * x, below, label(x, step), "below")
    for y, text in ys:
        at = camera.y - camera.scale * y
        if beside <= left or at < below:
            write(beside, at, text, "right")
    return scene


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
