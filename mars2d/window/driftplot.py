"""The distances between runs over time, as a plot that grows."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.core.scene import Scene
from mars2d.output.figures.comparison import COLORS, NO_DRIFT
from mars2d.output.raster.camera import PIXELS
from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.plot import Limits, draw_axes, polylines

Float = NDArray[np.float64]

LEFT, RIGHT, HEAD, FOOT = 72.0, 24.0, 34.0, 26.0
"""The room round the axes, points."""
MIN_TIME = 2.0
"""The shortest time axis, seconds."""
TITLE = "Distance from where contact puts a body"
NOTHING = "the three runs agree"
CURVES = ((1, "mean", "--", 1.4), (0, "largest", "-", 2.2))
"""The column of a drift, its name, its line style and its width, points."""


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
        end: float,
    ) -> None:
        """Draw the plot within a rectangle.

        drifts: (T, 2) metres by the physics, the largest and the mean of all bodies at each control
        step. step: seconds between two. now, end: the time that is shown, and that of the last row.
        """
        ui, theme = painter.ui, painter.theme
        surface.fill(theme.paper, rect)
        surface.fill(theme.edge, (rect.left, rect.top, rect.width, 1))
        self.area = area = pygame.Rect(
            rect.left + round(LEFT * ui), rect.top + round(HEAD * ui),
            rect.width - round((LEFT + RIGHT) * ui), rect.height - round((HEAD + FOOT) * ui),
        )  # fmt: skip
        if area.width <= 0 or area.height <= 0:
            return
        self._end = max(end, MIN_TIME)
        largest = max(float(each.max(initial=0.0)) for each in drifts.values())
        agree = largest < NO_DRIFT
        limits = Limits(0.0, self._end, 0.0, 1.0 if agree else 1.06 * largest)
        draw_axes(surface, area, painter, limits, "m")
        self._draw_names(surface, rect, painter)
        scene = Scene()
        for mode, drift in drifts.items():
            times = step * np.arange(len(drift), dtype=np.float64)
            for column, _, style, width in CURVES:
                for points in polylines(area, limits, times, drift[:, column]):
                    scene.line(points * (1, -1), stroke=COLORS[mode], width=width, style=style)
        x = float(limits.pixels(area, np.array([now]), np.zeros(1))[0, 0])
        scene.line([(x, -area.top), (x, -area.bottom)], stroke=theme.selected, width=1.2)
        painter.paint(surface, scene.shapes, PIXELS)
        if agree:
            painter.write(surface, NOTHING, 13 * ui, theme.muted, center=area.center)

    def _draw_names(self, surface: pygame.Surface, rect: pygame.Rect, painter: Painter) -> None:
        """Write the title, and the names of the curves at the right; where it is narrow, fewer."""
        ui, fonts, theme = painter.ui, painter.fonts, painter.theme
        middle, right, size = rect.top + round(HEAD / 2 * ui), self.area.right, 12.5 * ui
        names = [
            (f"{mode}, {name}" if name == "largest" else name, style, width, color)
            for mode, color in reversed(COLORS.items())
            if mode != "contact"
            for _, name, style, width in CURVES
        ]
        if sum(fonts.width(each[0], size) + 44 * ui for each in names) > self.area.width:
            names = [(each[0].partition(",")[0], *each[1:]) for each in names if each[1] == "-"]
        scene = Scene()
        for name, style, width, color in names:
            place = painter.write(surface, name, size, theme.text, midright=(right, middle))
            right = place.left - round(6 * ui)
            line = [(right - 24 * ui, -middle), (right, -middle)]
            scene.line(line, stroke=color, width=width, style=style)
            right -= round(38 * ui)
        painter.paint(surface, scene.shapes, PIXELS)
        title = fonts.shorten(TITLE, 13.5 * ui, right - self.area.left, bold=True)
        if len(title) > len(TITLE) // 2:
            at = self.area.left, middle
            painter.write(surface, title, 13.5 * ui, theme.ink, bold=True, midleft=at)
