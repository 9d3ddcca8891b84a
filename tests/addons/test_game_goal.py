"""The add-on Game where evaders have a goal, are seen, are helped, or where some are enough."""

from itertools import groupby

import numpy as np
import pytest

from mars2d import Holonomic, InputError, Robot, Scenario, World
from mars2d.addons import Game, Map
from mars2d.addons.contest import carrier_after
from mars2d.core.scene import Circle, Line, Scene, Text
from mars2d.sensors import RangeBearing
from tests.cases import each_case
from tests.worlds import finished

GOAL, LEFT = ([(x, -5), (x + 3, -5), (x + 3, 5), (x, 5)] for x in (2, -4))


def going(vx):
    return lambda _: (vx, 0.0)


def race(speeds, hunter=0.0, *, stop_time=10.0, workspace=None, starts=None, **game):
    """Evaders side by side go to the right [m/s] towards the goal; a hunter runs on y = 0."""
    robot = Robot(drive=Holonomic(max_linear_speed=2.0), diameter=0.2)
    names = [f"b{k}" for k in range(len(speeds))]
    team = [
        robot.replace(name=name, controller=going(speed)).at(x, 0.5 * k + 0.5)
        for k, (name, speed, x) in enumerate(
            zip(names, speeds, starts or [0.0] * len(speeds), strict=True)
        )
    ]
    roles = {"guard": ["red"], "attacker": names}
    fields = {"capture": 0.6, "goal": GOAL, **game}
    return Scenario(
        robots=[robot.replace(name="red", controller=going(hunter)).at(-4, 0), *team],
        addons=[Game(roles, **fields)],
        workspace=workspace,
        stop_time=stop_time,
    )


# -- a goal -------------------------------------------------------------------------------------


def test_an_evader_whose_middle_is_in_the_goal_is_safe_stands_still_and_has_won():
    world = finished(race([0.5]))
    game = world.addons.game
    assert world.over_message == "b0 has reached the goal after 4 s: attacker wins"
    assert (game.winner, game.safe, game.free, game.caught) == ("attacker", (1,), (), ())
    assert game.score == {"guard": 0, "attacker": 1}
    assert np.isnan(game.outcome(world.record).capture_time)


def test_where_nobody_is_caught_bodies_alone_keep_evaders_from_their_goal():
    """The hunter drives against the evader, head-on and as strong."""
    scenario = race([0.5, 0.5], -0.5, capture=None, hunted=["b0"])
    red, blue, other = scenario.robots
    for x, winner in ((1.0, "guard"), (-3.0, "attacker")):
        world = finished(scenario.replace(robots=[red.at(x, 0.5), blue, other]))
        assert (world.addons.game.winner, world.addons.game.caught) == (winner, ())
        assert world.addons.game.outcome(world.record).winner == winner


def test_some_are_safe_and_others_caught_and_it_goes_on_until_it_is_decided():
    # red is 0.6 m from b0 and b1 at about 2 s; b1, in the goal before, is safe
    scenario = race([0.0, 1.0, 0.0], 2.0, starts=[-1.0, 1.5, -2.0], wanted=2, capture=0.8)
    world = finished(scenario)
    game = world.addons.game
    assert game.safe == (2,)
    assert world.record.command[10:, 0, 2].tolist() == [0.0] * (len(world.record) - 10)
    assert game.caught == (1,)
    assert game.winner == "guard"  # two were needed, one more is free at the end
    assert world.over_message == "finished after 10 s: guard wins"


def test_the_evaders_have_won_when_too_many_are_safe():
    world = finished(race([1.0, 0.8, 0.0], wanted=2))
    assert world.over_message == "2 of 3 have reached the goal after 2.5 s: attacker wins"


def test_the_hunters_have_won_when_they_have_as_many_as_they_want():
    world = finished(race([0.0, 0.0], 1.0, goal=None, wanted=1, capture=0.7))
    assert world.over_message == "red catches b0, number 1 of 2, after 3.6 s: guard wins"
    assert world.addons.game.score == {"guard": 1, "attacker": 1}
    few = finished(race([0.0, 0.0], 0.0, goal=None, wanted=1))
    assert few.over_message == "2 of 2 were not caught in 10 s: attacker wins"


def test_who_is_caught_before_the_goal_is_not_safe_when_it_is_pushed_in():
    scenario = race([0.0, 0.0], 1.0, starts=[1.7, -3.0], stop_time=8.0)
    red, blue, other = scenario.robots
    robots = [red.at(-4, 0.5), blue.replace(mass=0.2), other.at(-3, 4)]
    game = Game({"guard": ["red"], "attacker": ["b0", "b1"]}, goal=GOAL)
    world = finished(scenario.replace(robots=robots, addons=[game]))
    assert world.record.pose[-1, 0, 1] > 2.0
    for found in (world.addons.game, world.addons.game.outcome(world.record)):
        assert [capture.evader for capture in found.captures] == [1]
        assert found.winner == "guard"
    assert world.addons.game.safe == ()


