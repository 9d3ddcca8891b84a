"""The inspector's plots of sensors: readings over time, or over bearings."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.core.quantity import Quantity
from mars2d.output.raster.brushes import rgba
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Float, Frame
from mars2d.sensors.base import Sensor
from mars2d.window.panels.trace import span_of
from mars2d.window.widgets.plot import Limits, draw_curve, polylines
from mars2d.window.widgets.words import Word, write_line

ROW, CELLS, BARS = 24.0, 18.0, 40.0
"""The heights of a line over time, colours and bars, points."""

TITLE = 21.0
"""The height of a plot's title, points."""

MAX_LINES = 6
"""How many numbers are drawn as lines over time; more are drawn as bars."""

NAME, VALUE = 46.0, 84.0
"""The room for the name and the value beside a line, points."""


class SensorPlot(NamedTuple):
    """A plot of a sensor; height: without its title, points."""

    sensor: Sensor
    height: float
    draw: Callable[[Painter, pygame.Surface, pygame.Rect], None]


class History(NamedTuple):
    """Readings (k, ...) of the last control steps, up to the present.

    first, last: the places of the first and the last on the time axis, from 0 to 1.
    """

    values: NDArray[Any]
    first: float
    last: float


def plot_of(frame: Frame, robot: int, sensor: Sensor, reading: Any) -> SensorPlot:
    """Return the plot of a sensor's readings on a robot: lines over time, colours, or bars.

    Bars are those of now, from left to right as the robot sees where they are of beams.
    """
    now = np.asarray(reading)
    quantities = sensor.quantities or (Quantity("value"),)
    past, color = history(frame, robot, sensor, now), frame.scenario.colors[robot]
    if quantities[0].kind == "color" and now.shape[-1:] == (3,):
        strip = now[None, ::-1] if now.ndim == 2 else past.values[None]
        return SensorPlot(sensor, CELLS, _Cells(strip))
    numbers = past.values.reshape(len(past.values), -1).astype(float)
    if numbers.shape[1] <= MAX_LINES:
        named = quantities if len(quantities) == numbers.shape[1] else None
        lines = _Lines(past._replace(values=numbers), named, quantities[0], color)
        return SensorPlot(sensor, ROW * numbers.shape[1], lines)
    beams = np.shape(getattr(sensor, "angles", ())) == now.shape
    return SensorPlot(sensor, BARS, _Bars(numbers[-1, ::-1] if beams else numbers[-1], color))


def history(frame: Frame, robot: int, sensor: Sensor, now: NDArray[Any]) -> History:
    """Return the recent readings of a sensor on a robot; now: the present one."""
    past = frame.reading_path(sensor.key, robot)
    if past is None or past.shape[1:] != now.shape:
        return History(now[None], 1.0, 1.0)
    dt = frame.scenario.sampling_time
    shown = max(1, round(span_of(dt) / dt))
    values = np.concatenate([past[-shown:], now[None]])
    begin = max(len(past) - shown, 0)
    end = max(len(past), shown)
    return History(values, (begin - end) / shown + 1, (len(past) - end) / shown + 1)


@dataclass(frozen=True, slots=True)
class _Lines:
    """Numbers, as a line over time each."""

    history: History
    named: tuple[Quantity, ...] | None
    quantity: Quantity
    color: str

    def __call__(self, painter: Painter, surface: pygame.Surface, rect: pygame.Rect) -> None:
        ui, theme = painter.ui, painter.theme
        values, height = self.history.values, round(ROW * ui)
        several = values.shape[1] > 1
        name_room = round(NAME * ui) if several else 0
        for k in range(values.shape[1]):
            quantity = self.named[k] if self.named else self.quantity
            row = pygame.Rect(rect.left, rect.top + k * height, rect.width, height)
            name = quantity.name if self.named else f"[{k}]"
            names = [Word(name, theme.text, 12)] if several else []
            value = Word(_in_words(float(values[-1, k]), quantity), theme.ink, 12)
            write_line(surface, row, painter, names, [value])
            area = pygame.Rect(
                row.left + name_room, row.top + 2,
                row.width - name_room - round(VALUE * ui), height - 4,
            )  # fmt: skip
            _line(surface, area, painter, self.history, k, quantity, self.color)


def _line(
    surface: pygame.Surface,
    area: pygame.Rect,
    painter: Painter,
    history: History,
    k: int,
    quantity: Quantity,
    color: str,
) -> None:
    """Draw number k over time, scaled to its range."""
    values = history.values[:, k]
    surface.fill(painter.theme.track, (area.left, area.bottom, area.width, 1))
    finite = values[np.isfinite(values)]
    if not finite.size:
        return
    low, high = float(finite.min()), float(finite.max())
    least = 0.02 * max(abs(low), abs(high), 0.05)
    if high - low < least:
        low, high = (low + high - least) / 2, (low + high + least) / 2
    limits, inner = Limits(0.0, 1.0, low, high), area.inflate(0, -4)
    places = np.linspace(history.first, history.last, len(values))
    lines = polylines(inner, limits, places, values, wraps=quantity.kind == "angle")
    ink = painter.theme.shade(color)
    draw_curve(surface, painter, lines, ink, 1.6)
    if np.isfinite(values[-1]):
        (point,) = limits.pixels(inner, places[-1:], values[-1:]).tolist()
        pygame.draw.aacircle(surface, ink, point, 2.4 * painter.ui)


@dataclass(frozen=True, slots=True)
class _Cells:
    """Colours side by side: of pixels, or of one pixel over time; nan is drawn empty."""

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
