"""What impacts do to energy: none adds any, in racks, heaps, wedges and at limits of gates."""

from __future__ import annotations

from itertools import pairwise
from math import cos, pi, radians, sin, sqrt, tan

import numpy as np
import pytest

from mars2d import Robot, Unicycle, World
from mars2d.addons import Map
from mars2d.bodies.joints import Hinge, Rod, Rope
from mars2d.bodies.props import Ball, Bar, Box, Gate, Prop, Puck
from tests.cases import each_case
from tests.worlds import endless

FAR = Robot(pose=(80.0, 80.0, 0.0))

TOLERANCE = 1e-9
"""By how much of all energy a control step may add to it."""


def energy(world: World) -> float:
    """The kinetic energy of robots and props, J."""
    mass, moment = np.array([body.inertia for body in world.scenario.bodies]).T
    vx, vy, spin = np.hstack([world.velocity, world.prop_velocity])
    return float((mass * (vx**2 + vy**2) + moment * spin**2).sum() / 2)


def momentum(world: World) -> np.ndarray:
    """The momentum of the props, N s."""
    mass = np.array([prop.inertia.mass for prop in world.scenario.props])
    return world.prop_velocity[:2] @ mass


def energies(world: World, seconds: float) -> np.ndarray:
    """The energies while nothing drives, one for each control step."""
    still = np.zeros((2, len(world.scenario.robots)))
    found = [energy(world)]
    for _ in range(round(seconds / world.scenario.sampling_time)):
        world.step(still)
        found.append(energy(world))
    return np.array(found)


def assert_never_grows(found: np.ndarray) -> None:
    assert np.diff(found).max() <= TOLERANCE * found[0]
    assert found[-1] < found[0]  # something did happen


def rack(restitution: float, friction: float) -> list[Prop]:
    """A ball that flies at fifteen others, which lie as at the start of a game of billiards."""
    looks = {"restitution": restitution, "friction": friction, "ground_friction": 0.0}
    places = [
        (0.1 * sqrt(3) * row, 0.1 * (2 * k - row)) for row in range(5) for k in range(row + 1)
    ]
    lying = [Puck(diameter=0.2, pose=(x, y * (1 + 1e-9), 0), **looks) for x, y in places]
    return [Puck(diameter=0.2, pose=(-1, 0.03, 0), velocity=(3, 0, 0), **looks), *lying]


@each_case("sampling_time", [0.005, 0.02, 0.1])
@each_case(("restitution", "friction"), [(1.0, 1.0), (1.0, 0.2), (0.9, 1.0)])
def test_a_rack_of_discs_gains_no_energy(restitution, friction, sampling_time):
    world = endless([FAR], rack(restitution, friction), sampling_time=sampling_time)
    before = momentum(world)
    assert_never_grows(energies(world, 1.2))
    assert momentum(world) == pytest.approx(before, abs=1e-9)


@each_case("restitution", [1.0, 0.9, 0.5])
def test_a_bar_that_hits_a_wall_gains_no_energy(restitution):
    rng = np.random.default_rng(7)
    for _ in range(10):
        bar = Bar(
            pose=(-0.6, 0, rng.uniform(-pi, pi)),
            velocity=(rng.uniform(0.5, 3), rng.uniform(-2, 2), rng.uniform(-8, 8)),
            friction=rng.uniform(0, 1.5), restitution=restitution, ground_friction=0.0,
        )  # fmt: skip
        world = endless([FAR], [bar], addons=[Map([[(0.5, -9), (0.5, 9)]])], sampling_time=0.02)
        found = energies(world, 1.5)
        assert np.diff(found).max() <= TOLERANCE * found[0]


