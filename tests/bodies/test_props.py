"""Props: they slide to rest by the formula, and what pushes them does so by its force."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest

from mars2d import Robot, Unicycle
from mars2d.bodies.props import Ball, Bar, Box, Gate, Prop, Puck, Solid
from mars2d.core.materials import GRAVITY
from mars2d.geometry.shapes import Compound, Disc
from tests.cases import each_case
from tests.worlds import ELL, drive, endless

EXACT = 1e-9  # metres, radians
IDLE = Robot(pose=(50, 50, 0))


def glided(prop: Prop, t: float) -> list[float]:
    """Where a prop that slides or spins is after t seconds: the formulas of the textbook."""
    (x, y, theta), (vx, vy, spin) = prop.pose, prop.velocity
    mass, moment = prop.inertia
    brake = prop.ground_friction * GRAVITY
    slow = prop.ground_friction * mass * GRAVITY * prop.shape.plate.lever / moment
    speed = np.hypot(vx, vy)
    t_slide = min(t, speed / brake) if brake else t
    t_spin = min(t, abs(spin) / slow) if slow else t
    way = (speed * t_slide - brake * t_slide**2 / 2) / speed if speed else 0.0
    turn = spin * t_spin - np.sign(spin) * slow * t_spin**2 / 2
    return [x + vx * way, y + vy * way, theta + turn]


PROPS = [
    Puck(pose=(0, 0, 1), velocity=(1.5, -0.5, 0)),
    Box(pose=(0, 9, 0), velocity=(0.3, 2.0, 0), ground_friction=0.3, mass=3),
    Ball(pose=(0, -9, 0), velocity=(-0.4, 0.1, 2)),
    Bar(pose=(0, 18, 0.3), velocity=(0, 0, 9), ground_friction=0.05),
    Solid(ELL, pose=(0, 27, -1), velocity=(0, 0, 5), ground_friction=0.2),
    Solid(Compound([Disc(0.3), Disc(0.2).moved(0.3, 0)]), pose=(0, -18, 2), velocity=(1, 0, 0)),
]


@each_case("sampling_time", [1e-3, 0.02, 0.1, 1.0, 10.0])
def test_props_glide_as_the_formula_says(sampling_time):
    world = endless([IDLE], PROPS, sampling_time=sampling_time)
    for _ in range(max(2, min(round(4 / sampling_time), 200))):
        world.step([[0], [0]])
        expected = np.transpose([glided(prop, world.time) for prop in PROPS])
        assert np.abs(world.prop_pose - expected).max() < EXACT


@each_case("sampling_time", [0.05, 0.5, 2.0])
def test_props_glide_exactly_while_others_near_them_push_and_cause_substeps(sampling_time):
    # Two robots press against each other; two pucks pass on either side, a few millimetres off.
    robots = [Robot(pose=(-0.2, 0, 0)), Robot(pose=(0.2, 0, pi))]
    pucks = [
        Puck(pose=(-1, 0.255, 0), velocity=(1, 0, 0), ground_friction=0.05),
        Puck(pose=(1, -0.255, 0), velocity=(-0.8, 0, 0), ground_friction=0.05),
        Box(pose=(-1, 0.66, 0), velocity=(0.9, 0, 0), ground_friction=0.05, length=0.5),
    ]
    world = endless(robots, pucks, sampling_time=sampling_time)
    for _ in range(round(4 / sampling_time)):
        world.step([[0.3, 0.3], [0, 0]])
        expected = np.transpose([glided(prop, world.time) for prop in pucks])
        assert np.abs(world.prop_pose - expected).max() < EXACT
    assert set(world.record.contacts[["a", "b"]].tolist()) == {(0, 1)}


# -- pushing --------------------------------------------------------------------------------


def moves(robot: Robot, prop: Prop) -> bool:
    """Whether a robot that comes to touch a prop slowly keeps it moving.

    What is too heavy coasts for less than 0.4 s after the impact, for a hundredth more than can be
    overcome.
    """
    world = endless([robot], [prop])
    drive(world, [[0.02], [0]], 7.5)
    before = world.prop_pose[0, 0]
    drive(world, [[0.02], [0]], 0.5)
    return bool(world.prop_pose[0, 0] - before > 0.002)


@each_case(("force", "prop", "x"), [(5, Box(mass=2.5), -0.351), (4, Solid(ELL), -0.371)])
def test_a_prop_moves_up_to_the_friction_that_the_force_overcomes(force, prop, x):
    robot = Robot(pose=(x, 0, 0), drive=Unicycle(max_force=force), friction=0)
    mu = force / (prop.inertia.mass * GRAVITY)
    assert moves(robot, prop.replace(ground_friction=0.98 * mu))
    assert not moves(robot, prop.replace(ground_friction=1.02 * mu))


@each_case(
    "prop",
    [Box(ground_friction=0), Ball(diameter=0.4), Puck(diameter=0.4, ground_friction=0)],
)
@each_case("mass", [0.5, 2.0])
def test_a_frictionless_prop_is_accelerated_by_force_over_both_masses(prop, mass):
    robot = Robot(pose=(-0.3501, 0, 0), drive=Unicycle(max_force=0.3))
    world = endless([robot], [prop.replace(mass=mass, restitution=0)])
    drive(world, [[0.5], [0]], 0.2)  # the impact leaves the share 1 / (1 + mass) of the speed
    before = world.prop_velocity[0, 0]
    drive(world, [[0.5], [0]], 0.5)
    rise = world.prop_velocity[0, 0] - before
    assert rise == pytest.approx(0.5 * 0.3 / (1 + mass), rel=1e-3)


@each_case("mu", [0.1, 0.3, 0.45])
def test_the_effort_of_pushing_a_box_is_mu_m_g_over_the_force(mu):
    world = endless([Robot(pose=(-0.36, 0, 0))], [Box(ground_friction=mu)])
    drive(world, [[0.2], [0]], 3)
    assert world.prop_velocity[0, 0] == pytest.approx(0.2, abs=1e-9)
    assert world.effort[0] == pytest.approx(mu * GRAVITY / 5, rel=2e-3)


def test_a_gate_opens_to_its_limit_and_lets_a_robot_past():
    gate = Gate(pose=(0, 0, -pi / 2), limits=(0, pi / 2))
    world = endless([Robot(pose=(-1, -0.3, 0))], [gate])
    drive(world, [[0.3], [0]], 8)
    assert world.prop_pose[2, 0] <= 1e-3
    assert world.prop_pose[2, 0] > -pi / 2 + 1.0
    hinge = world.prop_pose[:2, 0] - 0.5 * np.array(
        [cos(world.prop_pose[2, 0]), sin(world.prop_pose[2, 0])]
    )
    assert hinge == pytest.approx([0, 0.5], abs=1e-3)


def test_a_gate_with_a_spring_shuts_again():
    gate = Gate(pose=(0, 0, -pi / 2), stiffness=2, damping=1)
    world = endless([Robot(pose=(-1, -0.3, 0))], [gate])
    drive(world, [[0.3], [0]], 6)
    assert world.pose[0, 0] > 0.5
    drive(world, [[0.3], [0]], 6)
    assert world.prop_pose[2, 0] == pytest.approx(-pi / 2, abs=1e-3)
