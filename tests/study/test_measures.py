"""Measures tell what a run came to; those of a user are checked as they return."""

from __future__ import annotations

import inspect
import math
from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d import InputError, Robot, Scenario
from mars2d.addons import Game
from mars2d.core.errors import LawError
from mars2d.scenario.experiment import open_experiment
from mars2d.study.measures import BUILT_IN, UNITS, measure_named, measured
from mars2d.world.loop import simulate
from tests.cases import each_case
from tests.worlds import ahead


def meeting(**fields):
    """Two robots that drive at each other from 2 m, red hunting blue."""
    robots = [
        Robot(pose=(-1, 0, 0), controller=ahead, name="red"),
        Robot(pose=(1, 0, np.pi), controller=ahead, name="blue"),
    ]
    game = Game({"pursuer": ["red"], "evader": ["blue"]})
    return Scenario(**({"robots": robots, "addons": [game], "stop_time": 10} | fields))


@pytest.fixture(scope="module")
def caught():
    return mars2d.run(meeting())


@pytest.fixture(scope="module")
def escaped():
    return mars2d.run(meeting(stop_time=3))


def of(name, record):
    return measured(name, measure_named(name, {}), record)


def test_the_time_to_capture_is_that_of_the_game(caught, escaped):
    # 2 m less the diameter of 0.3 m, at 0.4 m/s.
    assert of("capture_time", caught) == pytest.approx(4.25)
    assert of("capture_time", escaped) is None


def test_the_winner_is_a_role(caught, escaped):
    assert of("winner", caught) == "pursuer"
    assert of("winner", escaped) == "evader"


def test_the_numbers_of_a_run_are_those_that_one_works_out_by_hand(escaped):
    assert of("end_time", escaped) == pytest.approx(3.0)
    assert of("collisions", escaped) == 0
    assert of("path_length", escaped) == pytest.approx(0.6)
    assert of("least_clearance", escaped) == pytest.approx(2 - 0.3 - 1.2)
    assert of("final_spread", escaped) == pytest.approx(0.4)


def test_a_touch_is_a_collision_and_the_effort_a_share(caught):
    assert of("collisions", caught) == 1
    assert of("least_clearance", caught) == pytest.approx(0.0, abs=0.01)
    assert 0 <= of("effort", caught) <= 1


def test_every_measure_says_what_it_is_and_its_unit():
    told = {name: inspect.getdoc(made).partition("\n")[0] for name, made in BUILT_IN.items()}
    words = {"s": "seconds", "m": "metres"}
    for name, unit in UNITS.items():
        assert words[unit] in told[name]
    assert all(text.endswith(".") for text in told.values())


def test_the_name_of_no_measure_is_an_error_with_the_nearest():
    with pytest.raises(
        InputError, match="there is no measure 'capture_tim'; did you mean 'capture"
    ):
        measure_named("capture_tim", {})
    with pytest.raises(InputError, match="did you mean 'my_error'"):
        measure_named("my_eror", {"my_error": lambda record: 1})
    with pytest.raises(InputError, match="there is no measure 'xyz'; known: capture_time"):
        measure_named("xyz", {"control": ahead})


def test_a_function_of_the_experiment_goes_before_one_built_in_if_it_is_of_one_thing():
    def winner(record):
        return "mine"

    assert measure_named("winner", {"winner": winner}) is winner
    with pytest.raises(
        InputError, match=r"measure 'two': two\(a, b\) is no measure: .*two\(record\)"
    ):
        measure_named("two", {"two": lambda a, b: 0})


@each_case(
    "given, kept",
    [
        (3, 3),
        (True, 1),
        (np.bool_(False), 0),
        (np.float32(0.5), 0.5),
        (np.int64(7), 7),
        (np.array(2.5), 2.5),
        (None, None),
        (math.nan, None),
        (np.nan, None),
        (math.inf, math.inf),
        (" red  wins ", "red wins"),
        (np.str_("red"), "red"),
    ],
)
def test_what_a_measure_returns_becomes_a_plain_number_a_word_or_nothing(caught, given, kept):
    value = measured("mine", lambda record: given, caught)
    assert value == kept
    assert type(value) in (int, float, str, type(None))


def test_what_a_measure_of_a_file_raises_points_at_its_line(tmp_path: Path):
    file = tmp_path / "study.py"
    file.write_text(
        "from mars2d import Scenario\n"
        "scenario = Scenario(stop_time=0.3)\n"
        "def half_way(record):\n"
        "    return record.poses[0]\n",
        encoding="utf-8",
    )
    experiment = open_experiment(file)
    record = simulate(experiment).record
    function = measure_named("half_way", experiment.source.functions)
    with pytest.raises(LawError, match=r"study.py, line 4: half_way raised .*did you mean 'pose'"):
        measured("half_way", function, record)
