"""The time bar shows where an experiment is and finds the row under the pointer; so the slider."""

from math import inf
from types import SimpleNamespace

import numpy as np
import pytest

from mars2d import Robot, Scenario
from mars2d.output.raster.layout import TEXT_SIZES, Layout
from mars2d.output.raster.theme import LIGHT
from mars2d.scenario.experiment import open_experiment
from mars2d.window.run.timebar import TimeBar, costs
from mars2d.window.screen.player import Player
from mars2d.window.widgets.slider import SpeedSlider
from mars2d.world.timeline import Timeline
from tests.cases import each_case
from tests.window.written import THEMES, Written, painter, pixels

RUNGS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
SIZES = [(640, 480), (1280, 720), (2560, 1440)]


def state(row=300, rows=400, last=1000, dt=0.1, **marks):
    """Return a time bar of a run that is at a row of so many."""
    scenario = SimpleNamespace(last_iteration=last, sampling_time=dt)
    source = SimpleNamespace(row=row, newest=rows, scenario=scenario)
    bar = TimeBar(SimpleNamespace(source=source, past=row < rows), source)
    bar.marks = lambda: marks
    return bar


class Drawn:
    """A time bar on a surface; `at` are the colours along its line."""

    def __init__(self, shown, theme=LIGHT, size=(1280, 720), text=1.0, **options):
        self.layout = Layout.of(size, text=text, controls=True)
        self.bar, self.surface = shown, Written(size)
        self.theme = theme
        shown.draw(self.surface, self.layout.timebar, painter(self.layout, theme), **options)
        self.pixels = pixels(self.surface)

    def has(self, color, row, above=0):
        """Return whether a colour is seen at a row, so many points above the line."""
        y = self.bar._line.centery - round(above * self.layout.ui)
        x = round(self.bar.x_of(row))
        near = self.pixels[y - 1 : y + 2, x - 2 : x + 3].reshape(-1, 3)
        return bool((np.abs(near - list(bytes.fromhex(color[1:]))).max(axis=1) < 3).any())


@THEMES
def test_played_recorded_and_future_stretches_differ(theme):
    drawn = Drawn(state(), theme)
    rows = [150, 360, 700]
    colors = [tuple(drawn.pixels[drawn.bar._line.centery, round(drawn.bar.x_of(r))]) for r in rows]
    assert len(set(colors)) == 3
    assert drawn.has(theme.selected, 150)
    assert drawn.has(theme.track, 700)


@THEMES
def test_the_handle_stands_at_the_row_and_tells_the_past_by_its_colour(theme):
    assert Drawn(state(), theme).has(theme.past.ink, 300)
    assert Drawn(state(row=400), theme).has(theme.selected, 400)
    assert not Drawn(state(row=400), theme).has(theme.past.ink, 400)


@each_case("size", SIZES)
@each_case("text", TEXT_SIZES)
@each_case("row", [0, 399])
def test_its_words_do_not_touch_each_other(size, text, row):
    drawn = Drawn(state(row=row), size=size, text=text, pointer=(100, size[1] - 70))
    assert not drawn.surface.crowded()
    assert not drawn.surface.cut()


@each_case("size", SIZES)
def test_the_row_under_the_pointer_is_found(size):
    drawn = Drawn(state(), size=size)
    for row in (0, 1, 137, 400):
        found = drawn.bar.row_at(drawn.bar.x_of(row))
        assert abs(found - row) <= max(1, 1000 / drawn.bar._line.width)
    assert drawn.bar.row_at(-50) == 0
    assert drawn.bar.row_at(size[0]) == 400  # no further than there is anything


def test_over_it_the_pointers_time_is_shown():
    plain = Drawn(state())
    pointer = (round(plain.bar.x_of(250)), plain.layout.timebar.centery)
    hovered = Drawn(state(), pointer=pointer)
    assert "25.0 s" in hovered.surface.texts
    assert hovered.surface.place("25.0 s").bottom <= hovered.layout.timebar.top
    beside = Drawn(state(), pointer=(pointer[0], 100))
    assert np.array_equal(beside.pixels, plain.pixels)
    assert not np.array_equal(Drawn(state(), held=True).pixels, plain.pixels), "it is lifted"


