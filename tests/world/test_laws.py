"""Laws: functions or generators, of a robot or of the team, and what they may see."""

from __future__ import annotations

import numpy as np
import pytest

import mars2d
from mars2d import LawError, Robot, Scenario, World
from tests.cases import each_case


def team(*laws, **fields) -> Scenario:
    robots = [Robot(pose=(0, i, 0), controller=law, **fields) for i, law in enumerate(laws)]
    return Scenario(robots=robots, stop_time=0.5)


# -- kinds of laws --------------------------------------------------------------------------


def test_a_law_can_be_a_generator_with_a_memory_of_its_own():
    def steps(robot):
        for speed in (0.1, 0.2, 0.3):
            yield speed, 0
        while True:
            yield 0, robot.time

    speeds = mars2d.run(team(steps)).command[:, :, 0]
    assert speeds[:, 0] == pytest.approx([0.1, 0.2, 0.3, 0, 0, 0])
    assert speeds[3:, 1] == pytest.approx([0.3, 0.4, 0.5])


def test_when_a_generator_returns_its_robot_stands_still():
    def brief(_robot):
        yield 0.3, 0.1

    record = mars2d.run(team(brief))
    assert record.command[0, :, 0].tolist() == [0.3, 0.1]
    assert not record.command[1:].any()
    assert record.finished


def test_a_law_can_be_any_callable():
    class Cruise:
        def __init__(self, speed):
            self.speed = speed

        def __call__(self, robot):
            return self.speed, 0

    assert mars2d.run(team(Cruise(0.25))).command[0, 0, 0] == 0.25


def test_a_robots_own_law_overrides_its_column_of_the_teams():
    scenario = Scenario(
        robots=[Robot(), Robot(pose=(1, 0, 0), controller=lambda _robot: (0.3, 0.2))], stop_time=0
    )
    record = mars2d.run(scenario, control=lambda _world: [[0.1, 0.1], [0, 0]])
    assert record.command[0].tolist() == [[0.1, 0.3], [0, 0.2]]


@each_case(
    "value",
    [(0.2, 0.1), [0.2, 0.1], np.array([0.2, 0.1]), np.array([[0.2], [0.1]]),
     (np.float64(0.2), np.float64(0.1))],
)  # fmt: skip
def test_a_robots_command_is_two_numbers_in_any_container(value):
    assert mars2d.run(team(lambda _robot: value)).command[0].ravel().tolist() == [0.2, 0.1]


# -- messages -------------------------------------------------------------------------------


@each_case(
    ("value", "message"),
    [
        (None, "returned nothing: a law returns its command, such as `return v, omega`"),
        ((1, 2, 3), r"returned \(1, 2, 3\): expected two numbers"),
        ("12", "returned '12': expected two numbers"),
        ((True, False), "expected two numbers"),
        ({0.1, 0.2}, "expected two numbers"),
    ],
)
def test_what_is_no_command_says_what_was_returned_and_by_which_law(value, message):
    def wander(_robot):
        return value

    with pytest.raises(LawError, match=message) as raised:
        mars2d.run(team(wander))
    assert str(raised.value).startswith("test_laws.py, line ")
    assert "wander returned" in str(raised.value)


@each_case(
    ("value", "message"),
    [
        (None, "returned nothing: a law returns its command, an array"),
        (np.zeros((2, 2)), r"shape \(2, 2\): expected two rows and a column for each robot"),
        ([["a", "b", "c"]] * 2, "expected two rows"),
        ([[1, 2, 3], [4]], "expected two rows"),
        ([[1j, 0, 0], [0, 0, 0]], "expected two rows"),
    ],
)
def test_what_is_no_command_of_the_team_says_so_as_well(value, message):
    with pytest.raises(LawError, match=message) as raised:
        mars2d.run(Scenario(robots=3), control=lambda _world: value)
    assert str(raised.value).startswith("test_laws.py, line ")


def test_a_law_that_raises_is_shown_with_its_innermost_own_line():
    def helper():
        return np.linalg.inv(np.zeros((2, 2)))  # raises in numpy: this line counts

    def law(_robot):
        return helper()

    with pytest.raises(LawError, match="law raised LinAlgError: Singular matrix") as raised:
        mars2d.run(team(law))
    line = helper.__code__.co_firstlineno + 1
    assert raised.value.where == f"test_laws.py, line {line}"
    assert isinstance(raised.value.__cause__, np.linalg.LinAlgError)


# -- what a law may see ---------------------------------------------------------------------


def test_memory_is_kept_between_steps_and_belongs_to_one_robot():
    def law(robot):
        robot.memory.count = getattr(robot.memory, "count", 0) + 1
        return 0.01 * robot.memory.count, 0

    record = mars2d.run(team(law, law))
    assert record.command[:, 0] == pytest.approx(0.01 * np.arange(1, 7)[:, None] * [1, 1])


def test_the_last_command_is_the_one_issued_after_saturation():
    seen = []

    def law(robot):
        seen.append(robot.command[0])
        return 9, 0

    mars2d.run(team(law))
    assert seen == [0, 0.5, 0.5, 0.5, 0.5, 0.5]


def test_the_law_of_the_team_finds_robots_and_addons_of_the_world():
    class Flag(mars2d.Addon):
        def on_start(self, world):
            self.up = 7

    seen = []

    def control(world):
        seen.append((len(world.robots), world.addons.flag.up, world.rng.random() < 1))
        return np.zeros((2, 2))

    mars2d.run(Scenario(robots=2, addons=[Flag()], stop_time=0), control=control)
    assert seen == [(2, 7, True)]
    with pytest.raises(LawError, match="no add-on 'flg'; did you mean 'flag'"):
        World(Scenario(addons=[Flag()])).addons.flg  # noqa: B018
