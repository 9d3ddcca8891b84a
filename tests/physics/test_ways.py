"""Ways in contact: what lasting forces do is of second order, whatever else is touched.

Each formula stands beside a contact that does nothing, at several sampling times, and momentum and
energy are looked at after each control step.
"""

from __future__ import annotations

from math import copysign, cos, exp, pi, sin, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mars2d import Holonomic, Robot, Unicycle, World
from mars2d.addons import Map
from mars2d.bodies import Ball, Box, Puck, Rope, Spring
from tests.cases import each_case
from tests.worlds import drive, endless

FAR = Robot(pose=(0, -90, 0))
GRAVITY = 9.81


def world_of(robots=(FAR,), props=(), *, stop_time=4.0, **fields) -> World:
    return endless(robots, props, stop_time=stop_time, **fields)


def at_rest(world: World) -> World:
    """Step to the end without commands."""
    drive(world, np.zeros((2, len(world.robots))), world.scenario.stop_time)
    return world


@each_case("sampling_time", [1.0, 0.5, 0.1, 0.005])
def test_what_slides_beside_a_smooth_wall_goes_as_far_as_in_the_open(sampling_time):
    for angle in (0.0, 0.7):
        c, s = np.cos(angle), sin(angle)
        walls = Map(walls=[[(-c, -s), (30 * c, 30 * s)]])
        place, way = np.array([-s, c]) * 0.1, np.array([c, s])
        puck = Puck(
            pose=(*place, 0), velocity=(*(2 * way), 0), ground_friction=0.6, friction=0.0
        )  # fmt: skip
        for spin in (0.0, 9.0):
            turns = puck.replace(velocity=(*(2 * way), spin))
            ends = []
            for addons in ([], [walls]):
                world = world_of(props=[turns], addons=addons, sampling_time=sampling_time)
                x, y, turned = at_rest(world).prop_pose[:, 0]
                ends.append(((x - place[0]) * way[0] + (y - place[1]) * way[1], turned))
            assert ends[0] == pytest.approx(ends[1], abs=1e-9)
            assert spin or ends[1][0] == pytest.approx(4 / (2 * 0.6 * GRAVITY), rel=1e-6)


@each_case("sampling_time", [0.5, 0.1, 0.005])
def test_the_floor_holds_what_is_pushed_beside_its_middle(sampling_time):
    """It can hold 3.9 N, and 0.5 N m: the push of 2.7 N stops, as half of either would not do."""
    for offset in (-0.054, 0.03):
        robot = Robot(pose=(-0.45, offset, 0), friction=0.38, drive=Holonomic(max_force=2.7))
        box = Box(pose=(0, 0, -0.05), mass=1.08, ground_friction=0.37, friction=0.47)
        world = world_of([robot], [box], stop_time=4, sampling_time=sampling_time)
        drive(world, [[0.13], [0.02]], 4)
        path = world.record.prop_pose[round(2 / sampling_time) :, :, 0]
        assert abs(path[0, 0]) > 2e-3
        assert np.ptp(path, axis=0) == pytest.approx(0.0, abs=2e-4)


def test_drives_do_after_a_blow_what_they_do_whatever_the_sampling_time():
    """One robot pushes a box into another that comes against it."""
    box = Box(pose=(0, 0, -0.0105), mass=0.573, friction=0.249, ground_friction=0.2575)
    robots = [
        Robot(pose=(-0.5, -0.021, 0), friction=0.253, drive=Unicycle(max_force=7.1)),
        Robot(pose=(0.5, -0.1, np.pi), friction=0.056),
    ]
    ends = []
    for sampling_time in (0.1, 0.005):
        world = world_of(robots, [box], stop_time=2, sampling_time=sampling_time)
        drive(world, [[0.2792, 0.1964], [0.0, 0.0]], 2)
        ends.append(np.hstack([world.pose, world.prop_pose]))
    assert ends[0][:2] == pytest.approx(ends[1][:2], abs=2e-3)