@THEMES
def test_events_are_ticks_in_colours_of_their_own(theme):
    drawn = Drawn(state(collision=[100], hand=[200], branch=[50], error=[350]), theme)
    assert drawn.has(theme.shade("#a3003c"), 100, above=-8)
    assert drawn.has(theme.hand.ink, 200, above=8)
    assert drawn.has(theme.past.ink, 50, above=8)
    assert drawn.has(theme.past.ink, 50, above=-8)
    assert drawn.has(theme.error.ink, 350, above=8)
    assert not drawn.has(theme.hand.ink, 200, above=-8)
    assert np.array_equal(
        Drawn(state(collision=np.array([100, 101]))).pixels,
        Drawn(state(collision=[100, 101])).pixels,
    )


@each_case("rows, seconds", [(0, 10), (90, 10), (99, 20), (1000, 200), (10_000, 2000)])
def test_an_endless_experiment_shows_a_round_time_that_grows(rows, seconds):
    endless = state(row=rows, rows=rows, last=10**13)
    assert endless.extent * 0.1 == pytest.approx(seconds)
    assert f"{seconds} s" in Drawn(endless).surface.texts
    assert Drawn(endless).bar.row_at(1e6) == rows


@each_case(
    "dt, row, text",
    [(0.05, 1, "0.05 s"), (1.0, 7, "7 s"), (0.025, 3, "0.075 s"), (0.5, 3, "1.5 s")],
)
def test_times_have_the_decimals_that_tell_rows_apart(dt, row, text):
    shown = state(row=400, last=400, dt=dt)
    plain = Drawn(shown)
    pointer = round(plain.bar.x_of(row)), plain.layout.timebar.centery
    assert text in Drawn(shown, pointer=pointer).surface.texts


# -- the slider -----------------------------------------------------------------------------------


class Slid:
    """A slider on a surface."""

    def __init__(self, speed, theme=LIGHT, size=(1280, 720), text=1.0):
        self.layout = Layout.of(size, text=text, controls=True)
        self.slider, self.surface = SpeedSlider(RUNGS), Written(size)
        self.slider.draw(self.surface, self.layout.slider, painter(self.layout, theme), speed)


@each_case("size", SIZES)
@each_case("text", TEXT_SIZES)
def test_each_speed_is_found_where_it_is_shown(size, text):
    slid = Slid(1.0, size=size, text=text)
    for speed in (*RUNGS, inf):
        assert slid.slider.speed_at(slid.slider.x_of(slid.slider.value_of(speed))) == speed
    assert slid.slider.speed_at(0) == 0.1
    assert slid.slider.speed_at(size[0]) == inf


def test_the_speed_stands_beside_it():
    for speed, text in ((1.0, "1x"), (inf, "max"), (0.0, "manual"), (3.0, "3x")):
        assert Slid(speed).surface.texts == [text]


def test_beside_the_speed_the_pointer_asks_what_a_step_and_a_picture_take():
    timeline = Timeline(open_experiment(Scenario(robots=[Robot(controller=lambda robot: (1, 0))])))
    player, surface = Player(timeline, 1.0), Written((1280, 720))
    layout = Layout.of(surface.get_size(), controls=True)
    beside = layout.slider.right - 10, layout.slider.centery

    def says(pointer):
        surface.words.clear()
        slider, brush, told = SpeedSlider(RUNGS), painter(layout, LIGHT), costs(player)
        slider.draw(surface, layout.slider, brush, 1.0, pointer=pointer, costs=told)
        return [text for text in surface.texts if text.partition(":")[0] in ("ms", "µs")]

    assert says(beside) == []  # nothing was done yet
    timeline.advance()
    timeline.advance()
    spent = timeline.world.simulation.seconds
    assert all(seconds > 0 for seconds in spent.values())
    spent.update(physics=3e-3, laws=4.2e-4, sensing=8e-6)
    player.drawing = 0.0123
    assert says(beside) == ["ms: physics 1.5, laws 0.2, sensing 0.0, picture 12.3"]
    spent.update(physics=3e-5)
    assert says(beside) == ["µs: physics 15, laws 210, sensing 4, picture 12300"]
    assert says((0, 0)) == []
