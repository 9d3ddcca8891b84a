"""The same scenario, seed and version give the same run, to the last bit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d import Holonomic, Robot, Scenario, World
from mars2d.sensors import Proximity, Sensor

BUSTLE = Path(__file__).parent / "bustle" / "bustle.py"

CODE = f"""
import mars2d
for discs in (False, True):
    record = mars2d.run({str(BUSTLE)!r}, seed=5, options={{"discs": discs}})
    print(record.digest, record.collisions)
"""


def test_processes_with_other_hash_seeds_give_the_same_digests(child):
    results = [child(CODE, PYTHONHASHSEED=seed) for seed in ("0", "1", "2", "4242", "random")]
    for result in results:
        assert result.returncode == 0, result.stderr
    printed = {result.stdout for result in results}
    assert len(printed) == 1
    words = printed.pop().split()
    assert [len(digest) for digest in words[::2]] == [64, 64]
    assert all(int(collisions) >= 5 for collisions in words[1::2])  # something happens


def wander(robot):
    return 0.3, robot.rng.normal()


def crowd(**fields) -> Scenario:
    robots = [
        Robot(pose=(0.4 * x, 0.4 * y, x), controller=wander, **fields)
        for x in range(3)
        for y in range(3)
    ]
    box = [(-0.5, -0.5), (1.5, -0.5), (1.5, 1.5), (-0.5, 1.5)]
    return Scenario(robots=robots, workspace=box, on_exit="wall", stop_time=3)


def test_running_twice_gives_the_same_and_other_seeds_give_others():
    first, second = mars2d.run(crowd(), seed=1), mars2d.run(crowd(), seed=1)
    assert first.digest == second.digest
    assert first.collisions > 0
    assert len({mars2d.run(crowd(), seed=seed).digest for seed in range(6)}) == 6


def test_worlds_stepped_in_turn_give_what_each_gives_alone():
    alone = [mars2d.run(crowd(), seed=seed).digest for seed in (1, 2)]
    worlds = [World(crowd(), seed=seed) for seed in (1, 2)]
    while not worlds[0].over:
        for world in worlds:
            world.step()
    assert [world.record.digest for world in worlds] == alone


def test_a_sensor_more_changes_neither_noise_nor_laws():
    class Noise(Sensor):
        def read(self, robot, world, rng):
            return rng.normal()

    plain = mars2d.run(crowd(sensors=[Noise()]), seed=3)
    more = mars2d.run(crowd(sensors=[Noise(name="first"), Noise(), Proximity(range=1)]), seed=3)
    assert np.array_equal(plain.pose, more.pose)
    assert np.array_equal(plain.sensors["noise"], more.sensors["noise"])


def test_a_robot_more_changes_no_other_robots_stream():
    few = Scenario(robots=[Robot(controller=wander)], stop_time=1)
    more = Scenario(
        robots=[Robot(controller=wander), Robot(pose=(2, 2, 0), controller=wander)], stop_time=1
    )
    assert np.array_equal(mars2d.run(few).command[:, :, 0], mars2d.run(more).command[:, :, 0])


def test_the_recorded_commands_alone_give_the_same_run():
    scenario = crowd().replace(command_delay=0.25)
    record = mars2d.run(scenario, seed=4)
    bare = scenario.replace(robots=[robot.replace(controller=None) for robot in scenario.robots])
    world = World(bare)
    for command in record.command:
        world.step(command)
    assert world.record.digest == record.digest


def test_saturated_commands_given_again_are_not_changed():
    rng = np.random.default_rng(0)
    robots = [Robot(), Robot(pose=(3, 0, 0), drive=Holonomic(max_linear_speed=0.37))]
    scenario = Scenario(robots=robots, workspace=None)
    first, second = World(scenario), World(scenario)
    for _ in range(200):
        first.step(rng.uniform(-2, 2, (2, 2)))
    for command in first.record.command:
        second.step(command)
    assert np.array_equal(first.record.command, second.record.command)


def test_global_random_numbers_are_neither_used_nor_changed():
    np.random.seed(0)  # noqa: NPY002 - this is what is tested
    before = np.random.get_state()[1].tolist()  # noqa: NPY002
    digest = mars2d.run(crowd(), seed=1).digest
    assert np.random.get_state()[1].tolist() == before  # noqa: NPY002
    np.random.seed(1)  # noqa: NPY002
    assert mars2d.run(crowd(), seed=1).digest == digest


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(20))
def test_long_crowded_runs_are_the_same_twice(seed):
    scenario = crowd().replace(stop_time=60)
    assert mars2d.run(scenario, seed=seed).digest == mars2d.run(scenario, seed=seed).digest
