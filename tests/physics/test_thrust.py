"""Robots whose drives' forces bound their acceleration where nothing touches them, too."""

from __future__ import annotations

from math import cos, hypot, pi, sin, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mars2d import Car, Drive, Holonomic, Robot, Unicycle
from mars2d.addons import Map
from mars2d.bodies import Box, Hinge
from mars2d.core.materials import GRAVITY
from mars2d.geometry.shapes import Polygon
from tests.cases import each_case
from tests.worlds import arc, drive, endless

PLATE = Polygon([(-0.2, -0.12), (0.2, -0.12), (0.2, 0.12), (-0.2, 0.12)])


def limited(kind: type[Drive] = Unicycle, **fields) -> Drive:
    return kind(force_limited=True, **{"max_linear_speed": 3.0, **fields})


def steps(time: float, sampling_time: float) -> float:
    """The time, as a whole number of control steps."""
    return round(time / sampling_time) * sampling_time


# -- alone ------------------------------------------------------------------------------------


@each_case("sampling_time", [0.5, 0.1, 0.03, 0.0017])
def test_it_gathers_speed_at_force_over_mass_and_brakes_so(sampling_time):
    force, mass, speed = 1.7, 2.3, 0.45
    world = endless([Robot(mass=mass, drive=limited(max_force=force))], sampling_time=sampling_time)
    a, gathers = force / mass, speed * mass / force
    poses = drive(world, [[speed], [0.0]], 1.5)
    time = sampling_time * np.arange(1, len(poses) + 1)
    way = np.where(time < gathers, a * time**2 / 2, speed * time - speed * gathers / 2)
    assert poses[:, 0, 0] == pytest.approx(way, abs=1e-12)
    assert world.velocity[:, 0] == pytest.approx([speed, 0, 0], abs=1e-12)
    poses = drive(world, [[0.0], [0.0]], 1.5)
    assert poses[-1, 0, 0] - way[-1] == pytest.approx(speed**2 / (2 * a), abs=1e-12)
    assert world.velocity[0, 0] == 0.0


@each_case("sampling_time", [0.37, 0.05])
@each_case("shape", [None, PLATE])
def test_it_gathers_spin_at_torque_over_moment(shape, sampling_time):
    torque, spin = 0.01, 1.1
    robot = Robot(mass=0.8, shape=shape, drive=limited(max_torque=torque))
    rate = torque / robot.inertia.moment
    world = endless([robot], sampling_time=sampling_time)
    drive(world, [[0.0], [spin]], 2.0)
    time = steps(2.0, sampling_time)
    turned = rate * time**2 / 2 if rate * time < spin else spin * time - spin**2 / (2 * rate)
    assert world.pose[:, 0] == pytest.approx([0, 0, turned], abs=1e-12)
    drive(world, [[0.0], [-spin]], 5.0)
    assert world.velocity[2, 0] == -spin


@each_case("angle", [0.9, 2.0, 4.4])
def test_a_holonomic_robots_velocity_goes_straight_to_the_one_commanded(angle):
    force, mass, first = 0.8, 1.3, np.array([0.3, 0.1])
    world = endless([Robot(mass=mass, drive=limited(Holonomic, max_force=force))])
    drive(world, first.reshape(2, 1), 2.0)
    start, second = world.pose[:2, 0], 0.5 * np.array([cos(angle), sin(angle)])
    a = force / mass * (second - first) / hypot(*(second - first))
    drive(world, second.reshape(2, 1), 0.3)
    assert world.velocity[:2, 0] == pytest.approx(first + 0.3 * a, abs=1e-12)
    assert world.pose[:2, 0] == pytest.approx(start + 0.3 * first + 0.045 * a, abs=1e-12)
    assert world.pose[2, 0] == 0.0


def integrated(force, mass, torque, moment, command, time):
    """The state x, y, theta, x', y', theta' by an integrator, with a little give at the end."""
    speed, spin = command

    def rates(_, state):
        _, _, theta, vx, vy, omega = state
        off = speed * np.array([cos(theta), sin(theta)]) - (vx, vy)
        ax, ay = force / mass * off / max(hypot(*off), 1e-5)
        return [vx, vy, omega, ax, ay, torque / moment * np.clip((spin - omega) / 1e-5, -1, 1)]

    return solve_ivp(
        rates, (0, time), np.zeros(6), method="LSODA", rtol=1e-9, atol=1e-10, max_step=1e-3
    ).y[:, -1]


@each_case("sampling_time", [0.5, 0.1, 0.06])
@each_case(
    ("force", "torque", "command"),
    [
        (0.3, 0.004, (0.4, 1.5)),  # it never gets onto its arc, and turns late
        (0.3, 0.5, (0.4, -1.9)),  # nor does this one, which turns at once
        (0.5, 0.01, (0.3, 0.8)),  # this one does
    ],
)
def test_a_unicycle_that_turns_goes_as_an_integrator_says(force, torque, command, sampling_time):
    robot = Robot(mass=1.3, drive=limited(max_force=force, max_torque=torque))
    world = endless([robot], sampling_time=sampling_time)
    drive(world, np.reshape(command, (2, 1)), 3.0)
    expected = integrated(force, 1.3, torque, robot.inertia.moment, command, 3.0)
    assert world.pose[:, 0] == pytest.approx(expected[:3], abs=3e-5)
    assert world.velocity[:, 0] == pytest.approx(expected[3:], abs=3e-5)


