"""Motors whose force falls with speed, and wheels that bear no more than their grip."""

from __future__ import annotations

from math import cos, hypot, log, pi, sin, tan

import numpy as np
import pytest

from mars2d import Holonomic, Robot, Unicycle
from mars2d.bodies import Car
from mars2d.bodies.props import Box
from mars2d.core.materials import GRAVITY
from tests.worlds import drive, endless


def pushed(drive_: object, angle: float, force: float, mass: float = 2.0) -> float:
    """How far a braked robot is pushed in 2 s by a force at an angle to its heading, metres.

    Another robot, which touches it from the start, pushes through its centre without friction.
    """
    way = np.array([cos(angle), sin(angle)])
    braked = Robot(mass=mass, drive=drive_, friction=0.0, pose=(0, 0, 0))
    other = Robot(
        pose=(*(-0.3 * way), angle), friction=0.0,
        drive=Unicycle(max_force=force, max_torque=50.0),
    )  # fmt: skip
    world = endless([braked, other], sampling_time=0.05)
    drive(world, [[0, 0.2], [0, 0]], 2)
    return hypot(*world.pose[:2, 0])


@pytest.mark.parametrize("mass", [1.0, 3.0])
@pytest.mark.parametrize("angle", [0.0, 0.4, pi / 4, 1.2, pi / 2, 2.5, -pi / 3])
@pytest.mark.parametrize(("grip", "side_grip"), [(0.5, None), (0.8, 0.3), (0.3, 0.9)])
def test_wheels_hold_within_the_ellipse_of_their_grip(grip, side_grip, angle, mass):
    across = grip if side_grip is None else side_grip
    most = mass * GRAVITY / hypot(cos(angle) / grip, sin(angle) / across)
    wheels = Unicycle(max_force=1e3, max_torque=50, grip=grip, side_grip=side_grip)
    assert pushed(wheels, angle, 0.97 * most, mass) < 2e-3
    assert pushed(wheels, angle, 1.05 * most, mass) > 2e-2


def test_a_stalled_motor_is_no_skidding_wheel():
    wheels = Unicycle(max_force=4.0, max_torque=50, grip=0.9)
    assert pushed(wheels, pi, 3.9) < 2e-3
    assert pushed(wheels, pi, 4.3) > 1e-2  # the motors give way: the wheels turn
    assert pushed(wheels, pi / 2, 0.97 * 0.9 * 2 * GRAVITY) < 2e-3  # the wheels do not
    ideal = Unicycle(max_force=4.0, max_torque=50)
    assert pushed(ideal, pi / 2, 4.3) > 1e-2  # without a grip, the motors bear all there is


@pytest.mark.parametrize("angle", [0.3, 2.0])
def test_motors_bear_what_is_ahead_and_wheels_what_is_across(angle):
    """The motors' 4 N bound the part ahead; the whole force is larger by 1 / |cos|."""
    most = 4.0 / abs(cos(angle))
    wheels = Unicycle(max_force=4.0, max_torque=50, grip=1.0)
    assert pushed(wheels, angle, 0.97 * most) < 2e-3
    assert pushed(wheels, angle, 1.05 * most) > 1e-2


@pytest.mark.parametrize("model", [Unicycle, Holonomic, Car])
@pytest.mark.parametrize(("force", "no_load"), [(10.0, 0.8), (20.0, 0.6)])
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


def test_a_car_without_side_grip_is_pushed_aside_by_little():
    slippery = Car(max_force=50.0, max_torque=50, grip=1.0, side_grip=0.02)
    assert pushed(slippery, pi / 2, 1.0) > 0.1
    assert pushed(slippery, 0.0, 1.0) < 2e-3


@pytest.mark.parametrize("sampling_time", [0.2, 0.05])
@pytest.mark.parametrize("wanted", [0.5, 1.9])
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


def test_wheels_skid_in_the_open_where_the_force_is_limited():
    """Ahead they quicken a robot at mu g, whatever the motors could do; so do they brake it."""
    wheels = Unicycle(max_force=1e3, grip=0.2, max_linear_speed=3.0, force_limited=True)
    world = endless([Robot(drive=wheels, mass=3.0)], sampling_time=0.05)
    drive(world, [[2.0], [0.0]], 0.5)
    assert world.velocity[0, 0] == pytest.approx(0.2 * GRAVITY * 0.5, rel=1e-6)
    drive(world, [[2.0], [0.0]], 1.0)
    start = world.pose[0, 0]
    drive(world, [[0.0], [0.0]], 2.0)
    assert world.pose[0, 0] - start == pytest.approx(2.0**2 / (2 * 0.2 * GRAVITY), rel=1e-4)


@pytest.mark.parametrize("side_grip", [0.05, 0.5])
def test_a_car_drifts_out_of_a_bend_that_its_side_grip_cannot_hold(side_grip):
    """On a circle of radius r at v wheels have to bear m v^2 / r across."""
    car = Car(
        max_force=1e3, max_torque=1e3, grip=2.0, side_grip=side_grip, force_limited=True,
        wheelbase=0.5, max_linear_speed=2.0,
    )  # fmt: skip
    world = endless([Robot(drive=car)], sampling_time=0.05)
    drive(world, [[1.0], [0.0]], 1.0)
    way = drive(world, [[1.0], [0.5]], 2.0)[:, :, 0]
    radius = 0.5 / tan(0.5)
    middle = np.array([1.0, radius])
    off = np.hypot(way[:, 0] - middle[0], way[:, 1] - middle[1]).max()
    holds = side_grip * GRAVITY > 1.0 / radius
    assert (off < 1.05 * radius) == holds
