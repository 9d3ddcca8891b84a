"""Remarks on what is legal and hardly meant: when they come, and when not."""

from math import pi
from time import process_time

import numpy as np

from mars2d import Dubins, Holonomic, Robot, Scenario, Unicycle
from mars2d.bodies import Box
from mars2d.cli.command_line import main
from mars2d.cli.remarks import Run, before
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.sensors import RangeFinder
from mars2d.world.loop import simulate
from tests.cases import each_case


@each_case("theta", [90, -180, 45, 360, 30])
def test_a_pose_in_degrees_is_remarked(theta):
    (told,) = before(Experiment(Scenario(robots=[Robot(name="red", pose=(0, 0, theta))])))
    assert told.startswith(f"red starts at theta = {theta} rad, ")
    assert told.endswith(f"write np.radians({theta})")


@each_case("theta", [0, pi, -3 * pi, 7, 14.0, np.radians(90), 20 * pi, 44.9])
def test_a_pose_in_radians_is_not(theta):
    assert [*before(Experiment(Scenario(robots=[Robot(pose=(0, 0, theta))])))] == []


def remarks(drive, command, steps=20):
    """Return the remarks on a run under a law."""
    watched = Run()
    robot = Robot(name="red", drive=drive, controller=lambda robot: command(robot.time))
    simulate(Experiment(Scenario(robots=[robot], stop_time=0.1 * steps)), watchers=[watched])
    return [*watched.remarks()]


def test_most_commands_far_beyond_the_bounds_are_told_with_what_they_mean():
    (told,) = remarks(Unicycle(max_linear_speed=0.5), lambda t: (3.0, 2.0))
    assert told == (
        "100% of the commands of red were cut by the drive's bounds, "
        "Unicycle(max_linear_speed=0.5): they mean v [m/s] and omega [rad/s], "
        "and the last was (3, 2)"
    )


@each_case(
    "drive, command",
    [
        (Unicycle(max_linear_speed=0.5), lambda t: (0.5, 0.0)),  # the bound itself
        (Unicycle(max_linear_speed=0.5), lambda t: (0.9, 0.0)),  # a gain that is a little high
        (Unicycle(max_linear_speed=0.5), lambda t: (2.0 if t < 0.85 else 0.2, 0.0)),  # 9 of 21
        (Holonomic(max_linear_speed=1.0), lambda t: (0.6, 0.8)),
        (Holonomic(max_linear_speed=1.0), lambda t: (60, 80)),  # at full speed in this direction
        (Dubins(max_angular_speed=0.5), lambda t: (1, 90)),  # as sharply as it can
    ],
)
def test_commands_within_the_bounds_and_a_few_beyond_are_not(drive, command):
    assert remarks(drive, command) == []


@each_case("spin", [90, 84.4, -31])
def test_commands_that_look_like_degrees_a_second_are_told(spin):
    told = remarks(Unicycle(max_linear_speed=0.5), lambda t: (0.1, spin))
    assert told[0].startswith(f"red was given omega = {spin:g} rad/s, ")
    assert told[0].endswith(f"if degrees are meant, write np.radians({spin:g})")


def experiment(robot, **scenario):
    """Return the remarks on a run of one robot."""
    watched = Run()
    found = Scenario(**{"robots": [robot], "stop_time": 2.0} | scenario)
    simulate(Experiment(found), watchers=[watched])
    return [*watched.remarks()]


def ahead(robot):
    return 0.5, 0.0


def test_a_prop_that_the_floor_holds_is_told_with_both_forces():
    red = Robot(name="red", controller=ahead)
    crate = Box(name="crate", pose=(0.5, 0, 0), mass=10)
    (told,) = experiment(red, props=[crate])
    assert told.startswith(
        "crate did not move: the floor holds 49.1 N, and the drives of red push 5 N"
    )
    for moved in (crate.replace(mass=0.5), crate.replace(ground_friction=0.04)):
        assert experiment(red, props=[moved]) == []
    assert experiment(red, props=[crate.at(0.5, 3)]) == []  # nobody pushed it


def test_an_edge_that_a_robot_does_not_see_is_told():
    red = Robot(name="red", pose=(4.5, 0, 0), controller=ahead, sensors=[RangeFinder(range=1)])
    (told,) = experiment(red)
    assert told == (
        "red left the workspace, whose edge its range_finder does not see: "
        "Scenario(on_exit='wall') makes it a wall"
    )
    assert experiment(red, on_exit="wall") == []
    assert experiment(red.replace(sensors=[])) == []


def test_a_law_that_takes_many_times_its_step_is_told():
    def slow(robot):
        end = process_time() + 2e-3
        while process_time() < end:
            pass
        return 0.1, 0.0

    (told,) = experiment(Robot(controller=slow), sampling_time=1e-4, stop_time=1e-3)
    assert "times its 0.0001 s: a real robot would get its commands too late" in told


def test_check_lists_them_as_hints(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "walk.py").write_text(
        "from mars2d import Robot, Scenario\n"
        "scenario = Scenario(robots=[Robot(name='red', pose=(0, 0, 90))], stop_time=1)\n"
    )
    assert main(["check", "walk.py"]) == 0
    assert "hint        red starts at theta = 90 rad, 14.3 turns" in capsys.readouterr().out


def test_calls_that_would_wait_are_named_with_their_lines(tmp_path):
    (tmp_path / "waits.py").write_text(
        "import time\nfrom mars2d import Robot, Scenario\nimport matplotlib.pyplot as plt\n"
        "def speed():\n    return float(input())\n"
        "def go(robot):\n    time.sleep(0.1)\n    plt.show()\n    return speed(), 0\n"
        "scenario = Scenario(robots=[Robot(controller=go)])\n"
    )
    told = [*before(open_experiment(tmp_path / "waits.py"))]
    assert [each.split(";")[0] for each in told] == [
        "waits.py, line 7: time.sleep(): sleep has no meaning in simulated time",
        "waits.py, line 8: plt.show(): nothing is shown while a simulation runs",
        "waits.py, line 5: input(): nobody answers while a simulation runs",
    ]
