"""The distances between runs over time, as a plot that grows."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pygame

from mars2d.core.scene import Scene
from mars2d.output.figures.comparison import COLORS, CURVES, NO_DRIFT, Drift
from mars2d.output.raster.camera import PIXELS
from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.plot import Limits, draw_axes, polylines

LEFT, RIGHT, HEAD, FOOT = 72.0, 24.0, 34.0, 26.0
"""The room round the axes, points."""
MIN_TIME = 2.0
"""The shortest time axis, seconds."""
TITLE = "Distance from where contact puts a body"


HIDDEN = 0.01
"""How near a curve has to be to another to be hidden by it, in parts of the axis."""


def _alike(one: Drift, other: Drift, name: str, apart: float) -> bool:
    """Return whether a curve of one drift lies on that of another."""
    both = zip(getattr(one, name).tolist(), getattr(other, name).tolist(), strict=False)
    return all(abs(a - b) < apart for a, b in both)


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
        drifts: Mapping[str, Drift],
        now: float,
        end: float,
    ) -> None:
        """Draw the plot within a rectangle.

        drifts: by the physics. now, end: the time that is shown, and that of the last row, seconds.
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
        largest = max(float(drift.max.max(initial=0.0)) for drift in drifts.values())
        agree = largest < NO_DRIFT
        limits = Limits(0.0, self._end, 0.0, 1.0 if agree else 1.06 * largest)
        draw_axes(surface, area, painter, limits, "m")
        middle, right, scene = rect.top + round(HEAD / 2 * ui), area.right, Scene()
        for mode, drift in reversed(list(drifts.items())):
            for name, dash, width in reversed(CURVES):
                look = {"stroke": COLORS[mode], "width": width, "style": dash}
                for points in polylines(area, limits, drift.time, getattr(drift, name)):
                    scene.line(points * (1, -1), **look)
                word, size = f"{mode}, {name}", 12.5 * ui
                above = drifts[next(iter(drifts))]
                if drift is not above and _alike(drift, above, name, HIDDEN * limits.high):
                    word = f"{word}: the same"
                left = right - painter.fonts.width(word, size) - round(30 * ui)
                if left > area.left:
                    painter.write(surface, word, size, theme.text, midright=(right, middle))
                    scene.line([(left, -middle), (left + 24 * ui, -middle)], **look)
                    right = left - round(14 * ui)
        x = float(limits.pixels(area, np.array([now]), np.zeros(1))[0, 0])
        scene.line([(x, -area.top), (x, -area.bottom)], stroke=theme.selected, width=1.2)
        painter.paint(surface, scene.shapes, PIXELS)
        if agree:
            at = area.center
            painter.write(surface, "the three runs agree", 13 * ui, theme.muted, center=at)
        title = painter.fonts.shorten(TITLE, 13.5 * ui, right - area.left, bold=True)
        if len(title) > len(TITLE) // 2:
            at = area.left, middle
            painter.write(surface, title, 13.5 * ui, theme.ink, bold=True, midleft=at)