@each_case("sampling_time", [0.5, 0.1, 0.005])
def test_floor_and_drive_give_no_more_momentum_than_they_can_while_bodies_hit(sampling_time):
    """A box turns and pushes a puck away again and again; a robot gathers speed as it does."""
    floor = {"ground_friction": 0.05, "friction": 0.0, "restitution": 0.0}
    motors = Unicycle(max_force=0.5, force_limited=True)
    robot = Robot(pose=(0, 9, 0), diameter=0.2, friction=0.0, drive=motors)
    for spin in (0.0, -1.6):
        props = [
            Box(pose=(0, 0, 0), velocity=(0.6, 0, 1.2), **floor),
            Puck(pose=(0.3, 0, 0), velocity=(0.6, 0, spin), **floor),
            Puck(pose=(0.3, 9, 0), velocity=(0.1, 0, 0), friction=0.0, ground_friction=0.0),
        ]
        world = world_of([robot], props, sampling_time=sampling_time, stop_time=1.0)
        slides = 0.05 * GRAVITY * sum(prop.inertia.mass for prop in props[:2])
        before = world.momentum.linear
        while not world.over:
            world.step([[1.0], [0.0]])
            after = world.momentum.linear
            lost = np.linalg.norm((before - after)[:, 1:3].sum(axis=1))
            gained = (after - before)[0, [0, 3]].sum()
            assert lost <= slides * sampling_time * (1 + 1e-6)
            assert gained <= 0.5 * sampling_time * (1 + 1e-6)
            before = after


def test_pucks_side_by_side_slide_as_each_alone():
    pucks = [
        Puck(pose=(0, y, 0), velocity=(2, 0, 0), ground_friction=mu, friction=0.0, diameter=0.2)
        for y, mu in ((0.0, 0.6), (0.2, 0.3))
    ]
    world = at_rest(world_of(props=pucks, sampling_time=0.5))
    ways = [4 / (2 * mu * GRAVITY) for mu in (0.6, 0.3)]
    assert world.prop_pose[0] == pytest.approx(ways, rel=1e-6)


@each_case("sampling_time", [0.5, 0.1, 0.005])
@each_case("max_overlap", [4e-3, 1e-3])
def test_a_pushed_box_goes_half_a_t_squared(sampling_time, max_overlap):
    robot = Robot(drive=Unicycle(max_force=5))
    box = Box(pose=(0.35, 0, 0), length=0.4, width=0.4, mass=1.0, ground_friction=0.5)
    world = world_of(
        [robot], [box], sampling_time=sampling_time, stop_time=1.0, max_overlap=max_overlap
    )
    a = (5 - 0.5 * GRAVITY) / 2
    while not world.over:
        world.step([[0.2], [0.0]])
        way = world.prop_pose[0, 0] - 0.35
        assert way == pytest.approx(a * world.time**2 / 2, rel=1e-3, abs=1e-6)


@each_case("sampling_time", [0.5, 0.1, 0.005])
def test_a_robot_that_was_hit_is_braked_over_its_way(sampling_time):
    drive = Unicycle(max_force=5, max_torque=5)
    ways = []
    for k in range(6):
        ball = Ball(pose=(0, -1 - 0.037 * k, 0), velocity=(0, 2.0, 0), mass=1.0, restitution=1.0)
        robot = Robot(friction=0, restitution=1, drive=drive)
        world = at_rest(world_of([robot], [ball], sampling_time=sampling_time))
        ways.append(world.pose[1, 0])
    assert ways == pytest.approx([4 / (2 * 5.0)] * 6, rel=1e-3)


