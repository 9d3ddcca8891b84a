"""A comparison as a film: three panels side by side, and below them the growing drift."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.core.errors import counted
from mars2d.core.scene import Scene
from mars2d.output.figures.comparison import COLORS, MEANINGS, MODES, Comparison, plot_drift
from mars2d.output.films.film import save_pictures
from mars2d.output.films.footage import Footage
from mars2d.output.layers.table import Layers
from mars2d.output.raster.bars import Status, draw_header
from mars2d.output.raster.camera import PIXELS, Camera
from mars2d.output.raster.grid import Bounds
from mars2d.output.raster.layout import Layout
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.stage import Stage
from mars2d.output.raster.theme import PRINTED
from mars2d.record.contact import met
from mars2d.record.frame import Frame

Float = NDArray[np.float64]

TITLE_HEIGHT = 74.0
"""The height of the title above a panel, points."""

MIN_PLOT_SHARE = 0.3
"""The least share of the picture's height for the drift."""


Reel = tuple[Footage, Frame]
"""The frames of a run: its footage, and its last frame."""


def save_triptych(
    comparison: Comparison,
    reels: Mapping[str, Reel],
    path: str | Path,
    *,
    fps: float = 25,
    size: tuple[int, int] = (1280, 720),
    progress: Callable[[int], None] | None = None,
) -> None:
    """Write the film of a comparison as .gif or .mp4; a run that ended earlier stands still.

    reels: the frames of each run, by its physics, all of the same speed and `fps`. size: pixels,
    even for .mp4. progress: called with the number of frames written so far. Raises InputError
    where the film can't be written, MissingExtraError for .mp4 without PyAV.
    """
    save_pictures(_pictures(comparison, reels, size, progress), path, fps)


def _pictures(
    comparison: Comparison,
    reels: Mapping[str, Reel],
    size: tuple[int, int],
    progress: Callable[[int], None] | None,
) -> Iterator[pygame.Surface]:
    """Yield each instant's picture, always on the same surface."""
    status = f"{reels['contact'][0].speed:.3g}x"
    triptych = Triptych(comparison, size, status)
    surface = pygame.Surface(size, 0, 32)
    shown: tuple[Frame | None, ...] = (None,) * len(MODES)
    films = [footage.frames(last) for footage, last in (reels[mode] for mode in MODES)]
    for count, frames in enumerate(zip_longest(*films), 1):
        shown = tuple(new or old for new, old in zip(frames, shown, strict=True))
        yield triptych.paint([frame for frame in shown if frame is not None], surface)
        if progress is not None:
            progress(count)


class Triptych:
    """Paints the three runs, one instant after another, and keeps the parts that do not change.

    size: pixels. status: the text beside the time, for example "10x".
    """

    def __init__(
        self, comparison: Comparison, size: tuple[int, int] = (1280, 720), status: str = ""
    ) -> None:
        """Lay out the picture and draw the curves of the drift; no frame is painted yet."""
        self.comparison = comparison
        self.size = size
        self._layout = Layout.of(size, 0.0)
        self._painter = Painter(theme=PRINTED)
        self._painter.ui = self._layout.ui
        self._status = Status(status) if status else None
        ui, width = self._layout.ui, size[0]
        top = self._layout.header.bottom + round(TITLE_HEIGHT * ui)
        high = self._plot_height(size[1] - top)
        edges = [round(k * width / 3) for k in range(4)]
        self._arenas = [Arena(mode, self._painter) for mode in MODES]
        for arena, left, right in zip(self._arenas, edges, edges[1:], strict=False):
            arena.plot = pygame.Rect(left, top, right - left, high)
        view = comparison.view
        bounds = (view.xmin, view.xmax, view.ymin, view.ymax)
        self._cameras = [arena.camera(bounds, size) for arena in self._arenas]
        self._collisions = [
            np.sort(record.contacts["time"][met(record.contacts)])
            for record in comparison.records.values()
        ]
        self._plot = _Plot(comparison, pygame.Rect(0, top + high, width, size[1] - top - high), ui)

    def _plot_height(self, room: int) -> int:
        """Return the panels' height: by the view's proportions, with room left for the drift."""
        ui, view = self._layout.ui, self.comparison.view
        across = self.size[0] / 3 - 64 * ui
        wanted = across * view.height / view.width + 36 * ui
        return round(min(max(wanted, 0.15 * room), room - MIN_PLOT_SHARE * self.size[1]))

    def paint(self, frames: list[Frame], surface: pygame.Surface | None = None) -> pygame.Surface:
        """Return the picture of an instant, given the frame of each run then."""
        if surface is None:
            surface = pygame.Surface(self.size, 0, 32)
        surface.fill(self._painter.theme.page)
        for arena, frame, camera, collisions in zip(
            self._arenas, frames, self._cameras, self._collisions, strict=True
        ):
            layers = Layers.of(frame.scenario.animation)
            count = int(np.searchsorted(collisions, frame.time, side="right"))
            arena.paint(surface, frame, camera, layers, count)
        latest = max(frames, key=lambda frame: frame.time)
        self._plot.paint(surface, latest.time, self._painter)
        draw_header(surface, self._layout, self._painter, latest, self._status)
        return surface


