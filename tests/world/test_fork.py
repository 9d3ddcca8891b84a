"""A fork goes on from an instant of a world, and shares nothing with it."""

from __future__ import annotations

import threading
from math import pi

import numpy as np
import pytest

from mars2d import Robot, Scenario, Unicycle, World
from mars2d.addons import Communication
from mars2d.addons.base import Addon
from mars2d.bodies.props import Box
from mars2d.core.errors import InputError
from mars2d.core.plane import rectangle
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment
from mars2d.sensors import Proximity, RangeFinder
from mars2d.world.loop import open_world
from tests.cases import each_case
from tests.physics import test_crowd_fuzz as fuzz
from tests.physics.test_same_bits import assert_same, crowd, restless

GENERATORS = {
    "capture_the_flag", "corner_game", "crowd", "dead_reckoning", "encirclement",
    "follow_the_leader", "guard_the_line", "herding", "hide_and_seek", "homicidal_chauffeur",
    "lion_and_man", "pinned", "plan_push", "pursuit_corners", "pursuit_voronoi", "round_a_pillar",
    "selfish_herd", "straight_chase", "sumo", "token_ring", "two_cars", "wall_follower",
}  # fmt: skip
"""Examples with laws that are generators."""

STEPS = 25

IN_TOUCH = {
    1: {"gap": 0.0, "faults": True, "things": True},
    2: {"gap": 1e-6, "things": True, "command_delay": 0.03},
    3: {"gap": 0.0, "physics": "stop"},
    4: {"gap": 0.0, "max_overlap": 0.02, "faults": True},
    5: {"gap": 0.0, "physics": "ideal", "things": True},
}
"""Crowds, by their seeds."""


def stepped(world, steps=STEPS):
    for _ in range(steps):
        if not world.over:
            world.step()
    return world


@each_case("name", sorted(set(examples()) - GENERATORS))
def test_a_fork_goes_the_way_of_its_world(name):
    world = stepped(open_world(open_experiment(name, seed=0)))
    fork = world.fork()
    before = world.record.digest
    stepped(fork)
    assert world.record.digest == before  # whatever the fork does
    stepped(world)
    assert_same(fork, world)


def crowded(mix, ties):
    return fuzz.crowd(1, mix, 10.0, 0.05, ties=ties)


def pushing(sampling_time):
    """Four robots push two boxes to a wall."""
    return Scenario(
        robots=[Robot(pose=(-0.295, 0.1 * i - 0.2, 0.1 * i), diameter=0.09) for i in range(4)],
        props=[Box(length=0.5, width=0.5), Box(length=0.3, width=0.4, pose=(0.6, 0.1, 0.3))],
        sampling_time=sampling_time, workspace=rectangle(-3, 1.5, -2, 2), on_exit="wall",
    )  # fmt: skip


def cornered(sampling_time):
    """A row of discs drives into a corner."""
    return Scenario(
        robots=[Robot(pose=(0.31 * i - 1, 0.05 * i - 1.5, pi + 0.2 * i)) for i in range(8)],
        sampling_time=sampling_time, workspace=rectangle(-2, 2, -2, 2), on_exit="wall",
    )  # fmt: skip


def spinning(sampling_time):
    """Discs in a row rub against each other."""
    return Scenario(
        robots=[Robot(pose=(0.301 * i, 0.02 * i, 2 * i)) for i in range(5)],
        sampling_time=sampling_time, on_exit="ignore",
    )  # fmt: skip


TOUCHING = [
    *((scene, T) for scene in (pushing, cornered, spinning) for T in (0.005, 0.1, 0.5)),
    *((lambda T, k=k: crowd(k, 8 * k, sampling_time=T, **IN_TOUCH[k]), 0.1) for k in IN_TOUCH),
    *((lambda ties, mix=mix: crowded(mix, ties), ties) for mix in fuzz.MIXES for ties in (0, 1)),
]


@pytest.mark.slow
@each_case(("scene", "argument"), TOUCHING)
def test_in_contact_it_does_so_to_the_bit(scene, argument):
    scenario = scene(argument)
    world = World(scenario, restless(1, scenario), 1)
    touches = 0
    for _ in range(2):  # a rest is among the steps before the fork, or among those after it
        fork = stepped(world).fork()
        for _ in range(15):
            world.step()
            fork.step()
            assert_same(fork, world)
            touches += len(world.contacts)
        world = fork.fork()
    assert touches