@each_case("damping", [0.0, 1.0, 5.0])
@each_case("sampling_time", [0.5, 0.1, 0.02])
def test_a_spring_swings_as_the_formula_says_at_each_instant(damping, sampling_time):
    mass, stiffness, amplitude = 1.0, 10.0, 0.3
    puck = Puck(name="p", pose=(1 + amplitude, 0, 0), mass=mass, ground_friction=0.0)
    spring = Spring(a="p", b=None, rest_length=1.0, stiffness=stiffness, damping=damping)
    world = world_of(props=[puck], joints=[spring], sampling_time=sampling_time, stop_time=10)
    fades = damping / (2 * mass)
    omega = sqrt(stiffness / mass - fades**2)
    while not world.over:
        world.step([[0], [0]])
        t = world.time
        swing = np.cos(omega * t) + fades / omega * sin(omega * t)
        assert world.prop_pose[0, 0] == pytest.approx(
            1 + amplitude * exp(-fades * t) * swing, abs=5e-3 * amplitude
        )


@each_case("start", [1.0, -1.0])
@each_case("mu", [0.1, 0.3])
@each_case("sampling_time", [0.5, 0.1, 0.02])
def test_on_a_rough_floor_each_half_swing_has_its_own_middle_until_the_floor_holds(
    sampling_time, mu, start
):
    stiffness = 20.0  # and 1 kg
    aside, half = mu * 9.81 / stiffness, pi / sqrt(stiffness)

    def swing(t):
        x = start
        while abs(x) > aside and t >= half:
            x, t = 2 * copysign(aside, x) - x, t - half
        if abs(x) <= aside:
            return x
        middle = copysign(aside, x)
        return middle + (x - middle) * cos(pi * t / half)

    puck = Puck(name="p", pose=(1.5 + start, 0, 0), mass=1.0, ground_friction=mu)
    spring = Spring(a="p", b=None, rest_length=1.5, stiffness=stiffness)
    world = world_of(props=[puck], joints=[spring], sampling_time=sampling_time, stop_time=4)
    while not world.over:
        world.step([[0], [0]])
        assert world.prop_pose[0, 0] - 1.5 == pytest.approx(swing(world.time), abs=2e-3)


@each_case(
    ("velocity", "force", "grip"),
    [((1.5, 0, 0), (0, 4), 0.0), ((2, 0, 0), (-6, 0), 0.0), ((0, 0, 0), (4, 0), 0.15)],
)
@each_case("mu", [0.0, 0.1, 0.3])
@each_case("sampling_time", [0.5, 0.1, 0.02])
def test_what_is_pushed_across_back_or_beside_its_middle_goes_as_an_integrator_says(
    sampling_time, mu, velocity, force, grip
):
    box = Box(name="box", mass=1.0, velocity=velocity, ground_friction=mu)
    world = world_of(props=[box], sampling_time=sampling_time, stop_time=1.5)
    world.operator.push("box", force, 2.0, (0.0, grip))
    moment, lever = box.rigid.inertia.moment, box.rigid.shape.plate.lever
    (fx, fy), weight = force, mu * 9.81

    def acceleration(_, state):
        _, _, theta, *v = state
        x, y = -sin(theta) * grip, cos(theta) * grip
        speed = max(sqrt(v[0] ** 2 + v[1] ** 2 + (lever * v[2]) ** 2), 1e-9)
        turn = x * fy - y * fx - weight * lever**2 * v[2] / speed
        return [*v, fx - weight * v[0] / speed, fy - weight * v[1] / speed, turn / moment]

    while not world.over:
        world.step([[0], [0]])
    found = solve_ivp(acceleration, (0, 1.5), [0, 0, 0, *velocity], rtol=1e-8, atol=1e-10)
    assert world.prop_pose[:, 0] == pytest.approx(found.y[:3, -1], abs=1e-3)


