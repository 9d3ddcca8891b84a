"""Plots in a window: axes and curves over time, bars, colours, and how numbers are written."""

from __future__ import annotations

from math import ceil, pi
from typing import NamedTuple

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.core.scene import Scene, faded
from mars2d.output.layers.arrows import round_force
from mars2d.output.raster.brushes import rgba
from mars2d.output.raster.camera import PIXELS
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.strokes import hairlines
from mars2d.output.signals import thinned
from mars2d.window.widgets.rows import minus

Float = NDArray[np.float64]


class Limits(NamedTuple):
    """The ends of both axes: of time, seconds, and of values."""

    start: float
    end: float
    low: float
    high: float

    def pixels(self, area: pygame.Rect, times: Float, values: Float) -> Float:
        """Return where points of the plot lie on the surface, (k, 2)."""
        x = area.left + (times - self.start) / (self.end - self.start) * area.width
        y = area.bottom - (values - self.low) / (self.high - self.low) * area.height
        return np.column_stack([x, y])


def limits_of(start: float, end: float, values: Float) -> Limits:
    """Return axes on which all finite values have room, with 0 where it is not far off."""
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    low = 0.0 if 0.0 < low < 0.6 * high else low
    high = 0.0 if 0.6 * low < high < 0.0 else high
    least = max(0.02 * max(abs(low), abs(high)), 1e-9)
    if high - low < least:  # a constant
        middle = (low + high) / 2
        low, high = (0.0, 1.0) if low == high == 0.0 else (middle - least / 2, middle + least / 2)
    room = 0.08 * (high - low)
    return Limits(start, end, low - (room if low else 0.0), high + (room if high else 0.0))


def draw_axes(
    surface: pygame.Surface,
    area: pygame.Rect,
    painter: Painter,
    limits: Limits,
    unit: str = "",
    *,
    times: bool = True,
) -> None:
    """Draw the grid and the numbers of both axes.

    unit: of the values. times: whether numbers of time stand below the area.
    """
    ui, fonts, theme = painter.ui, painter.fonts, painter.theme
    start, end, low, high = limits
    lines = max(1.0, min(3.0, area.height / (36 * ui)))
    step = round_force((high - low) / lines)
    for k in range(ceil(low / step - 1e-9), int(np.floor(high / step + 1e-9)) + 1):
        y = area.bottom - round((k * step - low) / (high - low) * area.height)
        surface.fill(theme.grid_axis if k == 0 else theme.grid, (area.left, y, area.width, 1))
        text = minus(f"{k * step:.4g} {unit}".strip())
        painter.write(surface, text, 11 * ui, theme.muted, midright=(area.left - 6 * ui, y))
    step = round_force((end - start) / max(1.0, min(4.0, area.width / (66 * ui))))
    for k in range(ceil(start / step - 1e-9), int(end / step + 1e-9) + 1):
        x = area.left + round((k * step - start) / (end - start) * area.width)
        surface.fill(theme.grid, (x, area.top, 1, area.height))
        image = fonts.render(f"{k * step:.6g} s", 11 * ui, theme.muted)
        place = image.get_rect(midtop=(x, area.bottom + round(3 * ui)))
        if times and place.right <= area.right + round(10 * ui):
            place.right = min(place.right, area.right)
            surface.blit(image, place)


