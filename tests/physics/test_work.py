"""The account of energy: work of drives, floors, contacts and joints adds up to what there is."""

from __future__ import annotations

from math import cos, hypot, pi, radians, sin, sqrt

import numpy as np
import pytest

from mars2d import Holonomic, Robot, Unicycle, World
from mars2d.addons import Map
from mars2d.bodies import Car
from mars2d.bodies.joints import Rod, Rope, Spring
from mars2d.bodies.props import Ball, Box, Gate, Puck
from mars2d.core.materials import GRAVITY
from tests.cases import each_case
from tests.worlds import endless

FAR = Robot(pose=(60, 60, 0))
DRIVES, FLOOR, FRICTION, IMPACTS, JOINTS, HANDS = range(6)


def work(world: World) -> np.ndarray:
    """The work since the start, J."""
    return world.energy.work


def kinetic(world: World) -> float:
    """The kinetic energy of all bodies, J: about each one's centre of mass."""
    total = 0.0
    velocities = np.hstack([world.velocity, world.prop_velocity]).T
    poses = np.hstack([world.pose, world.prop_pose]).T
    for body, (vx, vy, spin), (_, _, theta) in zip(
        world.scenario.bodies, velocities, poses, strict=True
    ):
        lead = body.lead
        x, y = vx - spin * lead * sin(theta), vy + spin * lead * cos(theta)
        total += (body.inertia.mass * (x * x + y * y) + body.inertia.moment * spin**2) / 2
    return float(total)


def balanced(world: World, command: object, seconds: float, tolerance: float = 1e-9) -> None:
    """Run a world, and look at each control step whether the account is right."""
    start, largest = kinetic(world) - work(world).sum(), 1e-12
    for _ in range(round(seconds / world.scenario.sampling_time)):
        world.step(command)
        now = kinetic(world)
        largest = max(largest, now, np.abs(work(world)).max())
        assert abs(now - start - work(world).sum()) <= tolerance * largest


def test_a_slide_loses_all_to_the_floor():
    box = Box(velocity=(2, 0, 0), mass=3.0, ground_friction=0.4)
    world = endless([FAR], [box])
    balanced(world, [[0], [0]], 2)
    assert work(world) == pytest.approx([0, -0.5 * 3 * 4, 0, 0, 0, 0], abs=1e-9)


@each_case("restitution", [0.0, 0.6, 1.0])
def test_a_straight_impact_loses_what_restitution_takes(restitution):
    """(1 - e^2) / 2 times the reduced mass times the square of the speed."""
    look = {"friction": 0.3, "ground_friction": 0.0, "restitution": sqrt(restitution)}
    first = Ball(pose=(-1, 0, 0), velocity=(2, 0, 0), mass=1.0, **look)
    second = Ball(mass=3.0, **look)
    world = endless([FAR], [first, second])
    balanced(world, [[0], [0]], 2)
    lost = (1 - restitution**2) / 2 * (1 * 3 / 4) * 2**2
    assert work(world) == pytest.approx([0, 0, 0, -lost, 0, 0], abs=1e-3)


@each_case("mu", [0.1, 0.25])
def test_an_oblique_impact_of_a_disc_loses_to_friction_what_it_slides(mu):
    """It slides all the time: the friction's impulse is mu (1 + e) m v_n."""
    e, m, vn, vt = 0.5, 2.0, 1.0, 3.0
    puck = Puck(
        diameter=0.2, pose=(0, 0.5, 0), velocity=(vt, -vn, 0), mass=m, friction=mu,
        restitution=e, ground_friction=0.0,
    )  # fmt: skip
    world = endless([FAR], [puck], addons=[Map([[(-9, 0), (9, 0)]])])
    balanced(world, [[0], [0]], 1)
    push = (1 + e) * m * vn
    after = vt - mu * push / m
    spin = mu * push * 0.1 / puck.inertia.moment
    assert after - spin * 0.1 > 0  # it does slide until the end
    change = m * (after**2 - vt**2) / 2 + puck.inertia.moment * spin**2 / 2
    assert work(world)[FRICTION] == pytest.approx(change, rel=1e-3)
    assert work(world)[IMPACTS] == pytest.approx(-(1 - e**2) * m * vn**2 / 2, rel=1e-3)


@each_case("limited", [False, True])
def test_what_a_drive_does_in_the_open_is_the_energy_of_its_robot(limited):
    robot = Robot(mass=2.0, drive=Unicycle(force_limited=limited, max_force=4, max_torque=1))
    world = endless([robot])
    balanced(world, [[0.4], [0.8]], 3)
    whole = (2 * 0.4**2 + robot.inertia.moment * 0.8**2) / 2
    assert work(world)[DRIVES] == pytest.approx(whole, rel=1e-6)