# -- a flag to carry home -----------------------------------------------------------------------


def carried(capture=0.6, **fields):
    """Blue 0 takes the flag and is caught on its way home; blue 1, who has waited there, is not."""
    scenario = race([1, 0.5], 1.0, stop_time=20.0, capture=capture, home=LEFT, **fields)
    red, *team = scenario.robots
    robots = [
        robot.replace(controller=lambda r, v=v, t=t: (v if r.time < t else -v, 0.0)).at(0, y)
        for robot, v, t, y in zip(team, (1.0, 0.5), (2.5, 6.0), (0.45, 1.5), strict=True)
    ]
    return scenario.replace(robots=[red.at(-4, 0.45), *robots])


@each_case("capture", [0.6, "contact"])
def test_who_carries_a_flag_is_safe_at_home_alone_live_and_in_a_record(capture):
    world, carriers = World(carried(capture)), []
    game = world.addons.game
    while not world.over:
        exits = game.exits_at(world.frame)
        world.step()
        assert carrier_after(exits) == game.carrier
        assert {
            leaving.robot: leaving.result for leaving in exits if leaving.result
        } == game.results
        carriers.append(game.carrier)
    assert [robot for robot, _ in groupby(carriers)] == [None, 1, 2, None]
    assert (game.caught, game.safe, game.winner) == ((1,), (2,), "attacker")
    assert world.over_message == "1 of 2 have brought the flag home after 14 s: attacker wins"
    assert game.outcome(world.record).winner == "attacker"
    assert game.aim("attacker", world.scenario) == "bring the flag home uncaught"


# -- sight --------------------------------------------------------------------------------------

PILLAR = Map([[(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]])


def looking(speed, walls=PILLAR):
    """A hider behind a pillar goes up; a seeker with eyes stands on the other side."""
    robot = Robot(drive=Holonomic(), diameter=0.2, sensors=[RangeBearing(range=20)])
    red = robot.replace(name="red", controller=going(0.0)).at(-2, 0)
    blue = robot.replace(name="blue", controller=lambda _: (0.0, speed)).at(2, 0)
    game = Game({"seeker": ["red"], "hider": ["blue"]}, capture="sight")
    return Scenario(robots=[red, blue], addons=[walls, game], stop_time=10.0)


def test_who_is_seen_is_caught_as_soon_as_no_obstacle_is_between():
    world = finished(looking(0.25))
    # the line from (-2, 0) to (2, y) clears the corner (-0.5, 0.5) from y = 4 / 3 on
    assert world.addons.game.capture_times == pytest.approx([4 / 3 / 0.25], abs=0.1)
    assert world.over_message == "red sees blue after 5.4 s: seeker wins"
    assert world.addons.game.outcome(world.record).winner == "seeker"
    scene = Scene()
    world.scenario.addons[1].draw(scene, world.record.frame(-1))
    assert [type(shape) for shape in scene.shapes] == [Line, Circle, Line, Line, Text]


def test_who_is_not_seen_all_the_time_has_won():
    assert finished(looking(0.0)).over_message == "blue was not seen in 10 s: hider wins"
    assert finished(looking(0.0, Map([]))).over_message.startswith("red sees blue after 0 s")


# -- somebody else is hunted --------------------------------------------------------------------


def test_only_the_hunted_are_caught_and_the_second_role_helps_them():
    scenario = race([0.0, 0.0], 1.0, goal=None, capture=0.7)
    game = Game({"guard": ["red"], "attacker": ["b0"]}, capture=1.1, hunted=["b1"])
    world = finished(scenario.replace(addons=[game]))
    assert world.over_message.startswith("red catches b1 after")
    assert world.addons.game.caught == (2,)
    assert scenario.replace(addons=[game]).addons[0].teams(scenario) == ((0,), (1,))


# -- what is refused ----------------------------------------------------------------------------


@each_case(
    ("fields", "words"),
    [
        ({"goal": [(0, 0), (1, 1)]}, r"Game.goal = .*: expected a polygon's vertices"),
        ({"wanted": 0}, "Game.wanted = 0: expected a whole number from 1"),
        ({"hunted": []}, r"Game.hunted = .*nobody has this role"),
        ({"capture": "sigth"}, "did you mean 'sight'"),
        ({"par": 0}, "Game.par = 0"),
        ({"home": GOAL}, "Game.home = .*: expected a goal, too"),
    ],
)
def test_games_that_can_not_be_are_refused_in_words(fields, words):
    with pytest.raises(InputError, match=words):
        Game({"guard": ["red"], "attacker": ["b0"]}, **fields)
