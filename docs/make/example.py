"""Make what belongs to an example: its pictures on the home, its film, and its golden path.

    python docs/make/example.py [NAME ...]

An example has a film, docs/pictures/NAME.gif, if a page of docs/ shows it. The golden path is what
its runs are compared with, tests/house/golden. Without a name, all are made, and the picture of the
home itself.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pygame
from PIL import Image

import mars2d
from mars2d.output.films.film import film_record
from mars2d.output.layers.table import Layers
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.stage import Stage
from mars2d.output.raster.theme import theme_of
from mars2d.scenario.examples import examples, thumbnail_of
from mars2d.window.home import Home
from mars2d.window.screen.memory import Memory
from mars2d.world.record import Record

DOCS = Path(__file__).parents[1]
sys.path.insert(0, str(DOCS.parent))
from tests.house.goldens import golden  # noqa: E402 - of the checkout

SIZE = (640, 400)
"""The size at which the pictures of the home are drawn; they are kept at half of it."""
MARGIN = 12
"""The margin round the workspace, pixels."""
MOMENT = 0.35
"""The share of a run after which it is shown."""
COLORS = 64

FILM_SIZE, FPS = (480, 400), 12
SECONDS = 8
"""How long a film is."""
LIGHTER = {"circular_motion": ((400, 340), 9)}
"""Size and frames a second of films in which much moves; what sensors read is left out, too."""


def thumbnail(record: Record, *, dark: bool) -> Image.Image:
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


def film(record: Record, path: Path) -> None:
    """Write the film of a run, all of it in `SECONDS`."""
    speed = float(record.time[-1]) / SECONDS
    size, fps = LIGHTER.get(path.stem, (FILM_SIZE, FPS))
    film_record(record, path, speed=speed, size=size, fps=fps, sensors=path.stem not in LIGHTER)


def draw_home() -> None:
    """Draw the home, as somebody sees it for the first time."""
    os.environ["MARS2D_MEMORY"] = ""
    home, surface = Home(Memory()), pygame.Surface((1280, 800), 0, 32)
    home.draw(surface)
    home.page.move(right=2, down=1)
    home.draw(surface)
    picture = Image.frombytes("RGB", surface.get_size(), pygame.image.tobytes(surface, "RGB"))
    picture.quantize(200).save(DOCS / "pictures" / "home.png", optimize=True)


def make(name: str) -> None:
    """Run an example, and make what belongs to it."""
    record = mars2d.run(name)
    for looks in ("light", "dark"):
        path = thumbnail_of(name, looks)
        path.parent.mkdir(exist_ok=True)
        thumbnail(record, dark=looks == "dark").save(path, optimize=True)
    if any(f"/{name}.gif)" in page.read_text("utf-8") for page in DOCS.rglob("*.md")):
        film(record, DOCS / "pictures" / f"{name}.gif")
    made = golden(name)
    made.write(name)
    print(f"{name}: golden to row {made.rows[-1]}, within {made.tolerances[-1]:.1e}", flush=True)


if __name__ == "__main__":
    for each in sys.argv[1:] or examples():
        make(each)
    if not sys.argv[1:]:
        draw_home()
