"""The picture between the bars: one frame, drawn over what seldom changes."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import replace
from math import ceil, floor
from time import perf_counter

import pygame

from mars2d import frame as scenes
from mars2d.forces import forces
from mars2d.frame import Frame
from mars2d.links import messages
from mars2d.scenario import Scenario
from mars2d.scene import Polygon, Shape
from mars2d.view.camera import Camera
from mars2d.view.grid import draw_grid, labels
from mars2d.view.layers import Layers
from mars2d.view.legend import draw_legend
from mars2d.view.painter import Painter
from mars2d.view.theme import PAGE
from mars2d.view.trails import Trails

__all__ = ["Stage"]

PATIENCE = 0.012
"""The seconds that drawing what stands still may take without the movement of a camera jerking."""


class Stage:
    """Draws frames of one experiment after another; used by the window, pictures and films alike.

    The workspace, the grid, the obstacles and the initial poses are drawn once a camera. On a copy
    of that the paths grow. On a copy of that is what the sensors have read, until they read again.
    What moves is drawn anew each time.
    """

    def __init__(self, painter: Painter) -> None:
        """Start with nothing drawn."""
        self.painter = painter
        self._still: pygame.Surface | None = None
        self._still_key: Hashable = None
        self._scenario: Scenario | None = None
        self._trailed: pygame.Surface | None = None
        self._trails: tuple[Trails, ...] = ()  # of the props, of the robots
        self._sensed: pygame.Surface | None = None
        self._sensed_of: tuple[object, ...] = ()
        self._labels: list[tuple[pygame.Surface, tuple[int, int]]] = []
        self._camera: Camera | None = None
        self._seconds = 0.0

    def draw(
        self,
        surface: pygame.Surface,
        frame: Frame,
        camera: Camera,
        layers: Layers,
        plot: pygame.Rect | None = None,
        *,
        marks: Sequence[Shape] = (),
        hurried: bool = False,
    ) -> None:
        """Draw a frame on the part `plot` of a surface, all of it by default.

        marks: shapes to draw over the bodies, beneath the forces. hurried: while the camera moves.
        If drawing what stands still took long, the picture drawn last is enlarged or moved instead,
        until there is time to draw it anew.
        """
        plot = surface.get_rect() if plot is None else plot
        before = surface.get_clip()
        surface.set_clip(plot)
        slow = self._seconds > PATIENCE and frame.scenario is self._scenario
        if not (hurried and slow and self._moved(surface, camera, layers, plot)):
            start = perf_counter()
            still = self._background(surface, frame.scenario, camera, layers, plot)
            picture = self._with_trails(still, frame, camera) if layers.trails else still
            if self._camera != camera:
                self._camera, self._seconds = camera, perf_counter() - start
            if layers.sensors:
                picture = self._with_sensors(picture, frame, camera, plot)
            surface.blit(picture, plot, plot)
            if layers.trails:
                for trails, poses in zip(self._trails, (frame.prop_pose, frame.pose), strict=False):
                    trails.loose_ends(surface, poses[:2])
        elif layers.sensors:
            self.painter.paint(surface, scenes.sensors(frame).shapes, camera)
        moving = scenes.addons(frame)
        if layers.theory:
            moving.extend(scenes.theory(frame).shapes)
        if layers.messages:
            moving.extend(messages(frame).shapes)
        for scene in (scenes.props(frame), scenes.robots(frame), scenes.joints(frame)):
            moving.extend(scene.shapes)
        moving.extend(marks)
        if layers.forces:
            moving.extend(forces(frame).shapes)
        self.painter.paint(surface, moving.shapes, camera)
        if camera == self._camera:
            surface.fblits(self._labels)
        if layers.forces:
            draw_legend(surface, self.painter, frame.scenario, camera, plot)
        surface.set_clip(before)

    def _moved(
        self, surface: pygame.Surface, camera: Camera, layers: Layers, plot: pygame.Rect
    ) -> bool:
        """Draw the last picture as another camera sees it, roughly; return whether there is one."""
        last = self._trailed if layers.trails and self._trails else self._still
        if last is None or self._camera is None or last.get_size() != surface.get_size():
            return False
        factor = camera.scale / self._camera.scale
        corner = camera.x - factor * self._camera.x, camera.y - factor * self._camera.y
        # Whole pixels of the last picture, as many as are seen now.
        seen = pygame.Rect(0, 0, ceil(plot.width / factor) + 2, ceil(plot.height / factor) + 2)
        seen.left = floor((plot.left - corner[0]) / factor)
        seen.top = floor((plot.top - corner[1]) / factor)
        seen = seen.clip(plot)
        surface.fill(PAGE, plot)
        if seen.width > 0 and seen.height > 0:
            size = round(seen.width * factor), round(seen.height * factor)
            place = corner[0] + factor * seen.left, corner[1] + factor * seen.top
            surface.blit(pygame.transform.scale(last.subsurface(seen), size), place)
        return True

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
            floor = scenes.floor(scenario).shapes
            if floor:
                self.painter.paint(still, floor, camera)
                self._edge(still, scenario, camera)
            self._labels = []
            if layers.grid:
                self._grid(still, scenario, camera)
            self.painter.paint(still, scenes.obstacles(scenario).shapes, camera)
            if scenario.animation.show_initial_pose:
                self.painter.paint(still, scenes.initial_poses(scenario).shapes, camera)
            self._still, self._still_key, self._scenario = still, key, scenario
            self._trails = ()
        return self._still

    def _grid(self, still: pygame.Surface, scenario: Scenario, camera: Camera) -> None:
        bounds = scenario.bounds
        if scenario.workspace is None or scenario.on_exit == "ignore":
            bounds = camera.view(still.get_size())
        draw_grid(still, camera, bounds, self.painter.ui)
        self._edge(still, scenario, camera)
        self._labels = labels(still.get_clip(), camera, bounds, self.painter.fonts, self.painter.ui)

    def _edge(self, still: pygame.Surface, scenario: Scenario, camera: Camera) -> None:
        """Draw the workspace's edge again, over the floor or the grid."""
        shapes = scenes.workspace(scenario).shapes
        edge = [replace(s, fill=None) for s in shapes if isinstance(s, Polygon)]
        self.painter.paint(still, edge, camera)

    def _with_trails(self, still: pygame.Surface, frame: Frame, camera: Camera) -> pygame.Surface:
        paths = (frame.prop_path, frame.path)
        kept = self._trails and all(
            trails.continues(path) for trails, path in zip(self._trails, paths, strict=True)
        )
        if self._trailed is None or not kept:
            self._trailed = still.copy()
            self._trails = self._new_trails(frame.scenario, camera)
        for trails, path in zip(self._trails, paths, strict=True):
            trails.prolong(self._trailed, path)
        return self._trailed

    def _with_sensors(
        self, picture: pygame.Surface, frame: Frame, camera: Camera, plot: pygame.Rect
    ) -> pygame.Surface:
        """Return a copy of a picture with what the sensors have read on it, drawn if it is new."""
        sensors = (sensor for robot in frame.scenario.robots for sensor in robot.sensors)
        stays = all(sensor.stays for sensor in sensors)
        sensed = frame.pose if frame.sensed is None else frame.sensed
        made_of = picture, frame.path, frame.readings, sensed, None if stays else frame.pose
        same = all(a is b for a, b in zip(made_of, self._sensed_of, strict=False))
        if self._sensed is None or not same:
            shapes = scenes.sensors(frame).shapes
            if not shapes:
                return picture
            if self._sensed is None or self._sensed.get_size() != picture.get_size():
                self._sensed = picture.copy()
            self._sensed.set_clip(plot)
            self._sensed.blit(picture, plot, plot)
            self.painter.paint(self._sensed, shapes, camera)
            self._sensed_of = made_of
        return self._sensed

    def _new_trails(self, scenario: Scenario, camera: Camera) -> tuple[Trails, Trails]:
        thin = scenes.prop_trail_colors(scenario), scenes.PROP_TRAIL_WIDTH
        style = scenario.animation.wake_style
        colors = scenes.trail_colors(scenario)
        return (
            Trails(self.painter, camera, "-", *thin),
            Trails(self.painter, camera, style, colors, scenes.TRAIL_WIDTH),
        )
