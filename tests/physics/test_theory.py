"""Contact physics against the textbook: stalemates, restitution, and impacts in chains.

What impacts of two do is in `tests/record/test_impacts.py`, friction in `test_surfaces.py`.
"""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from mars2d import Robot
from mars2d.addons import Map
from mars2d.bodies.props import Ball, Box, Puck, Solid
from mars2d.geometry.shapes import Polygon
from mars2d.record.contact import episodes
from tests.cases import each_case
from tests.worlds import drive, endless

IDLE = Robot(pose=(50, 50, 0))
STILL = [[0], [0]]
TEE = Polygon(
    [(-0.3, -0.05), (0, -0.05), (0, -0.2), (0.1, -0.2), (0.1, 0.2), (0, 0.2), (0, 0.05),
     (-0.3, 0.05)]
)  # fmt: skip
SQUARE = Polygon([(-0.15, -0.15), (0.15, -0.15), (0.15, 0.15), (-0.15, 0.15)])


@each_case(
    ("shape", "between"),
    [(None, ()), (None, (Box(),)), (SQUARE, ()), (SQUARE, (Ball(),)), (SQUARE, (Box(),))],
)
def test_two_equal_robots_head_on_do_not_drift_whatever_is_between(shape, between):
    robots = [Robot(pose=(x, 0, pi * (x > 0)), shape=shape) for x in (-0.6, 0.6)]
    world = endless(robots, [prop.replace(ground_friction=0.1) for prop in between])
    start = drive(world, [[0.3, 0.3], [0, 0]], 5)[-1]
    poses = drive(world, [[0.3, 0.3], [0, 0]], 15)[-1]
    # Three bodies pressed together buckle a little, those with flat faces the most.
    turns = 1e-5 if not between else 2e-4 if shape is None else 5e-3
    assert np.abs(world.pose[:2].mean(axis=1)).max() < turns
    assert np.abs(poses - start).max() < turns
    assert world.effort == pytest.approx([1, 1], abs=1e-3)


@each_case("restitution", [0.0, 0.3, 0.7, 1.0])
@each_case("prop", [Ball(), Box(), Solid(TEE), Puck()])
@each_case("speed", [0.1, 2.0])
def test_a_prop_bounces_off_a_wall_at_its_restitution(restitution, prop, speed):
    prop = prop.replace(restitution=restitution, ground_friction=0, velocity=(speed, 0, 0))
    world = endless([IDLE], [prop], addons=[Map([[(0.5, -1), (0.5, 1)]])])
    drive(world, STILL, 0.6 / speed)
    assert world.prop_velocity[0, 0] == pytest.approx(-restitution * speed, abs=0.02 * speed)
    assert abs(world.prop_velocity[2, 0]) < 0.05 * speed


def test_the_times_of_touching_add_up_to_that_between_touch_and_parting():
    world = endless([Robot()], addons=[Map([[(0.5, -1), (0.5, 1)]])])
    for speed, seconds in ((0.2, 3), (-0.2, 1), (0.2, 3)):
        drive(world, [[speed], [0]], seconds)
    rows = world.record.contacts
    first, second = episodes(rows)
    assert first["began"] == pytest.approx(0.35 / 0.2, abs=1e-2)
    assert first["ended"] == pytest.approx(3, abs=0.03)  # a substep in contact
    assert second["began"] == pytest.approx(5, abs=0.03)
    assert second["ended"] == pytest.approx(7)
    total = sum(float(e["ended"] - e["began"]) for e in (first, second))
    assert rows["duration"].sum() == pytest.approx(total, abs=1e-6)
    assert rows["ended"].sum() == 1
    assert rows["began"].sum() == 2
    assert world.record.collisions == 2


@each_case("restitution", [0.0, 0.3, 0.7071, 0.9, 1.0])
@each_case("gap", [0.0, 1e-4, 1e-3, 1e-2])
@each_case("count", [1, 2, 4])
def test_a_chain_of_pucks_before_a_wall_gives_it_all_momentum_and_wins_no_energy(
    restitution, gap, count
):
    """One is thrown at 2 m/s at others that lie apart by a gap, the last by as much from a wall."""
    look = {"diameter": 0.2, "restitution": restitution, "friction": 0, "ground_friction": 0}
    still = [Puck(pose=(0.5 + (0.2 + gap) * k, 0, 0), **look) for k in range(count)]
    end = still[-1].pose[0] + 0.1 + gap
    wall = Map([[(end, -1), (end, 1)]], restitution=restitution)
    pucks = [Puck(velocity=(2, 0, 0), **look), *still]
    world = endless([IDLE], pucks, addons=[wall], sampling_time=0.05)
    energy, momentum = world.energy.total, world.momentum.total[0]
    drive(world, STILL, 1.0)
    assert world.energy.total <= energy * (1 + 1e-9)
    rows = world.record.contacts[world.record.contacts["b"] == -1]
    lost = momentum - world.momentum.total[0]
    assert rows["normal_impulse"].sum() == pytest.approx(lost, abs=1e-6)
    assert world.prop_pose[0].max() < end - 0.1 + 1e-3
    assert (np.diff(world.prop_pose[0]) > 0.2 - 1e-3).all()  # nobody passes another


@each_case("gap", [1e-3, 1e-2])
def test_in_a_chain_each_impact_is_that_of_two(gap):
    """With a gap before the wall, the second puck comes back and hits the first once more."""
    e = 0.7071
    pucks = [
        Puck(diameter=0.2, pose=(0, 0, 0), velocity=(2, 0, 0), restitution=e, ground_friction=0),
        Puck(diameter=0.2, pose=(0.5, 0, 0), restitution=1, ground_friction=0),
    ]
    wall = Map([[(0.6 + gap, -1), (0.6 + gap, 1)]], restitution=1)
    world = endless([IDLE], pucks, addons=[wall], sampling_time=0.05)
    drive(world, STILL, 0.6)
    # The first goes on at 2 (1 - e) / 2, the second at 2 (1 + e) / 2 to the wall, and back into it.
    first, second = 1 - e, -(1 + e)
    common, apart = (first + second) / 2, e * (first - second) / 2
    assert world.prop_velocity[0] == pytest.approx([common - apart, common + apart], abs=2e-3)