def test_a_steady_push_gives_the_floor_what_the_drive_does():
    """mu m g v a second, once box and robot have their speed."""
    box = Box(pose=(0.5, 0, 0), mass=1.0, ground_friction=0.3)
    world = endless([Robot(drive=Unicycle(max_force=20))], [box], sampling_time=0.05)
    balanced(world, [[0.4], [0]], 3)
    before = work(world)
    balanced(world, [[0.4], [0]], 2)
    gained = work(world) - before
    rate = 0.3 * GRAVITY * 0.4
    assert gained[DRIVES] == pytest.approx(2 * rate, rel=5e-3)
    assert gained[FLOOR] == pytest.approx(-2 * rate, rel=5e-3)
    assert np.abs(gained[[FRICTION, IMPACTS, JOINTS, HANDS]]).max() < 0.01 * rate


def test_a_ropes_jerk_loses_what_an_inelastic_impact_does():
    look = {"ground_friction": 0.0}
    first = Ball(name="a", velocity=(-1, 0, 0), mass=1.0, **look)
    second = Ball(name="b", pose=(0.5, 0, 0), velocity=(2, 0, 0), mass=2.0, **look)
    world = endless([FAR], [first, second], joints=[Rope(a="a", b="b", length=1.0)])
    balanced(world, [[0], [0]], 2)
    assert work(world)[JOINTS] == pytest.approx(-0.5 * (1 * 2 / 3) * 3**2, rel=1e-3)
    assert work(world)[IMPACTS] == pytest.approx(0, abs=1e-9)


def test_a_spring_takes_and_gives_back():
    """Its work is minus what is stored, k x^2 / 2."""
    k = 20.0
    ball = Ball(name="a", pose=(1.3, 0, 0), mass=0.5, ground_friction=0.0)
    spring = Spring(a="a", anchor_b=(0, 0), rest_length=1.0, stiffness=k, damping=0.0)
    world = endless([FAR], [ball], joints=[spring], sampling_time=0.01)
    stored = k * 0.3**2 / 2
    for _ in range(100):
        balanced(world, [[0], [0]], 0.01)
        left = k * (world.prop_pose[0, 0] - 1.0) ** 2 / 2
        assert work(world)[JOINTS] == pytest.approx(stored - left, abs=0.05 * stored)


def test_a_gate_at_its_limit_loses_what_restitution_takes():
    gate = Gate(
        pose=(0.5, 0, 0), velocity=(0, 1, 2), limits=(-0.4, 0.4), damping=0.0,
        limit_restitution=0.5,
    )  # fmt: skip
    world = endless([FAR], [gate], sampling_time=0.02)
    start = kinetic(world)
    balanced(world, [[0], [0]], 0.5)
    assert work(world)[JOINTS] == pytest.approx(-0.75 * start, rel=5e-3)


def test_a_pull_from_outside_is_the_work_of_hands():
    puck = Puck(mass=2.0, ground_friction=0.0)
    world = endless([FAR], [puck], sampling_time=0.01)
    engine = world.simulation.engine
    engine.pull(1, (3.0, 4.0), 0.0)
    engine.drive(np.zeros((3, 1)), 0.5, 0.0)
    engine.let_go()
    speed = 5.0 / 2.0 * 0.5
    engine.look()
    assert engine.seen_work[HANDS] == pytest.approx(2.0 * speed**2 / 2, rel=1e-6)
    assert hypot(*engine.velocity[:2, 1]) == pytest.approx(speed, rel=1e-6)


