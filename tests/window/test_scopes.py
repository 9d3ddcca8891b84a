"""Scopes: traces that grow with a run, and their plots."""

from __future__ import annotations

import re
from types import SimpleNamespace

import numpy as np
import pygame
import pytest

from mars2d import Robot, Scenario
from mars2d.core.errors import InputError, LawError
from mars2d.output.raster.brushes import rgba
from mars2d.output.raster.layout import Layout
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.theme import LIGHT
from mars2d.output.signals import signals_of_bodies
from mars2d.scenario.experiment import open_experiment
from mars2d.sensors import Imu, RangeFinder
from mars2d.window.panels.scopes import Scopes
from mars2d.window.panels.trace import read
from mars2d.window.screen.picking import Selection
from mars2d.window.widgets.plot import Axes, as_number
from mars2d.world.timeline import Timeline
from tests.cases import each_case
from tests.window.person import PUSHING
from tests.window.written import Written, painter


@pytest.fixture
def timeline(pushing):
    return Timeline(open_experiment(pushing))


WHATS = ["x", "speed", "command", "effort", "force", "impulse", "energy", "kinetic", "momentum"]

# -- traces ---------------------------------------------------------------------------------------


def values_of(found):
    return [signal.values for signal in found]


@each_case("what", [*WHATS, "momentum.each", "distance.crate"])
def test_a_trace_is_the_records_signal_and_the_present_row(timeline, what):
    while timeline.row < 60:
        timeline.advance()
    found = read(what, (0, 1), timeline.recorded, timeline.frame)
    recorded = signals_of_bodies(timeline.recorded, what, (0, 1))
    for a, b in zip(values_of(found), values_of(recorded), strict=True):
        assert len(a) == len(b) + 1 == timeline.row + 1, "the present row is not recorded yet"
        np.testing.assert_array_equal(a[:-1], b.reshape(len(b), -1))


def test_the_readings_of_sensors_are_traced_if_they_are_few():
    robot = Robot(sensors=[Imu(), RangeFinder(beams=40)], controller=lambda _: (0.2, 0.1))
    timeline = Timeline(open_experiment(Scenario(robots=[robot])))
    for _ in range(5):
        timeline.advance()
        found = read("imu", (0,), timeline.recorded, timeline.frame)
    assert len(found) > 1
    reading = np.ravel(dict(timeline.frame.readings["imu"])[0])
    np.testing.assert_array_equal([each.values[-1, 0] for each in found], reading)
    with pytest.raises(InputError, match=r"readings of shape \(40,\): choose a part"):
        read("range_finder", (0,), timeline.recorded, timeline.frame)


def test_a_function_of_ones_own_is_traced_and_its_mistakes_are_told(timeline):
    while timeline.row < 10:
        timeline.advance()
    record, frame = timeline.recorded, timeline.frame
    (gap,) = read(timeline.experiment.source.functions["gap"], (), record, frame)
    np.testing.assert_array_equal(gap.values[:, 0], record.pose[:, 0, 1] - record.pose[:, 0, 0])
    (two,) = read(lambda r: {"a": r.time, "b": -r.time}, (), record, frame)
    assert two.curves == ("a", "b")

    def broken(record):
        return record.poses

    for function, words in (
        (broken, "broken raised AttributeError"),
        (lambda _: 3.0, "returned 3.0: expected a number for each of the 10 rows"),
        (lambda _: {}, "expected a number for each"),
        (lambda _: "much", "expected a number for each"),
    ):
        with pytest.raises(LawError, match=re.escape(words)):
            read(function, (), record, frame)


# -- plots ----------------------------------------------------------------------------------------


class Scoped:
    """Scopes of a run on a surface that remembers its words."""

    def __init__(self, timeline, size=(316, 300), theme=LIGHT):
        layout = Layout.of((1280, 720))
        self.timeline, self.gone = timeline, []
        self.scopes = Scopes(
            painter(layout, theme),
            SimpleNamespace(source=timeline, frame=timeline.frame, go=self.gone.append),
            Selection(),
            clock=lambda: 0.0,
        )
        self.surface = Written(size)

    def draw(self):
        self.scopes._image = None
        self.surface.words.clear()
        self.scopes.draw(self.surface, self.surface.get_rect(), self.timeline.frame)
        return self.surface


def test_the_cursor_has_the_values_of_the_row_that_is_shown(timeline):
    scoped = Scoped(timeline, (500, 300))
    scoped.scopes.switch("x", (0, 2))
    for _ in range(50):
        timeline.advance()
    for row in (50, 20):
        timeline.go(row)
        texts = scoped.draw().texts
        for name, values in (("red", "pose"), ("crate", "prop_pose")):
            x = getattr(timeline.frame, values)[0, 0]
            assert f"{name} {as_number(x)}" in texts


@each_case("height", [220, 400])
def test_each_number_has_the_name_of_its_curve(height):
    scoped = Scoped(Timeline(open_experiment("crowd")), (316, height))
    for what in ("speed", "energy"):
        scoped.scopes.switch(what, (0,) if what == "speed" else ())
    for _ in range(60):
        scoped.timeline.advance()
    surface = scoped.draw()
    assert not surface.crowded()
    for name in ("kinetic, of all", "drives", "impacts", "friction"):
        assert any(text.startswith(f"{name} ") for text in surface.texts), name


