"""The slider of the speed, from slow motion to as fast as it goes."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, log

import pygame

from mars2d.core.scene import Scene
from mars2d.output.raster.camera import PIXELS
from mars2d.output.raster.painter import Painter
from mars2d.window.tooltip import draw_tooltip

__all__ = ["SpeedSlider", "times"]

BAND = 4.0
"""The height of its line, points."""
VALUE, SHARE = 108.0, 0.48
"""The room for the words beside it, points, and of all at most."""
BEHIND = 0.9
"""Reached is less than wanted below such a share of it."""


class SpeedSlider:
    """Shows a speed on a line whose rungs are equally far apart, and tells which lies where.

    rungs: factors of real time in ascending order, about equally far apart as factors; above them
    lies "max", as inf.
    """

    def __init__(self, rungs: Sequence[float]) -> None:
        """Take the rungs; nothing is drawn yet."""
        self.rungs = (*rungs, inf)
        self._line = pygame.Rect(0, 0, 0, 0)
        self._area = pygame.Rect(0, 0, 0, 0)

    def hit(self, pixel: tuple[int, int]) -> bool:
        """Return whether a pixel belongs to the slider: a press there chooses its speed."""
        return bool(self._area.collidepoint(pixel))

    def speed_at(self, x: float) -> float | None:
        """Return the speed of the rung nearest to a pixel from the left, inf for "max"; or None.

        None as long as nothing is drawn, or where there is no room for it.
        """
        if self._line.width <= 0:
            return None
        last = len(self.rungs) - 1
        share = (x - self._line.left) / self._line.width
        return self.rungs[min(max(round(share * last), 0), last)]

    def x_of(self, speed: float) -> float:
        """Return how far from the left a speed lies, pixels; between rungs by its logarithm."""
        last = len(self.rungs) - 1
        if speed >= self.rungs[-2]:
            place = float(last if speed == inf else last - 1)
        else:
            speed = max(speed, self.rungs[0])
            k = max(i for i, rung in enumerate(self.rungs) if rung <= speed)
            low, high = self.rungs[k], self.rungs[k + 1]
            place = k + log(speed / low) / log(high / low)
        return self._line.left + self._line.width * place / last

    def draw(
        self,
        surface: pygame.Surface,
        rect: pygame.Rect,
        painter: Painter,
        speed: float,
        reached: float | None = None,
        *,
        pointer: tuple[int, int] | None = None,
        held: bool = False,
    ) -> None:
        """Draw it on a part of a surface.

        speed: 0 in manual mode, inf for "max". reached: the factor of real time of late, if known.
        pointer: where the mouse is. held: it drags the handle.
        """
        ui, theme = painter.ui, painter.theme
        surface.fill(theme.bar, rect)
        surface.fill(theme.edge, (rect.left, rect.top, rect.width, 1))
        self._arrange(rect, ui)
        if self._line.width <= 0:
            return
        hovered = held or (pointer is not None and self.hit(pointer))
        self._draw_line(surface, painter, speed)
        scene = Scene()
        center = self.x_of(speed), -self._line.centery
        scene.circle(center, 0.0, fill=theme.bar, pixels=10.0 if hovered else 8.5)
        scene.circle(
            center,
            0.0,
            fill=theme.selected if speed > 0 else theme.bar,
            stroke=theme.selected,
            width=1.5,
            pixels=8.0 if hovered else 6.5,
        )
        painter.paint(surface, scene.shapes, PIXELS, shaded=False)
        self._words(surface, rect, painter, speed, reached)
        if hovered and pointer is not None:
            wanted = self.speed_at(pointer[0])
            place = round(self.x_of(wanted or 1.0)), rect.top - round(4 * ui)
            draw_tooltip(surface, painter, times(wanted or 1.0), place)

    def _arrange(self, rect: pygame.Rect, ui: float) -> None:
        pad = round(16 * ui)
        words = round(min(VALUE * ui, SHARE * rect.width))
        height = max(2, round(BAND * ui))
        line = pygame.Rect(rect.left + pad, 0, max(0, rect.width - 2 * pad - words), height)
        line.centery = rect.centery
        self._line = line
        self._area = pygame.Rect(line.left - round(10 * ui), rect.top, 0, rect.height)
        self._area.width = line.width + round(20 * ui) if line.width else 0

    def _draw_line(self, surface: pygame.Surface, painter: Painter, speed: float) -> None:
        """Draw the line up to the handle and beyond it, and a tick at each rung."""
        ui, theme, line = painter.ui, painter.theme, self._line
        painter.panel(surface, line, theme.track, line.height / 2)
        before = surface.get_clip()
        played = self.x_of(speed) - line.left
        surface.set_clip(pygame.Rect(line.left, line.top, played, line.height))
        painter.panel(surface, line, theme.selected, line.height / 2)
        surface.set_clip(before)
        for k, rung in enumerate(self.rungs):
            x = round(line.left + line.width * k / (len(self.rungs) - 1))
            long = round((7 if rung in (1.0, inf) else 4) * ui)
            color = theme.muted if rung == 1.0 else theme.track
            surface.fill(color, (x, line.bottom + round(3 * ui), max(1, round(ui)), long))

    def _words(
        self,
        surface: pygame.Surface,
        rect: pygame.Rect,
        painter: Painter,
        speed: float,
        reached: float | None,
    ) -> None:
        """Write the speed, and below it what is reached where that is less."""
        ui, theme, fonts = painter.ui, painter.theme, painter.fonts
        left = self._line.right + round(20 * ui)
        room = rect.right - round(14 * ui) - left
        word = times(speed)
        size = next((s for s in (16, 14) if fonts.width(word, s * ui, bold=True) <= room), 12)
        image = fonts.render(word, size * ui, theme.ink, bold=True)
        behind = reached is not None and (speed == inf or reached < BEHIND * speed)
        if reached is None or not behind:
            surface.blit(image, image.get_rect(midleft=(left, rect.centery)))
            return
        surface.blit(image, image.get_rect(midleft=(left, rect.centery - round(9 * ui))))
        text = next(
            (t for t in (f"reaches {times(reached)}", times(reached))
             if fonts.width(t, 12.5 * ui) <= room),
            "",
        )  # fmt: skip
        color = theme.muted if speed == inf else theme.waiting.ink
        image = fonts.render(text, 12.5 * ui, color)
        surface.blit(image, image.get_rect(midleft=(left, rect.centery + round(11 * ui))))


def times(factor: float) -> str:
    """Return a factor of real time as it is read.

    >>> [times(factor) for factor in (0.1, 2.0, 3.27, 341.7, 0.0, float("inf"))]
    ['0.1x', '2x', '3.3x', '340x', 'manual', 'max']
    """
    if factor in (0.0, inf):
        return "max" if factor else "manual"
    if factor >= 10 and factor != round(factor):
        factor = float(f"{factor:.2g}")
    return f"{factor:.10g}x" if factor == round(factor, 1) else f"{factor:.2g}x"
