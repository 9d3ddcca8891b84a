"""Add-ons: a closed set of hooks, a live copy in each world."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import mars2d
from mars2d import InputError, LawError, Robot, Scenario, Sensor, World
from mars2d.addons import Addon, Map
from tests.cases import each_case


class Counter(Addon):
    """The add-on of the documentation."""

    start: int = 0

    def on_start(self, world):
        self.steps = self.start

    def on_step(self, world):
        self.steps += 1


def test_an_own_addon_is_a_short_class_that_laws_can_ask():
    world = World(Scenario(addons=[Counter(start=5)]))
    for _ in range(3):
        world.step()
    assert world.addons.counter.steps == 8


@each_case(("hook", "meant"), [("on_stepp", "on_step"), ("on_begin", ""), ("on_steps", "on_step")])
def test_an_unknown_hook_is_an_error_when_the_class_is_written(hook, meant):
    with pytest.raises(InputError, match=f"{hook} is no hook of an add-on.*{meant}"):
        type("Wrong", (Addon,), {hook: lambda self, world: None})


def test_in_a_scenario_an_addon_is_frozen_and_in_a_world_it_is_not():
    counter = Counter()
    with pytest.raises(dataclasses.FrozenInstanceError):
        counter.steps = 1
    scenario = Scenario(addons=[counter])
    World(scenario)
    assert not hasattr(scenario.addons[0], "steps")
    with pytest.raises(dataclasses.FrozenInstanceError):
        scenario.addons[0].steps = 1


def test_an_addon_that_fails_is_named_with_its_line():
    class Fragile(Addon):
        def on_step(self, world):
            raise KeyError("k")

    with pytest.raises(LawError, match=r"add-on 'fragile' raised KeyError: 'k'") as raised:
        mars2d.run(Scenario(addons=[Fragile()]))
    assert "test_addons.py, line" in str(raised.value)


def test_an_addon_can_end_the_experiment():
    class Referee(Addon):
        def on_step(self, world):
            if world.time > 0.45:
                world.stop("the game is over")

    record = mars2d.run(Scenario(addons=[Referee()]))
    assert record.over_message == "the game is over"
    assert record.time[-1] == 0.5


def test_an_addon_can_bring_obstacles_with_their_own_friction():
    class Ice(Addon):
        friction: float = 0.0

        def obstacles(self):
            return [[(-1, 0), (9, 0)]]

    way = {}
    for addon in (Ice(), Ice(friction=1.0)):
        robot = Robot(pose=(0, 0.2, -0.5), drive=mars2d.Holonomic(), friction=1.0)
        world = World(Scenario(robots=[robot], addons=[addon]))
        for _ in range(50):
            world.step([[0.2], [-0.2]])
        way[addon.friction] = world.pose[0, 0]
    assert way[0.0] > way[1.0] + 0.01


def test_all_hooks_are_called_at_their_moments():
    calls = []

    class Witness(Addon):
        def on_start(self, world):
            calls.append("start")

        def on_step(self, world):
            calls.append("step")

        def on_stop(self, world):
            calls.append("stop")

    world = World(Scenario(addons=[Witness()], stop_time=0.1))
    while not world.over:
        world.step()
    assert calls == ["start", "step", "step", "stop"]


# -- sensors and replays ------------------------------------------------------------------------


def test_an_add_on_finds_the_readings_of_this_step_in_on_sensed_and_none_before():
    class Watch(Addon):
        def on_start(self, world):
            self.seen = []

        def on_step(self, world):
            with pytest.raises(AttributeError, match="'clock' has no reading now"):
                _ = world.robots[0].sense.clock

        def on_sensed(self, world):
            self.seen.append((world.time, world.robots[0].sense.clock))

    class Clock(Sensor):
        def read(self, robot, world, rng):
            return world.time

    world = World(Scenario(robots=[Robot(sensors=[Clock()])], addons=[Watch()]))
    for _ in range(3):
        world.step([[0], [0]])
    assert world.addons.watch.seen == [(t, t) for t in (0.0, 0.1, 0.2)]


def test_a_map_takes_walls_of_several_corners_that_stay_open():
    corridor = Map(walls=[[(-5, 1), (2, 1), (2, 5)], [(-5, -1), (4, -1), (4, 5)]])
    assert corridor.obstacles() == (
        ((-5, 1), (2, 1)), ((2, 1), (2, 5)), ((-5, -1), (4, -1)), ((4, -1), (4, 5)),
    )  # fmt: skip
    world = World(Scenario(addons=[corridor]))
    assert world.surroundings.ray((0, 0), 0.0, 9.0, 0) == pytest.approx(4)
    assert world.surroundings.ray((0, 0), np.pi / 2, 9.0, 0) == pytest.approx(1)
