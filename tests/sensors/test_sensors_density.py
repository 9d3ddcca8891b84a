"""What readings add up to strays alike at any sampling time and at any rate of the sensor.

A single reading of a range finder, say, is no part of a sum: its noise is that of each reading.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest

import mars2d
from mars2d import Robot, Scenario, Unicycle, World
from mars2d.sensors import NUMBER, Imu, Odometry, Quantity, Sensor
from tests.cases import each_case
from tests.worlds import crowd, like

N = 100
PERIODS = [(0.4, 1), (0.1, 5), (0.043, 1)]


def summed(world: World, key: str, every: int) -> tuple[np.ndarray, float]:
    """Return the integrals of the readings (N, k), each over the time before it, and that time."""
    rows = world.record.sensors[key][every::every]
    interval = every * world.scenario.sampling_time
    return interval * rows.sum(axis=0), interval * len(rows)


# -- a gyroscope and accelerometers --------------------------------------------------------------


@pytest.mark.slow
@each_case(("sampling_time", "every"), PERIODS)
def test_the_heading_of_a_gyroscope_walks_alike_at_any_rate(sampling_time, every):
    density = (0.03, 0.021, 0.004)
    rate = None if every == 1 else 1 / (every * sampling_time)
    world = crowd(N, (0, 0), sampling_time, 11, sensors=[Imu(noise=density, rate=rate)])
    found, time = summed(world, "imu", every)
    for k in range(3):
        like(found[:, k], 0, density[k] * sqrt(time))
    largest = np.abs(np.corrcoef(found.T) - np.eye(3)).max()
    assert largest < 4 / sqrt(N)


@each_case("every", [1, 4])
def test_one_reading_is_the_noisier_the_shorter_its_time(every):
    robot = Robot(sensors=[Imu(noise=0.02, rate=25 / every)])
    found = mars2d.run(Scenario(robots=[robot], sampling_time=0.04, stop_time=60)).sensors["imu"]
    like(found[::every, 0].ravel(), 0, 0.02 / sqrt(0.04 * every))


@each_case("every", [1, 3, 7])
def test_at_a_low_rate_a_gyroscope_misses_no_turn(every):
    """A reading is the mean over the time since the one before; so they sum up to the heading."""
    robot = Robot(pose=(0, 0, 0.4), sensors=[Imu(rate=10 / every)])
    world = World(Scenario(robots=[robot], workspace=None, sampling_time=0.1))
    rng = np.random.default_rng(2)
    for spin in rng.uniform(-1.5, 1.5, 42):
        world.step([[0.1], [spin]])
    world.stop("done")
    found, _ = summed(world, "imu", every)
    assert found[0, 2] == pytest.approx(world.pose[2, 0] - 0.4, abs=1e-12)
    assert world.time == pytest.approx(4.2)


class Gyroscope(Sensor):
    """One of the user's own, in two numbers of which one is nothing."""

    averages = True
    quantities = (Quantity("omega", "rad/s"), NUMBER)

    def read(self, robot, world, rng):
        return robot.velocity[2], 0.0


def test_a_sensor_of_ones_own_may_have_a_density():
    robot = Robot(sensors=[Gyroscope(noise=(0.05, 0.0), rate=5, outliers=0.0)])
    scenario = Scenario(robots=[robot], sampling_time=0.04, stop_time=100)
    found = mars2d.run(scenario).sensors["gyroscope"][::5, 0]
    like(found[:, 0], 0, 0.05 / sqrt(0.2))
    assert not found[:, 1].any()


# -- odometry ------------------------------------------------------------------------------------


@pytest.mark.slow
@each_case(("sampling_time", "every"), PERIODS)
def test_the_drift_of_odometry_is_alike_at_any_rate(sampling_time, every):
    v, b, drift = 0.31, 0.14, 0.004
    rate = None if every == 1 else 1 / (every * sampling_time)
    robot = {"drive": Unicycle(wheel_semiaxis=b), "sensors": [Odometry(drift=drift, rate=rate)]}
    world = crowd(N, (v, 0.0), sampling_time, 11, **robot)
    last = world.record.sensors["odometry"][::every][-1]
    way = v * every * sampling_time * (len(world.record.time[::every]) - 1)
    off = last - [way, 0, 0]
    turning = drift**2 / (2 * b * b)
    like(off[:, 2], 0, sqrt(turning * way))
    like(off[:, 1], 0, sqrt(turning * way**3 / 3))
    bends = way**2 * turning
    deviation = sqrt(drift**2 * way / 2 + bends**2 / 12)
    assert off[:, 0].mean() == pytest.approx(-bends / 4, abs=4 * deviation / sqrt(N))
    assert off[:, 0].std() == pytest.approx(deviation, rel=4 / sqrt(2 * N))
