"""Sliders: a line with a handle; the slider of the speed, and that of a value."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, log

import pygame

from mars2d.core.scene import Scene
from mars2d.output.raster.camera import PIXELS
from mars2d.output.raster.painter import Painter

SPEED_LINE = 4.0
"""The height of the speed slider's line, points."""
WORDS, WORDS_SHARE = 108.0, 0.48
"""The room for the words beside the line: points, and at most this share of the slider."""
BEHIND = 0.9
"""A run that reaches less than this share of the chosen speed lags behind."""


class Slider:
    """The base of sliders: a line, and an area round it in which a press moves the handle."""

    def __init__(self) -> None:
        """Start with nothing drawn."""
        self._line = pygame.Rect(0, 0, 0, 0)
        self._area = pygame.Rect(0, 0, 0, 0)

    def hit(self, pixel: tuple[int, int]) -> bool:
        """Return whether a press at a pixel moves the handle."""
        return bool(self._area.collidepoint(pixel))

    def _place(self, rect: pygame.Rect, line: pygame.Rect, margin: int) -> None:
        """Set the line, and the area that is as high as `rect` and wider than the line."""
        self._line = line
        self._area = pygame.Rect(line.left - margin, rect.top, 0, rect.height)
        self._area.width = line.width + 2 * margin if line.width else 0

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
        x: float,
        *,
        ground: str,
        fill: str,
        large: bool,
    ) -> None:
        """Draw the handle, a disc, at a pixel from the left. ground: the colour round it."""
        scene, center = Scene(), (x, -self._line.centery)
        scene.circle(center, 0.0, fill=ground, pixels=10.0 if large else 8.5)
        edge, radius = painter.theme.selected, 8.0 if large else 6.5
        scene.circle(center, 0.0, fill=fill, stroke=edge, width=1.5, pixels=radius)
        painter.paint(surface, scene.shapes, PIXELS, shaded=False)


class SpeedSlider(Slider):
    """Shows the speed on a line with equally spaced rungs.

    rungs: factors of real time in ascending order, with about equal ratios; the last rung, "max",
    is inf.
    """

    def __init__(self, rungs: Sequence[float]) -> None:
        """Start with nothing drawn."""
        super().__init__()
        self.rungs = (*rungs, inf)

    def speed_at(self, x: float) -> float | None:
        """Return the speed of the rung nearest to a pixel from the left, inf for "max".

        None while nothing is drawn, or if there is no room for the line.
        """
        if self._line.width <= 0:
            return None
        last = len(self.rungs) - 1
        share = (x - self._line.left) / self._line.width
        return self.rungs[min(max(round(share * last), 0), last)]

    def x_of(self, speed: float) -> float:
        """Return where a speed lies, pixels from the left; between rungs by its logarithm."""
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
        costs: str = "",
    ) -> None:
        """Draw the slider on a part of a surface.

        speed: 0 in manual mode, inf for "max". reached: the recent factor of real time, if known.
        pointer: where the mouse is. held: whether the mouse drags the handle. costs: what takes the
        time, which the words beside the slider say under the pointer.
        """
        ui, theme = painter.ui, painter.theme
        surface.fill(theme.bar, rect)
        surface.fill(theme.edge, (rect.left, rect.top, rect.width, 1))
        self._arrange(rect, ui)
        if self._line.width <= 0:
            return
        hovered = held or (pointer is not None and self.hit(pointer))
        self._draw_line(surface, painter, speed)
        fill = theme.selected if speed > 0 else theme.bar
        self._draw_handle(
            surface, painter, self.x_of(speed), ground=theme.bar, fill=fill, large=hovered
        )
        self._words(surface, rect, painter, speed, reached)
        if hovered and pointer is not None:
            wanted = self.speed_at(pointer[0])
            place = round(self.x_of(wanted or 1.0)), rect.top - round(4 * ui)
            draw_tooltip(surface, painter, times(wanted or 1.0), midbottom=place)
        elif costs and pointer is not None and rect.collidepoint(pointer):
            draw_tooltip(
                surface, painter, costs, bottomright=(rect.right, rect.top - round(4 * ui))
            )

    def _arrange(self, rect: pygame.Rect, ui: float) -> None:
        pad = round(16 * ui)
        words = round(min(WORDS * ui, WORDS_SHARE * rect.width))
        height = max(2, round(SPEED_LINE * ui))
        line = pygame.Rect(rect.left + pad, 0, max(0, rect.width - 2 * pad - words), height)
        line.centery = rect.centery
        self._place(rect, line, round(10 * ui))

    def _draw_line(self, surface: pygame.Surface, painter: Painter, speed: float) -> None:
        """Draw the line up to the handle and beyond, and a tick at each rung."""
        ui, theme, line = painter.ui, painter.theme, self._line
        painter.panel(surface, line, theme.track, line.height / 2)
        self._fill(surface, painter, self.x_of(speed), theme.selected)
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
        """Write the speed, and below it the speed that is reached if that is less."""
        ui, theme, fonts = painter.ui, painter.theme, painter.fonts
        left = self._line.right + round(20 * ui)
        room = rect.right - round(14 * ui) - left
        word = times(speed)
        size = next((s for s in (16, 14) if fonts.width(word, s * ui, bold=True) <= room), 12)
        behind = reached is not None and (speed == inf or reached < BEHIND * speed)
        at = (left, rect.centery - 9 * ui * behind)
        painter.write(surface, word, size * ui, theme.ink, bold=True, midleft=at)
        if reached is None or not behind:
            return
        text = next(
            (t for t in (f"reaches {times(reached)}", times(reached))
             if fonts.width(t, 12.5 * ui) <= room),
            "",
        )  # fmt: skip
        color = theme.muted if speed == inf else theme.waiting.ink
        below = (left, rect.centery + 11 * ui)
        painter.write(surface, text, 12.5 * ui, color, midleft=below)


class ValueSlider(Slider):
    """Shows a value on a line from its lowest to its highest, with a tick at its default."""

    def __init__(self) -> None:
        """Start with nothing drawn."""
        super().__init__()
        self._low, self._high = 0.0, 1.0

    def value_at(self, x: float) -> float:
        """Return the value at a pixel from the left, between the lowest and the highest."""
        share = (x - self._line.left) / max(1, self._line.width)
        return self._low + min(max(share, 0.0), 1.0) * (self._high - self._low)

    def x_of(self, value: float) -> float:
        """Return where a value lies, pixels from the left."""
        share = (value - self._low) / (self._high - self._low)
        return self._line.left + self._line.width * min(max(share, 0.0), 1.0)

    def draw(
        self,
        surface: pygame.Surface,
        rect: pygame.Rect,
        painter: Painter,
        value: float,
        default: float,
        between: tuple[float, float],
        *,
        held: bool,
    ) -> None:
        """Draw the slider within a rectangle. held: whether the handle is dragged."""
        ui, theme = painter.ui, painter.theme
        self._low, self._high = between
        line = pygame.Rect(rect.left, 0, rect.width, max(2, round(SPEED_LINE * ui)))
        line.centery = rect.centery
        self._place(rect, line, round(8 * ui))
        painter.panel(surface, line, theme.track, line.height / 2)
        self._fill(surface, painter, self.x_of(value), theme.selected)
        tick = pygame.Rect(0, 0, max(1, round(1.5 * ui)), round(12 * ui))
        tick.center = round(self.x_of(default)), line.centery
        surface.fill(theme.muted, tick)
        self._draw_handle(
            surface, painter, self.x_of(value), ground=theme.plate, fill=theme.selected, large=held
        )


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
