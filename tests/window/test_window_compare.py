"""Three runs in step in one window, with mouse and keys, and how far they get apart."""

from __future__ import annotations

import numpy as np
import pygame
import pytest

import mars2d
from mars2d import Robot, Scenario
from mars2d.core.errors import LawError
from mars2d.output.figures.comparison import MODES, drifts
from mars2d.output.films.footage import Cut
from mars2d.output.raster.theme import LIGHT
from mars2d.record.contact import met
from mars2d.scenario.experiment import open_experiment
from mars2d.window.compare_window import CompareWindow
from mars2d.window.screen.display import Preferences
from mars2d.window.screen.source import Playback, Trio
from mars2d.world.timeline import Timeline
from tests.cases import each_case
from tests.window.person import differing
from tests.window.written import Written, painter

FAILS = """
from mars2d import Robot, Scenario

scenario = Scenario(robots=[Robot()], sampling_time=0.1, stop_time=1.0)


def control(world):
    if world.scenario.physics == "ideal" and world.time > 0.45:
        raise ValueError("too ideal")
    return [[0.1], [0.0]]
"""


def trio_of(source, **options):
    return Trio(
        {mode: Timeline(open_experiment(source, options | {"physics": mode})) for mode in MODES}
    )


def to_the_end(trio):
    while not trio.over:
        trio.advance()
    return trio


# -- the runs -------------------------------------------------------------------------------------


def test_the_runs_are_those_of_runs_alone_and_the_drift_is_that_of_the_comparison():
    trio = to_the_end(trio_of("push_box", stop_time=3))
    records = {mode: run.record for mode, run in trio.runs.items()}
    for mode, record in records.items():
        alone = mars2d.run("push_box", options={"physics": mode, "stop_time": 3})
        assert alone.digest == record.digest
        collisions = [alone.contacts["time"][met(alone.contacts)] <= time for time in (1.5, 3.0)]
        assert trio.collisions(1.5)[mode] == collisions[0].sum()
        assert trio.collisions(3.0)[mode] == collisions[1].sum() == alone.collisions
    for mode, drift in drifts(records).items():
        np.testing.assert_array_equal(trio.drifts[mode].max, drift.max)
        np.testing.assert_array_equal(trio.drifts[mode].mean, drift.mean)


def test_a_run_that_ends_earlier_stands_still_and_the_others_go_on():
    trio = to_the_end(trio_of("head_on"))
    rows = {mode: run.newest for mode, run in trio.runs.items()}
    assert rows["ideal"] < rows["contact"] == trio.row == trio.newest
    assert len(trio.drifts["ideal"].time) == rows["ideal"] + 1
    trio.go(rows["ideal"] - 5)
    assert {run.row for run in trio.runs.values()} == {rows["ideal"] - 5}
    trio.go(10**9)
    assert {mode: run.row for mode, run in trio.runs.items()} == rows
    assert trio.over
    trio.restart()
    assert trio.row == trio.newest == len(trio.drifts["stop"].time) == 0
    assert trio.collisions(0.0) == dict.fromkeys(MODES, 0)


def test_an_error_names_the_physics_and_the_others_have_gone_on(tmp_path):
    (tmp_path / "mine.py").write_text(FAILS)
    trio = trio_of(tmp_path / "mine.py")
    with pytest.raises(LawError, match=r"physics = 'ideal': mine.py, line 9.*too ideal"):
        to_the_end(trio)
    assert trio.runs["contact"].newest == trio.runs["stop"].newest == 6


# -- the film ---------------------------------------------------------------------------------


def test_a_film_has_a_picture_for_each_moment_and_a_run_that_ended_stands_still():
    scenario = Scenario(
        robots=[Robot(pose=(-2, 0, 0), diameter=0.4)], sampling_time=0.5, stop_time=4.0
    )
    records = {
        mode: mars2d.run(scenario.replace(stop_time=last), control=lambda _: [[0.5], [0.0]])
        for mode, last in zip(MODES, (4.0, 4.0, 2.0), strict=True)
    }
    window = CompareWindow(Trio({mode: Playback(record) for mode, record in records.items()}))
    pictures = window.film(Cut.of(4.0, 2.0, 10), (1280, 720), "2x")
    seen = [pygame.surfarray.array3d(picture).astype(int) for picture in pictures]
    assert len(seen) == 1 + 4.0 / 2.0 * 10 + 1  # the first, those after, and the end
    plots = window.plots
    early, late = seen[14], seen[18]
    for mode, moves in (("contact", True), ("ideal", False)):
        left, top, width, height = plots[mode]
        part = np.s_[left + 2 : left + width, top : top + height]
        assert (early[part] != late[part]).any() == moves


