"""The force on the selected body over time: its numbers; and how a body is selected."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mars2d import Robot, Scenario, Unicycle, World
from mars2d.bodies.props import Ball, Box, Solid
from mars2d.core.materials import GRAVITY
from mars2d.window.panels.forcemeter import bound_of, reading_of
from mars2d.window.screen.picking import body_at, next_body
from tests.cases import each_case
from tests.window.circling import Circling
from tests.worlds import ELL


def push(time=4.0, **changes):
    """Return a world in which a robot of 5 N stalls at a box that the floor holds with 5.9 N."""
    box = Box(pose=(0.5, 0, 0), length=0.3, width=0.3, ground_friction=0.6, mass=1, name="box")
    robot = Robot(drive=Unicycle(max_force=5), name="red")
    scenario = Scenario(robots=[robot], props=[box], workspace=None, stop_time=1000)
    world = World(scenario.replace(**changes), lambda world: [[0.2], [0.0]])
    while world.time < time - 1e-9:
        world.step()
    return world


def test_the_force_on_a_robot_that_stalls_is_what_its_drive_can_push_with():
    world = push()
    reading = reading_of(world.frame, 0)
    assert len(reading.force) == world.iteration
    assert reading.start == 0.0
    np.testing.assert_allclose(reading.force[-5:], 5.0, rtol=1e-3)
    assert reading.force[5] == 0.0, "before they touch"
    np.testing.assert_allclose(reading_of(world.frame, 1).force, reading.force)


def test_the_impulses_of_the_last_steps_are_those_of_the_record():
    world = push(time=15.0)
    reading = reading_of(world.frame, 1)
    dt = world.scenario.sampling_time
    assert reading.start == pytest.approx(world.time - 0.1 - 10.0)
    late = world.record.contacts["time"] > reading.start - 1e-6
    total = world.record.contacts["impulse"][late].sum()
    assert reading.force.sum() * dt == pytest.approx(total, rel=1e-6)


def test_playback_reads_as_live():
    world = push()
    live = reading_of(world.frame, 0)
    record = world.record  # ends a row before the last step, as it is not over
    for row in (len(record) - 1, 20):
        played = reading_of(record.frame(row), 0)
        np.testing.assert_allclose(played.force, live.force[:row])


def test_the_effort_is_read_where_it_is_known():
    source = Circling(pressed=True)
    source.row = 30
    np.testing.assert_array_equal(reading_of(source.frame, 0).effort, np.ones(30))
    assert reading_of(replace(source.frame, effort_path=np.empty((0, 0))), 0).effort is None
    assert reading_of(push().frame, 1).effort is None, "a prop has no drive"


def test_the_bound_is_that_of_the_drive_or_of_the_floor():
    frame = push(time=0.0).frame
    assert bound_of(frame, 0).force == 5.0
    assert bound_of(frame, 1).force == pytest.approx(0.6 * GRAVITY)
    ball = Scenario(robots=[Robot()], props=[Ball(pose=(1, 0, 0))])
    assert bound_of(World(ball).frame, 1) is None, "nothing holds a ball that rolls"


# -- selecting ------------------------------------------------------------------------------------


def crowded():
    solid = Solid(ELL, pose=(2, 0, np.pi / 2), name="ell")
    return World(
        Scenario(robots=[Robot(), Robot(pose=(0.4, 0, 0))], props=[solid, Box(pose=(0, 1, 0))])
    ).frame


@each_case(
    "point, body",
    [((0, 0), 0), ((0.1, 0.1), 0), ((0.4, 0.14), 1), ((0, 1.19), 3), ((0.2, 0.5), None),
     ((0.0, 0.16), 0), ((0.0, 0.18), None)],
)  # fmt: skip
def test_what_lies_under_the_pointer_is_hit_with_a_little_slack(point, body):
    assert body_at(crowded(), point, 0.02) == body


def test_one_body_after_the_other_is_selected_and_then_none():
    frame, order, body = crowded(), [], None
    for _ in range(5):
        body = next_body(frame, body)
        order.append(body)
    assert order == [0, 1, 2, 3, None]
    assert frame.scenario.bodies[2].name == "ell"