def test_on_an_arc_that_its_force_cannot_hold_it_goes_at_force_over_mass_times_spin():
    force, mass, spin = 0.3, 1.2, 1.5
    world = endless([Robot(mass=mass, drive=limited(max_force=force))])
    drive(world, [[0.9], [spin]], 60.0)
    assert hypot(*world.velocity[:2, 0]) == pytest.approx(force / (mass * spin), rel=1e-3)
    assert world.effort[0] == 1.0


def test_once_it_has_its_command_it_follows_it_exactly():
    robot = Robot(drive=limited(), pose=(0.2, 0.1, 0.7))
    world = endless([robot])
    drive(world, [[0.3], [0.4]], 2.0)
    expected = arc(world.pose[:, 0], 0.3, 0.4, 100.0)
    drive(world, [[0.3], [0.4]], 100.0)
    assert world.pose[:, 0] == pytest.approx(expected, abs=1e-9)
    assert world.effort[0] == pytest.approx(0.3 * 0.4 / 5.0)


def test_a_car_and_a_drive_of_ones_own_are_bounded_as_well():
    class Crab(Drive):
        def twist(self, command):
            return np.array([0 * command[0], command[0], command[1]])

    world = endless(
        [
            Robot(mass=2, drive=limited(Car, max_force=0.5)),
            Robot(mass=2, drive=limited(Crab, max_force=0.5), pose=(0, 3, 0)),
        ]
    )
    drive(world, [[1.0, 1.0], [0.0, 0.0]], 1.0)
    assert world.pose[:2, 0] == pytest.approx([0.125, 0])
    assert world.pose[:2, 1] == pytest.approx([0, 3.125])


@each_case("physics", ["stop", "ideal"])
def test_without_forces_it_changes_nothing(physics):
    drives = [Unicycle(max_force=0.1), Unicycle(max_force=0.1, force_limited=True)]
    worlds = [endless([Robot(drive=each)], physics=physics) for each in drives]
    ways = [drive(world, [[0.3], [0.2]], 1.0) for world in worlds]
    assert (ways[0] == ways[1]).all()


# -- beside other things ----------------------------------------------------------------------


@each_case("shape", [None, PLATE])
@each_case("command", [(0.35, 0.0), (0.35, 0.9), (0.1, -1.2)])
def test_near_a_wall_that_it_does_not_touch_it_goes_as_in_the_open(shape, command):
    robot = Robot(
        mass=2.3, shape=shape, pose=(0, 0.5, 0), drive=limited(max_force=1.1, max_torque=0.02)
    )
    walls = [[(-0.5, 0.2), (2, 0.2)], [(1.1, -1), (1.1, 2)], [(-0.5, 0.9), (1, 1.1)]]
    ways = []
    for addons in ([], [Map(walls)]):
        world = endless([robot], addons=addons, sampling_time=0.2)
        here = drive(world, np.reshape(command, (2, 1)), 1.2)
        back = drive(world, -np.reshape(command, (2, 1)), 1.0)
        ways.append(np.concatenate([here, back]))
        assert world.record.collisions == 0
    assert ways[0] == pytest.approx(ways[1], abs=1e-6)


@each_case("gap", [1e-6, 1e-4, 0.01, 0.2])
def test_it_hits_with_the_speed_that_it_gathered_over_the_gap(gap):
    force, mass = 1.5, 1.8
    world = endless(
        [Robot(mass=mass, drive=limited(max_force=force))],
        addons=[Map([[(0.15 + gap, -1), (0.15 + gap, 1)]])],
        sampling_time=2.0,
    )
    world.step([[3.0], [0.0]])
    expected = sqrt(2 * force / mass * gap)
    assert world.record.contacts[0]["speed"] == pytest.approx(expected, rel=0.01, abs=3e-3)


@each_case("force_limited", [True, False])
@each_case("gap", [0.0, 1e-17, 1e-12, 1e-6])
@each_case("n", [1, 2, 3, 4, 5, 8])
def test_a_file_moves_what_its_forces_can_and_nothing_else(n, gap, force_limited):
    if not force_limited and gap > 1e-9:
        pytest.skip("ideal drives run at full speed from the first instant")
    force, mass, m = 2.0, 4.0, 1.0
    robot = Robot(
        mass=m, drive=Unicycle(max_force=force, force_limited=force_limited, max_linear_speed=9)
    )
    team = [robot.at(-0.35 - gap - i * (0.3 + gap), 0) for i in range(n)]
    for share in (1.05, 0.9):
        friction = share * n * force / (mass * GRAVITY)
        world = endless(team, [Box(length=0.4, width=0.4, mass=mass, ground_friction=friction)])
        drive(world, [[8.0] * n, [0.0] * n], 3.0)
        a = max(1 - share, 0) * n * force / (mass + n * m)
        # In gaps robots gather speed before they push: up to 3 % of the way.
        tolerance = 0.02 if gap < 1e-9 else 0.03
        assert world.prop_pose[0, 0] == pytest.approx(a * 4.5, abs=1e-3 + tolerance * a * 4.5)


def test_held_by_a_hinge_to_a_load_both_gather_speed_together():
    force, load = 1.5, 2.0
    box = Box(mass=load, pose=(0.9, 0, pi), length=0.3, width=0.3, ground_friction=0.0)
    hinge = Hinge(a="robot0", b="box0", anchor_a=(0.4, 0.0), anchor_b=(0.5, 0.0))
    world = endless([Robot(drive=limited(max_force=force))], [box.replace(name="box0")], [hinge])
    drive(world, [[2.0], [0.0]], 2.0)
    assert world.velocity[0, 0] == pytest.approx(force / (1 + load) * 2.0, rel=0.01)
