"""Motors whose force falls with speed, and wheels that bear no more than their grip."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, hypot, log, pi, sin, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mars2d import Holonomic, Robot, Unicycle, World
from mars2d.addons import Map
from mars2d.bodies import Car, Hinge, Rope
from mars2d.bodies.props import Box
from mars2d.core.materials import GRAVITY
from tests.cases import each_case
from tests.islands import plainly
from tests.worlds import drive, endless

TIMES = each_case("sampling_time", [0.5, 0.005])


def pushed(drive_: object, angle: float, force: float) -> float:
    """How far a braked robot is pushed in 2 s by a force at an angle to its heading, metres.

    Another robot, which touches it from the start, pushes through its centre without friction.
    """
    way = np.array([cos(angle), sin(angle)])
    braked = Robot(mass=2.0, drive=drive_, friction=0.0, pose=(0, 0, 0))
    other = Robot(
        pose=(*(-0.3 * way), angle), friction=0.0,
        drive=Unicycle(max_force=force, max_torque=50.0),
    )  # fmt: skip
    world = endless([braked, other], sampling_time=0.05)
    drive(world, [[0, 0.2], [0, 0]], 2)
    return hypot(*world.pose[:2, 0])


WEIGHT = 2 * GRAVITY


def ellipse(angle: float, grip: float, side_grip: float) -> float:
    """What wheels under a robot of 2 kg bear at an angle to its heading, newtons."""
    return WEIGHT / hypot(cos(angle) / grip, sin(angle) / side_grip)


@each_case(
    ("angle", "most", "wheels"),
    [
        *((a, ellipse(a, 0.5, 0.5), {"grip": 0.5}) for a in (0.0, pi / 4, pi / 2, 2.5)),
        *(
            (a, ellipse(a, ahead, aside), {"grip": ahead, "side_grip": aside})
            for a in (0.0, pi / 4, pi / 2, -pi / 3)
            for ahead, aside in ((0.8, 0.3), (0.3, 0.9))
        ),
        # Motors bear what is ahead, and the whole force is larger by 1 / |cos|; wheels bear the
        # rest, but without a grip it is the motors, too.
        *((a, 4.0 / abs(cos(a)), {"grip": 1.0, "max_force": 4.0}) for a in (0.3, 2.0, pi)),
        (pi / 2, 0.9 * WEIGHT, {"grip": 0.9, "max_force": 4.0}),
        (pi / 2, 4.0, {"max_force": 4.0}),
    ],
)
def test_wheels_hold_within_the_ellipse_of_their_grip_and_what_motors_bear(angle, most, wheels):
    braked = Unicycle(**{"max_force": 1e3, "max_torque": 50, **wheels})
    assert pushed(braked, angle, 0.97 * most) < 2e-3
    assert pushed(braked, angle, 1.05 * most) > 8e-3


@each_case("model", [Unicycle, Holonomic, Car])
@each_case(("force", "no_load"), [(10.0, 0.8), (20.0, 0.6)])
def test_a_motor_pushes_a_box_at_the_speed_where_its_force_is_that_of_the_floor(
    model, force, no_load
):
    """F (1 - v / v0) = mu m g."""
    box = Box(pose=(0.5, 0, 0), mass=1.0, ground_friction=0.5)
    held = 0.5 * GRAVITY
    motor = model(max_force=force, no_load_speed=no_load, max_linear_speed=2.0, max_torque=50)
    world = endless([Robot(drive=motor)], [box], sampling_time=0.05)
    drive(world, [[1.0], [0.0]], 8)
    assert world.prop_velocity[0, 0] == pytest.approx(no_load * (1 - held / force), rel=0.01)
    assert world.effort[0] == pytest.approx(1.0, abs=0.01)


def test_a_motor_brakes_with_all_its_force():
    """What is thrown forward beyond its speed is braked by F / m, whatever the curve says."""
    motor = Unicycle(max_force=3.0, no_load_speed=0.5, max_linear_speed=2.0)
    braking = Robot(drive=motor, mass=1.0, restitution=1.0)
    hammer = Robot(pose=(-0.5, 0, 0), mass=1.0, restitution=1.0, drive=Unicycle(max_force=3.0))
    world = endless([braking, hammer], sampling_time=0.01)
    speeds = []
    for _ in range(100):
        world.step([[0, 0.5], [0, 0]])
        speeds.append(world.velocity[0, 0])
    top = int(np.argmax(speeds))
    assert speeds[top] > 0.4
    assert speeds[top + 1] - speeds[top + 5] == pytest.approx(3.0 * 0.04, rel=0.02)


@each_case("sampling_time", [0.2, 0.05])
@each_case("wanted", [0.5, 1.9])
def test_a_motor_runs_up_on_an_exponential(sampling_time, wanted):
    """m v' = F (1 - v / v0): v = v0 (1 - exp(-t / tau)), tau = m v0 / F, up to the command."""
    force, no_load, mass = 4.0, 2.0, 2.0
    motor = Unicycle(
        max_force=force, no_load_speed=no_load, max_linear_speed=3.0, force_limited=True
    )
    world = endless([Robot(drive=motor, mass=mass)], sampling_time=sampling_time)
    way = drive(world, [[wanted], [0.0]], 4)[:, 0, 0]
    tau = mass * no_load / force
    reached = -tau * log(1 - wanted / no_load)
    t = sampling_time * np.arange(1, len(way) + 1)
    rising = np.minimum(t, reached)
    x = no_load * (rising - tau * (1 - np.exp(-rising / tau))) + wanted * (t - rising)
    assert way == pytest.approx(x, abs=1e-3)


