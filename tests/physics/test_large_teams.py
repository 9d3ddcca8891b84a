"""Large teams fall into islands: what happens to a robot is what happens to it alone."""

from __future__ import annotations

import numpy as np
import pytest
from scenes import team
from worlds import deepest, world_of

from mars2d import Holonomic, Robot, Scenario, World
from mars2d.sensors import Proximity, RangeFinder
from tests.cases import each_case

MANY = 80
APART = 3.0
ROW = 8
"""How many robots stand in a row of the large teams here."""


def place(i: int) -> tuple[float, float]:
    """Return where the i-th robot of a large team stands."""
    return APART * (i % ROW), APART * (i // ROW)


def standing(**robots: Robot) -> list[Robot]:
    """Return a large team that stands on a grid, but for some robots: i=robot, by "r17" say."""
    team = [Robot(pose=(*place(i), 0.0)) for i in range(MANY)]
    for name, robot in robots.items():
        team[int(name[1:])] = robot
    return team


def scenario(robots: list[Robot], **settings) -> Scenario:
    return Scenario(robots=robots, on_exit="ignore", sampling_time=0.05, stop_time=100, **settings)


def duel(left: Robot, right: Robot) -> tuple[World, World, list[int]]:
    """Return a large team of which two robots move towards each other, and these two alone.

    They stand at opposite ends of the grid's first column, and the way between is free.
    """
    rows = MANY // ROW
    i, j = 0, ROW * (rows - 1)
    column = {f"r{ROW * k}": Robot(pose=(-50.0 - k, 0.0, 0.0)) for k in range(1, rows - 1)}
    large = standing(**column, **{f"r{i}": left, f"r{j}": right})
    return World(scenario(large)), World(scenario([left, right])), [i, j]


@each_case("drive", [None, Holonomic()])
def test_two_robots_of_a_large_team_meet_as_two_robots_alone(drive):
    length = APART * (MANY // ROW - 1)
    options = {} if drive is None else {"drive": drive}
    down = np.pi / 2 if drive is None else 0.0
    left = Robot(pose=(0.02, 0.0, down), mass=1.5, **options)
    right = Robot(pose=(-0.03, length, -down), **options)
    large, alone, who = duel(left, right)
    command = np.zeros((2, MANY))
    if drive is None:
        command[0, who] = 0.4
    else:
        command[1, who] = 0.4, -0.4
    met = 0
    while alone.time < length / 0.8 + 6:
        large.step(command)
        alone.step(command[:, who])
        assert np.array_equal(large.pose[:, who], alone.pose)
        assert np.array_equal(large.effort[who], alone.effort)
        met += len(alone.contacts)
        for field in ("time", "duration", "point", "normal", "impulse", "speed", "began", "ended"):
            assert np.array_equal(large.contacts[field], alone.contacts[field]), field
    assert met > 50
    others = np.delete(np.arange(MANY), who)
    start = np.array([robot.pose for robot in large.scenario.robots]).T
    assert np.array_equal(large.pose[:, others], start[:, others])


def test_a_large_crowd_stays_within_its_walls_and_its_overlap():
    scene = team(200, 0.05)
    world = world_of(scene)
    poses = []
    for _ in range(100):
        world.step()
        poses.append(world.pose)
    assert len(world.record.contacts) > 1000
    assert deepest(scene, np.array(poses)) < 1e-3


def test_sensors_of_a_large_team_see_robots_where_they_are():
    seeing = Robot(
        pose=(*place(5), np.pi / 2),
        sensors=[Proximity(range=0.5), RangeFinder(beams=1, range=5.0)],
    )
    coming = Robot(pose=(place(5)[0], 2.0, -np.pi / 2))
    world = World(scenario(standing(r5=seeing, **{f"r{5 + ROW}": coming})))
    command = np.zeros((2, MANY))
    command[0, 5 + ROW] = 0.4
    for _ in range(80):
        world.observe()
        gap = world.pose[1, 5 + ROW] - world.robots[5].radius
        sense = world.robots[5].sense
        assert sense.range_finder[0] == pytest.approx(gap, abs=1e-9)
        assert sense.proximity == (gap < 0.5)
        ray = world.surroundings.ray(place(5), np.pi / 2, 5.0, 5)
        assert ray == pytest.approx(gap, abs=1e-9)
        world.step(command)
