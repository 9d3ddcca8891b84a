"""A comparison as a film: three runs side by side, and how often their bodies have met."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import zip_longest

import numpy as np
import pygame

from mars2d.core.errors import counted
from mars2d.output.figures.comparison import COLORS, MEANINGS, Comparison
from mars2d.output.films.footage import Footage
from mars2d.output.layers.table import Layers
from mars2d.output.raster.bars import Status, draw_header
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.grid import Bounds
from mars2d.output.raster.layout import Layout
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.stage import Stage
from mars2d.output.raster.theme import PRINTED
from mars2d.record.contact import met
from mars2d.record.frame import Frame

TITLE_HEIGHT = 74.0
"""The height of the title above a panel, points."""

Reel = tuple[Footage, Frame]
"""The frames of a run: its footage, and its last frame."""


def triptych(
    comparison: Comparison, reels: Mapping[str, Reel], size: tuple[int, int] = (1280, 720)
) -> Iterator[pygame.Surface]:
    """Yield the pictures of a film, all on one surface; a run that ended earlier stands still.

    reels: the frames of each run, by its physics, all of the same speed and frames per second.
    size: pixels.
    """
    layout, painter = Layout.of(size, 0.0), Painter(theme=PRINTED)
    painter.ui = layout.ui
    surface = pygame.Surface(size, 0, 32)
    status = Status(f"{next(iter(reels.values()))[0].speed:.3g}x")
    top = layout.header.bottom + round(TITLE_HEIGHT * layout.ui)
    view = comparison.view
    arenas, films = [], []
    for k, (mode, (footage, last)) in enumerate(reels.items()):
        arena = Arena(mode, painter)
        left, right = (round(edge * size[0] / len(reels)) for edge in (k, k + 1))
        arena.plot = pygame.Rect(left, top, right - left, size[1] - top)
        camera = arena.camera((view.xmin, view.xmax, view.ymin, view.ymax), size)
        contacts = comparison.records[mode].contacts
        arenas.append((arena, camera, np.sort(contacts["time"][met(contacts)])))
        films.append(footage.frames(last))
    shown: list[Frame] = []
    for frames in zip_longest(*films):
        shown = [new or old for new, old in zip_longest(frames, shown)]
        surface.fill(painter.theme.page)
        for (arena, camera, collisions), frame in zip(arenas, shown, strict=True):
            layers = Layers.of(frame.scenario.animation)
            count = int(np.searchsorted(collisions, frame.time, side="right"))
            arena.paint(surface, frame, camera, layers, count)
        latest = max(shown, key=lambda frame: frame.time)
        draw_header(surface, layout, painter, latest, status)
        yield surface


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
