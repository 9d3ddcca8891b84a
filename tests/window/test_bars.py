"""Header, footer, banner and the page of help say what matters at any size, in both themes."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mars2d.output.excerpt import Excerpt
from mars2d.output.raster.bars import Banner, Status, draw_footer, draw_header, footer_height
from mars2d.output.raster.layout import FOOTER, TEXT_SIZES, Layout
from mars2d.output.raster.theme import LIGHT
from mars2d.window import keys
from mars2d.window.help import draw_help
from mars2d.window.keys import Key
from tests.cases import each_case
from tests.window.circling import Circling
from tests.window.written import THEMES, Written, painter, pixels

SIZES = each_case("size", [(640, 480), (1280, 720), (2560, 1440)])
TEXTS = each_case("text", [1.0, max(TEXT_SIZES)])
HINTS = (("Space", "pause"), ("→", "step"), ("+ -", "speed"), ("F1", "help"))
TITLE = "A long title of an experiment about which there is much to say"
EXCERPT = Excerpt(
    Path("walk.py"), 12, 10,
    ("def walk(world):", "    far = world.range", "    v = sqrt(far - 2.0)", "", "    return v, 0"),
)  # fmt: skip
WRONG = "walk.py, line 12: robot 'red': the law raised ValueError: math domain error"


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


def test_the_header_has_title_time_step_and_status(frame):
    texts = header(frame, Status("2x")).texts
    assert texts[0] == "2x"
    assert set(texts) >= {"time", "step", str(frame.iteration), frame.scenario.title}


@SIZES
@TEXTS
@each_case("words", ["1x", "past · 12.3 s ago", "10x  reaches 3.2x"])
def test_its_words_do_not_touch_and_the_time_is_always_there(frame, size, text, words):
    surface = header(titled(frame, TITLE), Status(words, "past"), size, text)
    assert not surface.crowded()
    assert not surface.cut()
    assert words in surface.texts
    assert any(found.endswith(" s") for found in surface.texts)


def test_where_there_is_no_room_the_step_goes_first(frame):
    status = Status("past · 12.3 s ago", "past")
    wide, narrow = (
        header(titled(frame, TITLE), status, size) for size in [(1280, 720), (480, 600)]
    )
    assert "step" in wide.texts
    assert "step" not in narrow.texts
    assert any(text.endswith("…") for text in narrow.texts)


@THEMES
@each_case("kind", ["running", "waiting", "past", "hand", "error"])
def test_the_chip_is_in_the_colours_of_its_kind(frame, theme, kind):
    seen = pixels(header(frame, Status("some words", kind), theme=theme))
    for color in getattr(theme, kind):
        assert (seen == list(bytes.fromhex(color[1:]))).all(axis=2).sum() > 20


# -- the footer -----------------------------------------------------------------------------------


@SIZES
@TEXTS
def test_the_quiet_line_keeps_the_key_for_help(size, text):
    _, surface = footer(None, size, text)
    assert "F1" in surface.texts
    assert not surface.crowded()
    assert not surface.cut()


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


@SIZES
@each_case("text", [1.0, 1.7])
def test_an_error_shows_the_line_and_as_many_round_it_as_there_is_room_for(size, text):
    _, surface = footer(Banner(WRONG, "R restarts", True, EXCERPT), size, text)
    numbers = [found for found in surface.texts if found.isdigit()]
    assert "12" in numbers
    assert numbers == [str(k) for k in range(int(numbers[0]), int(numbers[-1]) + 1)]
    assert any("sqrt" in found for found in surface.texts)
    assert surface.texts.count("▸") == 1
    assert abs(surface.place("▸").centery - surface.place("12").centery) <= 2


def test_all_lines_of_an_excerpt_are_shown_where_there_is_room():
    _, surface = footer(Banner(WRONG, "R restarts", True, EXCERPT))
    assert set(surface.texts) >= {line for line in EXCERPT.lines if line}
    assert surface.place("    far = world.range").top < surface.place("    return v, 0").top


def test_a_banner_is_no_higher_than_its_code():
    pens = painter(Layout.of((1280, 720)), LIGHT)
    short = Excerpt(EXCERPT.file, 12, 12, EXCERPT.lines[2:3])
    heights = [
        footer_height(Banner(WRONG, "R restarts", True, excerpt), (1280, 720), pens)
        for excerpt in (None, short, EXCERPT)
    ]
    assert heights == [FOOTER, FOOTER + 40, FOOTER + 120]


def test_without_a_banner_the_footer_has_its_height():
    pens = painter(Layout.of((1280, 720)), LIGHT)
    assert footer_height(None, (1280, 720), pens) == FOOTER
    assert footer_height(Banner("It is over."), (1280, 720), pens) == FOOTER


# -- help -----------------------------------------------------------------------------------------


def helped(size, text=1.0, groups=None, page=0):
    layout, surface = Layout.of(size, text=text, controls=True), Written(size)
    groups = keys.GROUPS.items() if groups is None else groups
    pages = draw_help(surface, layout, painter(layout, LIGHT), groups, page)
    return layout, surface, pages


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
    for heading, group in keys.GROUPS.items():
        assert heading in found
        for key in group:
            assert all(label in found for label in key.labels)
            assert all(word in everything for word in key.help.split())


@each_case(
    "size, text, most",
    [((1280, 720), 1.0, 1), ((800, 600), 1.0, 2), ((1280, 720), 1.7, 2), ((1920, 1080), 1.7, 2)],
)
def test_help_is_legible_and_of_few_pages(size, text, most):
    layout, surface, pages = helped(size, text)
    assert pages <= most
    lowest = min(place.height for found, place in surface.words)
    assert lowest >= 13
    assert lowest >= 10 * layout.ui


def test_a_page_beyond_the_last_is_the_last():
    pages = helped((640, 480), 1.7)[2]
    assert pages > 1
    last = helped((640, 480), 1.7, page=pages - 1)[1]
    beyond = helped((640, 480), 1.7, page=99)[1]
    assert np.array_equal(pixels(last), pixels(beyond))
    assert "F1 closes this" in last.texts
    assert "F1 goes on" in helped((640, 480), 1.7)[1].texts


@each_case("size", [(40, 30), (120, 90), (300, 60)])
def test_where_nothing_could_be_read_there_is_no_help(size):
    assert helped(size)[2] >= 1


@pytest.mark.slow
def test_groups_of_one_key_and_of_very_many():
    one = [("Group", [Key("go", ("g",), ("G",), "go")])]
    assert helped((1280, 720), groups=one)[1].texts == [
        "Keys",
        "F1 closes this",
        "Group",
        "G",
        "go",
    ]
    many = [("Group", [Key(str(k), (), (str(k),), "do " * 9) for k in range(300)])]
    pages = helped((1280, 720), groups=many)[2]
    assert "299" in helped((1280, 720), groups=many, page=pages)[1].texts
