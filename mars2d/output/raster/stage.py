"""The picture between the bars: the layers of a frame over those that are kept."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from itertools import takewhile
from math import ceil, floor
from operator import is_
from time import perf_counter
from typing import NamedTuple

import pygame

from mars2d.core.scene import Shape
from mars2d.output.layers.addons import sensors
from mars2d.output.layers.bodies import starts
from mars2d.output.layers.legend import legends
from mars2d.output.layers.table import FIRST_BODIES, LAST_BODIES, LAYERS, Layers, standing
from mars2d.output.layers.trails import trails
from mars2d.output.raster.camera import PIXELS, Camera
from mars2d.output.raster.grid import Bounds, draw_grid, labels
from mars2d.output.raster.legend import draw_legends
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.trails import Wakes
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario


class Canvas:
    """The layers that seldom change, drawn once for a camera: those that stand still, and paths.

    seconds: the time that drawing took. made: when it began, on the clock of `perf_counter`.
    """

    def __init__(
        self, painter: Painter, frame: Frame, camera: Camera, layers: Layers, size: tuple[int, int],
        plot: pygame.Rect,
    ) -> None:  # fmt: skip
        """Draw the layers that stand still on the part `plot` of a surface of `size` pixels."""
        self.made, self.camera, self.area = perf_counter(), camera, plot
        self.still = pygame.Surface(size, 0, 32)
        self.still.set_clip(plot)
        self.still.fill(painter.theme.page)
        scenario = frame.scenario
        for layer in takewhile(standing().__contains__, layers.seen(scenario.animation)):
            if layer.shapes is None:
                bounds = grid_bounds(scenario, camera, size)
                draw_grid(self.still, camera, bounds, painter)
            else:
                painter.paint(self.still, layer.shapes(frame).shapes, camera)
        self.wakes: Wakes | None = None
        if layers.trails and scenario.animation.wake_style == "-":
            self.wakes = Wakes(painter, scenario, camera, self.still)
            self.wakes.show(frame)
        self.seconds = perf_counter() - self.made

    def picture(self, frame: Frame) -> pygame.Surface:
        """Return the picture, with solid paths up to a frame if they are seen."""
        if self.wakes is None:
            return self.still
        self.wakes.show(frame)
        return self.wakes.surface


def grid_bounds(scenario: Scenario, camera: Camera, size: tuple[int, int]) -> Bounds:
    """Return the bounds of the grid, (xmin, xmax, ymin, ymax) in metres."""
    if scenario.workspace is None or scenario.on_exit == "ignore":
        return camera.view(size)
    return scenario.bounds


PATIENCE = 0.012
"""The seconds that the kept layers may take to draw before a moving camera jerks."""

MAX_AGE = 0.25
"""Where it takes longer, the seconds for which a moving camera shows them shifted or enlarged."""

NUMBERS = 48.0
"""The room for the numbers of an axis, points."""


class _Shot(NamedTuple):
    """What is drawn, and where: on the part `plot` of a surface."""

    surface: pygame.Surface
    frame: Frame
    camera: Camera
    layers: Layers
    plot: pygame.Rect


class Stage:
    """Draws frames of one experiment after another; used by the window, pictures and films alike.

    The layers that stand still are drawn once for each camera. Solid paths grow on a copy of that
    picture, and the readings are drawn on a copy of the paths, until the sensors read again. All
    other layers are drawn for each frame.
    """

    def __init__(self, painter: Painter) -> None:
        """Start with nothing drawn."""
        self.painter = painter
        self._canvas: Canvas | None = None
        self._key: tuple[Hashable, ...] = ()
        self._made_of: list[object] = []  # what the canvas shows
        self._sensed: pygame.Surface | None = None
        self._sensed_of: tuple[object, ...] = ()
        self._legend = pygame.Surface((0, 0)), (0, 0)
        self._legend_of: tuple[object, ...] = ()

    def draw(
        self,
        surface: pygame.Surface,
        frame: Frame,
        camera: Camera,
        layers: Layers,
        plot: pygame.Rect | None = None,
        *,
        free: Sequence[pygame.Rect] = (),
        beneath: Sequence[Shape] = (),
        marks: Sequence[Shape] = (),
        hurried: bool = False,
    ) -> None:
        """Draw a frame on the part `plot` of a surface, all of it by default.

        free: the parts of the plot on which nothing else will be drawn, where legends go, the
        largest first; by default all of it. beneath, marks: shapes to draw below and above the
        bodies.
        hurried: whether the camera is moving. If the layers that stand still took long to draw, the
        last picture of them is then enlarged or shifted for a quarter of a second.
        """
        plot = surface.get_rect() if plot is None else plot
        before = surface.get_clip()
        surface.set_clip(plot)
        shot = _Shot(surface, frame, camera, layers, plot)
        canvas = self._canvas_for(shot, hurried)
        (self._spread if canvas.camera == camera else self._enlarge)(shot, canvas)
        self._paint_above(shot, beneath, marks)
        if layers.grid:
            bounds = grid_bounds(frame.scenario, camera, surface.get_size())
            numbers = labels(plot, camera, bounds, self.painter)
            self.painter.paint(surface, numbers.shapes, PIXELS, shaded=False)
        self._draw_legends(shot, free or [plot])
        surface.set_clip(before)

    def _draw_legends(self, shot: _Shot, free: Sequence[pygame.Rect]) -> None:
        """Draw legends beside the workspace if there is room, from a picture that is kept."""
        (surface, frame, camera, layers, _), painter = shot, self.painter
        beside = [strip for room in free for strip in self._around(shot, room)]
        of = (frame.scenario, layers.on, camera.scale, *map(tuple, (*beside, *free)), painter.ui,
              painter.theme)  # fmt: skip
        if of != self._legend_of:
            shown = [each for each in legends(frame.scenario) if getattr(layers, each.layer)]
            whole = pygame.Surface(surface.get_size(), pygame.SRCALPHA, 32)
            draw_legends(whole, painter, camera, free[0], shown, beside)
            place = whole.get_bounding_rect()
            self._legend_of, self._legend = of, (whole.subsurface(place).copy(), place.topleft)
        shot.surface.blit(*self._legend)

    def _around(self, shot: _Shot, room: pygame.Rect) -> list[pygame.Rect]:
        """Return the parts of a room beside the workspace and the numbers of its axes."""
        xmin, xmax, ymin, ymax = shot.frame.scenario.bounds
        corners = shot.camera.to_pixels([(xmin, ymax), (xmax, ymin)]).round().astype(int).tolist()
        (left, top), (right, bottom) = corners
        numbers = round(NUMBERS * self.painter.ui)
        left, right, bottom = left - numbers, right + numbers // 3, bottom + numbers // 2
        sides = (
            pygame.Rect(right, room.top, room.right - right, room.height),
            pygame.Rect(room.left, room.top, left - room.left, room.height),
            pygame.Rect(room.left, bottom, room.width, room.bottom - bottom),
            pygame.Rect(room.left, room.top, room.width, top - room.top),
        )
        return [side.clip(room) for side in sides if min(side.size) > 0]

    def _paint_above(self, shot: _Shot, beneath: Sequence[Shape], marks: Sequence[Shape]) -> None:
        """Draw the layers above the kept ones, with `beneath` and `marks` around the bodies."""
        surface, frame, camera, layers, _ = shot
        seen = {layer.name for layer in layers.seen(frame.scenario.animation)}
        for layer in LAYERS[_place("sensors") + 1 :]:
            if layer.name == FIRST_BODIES:
                self.painter.paint(surface, beneath, camera)
            if layer.name in seen and layer.shapes is not None:
                self.painter.paint(surface, layer.shapes(frame).shapes, camera)
            if layer.name == LAST_BODIES:
                self.painter.paint(surface, marks, camera)

    # -- the kept layers ----------------------------------------------------------------------

    def _canvas_for(self, shot: _Shot, hurried: bool) -> Canvas:
        """Return the canvas for a camera; an older one for a moment, if hurried."""
        surface, frame, camera, layers, plot = shot
        size = surface.get_size()
        scenario, standing_ones = frame.scenario, {layer.name for layer in standing()}
        seen = standing_ones & {layer.name for layer in layers.seen(scenario.animation)}
        of: list[object] = [scenario.surfaces, scenario.workspace, *scenario.addons]
        began = b""
        if layers.trails or "starts" in seen:
            of, began = [scenario], b"".join(poses.tobytes() for poses in starts(frame))
        looks = size, tuple(plot), self.painter.ui, self.painter.theme
        key = frozenset(seen), layers.trails, scenario.on_exit, scenario.bounds, began, looks
        canvas, made_of = self._canvas, self._made_of
        if key != self._key or len(of) != len(made_of) or not all(map(is_, of, made_of)):
            canvas = None
        self._key, self._made_of = key, of
        if canvas is not None:
            young = hurried and perf_counter() - canvas.made < MAX_AGE
            if canvas.camera == camera or (young and canvas.seconds > PATIENCE):
                return canvas
        self._canvas = Canvas(self.painter, frame, camera, layers, size, plot)
        return self._canvas

    def _spread(self, shot: _Shot, canvas: Canvas) -> None:
        """Draw the layers that stand still, the paths and the readings."""
        surface, frame, camera, layers, plot = shot
        picture = canvas.picture(frame)
        if layers.trails and canvas.wakes is None:  # dashed, or marks
            surface.blit(picture, plot, plot)
            shapes = trails(frame).shapes + (sensors(frame).shapes if layers.sensors else [])
            self.painter.paint(surface, shapes, camera)
            return
        if layers.sensors and frame.readings:
            picture = self._with_sensors(picture, frame, canvas)
        surface.blit(picture, plot, plot)
        if canvas.wakes is not None:
            canvas.wakes.finish(surface, frame)

    def _enlarge(self, shot: _Shot, canvas: Canvas) -> None:
        """Draw a canvas as another camera sees it, roughly, and the readings."""
        surface, frame, camera, layers, plot = shot
        last = canvas.picture(frame)
        factor = camera.scale / canvas.camera.scale
        corner = camera.x - factor * canvas.camera.x, camera.y - factor * canvas.camera.y
        # The whole pixels of the last picture that are visible now.
        seen = pygame.Rect(0, 0, ceil(plot.width / factor) + 2, ceil(plot.height / factor) + 2)
        seen.left = floor((plot.left - corner[0]) / factor)
        seen.top = floor((plot.top - corner[1]) / factor)
        seen = seen.clip(canvas.area)
        surface.fill(self.painter.theme.page, plot)
        if seen.width > 0 and seen.height > 0:
            size = round(seen.width * factor), round(seen.height * factor)
            place = corner[0] + factor * seen.left, corner[1] + factor * seen.top
            surface.blit(pygame.transform.scale(last.subsurface(seen), size), place)
        if layers.sensors:
            self.painter.paint(surface, sensors(frame).shapes, camera)

    def _with_sensors(
        self, picture: pygame.Surface, frame: Frame, canvas: Canvas
    ) -> pygame.Surface:
        """Return a copy of a picture with the readings on it, kept until they are others."""
        stays = all(sensor.stays for robot in frame.scenario.robots for sensor in robot.sensors)
        sensed = frame.pose if frame.sensed is None else frame.sensed
        read = [reading for readings in frame.readings.values() for _, reading in readings]
        made_of = picture, frame.path, sensed, None if stays else frame.pose, *read
        old, self._sensed_of = self._sensed_of, made_of
        if self._sensed is None or self._sensed.get_size() != picture.get_size():
            self._sensed = picture.copy()
        elif len(made_of) == len(old) and all(map(is_, made_of, old)):
            return self._sensed
        self._sensed.set_clip(canvas.area)
        self._sensed.blit(picture, canvas.area, canvas.area)
        self.painter.paint(self._sensed, sensors(frame).shapes, canvas.camera)
        return self._sensed


def _place(name: str) -> int:
    """Return the index of a layer in the table."""
    return next(k for k, layer in enumerate(LAYERS) if layer.name == name)
