"""The distances between runs over time, as a plot that grows."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.core.plane import grid_step
from mars2d.core.scene import Scene
from mars2d.output.figures.comparison import COLORS, NO_DRIFT
from mars2d.output.raster.camera import PIXELS
from mars2d.output.raster.painter import Painter

Float = NDArray[np.float64]

LEFT, RIGHT, HEAD, FOOT = 72.0, 24.0, 34.0, 26.0
"""The room round the axes, points."""
MIN_TIME = 2.0
"""The shortest time axis, seconds."""
TITLE = "Distance from where contact puts a body"
NOTHING = "the three runs agree"


class DriftPlot:
    """Draws the largest and the mean drift of "stop" and "ideal"; a click on it is a time."""

    def __init__(self) -> None:
        """Start with nothing drawn."""
        self.area = pygame.Rect(0, 0, 0, 0)
        self._end = 1.0

    def hit(self, pixel: tuple[int, int]) -> bool:
        """Return whether a pixel is within the axes."""
        return bool(self.area.collidepoint(pixel))

    def time_at(self, x: float) -> float:
        """Return the time at a pixel from the left, seconds."""
        share = (x - self.area.left) / max(1, self.area.width)
        return min(max(share, 0.0), 1.0) * self._end

    def draw(
        self,
        surface: pygame.Surface,
        rect: pygame.Rect,
        painter: Painter,
        drifts: Mapping[str, Float],
        step: float,
        now: float,
    ) -> None:
        """Draw the plot within a rectangle.

        drifts: (T, 2) metres by the physics, the largest and the mean of all bodies at each control
        step. step: seconds between two. now: the time that is shown, seconds.
        """
        ui, theme, fonts = painter.ui, painter.theme, painter.fonts
        surface.fill(theme.paper, rect)
        surface.fill(theme.edge, (rect.left, rect.top, rect.width, 1))
        self.area = pygame.Rect(
            rect.left + round(LEFT * ui), rect.top + round(HEAD * ui),
            rect.width - round((LEFT + RIGHT) * ui), rect.height - round((HEAD + FOOT) * ui),
        )  # fmt: skip
        if self.area.width <= 0 or self.area.height <= 0:
            return
        lasts = [step * (len(each) - 1) for each in drifts.values() if len(each)]
        self._end = max(*lasts, MIN_TIME)
        top = max((float(each[:, 0].max()) for each in drifts.values() if len(each)), default=0.0)
        agree, top = top < NO_DRIFT, 1.06 * top if top >= NO_DRIFT else 1.0
        self._draw_axes(surface, painter, top)
        self._draw_names(surface, rect, painter)
        scene = Scene()
        for mode, drift in drifts.items():
            for column, style, width in ((1, "--", 1.4), (0, "-", 2.2)):
                self._curve(scene, drift[:, column], step, top, COLORS[mode], style, width)
        x = self.area.left + self.area.width * min(now / self._end, 1.0)
        scene.line(
            [(x, -self.area.top), (x, -self.area.bottom)], stroke=theme.selected, width=1.2
        )  # fmt: skip
        painter.paint(surface, scene.shapes, PIXELS)
        if agree:
            image = fonts.render(NOTHING, 13 * ui, theme.muted)
            surface.blit(image, image.get_rect(center=self.area.center))

    def _curve(
        self, scene: Scene, values: Float, step: float, top: float, color: str, style: str,
        width: float,
    ) -> None:  # fmt: skip
        """Add a curve, with a point at most for each pixel."""
        if len(values) < 2:
            return
        rows = np.unique(np.linspace(0, len(values) - 1, self.area.width + 1).astype(int))
        x = self.area.left + self.area.width * step * rows / self._end
        y = self.area.bottom - self.area.height * np.minimum(values[rows] / top, 1.0)
        scene.line(np.column_stack([x, -y]), stroke=color, width=width, style=style)

    def _draw_axes(self, surface: pygame.Surface, painter: Painter, top: float) -> None:
        """Draw the grid, and the numbers of both axes."""
        ui, fonts, theme, area = painter.ui, painter.fonts, painter.theme, self.area
        step = grid_step(top * 30 * ui / area.height)
        for k in range(int(top / step + 1e-9) + 1):
            y = area.bottom - round(k * step / top * area.height)
            surface.fill(theme.grid_axis if k == 0 else theme.grid, (area.left, y, area.width, 1))
            image = fonts.render(f"{k * step:.4g} m", 11.5 * ui, theme.muted)
            surface.blit(image, image.get_rect(midright=(area.left - round(8 * ui), y)))
        step = grid_step(self._end * 90 * ui / area.width)
        for k in range(int(self._end / step + 1e-9) + 1):
            x = area.left + round(k * step / self._end * area.width)
            surface.fill(theme.grid, (x, area.top, 1, area.height))
            image = fonts.render(f"{k * step:.6g} s", 11.5 * ui, theme.muted)
            surface.blit(image, image.get_rect(midtop=(x, area.bottom + round(5 * ui))))

    def _draw_names(self, surface: pygame.Surface, rect: pygame.Rect, painter: Painter) -> None:
        """Write the title, and the names of the curves at the right."""
        ui, fonts, theme = painter.ui, painter.fonts, painter.theme
        middle, right = rect.top + round(HEAD / 2 * ui), self.area.right
        scene, size = Scene(), 12.5 * ui
        curves = [
            [("mean", "--", 1.4, color), (f"{mode}, largest", "-", 2.2, color)]
            for mode, color in reversed(COLORS.items())
            if mode != "contact"
        ]
        words = "".join(name for curve in curves for name, *_ in curve)
        if fonts.width(words, size) + 4 * 44 * ui > self.area.width:
            curves = [[(each[1][0].partition(",")[0], "-", 2.2, each[1][3])] for each in curves]
        for each in curves:
            for name, style, width, color in each:
                image = fonts.render(name, 12.5 * ui, theme.text)
                surface.blit(image, image.get_rect(midright=(right, middle)))
                right -= image.get_width() + round(6 * ui)
                line = [(right - 24 * ui, -middle), (right, -middle)]
                scene.line(line, stroke=color, width=width, style=style)
                right -= round(38 * ui)
        painter.paint(surface, scene.shapes, PIXELS)
        title = fonts.shorten(TITLE, 13.5 * ui, right - self.area.left, bold=True)
        if len(title) > len(TITLE) // 2:
            image = fonts.render(title, 13.5 * ui, theme.ink, bold=True)
            surface.blit(image, image.get_rect(midleft=(self.area.left, middle)))