def test_what_is_switched_on_for_one_body_joins_the_plot_of_another(timeline):
    scopes = Scoped(timeline).scopes
    scopes.switch("speed", (0,))
    scopes.switch("speed", (2,))
    scopes.switch("energy", ())
    assert scopes.traces == {"speed": (0, 2), "energy": ()}
    assert scopes.shows("speed", (2,))
    assert not scopes.shows("speed", (0, 1))
    scopes.switch("speed", (0,))
    assert scopes.traces["speed"] == (2,)
    scopes.meet(Scenario(robots=[Robot(), Robot(pose=(1, 0, 0))]))
    assert list(scopes.traces) == ["energy"]
    scopes.switch("energy", ())
    assert not scopes.is_open


def test_the_wheel_shows_less_time_and_more_until_it_is_all(timeline):
    scoped = Scoped(timeline)
    scoped.scopes.switch("x", (0,))
    for _ in range(190):
        timeline.advance()
    scoped.draw()
    turn = pygame.Event(pygame.MOUSEWHEEL, y=4, precise_y=4.0)
    scoped.scopes.handle(turn)
    assert scoped.scopes.span == pytest.approx(19 / 1.25**4)
    scoped.draw()
    limits = scoped.scopes._plots[0].axes
    assert limits.start < timeline.frame.time <= limits.end
    timeline.go(10)
    scoped.draw()
    limits = scoped.scopes._plots[0].axes
    assert limits.start <= timeline.frame.time < limits.end
    scoped.scopes.handle(pygame.Event(pygame.MOUSEWHEEL, y=-9, precise_y=-9.0))
    assert scoped.scopes.span is None


def test_a_mistake_stands_in_the_panel(timeline):
    scoped = Scoped(timeline)
    scoped.scopes.switch(lambda record: record.pose.nothing, ())
    for _ in range(3):
        timeline.advance()
    seen = pygame.surfarray.array3d(scoped.draw()).astype(int)
    ink = rgba(LIGHT.error.ink)[:3]
    assert (np.abs(seen - ink).max(axis=2) < 20).any()
    scoped.scopes.switch("sped", (0,))
    own, unknown = scoped.scopes._signals(timeline.frame)[1]
    assert "AttributeError" in own
    assert "test_scopes.py, line" in own
    assert unknown == "sped: there is no 'sped'; did you mean 'speed'?"


# -- what an experiment's file names --------------------------------------------------------------


def test_a_file_names_its_scopes(tmp_path):
    path = tmp_path / "named.py"
    path.write_text(PUSHING + '\n\nscopes = ["speed", gap]\n')
    speed, gap = open_experiment(path).source.scopes
    assert (speed, gap.__name__) == ("speed", "gap")
    path.write_text(PUSHING + "\n\nscopes = 'speed'\n")
    with pytest.raises(InputError, match="scopes = 'speed': expected a list of columns") as error:
        open_experiment(path)
    assert error.value.where == "named.py"
    path.write_text(PUSHING + "\n\nscopes = [push, lambda: 0]\n")
    with pytest.raises(InputError, match=r"scopes\[1\] = .*exactly one argument, the record"):
        open_experiment(path)


def test_of_many_curves_the_median_and_the_middle_half_are_drawn():
    surface = pygame.Surface((200, 200), 0, 32)
    surface.fill("white")
    area, times = surface.get_rect(), np.linspace(0, 1, 300)
    values = np.tile(np.arange(21.0), (300, 1))  # each stays at its number
    Axes(area, 0, 1, 0, 20).draw_quartiles(surface, Painter(), times, values)
    column = pygame.surfarray.array3d(surface)[100].sum(axis=1)
    painted = np.flatnonzero(column < 765)
    assert (painted.min(), painted.max()) == pytest.approx((50, 150), abs=1)  # 15 and 5 of 20
    assert column.argmin() == pytest.approx(100, abs=1)  # 10 of 20


def test_curves_have_gaps_where_nothing_is_known_steps_and_leaps_of_angles():
    axes, times = Axes(pygame.Rect(0, 0, 40, 10), 0.0, 4.0, -5.0, 5.0), np.arange(5.0)
    gap = axes.lines(times, np.array([0.0, 1.0, np.nan, 2.0, np.inf]))
    assert [part.tolist() for part in gap] == [[[0, 5], [10, 4]], [[30, 3]]]
    leap = axes.lines(times, np.array([2.0, 3.0, -3.0, -2.0, -1.0]), wraps=True)
    assert [len(part) for part in leap] == [2, 3]
    post, pre = (axes.lines(times, times, held=held)[0] for held in ("post", "pre"))
    assert post[:4].tolist() == [[0, 5], [10, 5], [10, 4], [20, 4]]
    assert pre[:4].tolist() == [[-10, 5], [0, 5], [0, 4], [10, 4]]
    assert axes.time_at(axes.x_of(2.5)) == 2.5