# -- wheels that grip do not skid -------------------------------------------------------------


def way_of(make: Callable[[], World], *acts: tuple) -> tuple[np.ndarray, World]:
    """The poses (3,) of a robot after some acts, compiled and in Python the same, and its world.

    An act is a command, for how long [s], and the force on it from now on [N], as a vector.
    """

    def gone() -> tuple[np.ndarray, World]:
        world, poses = make(), []
        for command, seconds, (fx, fy) in acts:
            target = None if fx == fy == 0 else (1e4 * fx + world.pose[0, 0], 1e4 * fy)
            world.operator.pull(0, (0.0, 0.0), target, force=hypot(fx, fy) or 1.0, speed=100.0)
            drive(world, np.reshape(command, (2, 1)), seconds)
            poses.append(world.pose[:, 0])
        return np.array(poses), world

    poses, world = gone()
    with plainly():
        again, _ = gone()
    assert poses.tobytes() == again.tobytes()
    return poses, world


def alone(wheels: object, sampling_time: float, walls: list = (), **fields) -> Callable[[], World]:
    """A world of a robot of 2 kg without friction, and of walls."""
    robot = Robot(drive=wheels, friction=0.0, **{"mass": 2.0, **fields})
    addons = [Map(walls)] if walls else []
    return lambda: endless([robot], addons=addons, sampling_time=sampling_time)


AT_A_WALL = [[(0.15, -9), (0.15, 9)]]


@TIMES
@each_case(("model", "offset"), [(Unicycle, 0.0), (Car, 0.05)])
def test_a_robot_stalled_at_a_wall_does_not_slide_aside(model, offset, sampling_time):
    wheels = model(max_force=5.0, max_torque=50.0, grip=0.9)
    make = alone(wheels, sampling_time, AT_A_WALL, mass_offset=offset)
    poses, world = way_of(make, ((0.3, 0.0), 1.0, (0, 0)), ((0.3, 0.0), 1.0, (0, 1.0)))
    assert abs(poses[1] - poses[0]) == pytest.approx([0, 0, 0], abs=1e-6)
    assert world.effort[0] == pytest.approx(1.0)


@TIMES
@each_case("side_grip", [0.9, 0.4])
def test_beyond_what_the_ellipse_leaves_a_stalled_robot_skids_aside(side_grip, sampling_time):
    """While it is slow its motors stall; then they turn the wheels as commanded: these slip."""
    force, mass, grip, speed = 5.0, 2.0, 0.9 * 2 * GRAVITY, 0.3
    across = side_grip * mass * GRAVITY
    left = across * sqrt(1 - (force / grip) ** 2)
    wheels = Unicycle(max_force=force, grip=0.9, side_grip=side_grip)
    make = alone(wheels, sampling_time, AT_A_WALL)
    poses, _ = way_of(make, ((speed, 0), 1.0, (0, 0)), ((speed, 0), 0.5, (0, 0.98 * left)))
    assert poses[1] == pytest.approx(poses[0], abs=1e-6)
    push = 1.1 * left
    poses, world = way_of(make, ((speed, 0), 1.0, (0, 0)), ((speed, 0), 2.0, (0, push)))

    def rates(_, state):
        slip = np.array([speed, state[1]]) / hypot(speed, state[1])
        held = slip / hypot(slip[0] / grip, slip[1] / across)
        return [state[1], (push - (left if held[0] > force else held[1])) / mass]

    way, velocity = solve_ivp(rates, (0, 2.0), [0, 0], max_step=1e-3).y[:, -1]
    assert poses[1, 1] - poses[0, 1] == pytest.approx(way, rel=0.02)
    assert world.velocity[:, 0] == pytest.approx([0, velocity, 0], rel=0.01, abs=1e-9)


