"""Pictures without a window or display, drawn by the same code as the window."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import pygame

from mars2d.core.errors import InputError
from mars2d.core.files import atomic_write
from mars2d.output.layers.table import Layers
from mars2d.output.raster.bars import Banner, Status, draw_footer, draw_header
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.layout import FOOTER, Layout, fitted
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.stage import Stage
from mars2d.output.raster.theme import PRINTED
from mars2d.record.frame import Frame


class Artist:
    """Paints one frame after another, and keeps the parts that do not change.

    size: pixels. camera: by default one that shows the whole workspace. status: the text beside the
    time, such as "10x". footer: whether to leave room for the message at the end. switches: of
    layers by name, such as grid=False; None takes the setting of the scenario's animation, and
    sensors are off. Impulses go with forces.
    """

    def __init__(
        self,
        size: tuple[int, int] = (1280, 720),
        *,
        camera: Camera | None = None,
        footer: bool = True,
        status: str = "",
        **switches: bool | None,
    ) -> None:
        """Check the size; nothing is drawn yet."""
        if not all(isinstance(side, int) and 16 <= side <= 16_384 for side in size):
            raise InputError(f"size = {size!r}: expected (width, height) in pixels, 16 to 16384")
        self.size = size
        self.layout = Layout.of(size, FOOTER if footer else 0.0)
        self.painter = Painter(theme=PRINTED)
        self.painter.ui = self.layout.ui
        self._stage = Stage(self.painter)
        self._camera = camera
        asked = {"sensors": False, "impulses": switches.get("forces")} | switches
        self._switches = {name: on for name, on in asked.items() if on is not None}
        self._status = Status(status) if status else None

    def paint(self, frame: Frame, surface: pygame.Surface | None = None) -> pygame.Surface:
        """Return the whole picture of a frame, painted on `surface` if given."""
        if surface is None:
            surface = pygame.Surface(self.size, 0, 32)
        layers = Layers.of(frame.scenario.animation, **self._switches)
        camera = self._camera or fitted(frame.scenario.bounds, self.size, self.layout)
        self._stage.draw(surface, frame, camera, layers, self.layout.plot)
        draw_header(surface, self.layout, self.painter, frame, self._status)
        banner = Banner(frame.over_message) if frame.over_message else None
        draw_footer(surface, self.layout, self.painter, banner, summary(frame))
        return surface


def arena_of(
    window: pygame.Surface, layout: Layout, painter: Painter, frame: Frame, banner: Banner | None
) -> pygame.Surface:
    """Return the picture that a window shows, without the window's own bars and buttons."""
    plot, top = layout.plot, layout.header.height
    bare = replace(
        layout,
        header=pygame.Rect(0, 0, plot.width, top),
        plot=pygame.Rect(0, top, plot.width, plot.height),
        footer=pygame.Rect(0, top + plot.height, plot.width, layout.footer.height),
    )
    picture = pygame.Surface(bare.size, 0, 32)
    draw_header(picture, bare, painter, frame, None)
    picture.blit(window, bare.plot, plot)
    draw_footer(picture, bare, painter, banner, summary(frame))
    return picture


def summary(frame: Frame) -> str:
    """Return the line below a picture: the number of robots and the sampling time."""
    scenario = frame.scenario
    count = len(scenario.robots)
    team = "1 robot" if count == 1 else f"{count} robots"
    return f"{team}  ·  sampling time {scenario.sampling_time:g} s"


def paint_frame(
    frame: Frame, size: tuple[int, int] = (1280, 720), **options: Any
) -> pygame.Surface:
    """Return the picture of one frame, with title, time, step and message; options: of `Artist`."""
    return Artist(size, **options).paint(frame)


def save_png(surface: pygame.Surface, path: str | os.PathLike[str]) -> None:
    """Write a picture as PNG. Raises InputError when it can't be written there."""
    target = Path(path)
    if target.suffix.lower() != ".png":
        raise InputError(f"{target}: expected a name that ends in .png")
    with atomic_write(target) as file:
        pygame.image.save(surface, file, "x.png")
