"""The noise of drives is a density: how far robots stray does not depend on the sampling time.

What is predicted are the moments of Brownian motion with the density `noise` of each actuator, in
closed form; what is measured are the poses of a crowd after ten seconds.
"""

from __future__ import annotations

from math import cos, exp, sin, sqrt, tan

import numpy as np
import pytest

from mars2d import Car, Drive, Holonomic, Robot, Scenario, Unicycle, World
from tests.cases import each_case
from tests.worlds import crowd, like

N = 800
PERIODS = [0.4, 0.13]

MEAN = 4 / sqrt(N)
"""Four standard deviations of an estimated correlation."""


def come(drive: Drive, command, sampling_time: float) -> tuple[np.ndarray, float]:
    """Return how far N robots have come after ten seconds (3, N), and the time, seconds."""
    world = crowd(N, command, sampling_time, seed=7, drive=drive)
    return world.pose - world.scenario.initial_pose, world.time


def strays(pose: np.ndarray, time: float, speed: float, along: float, turn: float) -> None:
    """Assert that poses (3, N) are those of robots that were to drive straight ahead.

    speed: m/s. along: the density of the way, m/sqrt(s). turn: that of the heading, rad/sqrt(s).
    """
    x, y, theta = pose
    like(theta, 0, turn * sqrt(time))
    like(y, 0, speed * turn * sqrt(time**3 / 3))
    assert np.corrcoef(y, theta)[0, 1] == pytest.approx(sqrt(3) / 2, abs=MEAN / 4)
    # E cos(theta) = exp(-turn^2 t / 2); what bends add to the spread is that of theta^2, summed up.
    q = turn**2
    bends = speed * q * time**2 / sqrt(12)
    like(x, 2 * speed / q * (1 - exp(-q * time / 2)), sqrt(along**2 * time + bends**2))
    assert np.corrcoef(x, theta)[0, 1] == pytest.approx(0, abs=MEAN)


@each_case("sampling_time", PERIODS)
def test_a_unicycle_that_drives_straight_strays_alike_at_any_sampling_time(sampling_time):
    v, b, s = 0.37, 0.13, 0.0071
    pose, time = come(Unicycle(noise=s, wheel_semiaxis=b), (v, 0.0), sampling_time)
    strays(pose, time, v, s * v / sqrt(2), s * v / (b * sqrt(2)))


@each_case("sampling_time", PERIODS)
def test_a_holonomic_robot_strays_alike_in_all_directions(sampling_time):
    speed, angle, s = 0.31, 0.6, 0.11
    velocity = (speed * cos(angle), speed * sin(angle))
    pose, time = come(Holonomic(noise=s), velocity, sampling_time)
    for axis in (0, 1):
        like(pose[axis], velocity[axis] * time, s * speed * sqrt(time))
    assert np.corrcoef(pose[:2])[0, 1] == pytest.approx(0, abs=MEAN)
    assert not pose[2].any()


@pytest.mark.slow
@each_case("sampling_time", PERIODS)
@each_case("delta", [0.3, 0.7])  # 0.7: the wheels are at their bound
def test_a_car_on_a_bend_turns_as_far_as_it_is_told_with_the_noise_of_both(delta, sampling_time):
    v, s, most, base = 0.41, 0.1, 0.7, 0.23
    drive = Car(noise=s, max_steering=most, wheelbase=base)
    pose, time = come(drive, (v, delta), sampling_time)
    deviation = s * v / base * sqrt((tan(delta) ** 2 + most**2) * time)
    like(pose[2], v * tan(delta) / base * time, deviation)


def test_what_is_drawn_does_not_depend_on_the_sampling_time_but_for_its_size():
    """The random streams are those of the robots, a pair of numbers for each control step."""
    ways = []
    for sampling_time in (0.2, 0.05):
        world = World(
            Scenario(
                robots=[Robot(drive=Holonomic(noise=0.1))], physics="ideal", workspace=None,
                sampling_time=sampling_time, stop_time=1000,
            ), seed=3,
        )  # fmt: skip
        for _ in range(300):
            world.step([[0.3], [0.0]])
        off = np.diff(world.record.pose[:, :2, 0], axis=0) / sampling_time - [0.3, 0.0]
        ways.append(off * sqrt(sampling_time) / (0.1 * 0.3))
    assert ways[0] == pytest.approx(ways[1], abs=1e-9)
    assert ways[0].std() == pytest.approx(1, rel=5 / sqrt(1200))
    assert abs(np.corrcoef(ways[0].T)[0, 1]) < 5 / sqrt(300)
    assert abs(np.corrcoef(ways[0][1:, 0], ways[0][:-1, 0])[0, 1]) < 5 / sqrt(300)
