"""Physics without forces: "stop" never overlaps, "ideal" is free motion; both report contacts."""

from __future__ import annotations

from math import cos, pi, sin, sqrt

import numpy as np
import pytest
import shapely

from mars2d import Holonomic, Robot, Unicycle
from mars2d.addons import Map
from mars2d.bodies.props import Ball, Box, Puck
from mars2d.core.materials import GRAVITY
from mars2d.geometry.shapes import Polygon
from mars2d.record import episodes
from tests.cases import each_case
from tests.worlds import arc, drive, endless

SQUARE = Polygon([(-0.15, -0.15), (0.15, -0.15), (0.15, 0.15), (-0.15, 0.15)])
DEEPEST = 2e-4  # metres


def corners(pose, half=0.15) -> np.ndarray:
    x, y, theta = pose
    c, s = cos(theta), sin(theta)
    return np.array(
        [(x + c * p - s * q, y + s * p + c * q) for p in (-half, half) for q in (-half, half)]
    )


# -- ideal ----------------------------------------------------------------------------------


@each_case("sampling_time", [0.01, 0.1, 1.0])
@each_case("shape", [None, SQUARE])
def test_ideal_poses_are_those_of_free_motion_through_everything(sampling_time, shape):
    starts = [(-1, 0.1, 0), (1, 0, pi), (0, -1, pi / 2)]
    commands = np.array([[0.3, 0.25, 0.4], [0.2, -0.3, 0.0]])
    robots = [Robot(pose=pose, shape=shape) for pose in starts]
    walls = Map([[(-2, 0.3), (2, 0.3)], [(0.2, 0.2), (0.5, 0.2), (0.5, 0.5)]])
    props = [Box(pose=(0.3, -0.4, 0)), Puck(pose=(0, 0.6, 0), velocity=(0.5, -1, 0))]
    world = endless(robots, props, addons=[walls], sampling_time=sampling_time, physics="ideal")
    for _ in range(round(5 / sampling_time)):
        world.step(commands)
        expected = [
            arc(pose, *command, world.time)
            for pose, command in zip(starts, commands.T, strict=True)
        ]
        assert np.abs(world.pose.T - expected).max() < 1e-9
    assert world.prop_pose[:, 0] == pytest.approx([0.3, -0.4, 0], abs=1e-12)
    way = 1.25 / (2 * 0.1 * GRAVITY)
    slid = world.prop_pose[:2, 1] - [0, 0.6]
    assert slid == pytest.approx(way * np.array([0.5, -1]) / sqrt(1.25), abs=1e-9)
    assert world.record.collisions >= 5
    assert not world.record.effort.any()
    assert not world.record.contacts["impulse"].any()


@each_case("sampling_time", [0.05, 0.3, 2.0])
@each_case("offset", [0.0, 0.1, 0.25])
def test_ideal_contacts_of_discs_begin_and_end_at_the_right_times(sampling_time, offset):
    robots = [Robot(pose=(-1, 0, 0)), Robot(pose=(1, offset, pi))]
    world = endless(robots, sampling_time=sampling_time, physics="ideal")
    drive(world, [[0.3, 0.2], [0, 0]], 6)
    # Centres come as near as 0.3 m when the way along x is sqrt(0.3^2 - offset^2).
    along = sqrt(0.09 - offset**2)
    rows = world.record.contacts
    (episode,) = episodes(rows)  # of rows by several normals: that of discs that pass turns
    assert world.record.collisions == 1
    first = rows[0]
    assert first["time"] == pytest.approx((2 - along) / 0.5, abs=2e-3)
    # That they part is seen at the end of a control step.
    lasted = episode["ended"] - episode["began"]
    assert lasted == pytest.approx(2 * along / 0.5, abs=sampling_time + 1e-9)
    assert rows["duration"].sum() == pytest.approx(lasted)
    normal = np.array([along, offset]) / 0.3
    assert first["normal"] == pytest.approx(normal, abs=3e-3)
    assert first["speed"] == pytest.approx(0.5 * normal[0], abs=2e-3)
    assert abs(first["slip"]) == pytest.approx(0.5 * abs(normal[1]), abs=2e-3)
    centre = np.array([-1 + 0.3 * first["time"], 0])
    assert first["point"] == pytest.approx(centre + 0.15 * normal, abs=1e-3)


def test_ideal_contacts_of_a_square_and_a_wall_have_the_middle_of_the_face():
    robot = Robot(pose=(0, 0.1, 0), shape=SQUARE)
    world = endless([robot], addons=[Map([[(0.6, -1), (0.6, 1)]])], physics="ideal")
    drive(world, [[0.4], [0]], 1.2)
    row = world.record.contacts[0]
    assert (row["a"], row["b"]) == (0, -1)
    assert row["time"] == pytest.approx(0.45 / 0.4, abs=2e-3)
    assert row["point"] == pytest.approx([0.6, 0.1], abs=1e-3)
    assert row["normal"] == pytest.approx([1, 0], abs=1e-6)
    assert row["speed"] == pytest.approx(0.4, rel=1e-6)


