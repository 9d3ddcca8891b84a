"""Draw the small pictures of the examples that the home shows, examples/thumbnails.

python docs/make_thumbnails.py [NAME ...]

Without a name, it draws the picture of the home itself, too, docs/pictures/home.png.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pygame
from PIL import Image

import mars2d
from mars2d.output.layers.table import Layers
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.stage import Stage
from mars2d.output.raster.theme import theme_of
from mars2d.scenario.examples import examples
from mars2d.window.home import Home
from mars2d.window.screen.memory import Memory
from mars2d.world.record import Record

FOLDER = Path(__file__).parents[1] / "examples" / "thumbnails"
PICTURE = Path(__file__).parent / "pictures" / "home.png"
SIZE = (640, 400)
"""The size at which they are drawn; they are kept at half of it."""
MARGIN = 12
"""The margin round the workspace, pixels."""
MOMENT = 0.35
"""The share of a run after which it is shown."""
COLORS = 64


def draw(record: Record, *, dark: bool) -> Image.Image:
    """Return the picture of a run, in few colours."""
    frame = record.frame(round(MOMENT * (len(record) - 1)))
    painter, surface = Painter(theme=theme_of(dark=dark)), pygame.Surface(SIZE, 0, 32)
    camera = Camera.fit(frame.scenario.bounds, SIZE, (MARGIN,) * 4)
    layers = Layers.of(frame.scenario.animation, names=False, grid=False)
    painter.ui = 1.5
    beyond = surface.get_rect().inflate(800, 800)  # so that legends lie outside
    Stage(painter).draw(surface, frame, camera, layers, beyond)
    picture = Image.frombytes("RGB", SIZE, pygame.image.tobytes(surface, "RGB"))
    half = picture.resize((SIZE[0] // 2, SIZE[1] // 2), Image.Resampling.LANCZOS)
    return half.quantize(COLORS)


def draw_home() -> None:
    """Draw the home, as somebody sees it for the first time."""
    os.environ["MARS2D_MEMORY"] = ""
    home, surface = Home(Memory()), pygame.Surface((1280, 800), 0, 32)
    home.draw(surface)
    home.page.move(right=2, down=1)
    home.draw(surface)
    picture = Image.frombytes("RGB", surface.get_size(), pygame.image.tobytes(surface, "RGB"))
    picture.quantize(200).save(PICTURE, optimize=True)


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    if not sys.argv[1:]:
        draw_home()
    for name in sys.argv[1:] or examples():
        run = mars2d.run(name)
        for looks in ("light", "dark"):
            path = FOLDER / f"{name}_{looks}.png"
            draw(run, dark=looks == "dark").save(path, optimize=True)
            print(path.name, path.stat().st_size)
