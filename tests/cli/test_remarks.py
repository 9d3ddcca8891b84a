"""Remarks on what is legal and hardly meant: when they come, and when not."""

from math import pi

import numpy as np

from mars2d import Holonomic, Robot, Scenario, Unicycle
from mars2d.cli.command_line import main
from mars2d.cli.remarks import Bounds, before
from mars2d.scenario.experiment import Experiment, open_experiment
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
    """Return the remarks on the bounds in a run under a law."""
    bounds = Bounds()
    robot = Robot(name="red", drive=drive, controller=lambda robot: command(robot.time))
    simulate(Experiment(Scenario(robots=[robot], stop_time=0.1 * steps)), watchers=[bounds])
    return [*bounds.remarks()]


def test_most_commands_cut_are_told_with_the_bounds():
    (told,) = remarks(Unicycle(max_linear_speed=0.5), lambda t: (1.0, 0.0))
    assert told == (
        "100% of the commands of red were cut by the drive's bounds, Unicycle(max_linear_speed=0.5)"
    )


@each_case(
    "drive, command",
    [
        (Unicycle(max_linear_speed=0.5), lambda t: (0.5, 0.0)),  # the bound itself
        (Unicycle(max_linear_speed=0.5), lambda t: (2.0 if t < 0.85 else 0.2, 0.0)),  # 9 of 21
        (Holonomic(max_linear_speed=1.0), lambda t: (0.6, 0.8)),
    ],
)
def test_commands_within_the_bounds_and_a_few_beyond_are_not(drive, command):
    assert remarks(drive, command) == []


def test_commands_that_look_like_degrees_a_second_are_told():
    told = remarks(Unicycle(max_linear_speed=0.5), lambda t: (0.1, 90))
    assert told[0] == (
        "red was given omega = 90 rad/s, 14.3 turns; if degrees are meant, write np.radians(90)"
    )
    assert len(remarks(Unicycle(max_linear_speed=100), lambda t: (0.1, 45))) == 1


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