# -- stop -----------------------------------------------------------------------------------


@each_case("sampling_time", [0.05, 0.5, 2.0])
@each_case("shape", [None, SQUARE])
def test_stop_at_a_wall_and_away_again(sampling_time, shape):
    robot = Robot(pose=(0, 0, 0), shape=shape)
    wall = Map([[(0.6, -1), (0.6, 1)]])
    world = endless([robot], addons=[wall], sampling_time=sampling_time, physics="stop")
    drive(world, [[0.4], [0]], 4)
    assert world.pose[0, 0] == pytest.approx(0.45, abs=DEEPEST)
    drive(world, [[0.4], [0]], 4)
    assert world.pose[0, 0] == pytest.approx(0.45, abs=DEEPEST)
    before = world.pose[0, 0]
    drive(world, [[-0.2], [0]], 2)
    assert world.pose[0, 0] == pytest.approx(before - 0.4, abs=1e-9)
    assert world.record.collisions == 1


def test_stop_holds_one_that_goes_into_another_and_lets_the_other_go_away():
    robots = [Robot(pose=(-0.5, 0, 0)), Robot(pose=(0, 0, 0))]
    world = endless(robots, physics="stop")
    drive(world, [[0.4, 0.0], [0, 0]], 3)
    assert world.pose[0] == pytest.approx([-0.3, 0], abs=DEEPEST)
    drive(world, [[0.4, 0.3], [0, 0]], 3)
    # The one ahead is not held; the one behind follows it as near as it may.
    assert world.pose[0, 1] == pytest.approx(0.9, abs=1e-9)
    assert world.pose[0, 1] - world.pose[0, 0] > 0.3 - DEEPEST


def test_stop_leaves_props_where_they_are_and_stops_those_that_slide():
    props = [Box(pose=(0.6, 0, 0)), Ball(pose=(3, 3, 0), velocity=(1, 0, 0))]
    wall = Map([[(4, 2), (4, 4)]])
    world = endless([Robot()], props, addons=[wall], physics="stop")
    drive(world, [[0.3], [0]], 4)
    assert world.prop_pose[:, 0].tolist() == [0.6, 0, 0]
    assert world.pose[0, 0] == pytest.approx(0.25, abs=DEEPEST)
    assert world.prop_pose[0, 1] == pytest.approx(3.9, abs=DEEPEST)
    assert not world.prop_velocity.any()


def test_stop_is_exact_where_nothing_touches():
    starts = [(0, 0, 0.3), (3, 0, 1)]
    world = endless(
        [Robot(pose=p) for p in starts], [Puck(pose=(0, -3, 0), velocity=(1, 0, 0))], physics="stop"
    )
    for _ in range(40):
        world.step([[0.3, 0.2], [0.4, -0.5]])
        expected = [arc(starts[0], 0.3, 0.4, world.time), arc(starts[1], 0.2, -0.5, world.time)]
        assert np.abs(world.pose.T - expected).max() < 1e-9
    assert world.prop_pose[0, 0] == pytest.approx(1 / (2 * 0.1 * GRAVITY), abs=1e-9)


@each_case("sampling_time", [0.05, 0.5])
@each_case("shape", [None, SQUARE])
@each_case("seed", range(3))
def test_stop_in_a_crowd_nothing_overlaps_and_none_is_held_for_good(seed, shape, sampling_time):
    rng = np.random.default_rng(seed)
    robots = [
        Robot(
            pose=(0.5 * (k % 3 - 1), 0.5 * (k // 3 - 1), rng.uniform(-3, 3) if not shape else 0),
            drive=(Unicycle, Holonomic)[k % 2](max_linear_speed=1.0), shape=shape,
        )
        for k in range(9)
    ]  # fmt: skip
    h, reach, half = 0.8, 0.0 if shape else 0.15, DEEPEST / 2
    room = [(-h, -h), (h, -h), (h, h), (-h, h)]
    inside = shapely.box(-h - half, -h - half, h + half, h + half)
    world = endless(
        robots, workspace=room, on_exit="wall", sampling_time=sampling_time, physics="stop"
    )
    moved = np.zeros(9)
    for _ in range(round(12 / sampling_time)):
        before = world.pose
        world.step(rng.uniform(-1, 1, (2, 9)))
        moved += np.hypot(*(world.pose - before)[:2])
        cores = np.array([core(pose, shape) for pose in world.pose.T])
        assert shapely.contains(inside, cores).all()
        assert shapely.distance(cores, inside.exterior).min() > reach - half
        apart = shapely.distance(cores[:, None], cores) + 9 * np.eye(9)
        assert apart.min() > max(2 * reach - DEEPEST, 0)
    assert moved.min() > 0.3


def core(pose, shape):
    """What of a robot overlaps with nothing: its middle, or the square but for half of DEEPEST."""
    if shape is None:
        return shapely.Point(pose[:2])
    square = shapely.Polygon(corners(pose)[[0, 1, 3, 2]])
    return square.buffer(-DEEPEST / 2, join_style="mitre")