@each_case("name", ["sumo", "wall_follower"])
def test_a_generator_that_runs_is_refused_by_name_and_may_be_left_out(name):
    world = stepped(open_world(open_experiment(name, seed=0)))
    with pytest.raises(InputError, match=r"the law \w+ is a generator.*fork\(laws=False\)"):
        world.fork()
    fork = world.fork(laws=False)
    fork.step()
    assert not fork.command.any()
    assert world.record.finished == world.finished


class Counting:
    """A law that is an object, and counts."""

    def __init__(self):
        self.count = 0

    def __call__(self, robot):
        self.count += 1
        robot.memory.count = getattr(robot.memory, "count", 0) + 1
        robot.send(self.count)
        return 0.1, 0.2 * robot.rng.normal()


class Stopwatch(Addon):
    """Counts control steps in a list."""

    def on_start(self, world):
        self.seen = []

    def on_step(self, world):
        self.seen.append(world.time)


def remembering():
    robot = Robot(
        drive=Unicycle(noise=0.02, dead_time=0.3),
        sensors=[
            RangeFinder(beams=4, noise=0.1, latency=0.2),
            Proximity(range=0.5, recorded=False),
        ],
        controller=Counting(),
    )
    return Scenario(
        robots=[robot.replace(name="a"), robot.replace(name="b", controller=Counting()).at(2, 1)],
        addons=[Communication(delay=0.4, loss=0.3), Stopwatch()],
        stop_time=60.0,
    )


def test_all_that_remembers_is_copied():
    world = stepped(World(remembering(), seed=4))
    fork = world.fork()
    assert fork.scenario is world.scenario
    stepped(fork)
    assert len(world.addons.stopwatch.seen) == STEPS
    assert [robot.memory.count for robot in world.robots] == [STEPS, STEPS]
    assert world.scenario.robots[0].controller.count == STEPS
    assert_same(fork, stepped(world))
    assert fork.addons.stopwatch.seen == world.addons.stopwatch.seen
    for mine, theirs in zip(fork.robots, world.robots, strict=True):
        assert mine.memory.count == theirs.memory.count == 2 * STEPS
        assert mine.inbox == theirs.inbox
        np.testing.assert_array_equal(mine.sense.range_finder, theirs.sense.range_finder)


def test_a_fork_forks_and_resets():
    world = stepped(World(remembering(), seed=4))
    twice = world.fork().fork()
    assert_same(stepped(twice), stepped(world))
    twice.reset()
    assert twice.iteration == 0


def test_a_law_plans_by_forks_and_its_world_goes_on_as_without():
    def plan(world):
        ends = []
        for omega in (-1.0, 0.0, 1.0):
            trial = world.fork(laws=False)
            for _ in range(5):  # also at the end of the run
                trial.step([[0.5], [omega]])
            ends.append(float(trial.pose[2, 0]))
        assert ends[0] < ends[1] < ends[2]
        return 0.5, (-1.0, 0.0, 1.0)[int(np.argmax(ends))]

    scenario = Scenario(robots=[Robot(pose=(0, 0, 0))], stop_time=1.0)
    planned, plain = World(scenario, plan), World(scenario, lambda world: (0.5, 1.0))
    for world in (planned, plain):
        while not world.over:
            world.step()
    np.testing.assert_array_equal(planned.record.pose, plain.record.pose)


class Locked(Addon):
    """Holds something that can't be copied."""

    def on_start(self, world):
        self.lock = threading.Lock()


def test_what_can_not_be_copied_is_named():
    world = World(Scenario(addons=[Locked()]))
    with pytest.raises(InputError, match=r"the add-on 'locked' can't be copied: .*lock"):
        world.fork()
    law = Counting()
    law.lock = threading.Lock()
    with pytest.raises(InputError, match=r"the law \w+ can't be copied: .*fork\(laws=False\)"):
        World(Scenario(robots=[Robot(controller=law)])).fork()
