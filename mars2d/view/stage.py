"""The picture between the bars: one frame, drawn over what seldom changes."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import replace

import pygame

from mars2d import frame as scenes
from mars2d.frame import Frame
from mars2d.scenario import Scenario
from mars2d.scene import Polygon, Scene
from mars2d.view.camera import Camera
from mars2d.view.grid import draw_grid, labels
from mars2d.view.layers import Layers
from mars2d.view.painter import Painter
from mars2d.view.theme import PAGE
from mars2d.view.trails import Trails

__all__ = ["Stage"]


class Stage:
    """Draws frames of one experiment after another; used by the window, pictures and films alike.

    The workspace, the grid, the obstacles and the initial poses are drawn once a camera. On a copy
    of that the paths grow. What moves is drawn anew each time.
    """

    def __init__(self, painter: Painter) -> None:
        """Start with nothing drawn."""
        self.painter = painter
        self._still: pygame.Surface | None = None
        self._still_key: Hashable = None
        self._scenario: Scenario | None = None
        self._trailed: pygame.Surface | None = None
        self._trails: Trails | None = None
        self._labels: list[tuple[pygame.Surface, tuple[int, int]]] = []

    def draw(
        self,
        surface: pygame.Surface,
        frame: Frame,
        camera: Camera,
        layers: Layers,
        plot: pygame.Rect | None = None,
    ) -> None:
        """Draw a frame on the part `plot` of a surface, all of it by default."""
        plot = surface.get_rect() if plot is None else plot
        before = surface.get_clip()
        surface.set_clip(plot)
        still = self._background(surface, frame.scenario, camera, layers, plot)
        if layers.trails:
            surface.blit(self._with_trails(still, frame, camera), plot, plot)
            if self._trails is not None:
                self._trails.loose_ends(surface, frame.pose[:2])
        else:
            surface.blit(still, plot, plot)
        moving = Scene()
        if frame.draw_addons is not None:
            frame.draw_addons(moving)
        if layers.sensors:
            moving.extend(scenes.sensors(frame).shapes)
        moving.extend(scenes.robots(frame).shapes)
        self.painter.paint(surface, moving.shapes, camera)
        surface.fblits(self._labels)
        surface.set_clip(before)

    def _background(
        self,
        surface: pygame.Surface,
        scenario: Scenario,
        camera: Camera,
        layers: Layers,
        plot: pygame.Rect,
    ) -> pygame.Surface:
        key = (camera, layers.grid, surface.get_size(), tuple(plot), self.painter.ui)
        if self._still is None or key != self._still_key or scenario is not self._scenario:
            still = pygame.Surface(surface.get_size(), 0, 32)
            still.set_clip(plot)
            still.fill(PAGE)
            self.painter.paint(still, scenes.workspace(scenario).shapes, camera)
            self._labels = []
            if layers.grid:
                self._grid(still, scenario, camera)
            self.painter.paint(still, scenes.obstacles(scenario).shapes, camera)
            if scenario.animation.show_initial_pose:
                self.painter.paint(still, scenes.initial_poses(scenario).shapes, camera)
            self._still, self._still_key, self._scenario = still, key, scenario
            self._trails = None
        return self._still

    def _grid(self, still: pygame.Surface, scenario: Scenario, camera: Camera) -> None:
        bounds = scenario.bounds
        if scenario.workspace is None or scenario.on_exit == "ignore":
            bounds = camera.view(still.get_size())
        draw_grid(still, camera, bounds, self.painter.ui)
        if scenario.workspace is not None:  # its edge lies on the grid
            shapes = scenes.workspace(scenario).shapes
            edge = [replace(s, fill=None) for s in shapes if isinstance(s, Polygon)]
            self.painter.paint(still, edge, camera)
        self._labels = labels(still.get_clip(), camera, bounds, self.painter.fonts, self.painter.ui)

    def _with_trails(self, still: pygame.Surface, frame: Frame, camera: Camera) -> pygame.Surface:
        if self._trails is None or self._trailed is None or not self._trails.continues(frame.path):
            self._trailed = still.copy()
            scenario = frame.scenario
            style = scenario.animation.wake_style
            colors = scenes.trail_colors(scenario)
            self._trails = Trails(self.painter, camera, style, colors, scenes.TRAIL_WIDTH)
        self._trails.prolong(self._trailed, frame.path)
        return self._trailed
