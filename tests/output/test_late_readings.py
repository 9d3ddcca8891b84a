"""What a sensor has hit is drawn where it is, however late or seldom the sensor measures."""

from __future__ import annotations

import numpy as np

from mars2d import Robot, Scenario, World
from mars2d.addons import Map
from mars2d.core.scene import Circle, Line, Polygon
from mars2d.output.layers.addons import sensors
from mars2d.record.frame import between
from mars2d.sensors import Proximity, RangeFinder
from tests.cases import each_case

WALL = 2.0


def world_of(*carried, stop_time=3.0):
    """A robot that comes nearer to a wall across its way by 0.5 m/s, turning to and fro."""
    robot = Robot(sensors=carried)
    scenario = Scenario(
        robots=[robot], addons=[Map([[(WALL, -50), (WALL, 50)]])], workspace=None,
        sampling_time=0.1, stop_time=stop_time,
    )  # fmt: skip
    return World(scenario, lambda world: [[0.5], [np.cos(3 * world.time)]])


def hits(frame):
    """Where beams have hit something, (k, 2) metres."""
    lines = [shape.points for shape in sensors(frame).shapes if isinstance(shape, Line)]
    return np.vstack(lines) if lines else np.empty((0, 2))


@each_case("rate", [None, 5.0, 2.0])
@each_case("latency", [0.0, 0.1, 0.55])
def test_hits_lie_on_the_wall_in_records_live_and_between_control_steps(rate, latency):
    mount = (0.1, 0.05, 0.2)
    laser = RangeFinder(
        beams=5, field_of_view=1.2, range=9, rate=rate, latency=latency, mount=mount
    )
    world = world_of(laser)
    seen, drawn = [], 0
    while not world.over:
        world.observe()
        seen.append(world.frame)
        world.step()
        seen.append(world.frame)  # with the readings of the step before
    record = world.record
    seen += [record.frame(row) for row in range(len(record))]
    seen += [between(record.frame(k), record.frame(k + 1), 0.1 * k + 0.04) for k in range(25)]
    for frame in seen:
        found = hits(frame)
        drawn += len(found)
        np.testing.assert_allclose(found[:, 0], WALL, atol=1e-9)
    assert drawn > 100


def centre(frame):
    (shape,) = sensors(frame).shapes
    return shape.center if isinstance(shape, Circle) else tuple(shape.points[0])


def test_what_goes_with_the_robot_does_so_between_control_steps_unless_it_is_late():
    view = 1.0
    at_once, late = (
        world_of(Proximity(range=0.5, field_of_view=view, latency=latency))
        for latency in (0.0, 0.3)
    )
    for world in (at_once, late):
        while not world.over:
            world.step()
    pose = at_once.record.pose
    for world, row in ((at_once, 10), (late, 7)):
        frame = world.record.frame(10)
        assert isinstance(sensors(frame).shapes[0], Polygon)
        np.testing.assert_allclose(centre(frame), pose[row, :2, 0])
    moved = between(at_once.record.frame(10), at_once.record.frame(11), 1.05)
    np.testing.assert_allclose(centre(moved), moved.pose[:2, 0])
    assert not np.allclose(moved.pose, pose[10])
