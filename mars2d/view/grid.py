"""The grid of the plane and its labels in metres."""

from __future__ import annotations

from math import ceil, floor, log10

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.view.camera import Camera
from mars2d.view.fonts import Fonts
from mars2d.view.theme import GRID, GRID_AXIS, MUTED, PAGE

__all__ = ["draw_grid", "draw_labels", "label", "spacing", "ticks"]

Bounds = tuple[float, float, float, float]
Float = NDArray[np.float64]


def spacing(scale: float, least: float) -> float:
    """Return the distance of grid lines, metres: 1, 2 or 5 times a power of ten.

    The smallest for which lines are at least `least` pixels apart, at `scale` pixels a metre.
    """
    wanted = least / scale
    power = 10.0 ** floor(log10(wanted))
    for factor in (1, 2, 5):
        if factor * power >= wanted * (1 - 1e-9):
            return factor * power
    return 10 * power


def ticks(low: float, high: float, step: float) -> Float:
    """Return the multiples of `step` from `low` to `high`, both included."""
    first, last = ceil(low / step - 1e-6), floor(high / step + 1e-6)
    return np.arange(first, min(last, first + 2000) + 1, dtype=np.float64) * step


def label(value: float, step: float) -> str:
    """Return a tick's value with as many decimals as its step has.

    >>> label(0.5, 0.5), label(-2.0, 1.0)
    ('0.5', '−2')
    """
    decimals = max(0, -floor(log10(step) + 1e-9))
    text = f"{value + 0.0:.{decimals}f}"
    return text.replace("-", "−") if float(text) != 0 else text.lstrip("-")


def draw_grid(surface: pygame.Surface, camera: Camera, bounds: Bounds, ui: float) -> None:
    """Draw lines one pixel wide within bounds (xmin, xmax, ymin, ymax), metres."""
    clip = surface.get_clip()
    (left, top), (right, bottom) = camera.to_pixels(
        [(bounds[0], bounds[3]), (bounds[1], bounds[2])]
    ).tolist()
    left, right = max(left, clip.left), min(right, clip.right)
    top, bottom = max(top, clip.top), min(bottom, clip.bottom)
    if left >= right or top >= bottom:
        return
    step = spacing(camera.scale, 42 * ui)
    xmin, xmax, ymin, ymax = camera_bounds(camera, left, top, right, bottom)
    for x in ticks(xmin, xmax, step).tolist():
        px = round(camera.x + camera.scale * x)
        color = GRID_AXIS if abs(x) < step / 2 else GRID
        pygame.draw.line(surface, color, (px, round(top)), (px, round(bottom) - 1))
    for y in ticks(ymin, ymax, step).tolist():
        py = round(camera.y - camera.scale * y)
        color = GRID_AXIS if abs(y) < step / 2 else GRID
        pygame.draw.line(surface, color, (round(left), py), (round(right) - 1, py))


def draw_labels(
    surface: pygame.Surface, camera: Camera, bounds: Bounds, fonts: Fonts, ui: float
) -> None:
    """Write the metres along the left and lower side of `bounds`, or of what is visible of it."""
    clip = surface.get_clip()
    size, gap = 12 * ui, round(7 * ui)
    step = spacing(camera.scale, 42 * ui)
    (left, top), (right, bottom) = camera.to_pixels(
        [(bounds[0], bounds[3]), (bounds[1], bounds[2])]
    ).tolist()
    left, right = max(left, clip.left), min(right, clip.right)
    top, bottom = max(top, clip.top), min(bottom, clip.bottom)
    if left >= right or top >= bottom:
        return
    xmin, xmax, ymin, ymax = camera_bounds(camera, left, top, right, bottom)
    xs, ys = ticks(xmin, xmax, step).tolist(), ticks(ymin, ymax, step).tolist()
    below = min(round(bottom) + gap, clip.bottom - round(size * 1.6))
    widest = max((fonts.width(label(y, step), size) for y in ys), default=0)
    beside = max(round(left) - gap, clip.left + widest + gap)
    for x in xs:
        image = fonts.render(label(x, step), size, MUTED)
        place = image.get_rect(midtop=(round(camera.x + camera.scale * x), below))
        if clip.left + widest + 2 * gap <= place.left and place.right <= clip.right:
            _write(surface, image, place, inside=below < bottom)
    for y in ys:
        image = fonts.render(label(y, step), size, MUTED)
        place = image.get_rect(midright=(beside, round(camera.y - camera.scale * y)))
        if clip.top <= place.top and place.bottom <= below - (0 if below < bottom else -gap):
            _write(surface, image, place, inside=beside > left)


def _write(
    surface: pygame.Surface, image: pygame.Surface, place: pygame.Rect, *, inside: bool
) -> None:
    """Write a label, on a plate where it lies inside the picture."""
    if inside:
        plate = pygame.Surface(place.inflate(6, 0).size, 0, 32)
        plate.fill(PAGE)
        plate.set_alpha(200)
        surface.blit(plate, place.inflate(6, 0))
    surface.blit(image, place)


def camera_bounds(
    camera: Camera, left: float, top: float, right: float, bottom: float
) -> tuple[float, float, float, float]:
    """Return (xmin, xmax, ymin, ymax), metres, of a rectangle of pixels."""
    (xmin, ymax), (xmax, ymin) = camera.to_world([(left, top), (right, bottom)]).tolist()
    return xmin, xmax, ymin, ymax
