"""Live editing: what is saved is in effect at once, and what is wrong with it is said in place."""

import os

import pytest

from mars2d import LawError
from mars2d.scenario.experiment import open_experiment
from mars2d.window.run.reload import Reload
from mars2d.world.timeline import Timeline
from tests.cases import each_case

WALK = """
from mars2d import Robot, Scenario, load_law
from speeds import SLOW
def law(robot):
    return SLOW, 0.0
scenario = Scenario(
    robots=[Robot(controller=law).at(0, 0), Robot(controller=load_law("other.py")).at(0, 2)],
    sampling_time=0.1,
)
"""
SPEEDS = "SLOW = 0.1\n"
OTHER = "def control(robot):\n    return 0.2, 0.1\n"


class Desk:
    """A person who writes files, a timeline of them, and a clock."""

    def __init__(self, folder):
        self.folder, self.now, self.written = folder, 0.0, 0
        for name, text in (("walk", WALK), ("speeds", SPEEDS), ("other", OTHER)):
            self.write(name, text)
        self.timeline = Timeline(open_experiment(folder / "walk.py"))
        self.reload = Reload(self.timeline)

    def write(self, name, text):
        path = self.folder / f"{name}.py"
        path.write_text(text)
        self.written += 1
        os.utime(path, (self.written, self.written))

    def wait(self, seconds=1.0):
        """Let time pass; return what was said."""
        said = []
        for _ in range(round(seconds / 0.05)):
            self.now += 0.05
            answer = self.reload.poll(self.now)
            if answer is not None:
                said.append(answer)
        return said

    def run(self, rows):
        for _ in range(rows):
            self.timeline.advance()

    @property
    def command(self):
        self.run(1)
        return self.timeline.world.history.command[-1].T.tolist()


@pytest.fixture
def desk(tmp_path):
    return Desk(tmp_path)


@each_case(
    "name, text, command",
    [
        ("walk", WALK.replace("SLOW, 0.0", "SLOW, 0.3"), [[0.1, 0.3], [0.2, 0.1]]),
        ("speeds", "SLOW = 0.15\n", [[0.15, 0.0], [0.2, 0.1]]),
        ("other", OTHER.replace("0.2, 0.1", "0.2, -0.1"), [[0.1, 0.0], [0.2, -0.1]]),
    ],
)
def test_each_file_that_was_read_is_watched(tmp_path, name, text, command):
    desk = Desk(tmp_path)
    desk.run(5)
    desk.write(name, text)
    (said,) = desk.wait()
    assert said.error is None
    assert said.message == f"{name}.py: in effect from now on; R runs it from the start"
    assert desk.timeline.newest == 5
    assert desk.command == command


def test_it_is_in_effect_within_a_second_but_not_before_it_rests(desk):
    desk.run(5)
    assert desk.wait(0.3) == []
    for k in range(10):  # an editor that goes on writing
        desk.write("walk", WALK[: 40 + 10 * k])
        assert desk.wait(0.15) == []
    desk.write("walk", WALK.replace("SLOW, 0.0", "SLOW, 0.3"))
    assert len(desk.wait(0.75)) == 1


@each_case(
    "name, text, where",
    [
        ("walk", WALK.replace("return SLOW", "return SLOW +"), "walk.py, line 5"),
        ("speeds", "SLOW = 1 +\n", "speeds.py, line 1"),
        ("speeds", "FAST = 1\n", "walk.py, line 3"),
        ("other", "def contol(robot): pass\n", "walk.py, line 7: other.py: has no law 'control'"),
        ("walk", WALK.replace("SLOW, 0.0", "SLOW / 0, 0.0"), "walk.py, line 5: law raised"),
    ],
)
def test_an_error_is_told_of_and_the_law_of_before_goes_on(tmp_path, name, text, where):
    desk = Desk(tmp_path)
    desk.run(5)
    desk.write(name, text)
    (said,) = desk.wait()
    assert said.message.startswith(where)
    assert said.message.endswith("\nthe old law goes on")
    assert said.error is not None
    assert desk.command == [[0.1, 0.0], [0.2, 0.1]]
    assert desk.wait() == []  # once
    desk.write(name, {"walk": WALK, "speeds": "SLOW = 0.15\n", "other": OTHER}[name])
    (said,) = desk.wait()
    assert said.error is None