@TIMES
@each_case(("heading", "angle"), [(0.0, pi / 4), (2.0, -pi / 4), (2.0, 3 * pi / 4)])
def test_a_braked_robot_pushed_obliquely_rolls_along_its_heading(angle, heading, sampling_time):
    """Its motors are weaker than the push, its wheels are not."""
    force, mass = 1.0, 2.0
    push = 0.25 * 0.9 * mass * GRAVITY
    wheels = Unicycle(max_force=force, grip=0.9)
    make = alone(wheels, sampling_time, pose=(0, 0, heading))
    pushed_to = push * np.array([cos(heading + angle), sin(heading + angle)])
    poses, world = way_of(make, ((0, 0), 2.0, pushed_to))
    way = (push * cos(angle) - force * np.sign(cos(angle))) / mass * 2.0**2 / 2
    along = np.array([cos(heading), sin(heading), 0])
    assert poses[0] - [0, 0, heading] == pytest.approx(along * (along @ poses[0]), abs=1e-9)
    assert along[:2] @ poses[0, :2] == pytest.approx(way, rel=0.015)
    assert world.effort[0] == pytest.approx(1.0)


@TIMES
@each_case(("degrees", "stops"), [(18, True), (15, False)])
def test_at_a_smooth_wall_it_stops_if_its_wheels_bear_what_wall_and_motors_do(
    degrees, stops, sampling_time
):
    """At an angle a the wall takes F / sin a; so do the wheels: it stops if that is within grip.

    Else it slides at v cos a, as without a grip: wheels that slip push straight into the wall.
    """
    angle, grip, force, speed = degrees * pi / 180, 0.9 * 2 * GRAVITY, 5.0, 0.3
    assert stops == (force <= grip * sin(angle))
    wheels = Unicycle(max_force=force, max_torque=50.0, grip=0.9)
    make = alone(wheels, sampling_time, [[(-9, 0.15), (99, 0.15)]], pose=(0, 0, angle))
    poses, _ = way_of(make, ((speed, 0), 2.0, (0, 0)), ((speed, 0), 2.0, (0, 0)))
    way = 0.0 if stops else 2.0 * speed * cos(angle)
    assert poses[1] - poses[0] == pytest.approx([way, 0, 0], abs=1e-6)


@TIMES
@each_case("force_limited", [True, False])
def test_a_robot_thrown_aside_skids_until_its_wheels_hold_and_rolls_on(
    force_limited, sampling_time
):
    """Its weak motors brake it along its heading, and leave sqrt(G^2 - F^2) across."""
    force, mass, grip = 1.0, 2.0, 0.5 * 2 * GRAVITY
    wheels = Unicycle(max_force=force, grip=0.5, force_limited=force_limited)
    start = ((0, 0), 0.5, (20.0, 20.0))
    thrown = way_of(alone(wheels, sampling_time), start)[1]
    (x, y, _), (vx, vy, _) = thrown.pose[:, 0], thrown.velocity[:, 0]
    assert min(vx, vy) > 1.0
    poses, world = way_of(
        alone(wheels, sampling_time), start, ((0, 0), 1.5, (0, 0)), ((0, 0), 12.0, (0, 0))
    )
    a, b = force / mass, sqrt(grip**2 - force**2) / mass
    assert vy / b < 1.5 < vx / a
    assert poses[1] == pytest.approx(
        [x + vx * 1.5 - a * 1.5**2 / 2, y + vy**2 / b / 2, 0], abs=1e-6
    )
    assert poses[2] == pytest.approx([x + vx**2 / a / 2, y + vy**2 / b / 2, 0], abs=1e-6)
    assert world.velocity[:, 0] == pytest.approx([0, 0, 0])


@TIMES
@each_case("motors", [8.0, 1e3])
def test_locked_wheels_skid_straight_on(motors, sampling_time):
    """Motors that hold the wheels let their whole grip oppose the slip, whatever its direction."""
    wheels = Unicycle(max_force=motors, grip=0.5, force_limited=True)
    start = ((0, 0), 0.5, (20.0, 20.0))
    thrown = way_of(alone(wheels, sampling_time), start)[1]
    velocity, before = thrown.velocity[:2, 0], thrown.pose[:2, 0]
    poses, _ = way_of(alone(wheels, sampling_time), start, ((0, 0), 3.0, (0, 0)))
    way = velocity * hypot(*velocity) / (2 * 0.5 * GRAVITY)
    assert poses[1, :2] - before == pytest.approx(way, abs=1e-6)


