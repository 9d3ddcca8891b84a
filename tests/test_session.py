"""mars2d.run: one call from an experiment to its record."""

import sys
import time
import types

import numpy as np
import pytest

import mars2d
from mars2d import InputError, Robot, Scenario
from mars2d.files import Experiment
from mars2d.loop import simulate

SQUARE = Scenario(robots=[Robot()], sampling_time=0.1, stop_time=1.0)


def forward(world):
    return np.full((2, 1), 0.1)


def test_a_scenario_runs_with_the_law_given():
    record = mars2d.run(SQUARE, control=forward)
    assert record.time.tolist() == pytest.approx(np.arange(11) * 0.1)
    assert np.all(record.command == 0.1)


def test_a_scenario_without_a_law_stands_still():
    assert np.all(mars2d.run(SQUARE).pose == 0.0)


def test_a_file_an_example_and_a_module_are_experiments(tmp_path):
    text = (
        "from mars2d import Scenario\n"
        "scenario = Scenario(stop_time=1)\n"
        "def control(world):\n    return 0.1, 0.1\n"
    )
    path = tmp_path / "mine.py"
    path.write_text(text)
    module = types.ModuleType("mine")
    exec(text, module.__dict__)
    by_path, by_text, by_module = (mars2d.run(x) for x in (path, str(path), module))
    assert by_path.digest == by_text.digest == by_module.digest
    assert by_path.filename == "mine.py"


def test_a_file_leaves_no_module_behind(tmp_path):
    path = tmp_path / "mine.py"
    path.write_text("from mars2d import Scenario\nscenario = Scenario(stop_time=1)\n")
    before = set(sys.modules)
    mars2d.run(path)
    assert not [name for name in set(sys.modules) - before if "mine" in name]


def test_two_files_of_one_name_do_not_meet(tmp_path):
    for k in (1, 2):
        (tmp_path / str(k)).mkdir()
        (tmp_path / str(k) / "same.py").write_text(
            f"from mars2d import Scenario\nscenario = Scenario(stop_time={k})\n"
        )
    ends = [mars2d.run(tmp_path / str(k) / "same.py").time[-1] for k in (1, 2)]
    assert ends == [1.0, 2.0]


def test_stop_time_and_options_override_the_scenario():
    options = {"robots.*.diameter": 0.2, "animation.grid": False, "title": "Mine"}
    record = mars2d.run("random_walk", 5, options=options)
    assert record.time[-1] == 5.0
    assert [robot.diameter for robot in record.scenario.robots] == [0.2, 0.2]
    assert record.scenario.animation.grid is False
    assert record.scenario.title == "Mine"


def test_options_set_the_parameters_of_a_scenario_function():
    record = mars2d.run("follow_the_leader", 1, options={"followers": 1, "robots.0.mass": 2})
    assert len(record.scenario.robots) == 2
    assert record.scenario.robots[0].mass == 2.0


def test_a_speed_paces_the_run():
    start = time.perf_counter()
    mars2d.run(SQUARE, speed=4.0, show=False)
    assert time.perf_counter() - start >= 0.24  # one simulated second at four times real time


def test_watchers_see_every_step_after_sensing():
    seen = []
    simulate(Experiment(SQUARE), watchers=[lambda world: seen.append(world.time)])
    assert seen == pytest.approx(np.arange(11) * 0.1)


def test_seeds_make_runs_that_differ_and_repeat():
    first, again, other = (mars2d.run("random_walk", 200, seed=seed) for seed in (1, 1, 2))
    assert first.digest == again.digest
    assert first.digest != other.digest


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"experiment": 3}, "expected a file"),
        ({"experiment": SQUARE, "speed": "fast"}, "speed = 'fast'"),
        ({"experiment": SQUARE, "seed": 1.5}, "seed = 1.5"),
        ({"experiment": SQUARE, "control": 7}, "control = 7"),
        ({"experiment": SQUARE, "options": {"titel": "x"}}, "did you mean 'title'?"),
        ({"experiment": SQUARE, "stop_time": -1}, "Scenario.stop_time = -1"),
    ],
)
def test_what_can_not_be_run_is_refused(arguments, words):
    with pytest.raises(InputError, match=r".") as caught:
        mars2d.run(**arguments)
    assert words in str(caught.value)


def test_an_error_carries_what_was_recorded():
    def fails_later(world):
        if world.iteration == 5:
            raise RuntimeError("enough")
        return 0.1, 0.0

    with pytest.raises(mars2d.LawError, match="enough") as caught:
        mars2d.run(SQUARE, control=fails_later)
    assert len(caught.value.record) == 5
    assert caught.value.where.startswith("test_session.py, line")
