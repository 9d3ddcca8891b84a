"""Ropes, rods, springs and hinges: they hold what they should, with the forces of the textbook."""

from __future__ import annotations

from math import exp, hypot, pi, sqrt

import numpy as np
import pytest

from mars2d import InputError, Robot, Unicycle, World
from mars2d.bodies.joints import Hinge, Rod, Rope, Spring
from mars2d.bodies.props import Ball, Bar, Box, Puck
from mars2d.core.materials import GRAVITY
from tests.cases import each_case
from tests.worlds import drive, endless

IDLE = Robot(pose=(50, 50, 0))
MILLIMETRE = 1e-3


def coast(world: World, seconds: float) -> np.ndarray:
    return drive(world, np.zeros((2, len(world.scenario.robots))), seconds)


def at(pose: np.ndarray, anchor) -> np.ndarray:
    """Where a body's anchor lies, for poses (T, 3): (T, 2)."""
    x, y, theta = pose.T
    return np.column_stack(
        [
            x + anchor[0] * np.cos(theta) - anchor[1] * np.sin(theta),
            y + anchor[0] * np.sin(theta) + anchor[1] * np.cos(theta),
        ]
    )


def apart(first: np.ndarray, second) -> np.ndarray:
    return np.hypot(*(first - second).T)


# -- ropes ----------------------------------------------------------------------------------


@each_case("mu", [0.1, 0.2, 0.4])
def test_towing_a_box_by_a_rope_takes_the_effort_mu_m_g_over_the_force(mu):
    world = endless(
        [Robot()], [Box(pose=(-1, 0, 0), ground_friction=mu)], [Rope(a="robot0", b="box0")]
    )
    poses = drive(world, [[0.3], [0]], 6)
    assert world.prop_velocity[0, 0] == pytest.approx(0.3, abs=2e-3)
    assert world.effort[0] == pytest.approx(mu * GRAVITY / 5, rel=0.01)
    assert apart(poses[:, :2, 0], poses[:, :2, 1]).max() < 1 + MILLIMETRE


@each_case(("speed", "sampling_time"), [(0.1, 0.5), (0.5, 0.02), (0.5, 0.5), (3.0, 0.5)])
def test_a_rope_is_never_longer_than_its_length_and_a_millimetre(speed, sampling_time):
    puller = Robot(drive=Unicycle(max_linear_speed=speed), mass=3)
    box = Box(pose=(-1, 0.3, 0), ground_friction=0.2)
    rope = Rope(a="robot0", b="box0", length=1.5, anchor_a=(-0.15, 0), anchor_b=(0.2, 0.2))
    world = endless([puller], [box], [rope], sampling_time=sampling_time)
    poses = drive(world, [[speed], [0]], max(1.5, 1 / speed))
    length = apart(at(poses[:, :, 0], rope.anchor_a), at(poses[:, :, 1], rope.anchor_b))
    assert length.max() < 1.5 + MILLIMETRE
    if speed < 1:  # a box that a jerk has thrown about comes along on a slack rope
        assert length[-1] > 1.5 - MILLIMETRE


def test_a_slack_rope_does_nothing():
    ball = Ball(pose=(1, 0, 0), velocity=(0.2, 0.1, 0))
    world = endless([Robot()], [ball], [Rope(a="robot0", b="ball0", length=5)])
    drive(world, [[0.1], [0.2]], 5)
    assert world.prop_pose[:2, 0] == pytest.approx([2, 0.5], abs=1e-9)
    assert world.pose[2, 0] == pytest.approx(1, abs=1e-9)
    assert world.effort[0] == 0


def test_a_jerk_on_a_rope_is_inelastic_and_keeps_the_momentum():
    balls = [Ball(velocity=(-1, 0, 0), mass=1), Ball(pose=(0.5, 0, 0), mass=3)]
    world = endless([IDLE], balls, [Rope(a="ball0", b="ball1", length=1)])
    coast(world, 2)
    assert world.prop_velocity[0] == pytest.approx([-0.25, -0.25], rel=0.01)
    momentum = world.prop_velocity[0] @ [1, 3]
    assert momentum == pytest.approx(-1, abs=1e-9)


# -- rods -----------------------------------------------------------------------------------