class Arena:
    """One run of a comparison: its title, and its picture below that on the rectangle `plot`.

    mode: its physics.
    """

    def __init__(self, mode: str, painter: Painter, memory: int = 0) -> None:
        """Start with nothing drawn; memory: as for `Stage`."""
        self.mode, self.plot = mode, pygame.Rect(0, 0, 0, 0)
        self._painter = painter
        self._stage = Stage(painter, memory)

    def camera(self, bounds: Bounds, size: tuple[int, int]) -> Camera:
        """Return the camera that shows bounds (xmin, xmax, ymin, ymax) [m] of the plane."""
        ui, plot = self._painter.ui, self.plot
        margins = (
            plot.left + 44 * ui, plot.top + 6 * ui,
            size[0] - plot.right + 20 * ui, size[1] - plot.bottom + 30 * ui,
        )  # fmt: skip
        return Camera.fit(bounds, size, margins)

    def paint(
        self,
        surface: pygame.Surface,
        frame: Frame,
        camera: Camera,
        layers: Layers,
        collisions: int,
        *,
        hurried: bool = False,
    ) -> None:
        """Paint a frame; collisions: how many there were so far. hurried: as for `Stage.draw`."""
        self._stage.draw(surface, frame, camera, layers, self.plot, hurried=hurried)
        ui, fonts, theme = self._painter.ui, self._painter.fonts, self._painter.theme
        title = fonts.render(self.mode, 21 * ui, theme.shade(COLORS[self.mode]), bold=True)
        done = fonts.render(counted(collisions, "collision"), 17 * ui, theme.ink)
        left, right = self.plot.left + round(44 * ui), self.plot.right - round(20 * ui)
        level = self.plot.top - round(TITLE_HEIGHT * ui)
        surface.blit(title, title.get_rect(midleft=(left, level + round(20 * ui))))
        if right - left >= title.get_width() + done.get_width() + 10 * ui:
            surface.blit(done, done.get_rect(midright=(right, level + round(21 * ui))))
        text, color = MEANINGS[self.mode], theme.muted
        if frame.over_message:
            text, color = frame.over_message, theme.text
        for k, part in enumerate(fonts.wrap(text, 13.5 * ui, right - left, 2)):
            line = fonts.render(part, 13.5 * ui, color)
            surface.blit(line, line.get_rect(midleft=(left, level + round((43 + 17 * k) * ui))))


class _Plot:
    """The drift on the rectangle `place`: the curves are drawn once, and shown up to the time."""

    def __init__(self, comparison: Comparison, place: pygame.Rect, ui: float) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self.place = place
        dpi = 110 * ui
        figure = Figure(figsize=(place.width / dpi, place.height / dpi), dpi=dpi, facecolor="white")
        canvas = FigureCanvasAgg(figure)
        width, height = place.size
        sides = 80 * ui / width, 1 - 20 * ui / width
        ends = 48 * ui / height, 1 - 38 * ui / height
        ax = figure.add_axes((sides[0], ends[0], sides[1] - sides[0], ends[1] - ends[0]))
        curves = plot_drift(comparison, ax)
        self._whole = _drawn(canvas)
        for line in ax.lines:
            line.set_visible(False)
        self._empty = _drawn(canvas)
        self._end = comparison.end
        self._curves = [self._in_pixels(ax.transData.transform(curve)) for curve in curves]
        self._times = [curve[:, 0] for curve in curves]
        self._span = [float(x) for x in ax.transAxes.transform([(0, 0), (1, 1)])[:, 0]]
        self._top = place.bottom - ax.bbox.y1
        self._bottom = place.bottom - ax.bbox.y0
        colors = [color for mode, color in COLORS.items() if mode in comparison.drifts]
        self._colors = [color for color in colors for _ in range(2)]

    def _in_pixels(self, points: Float) -> Float:
        """Return points (T, 2), which count up from the figure's corner, on the surface."""
        return np.column_stack([self.place.left + points[:, 0], self.place.bottom - points[:, 1]])

    def paint(self, surface: pygame.Surface, time: float, painter: Painter) -> None:
        surface.blit(self._empty, self.place)
        left, right = self._span
        now = left + (right - left) * min(time / self._end, 1.0) if self._end > 0 else right
        part = pygame.Rect(0, 0, round(now) + (3 if time >= self._end else 0), self.place.height)
        surface.blit(self._whole, self.place, part)
        scene = Scene()
        x = self.place.left + now
        scene.line([(x, -self._top), (x, -self._bottom)], stroke="#9aa5b1", width=1.0)
        # The mean first, so that the largest drift lies on top of it.
        for points, times, color in reversed(
            list(zip(self._curves, self._times, self._colors, strict=True))
        ):
            at = min(time, float(times[-1]))
            px, py = (float(np.interp(at, times, points[:, k])) for k in (0, 1))
            if np.isfinite(py):
                scene.circle((px, -py), 0.0, fill=color, stroke="#ffffff", pixels=5.0)
        painter.paint(surface, scene.shapes, PIXELS)


def _drawn(canvas: Any) -> pygame.Surface:
    """Return the picture on a canvas of matplotlib as a surface."""
    canvas.draw()
    width, height = canvas.get_width_height()
    return pygame.image.frombuffer(bytes(canvas.buffer_rgba()), (width, height), "RGBA")
