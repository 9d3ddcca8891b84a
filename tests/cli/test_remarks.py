"""Remarks on what is legal and hardly meant: when they come, and when not."""

from math import pi
from time import process_time

import numpy as np

from mars2d import Car, Dubins, Holonomic, Omni, Robot, Scenario, Unicycle
from mars2d.addons import Map
from mars2d.bodies import Box, Rope
from mars2d.cli.command_line import main
from mars2d.cli.remarks import after, before
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.sensors import Proximity, RangeFinder
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
    robot = Robot(name="red", drive=drive, controller=lambda robot: command(robot.time))
    return experiment(robot, stop_time=0.1 * steps)


def test_most_commands_far_beyond_the_bounds_are_told_with_what_they_mean():
    (told,) = remarks(Unicycle(max_linear_speed=0.5), lambda t: (3.0, 2.0))
    assert told == (
        "100% of the commands of red were cut by the drive's bounds, "
        "v [m/s] from -0.5 to 0.5 and omega [rad/s] from -5 to 5: the last was (3, 2)"
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


def test_angles_of_steering_and_spins_in_any_direction_are_told_too():
    (told,) = remarks(Car(), lambda t: (0.2, 30))
    assert told.startswith("red was given delta = 30 rad, 4.77 turns; if degrees are meant")
    (told,) = remarks(Omni(), lambda t: (0.2, 0, 90))
    assert told.startswith("red was given omega = 90 rad/s, 14.3 turns; if degrees are meant")
    assert remarks(Car(), lambda t: (0.2, 1.0)) == []


def experiment(robot, **scenario):
    """Return the remarks on a run of one robot."""
    found = Scenario(**{"robots": [robot], "stop_time": 2.0} | scenario)
    return [*after(simulate(Experiment(found)))]


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
    rope = Rope(a="red", b="crate", length=0.6)
    back = red.replace(controller=lambda robot: (-0.5, 0))
    (told,) = experiment(back, props=[crate], joints=[rope])
    assert told.startswith("crate did not move: the floor holds 49.1 N")


def test_a_prop_between_two_others_is_told_with_their_names():
    red, box = Robot(name="red", controller=ahead), Box(name="box", pose=(0.5, 0, 0), mass=1)
    blue = red.replace(name="blue", pose=(1.0, 0, pi))
    (told,) = experiment(red, robots=[red, blue], props=[box.replace(ground_friction=0.1)])
    assert told == "box did not move: it is between red with 5 N and blue with 5 N"
    wall = Map([[(0.7, -1), (0.7, 1)]])
    (told,) = experiment(red, props=[box.replace(ground_friction=0.1, length=0.4)], addons=[wall])
    assert told == "box did not move: it is between obstacle 0 and red with 5 N"


def test_an_edge_that_a_robot_does_not_see_is_told():
    red = Robot(name="red", pose=(4.5, 0, 0), controller=ahead, sensors=[RangeFinder(range=1)])
    (told,) = experiment(red)
    assert told == (
        "red left the workspace, whose edge its range_finder does not see: "
        "Scenario(on_exit='wall') makes it a wall"
    )
    assert experiment(red, on_exit="wall") == []
    assert experiment(red.replace(sensors=[])) == []
    assert "its proximity does not see" in experiment(red.replace(sensors=[Proximity(range=1)]))[0]


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
        "class Go:\n  def __call__(self, robot):\n"
        "    time.sleep(0.1)\n    plt.show()\n    return speed(), 0\n"
        "scenario = Scenario(robots=[Robot(controller=Go())])\n"
    )
    told = [*before(open_experiment(tmp_path / "waits.py"))]
    assert [each.split(";")[0] for each in told] == [
        "waits.py, line 8: time.sleep(): sleep has no meaning in simulated time",
        "waits.py, line 9: plt.show(): nothing is shown while a simulation runs",
        "waits.py, line 5: input(): nobody answers while a simulation runs",
    ]