def test_a_rod_keeps_its_length_and_a_stone_at_it_its_speed():
    ball = Ball(pose=(1, 0, 0), velocity=(0, 1, 0))
    world = endless([IDLE], [ball], [Rod(a="ball0")], sampling_time=0.05)
    poses = coast(world, 2 * pi)[:, :2, 1]
    assert np.abs(np.hypot(*poses.T) - 1).max() < MILLIMETRE
    assert hypot(*world.prop_velocity[:2, 0]) == pytest.approx(1, rel=0.01)
    turned = np.unwrap(np.arctan2(poses[:, 1], poses[:, 0]))[-1]
    assert turned == pytest.approx(world.time, rel=0.01)


# -- springs --------------------------------------------------------------------------------


def periods(world: World, values: np.ndarray) -> np.ndarray:
    """The times [s] between rises of samples through zero, by straight lines between them."""
    k = np.flatnonzero((values[:-1] < 0) & (values[1:] >= 0))
    return np.diff(k - values[k] / (values[k + 1] - values[k])) * world.scenario.sampling_time


@each_case(("stiffness", "mass"), [(5, 1.0), (20, 1.0), (400, 1.0), (20, 4.0)])
def test_a_mass_at_a_spring_swings_with_the_period_two_pi_root_m_over_k(stiffness, mass):
    period = 2 * pi * sqrt(mass / stiffness)
    ball = Ball(pose=(1.2, 0, 0), mass=mass)
    spring = Spring(a="ball0", rest_length=1, stiffness=stiffness)
    world = endless([IDLE], [ball], [spring], sampling_time=period / 50)
    x = coast(world, 5.5 * period)[:, 0, 1] - 1
    found = periods(world, x)
    assert len(found) >= 4
    assert found == pytest.approx(period, rel=0.01)
    assert np.abs(x).max() == pytest.approx(0.2, rel=0.01)


def test_two_masses_at_a_spring_swing_with_their_reduced_mass():
    balls = [Ball(pose=(0, 0, 0), mass=1), Ball(pose=(1.2, 0, 0), mass=3)]
    spring = Spring(a="ball0", b="ball1", rest_length=1, stiffness=30)
    period = 2 * pi * sqrt((1 * 3 / 4) / 30)
    world = endless([IDLE], balls, [spring], sampling_time=period / 50)
    x = coast(world, 4.5 * period)[:, 0, 1:]
    assert periods(world, x[:, 1] - x[:, 0] - 1) == pytest.approx(period, rel=0.01)
    middle = x @ [1, 3] / 4
    assert np.abs(middle - 0.9).max() < 1e-9


# -- hinges ---------------------------------------------------------------------------------


def test_the_anchors_of_a_hinge_stay_together_under_load():
    trailer = Box(pose=(-0.5, 0, 0), length=0.3, width=0.2, ground_friction=0.3, name="trailer")
    hinge = Hinge(a="robot0", b="trailer", anchor_a=(-0.25, 0), anchor_b=(0.25, 0))
    world = endless([Robot(drive=Unicycle(max_force=8))], [trailer], [hinge])
    for command in ([[0.3], [0.5]], [[0.2], [-1]], [[-0.2], [0]], [[0.5], [0]]):
        poses = drive(world, command, 3)
        gap = apart(at(poses[:, :, 0], (-0.25, 0)), at(poses[:, :, 1], (0.25, 0)))
        assert gap.max() < MILLIMETRE


def test_the_links_of_a_chain_that_swings_freely_stay_together():
    n = 5
    bars = [
        Bar(
            pose=(0.5 * i, 0, 0), length=0.5, name=f"link{i}", ground_friction=0,
            velocity=(0, float(i == n - 1), 0),
        )
        for i in range(n)
    ]  # fmt: skip
    hinges = [Hinge(a="link0", anchor_a=(-0.25, 0), anchor_b=(-0.25, 0))]
    hinges += [
        Hinge(a=f"link{i}", b=f"link{i + 1}", anchor_a=(0.25, 0), anchor_b=(-0.25, 0))
        for i in range(n - 1)
    ]
    world = endless([IDLE], bars, hinges)
    poses = coast(world, 8)
    for i in range(n - 1):
        gap = apart(at(poses[:, :, 1 + i], (0.25, 0)), at(poses[:, :, 2 + i], (-0.25, 0)))
        assert gap.max() < 2 * MILLIMETRE
    assert apart(at(poses[:, :, 1], (-0.25, 0)), (-0.25, 0)).max() < MILLIMETRE


