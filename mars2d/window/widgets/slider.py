"""Sliders: a line with a handle; the slider of the speed, and that of a value."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, log

import numpy as np
import pygame

from mars2d.core.scene import Scene
from mars2d.output.raster.camera import PIXELS
from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.rows import Pixel

LINE = 4.0
"""The height of the line of a slider, points."""
WORDS, WORDS_SHARE = 108.0, 0.48
"""The room for the words beside the line: points, and at most this share of the slider."""
BEHIND = 0.9
"""A run that reaches less than this share of the chosen speed lags behind."""


class Slider:
    """A line with a handle, from a lowest to a highest value; a press round it moves the handle."""

    def __init__(self, low: float = 0.0, high: float = 1.0) -> None:
        """Start with nothing drawn."""
        self.low, self.high = low, high
        self._line = pygame.Rect(0, 0, 0, 0)
        self._area = pygame.Rect(0, 0, 0, 0)

    def hit(self, pixel: Pixel) -> bool:
        """Return whether a press at a pixel moves the handle."""
        return bool(self._area.collidepoint(pixel))

    def value_at(self, x: float) -> float:
        """Return the value at a pixel from the left, between the lowest and the highest."""
        share = (x - self._line.left) / max(1, self._line.width)
        return self.low + min(max(share, 0.0), 1.0) * (self.high - self.low)

    def x_of(self, value: float) -> float:
        """Return where a value lies, pixels from the left."""
        share = (value - self.low) / (self.high - self.low)
        return self._line.left + self._line.width * min(max(share, 0.0), 1.0)

    def draw_value(
        self,
        surface: pygame.Surface,
        rect: pygame.Rect,
        painter: Painter,
        value: float,
        default: float,
        *,
        held: bool,
    ) -> None:
        """Draw it within a rectangle, with a tick at the default. held: by the mouse."""
        ui, theme = painter.ui, painter.theme
        line = pygame.Rect(rect.left, 0, rect.width, max(2, round(LINE * ui)))
        line.centery = rect.centery
        self._place(rect, line, round(8 * ui))
        tick = pygame.Rect(0, 0, max(1, round(1.5 * ui)), round(12 * ui))
        tick.center = round(self.x_of(default)), line.centery
        painter.panel(surface, line, theme.track, line.height / 2)
        self._fill(surface, painter, self.x_of(value), theme.selected)
        surface.fill(theme.muted, tick)
        radius = 8.5 if held else 7.0
        self._draw_handle(surface, painter, value, theme.plate, theme.selected, radius)

    def _place(self, rect: pygame.Rect, line: pygame.Rect, margin: int) -> None:
        """Set the line, and the area that is as high as `rect` and wider than the line."""
        wide = line.width + 2 * margin if line.width else 0
        self._line, self._area = line, pygame.Rect(line.left - margin, rect.top, wide, rect.height)

    def _fill(self, surface: pygame.Surface, painter: Painter, end: float, color: str) -> None:
        """Draw the line from its left end to a pixel `end` from the left of the surface."""
        line, before = self._line, surface.get_clip()
        filled = pygame.Rect(line.left, line.top, end - line.left, line.height)
        surface.set_clip(filled.clip(before))
        painter.panel(surface, line, color, line.height / 2)
        surface.set_clip(before)

    def _draw_handle(
        self,
        surface: pygame.Surface,
        painter: Painter,
        value: float,
        ground: str,
        fill: str,
        radius: float,
    ) -> None:
        """Draw the handle, a disc of a radius [points], at a value. ground: the colour round it."""
        scene, center = Scene(), (self.x_of(value), -self._line.centery)
        scene.circle(center, 0.0, fill=ground, pixels=radius + 2.0)
        scene.circle(center, 0.0, fill=fill, pixels=radius)
        painter.paint(surface, scene.shapes, PIXELS, shaded=False)


class SpeedSlider(Slider):
    """Shows the speed on a line with equally spaced rungs; its values are their numbers.

    rungs: factors of real time in ascending order; after them comes "max", which is inf.
    """

    def __init__(self, rungs: Sequence[float]) -> None:
        """Start with nothing drawn."""
        super().__init__(0.0, len(rungs))
        self.rungs = (*rungs, inf)

    def speed_at(self, x: float) -> float:
        """Return the speed of the rung nearest to a pixel from the left, inf for "max"."""
        return self.rungs[round(self.value_at(x))]

    def value_of(self, speed: float) -> float:
        """Return the number of a speed's rung; between rungs by its logarithm."""
        if speed in self.rungs:
            return self.rungs.index(speed)
        finite = self.rungs[:-1]
        return float(np.interp(log(max(speed, finite[0])), np.log(finite), range(len(finite))))

    def draw(
        self,
        surface: pygame.Surface,
        rect: pygame.Rect,
        painter: Painter,
        speed: float,
        *,
        pointer: Pixel | None = None,
        held: bool = False,
        costs: str = "",
    ) -> None:
        """Draw the slider on a part of a surface, and beside it the speed in words.

        speed: 0 in manual mode, inf for "max". pointer: where the mouse is. held: whether the mouse
        drags the handle. costs: what takes the time, which the words say under the pointer.
        """
        ui, theme, pad = painter.ui, painter.theme, round(16 * painter.ui)
        surface.fill(theme.bar, rect)
        surface.fill(theme.edge, (rect.left, rect.top, rect.width, 1))
        words = round(min(WORDS * ui, WORDS_SHARE * rect.width))
        inner = pygame.Rect(rect.left + pad, rect.top, rect.width - 2 * pad - words, rect.height)
        if inner.width <= 0:
            return
        hovered = held or (pointer is not None and self.hit(pointer))
        rung, real_time = self.value_of(speed), self.rungs.index(1.0)
        self.draw_value(surface, inner, painter, rung, real_time, held=hovered)
        left, word = self._line.right + round(20 * ui), times(speed)
        fits = painter.fonts.width(word, 16 * ui, bold=True) <= rect.right - round(14 * ui) - left
        size, at = (16 if fits else 12), (left, rect.centery)
        painter.write(surface, word, size * ui, theme.ink, bold=True, midleft=at)
        above = rect.top - round(4 * ui)
        if hovered and pointer is not None:
            wanted = self.speed_at(pointer[0])
            at = round(self.x_of(self.value_of(wanted))), above
            draw_tooltip(surface, painter, times(wanted), midbottom=at)
        elif costs and pointer is not None and rect.collidepoint(pointer):
            draw_tooltip(surface, painter, costs, bottomright=(rect.right, above))


def draw_tooltip(
    surface: pygame.Surface, painter: Painter, text: str, **place: tuple[int, int]
) -> pygame.Rect:
    """Draw a word on a plate, within the surface; return the plate. place: as for `get_rect`."""
    ui, theme = painter.ui, painter.theme
    image = painter.fonts.render(text, 13 * ui, theme.ink, bold=True)
    plate = pygame.Rect(0, 0, image.get_width() + round(16 * ui), round(26 * ui))
    for name, pixel in place.items():
        setattr(plate, name, pixel)
    plate.clamp_ip(surface.get_rect())
    painter.panel(surface, plate, theme.plate, 6 * ui, theme.key_edge)
    surface.blit(image, image.get_rect(center=plate.center))
    return plate


def times(factor: float) -> str:
    """Return a factor of real time in words.

    >>> [times(factor) for factor in (0.1, 2.0, 3.27, 341.7, 0.0, float("inf"))]
    ['0.1x', '2x', '3.3x', '340x', 'manual', 'max']
    """
    if factor in (0.0, inf):
        return "max" if factor else "manual"
    if factor >= 10 and factor != round(factor):
        factor = float(f"{factor:.2g}")
    return f"{factor:.10g}x" if factor == round(factor, 1) else f"{factor:.2g}x"
