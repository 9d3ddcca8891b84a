"""Robots whose centre of mass is not their centre of rotation."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest

from mars2d import Car, Holonomic, InputError, Robot, Unicycle, World
from mars2d.bodies import Box, Puck, Spring
from mars2d.geometry.shapes import Polygon
from tests.cases import each_case
from tests.worlds import arc, drive, endless

CHASSIS = Polygon([(-0.15, -0.1), (0.35, -0.1), (0.35, 0.1), (-0.15, 0.1)])
LIMP = {"max_force": 1e-6, "max_torque": 1e-6}
"""A drive that does nothing worth speaking of."""


def car_of(lead: float = 0.13, **fields) -> Robot:
    fields = {"drive": Car(**LIMP), "mass": 2.0, "friction": 0.0, "restitution": 1.0} | fields
    return Robot(shape=CHASSIS, mass_offset=lead, **fields)


def puck_of(x: float, speed: float, mass: float, angle: float = 0.0) -> Puck:
    """A puck that comes to a robot at the origin, which looks along an angle, from its left."""
    c, s = cos(angle), sin(angle)
    return Puck(
        pose=(c * x - s * 0.4, s * x + c * 0.4, 0), velocity=(s * speed, -c * speed, 0),
        diameter=0.2, mass=mass, friction=0.0, restitution=1.0, ground_friction=0.0,
    )  # fmt: skip


def center_of(world: World, lead: float) -> np.ndarray:
    x, y, theta = world.pose[:, 0]
    return np.array([x + lead * cos(theta), y + lead * sin(theta)])


def velocity_of_center(world: World, lead: float) -> np.ndarray:
    vx, vy, spin = world.velocity[:, 0]
    theta = world.pose[2, 0]
    return np.array([vx - spin * lead * sin(theta), vy + spin * lead * cos(theta)])


@each_case("plain", ["", "1"])
@each_case("lead", [0.13, -0.08, 0.0, 0.3])
@each_case("x", [0.31, 0.02, -0.1, 0.13])  # the last one at a centre of mass
def test_a_puck_at_its_side_sets_it_going_as_a_free_rigid_body(x, lead, plain, monkeypatch):
    monkeypatch.setenv("MARS2D_PLAIN", plain)
    speed, mass, angle = 0.7, 0.6, 0.9
    robot = car_of(lead).at(0, 0, angle)
    world = endless([robot], [puck_of(x, speed, mass, angle)], sampling_time=0.05)
    drive(world, [[0.0], [0.0]], 0.4)
    moment = robot.inertia.moment
    blow = 2 * speed / (1 / mass + 1 / 2.0 + (x - lead) ** 2 / moment)
    spin = -(x - lead) * blow / moment
    assert world.velocity[2, 0] == pytest.approx(spin, abs=1e-3 * speed / 0.1)
    along = np.array([sin(angle), -cos(angle)])
    assert velocity_of_center(world, lead) == pytest.approx(along * blow / 2, abs=1e-3 * speed)
    left = -speed + blow / mass
    energy = (mass * left**2 + blow**2 / 2.0 + moment * spin**2) / 2
    assert energy == pytest.approx(mass * speed**2 / 2)
    assert world.record.contacts["normal_impulse"].sum() == pytest.approx(blow, rel=1e-3)


def test_free_it_spins_about_its_centre_of_mass_which_goes_straight_on():
    lead = 0.13
    world = endless([car_of(lead)], [puck_of(0.33, 0.9, 0.5)])
    drive(world, [[0.0], [0.0]], 0.5)
    at, velocity = center_of(world, lead), velocity_of_center(world, lead)
    theta, spin = world.pose[2, 0], world.velocity[2, 0]
    assert abs(spin) > 2
    drive(world, [[0.0], [0.0]], 3.0)
    assert center_of(world, lead) == pytest.approx(at + 3 * velocity, abs=1e-5)
    assert world.pose[2, 0] == pytest.approx(theta + 3 * spin, abs=1e-3)
    assert velocity_of_center(world, lead) == pytest.approx(velocity, abs=1e-5)


def test_its_drive_acts_at_the_centre_of_rotation_and_turns_it_by_the_lever():
    """A force across at the pose turns it about its centre of mass."""
    lead, force, mass = 0.15, 0.5, 2.0
    robot = car_of(lead, drive=Holonomic(max_force=force, max_torque=1e-6, force_limited=True))
    world = endless([robot], sampling_time=0.05)
    drive(world, [[0.0], [0.5]], 0.1)
    moment = robot.inertia.moment
    spin = -lead * force * 0.1 / moment
    assert world.velocity[2, 0] == pytest.approx(spin, rel=0.02)
    assert velocity_of_center(world, lead)[1] == pytest.approx(force / mass * 0.1, rel=0.02)


def test_ahead_its_force_moves_it_as_if_its_mass_lay_at_the_pose():
    force, mass = 0.8, 2.0
    robot = car_of(0.12, drive=Unicycle(max_force=force, force_limited=True))
    world = endless([robot])
    drive(world, [[0.4], [0.0]], 0.9)
    assert world.pose[0, 0] == pytest.approx(force / mass * 0.81 / 2, rel=2e-3)
    assert world.velocity[:, 0] == pytest.approx([force / mass * 0.9, 0, 0], rel=1e-3, abs=1e-6)


@each_case("physics", ["contact", "stop", "ideal"])
def test_where_it_follows_its_command_it_moves_to_the_bit_as_without(physics):
    worlds = [endless([Robot(mass_offset=lead)], physics=physics) for lead in (0.0, 0.1)]
    ways = [drive(world, [[0.3], [0.7]], 3.0) for world in worlds]
    assert (ways[0] == ways[1]).all()


def test_pushing_a_box_in_a_bend_it_keeps_to_its_command():
    for lead in (0.0, 0.1):
        robot = Robot(mass_offset=lead, drive=Unicycle(max_force=50, max_torque=20))
        box = Box(pose=(0.3501, 0, 0), ground_friction=0.2)
        world = endless([robot], [box])
        drive(world, [[0.2], [0.5]], 4.0)
        assert world.pose[:, 0] == pytest.approx(arc((0, 0, 0), 0.2, 0.5, 4.0), abs=0.01)


def test_thrown_off_its_command_it_comes_back_and_follows_it_exactly():
    robot = Robot(mass_offset=0.1, drive=Unicycle(max_force=3, max_torque=0.3))
    world = endless([robot], [puck_of(0.05, 1.5, 0.5)])
    drive(world, [[0.0], [0.0]], 3.0)
    assert world.record.collisions == 1
    assert world.velocity[:, 0] == pytest.approx([0, 0, 0], abs=1e-12)
    expected = arc(world.pose[:, 0], 0.3, 0.5, 2.0)
    drive(world, [[0.3], [0.5]], 2.0)
    assert world.pose[:, 0] == pytest.approx(expected, abs=1e-9)


def test_a_spring_at_its_centre_of_mass_does_not_turn_it():
    lead, stiffness = 0.12, 2.0
    spring = Spring(
        a="robot0", anchor_a=(lead, 0), anchor_b=(lead, 1.0), stiffness=stiffness,
        rest_length=0.8, damping=0.0,
    )  # fmt: skip
    world = endless([car_of(lead)], joints=[spring], sampling_time=0.01)
    poses = drive(world, [[0.0], [0.0]], 2 * pi * (2.0 / stiffness) ** 0.5)
    assert np.abs(poses[:, 2, 0]).max() < 1e-3
    assert poses[:, 1, 0].max() == pytest.approx(0.4, rel=0.01)


def test_the_moment_is_that_of_a_plate_about_the_centre_of_mass():
    length, width, mass = 0.5, 0.2, 2.0
    plate = mass * (length**2 + width**2) / 12
    middle = 0.1  # of the chassis, ahead of the pose
    for lead in (0.0, 0.1, 0.13, -0.05):
        expected = plate + mass * (lead - middle) ** 2
        assert car_of(lead).inertia.moment == pytest.approx(expected)
    assert car_of(0.13, moment=0.07).inertia.moment == 0.07


@each_case("lead", [0.5, -0.4, float("nan")])
def test_a_centre_of_mass_outside_of_the_robot_is_refused(lead):
    with pytest.raises(InputError, match=r"Robot\.mass_offset"):
        Robot(mass_offset=lead)
