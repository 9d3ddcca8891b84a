"""Header, footer, banner and the page of help say what matters at any size, in both themes."""

from dataclasses import replace
from pathlib import Path

import pytest

from mars2d.output.excerpt import Excerpt
from mars2d.output.raster.bars import Banner, Status, draw_footer, draw_header, footer_height
from mars2d.output.raster.layout import TEXT_SIZES, Layout
from mars2d.output.raster.theme import LIGHT
from mars2d.window.run import keys
from mars2d.window.widgets.help import Help
from tests.cases import each_case
from tests.window.circling import Circling
from tests.window.written import Written, painter

SIZES = each_case("size", [(640, 480), (1280, 720), (2560, 1440)])
TEXTS = each_case("text", [1.0, max(TEXT_SIZES)])
HINTS = (("Space", "pause"), ("→", "step"), ("+ -", "speed"), ("F1", "help"))
TITLE = "A long title of an experiment about which there is much to say"
EXCERPT = Excerpt(
    Path("walk.py"), 12, 10,
    ("def walk(world):", "    far = world.range", "    v = sqrt(far - 2.0)", "", "    return v, 0"),
)  # fmt: skip
WRONG = "walk.py, line 12: robot 'red': the law raised ValueError: math domain error"

GROUPS = {**keys.GROUPS, "Mouse": keys.MOUSE}


@pytest.fixture(scope="module")
def frame():
    source = Circling()
    for _ in range(30):
        source.advance()
    return source.frame


def titled(frame, title):
    return replace(frame, scenario=frame.scenario.replace(title=title))


def header(frame, status, size=(1280, 720), text=1.0, theme=LIGHT):
    layout, surface = Layout.of(size, text=text, controls=True), Written(size)
    draw_header(surface, layout, painter(layout, theme), frame, status)
    return surface


def footer(banner, size=(1280, 720), text=1.0):
    pens = painter(Layout.of(size, text=text), LIGHT)
    height = footer_height(banner, size, pens, text)
    layout, surface = Layout.of(size, height, text=text, controls=True), Written(size)
    draw_footer(surface, layout, pens, banner, "20 robots  ·  sampling time 0.1 s", HINTS)
    return layout, surface


# -- the header -----------------------------------------------------------------------------------


@SIZES
@TEXTS
@each_case("words", ["1x", "past · 12.3 s ago", "10x  reaches 3.2x"])
def test_its_words_do_not_touch_and_the_time_is_always_there(frame, size, text, words):
    surface = header(titled(frame, TITLE), Status(words, "past"), size, text)
    assert not surface.crowded()
    assert not surface.cut()
    assert words in surface.texts
    assert any(found.endswith(" s") for found in surface.texts)
    if size[0] > 1000 and text == 1.0:
        assert {"time", "step", str(frame.iteration), TITLE} <= {*surface.texts}


# -- the footer -----------------------------------------------------------------------------------


@SIZES
@TEXTS
@each_case("code", [None, EXCERPT])
@each_case("words", ["It is over.", WRONG, WRONG * 8])
def test_a_banner_has_all_it_can_say(size, text, code, words):
    banner = Banner(words, "R restarts   Esc leaves", code is not None, code)
    layout, surface = footer(banner, size, text)
    assert not surface.crowded()
    assert not surface.cut()
    assert all(layout.footer.contains(place) for _, place in surface.words)
    assert "R restarts   Esc leaves" in surface.texts
    assert layout.plot.height > 40


# -- help -----------------------------------------------------------------------------------------


def helped(size, text=1.0, page=0):
    layout, surface = Layout.of(size, text=text, controls=True), Written(size)
    shown = Help()
    shown.page = page
    shown.draw(surface, layout, painter(layout, LIGHT), GROUPS.items())
    return layout, surface, shown.pages


@each_case("size, text", [((640, 480), max(TEXT_SIZES)), ((1280, 720), 1.0)])
def test_all_keys_stand_on_the_pages_of_help(size, text):
    found = []
    pages = helped(size, text)[2]
    for page in range(pages):
        layout, surface, _ = helped(size, text, page=page)
        assert not surface.crowded()
        assert not surface.cut()
        assert all(place.top > layout.header.bottom for _, place in surface.words)
        found += surface.texts
    everything = " ".join(found)
    for heading, group in GROUPS.items():
        assert heading in found
        for key in group:
            assert all(label in found for label in key.labels)
            assert all(word in everything for word in key.help.split())
