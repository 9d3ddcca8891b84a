"""The add-on Game: roles, captures, score, who has won; and robots that are held."""

import numpy as np
import pytest

from mars2d import Holonomic, InputError, Robot, Scenario, World
from mars2d.addons import Game
from tests.cases import each_case
from tests.worlds import finished

ROLES = {"pursuer": ["red"], "evader": ["blue"]}


def right(_):
    return 0.5, 0.0


def still(_):
    return 0.0, 0.0


def chase(game=None, evaders=((2.0, 0.0),), stop_time=10.0, **fields):
    """Red drives to the right at 0.5 m/s from (0, 0), along evaders that stand still."""
    robot = Robot(drive=Holonomic(), mass=1.0)
    names = ["blue", "green", "pink"]
    team = [
        robot.replace(name=name, controller=still).at(*place)
        for name, place in zip(names, evaders, strict=False)
    ]
    red = robot.replace(name="red", controller=right)
    roles = {"pursuer": ["red"], "evader": names[: len(team)]}
    return Scenario(
        robots=[red, *team],
        addons=[game or Game(roles)],
        workspace=None,
        stop_time=stop_time,
        **fields,
    )


# -- captures -----------------------------------------------------------------------------------


@each_case("physics", ["contact", "stop", "ideal"])
def test_contact_is_a_capture_when_the_robots_touch(physics):
    world = finished(chase(physics=physics))
    game = world.addons.game
    assert game.capture_times == pytest.approx([(2.0 - 0.3) / 0.5], abs=1e-3)
    assert game.captures[0][1:] == (0, 1)
    assert (game.winner, game.caught, game.free) == ("pursuer", (1,), ())
    assert game.score == {"pursuer": 1, "evader": 0}
    assert world.over_message == "red catches blue after 3.4 s: pursuer wins"


def test_a_distance_is_a_capture_at_the_first_control_step_within_it():
    world = finished(chase(Game(ROLES, capture=1.02)))
    assert world.addons.game.capture_times == (2.0,)  # 1 m away; one step before it was 1.05
    assert world.over_message == "red catches blue after 2 s: pursuer wins"


def test_a_capture_after_the_par_is_too_late_and_the_run_may_go_on_until_it():
    world = finished(chase(Game(ROLES, par=2.0, to_the_end=True)))
    assert world.over_message == "red catches blue after 3.4 s, not within 2 s: evader wins"
    outcome = world.addons.game.outcome(world.record)
    assert (outcome.winner, outcome.payoff) == ("evader", pytest.approx(3.4, abs=1e-3))
    world = finished(chase(Game(ROLES, par=2.0)))
    assert world.over_message == "blue was not caught in 2.1 s: evader wins"
    assert world.addons.game.outcome(world.record).winner == "evader"
    assert finished(chase(Game(ROLES, par=3.5))).addons.game.winner == "pursuer"
    assert Game(ROLES, par=2.0).aim("pursuer", world.scenario) == "catch blue within 2 s"


def test_nobody_has_won_before_the_end_nor_when_something_else_ends_it():
    world = World(chase())
    for _ in range(5):
        world.step()
    assert world.addons.game.winner is None
    world.stop("enough")
    assert world.addons.game.winner is None
    assert world.addons.game.outcome(world.record).winner is None


def test_the_caught_stand_still_while_the_game_goes_on():
    fleeing = chase(evaders=[(1.0, 0.2), (6.0, -0.2)], physics="ideal", stop_time=20.0)
    robots = [fleeing.robots[0], *(r.replace(controller=right) for r in fleeing.robots[1:])]
    slow = Holonomic(max_linear_speed=0.2)
    robots = [robots[0], *(r.replace(drive=slow) for r in robots[1:])]
    world = finished(fleeing.replace(robots=robots))
    game, record = world.addons.game, world.record
    assert game.caught == (1, 2)
    caught, over = np.searchsorted(record.time, game.capture_times)
    assert over > caught + 10
    assert (record.command[:caught, 0, 1] == 0.2).all()
    assert (record.command[caught:, :, 1] == 0).all()
    assert np.ptp(record.pose[caught:, 0, 1]) == 0
    assert (record.command[:over, 0, 2] == 0.2).all()
    assert "catches green, the last of 2, after" in world.over_message


def test_the_nearest_of_several_hunters_is_the_one_who_catches():
    robot = Robot(drive=Holonomic())
    scenario = Scenario(
        robots=[robot.at(-1, 0), robot.at(0.6, 0), robot.at(0, 0)],
        addons=[Game({"hunters": range(2), "prey": [2]}, capture=1.5)],
    )
    assert World(scenario).over is False
    world = finished(scenario)
    assert world.over_message == "robot1 catches robot2 after 0 s: hunters win"


@each_case(("capture", "alone", "both", "last"), [(0.5, 3.0, 7.0, 0), ("contact", 3.4, 7.4, 1)])
def test_it_may_take_two_hunters_at_once(capture, alone, both, last):
    def near(robot):
        x = float(robot.pose[0])
        return (0.0 if abs(x) < 0.3 else -np.sign(x) * 0.5), 0.0

    robot = Robot(drive=Holonomic(), controller=near)
    wait = robot.replace(controller=still)
    for together, when, who in [(1, alone, 0), (2, both, last)]:  # the nearest, who touches last
        game = Game({"hunters": [0, 1], "prey": [2]}, capture=capture, together=together)
        robots = [robot.at(-2, 0), robot.at(4, 0), wait.at(0, 0)]
        record = finished(Scenario(robots=robots, addons=[game], stop_time=10)).record
        (caught,) = game.outcome(record).captures
        assert (caught.hunter, caught.evader) == (who, 2)
        assert caught.time == pytest.approx(when, abs=0.1)
        assert record.time[-1] == pytest.approx(caught.time, abs=0.11)
    with pytest.raises(InputError, match=r"Game.together = 3: expected at most 2"):
        World(Scenario(robots=robots, addons=[game.replace(together=3)]))


def test_contacts_with_others_are_no_captures():
    """Two hunters, then two evaders, touch each other: nobody is caught."""
    robot = Robot(drive=Holonomic(), controller=right)
    wait = robot.replace(controller=still)
    scenario = Scenario(
        robots=[robot.at(0, 0), wait.at(1, 0), robot.at(0, 3), wait.at(1, 3)],
        addons=[Game({"pursuer": [0, 1], "evader": [2, 3]})],
        stop_time=3.0,
    )
    record = finished(scenario).record
    assert record.collisions == 2
    assert scenario.addons[0].outcome(record).captures == ()


# -- what is refused ----------------------------------------------------------------------------


@each_case(
    ("roles", "words"),
    [
        ({"pursuer": ["red"]}, "two roles"),
        ({"pursuer": "red", "evader": ["blue"]}, r"Game.roles\['pursuer'\] = 'red'"),
        ({1: ["red"], "evader": ["blue"]}, "two roles"),
        ({"pursuer": [5], "evader": ["blue"]}, "no robot 5; they are 0 to 1"),
        ({"pursuer": ["red", 0], "evader": ["blue"]}, "red stands twice as pursuer"),
    ],
)
def test_roles_that_can_not_be_are_refused_in_words(roles, words):
    with pytest.raises(InputError, match=words):
        World(chase(Game(roles)))