def test_a_law_that_failed_is_mended(desk):
    desk.write("walk", WALK.replace("SLOW, 0.0", "SLOW / (robot.time < 0.95), 0.0"))
    desk.wait()
    desk.timeline.restart()
    desk.wait()
    with pytest.raises(LawError):
        desk.run(50)
    assert desk.timeline.newest == 10
    assert desk.timeline.over
    desk.write("walk", WALK.replace("SLOW, 0.0", "SLOW / (robot.time < 0.85), 0.0"))
    (said,) = desk.wait()
    assert said.message.startswith("walk.py, line 5: law raised ZeroDivisionError")
    assert not said.message.endswith("goes on")
    desk.write("walk", WALK.replace("SLOW, 0.0", "SLOW, 0.3"))
    (said,) = desk.wait()
    assert said.error is None
    assert (desk.timeline.newest, desk.timeline.over) == (10, False)
    assert desk.command[0] == [0.1, 0.3]


def test_a_restart_takes_what_was_saved_and_it_is_not_taken_twice(desk):
    desk.run(5)
    desk.write("walk", WALK.replace("SLOW, 0.0", "SLOW, 0.3"))
    desk.timeline.restart()
    assert desk.wait() == []
    assert desk.command[0] == [0.1, 0.3]


def test_a_file_that_is_imported_from_now_on_is_watched(desk):
    desk.run(2)
    desk.write("fast", "FAST = 0.17\n")
    desk.write("walk", WALK.replace("from speeds import SLOW", "from fast import FAST as SLOW"))
    assert len(desk.wait()) == 1
    desk.write("fast", "FAST = 0.18\n")
    assert len(desk.wait()) == 1
    assert desk.command[0] == [0.18, 0.0]
    desk.write("speeds", "SLOW = 7\n")
    assert desk.wait() == []


def test_a_scenario_file_and_its_laws_are_watched(tmp_path):
    scenario = tmp_path / "walk.toml"
    (tmp_path / "law.py").write_text(OTHER)
    text = 'format = 1\n[[robots]]\npose = [0, 0, 0]\ncontroller = "law.py:control"\n'
    scenario.write_text(text)
    timeline = Timeline(open_experiment(scenario))
    assert set(timeline.experiment.source.written) == {scenario, tmp_path / "law.py"}
    reload = Reload(timeline)
    (tmp_path / "law.py").write_text(OTHER.replace("0.2, 0.1", "0.15, 0.1"))
    said = [reload.poll(1.0), reload.poll(2.0)]
    assert said[1].message.startswith("law.py: in effect from now on")
    scenario.write_text(text + "[[addons]]\ntype = 'Map'\nwalls = [[[3, 0], [3, 1]]]\n")
    said = [reload.poll(3.0), reload.poll(4.0)]
    assert said[1].message.startswith("walk.toml: in effect from now on")
    assert timeline.scenario.obstacles == (((3.0, 0.0), (3.0, 1.0)),)


def test_a_file_that_is_gone_is_said_once_and_taken_again_when_it_is_back(desk):
    (desk.folder / "speeds.py").unlink()
    (said,) = desk.wait()
    assert said.message == "speeds.py is gone: the run goes on with what it was"
    assert said.error is None
    assert desk.wait() == []
    desk.write("speeds", "SLOW = 0.3\n")
    (said,) = desk.wait()
    assert said.message.startswith("speeds.py: in effect")


def test_a_start_that_was_moved_waits_for_r(desk):
    desk.timeline.advance()
    desk.write("walk", WALK.replace("at(0, 2)", "at(0, 3)"))
    (said,) = desk.wait()
    assert said.message.startswith("walk.py: R starts robot1 from there; all else is in effect")
    assert desk.timeline.world.pose[1, 1] == pytest.approx(2.0, abs=0.1)
    desk.timeline.restart()
    assert desk.timeline.world.pose[1, 1] == 3.0