@pytest.mark.parametrize("other", [False, True])
def test_the_limits_of_a_hinge_are_angles_of_b_against_a(other):
    """With a fast floor brake on one of them, the other is turned against its limit by a robot."""
    base = Box(pose=(0, 0, 0.5), mass=10, ground_friction=5, name="base")
    arm = Bar(pose=(0.5, 0, 0), name="arm", ground_friction=0, velocity=(0, 0.5, 1.0))
    if other:
        hinge = Hinge(a="arm", b="base", anchor_a=(-0.5, 0), limits=(-0.3, 0))
    else:
        hinge = Hinge(a="base", b="arm", anchor_b=(-0.5, 0), limits=(0, 0.3))
    world = endless([IDLE], [base, arm], [hinge], sampling_time=0.02)
    angle = coast(world, 2)[:, 2, 2]
    assert angle.max() == pytest.approx(0.3, abs=0.02)
    assert angle.min() > -0.02


def test_a_hinge_with_a_spring_swings_with_the_period_of_its_moment():
    bar = Bar(pose=(0.5, 0, 0), ground_friction=0, mass=2, velocity=(0, 0.1, 0.2))
    hinge = Hinge(a="bar0", anchor_a=(-0.5, 0), stiffness=8)
    moment = bar.inertia.moment + 2 * 0.5**2
    period = 2 * pi * sqrt(moment / 8)
    world = endless([IDLE], [bar], [hinge], sampling_time=period / 50)
    angle = coast(world, 4.5 * period)[:, 2, 1]
    assert periods(world, angle) == pytest.approx(period, rel=0.01)
    assert np.abs(angle).max() == pytest.approx(0.2 * sqrt(moment / 8), rel=0.02)


def test_a_damped_hinge_comes_to_rest_as_exponentials_do():
    bar = Bar(pose=(0.5, 0, 0), ground_friction=0, velocity=(0, 0.5, 1.0))
    hinge = Hinge(a="bar0", anchor_a=(-0.5, 0), damping=0.2)
    rate = 0.2 / (bar.inertia.moment + 0.5**2)
    world = endless([IDLE], [bar], [hinge], sampling_time=0.02)
    coast(world, 1)
    assert world.prop_velocity[2, 0] == pytest.approx(exp(-rate), rel=0.02)


def test_a_puck_on_a_hinge_is_held_by_floor_and_hinge_at_once():
    puck = Puck(pose=(0, 0, 0), velocity=(0, 0, 8), ground_friction=0.2)
    world = endless([IDLE], [puck], [Hinge(a="puck0")], sampling_time=0.002)
    poses = coast(world, 0.5)
    assert np.abs(poses[:, :2, 1]).max() < 1e-6
    slowing = 0.2 * GRAVITY * (2 / 3 * 0.1) / (0.1**2 / 2)
    assert world.prop_velocity[2, 0] == 0
    assert poses[-1, 2, 1] == pytest.approx(8**2 / (2 * slowing), rel=0.02)


# -- refused --------------------------------------------------------------------------------


@each_case(
    ("joint", "said"),
    [
        (lambda: Rope(a="robot0", b="ball0", length=-1), "Rope.length = -1"),
        (lambda: Rod(a="robot0", b="ball0", length=2), "start 1 m apart"),
        (lambda: Rope(a="robot0", b="robot0"), "another body than a"),
        (lambda: Rope(a="robot0", b="bal0"), "did you mean 'ball0'"),
        (lambda: Spring(a="robot0", b="ball0", damping=float("nan")), "Spring.damping = nan"),
        (lambda: Rope(a="robot0", b="ball0", anchor_a=(1, 0)), "use a Hinge"),
    ],
)
def test_joints_that_cannot_be_are_refused_by_name(joint, said):
    with pytest.raises(InputError) as error:
        endless([Robot()], [Ball(pose=(1, 0, 0))], [joint()])
    assert said in str(error.value)
