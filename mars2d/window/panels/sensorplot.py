"""The inspector's sensors: their numbers, colours, or bars."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pygame

from mars2d.core.quantity import Quantity
from mars2d.output.raster.brushes import rgba
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Float, Frame
from mars2d.sensors.base import Sensor
from mars2d.window.widgets.words import Word, write_line

ROW, CELLS, BARS = 18.0, 18.0, 40.0
"""The heights of a number, colours and bars, points."""

TITLE = 21.0
"""The height of a plot's title, points."""

MAX_LINES = 6
"""How many numbers are written; more are drawn as bars."""


class SensorPlot(NamedTuple):
    """A plot of a sensor; height: without its title, points."""

    sensor: Sensor
    height: float
    draw: Callable[[Painter, pygame.Surface, pygame.Rect], None]


def plot_of(frame: Frame, robot: int, sensor: Sensor, reading: Any) -> SensorPlot:
    """Return the plot of a sensor's reading on a robot: numbers, colours, or bars.

    Bars are those of now, from left to right as the robot sees where they are of beams.
    """
    now = np.asarray(reading)
    quantities = sensor.quantities or (Quantity("value"),)
    color = frame.scenario.colors[robot]
    if quantities[0].kind == "color" and now.shape[-1:] == (3,):
        strip = now[None, ::-1] if now.ndim == 2 else now[None, None]
        return SensorPlot(sensor, CELLS, _Cells(strip))
    numbers = now.ravel().astype(float)
    if len(numbers) <= MAX_LINES:
        lines = _Lines(numbers, quantities)
        return SensorPlot(sensor, ROW * len(numbers), lines)
    beams = np.shape(getattr(sensor, "angles", ())) == now.shape
    return SensorPlot(sensor, BARS, _Bars(numbers[::-1] if beams else numbers, color))


@dataclass(frozen=True, slots=True)
class _Lines:
    """Numbers, each in a line with its name."""

    values: Float
    quantities: tuple[Quantity, ...]

    def __call__(self, painter: Painter, surface: pygame.Surface, rect: pygame.Rect) -> None:
        height, named = round(ROW * painter.ui), len(self.quantities) == len(self.values)
        for k, value in enumerate(self.values.tolist()):
            quantity = self.quantities[k if named else 0]
            row = pygame.Rect(rect.left, rect.top + k * height, rect.width, height)
            name = Word(quantity.name if named else f"[{k}]", painter.theme.text, 12)
            number = Word(_in_words(value, quantity), painter.theme.ink, 12)
            write_line(surface, row, painter, [name], [number])


@dataclass(frozen=True, slots=True)
class _Cells:
    """Colours side by side; nan is drawn empty."""

    colors: Float

    def __call__(self, painter: Painter, surface: pygame.Surface, rect: pygame.Rect) -> None:
        ground = np.array(rgba(painter.theme.track)[:3]) / 255
        colors = np.where(np.isfinite(self.colors), self.colors, ground)
        pixels = np.rint(255 * np.clip(colors, 0, 1)).astype(np.uint8)
        strip = pygame.surfarray.make_surface(pixels.swapaxes(0, 1))
        area = rect.inflate(0, -4)
        surface.blit(pygame.transform.scale(strip, area.size), area)
        pygame.draw.rect(surface, painter.theme.edge, area, 1)


@dataclass(frozen=True, slots=True)
class _Bars:
    """Many numbers, as bars side by side."""

    values: Float
    color: str

    def __call__(self, painter: Painter, surface: pygame.Surface, rect: pygame.Rect) -> None:
        values = np.where(np.isfinite(self.values), self.values, 0.0)
        low, high = min(0.0, float(values.min())), max(0.0, float(values.max()))
        span = (high - low) or 1.0
        zero = rect.bottom - 2 + low / span * (rect.height - 4)
        edges = rect.left + rect.width * np.arange(len(values) + 1) / len(values)
        ink = painter.theme.shade(self.color)
        for left, right, value in zip(
            edges[:-1].tolist(), edges[1:].tolist(), values.tolist(), strict=True
        ):
            tall = value / span * (rect.height - 4)
            bar = (left, min(zero, zero - tall), max(1.0, right - left - 1), abs(tall))
            surface.fill(ink, bar)
        surface.fill(painter.theme.grid_axis, (rect.left, zero, rect.width, 1))


def _in_words(value: float, quantity: Quantity) -> str:
    """Return a number in words, with its unit; angles in degrees."""
    if quantity.kind == "angle" and np.isfinite(value):
        return f"{round(float(np.degrees(value))):d}°".replace("-", "\N{MINUS SIGN}")
    if not np.isfinite(value):
        return "nothing" if np.isnan(value) or value > 0 else str(value)
    text = f"{value:.3f}" if abs(value) < 10 else f"{value:.4g}"
    unit = quantity.unit.replace("^2", "²")
    return f"{text} {unit}".replace("-", "\N{MINUS SIGN}").strip()