@each_case("seed", range(3))
def test_a_tangle_of_all_of_it_adds_up(seed):
    """Robots of all drives, also with a centre of mass elsewhere; props, ropes, rods, a wall."""
    rng = np.random.default_rng(seed)
    kinds = [
        Unicycle(max_force=8), Unicycle(force_limited=True), Holonomic(grip=0.5),
        Car(no_load_speed=1.0),
    ]  # fmt: skip
    robots = [
        Robot(
            pose=(0.7 * (k % 3), 0.7 * (k // 3), rng.uniform(-pi, pi)), drive=kinds[k % 4],
            name=f"r{k}", friction=0.5, restitution=0.5, mass_offset=0.05 * (k % 2),
        )
        for k in range(6)
    ]  # fmt: skip
    props = [
        (Box, Puck, Ball)[k % 3](
            name=f"p{k}", pose=(0.7 * (k % 3), 1.5 + 0.7 * (k // 3), 1.0 * k),
            velocity=(*rng.uniform(-1, 1, 2), 2.0), friction=0.5, restitution=0.5,
        )
        for k in range(6)
    ]  # fmt: skip
    joints = [Rope(a="r0", b="p0", length=1.8), Rod(a="r1", b="r2"), Rod(a="p4", b="p5")]
    corners = [(-0.5, -0.5), (2.0, -0.5), (2.0, 3.2), (-0.5, 3.2), (-0.5, -0.5)]
    walls = Map(walls=[corners])
    world = endless(robots, props, joints=joints, addons=[walls], sampling_time=0.05)
    for _ in range(20):
        balanced(world, np.array([rng.uniform(-0.5, 0.5, 6), rng.uniform(-0.5, 0.5, 6)]), 0.3)


def test_the_energy_of_a_world_has_that_of_each_body():
    robot = Robot(mass=2.0, drive=Car(), mass_offset=0.1)
    puck = Puck(pose=(3, 0, 0), velocity=(0.5, 0, 3), mass=0.4, ground_friction=0.0)
    world = endless([robot], [puck])
    balanced(world, [[0.3], [0.4]], 1)
    spin = world.velocity[2, 0]
    moment = world.scenario.bodies[0].inertia.moment
    first = (2.0 * (0.3**2 + (0.1 * spin) ** 2) + moment * spin**2) / 2
    second = (0.4 * 0.5**2 + puck.inertia.moment * 3**2) / 2
    assert world.energy.kinetic == pytest.approx([first, second])
    assert world.energy.total == pytest.approx(kinetic(world))
    assert world.energy.by("drives") == pytest.approx(first)


def test_momentum_is_that_of_the_centres_of_mass():
    look = {"ground_friction": 0.0, "friction": 0.6, "restitution": 0.8}
    boxes = [
        Box(pose=(0.6 * k, 0.1 * k, k), velocity=(1.0 - k, 0.2, 2.0), mass=1.0 + k, **look)
        for k in range(4)
    ]  # fmt: skip
    world = endless([FAR], boxes)
    linear, angular = world.momentum.total, world.momentum.angular
    assert linear == pytest.approx([sum((1 + k) * (1.0 - k) for k in range(4)), 0.2 * 10])
    by_hand = sum(
        (1 + k) * (0.6 * k * 0.2 - 0.1 * k * (1.0 - k)) + box.inertia.moment * 2.0
        for k, box in enumerate(boxes)
    )
    assert angular == pytest.approx(by_hand)
    for _ in range(40):
        world.step([[0], [0]])
    assert world.energy.by("impacts") < -0.1  # they have met
    assert world.momentum.total == pytest.approx(linear, abs=1e-9)
    assert world.momentum.angular == pytest.approx(angular, abs=2e-3 * abs(angular))


def test_what_is_put_elsewhere_has_lost_its_energy_to_hands():
    puck = Puck(name="puck", velocity=(1, 0, 0), mass=2.0, ground_friction=0.0)
    world = endless([FAR], [puck])
    balanced(world, [[0], [0]], 0.5)
    world.operator.place("puck", (2.0, 2.0, 0.0))
    assert world.energy.by("hands") == pytest.approx(-1.0)
    balanced(world, [[0], [0]], 0.5)
    assert world.energy.total == 0.0


@each_case("physics", ["stop", "ideal"])
def test_without_forces_drives_do_all_and_what_stops_has_lost_it_in_the_impact(physics):
    puck = Puck(pose=(1, 0, 0), velocity=(-0.5, 0, 0), mass=2.0, ground_friction=0.0)
    world = endless([Robot(mass=3.0)], [puck], physics=physics)
    balanced(world, [[0.4], [0]], 2)
    lost = -2.0 * 0.5**2 / 2 if physics == "stop" else 0.0
    assert world.energy.by("impacts") == pytest.approx(lost)


@each_case("angle", [0.0, 30.0])
def test_a_robot_that_presses_against_a_wall_does_no_work(angle):
    robot = Robot(pose=(-0.3, 0, 0), drive=Unicycle(max_force=5), friction=2.0)
    a = radians(90 - angle)
    walls = Map([[(-3 * cos(a), -3 * sin(a)), (3 * cos(a), 3 * sin(a))]])
    world = endless([robot], addons=[walls])
    balanced(world, [[0.3], [0]], 2)
    before = work(world)
    balanced(world, [[0.3], [0]], 2)
    assert np.abs(work(world) - before).max() < 1e-4