@each_case("material", ["glass", "rubber", "steel"])
def test_a_heap_in_a_room_gains_no_energy(material):
    rng = np.random.default_rng(0)
    props = [
        (Box, Puck, Bar)[k % 3](
            pose=(k % 4 - 1.5, k // 4 - 1.0, rng.uniform(-pi, pi)),
            velocity=(*rng.uniform(-2, 2, 2), rng.uniform(-5, 5)),
            friction=material, restitution=material, ground_friction=0.0,
        )
        for k in range(12)
    ]  # fmt: skip
    corners = [(-2.2, -1.7), (2.2, -1.7), (2.2, 1.7), (-2.2, 1.7), (-2.2, -1.7)]
    walls = [list(pair) for pair in pairwise(corners)]
    world = endless([FAR], props, addons=[Map(walls)], sampling_time=0.02)
    assert_never_grows(energies(world, 3))


@each_case(("restitution", "friction"), [(0.0, 0.5), (1.0, 1.0), (1.0, 0.0)])
def test_joints_gain_no_energy_either(restitution, friction):
    rng = np.random.default_rng(0)
    props = [
        (Ball, Box, Puck)[k % 3](
            name=f"p{k}", pose=(0.7 * (k % 3), 0.7 * (k // 3), 0.0),
            velocity=(*rng.uniform(-1, 1, 2), rng.uniform(-3, 3)), mass=float(1 + k % 3),
            friction=friction, restitution=restitution, ground_friction=0.0,
        )
        for k in range(9)
    ]  # fmt: skip
    joints = [
        Rope(a="p0", b="p4", length=1.1),
        Rod(a="p1", b="p2"),
        Hinge(a="p5", b="p8", anchor_a=(0, 0.35), anchor_b=(0, -0.35), limits=(-1, 1)),
        Hinge(a="p6", anchor_a=(0.2, 0), anchor_b=(0.2, 1.4)),
    ]
    world = endless([FAR], props, joints=joints, sampling_time=0.05)
    world.step([[0], [0]])  # a joint takes what does not fit it at the start
    assert_never_grows(energies(world, 8))


def test_robots_that_brake_gain_no_energy_from_what_hits_them():
    rng = np.random.default_rng(3)
    robots = [
        Robot(
            pose=(cos(k), sin(k), k), friction=1.0, restitution=1.0,
            drive=Unicycle(max_force=3, max_torque=0.2),
        )
        for k in range(6)
    ]  # fmt: skip
    props = [
        Box(
            pose=(2.5 * cos(k), 2.5 * sin(k), k), friction=1.0, restitution=1.0,
            velocity=(-2 * cos(k), -2 * sin(k), rng.uniform(-4, 4)), ground_friction=0.0,
        )
        for k in range(6)
    ]  # fmt: skip
    assert_never_grows(energies(endless(robots, props, sampling_time=0.02), 3))


# -- several at once --------------------------------------------------------------------------


@each_case("gap", [1e-8, 1e-6, 1e-3])
@each_case("count", [3, 5])
def test_balls_in_a_row_with_gaps_are_hit_one_after_the_other(gap, count):
    world = endless([FAR], row(count, gap), sampling_time=0.05)
    energies(world, 1.5)
    assert world.prop_velocity[0] == pytest.approx([0.0] * (count - 1) + [1.0], abs=1e-3)


@each_case("count", [3, 4, 5])
def test_balls_that_touch_are_hit_at_once(count):
    """Momentum and energy are kept, but the first one flies back; a gap of 1e-9 m is none."""
    for gap in (0.0, 1e-12):
        world = endless([FAR], row(count, gap), sampling_time=0.05)
        energies(world, 1.5)
        v = world.prop_velocity[0]
        assert v[0] < -0.3
        assert v.sum() == pytest.approx(1.0, abs=1e-9)
        assert 0.99 < (v**2).sum() <= 1.0 + 1e-9
        assert np.diff(v).min() > -2e-4  # nobody moves into another, but for what the solver leaves


def row(count: int, gap: float) -> list[Prop]:
    """A ball that flies at others in a row, all alike."""
    look = {"diameter": 0.2, "restitution": 1.0, "friction": 0.0, "ground_friction": 0.0}
    lying = [Ball(pose=(k * (0.2 + gap), 0, 0), **look) for k in range(count - 1)]
    return [Ball(pose=(-0.5, 0, 0), velocity=(1, 0, 0), **look), *lying]


# -- wedges -----------------------------------------------------------------------------------


def wedge(half_angle: float, radius: float) -> list[list[tuple[float, float]]]:
    """Two walls that meet on the x axis, where a disc about the origin touches both at x = 1."""
    tip = radius / sin(half_angle) + 1.0
    return [[(-4.0, side * (tip + 4.0) * tan(half_angle)), (tip, 0.0)] for side in (1, -1)]


@each_case("degrees", [0.5, 5.0])
@each_case(("force", "speed"), [(5.0, 0.3), (50.0, 1.0)])
def test_a_shallow_wedge_throws_no_robot_back(degrees, force, speed):
    half = radians(degrees)
    for friction in (0.0, 0.5 * tan(half)):
        robot = Robot(drive=Unicycle(max_force=force), friction=friction)
        world = endless(
            [robot], addons=[Map(wedge(half, 0.15))], sampling_time=0.05, max_overlap=1e-3
        )
        for _ in range(80):
            world.step([[speed], [0.0]])
            assert world.velocity[0, 0] > -0.05 * speed
            # In overlap d with both walls it stands d / sin(half) further ahead.
            assert world.pose[0, 0] <= 1.0 + 1e-3 / sin(half)
        assert world.pose[0, 0] > 1.0 - 1e-3
        assert world.pose[1, 0] == pytest.approx(0.0, abs=1e-3)


@each_case("restitution", [0.0, 0.5, 1.0])
@each_case("degrees", [0.5, 2.0, 10.0, 20.0, 45.0])
def test_a_ball_comes_out_of_a_wedge_at_its_restitution_at_most(degrees, restitution):
    ball = Ball(
        diameter=0.2, velocity=(1, 0, 0), friction=0.0, restitution=restitution, ground_friction=0
    )
    walls = Map(wedge(radians(degrees), 0.1))
    world = endless([FAR], [ball], addons=[walls], sampling_time=0.05)
    energies(world, 1.5)
    rebound = -world.prop_velocity[0, 0]
    # Between nearly parallel walls the solver leaves a little more.
    assert -0.01 <= rebound <= restitution + (2e-2 if degrees < 1 else 1e-2)
    if degrees >= 20:  # the solver settles: both normal speeds are turned round, times e
        assert rebound == pytest.approx(restitution, abs=2e-3)


# -- limits -----------------------------------------------------------------------------------


@each_case("restitution", [0.0, 0.3, 0.8, 1.0])
@each_case("spin", [0.1, -2.0, 30.0])
def test_a_gate_turns_back_from_its_limit_at_its_restitution(restitution, spin):
    for share in (0.03, 0.17, 0.9):  # of the time to the limit: the sampling time
        gate = Gate(
            pose=(0.5, 0, 0), velocity=(0, 0.5 * spin, spin), limits=(-0.5, 0.5), damping=0.0,
            limit_restitution=restitution,
        )  # fmt: skip
        world = endless([FAR], [gate], sampling_time=share * 0.5 / abs(spin), stop_time=1e3)
        turned = 0.0
        for _ in range(round(1.4 / share) + 1):
            world.step([[0], [0]])
            turned = max(turned, abs(world.prop_pose[2, 0]))
        assert world.prop_velocity[2, 0] == pytest.approx(-restitution * spin, abs=2e-3 * abs(spin))
        assert turned <= 0.5 + 1e-3  # 1 mm at its tip


@each_case("restitution", [0.0, 0.6, 1.0])
def test_two_boxes_on_a_hinge_part_at_the_restitution_of_its_limit(restitution):
    """Their spins change at the limit as momentum, a hinge that holds, and the limit demand.

    A pair of impulses (p, q) acts at the pin and a pair of torques t between the bodies: five
    unknown velocities and three impulses follow from eight linear equations.
    """
    size = {"length": 1.0, "width": 0.4, "ground_friction": 0.0}
    first = Box(name="a", pose=(0, 0, 0), mass=2.0, **size)
    second = Box(name="b", pose=(1, 0, 0), velocity=(0, 0.5, 1.0), mass=1.0, **size)
    hinge = Hinge(
        a="a", b="b", anchor_a=(0.5, 0), anchor_b=(-0.5, 0), limits=(-0.4, 0.4),
        limit_restitution=restitution,
    )  # fmt: skip
    world = endless([FAR], [first, second], joints=[hinge], sampling_time=1e-3)
    before = after = world.prop_velocity
    for _ in range(2000):
        before, pose = world.prop_velocity, world.prop_pose
        world.step([[0], [0]])
        after = world.prop_velocity
        if (after[2, 1] - after[2, 0]) < (before[2, 1] - before[2, 0]) - 0.05:
            break
    found = after - before
    inverse = [[1 / prop.inertia.mass] * 2 + [1 / prop.inertia.moment] for prop in (first, second)]
    c, s = np.cos(pose[2]), np.sin(pose[2])
    arm_a, arm_b = 0.5 * np.array([c[0], s[0]]), -0.5 * np.array([c[1], s[1]])
    rows = np.array(
        [  # the point on b less that on a, along x and y, and the spin of b less that of a
            [-1, 0, arm_a[1], 1, 0, -arm_b[1]],
            [0, -1, -arm_a[0], 0, 1, arm_b[0]],
            [0, 0, -1, 0, 0, 1],
        ]
    )
    state = before.T.ravel()
    wanted = np.array([0, 0, -restitution * (rows @ state)[2]]) - rows @ state
    weights = np.diag(np.ravel(inverse))
    change = weights @ rows.T @ np.linalg.solve(rows @ weights @ rows.T, wanted)
    assert found.T.ravel() == pytest.approx(change, abs=0.02 * np.abs(change).max())
