"""Both themes can be read, and on dark paper scenes keep what tells their colours apart."""

from dataclasses import fields, replace
from itertools import combinations

import numpy as np
import pygame
import pytest

from mars2d.bodies.colors import MATERIAL_COLORS, OBSTACLE
from mars2d.core.scene import NAMED, PALETTE, THEORY, Scene
from mars2d.output.layers.bodies import INK, prop_edge
from mars2d.output.layers.table import Layers
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.stage import Stage
from mars2d.output.raster.theme import (
    DARK,
    LIGHT,
    PRINTED,
    Tone,
    _lab,
    _numbers,
    contrast,
    luminance,
    mixed,
    on_dark,
)
from tests.cases import each_case
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
@each_case("ink", ["ink", "text", "muted"])
@each_case("ground", ["page", "paper", "bar", "plate"])
def test_words_can_be_read(theme, ink, ground):
    assert contrast(getattr(theme, ink), getattr(theme, ground)) >= READABLE


@THEMES
@each_case("kind", TONES)
def test_what_the_clock_does_can_be_read(theme, kind):
    tone = getattr(theme, kind)
    for ground in (tone.pale, theme.bar, theme.plate):
        assert contrast(tone.ink, ground) >= READABLE


@THEMES
def test_keys_banners_and_their_code_can_be_read(theme):
    assert contrast(theme.text, theme.key) >= READABLE
    for ground in (theme.over, theme.failed):
        darker = mixed(theme.banner_plate[:7], ground, int(theme.banner_plate[7:], 16) / 255)
        for place in (ground, darker, mixed("#ffffff", darker, 0x30 / 255)):
            assert contrast(theme.on_banner, place) >= READABLE
        for place in (ground, darker):
            assert contrast(theme.on_banner_muted, place) >= READABLE


@THEMES
def test_the_time_bar_and_the_slider_can_be_seen(theme):
    assert contrast(theme.selected, theme.bar) >= SEEN
    assert contrast(theme.selected, theme.track) >= SEEN
    assert contrast(theme.effort, theme.plate) >= SEEN


@THEMES
def test_each_colour_of_a_theme_is_one(theme):
    for item in fields(theme):
        value = getattr(theme, item.name)
        for color in value if isinstance(value, Tone) else [value]:
            if color is not theme.dark:
                assert len(on_dark(color, DARK.paper)) == 7


def test_on_white_paper_scenes_stay_as_they_are():
    for color in (*PALETTE, "#ffffff80", "#123456"):
        assert LIGHT.shade(color) == PRINTED.shade(color) == color
    image = np.arange(48, dtype=np.uint8).reshape(4, 4, 3)
    assert LIGHT.shade_pixels(image) is image


def test_pictures_are_the_light_theme_with_paler_small_print():
    assert replace(PRINTED, muted=LIGHT.muted) == LIGHT


# -- on dark paper --------------------------------------------------------------------------------


def test_white_becomes_the_paper_and_black_nearly_white():
    assert DARK.shade("#ffffff") == DARK.paper
    assert contrast(DARK.shade("#000000"), DARK.paper) > 12


def test_opacity_is_kept():
    assert DARK.shade("#0072b280") == DARK.shade("#0072b2") + "80"
    assert DARK.shade("#ffffffe6") == DARK.paper + "e6"


@each_case("color", [*PALETTE, THEORY, INK, "#a3003c", "#c92a2a", "#333333"])
def test_words_of_a_scene_can_be_read(color):
    assert contrast(DARK.shade(color), DARK.paper) >= READABLE


@each_case("name", [name for name in NAMED if NAMED[name] != "#ffffff"])
def test_each_colour_with_a_name_is_seen(name):
    assert contrast(DARK.shade(NAMED[name]), DARK.paper) >= SEEN


@each_case("material", MATERIAL_COLORS)
def test_the_edge_of_a_prop_is_seen(material):
    color = MATERIAL_COLORS[material]
    assert contrast(DARK.shade(prop_edge(color)), DARK.paper) >= SEEN


def test_greys_are_turned_over_in_order():
    greys = [DARK.shade(f"#{k:02x}{k:02x}{k:02x}") for k in range(0, 256, 15)]
    bright = [luminance(grey) for grey in greys]
    assert bright == sorted(bright, reverse=True)
    assert contrast(DARK.shade(OBSTACLE), DARK.shade(INK)) > 1.7


def distance(one, other):
    """Return how different two colours look, in OKLab."""
    return float(np.linalg.norm(np.subtract(*(_lab(_numbers(c)) for c in (one, other)))))


def test_the_colours_of_robots_are_told_apart_as_well():
    dark = [DARK.shade(color) for color in PALETTE]
    assert min(distance(a, b) for a, b in combinations(dark, 2)) > 0.075
    assert [distance(DARK.shade(c), c) < 0.25 for c in PALETTE[:-1]] == [True] * 7


def test_an_image_is_turned_like_a_shape():
    colors = [*PALETTE, "#ffffff", "#000000", "#b8c0c8"]
    pixels = np.array([[[*bytes.fromhex(c[1:]), k] for k, c in enumerate(colors)]])
    turned = DARK.shade_pixels(pixels.astype(np.uint8))
    for k, color in enumerate(colors):
        expected = list(bytes.fromhex(DARK.shade(color)[1:]))
        assert np.abs(turned[0, k, :3].astype(int) - expected).max() <= 12
    assert turned[0, :, 3].tolist() == list(range(len(colors)))
    assert DARK.shade_pixels(pixels.astype(np.uint8)[..., :3]).shape == (1, len(colors), 3)


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


def test_text_and_its_rim_follow_the_theme():
    scene = Scene()
    scene.text((0, 0), "HHH", color="#000000", size=30.0, halo="#ffffff")
    dark = painted(scene, DARK)
    assert dark.max() > 230  # the letters
    assert dark.min() < 60  # the rim


def test_a_theme_may_change_at_any_time():
    scene = all_shapes("#0072b2")["disc"]
    painter, surface = Painter(), pygame.Surface((100, 100), 0, 32)
    camera = Camera(10.0, 50.0, 50.0)
    for theme in (LIGHT, DARK, LIGHT):
        painter.theme = theme
        painter.paint(surface, scene.shapes, camera)
        assert np.array_equal(pixels(surface)[45:55, 45:55], painted(scene, theme)[45:55, 45:55])


def test_the_themes_own_colours_are_painted_as_they_are():
    scene = all_shapes(DARK.muted)["disc"]
    wanted = list(bytes.fromhex(DARK.muted[1:]))
    assert painted(scene, DARK, shaded=False)[50, 50].tolist() == wanted
    assert painted(scene, DARK)[50, 50].tolist() != wanted


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