@TIMES
def test_a_robot_at_a_joint_is_held_by_its_wheels_too(sampling_time):
    robot = Robot(mass=2.0, drive=Unicycle(max_force=5.0, max_torque=5.0, grip=0.9))
    load = Box(name="b", pose=(-1.0, 0, 0), length=0.3, width=0.3, mass=4.0, ground_friction=0.5)

    def tied(joint: object, box: Box) -> Callable[[], World]:
        return lambda: endless([robot], [box], [joint], sampling_time=sampling_time)

    rope = Rope(a="robot0", b="b", length=1.0)
    pull = ((0.3, 0.0), 2.0)
    poses, world = way_of(tied(rope, load), (*pull, (0, 0)), (*pull, (0, 1.0)))
    assert poses[1] == pytest.approx(poses[0], abs=1e-6)
    assert world.effort[0] == pytest.approx(1.0)
    hinge = Hinge(a="robot0", b="b", anchor_a=(-0.25, 0.0), anchor_b=(0.25, 0.0))
    light = load.replace(pose=(-0.5, 0, 0), mass=1.0, ground_friction=0.1)
    poses, world = way_of(tied(hinge, light), ((0.3, 0.8), 4.0, (0, 0)))
    c, s = cos(poses[0, 2]), sin(poses[0, 2])
    assert world.velocity[:, 0] == pytest.approx([0.3 * c, 0.3 * s, 0.8], abs=1e-5)


def integrated(force, along, across, mass, command, time):
    """The state x, y, theta, and its velocity ahead and across, with a little give."""
    wanted, spin = command

    def rates(_, state):
        _, _, theta, ahead, aside = state
        a = mass * (wanted - ahead) / 2e-5
        b = mass * (spin * ahead - aside / 2e-5)
        beyond = max(hypot(a / along, b / across), 1)
        a, held = a / beyond, b / beyond
        if abs(a) > force:
            a = np.copysign(force, a)
            most = across * sqrt(1 - (a / along) ** 2)
            held = np.clip(b, -most, most)
        vx, vy = ahead * cos(theta) - aside * sin(theta), ahead * sin(theta) + aside * cos(theta)
        return [vx, vy, spin, a / mass + spin * aside, held / mass - spin * ahead]

    return solve_ivp(
        rates, (0, time), np.zeros(5), method="LSODA", rtol=1e-8, atol=1e-9, max_step=1e-3
    ).y[:, -1]


@TIMES
@each_case(
    ("force", "grip", "side_grip", "command"),
    [
        (1.0, 0.5, None, (1.0, 0.8)),  # it rolls all the way
        (1.0, 0.5, 0.2, (2.0, 2.0)),  # until m v omega is more than its wheels bear
        (3.0, 0.3, 0.2, (1.5, 1.5)),
        (30.0, 0.3, 0.3, (1.0, 1.0)),  # its wheels spin
    ],
)
def test_a_robot_that_turns_keeps_its_velocity_along_its_heading_while_its_wheels_bear_it(
    force, grip, side_grip, command, sampling_time
):
    weight = 2.0 * GRAVITY
    wheels = Unicycle(
        max_force=force, max_torque=1e5, grip=grip, side_grip=side_grip, max_linear_speed=4.0,
        force_limited=True,
    )  # fmt: skip
    poses, world = way_of(alone(wheels, sampling_time), (command, 2.0, (0, 0)))
    expected = integrated(force, grip * weight, (side_grip or grip) * weight, 2.0, command, 2.0)
    assert poses[0] == pytest.approx(expected[:3], abs=2e-4)
    c, s = cos(poses[0, 2]), sin(poses[0, 2])
    vx, vy = world.velocity[:2, 0]
    assert (c * vx + s * vy, c * vy - s * vx) == pytest.approx(expected[3:], abs=2e-4)
    if side_grip is None:
        assert c * vy - s * vx == pytest.approx(0, abs=1e-12)


def test_effort_is_the_share_of_what_motors_and_wheels_can_bear_in_that_direction():
    wheels = Unicycle(max_force=5.0, max_torque=50.0, grip=0.9, side_grip=0.3)
    across = 0.3 * 2 * GRAVITY
    for push, share in [((5.1, 0.0), 1.0), ((0, 5.1), 5.1 / across), ((0, 1.2 * across), 1.0)]:
        world = way_of(alone(wheels, 0.1), ((0, 0), 1.0, push))[1]
        assert world.effort[0] == pytest.approx(share, abs=1e-6)
    rolling = Unicycle(grip=0.9, side_grip=0.3, force_limited=True)
    world = way_of(alone(rolling, 0.1), ((0.3, 0.8), 3.0, (0, 0)))[1]
    assert world.effort[0] == pytest.approx(2.0 * 0.3 * 0.8 / across)
