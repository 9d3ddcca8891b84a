"""Parameters that are set while a run goes on: at once where it can go on, else from the start."""

from __future__ import annotations

import numpy as np
import pytest

from mars2d import InputError, load
from mars2d.cli.command_line import main
from mars2d.record.interventions import Change
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.world.branch import options_of
from mars2d.world.timeline import Timeline
from mars2d.world.verify import rerun

FILE = """
from functools import partial
from mars2d import Robot, Scenario

def go(speed, robot):
    while True:
        yield speed, 0.0

def scenario(speed=0.2, mass=1.0, diameter=0.3, y=0.0):
    robot = Robot(name="red", mass=mass, diameter=diameter, controller=partial(go, speed))
    return Scenario(robots=[robot.at(-4, y)], stop_time=4.0)
"""


@pytest.fixture
def timeline(tmp_path):
    path = tmp_path / "file.py"
    path.write_text(FILE)
    return Timeline(open_experiment(path))


def after(timeline, rows):
    for _ in range(rows):
        timeline.advance()
    return timeline


def speeds(record):
    return np.round(np.diff(record.pose[:, 0, 0]) / 0.1, 6).tolist()


def test_a_law_goes_on_with_another_value_and_the_record_says_so(timeline, tmp_path):
    assert after(timeline, 10).set({"speed": 0.4}) == ""
    record = after(timeline, 10).record
    assert speeds(record) == [0.2] * 10 + [0.4] * 9 + [0.4] * (len(record) - 20)
    assert record.options == {}
    (change,) = record.changes
    assert (change.row, change.options) == (10, (("speed", 0.4),))
    record.save(tmp_path / "run.npz")
    kept = load(tmp_path / "run.npz")
    assert kept.changes[0].options == (("speed", 0.4),)
    assert rerun(kept) is None


def test_mars2d_check_verifies_a_run_with_changed_masses_and_names_them(timeline, tmp_path, capsys):
    after(timeline, 5).set({"mass": 2.0})
    after(timeline, 5).set({"robots.red.drive.max_linear_speed": 0.1})
    after(timeline, 30).record.save(tmp_path / "run.npz")
    assert timeline.world.scenario.robots[0].mass == 2.0
    assert speeds(timeline.record)[-1] == 0.1
    assert main(["check", str(tmp_path / "run.npz")]) in (0, None)
    said = capsys.readouterr().out
    assert "set         at 0.5 s: mass = 2.0\n" in said
    assert "set         at 1 s: robots.red.drive.max_linear_speed = 0.1\n" in said
    assert "bit-identical" in said


def test_another_shape_or_start_needs_a_new_start_whose_record_has_the_setting(timeline, tmp_path):
    assert after(timeline, 5).set({"diameter": 0.5}) == "diameter of red is another one"
    assert timeline.newest == 0
    assert after(timeline, 5).set({"y": 1.0}) == "red starts elsewhere"
    record = after(timeline, 5).record
    assert record.pose[0, 1, 0] == 1.0
    assert record.options == {"diameter": 0.5, "y": 1.0}
    assert record.interventions == ()
    record.save(tmp_path / "run.npz")
    assert main(["check", str(tmp_path / "run.npz")]) in (0, None)


def test_before_the_first_step_a_run_begins_with_the_value_as_if_it_were_its_own(timeline):
    assert timeline.set({"speed": 0.3}) == ""
    record = after(timeline, 41).record
    assert record.interventions == ()
    assert record.options == {"speed": 0.3}
    assert record.finished
    assert timeline.set({"speed": 0.1}) == "the run is over"
    assert speeds(after(timeline, 3).record) == [0.1] * 2
    timeline.restart()
    assert timeline.experiment.options == {"speed": 0.1}


def test_what_can_not_be_set_changes_nothing(timeline):
    after(timeline, 5)
    for options, words in (
        ({"mass": -1.0}, "Robot.mass = -1.0"),
        ({"sped": 1.0}, "no option 'sped'; did you mean 'speed'"),
        ({"laws.go.speed": "x"}, "expected a number"),
    ):
        with pytest.raises(InputError, match=words):
            timeline.set(options)
    assert timeline.newest == 5
    assert timeline.experiment.options == {}
    assert not timeline.touched


def test_undo_takes_back_one_slider_and_what_it_says(timeline):
    after(timeline, 5).set({"speed": 0.3})
    after(timeline, 5).set({"mass": 2.0})
    after(timeline, 1).set({"mass": 3.0})
    after(timeline, 5)
    assert isinstance(timeline.undo(), Change)
    assert timeline.row == 10, "both belong to one drag"
    assert timeline.world.scenario.robots[0].mass == 1.0
    assert timeline.experiment.options == {"speed": 0.3}
    timeline.undo()
    assert timeline.experiment.options == {}
    assert speeds(after(timeline, 10).record) == [0.2] * len(speeds(timeline.record))
    timeline.show(timeline.others[0])
    assert timeline.experiment.options == options_of(timeline.world) != {}


def test_a_branch_off_the_past_has_the_values_of_now(timeline):
    after(timeline, 10).set({"mass": 2.0, "speed": 0.4})
    after(timeline, 10).go(5)
    timeline.change(lambda world: world.operator.place(0, (0, 0, 0)))
    assert timeline.world.scenario.robots[0].mass == 2.0
    record = after(timeline, 5).record
    assert dict(record.changes[0].options) == {"mass": 2.0, "speed": 0.4}
    assert speeds(record)[-1] == 0.4
    assert rerun(record) is None


def test_an_experiment_without_a_file_takes_values_as_well():
    plain = open_experiment("cyclic_pursuit").scenario
    timeline = after(Timeline(Experiment(plain)), 5)
    assert timeline.set({"robots.robot0.mass": 2.0, "laws.pursue.gain": 0.2}) == ""
    assert timeline.world.scenario.robots[0].mass == 2.0
    assert timeline.world.scenario.robots[1].controller.args[0] == 0.2
    timeline.undo()
    assert timeline.world.scenario.robots[0].mass == 1.0
    assert timeline.world.scenario.robots[1].controller.args[0] == 0.1


def test_a_saved_file_with_another_mass_goes_on_and_keeps_what_was_set(timeline, tmp_path):
    after(timeline, 5).set({"speed": 0.4})
    path = tmp_path / "file.py"
    path.write_text(FILE.replace("mass=1.0", "mass=3.0"))
    timeline.take(after(timeline, 5).experiment.reopened())
    assert timeline.world.scenario.robots[0].mass == 3.0
    record = after(timeline, 10).record
    assert speeds(record)[6:] == [0.4] * (len(record) - 7)
    assert [(each.row, dict(each.options)) for each in record.changes] == [
        (5, {"speed": 0.4}),
        (10, {}),
    ]
    assert rerun(record) is None