@each_case("late", [-1e-3, 0.0, 1e-12, 1e-3, 2e-3])
@each_case("sampling_time", [0.5, 0.25, 0.1, 0.01])
def test_a_ball_between_two_walls_turns_where_it_touches_also_where_a_step_ends(
    sampling_time, late
):
    ball = Ball(
        diameter=0.2, velocity=(1.0, 0, 0), restitution=1.0, friction=0.0, ground_friction=0.0,
        pose=(-late, 0, 0),
    )  # fmt: skip
    walls = Map(walls=[[(x, -1), (x, 1)] for x in (-0.35, 0.35)], restitution=1.0)
    world = world_of(props=[ball], addons=[walls], sampling_time=sampling_time, stop_time=10.0)
    while not world.over:
        world.step([[0], [0]])
        phase = (world.time - late + 0.25) % 1.0
        expected = phase - 0.25 if phase < 0.5 else 0.75 - phase
        assert world.prop_pose[0, 0] == pytest.approx(expected, abs=3e-5 if late else 1e-6)


def test_momentum_and_energy_hold_after_each_control_step_of_a_blow():
    robot = Robot(restitution=1, friction=0, drive=Unicycle(max_force=1e-9, max_torque=1e-9))
    for sampling_time in (0.5, 0.005):
        for k in range(10):
            puck = Puck(
                pose=(-0.55 - 0.037 * k, 0, 0), velocity=(1, 0, 0), ground_friction=0.0,
                restitution=1.0, friction=0.0,
            )  # fmt: skip
            world = world_of([robot], [puck], sampling_time=sampling_time, stop_time=1.5)
            while not world.over:
                world.step([[0], [0]])
                assert world.momentum.linear[0].sum() == pytest.approx(1.0, abs=1e-7)
                assert world.energy.total == pytest.approx(0.5, abs=1e-7)


@each_case("sampling_time", [0.5, 0.1, 0.02, 0.005])
@each_case("many", [1, 2, 3])  # one at a wall, two and three at each other
def test_robots_whose_drivers_let_go_press_each_other_no_longer(many, sampling_time):
    drives = [(0.5, 5.0), (0.0, 5.0), (-0.5, 5.0)]
    pushing = np.zeros((2, many))
    pushing[0, 0], pushing[0, -1] = 0.5, -0.5 if many > 1 else 0.5
    robots = [
        Robot(pose=(0.31 * k, 0, 0), drive=Unicycle(max_force=drives[k][1])) for k in range(many)
    ]
    wall = [(0.3, -1), (0.3, 1)] if many == 1 else [(-9, -1), (-9, 1)]
    world = world_of(robots, addons=[Map(walls=[wall])], sampling_time=sampling_time, stop_time=9)
    while world.time < 3:
        world.step(pushing)
    pressed = [row["impulse"] / sampling_time for row in world.contacts]
    assert pressed == pytest.approx([5.0] * max(many - 1, 1), rel=1e-6)
    places = world.pose.copy()
    while world.time < 3.5:
        world.step(0 * pushing)
    world.step(0 * pushing)
    assert [row["impulse"] for row in world.contacts if row["impulse"] > 1e-12] == []
    assert np.abs(world.pose - places).max() < 1e-6


def test_a_robot_that_is_still_pushed_when_its_driver_lets_go_holds_its_place():
    robots = [Robot(), Robot(pose=(0.3, 0, 0), drive=Unicycle(max_force=4.0))]
    world = world_of(robots, stop_time=10)
    for _ in range(3):
        world.step([[0.5, -0.5], [0, 0]])
    for _ in range(20):
        world.step([[0, -0.2], [0, 0]])
    place = world.pose.copy()
    while not world.over:
        world.step([[0, -0.2], [0, 0]])
    assert world.contacts[0]["impulse"] / 0.1 == pytest.approx(4, rel=1e-6)
    assert np.abs(world.pose - place).max() < 1e-6


@each_case("sampling_time", [0.1, 0.01, 0.005])
def test_a_drive_gives_no_more_than_its_force_while_it_brakes_a_robot_that_is_hit(sampling_time):
    for k in range(12):
        drive = Unicycle(max_force=3.0, max_torque=0.2)
        robot = Robot(pose=(1, 0, 0.25 * k), mass_offset=0.06, restitution=0.3, drive=drive)
        box = Box(
            pose=(0, 0, 2.5), velocity=(1.2, 0, 0), restitution=0.3, ground_friction=0.0
        )  # fmt: skip
        world = at_rest(world_of([robot], [box], sampling_time=sampling_time, stop_time=1.5))
        given = np.diff(world.record.momentum.linear.sum(axis=2), axis=0)
        assert np.linalg.norm(given, axis=1).max() <= 3.0 * sampling_time * (1 + 1e-6)


