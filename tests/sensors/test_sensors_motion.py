"""What a robot knows of its own motion: pose, odometry, inertial measurements."""

from __future__ import annotations

from math import cos, pi, sin, sqrt

import numpy as np
import pytest

import mars2d
from mars2d import Car, Differential, Drive, Holonomic, InputError, Robot, Scenario, Unicycle, World
from mars2d.addons import Map
from mars2d.geometry.dead_reckoning import odometry_covariance
from mars2d.sensors import Imu, Odometry, Pose
from tests.cases import each_case


def followed(robot, commands, **scenario):
    """The world after a robot has been given commands (k, 2), one each control step."""
    fields = {"workspace": None, "stop_time": 1e6} | scenario
    world = World(Scenario(robots=[robot], **fields))
    for command in commands:
        world.step(np.reshape(command, (2, 1)))
    world.observe()
    return world


# -- pose -----------------------------------------------------------------------------------


def test_the_pose_is_that_of_the_mount():
    world = followed(Robot(pose=(1, 2, pi / 2), sensors=[Pose(mount=(0.3, 0.1, 1))]), [])
    assert world.robots[0].sense.pose == pytest.approx([0.9, 2.3, pi / 2 + 1])


# -- odometry: without errors ----------------------------------------------------------------


DRIVES = {
    "unicycle": (Unicycle(), (0.4, 1.2)),
    "differential": (Differential(), (6.0, 9.0)),
    "car": (Car(), (0.4, 0.5)),
    "holonomic": (Holonomic(), (0.3, -0.2)),
}


@each_case("delay", [0.0, 0.03, 0.25])
@each_case("sampling_time", [0.02, 0.1, 1.0])
@each_case("drive", list(DRIVES))
def test_perfect_odometry_is_the_truth_in_free_motion(drive, sampling_time, delay):
    kind, most = DRIVES[drive]
    commands = np.random.default_rng(3).uniform(-0.3, 1, (60, 2)) * most
    sensors = [Odometry(origin="world"), Odometry(name="own")]
    robot = Robot(pose=(1, -2, 2.5), drive=kind, sensors=sensors)
    world = followed(robot, commands, sampling_time=sampling_time, command_delay=delay)
    sense = world.robots[0].sense
    assert np.abs(world.pose[:, 0] - [1, -2, 2.5]).max() > 0.1
    assert sense.odometry == pytest.approx(world.pose[:, 0], abs=1e-9)
    x, y, theta = world.pose[:, 0] - [1, -2, 2.5]
    c, s = cos(2.5), sin(2.5)
    assert sense.own == pytest.approx([c * x + s * y, c * y - s * x, theta], abs=1e-9)


def test_odometry_knows_the_noise_of_the_drive_for_the_wheels_do_turn_so():
    robot = Robot(drive=Unicycle(noise=0.3), sensors=[Odometry()])
    world = followed(robot, [(0.3, 0.4)] * 100)
    assert world.robots[0].sense.odometry == pytest.approx(world.pose[:, 0], abs=1e-9)


def test_a_drive_of_ones_own_that_spins_in_the_frame_of_the_world_is_followed():
    class Spinner(Drive):
        frame = "world"

        def twist(self, command):
            return np.array([command[0], command[1], np.full(command.shape[1], 2.0)])

    robot = Robot(pose=(0, 0, 1), drive=Spinner(), sensors=[Odometry(origin="world")])
    world = followed(robot, [(0.3, -0.2), (-0.1, 0.4), (0.2, 0.2)] * 10)
    assert world.robots[0].sense.odometry == pytest.approx(world.pose[:, 0], abs=1e-9)


def test_wheels_that_slip_go_on_while_the_robot_stands():
    wall = Map([[(0.5, -2), (0.5, 2)]])
    robot = Robot(sensors=[Odometry()])
    world = followed(robot, [(0.3, 0)] * 100, addons=[wall])
    assert world.pose[0, 0] == pytest.approx(0.35, abs=2e-3)
    assert world.robots[0].sense.odometry == pytest.approx([3.0, 0, 0], abs=1e-9)


# -- odometry: systematic errors ---------------------------------------------------------------


def test_a_wheel_believed_too_large_bends_the_way_to_a_known_circle():
    drive = Unicycle(wheel_semiaxis=0.1)
    robot = Robot(drive=drive, sensors=[Odometry(wheel_scale=(0.99, 1.01))])
    world = followed(robot, [(0.5, 0)] * 200)  # 10 m straight on
    radius = 0.1 * (1.01 + 0.99) / (1.01 - 0.99)
    turn = 10 / radius
    expected = [radius * sin(turn), radius * (1 - cos(turn)), turn]
    assert world.robots[0].sense.odometry == pytest.approx(expected, abs=1e-9)


