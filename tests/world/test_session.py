"""mars2d.run: one call from an experiment to its record."""

import signal
import sys
import time
import types
from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d import InputError, Robot, Scenario
from mars2d.output.formats.mcap import Log
from mars2d.scenario.experiment import open_experiment
from mars2d.world.loop import Interrupted, simulate
from tests.cases import each_case

SQUARE = Scenario(robots=[Robot()], sampling_time=0.1, stop_time=1.0)


def forward(world):
    return np.full((2, 1), 0.1)


def test_a_scenario_runs_with_the_law_given():
    record = mars2d.run(SQUARE, control=forward)
    assert record.time.tolist() == pytest.approx(np.arange(11) * 0.1)
    assert np.all(record.command == 0.1)


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


def test_what_no_world_can_be_made_of_is_said_with_its_file(tmp_path):
    path = tmp_path / "mine.py"
    path.write_text(
        "from mars2d import Car, Robot, Scenario\n"
        "scenario = Scenario(robots=[Robot(drive=Car(dead_time=2))], sampling_time=1e-6)\n"
    )
    with pytest.raises(InputError, match=r"Car\.dead_time") as caught:
        mars2d.run(path)
    assert caught.value.where == "mine.py"


def test_a_speed_paces_the_run():
    start = time.perf_counter()
    mars2d.run(SQUARE, speed=4.0, show=False)
    assert time.perf_counter() - start >= 0.24  # one simulated second at four times real time


class AfterThreeSteps(Log):
    """A log that does something of its own once it has followed the third step."""

    def __init__(self, path, then):
        super().__init__(path)
        self._then = then

    def follow(self, world):
        super().follow(world)
        if world.iteration == 3:
            self._then()


def test_ctrl_c_between_two_steps_keeps_them(tmp_path):
    def press():
        signal.raise_signal(signal.SIGINT)

    log = AfterThreeSteps(tmp_path / "run.mcap", press)
    with pytest.raises(Interrupted) as caught:
        simulate(open_experiment(SQUARE), log=log)
    assert caught.value.record.over_message == "Interrupted by Ctrl-C"
    assert len(caught.value.record) == len(mars2d.load(tmp_path / "run.mcap")) == 3


@each_case(
    ("arguments", "words"),
    [
        ({"experiment": 3}, "expected a file"),
        ({"experiment": SQUARE, "seed": 1.5}, "seed = 1.5"),
        ({"experiment": SQUARE, "control": 7}, "control = 7"),
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


# -- laws in files of their own ---------------------------------------------------------------

DUEL = """\
from mars2d import Robot, Scenario, load_law

def scenario(red="players/forward.py", blue="players/forward.py"):
    return Scenario(
        stop_time=1,
        robots=[
            Robot(pose=(-1, 0, 0), controller=load_law(red), name="red"),
            Robot(pose=(1, 0, 3.14), controller=load_law(blue), name="blue"),
        ],
    )
"""

COUNTING = """\
calls = []

def control(robot):
    calls.append(robot.name)
    return 0.01 * len(calls), 0.0
"""


@pytest.fixture
def duel(tmp_path, monkeypatch):
    """An experiment with a law in a folder beside it, while another folder is the current one."""
    (tmp_path / "game" / "players").mkdir(parents=True)
    (tmp_path / "mine").mkdir()
    (tmp_path / "game" / "duel.py").write_text(DUEL)
    (tmp_path / "game" / "players" / "forward.py").write_text(COUNTING)
    monkeypatch.chdir(tmp_path / "mine")
    return tmp_path / "game" / "duel.py"


def test_a_law_is_found_beside_the_experiment_and_each_robot_has_its_own(duel):
    record = mars2d.run(duel)
    assert np.array_equal(record.command[:, 0, 0], record.command[:, 0, 1])
    assert record.command[:, 0, 0] == pytest.approx(0.01 * np.arange(1, 12))


def test_a_law_may_have_another_name_and_import_what_lies_beside_it(duel):
    (duel.parent / "players" / "gains.py").write_text("GAIN = 0.25\n")
    (duel.parent / "players" / "mine.py").write_text(
        "from gains import GAIN\ndef pusher(robot):\n    return GAIN, 0\n"
    )
    duel.write_text(DUEL.replace("load_law(red)", "load_law('players/mine.py', 'pusher')"))
    before = set(sys.modules)
    assert np.all(mars2d.run(duel).command[:, 0, 0] == 0.25)
    assert not {name for name in set(sys.modules) - before if "mine" in name or "gains" in name}


@each_case(
    ("text", "where", "words"),
    [
        ("def contrl(robot):\n    pass\n", "red.py", "no law 'control'; did you mean 'contrl'?"),
        ("x = 1\n", "red.py", "has no law 'control'"),
        ("def control():\n    pass\n", "red.py, line 1", "exactly one argument, the robot"),
        ("x = 1\nimport nmpy\n", "red.py, line 2", "ModuleNotFoundError"),
        ("def control(robot):\n    return robot.posee\n", "red.py, line 2", "'posee'"),
        ("def control(robot):\n    pass\n", "red.py, line 1", "control returned nothing"),
    ],
)
def test_a_mistake_in_a_laws_file_points_into_it(duel, text, where, words):
    Path("red.py").write_text(text)
    with pytest.raises(InputError) as caught:
        mars2d.run(duel, options={"red": "red.py"})
    assert caught.value.where == where
    assert words in str(caught.value)


@each_case(
    ("path", "words"),
    [
        (
            "rde.py",
            "rde.py: there is no such file beside duel.py or in the current folder;",
        ),
        ("red", "did you mean 'red.py'?"),
        ("red.txt", "red.txt: expected a law, a file that ends in .py or .onnx"),
        (3, "load_law(path) = 3: expected the name of a law's file"),
    ],
)
def test_a_laws_file_that_is_not_there_is_named_with_the_nearest(duel, path, words):
    Path("red.py").write_text("def control(robot):\n    return 0, 0\n")
    Path("red.txt").write_text("")
    with pytest.raises(InputError) as caught:
        mars2d.run(duel, options={"red": path})
    assert words in str(caught.value)
    assert caught.value.where.startswith("duel.py, line")
