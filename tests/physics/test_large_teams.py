"""Large teams fall into islands: what happens to a robot is what happens to it alone."""

from __future__ import annotations

import numpy as np
from scenes import team
from worlds import deepest, world_of

from mars2d import Holonomic, Robot, Scenario, World
from tests.cases import each_case

MANY = 80


@each_case("drive", [None, Holonomic()])
def test_two_robots_of_a_large_team_meet_as_two_robots_alone(drive):
    """They begin at both ends of a column between which nobody stands."""
    length, options = 27.0, {} if drive is None else {"drive": drive}
    down = np.pi / 2 if drive is None else 0.0
    left = Robot(pose=(0.02, 0.0, down), mass=1.5, **options)
    right = Robot(pose=(-0.03, length, -down), **options)
    others = [Robot(pose=(3.0 + 3.0 * (i % 8), 3.0 * (i // 8), 0.0)) for i in range(MANY - 2)]
    large, alone = (
        World(Scenario(robots=team, on_exit="ignore", sampling_time=0.05, stop_time=100))
        for team in ([left, *others, right], [left, right])
    )
    who, command = [0, MANY - 1], np.zeros((2, MANY))
    if drive is None:
        command[0, who] = 0.4
    else:
        command[1, who] = 0.4, -0.4
    met, start = 0, large.pose
    while alone.time < length / 0.8 + 6:
        large.step(command)
        alone.step(command[:, who])
        assert np.array_equal(large.pose[:, who], alone.pose)
        assert np.array_equal(large.effort[who], alone.effort)
        met += len(alone.contacts)
        for field in ("time", "duration", "point", "normal", "impulse", "speed", "began", "ended"):
            assert np.array_equal(large.contacts[field], alone.contacts[field]), field
    assert met > 50
    assert np.array_equal(large.pose[:, 1:-1], start[:, 1:-1])


def test_a_large_crowd_stays_within_its_walls_and_its_overlap():
    scene = team(200, 0.05)
    world = world_of(scene)
    poses = []
    for _ in range(100):
        world.step()
        poses.append(world.pose)
    assert len(world.record.contacts) > 1000
    assert deepest(scene, np.array(poses)) < 1e-3
