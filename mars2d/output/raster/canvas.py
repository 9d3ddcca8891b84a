"""The layers that seldom change, drawn once for a camera: those that stand still, and paths."""

from __future__ import annotations

from itertools import takewhile
from time import perf_counter

import pygame

from mars2d.output.layers.table import Layers, standing
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.grid import Bounds, draw_grid
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.trails import Wakes
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario

__all__ = ["Canvas", "grid_bounds"]

WHOLE = 1e-6
"""Shifts that are off a whole number of pixels by less are whole."""


class Canvas:
    """A part of the world as a camera sees it, which another camera of that scale may look at.

    camera: of the whole surface. area: its part that is drawn, pixels. memory: bytes that may be
    used to go back quickly. seconds: what drawing took.
    """

    def __init__(
        self,
        painter: Painter,
        frame: Frame,
        camera: Camera,
        layers: Layers,
        size: tuple[int, int],
        area: pygame.Rect,
        *,
        memory: int = 0,
    ) -> None:
        """Draw the layers that stand still on a surface of `size` pixels."""
        start = perf_counter()
        self.camera, self.area = camera, area
        self.still = pygame.Surface(size, 0, 32)
        self.still.set_clip(area)
        self.still.fill(painter.theme.page)
        scenario = frame.scenario
        for layer in takewhile(standing().__contains__, layers.seen(scenario.animation)):
            if layer.shapes is None:
                bounds = grid_bounds(scenario, camera, size)
                draw_grid(self.still, camera, bounds, painter.ui, painter.theme)
            else:
                painter.paint(self.still, layer.shapes(frame).shapes, camera)
        self.wakes: Wakes | None = None
        self._painter, self._scenario, self._memory = painter, scenario, memory
        self.seconds = perf_counter() - start

    def with_paths(self, frame: Frame, until: float = float("inf")) -> pygame.Surface | None:
        """Return the picture with the paths until a frame; None if they are not drawn in time."""
        start = perf_counter()
        if fresh := self.wakes is None:
            self.wakes = Wakes(self._painter, self._scenario, self.camera, self.still, self._memory)
        done = self.wakes.show((frame.prop_path, frame.path), until)
        if fresh:
            self.seconds += perf_counter() - start
        return self.wakes.surface if done else None

    def shift(self, camera: Camera) -> tuple[int, int]:
        """Return where the surface's corner lies for another camera, to whole pixels."""
        return round(camera.x - self.camera.x), round(camera.y - self.camera.y)

    def shows(self, camera: Camera, plot: pygame.Rect) -> bool:
        """Return whether all is drawn that a camera sees on a part of a surface."""
        dx, dy = self.shift(camera)
        return camera.scale == self.camera.scale and self.area.contains(plot.move(-dx, -dy))

    def is_exact(self, camera: Camera) -> bool:
        """Return whether it is what that camera sees, without rounding."""
        dx, dy = self.shift(camera)
        off = camera.x - self.camera.x - dx, camera.y - self.camera.y - dy
        return camera.scale == self.camera.scale and max(map(abs, off)) < WHOLE


def grid_bounds(scenario: Scenario, camera: Camera, size: tuple[int, int]) -> Bounds:
    """Return where there is a grid, (xmin, xmax, ymin, ymax) in metres."""
    if scenario.workspace is None or scenario.on_exit == "ignore":
        return camera.view(size)
    return scenario.bounds
