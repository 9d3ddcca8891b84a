"""Both themes can be read, and on dark paper scenes keep what tells their colours apart."""

from itertools import combinations

import numpy as np
import pygame
import pytest

from mars2d.core.scene import PALETTE, Scene, rgb
from mars2d.output.layers.table import Layers
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.stage import Stage
from mars2d.output.raster.theme import DARK, LIGHT, mixed
from tests.cases import each_case
from tests.colors import contrast
from tests.window.circling import Circling
from tests.window.written import THEMES, pixels

READABLE = 4.5
SEEN = 3.0
"""The contrasts that WCAG 2 asks of text, and of graphics."""
TONES = ("running", "waiting", "past", "hand", "error")


@each_case(
    "color, ground, expected",
    [("#000000", "#ffffff", 21.0), ("#777777", "#ffffff", 4.48), ("#0000ff", "#000000", 2.44)],
)
def test_contrast_is_that_of_wcag(color, ground, expected):
    assert contrast(color, ground) == pytest.approx(expected, abs=0.01)
    assert contrast(ground, color) == contrast(color, ground)


@THEMES
def test_words_can_be_read_and_controls_be_seen(theme):
    pairs = [
        (getattr(theme, ink), getattr(theme, ground))
        for ink in ("ink", "text", "muted") for ground in ("page", "paper", "bar", "plate")
    ]  # fmt: skip
    for tone in (getattr(theme, kind) for kind in TONES):
        pairs += [(tone.ink, ground) for ground in (tone.pale, theme.bar, theme.plate)]
    pairs.append((theme.text, theme.key))
    for ground in (theme.over, theme.failed):
        darker = mixed(theme.banner_plate[:7], ground, int(theme.banner_plate[7:], 16) / 255)
        marked = mixed("#ffffff", darker, 0x30 / 255)
        pairs += [(theme.on_banner, place) for place in (ground, darker, marked)]
        pairs += [(theme.on_banner_muted, place) for place in (ground, darker)]
    assert [pair for pair in pairs if contrast(*pair) < READABLE] == []
    seen = [(theme.selected, theme.bar), (theme.selected, theme.track), (theme.effort, theme.plate)]
    assert [pair for pair in seen if contrast(*pair) < SEEN] == []


# -- on dark paper --------------------------------------------------------------------------------


def test_the_colours_of_robots_are_seen_and_told_apart_as_well():
    dark = [DARK.shade(color) for color in PALETTE]
    worst = min(contrast(color, LIGHT.paper) for color in PALETTE)
    assert all(contrast(color, DARK.paper) > worst for color in dark)
    assert min(np.abs(np.subtract(rgb(a), rgb(b))).max() for a, b in combinations(dark, 2)) > 0.15
    assert DARK.shade("#ffffff") == DARK.paper
    assert DARK.shade("#00000080") == "#ffffff80"


# -- painted --------------------------------------------------------------------------------------


def painted(scene, theme, *, shaded=True):
    surface = pygame.Surface((100, 100), 0, 32)
    surface.fill("#808080")
    Painter(theme=theme).paint(surface, scene.shapes, Camera(10.0, 50.0, 50.0), shaded=shaded)
    return pixels(surface)


def all_shapes(color):
    """Return one scene a kind of shape, with something of the colour in the middle."""
    box = [(-2, -2), (2, -2), (2, 2), (-2, 2)]
    image = np.full((4, 4, 3), list(bytes.fromhex(color[1:])), dtype=np.uint8)
    scenes = {name: Scene() for name in ("disc", "large", "polygon", "line", "arrow", "image")}
    scenes["disc"].circle((0, 0), 2.0, fill=color, stroke=color)
    scenes["large"].circle((0, 0), 30.0, fill=color, stroke=color)
    scenes["polygon"].polygon(box, fill=color, stroke=color)
    scenes["line"].line([(-2, 0), (2, 0)], stroke=color, width=9.0)
    scenes["arrow"].arrow((-3, 0), (3, 0), fill=color, width=9.0)
    scenes["image"].image(image, (-2, 2, -2, 2))
    return scenes


@each_case("kind", all_shapes("#000000"))
def test_each_kind_of_shape_follows_the_theme(kind):
    scene = all_shapes("#0072b2")[kind]
    assert painted(scene, LIGHT)[50, 50].tolist() == [0x00, 0x72, 0xB2]
    wanted = list(bytes.fromhex(DARK.shade("#0072b2")[1:]))
    assert np.abs(painted(scene, DARK)[50, 50] - wanted).max() <= (12 if kind == "image" else 1)


def test_a_stage_that_has_changed_its_theme_draws_what_a_new_one_draws():
    source = Circling()
    for _ in range(30):
        source.advance()
    frame, camera = source.frame, Camera(60.0, 320.0, 240.0)

    def drawn(stage):
        surface = pygame.Surface((640, 480), 0, 32)
        stage.draw(surface, frame, camera, Layers())
        return pixels(surface)

    stage = Stage(Painter())
    light = drawn(stage)
    stage.painter.theme = DARK
    dark = drawn(stage)
    assert np.array_equal(dark, drawn(Stage(Painter(theme=DARK))))
    assert dark.mean() < 60 < 200 < light.mean()
    stage.painter.theme = LIGHT
    assert np.array_equal(drawn(stage), light)
