"""Ramps: how actuators whose change is bounded get from one command to the next."""

from __future__ import annotations

from math import cos, hypot, sin, tan

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mars2d import Car, Differential, Holonomic, Robot, Unicycle
from mars2d.addons import Map
from mars2d.sensors import Imu, Odometry
from tests.cases import each_case
from tests.worlds import drive, endless

A = 0.37  # m/s^2
SPEED = 0.43  # m/s

STRAIGHT = [
    (Unicycle(max_acceleration=A), (SPEED, 0.0)),
    (Differential(max_acceleration=A, wheel_radius=0.05), (SPEED / 0.05, SPEED / 0.05)),
    (Differential(command="twist", max_acceleration=A), (SPEED, 0.0)),
    (Holonomic(max_acceleration=A), (0.6 * SPEED, -0.8 * SPEED)),
    (Car(max_acceleration=A), (SPEED, 0.0)),
]


def way_after(time: np.ndarray) -> np.ndarray:
    """The way at an acceleration up to a speed."""
    takes = SPEED / A
    return np.where(time < takes, A * time**2 / 2, SPEED * time - SPEED * takes / 2)


@each_case("physics", ["contact", "ideal"])
@each_case("sampling_time", [0.5, 0.03])
@each_case(("kind", "command"), STRAIGHT)
def test_way_and_speed_are_those_of_the_ramp_whatever_the_sampling_time(
    kind, command, sampling_time, physics
):
    world = endless([Robot(drive=kind)], sampling_time=sampling_time, physics=physics)
    for k in range(1, round(3 / sampling_time) + 1):
        world.step(np.reshape(command, (2, 1)))
        time = k * sampling_time
        assert hypot(*world.pose[:2, 0]) == pytest.approx(way_after(time), abs=1e-9)
        speed = hypot(*world.velocity[:2, 0])
        assert speed == pytest.approx(min(A * time, SPEED), abs=1e-9)
    braking = world.pose[:2, 0]
    drive(world, [[0.0], [0.0]], 3.0)
    assert hypot(*(world.pose[:2, 0] - braking)) == pytest.approx(SPEED**2 / (2 * A), abs=1e-9)


@each_case("delay", [0.04, 0.137, 0.5])
def test_a_ramp_begins_when_its_command_arrives(delay):
    sampling_time = 0.1
    robot = Robot(drive=Unicycle(max_acceleration=A, dead_time=delay))
    world = endless([robot, Robot(pose=(0, 3, 0))], sampling_time=sampling_time)
    poses = drive(world, [[SPEED, 0.1], [0.0, 0.0]], 3.0)
    time = np.maximum(sampling_time * np.arange(1, len(poses) + 1) - delay, 0.0)
    assert poses[:, 0, 0] == pytest.approx(way_after(time), abs=1e-9)
    assert poses[-1, 0, 1] == pytest.approx(0.3)


@each_case(("sampling_time", "off"), [(0.5, 5e-4), (0.1, 2e-5), (0.03, 2e-6)])
def test_on_a_bend_the_way_is_that_of_an_integrator_but_for_the_square_of_the_step(
    sampling_time, off
):
    drives = (
        Unicycle(max_linear_speed=2, max_acceleration=0.3, wheel_semiaxis=0.1),
        Car(max_linear_speed=2, max_acceleration=0.3, max_steering_rate=0.5, wheelbase=0.2),
    )
    team = [Robot(drive=each, pose=(0, 5.0 * i, 0)) for i, each in enumerate(drives)]
    world = endless(team, sampling_time=sampling_time)
    drive(world, [[0.4, 0.4], [1.5, 0.5]], 3.0)

    def wheels(time: float) -> tuple[float, float]:
        left, right = min(0.25, 0.3 * time), min(0.55, 0.3 * time)
        return (left + right) / 2, (right - left) / 0.2

    def steered(time: float) -> tuple[float, float]:
        speed = min(0.4, 0.3 * time)
        return speed, speed * tan(min(0.5, 0.5 * time)) / 0.2

    for i, moves in enumerate((wheels, steered)):

        def rates(time, state, moves=moves):
            speed, spin = moves(time)
            return [speed * cos(state[2]), speed * sin(state[2]), spin]

        found = solve_ivp(rates, (0, 3), [0, 5.0 * i, 0], rtol=1e-10, atol=1e-12, max_step=0.01)
        assert world.pose[:, i] == pytest.approx(found.y[:, -1], abs=off)


def test_what_hits_within_a_step_hits_with_the_speed_of_the_ramp():
    sampling_time, gap = 1.0, 0.1
    robot = Robot(drive=Unicycle(max_acceleration=A))
    wall = [[(0.15 + gap, -1), (0.15 + gap, 1)]]
    world = endless([robot], addons=[Map(wall)], sampling_time=sampling_time)
    world.step([[SPEED], [0.0]])
    speed = world.record.contacts[0]["speed"]
    assert speed == pytest.approx((2 * A * gap) ** 0.5, abs=A * sampling_time / 8)


def test_odometry_and_gyroscope_know_of_the_ramp():
    robot = Robot(drive=Unicycle(max_acceleration=0.3), sensors=[Odometry(), Imu()])
    world = endless([robot], sampling_time=0.2)
    for _ in range(4):
        before = world.pose[2, 0]
        world.step([[0.3], [0.8]])
        world.observe()
    assert world.robots[0].sense.odometry == pytest.approx(world.pose[:, 0], abs=1e-9)
    assert world.robots[0].sense.imu[2] == pytest.approx((world.pose[2, 0] - before) / 0.2)
