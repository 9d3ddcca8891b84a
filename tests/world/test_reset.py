"""A world starts again as a new one would, steps some robots by name, and may keep no record."""

from __future__ import annotations

import numpy as np
import pytest

from mars2d import Differential, Robot, Scenario, World
from mars2d.addons import Game
from mars2d.bodies.props import Box
from mars2d.core.errors import InputError
from mars2d.sensors import RangeFinder
from tests.cases import each_case


def wander(robot):
    return 0.3, robot.rng.normal()


def scenario(**changes):
    robot = Robot(
        drive=Differential(noise=0.05), sensors=[RangeFinder(beams=5, noise=0.01)],
        controller=wander,
    )  # fmt: skip
    fields = {
        "robots": [robot.replace(name="red").at(-1, 0, 0), robot.replace(name="blue").at(1, 0, 3)],
        "props": [Box(name="crate", pose=(0, 0.4, 0), length=0.4, width=0.3)],
        "workspace": [(-2, -2), (2, -2), (2, 2), (-2, 2)],
        "on_exit": "wall",
        "stop_time": 8.0,
        "addons": [Game({"pursuer": ["red"], "evader": ["blue"]})],
    }
    return Scenario(**{**fields, **changes})


def ended(world):
    while not world.over:
        world.step()
    return world.record


@each_case("steps", [0, 7, 1000])
@each_case("seed", [None, 5])
def test_the_run_after_a_reset_is_that_of_a_new_world(steps, seed):
    world = World(scenario(), seed=3)
    for _ in range(steps):
        if not world.over:
            world.step()
    world.reset(seed=seed)
    assert (world.iteration, world.over, len(world.history)) == (0, False, 0)
    assert ended(world).digest == ended(World(scenario(), seed=3 if seed is None else seed)).digest


def test_a_reset_may_take_another_scenario():
    world = World(scenario())
    ended(world)
    other = scenario(robots=[Robot(name="alone", controller=wander)], addons=[], stop_time=2.0)
    world.reset(seed=1, scenario=other)
    assert ended(world).digest == ended(World(other, seed=1)).digest


def test_a_record_from_before_a_reset_stays_as_it_was():
    world = World(scenario())
    before = ended(world)
    digest = before.digest
    world.reset(seed=9)
    ended(world)
    assert before.digest == digest


def test_a_reset_refuses_wrong_seeds_and_scenarios():
    world = World(scenario())
    with pytest.raises(InputError, match="seed"):
        world.reset(seed=-1)
    with pytest.raises(InputError, match="a Scenario"):
        world.reset(scenario="random_walk")
    assert ended(world).digest == ended(World(scenario())).digest


# -- commands by name -----------------------------------------------------------------------------


def test_commands_by_name_leave_the_other_laws_going():
    world, alone = World(scenario()), World(scenario())
    for _ in range(10):
        world.step({"red": (0.1, 0.2)})
        alone.step()
    commands = world.record.command
    np.testing.assert_array_equal(commands[:, :, 0], np.tile([0.1, 0.2], (10, 1)))
    np.testing.assert_array_equal(commands[:, :, 1], alone.record.command[:, :, 1])


WRONG = [
    ({"rad": (1, 0)}, "did you mean 'red'"),
    ({2: (1, 0)}, "2"),
    ({"red": (1, 0, 0)}, r"the command of red was given \(1, 0, 0\): expected two numbers"),
    ({"red": (float("nan"), 0)}, "the command of red was given .*finite"),
    ({"red": None}, "the command of red was given nothing"),
    ({"red": "left"}, "the command of red was given 'left'"),
    ([[1, 0]], "World.step"),
]


def test_a_wrong_command_is_named_and_the_world_goes_on():
    world = World(scenario())
    for command, words in WRONG:
        with pytest.raises(InputError, match=words):
            world.step(command)
    assert ended(world).digest == ended(World(scenario())).digest


# -- without a record -----------------------------------------------------------------------------


def test_without_a_record_the_motion_is_the_same_and_nothing_is_kept():
    world, kept = World(scenario(), record=False), World(scenario())
    while not world.over:
        world.step()
        kept.step()
    np.testing.assert_array_equal(world.pose, kept.pose)
    assert world.over_message == kept.over_message
    assert len(world.history) == 0
    assert world.frame.path.shape == (0, 3, 2)
    with pytest.raises(InputError, match="keeps no record"):
        _ = world.record
