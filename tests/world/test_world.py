"""A world is stepped: in the order of Algorithm 1, and never more than it says."""

from __future__ import annotations

import numpy as np
import pytest

import mars2d
from mars2d import Holonomic, InputError, LawError, Robot, Scenario, World
from mars2d.addons import Addon, Map
from mars2d.bodies.props import Ball, Box
from mars2d.sensors import Sensor
from tests.cases import each_case


def test_a_control_step_goes_in_the_order_of_algorithm_1():
    log = []

    class Diary(Addon):
        def on_start(self, world):
            log.append("start")

        def on_step(self, world):
            log.append(f"add-on {world.iteration}")

        def on_stop(self, world):
            log.append("stop")

    class Nose(Sensor):
        def read(self, robot, world, rng):
            log.append(f"sense {robot.index}")
            return 0.0

    def control(world):
        log.append("control")
        return np.zeros((2, 2))

    def own(robot):
        log.append(f"own {robot.index}")
        return 0, 0

    robots = [Robot(sensors=[Nose()]), Robot(pose=(1, 0, 0), sensors=[Nose()], controller=own)]
    scenario = Scenario(robots=robots, addons=[Diary()], stop_time=0.1)
    world = World(scenario, control, watch=lambda _world: log.append("watch"))
    while not world.over:
        world.step()
    once = ["sense 0", "sense 1", "watch", "control", "own 1"]
    assert log == ["start", "add-on 0", *once, "add-on 1", *once, "stop"]


def test_all_robots_are_sensed_before_any_is_commanded():
    class Eye(Sensor):
        def read(self, robot, world, rng):
            return float(world.pose[0].sum())

    seen = []

    def law(robot):
        seen.append(robot.sense.eye)
        return 0.2, 0

    walker = Robot(sensors=[Eye()], controller=law, drive=Holonomic())
    mars2d.run(Scenario(robots=[walker, walker.at(0, 1)], stop_time=0.3))
    assert seen == pytest.approx([0, 0, 0.04, 0.04, 0.08, 0.08, 0.12, 0.12])


def test_the_last_row_is_at_the_stop_time_and_nothing_moves_after_it():
    world = World(Scenario(stop_time=0.5))
    steps = 0
    while not world.over:
        world.step([[0.1], [0]])
        steps += 1
    assert steps == 6
    assert world.time == pytest.approx(0.5)
    assert world.pose[0, 0] == pytest.approx(0.05)
    assert world.over_message == "finished after 0.5 s"
    with pytest.raises(InputError, match="over: finished after"):
        world.step()


def test_stop_ends_the_experiment_with_this_step_and_the_first_reason_counts():
    def control(world):
        if world.iteration == 3:
            world.stop("caught")
            world.stop("again")
        return [[0.1], [0]]

    record = mars2d.run(Scenario(), control=control)
    assert record.over_message == "caught"
    assert len(record) == 4


def test_leaving_the_workspace_names_the_robot_and_the_place():
    robots = [Robot(name="stays"), Robot(pose=(4.92, 1, 0), name="leaves")]
    record = mars2d.run(Scenario(robots=robots), control=lambda _world: [[0, 0.5], [0, 0]])
    assert record.over_message == "Out of bounds: leaves left the workspace at (5.02, 1)"
    assert len(record) == 3


@each_case("command", [[[0, 0], [0, 0]], [1, 2, 3], "x", [[np.nan], [0]], 5])
def test_a_given_command_that_cannot_be_used_is_an_input_error(command):
    world = World(Scenario())
    with pytest.raises(InputError, match=r"World.step\(command\)"):
        world.step(command)
    world.step([[0.1], [0]])  # and the world goes on
    assert world.iteration == 1


# -- what is read only ----------------------------------------------------------------------


def test_pose_command_history_and_contacts_cannot_be_written():
    robots = [Robot(), Robot(pose=(0.3, 0, 0))]
    world = World(Scenario(robots=robots, props=[Box(pose=(3, 0))]))
    for _ in range(3):
        world.step([[0.2, 0], [0, 0]])
    assert len(world.contacts) == 1
    for array in (
        world.pose, world.command, world.history.pose, world.history.time, world.history.command,
        world.history.command_time, world.robots[0].pose, world.robots[0].command,
        world.robots[0].neighbours[0].pose, world.contacts["impulse"], world.prop_pose,
        world.props[0].pose, world.effort, world.history.prop_pose, world.history.effort,
    ):  # fmt: skip
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0


# -- stepping from within -------------------------------------------------------------------