def test_wheels_believed_too_far_apart_turn_less():
    robot = Robot(sensors=[Odometry(semiaxis_scale=1.25)])
    world = followed(robot, [(0, 1.0)] * 50)
    assert world.robots[0].sense.odometry == pytest.approx([0, 0, 4.0], abs=1e-9)


# -- odometry: random errors -------------------------------------------------------------------


SEEDS = 300


def estimates(commands, drift, drive=None, **scenario):
    """The odometry of many robots that do the same far apart, (SEEDS, 3), and the truth (3,)."""
    drive = drive or Unicycle(wheel_semiaxis=0.2, max_linear_speed=5)
    robots = [
        Robot(pose=(0, 3 * k, 0), drive=drive, sensors=[Odometry(drift=drift)])
        for k in range(SEEDS)
    ]
    world = World(Scenario(robots=robots, workspace=None, stop_time=1e6, **scenario))
    for command in commands:
        world.step(np.tile(np.reshape(command, (2, 1)), SEEDS))
    world.observe()
    found = np.array([robot.sense.odometry for robot in world.robots])
    return found, world.pose[:, 0]


def agree(found, covariance):
    """Whether the covariance of samples (k, 3) is the predicted one, to four deviations."""
    sample = np.cov(found.T)
    d = np.diag(covariance)
    deviation = np.sqrt((np.outer(d, d) + covariance**2) / len(found))
    return bool((np.abs(sample - covariance) < 4 * deviation + 1e-12).all())


def predicted(rims, semiaxis, drift, start=0.0):
    """The covariance after steps in which the rims (k, 2) travel."""
    covariance, theta = np.zeros((3, 3)), start
    for left, right in rims:
        covariance = odometry_covariance(covariance, theta, left, right, semiaxis, drift)
        theta += (right - left) / (2 * semiaxis)
    return covariance


@pytest.mark.slow
def test_on_a_straight_line_the_covariance_is_that_of_theory():
    drift, b, length, steps = 1e-3, 0.2, 5.0, 100  # so small that the first order is all
    found, truth = estimates([(0.5, 0)] * steps, drift)
    k = drift**2
    # Integrals over the way; the sums over steps differ by 1 / (4 steps^2).
    turning = k / (2 * b * b)
    theory = np.array(
        [
            [k * length / 2, 0, 0],
            [0, turning * length**3 / 3, turning * length**2 / 2],
            [0, turning * length**2 / 2, turning * length],
        ]
    )
    assert found.mean(axis=0) == pytest.approx(truth, abs=4 * sqrt(theory[1, 1] / SEEDS))
    assert agree(found, theory)
    assert not agree(found, 1.5 * theory)
    made = predicted([(0.05, 0.05)] * steps, b, drift)
    assert made == pytest.approx(theory, rel=1e-4, abs=1e-12)


@pytest.mark.slow
def test_round_a_circle_the_covariance_is_that_of_theory():
    drift, b, radius, steps = 1e-3, 0.2, 0.8, 100
    turn = 2 * pi / steps / 0.1  # rad/s
    found, truth = estimates([(radius * turn, turn)] * steps, drift)
    assert truth == pytest.approx([0, 0, 2 * pi], abs=1e-9)
    k, wide = drift**2, (radius / b) ** 2
    theory = pi * k * radius * np.array([1.5 * wide - 0.5, wide / 2 - 0.5, 1 / b**2])
    made = predicted(
        [tuple(2 * pi / steps * (radius + side * b) for side in (-1, 1))] * steps, b, drift
    )
    assert made.diagonal() == pytest.approx(theory, rel=2e-3)
    assert agree(found, made)
    assert not agree(found, 1.5 * made)


def test_the_predicted_covariance_is_the_first_order_of_the_model():
    rng = np.random.default_rng(5)
    before, theta, b, drift = np.diag([4e-6, 9e-6, 1e-6]), 0.7, 0.15, 1e-3
    for left, right in [(0.5, 0.7), (-0.3, 0.2), (0.4, 0.4), (1e-9, -1e-9), (0.3, 0.3 + 1e-5)]:
        travel = np.array([left, right]) + drift * np.sqrt(np.abs([left, right])) * (
            rng.standard_normal((60_000, 2))
        )
        pose = [0, 0, theta] + rng.standard_normal((60_000, 3)) * np.sqrt(before.diagonal())
        forward, spin = travel.mean(axis=1), (travel[:, 1] - travel[:, 0]) / (2 * b)
        chord, middle = forward * np.sinc(spin / 2 / pi), pose[:, 2] + spin / 2
        moved = pose + np.column_stack([chord * np.cos(middle), chord * np.sin(middle), spin])
        assert agree(moved, odometry_covariance(before, theta, left, right, b, drift))


