"""Plots in a window: axes and curves over time, bars, colours, and how numbers are written."""

from __future__ import annotations

from math import ceil, floor, pi
from typing import Any, NamedTuple

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


class Axes(NamedTuple):
    """Axes on an area of a surface: the ends of the time [s], and those of the values."""

    area: pygame.Rect
    start: float
    end: float
    low: float
    high: float

    @classmethod
    def round(cls, area: pygame.Rect, start: float, end: float, values: Float) -> Axes:
        """Return axes on which all finite values have room, with 0 where it is not far off."""
        finite = values[np.isfinite(values)]
        low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
        low = 0.0 if 0.0 < low < 0.6 * high else low
        high = 0.0 if 0.6 * low < high < 0.0 else high
        least = max(0.02 * max(abs(low), abs(high)), 1e-9)
        if high - low < least:  # a constant
            middle = (low + high) / 2
            low, high = (
                (0.0, 1.0) if low == high == 0.0 else (middle - least / 2, middle + least / 2)
            )
        room = 0.08 * (high - low)
        return cls(area, start, end, low - room * bool(low), high + room * bool(high))

    def x_of(self, time: Any) -> Any:
        """Return where a time lies, or times (T,), pixels from the left."""
        return self.area.left + (time - self.start) / (self.end - self.start) * self.area.width

    def y_of(self, value: Any) -> Any:
        """Return where a value lies, or values (T,), pixels from the top."""
        return self.area.bottom - (value - self.low) / (self.high - self.low) * self.area.height

    def time_at(self, x: float) -> float:
        """Return the time at a pixel from the left, seconds."""
        return self.start + (x - self.area.left) / self.area.width * (self.end - self.start)

    def draw(
        self, surface: pygame.Surface, painter: Painter, unit: str = "", *, times: bool = True
    ) -> None:
        """Draw the grid and the numbers of both axes.

        unit: of the values. times: whether numbers of time stand below the area.
        """
        ui, theme, (area, start, end, low, high) = painter.ui, painter.theme, self
        step = round_force((high - low) / max(1.0, min(3.0, area.height / (36 * ui))))
        for k in range(ceil(low / step - 1e-9), floor(high / step + 1e-9) + 1):
            y = round(self.y_of(k * step))
            surface.fill(theme.grid if k else theme.grid_axis, (area.left, y, area.width, 1))
            text = minus(f"{k * step:.4g} {unit}".strip())
            painter.write(surface, text, 11 * ui, theme.muted, midright=(area.left - 6 * ui, y))
        step = round_force((end - start) / max(1.0, min(4.0, area.width / (66 * ui))))
        for k in range(ceil(start / step - 1e-9), floor(end / step + 1e-9) + 1):
            x = round(self.x_of(k * step))
            surface.fill(theme.grid, (x, area.top, 1, area.height))
            image = painter.fonts.render(f"{k * step:.6g} s", 11 * ui, theme.muted)
            place = image.get_rect(midtop=(x, area.bottom + round(3 * ui)))
            if times and place.right <= area.right + round(10 * ui):
                place.right = min(place.right, area.right)
                surface.blit(image, place)

    def lines(
        self, times: Float, values: Float, *, held: str = "", wraps: bool = False
    ) -> list[Float]:
        """Return the lines of a curve through values (T,) at times (T,), each (k, 2) pixels.

        held: as of a `Signal`: a value that holds is drawn as a step. wraps: whether they are
        angles, which jump from one end of their range to the other. Long curves are thinned to
        their extremes.
        """
        lies = np.searchsorted(times, [self.start, self.end])
        seen = slice(max(int(lies[0]) - 1, 0), int(lies[1]) + 1)
        times, values = times[seen], values[seen]
        if not len(times):
            return []
        kept = thinned(values, max(1, self.area.width // 2))
        first = 2 * times[0] - times[1] if len(times) > 1 else times[0]  # a row before
        after = 2 * times[-1] - times[-2] if len(times) > 1 else times[-1]
        times, values = times[kept], np.where(np.isfinite(values), values, np.nan)[kept]
        if wraps:
            leaps = np.flatnonzero(np.abs(np.diff(values)) > pi) + 1
            times = np.insert(times, leaps, times[leaps])
            values = np.insert(values, leaps, np.nan)
        if held:
            edges = np.append(first, times) if held == "pre" else np.append(times, after)
            times, values = np.repeat(edges, 2)[1:-1], np.repeat(values, 2)
        top, high = self.area.top, self.area.height
        y = np.clip(self.y_of(values), top - 10 * high, top + 2 * high)
        points, known = np.column_stack([self.x_of(times), y]), np.isfinite(values)
        parts = np.split(np.arange(len(points)), np.flatnonzero(np.diff(known)) + 1)
        return [points[part] for part in parts if known[part[0]]]

    def draw_quartiles(
        self, surface: pygame.Surface, painter: Painter, times: Float, values: Float
    ) -> None:
        """Draw the median of many curves (T, k), and the band of the middle half of them.

        Rows in which a value is unknown are left out.
        """
        seen = np.flatnonzero((times >= self.start) & (times <= self.end))
        seen = seen[:: max(1, len(seen) // max(self.area.width, 1))]
        seen = seen[np.isfinite(values[seen]).all(axis=1)]
        if len(seen) < 2:
            return
        x, y = self.x_of(times[seen]), self.y_of(np.percentile(values[seen], (25, 50, 75), axis=1))
        low, median, high = (np.column_stack([x, each]) for each in y)
        scene, ink = Scene(), painter.theme.ink
        scene.polygon(np.vstack([low, high[::-1]]) * (1, -1), fill=faded(ink, 0.2))
        painter.paint(surface, scene.shapes, PIXELS, shaded=False)
        draw_curve(surface, painter, [median], ink, 2.0)


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