def test_a_law_that_steps_the_world_is_an_error_and_nothing_is_recorded_twice():
    def control(world):
        if world.iteration == 2:
            world.step([[0], [0]])
        return [[0], [0]]

    world = World(Scenario(), control)
    world.step()
    world.step()
    with pytest.raises(LawError, match="from within a step"):
        world.step()
    assert len(world.record) == 2
    assert world.iteration == 2


# -- errors keep the record -----------------------------------------------------------------


def late(what):
    """A law that fails in its fourth step."""

    def law(robot):
        if robot.time > 0.25:
            return what()
        return 0.1, 0

    return law


@each_case("what", [lambda: 1 / 0, lambda: None, lambda: (np.nan, 0)])
def test_what_was_recorded_until_an_error_is_kept(what):
    scenario = Scenario(robots=[Robot(controller=late(what))])
    with pytest.raises(LawError) as raised:
        mars2d.run(scenario)
    record = raised.value.record
    assert len(record) == 3
    assert record.pose[-1, 0, 0] == pytest.approx(0.02)
    assert "test_world.py, line" in str(raised.value)


# -- what a world tells ---------------------------------------------------------------------


@each_case("physics", ["contact", "stop", "ideal"])
@each_case("delay", [0.0, 0.25])
def test_velocity_is_that_of_the_instant_not_of_the_last_chord(physics, delay):
    far = Robot(pose=(0, 4, 0), drive=Holonomic())
    scenario = Scenario(
        robots=[Robot(), far], physics=physics, command_delay=delay, sampling_time=0.5
    )
    world = World(scenario)
    assert not world.velocity.any()
    for _ in range(5):
        world.step([[0.3, 0.1], [1.2, -0.2]])
    theta = world.pose[2, 0]
    expected = [[0.3 * np.cos(theta), 0.1], [0.3 * np.sin(theta), -0.2], [1.2, 0]]
    assert world.velocity == pytest.approx(np.array(expected), abs=1e-12)
    assert world.robots[0].velocity == pytest.approx(world.velocity[:, 0])


@each_case("physics", ["contact", "stop"])
def test_a_robot_that_a_wall_holds_has_no_velocity(physics):
    wall = Map([[(0.4, -1), (0.4, 1)]])
    world = World(Scenario(robots=[Robot()], addons=[wall], physics=physics, sampling_time=0.1))
    for _ in range(20):
        world.step([[0.3], [0.0]])
    assert world.velocity == pytest.approx(np.zeros((3, 1)), abs=1e-6)


def test_the_frame_shows_the_readings_of_this_instant_once_it_is_observed():
    class Clock(Sensor):
        def read(self, robot, world, rng):
            return world.time

    world = World(Scenario(robots=[Robot(sensors=[Clock()])]))
    assert world.frame.readings == {}
    world.observe()
    assert world.frame.readings == {"clock": [(0, 0.0)]}
    world.step()
    world.observe()
    frame = world.frame
    assert frame.readings == {"clock": [(0, 0.1)]}
    assert frame.iteration == 1
    assert frame.path.shape == (1, 3, 1)
    world.step()  # having looked does not sense twice
    assert world.record.sensors["clock"].ravel().tolist() == [0.0, 0.1]


# -- props and effort -----------------------------------------------------------------------------


def test_a_law_sees_the_props_where_they_are():
    seen = []

    def control(world):
        seen.append([(prop.index, prop.name, *prop.pose.tolist()) for prop in world.props])
        return [[0.3], [0]]

    props = [Ball(pose=(0, 2), velocity=(1, 0, 0.5)), Box(pose=(1, 0, 0.2), name="load")]
    world = World(Scenario(props=props), control)
    for _ in range(3):
        world.step()
    assert seen[0] == [(0, "ball0", 0, 2, 0), (1, "load", 1, 0, 0.2)]
    assert seen[2][0] == pytest.approx((0, "ball0", 0.2, 2, 0.1))
    assert world.prop_pose[:, 0] == pytest.approx([0.3, 2, 0.15])
    assert world.prop_velocity[:, 0] == pytest.approx([1, 0, 0.5])
    assert world.props[0].velocity == pytest.approx([1, 0, 0.5])
    assert world.pose.shape == (3, 1)
    assert world.velocity.shape == (3, 1)


def test_effort_is_none_in_free_motion_and_all_of_it_against_a_wall():
    square = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    scenario = Scenario(robots=[Robot()], workspace=square, on_exit="wall")
    world = World(scenario)
    for _ in range(10):
        world.step([[0.5], [0.3]])
        assert world.effort.tolist() == [0]
    for _ in range(30):
        world.step([[0.5], [0]])
    assert world.effort == pytest.approx([1])
    effort = world.record.effort
    assert effort[:10].max() == 0
    assert effort[-1] == pytest.approx([1])