def test_a_prop_that_is_pushed_off_its_middle_goes_as_by_much_finer_steps():
    floor = {"friction": 0.1, "ground_friction": 0.0}
    pushes = {
        "box": ([0.53, -0.06], {}, Box(pose=(0.5, -0.063, 2.4), restitution=0.3, **floor)),
        "flat": ([0.58, -0.05], {}, Box(pose=(0.5, -0.1, 0.31), **floor)),
        "puck": ([0.52, 0.02], {"grip": 0.6}, Puck(pose=(0.5, 0.057, 0), **floor)),
    }
    for name, (command, fields, prop) in pushes.items():
        robot = Robot(friction=0.1, drive=Unicycle(max_force=3.0, force_limited=True, **fields))

        def end_of(sampling_time, max_overlap, robot=robot, prop=prop, command=command):
            world = world_of(
                [robot], [prop], sampling_time=sampling_time, stop_time=2.0,
                max_overlap=max_overlap,
            )  # fmt: skip
            while not world.over:
                world.step(np.array([command]).T)
            return world.prop_pose[:2, 0]

        assert np.linalg.norm(end_of(0.1, 1e-3) - end_of(0.001, 1e-4)) < 4e-3, name


@each_case("sampling_time", [0.5, 0.1, 0.02])
def test_robots_that_slide_round_each_other_stay_in_touch(sampling_time):
    """One is pushed aside by the other: where they parted again and again they hit each other."""
    red = Robot(pose=(-0.4, -0.0962, 0), friction=0.148)
    drive = Unicycle(max_force=3.93, force_limited=True)
    blue = Robot(pose=(0, 0, 0.117), friction=0.41, drive=drive)

    def after(time, max_overlap):
        world = world_of(
            [red, blue], sampling_time=time, stop_time=2.0, max_overlap=max_overlap
        )  # fmt: skip
        begun = 0
        while not world.over:
            world.step([[0.365, 0.0], [0.0, 0.0]])
            begun += world.contacts["began"].sum()
        assert begun <= 3
        return world.pose[:2]

    assert np.abs(after(sampling_time, 1e-3) - after(0.005, 2e-5)).max() < 2e-3


@each_case("sampling_time", [0.1, 0.02])
def test_a_robot_at_a_slack_rope_follows_its_command_at_once(sampling_time):
    """The crate at the other end is pushed meanwhile, so that a solver steps both."""
    tower = Robot(name="t", pose=(0, 0.95, 0), drive=Unicycle(max_force=2.0, max_torque=0.02))
    pusher = Robot(pose=(-0.5, 0, 0), drive=Unicycle(max_force=3.0))
    crate = Box(name="b", pose=(0, 0, 0), ground_friction=0.05)
    rope = Rope(a="t", b="b", length=1.0)
    world = world_of(
        [tower, pusher], [crate], joints=[rope], sampling_time=sampling_time, stop_time=2.0
    )
    slack = 0
    while not world.over:
        turning = 1.5 if round(world.time / sampling_time) * sampling_time % 0.6 < 0.3 else -1.5
        heading = world.pose[2, 0]
        apart = [np.linalg.norm(world.pose[:2, 0] - world.prop_pose[:2, 0])]
        world.step([[0.32, 0.3], [turning, 0.0]])
        apart += [np.linalg.norm(world.pose[:2, 0] - world.prop_pose[:2, 0])]
        if max(apart) < 1 - 1e-4:
            slack += 1
            assert world.pose[2, 0] - heading == pytest.approx(turning * sampling_time, abs=1e-9)
    assert slack > 4