@each_case("drive", [Car(), Holonomic()])
def test_other_drives_drift_by_three_wheels_that_only_measure(drive):
    command = (0.4, 0.3) if isinstance(drive, Car) else (0.3, 0.2)
    found, truth = estimates([command] * 30, 0.01, drive)
    b = Robot().radius
    spread = found.std(axis=0)
    way = 0.4 * 3 if isinstance(drive, Car) else 0.3 * 3
    assert spread[2] == pytest.approx(0.01 * sqrt(way / 2) / b, rel=0.08)
    assert found.mean(axis=0) == pytest.approx(truth, abs=4 * spread.max() / sqrt(SEEDS))


@each_case(
    ("fields", "message"),
    [
        ({"wheel_scale": 1.01}, r"Odometry.wheel_scale = 1.01: expected two scales"),
        ({"wheel_scale": (1, float("nan"))}, r"Odometry.wheel_scale = "),
        ({"mount": (0.1, 0, 0)}, r"Odometry.mount = .*: expected \(0, 0, 0\)"),
    ],
)
def test_odometry_that_can_not_be_is_an_error(fields, message):
    with pytest.raises(InputError, match=message):
        Odometry(**fields)


# -- inertial measurements ---------------------------------------------------------------------


def test_on_a_circle_it_feels_the_centripetal_acceleration():
    for sampling_time in (0.01, 0.1, 1.0):
        robot = Robot(pose=(0, 0, 1), sensors=[Imu()])
        world = followed(robot, [(0.4, 0.8)] * 5, sampling_time=sampling_time)
        assert world.robots[0].sense.imu == pytest.approx([0, 0.32, 0.8], abs=1e-9)


def test_at_the_start_all_are_zero_and_then_speeding_up_is_felt_once():
    world = followed(Robot(pose=(0, 0, 2), sensors=[Imu()]), [(0.3, 0)] * 4)
    found = world.record.sensors["imu"][:, 0]
    assert found == pytest.approx(np.array([[0, 0, 0], [3, 0, 0], [0, 0, 0], [0, 0, 0]]), abs=1e-9)


def test_a_collision_is_felt_as_a_blow():
    robot = Robot(sensors=[Imu()], diameter=0.3)
    world = followed(robot, [(0.4, 0)] * 40, addons=[Map([[(0.8, -1), (0.8, 1)]])])
    felt = world.record.sensors["imu"][2:, 0, 0]
    assert felt.min() == pytest.approx(-4, rel=0.1)  # from 0.4 m/s to 0 in a control step
    assert (felt < -0.4).sum() <= 2


@each_case("mount", [(0.2, 0, 0), (0, 0.3, 0), (-0.1, 0.2, 0.7)])
def test_off_the_centre_it_feels_the_turning(mount):
    spin, before = 1.5, 0.5
    world = followed(Robot(sensors=[Imu(mount=mount)]), [(0, before), (0, spin), (0, spin)])
    x, y, turned = mount
    c, s = cos(turned), sin(turned)

    def in_its_frame(ax, ay):
        return [c * ax + s * ay, c * ay - s * ax]

    # omega^2 r towards the centre, and alpha r across while the spin grows.
    steady = in_its_frame(-(spin**2) * x, -(spin**2) * y)
    assert world.robots[0].sense.imu == pytest.approx([*steady, spin], abs=1e-9)
    alpha = (spin - before) / 0.1
    growing = in_its_frame(-(spin**2) * x - alpha * y, -(spin**2) * y + alpha * x)
    world.step([[0], [spin]])
    found = world.record.sensors["imu"][2, 0]
    assert found == pytest.approx([*growing, spin], abs=1e-9)


def test_the_bias_is_constant_and_its_walk_grows_with_the_root_of_time():
    robots = [
        Robot(pose=(0, y, 0), sensors=[Imu(bias=(0.1, -0.2, 0.3), bias_walk=(0.02, 0, 0.01))])
        for y in range(200)
    ]
    scenario = Scenario(robots=robots, workspace=None, stop_time=8, sampling_time=0.5)
    found = mars2d.run(scenario).sensors["imu"]
    assert found[0] == pytest.approx(np.tile([0.1, -0.2, 0.3], (200, 1)), abs=1e-12)
    for row, seconds in ((4, 2), (16, 8)):
        deviation = found[row].std(axis=0) / sqrt(seconds)
        assert deviation == pytest.approx([0.02, 0, 0.01], rel=0.2, abs=1e-12)
    assert found[-1].mean(axis=0) == pytest.approx([0.1, -0.2, 0.3], abs=0.02)


@each_case(
    ("fields", "message"),
    [
        ({"bias": 0.1}, r"Imu.bias = 0.1: expected three numbers"),
        ({"bias": (0, 0, "fast")}, r"Imu.bias = "),
    ],
)
def test_an_imu_that_can_not_be_is_an_error(fields, message):
    with pytest.raises(InputError, match=message):
        Imu(**fields)