# -- the plot -------------------------------------------------------------------------------------


@each_case("size", [(800, 600), (1024, 768), (1280, 720)])
@each_case("text", [1.0, 1.7])
def test_the_arenas_have_the_same_width_and_lie_above_the_plot(size, text):
    window = CompareWindow(trio_of("push_box"), 1, size, Preferences(text=text))
    window.draw(Written(size))
    plots = [*window.plots.values()]
    assert max(plot.width for plot in plots) - min(plot.width for plot in plots) <= 1
    assert all(plot.height >= 0.1 * size[1] for plot in plots)
    assert all(plot.bottom <= window._plot_place.top for plot in plots)
    assert window._plot_place.height >= 0.15 * size[1]


# -- the window -----------------------------------------------------------------------------------


@pytest.fixture
def compare(open_window):
    return lambda experiment, speed="max", **more: open_window(speed, compare=experiment, **more)


def test_keys_and_buttons_of_time_move_all_three(compare):
    window = compare("push_box")
    window.until(lambda s: s["over"])
    window.press("Home")
    window.until(lambda s: set(s["rows"].values()) == {0})
    window.steps(3)
    window.until(lambda s: set(s["rows"].values()) == {3})
    window.press("n")
    met = window.until(lambda s: s["row"] > 3 and s["forces"])
    assert len(set(met["rows"].values())) == 1
    window.do("mousemove", *window.state["buttons"]["start"], "click", 1)
    window.until(lambda s: s["row"] == 0)
    window.do("mousemove", *window.state["buttons"]["pause"], "click", 1)
    window.until(lambda s: s["over"])


def test_the_time_bar_and_the_plot_are_scrubbed_and_the_wheel_zooms_all_arenas(compare):
    window = compare("push_box")
    window.until(lambda s: s["over"])
    first, last, y = window.state["bar"]
    window.do("mousemove", round((first + last) / 2), y, "click", 1)
    window.until(lambda s: abs(s["row"] - s["newest"] / 2) <= 2)
    left, top, width, height = window.state["graph"]
    window.do("mousemove", left + width // 4, top + height // 2, "click", 1)
    window.until(lambda s: abs(s["row"] - s["newest"] / 4) <= 2)
    scale, before = window.state["scale"], window.still()
    window.do("mousemove", *window.state["arenas"]["stop"], "click", 4)
    window.until(lambda s: s["scale"] > scale)
    assert window.shows(lambda seen: differing(before, seen) > 500)
    window.press("f")
    window.until(lambda s: s["scale"] == scale)


def test_looks_help_pictures_films_and_leaving(compare, tmp_path):
    window = compare("head_on", 1, folder=tmp_path, text=2.2)
    window.press("space")
    bare = window.still()
    window.shown.notes.say("seen at any size of text")
    assert window.shows(lambda seen: differing(bare[:, 600:], seen[:, 600:]) > 1000)
    window.press("space", "p", "v")
    window.says("compared_1.png")
    window.press("v")
    window.says("film: ")
    assert len(list(tmp_path.iterdir())) == 2
    window.press("d", "z", "z", "x")
    window.until(lambda s: s["dark"] and s["text"] == 1.3 and not s["forces"])
    window.press("F1")
    window.until(lambda s: s["help"] is not None)
    window.press("Escape")
    window.until(lambda s: s["help"] is None)
    row = window.state["row"]
    window.press("r")
    window.until(lambda s: s["row"] < row or s["row"] < 5)
    window.press("ctrl+q")
    window.until(lambda s: s.get("left"))


def test_each_physics_says_what_it_counts_and_leaves_out_and_which_line_another_hides(keyboard):
    window = CompareWindow(trio_of("tug_of_war", stop_time=1), size=(1280, 720))
    window.looks.painter = painter(window.looks.layout((1280, 720)), LIGHT)
    while window.trio.row < 20:
        window.trio.advance()
    window.player.settle()
    surface = Written((1280, 720))
    window.draw(surface)
    assert {"0 collisions", "0 stops", "0 overlaps"} <= set(surface.texts)
    assert sum(text.startswith("without 4 ropes; ") for text in surface.texts) == 2
    assert {"stop, max", "ideal, max: the same", "ideal, mean: the same"} <= set(surface.texts)