def polylines(
    area: pygame.Rect,
    limits: Limits,
    times: Float,
    values: Float,
    *,
    held: str = "",
    wraps: bool = False,
) -> list[Float]:
    """Return the lines of a curve through values (T,) at times (T,), each (k, 2) pixels.

    held: as of a `Signal`: a value that holds is drawn as a step. wraps: whether they are angles,
    which jump from one end of their range to the other. Long curves are thinned to their extremes.
    """
    lies = np.searchsorted(times, [limits.start, limits.end])
    seen = slice(max(int(lies[0]) - 1, 0), int(lies[1]) + 1)
    times, values = times[seen], values[seen]
    if not len(times):
        return []
    kept = thinned(values, max(1, area.width // 2))
    first = 2 * times[0] - times[1] if len(times) > 1 else times[0]  # a row before
    after = 2 * times[-1] - times[-2] if len(times) > 1 else times[-1]
    times, values = times[kept], np.where(np.isfinite(values), values, np.nan)[kept]
    if wraps:
        leaps = np.flatnonzero(np.abs(np.diff(values)) > pi) + 1
        times, values = np.insert(times, leaps, times[leaps]), np.insert(values, leaps, np.nan)
    if held:
        edges = np.append(first, times) if held == "pre" else np.append(times, after)
        times, values = np.repeat(edges, 2)[1:-1], np.repeat(values, 2)
    points = limits.pixels(area, times, values)
    points[:, 1] = np.clip(points[:, 1], area.top - 10 * area.height, area.bottom + area.height)
    known = np.isfinite(values)
    parts = np.split(np.arange(len(points)), np.flatnonzero(np.diff(known)) + 1)
    return [points[part] for part in parts if known[part[0]]]


def draw_curve(
    surface: pygame.Surface, painter: Painter, lines: list[Float], color: str, width: float
) -> None:
    """Draw the lines of a curve in a colour of the theme; width: points."""
    ink = rgba(color)[:3]
    for points in lines:
        if len(points) > 1:
            hairlines(surface, ink, points, width * painter.ui)
        else:
            pygame.draw.aacircle(surface, ink, points[0].tolist(), width * painter.ui)


def draw_quartiles(
    surface: pygame.Surface,
    area: pygame.Rect,
    painter: Painter,
    limits: Limits,
    times: Float,
    values: Float,
) -> None:
    """Draw the median of many curves (T, k), and the band in which the middle half of them lies.

    Rows in which a value is unknown are left out.
    """
    seen = np.flatnonzero((times >= limits.start) & (times <= limits.end))
    seen = seen[:: max(1, len(seen) // max(area.width, 1))]
    seen = seen[np.isfinite(values[seen]).all(axis=1)]
    if len(seen) < 2:
        return
    low, median, high = np.percentile(values[seen], (25, 50, 75), axis=1)
    edges = [limits.pixels(area, times[seen], edge) for edge in (low, high)]
    scene, ink = Scene(), painter.theme.ink
    scene.polygon(np.vstack([edges[0], edges[1][::-1]]) * (1, -1), fill=faded(ink, 0.2))
    painter.paint(surface, scene.shapes, PIXELS, shaded=False)
    draw_curve(surface, painter, [limits.pixels(area, times[seen], median)], ink, 2.0)


def draw_bars(
    surface: pygame.Surface, rect: pygame.Rect, painter: Painter, values: Float, color: str
) -> None:
    """Draw numbers (n,) as bars side by side, in a colour of scenes; nan and inf as 0."""
    values = np.where(np.isfinite(values), values, 0.0)
    low, high = min(0.0, float(values.min())), max(0.0, float(values.max()))
    tall = (rect.height - 4) / ((high - low) or 1.0)
    zero, wide = rect.bottom - 2 + low * tall, rect.width / len(values)
    for k, value in enumerate((tall * values).tolist()):
        bar = rect.left + k * wide, zero - max(value, 0.0), max(1.0, wide - 1), abs(value)
        surface.fill(painter.theme.shade(color), bar)
    surface.fill(painter.theme.grid_axis, (rect.left, zero, rect.width, 1))


def draw_colors(
    surface: pygame.Surface, rect: pygame.Rect, painter: Painter, colors: Float
) -> None:
    """Draw colours (n, 3) side by side; nan is drawn empty."""
    colors = np.where(np.isfinite(colors), colors, np.divide(rgba(painter.theme.track)[:3], 255))
    pixels = np.rint(255 * np.clip(colors, 0, 1)).astype(np.uint8)
    strip, area = pygame.surfarray.make_surface(pixels[:, None]), rect.inflate(0, -4)
    surface.blit(pygame.transform.scale(strip, area.size), area)
    pygame.draw.rect(surface, painter.theme.edge, area, 1)


def as_number(value: float) -> str:
    """Return a number with three digits, for example ``0.200``."""
    if not np.isfinite(value):
        return "nothing"
    size = abs(value)
    text = f"{value:.3g}" if size >= 1000 or 0 < size < 1e-3 else f"{value:#.3g}".rstrip(".")
    return minus(text)
