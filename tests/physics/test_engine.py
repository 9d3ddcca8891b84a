"""The physics: exact where nothing touches, honest forces where something does."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import mars2d
from mars2d import Holonomic, Robot, Scenario, Unicycle, World
from mars2d.addons import Map
from tests.cases import each_case
from tests.worlds import arc, drive, endless

EXACT = 1e-9  # metres


def free(*robots: Robot, **fields) -> World:
    """A world without limits."""
    return endless(robots, **fields)


def moved(robot: Robot, pose, command, t: float) -> np.ndarray:
    if isinstance(robot.drive, Unicycle):
        return np.array(arc(pose, *command, t))
    return np.add(pose, [command[0] * t, command[1] * t, 0])


# -- free motion ----------------------------------------------------------------------------

speeds = st.floats(-0.3, 0.3)
# The formula above loses digits of its own for radii of kilometres.
spins = st.one_of(st.just(0.0), st.floats(1e-3, 2.0), st.floats(-2.0, -1e-3))


@given(
    commands=st.lists(st.tuples(speeds, spins), min_size=1, max_size=8),
    sampling_time=st.floats(1e-3, 100.0),
    heading=st.floats(-7, 7),
    offset=st.floats(-0.15, 0.15),
)
@example(commands=[(0.3, 2.0)] * 8, sampling_time=100.0, heading=1.0, offset=0.15)
def test_a_unicycle_follows_the_closed_form_arc(commands, sampling_time, heading, offset):
    robot = Robot(pose=(1, -2, heading), center_offset=offset)
    world = free(robot, sampling_time=sampling_time)
    expected = np.array(robot.pose)
    for command in commands:
        world.step([[command[0]], [command[1]]])
        expected = np.array(arc(expected, *command, sampling_time))
        assert np.abs(world.pose[:2, 0] - expected[:2]).max() < EXACT
        assert world.pose[2, 0] == pytest.approx(expected[2], abs=1e-9)


@given(
    team=st.lists(st.sampled_from(["unicycle", "holonomic"]), min_size=2, max_size=6),
    ticks=st.integers(1, 6),
    sampling_time=st.floats(1e-3, 50.0),
    delay=st.floats(0, 20.0),
    seed=st.integers(0, 2**32),
)
def test_a_mixed_team_with_delay_is_where_its_commands_bring_it(
    team, ticks, sampling_time, delay, seed
):
    rng = np.random.default_rng(seed)
    robots = [
        Robot(
            pose=(1e3 * i, 0, rng.uniform(-3, 3)),
            drive=Unicycle() if kind == "unicycle" else Holonomic(),
            center_offset=rng.uniform(-0.1, 0.1),
        )
        for i, kind in enumerate(team)
    ]
    world = free(*robots, sampling_time=sampling_time, command_delay=delay)
    commands = rng.uniform(-0.2, 0.2, (ticks, 2, len(team)))
    for command in commands:
        world.step(command)
    # Command k is in effect from k Ts + delay to (k + 1) Ts + delay; all ends at ticks Ts.
    end = ticks * sampling_time
    for i, robot in enumerate(robots):
        expected = np.array(robot.pose)
        for k in range(ticks):
            start = k * sampling_time + delay
            duration = min(start + sampling_time, end) - start
            if duration > 0:
                expected = moved(robot, expected, commands[k, :, i], duration)
        assert np.abs(world.pose[:2, i] - expected[:2]).max() < EXACT


@each_case("spin", [1e-12, 1e-9, 1e-6])
def test_an_arc_of_huge_radius_is_as_exact(spin):
    world = free(Robot())
    drive(world, [[0.4], [spin]], 10)
    x, y, theta = world.pose[:, 0]
    assert x == pytest.approx(4.0, abs=EXACT)
    assert y == pytest.approx(0.4 * spin * 10**2 / 2, abs=EXACT)
    assert theta == pytest.approx(10 * spin, rel=1e-9)


def test_four_thousand_ticks_stay_exact():
    world = free(Robot(), Robot(pose=(0, 50, 0), drive=Holonomic()), sampling_time=0.05)
    for _ in range(4_000):
        world.step([[0.2, 0.01], [0.3, -0.02]])
    turning = arc((0, 0, 0), 0.2, 0.3, 200.0)
    assert np.abs(world.pose[:2, 0] - turning[:2]).max() < EXACT
    assert np.abs(world.pose[:2, 1] - [2, 46]).max() < EXACT


def test_arcs_stay_exact_where_others_are_near_but_nothing_touches():
    # Two robots pass each other a millimetre apart, a third one touches a wall far away.
    robots = [Robot(pose=(-1, 0, 0)), Robot(pose=(1, 0.301, np.pi)), Robot(pose=(9, 9, 0))]
    wall = Map([[(9.15 + 1e-6, 8), (9.15 + 1e-6, 10)]])
    world = free(*robots, addons=[wall])
    drive(world, [[0.3, 0.3, 0.3], [0, 0, 0]], 5)
    assert np.abs(world.pose[:2, 0] - [0.5, 0]).max() < EXACT
    assert np.abs(world.pose[:2, 1] - [-0.5, 0.301]).max() < EXACT
    pairs = {(int(row["a"]), int(row["b"])) for row in world.record.contacts}
    assert pairs == {(2, -1)}


def test_the_geometric_centre_runs_round_the_centre_of_rotation():
    world = free(Robot(center_offset=0.1))
    drive(world, [[0], [1.0]], np.pi)  # 3.1 s
    angle = world.pose[2, 0]
    assert np.abs(world.pose[:2, 0]).max() < EXACT
    expected = -0.1 * np.cos(angle), -0.1 * np.sin(angle)
    assert world.geometric_center[:, 0] == pytest.approx(expected)


# -- contact --------------------------------------------------------------------------------


@each_case("offset", [0.05, 0.1, 0.15])
def test_a_hit_turns_a_robot_about_its_centre_of_rotation_by_impulse_times_lever(offset):
    weak = Holonomic(max_force=1e-6, max_torque=1e-6)
    hitting = Robot(pose=(0, -offset, 0), drive=weak, friction=0)
    target = Robot(pose=(0.35, 0, np.pi / 2), center_offset=offset, drive=weak, mass=2, friction=0)
    world = free(hitting, target, sampling_time=0.01)
    drive(world, [[0.4, 0], [0, 0]], 0.13)
    assert len(world.record.contacts) > 0
    impulse = 2 * world.velocity[0, 1]
    moment = 2 * (0.15**2 / 2 + offset**2)
    assert impulse > 0.1
    assert world.velocity[2, 1] == pytest.approx(impulse * offset / moment, rel=0.01)


@each_case("distance", [0.1, 0.1037, 0.1311, 0.56])
@each_case("speed", [0.3, 0.5, 2.0, 100.0])
def test_without_restitution_nothing_bounces(speed, distance):
    weak = Unicycle(max_linear_speed=speed, max_force=1e-6, max_torque=1e-6)
    wall = Map([[(0.15 + distance, -1), (0.15 + distance, 1)]])
    world = free(Robot(drive=weak), addons=[wall])
    slowest = speed
    for _ in range(20):
        world.step([[speed], [0]])
        slowest = min(slowest, world.velocity[0, 0])
    assert abs(slowest) < 1e-3 * speed
    assert world.pose[0, 0] == pytest.approx(distance, abs=1e-3)


@each_case(("force", "mass"), [(0.05, 1.0), (0.1, 0.5), (0.2, 3.0)])
@each_case("limited", [False, True])
def test_a_robot_thrown_off_comes_back_at_force_over_mass(force, mass, limited):
    motors = Unicycle(max_force=force, max_torque=1, force_limited=limited)
    robot = Robot(drive=motors, restitution=1, mass=mass, friction=0, pose=(-8 * limited, 0, 0))
    wall = Map([[(0.2, -1), (0.2, 1)]], restitution=1, friction=0)
    world = free(robot, addons=[wall], sampling_time=0.02)
    while not len(world.contacts):
        world.step([[0.4], [0]])
    drive(world, [[0.4], [0]], 0.02)
    before = world.velocity[0, 0]
    assert before == pytest.approx(-0.4, rel=0.05)
    drive(world, [[0.4], [0]], 1)
    assert (world.velocity[0, 0] - before) / 1.0 == pytest.approx(force / mass, rel=0.02)


def test_a_robot_back_at_its_command_follows_it_exactly_again():
    robot = Robot(drive=Unicycle(max_force=2), restitution=1)
    wall = Map([[(0.2, -9), (0.2, 9)]], restitution=0.5)
    world = free(robot, addons=[wall])
    drive(world, [[0.4], [0]], 0.3)
    drive(world, [[-0.3], [0]], 1)
    start = world.pose[:, 0]
    drive(world, [[-0.3], [0.5]], 1)
    assert np.abs(world.pose[:2, 0] - arc(start, -0.3, 0.5, 1.0)[:2]).max() < EXACT


# -- obstacles ------------------------------------------------------------------------------

CONCAVE = [(5, 2), (4, 3), (6, 4), (5, 3)]  # the first obstacle of the paper


def test_a_robot_drives_into_the_notch_as_far_as_it_fits():
    robot = Robot(pose=(5.7, 3, np.pi), diameter=0.1, friction=0)
    world = free(robot, addons=[Map([CONCAVE], friction=0)])
    drive(world, [[0.3], [0]], 5)
    assert world.pose[0, 0] == pytest.approx(5.05, abs=1e-3)
    assert len(world.record.contacts) > 0


@each_case("side", [-1, 1])
@each_case(("speed", "sampling_time"), [(0.5, 0.05), (0.5, 2.0), (100, 1.0)])
def test_a_wall_of_two_vertices_stops_a_robot_from_both_sides(side, speed, sampling_time):
    robot = Robot(pose=(side, 0, 0 if side < 0 else np.pi), drive=Unicycle(max_linear_speed=100))
    world = free(robot, addons=[Map([[(0, -1), (0, 1)]])], sampling_time=sampling_time)
    drive(world, [[speed], [0]], 10)
    assert side * world.pose[0, 0] == pytest.approx(0.15, abs=1e-3)


@each_case("on_exit", ["wall", "stop", "ignore"])
def test_at_the_edge_of_the_workspace_happens_what_on_exit_says(on_exit):
    square = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    world = free(Robot(), workspace=square, on_exit=on_exit)
    while not world.over and world.time < 10:
        world.step([[0.3], [0]])
    x = world.pose[0, 0]
    if on_exit == "wall":
        assert x == pytest.approx(0.85, abs=1e-3)
        assert world.record.contacts["b"].max() == -1
    elif on_exit == "stop":
        assert world.over
        assert "robot0" in world.over_message
        assert 1 < x < 1.04
    else:
        assert x == pytest.approx(3.0, abs=1e-9)


# -- worlds ---------------------------------------------------------------------------------


def test_robots_that_start_overlapping_by_less_than_is_allowed_part_again():
    world = free(Robot(), Robot(pose=(0.2993, 0, 0)))
    drive(world, [[0, 0], [0, 0]], 5)
    gap = world.pose[0, 1] - world.pose[0, 0] - 0.3
    assert -1.5e-4 < gap <= 1e-5


@each_case("gap", [0.05, 0.3, 0.8])
def test_a_robot_pinched_out_between_two_stops_at_the_wall(gap):
    strong = Holonomic(max_force=50)
    jaws = [Robot(pose=(-0.55, 0, 0), drive=strong), Robot(pose=(0.55, 0, 0), drive=strong)]
    pip = Robot(pose=(0, 0.03, 0), drive=Holonomic(max_force=0.01))
    wall = Map([[(-9, 0.18 + gap), (9, 0.18 + gap)]])
    scenario = Scenario(robots=[*jaws, pip], addons=[wall], sampling_time=1.0, stop_time=4.0)
    record = mars2d.run(scenario, control=lambda world: [[0.5, -0.5, 0], [0, 0, 0]])
    assert record.pose[:, 1, 2].max() < 0.18 + gap - 0.15 + 1e-3


@each_case("plain", ["", "1"])
def test_a_motion_that_can_not_go_on_is_an_error(monkeypatch, plain):
    """No gate lets such twists pass; if one did, robots would go through each other."""
    monkeypatch.setenv("MARS2D_PLAIN", plain)
    world = free(Robot(), Robot(pose=(0.31, 0, 0)))
    twist = np.array([[1e200, 0.0], [0.0, 0.0], [0.0, 0.0]])
    for _ in range(2):  # it does not go on either
        with pytest.raises(FloatingPointError, match="not finite"):
            world.simulation.engine.drive(twist, 0.1, 0.0)
