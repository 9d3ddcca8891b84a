"""The inspector's sensors: their numbers, colours, or bars."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import pygame

from mars2d.core.quantity import Quantity
from mars2d.output.raster.brushes import rgba
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Float, Frame
from mars2d.sensors.base import Sensor
from mars2d.window.widgets.panel import LINE, Panel
from mars2d.window.widgets.rows import Row, Word, minus

BARS = 40.0
"""The height of bars, points."""

MAX_LINES = 6
"""How many numbers are written; more are drawn as bars."""


def rows_of(panel: Panel, frame: Frame, robot: int, sensor: Sensor, reading: Any) -> list[Row]:
    """Return a sensor's reading on a robot: numbers, colours, or bars.

    Bars are those of now, from left to right as the robot sees where they are of beams.
    """
    now, painter = np.asarray(reading), panel.painter
    quantities = sensor.quantities or (Quantity("value"),)
    if quantities[0].kind == "color" and now.shape[-1:] == (3,):
        strip = now[None, ::-1] if now.ndim == 2 else now[None, None]
        return [Row(LINE, partial(_draw_colors, painter, strip))]
    numbers = now.ravel().astype(float)
    if len(numbers) > MAX_LINES:
        beams = np.shape(getattr(sensor, "angles", ())) == now.shape
        bars, color = numbers[::-1] if beams else numbers, frame.scenario.colors[robot]
        return [Row(BARS, partial(_draw_bars, painter, bars, color))]
    theme, named = painter.theme, len(quantities) == len(numbers)
    each = [quantities[k if named else 0] for k in range(len(numbers))]
    names = [quantity.name if named else f"[{k}]" for k, quantity in enumerate(each)]
    values = map(_in_words, numbers.tolist(), each)
    return [
        panel.line([Word(name, theme.text)], [Word(value, theme.ink)])
        for name, value in zip(names, values, strict=True)
    ]


def _draw_colors(
    painter: Painter, colors: Float, surface: pygame.Surface, rect: pygame.Rect
) -> None:
    """Draw colours (1, n, 3) side by side; nan is drawn empty."""
    ground = np.array(rgba(painter.theme.track)[:3]) / 255
    colors = np.where(np.isfinite(colors), colors, ground)
    pixels = np.rint(255 * np.clip(colors, 0, 1)).astype(np.uint8)
    strip = pygame.surfarray.make_surface(pixels.swapaxes(0, 1))
    area = rect.inflate(0, -4)
    surface.blit(pygame.transform.scale(strip, area.size), area)
    pygame.draw.rect(surface, painter.theme.edge, area, 1)


def _draw_bars(
    painter: Painter, values: Float, color: str, surface: pygame.Surface, rect: pygame.Rect
) -> None:
    """Draw numbers (n,) as bars side by side."""
    values = np.where(np.isfinite(values), values, 0.0)
    low, high = min(0.0, float(values.min())), max(0.0, float(values.max()))
    tall = (rect.height - 4) / ((high - low) or 1.0)
    zero, wide = rect.bottom - 2 + low * tall, rect.width / len(values)
    ink = painter.theme.shade(color)
    for k, value in enumerate(values.tolist()):
        top = min(zero, zero - value * tall)
        bar = rect.left + k * wide, top, max(1.0, wide - 1), abs(value * tall)
        surface.fill(ink, bar)
    surface.fill(painter.theme.grid_axis, (rect.left, zero, rect.width, 1))


def _in_words(value: float, quantity: Quantity) -> str:
    """Return a number in words, with its unit; angles in degrees."""
    if not np.isfinite(value):
        return "nothing" if np.isnan(value) or value > 0 else str(value)
    if quantity.kind == "angle":
        return minus(f"{round(float(np.degrees(value))):d}°")
    text = f"{value:.3f}" if abs(value) < 10 else f"{value:.4g}"
    return minus(f"{text} {quantity.unit.replace('^2', '²')}".strip())
