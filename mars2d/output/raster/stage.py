"""The picture between the bars: the layers of a frame over those that are kept."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from itertools import takewhile
from math import ceil, floor
from time import perf_counter

import pygame

from mars2d.core.scene import Shape, Text
from mars2d.output.layers.bodies import starts
from mars2d.output.layers.legend import legends
from mars2d.output.layers.table import FIRST_BODIES, LAST_BODIES, LAYERS, Layers, standing
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


class Stage:
    """Draws frames of one experiment after another; used by the window, pictures and films alike.

    The layers that stand still are drawn once for each camera. Solid paths grow on a copy of that
    picture. All other layers are drawn for each frame.
    """

    def __init__(self, painter: Painter) -> None:
        """Start with nothing drawn."""
        self.painter = painter
        self._canvas: Canvas | None = None
        self._scenario: Scenario | None = None
        self._key: tuple[Hashable, ...] = ()  # of what the canvas shows of the scenario
        self._corner = 0  # where legends are

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
        bodies. hurried: whether the camera is moving. If the layers that stand still took long to
        draw, the last picture of them is then enlarged or shifted for a quarter of a second.
        """
        plot = surface.get_rect() if plot is None else plot
        before, paint = surface.get_clip(), self.painter.paint
        surface.set_clip(plot)
        canvas = self._canvas_for(surface.get_size(), frame, camera, layers, plot, hurried=hurried)
        if canvas.camera == camera:
            surface.blit(canvas.picture(frame), plot, plot)
        else:
            self._enlarge(surface, canvas.picture(frame), canvas, camera, plot)
        if canvas.wakes is not None and canvas.camera == camera:
            canvas.wakes.finish(surface, frame)
        seen = {layer.name for layer in layers.seen(frame.scenario.animation)}
        seen -= {layer.name for layer in standing()} | ({"trails"} if canvas.wakes else set())
        shapes: list[Shape] = []
        words = [mark for mark in marks if isinstance(mark, Text)]
        others = [mark for mark in marks if not isinstance(mark, Text)]
        for layer in LAYERS:
            shapes += beneath if layer.name == FIRST_BODIES else ()
            if layer.name in seen and layer.shapes is not None:
                shapes += layer.shapes(frame).shapes
            shapes += others if layer.name == LAST_BODIES else ()
        paint(surface, [*shapes, *words], camera)  # no other label stands before those words
        if layers.grid:
            bounds = grid_bounds(frame.scenario, camera, surface.get_size())
            numbers = labels(plot, camera, bounds, self.painter)
            paint(surface, numbers.shapes, PIXELS, shaded=False)
        shown = [each for each in legends(frame.scenario) if getattr(layers, each.layer)]
        rooms = free or [plot]
        beside = [strip for room in rooms for strip in self._around(frame.scenario, camera, room)]
        middles = camera.to_pixels(frame.all_poses[:2].T).tolist()
        self._corner = draw_legends(
            surface, self.painter, camera, rooms[0], shown, beside, middles, self._corner
        )
        surface.set_clip(before)

    def _around(self, scenario: Scenario, camera: Camera, room: pygame.Rect) -> list[pygame.Rect]:
        """Return the parts of a room beside the workspace and the numbers of its axes."""
        xmin, xmax, ymin, ymax = scenario.bounds
        corners = camera.to_pixels([(xmin, ymax), (xmax, ymin)]).round().astype(int).tolist()
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

    def _canvas_for(
        self, size: tuple[int, int], frame: Frame, camera: Camera, layers: Layers,
        plot: pygame.Rect, *, hurried: bool,
    ) -> Canvas:  # fmt: skip
        """Return the canvas for a camera; an older one for a moment, if hurried."""
        began = b"".join(poses.tobytes() for poses in starts(frame))
        key = layers.on, began, size, tuple(plot), self.painter.ui, self.painter.theme
        canvas = self._canvas
        if canvas is not None and frame.scenario is self._scenario and key == self._key:
            young = hurried and perf_counter() - canvas.made < MAX_AGE
            if canvas.camera == camera or (young and canvas.seconds > PATIENCE):
                return canvas
        self._scenario, self._key = frame.scenario, key
        self._canvas = Canvas(self.painter, frame, camera, layers, size, plot)
        return self._canvas

    def _enlarge(
        self, surface: pygame.Surface, last: pygame.Surface, canvas: Canvas, camera: Camera,
        plot: pygame.Rect,
    ) -> None:  # fmt: skip
        """Draw the picture of a canvas as another camera sees it, roughly."""
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
