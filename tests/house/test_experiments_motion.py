"""Cyclic pursuit, collective circular motion and formations, against theory."""

from math import log, pi, sin

import numpy as np
import pytest
from scipy.optimize import brentq

import mars2d
from mars2d import Robot, Scenario, World
from mars2d.scenario.experiment import open_module
from tests.worlds import predicted

pytestmark = [pytest.mark.slow, pytest.mark.nightly]


def about(record, middle=None):
    """x and y (n,) of the robots in the end, from a point or from their middle."""
    position = record.pose[-1, :2]
    if middle is None:
        middle = position.mean(axis=1)
    return position - np.reshape(middle, (2, 1))


# -- cyclic pursuit -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("n", "gain", "speed"),
    [(3, 0.1, 0.05), (4, 0.2, 0.05), (5, 0.2, 0.2), (6, 0.1, 0.05), (6, 0.2, 0.1), (8, 0.15, 0.08)],
)
def test_at_full_speed_the_radius_of_cyclic_pursuit_is_n_v_by_pi_k_within_a_percent(n, gain, speed):
    record, checks = predicted("cyclic_pursuit", stop_time=500, n=n, gain=gain, speed=speed)
    assert np.hypot(*about(record)) == pytest.approx(n * speed / (pi * gain), rel=0.01)
    assert record.command[-1, 1].mean() == pytest.approx(gain * pi / n, rel=0.01)
    assert record.collisions == 0
    assert checks["radius"].ok
    assert checks["largest gap"].ok


def growth_rate(n, gain, ratio):
    """How fast the gaps of a regular polygon of robots grow that are slower than their bound."""
    h, slow = pi / n, gain / ratio
    a = brentq(lambda a: gain * a - 2 * slow * sin(h) * np.cos(h - a), 0, pi)
    return slow * (np.cos(2 * h - a) - np.cos(a))


@pytest.mark.parametrize(
    ("n", "ratio", "sign"), [(6, 1.7, 1), (6, 2.2, -1), (4, 1.6, 1), (4, 2.2, -1)]
)
def test_the_ratio_of_gains_decides_whether_they_spread_or_shrink_and_how_fast(n, ratio, sign):
    record, checks = predicted("cyclic_pursuit", stop_time=200, n=n, ratio=ratio, speed=9.0)
    assert np.sign(2 * n / pi * sin(pi / n) - ratio) == sign
    x, y = record.pose[:, 0], record.pose[:, 1]
    gaps = np.hypot(x - np.roll(x, 1, axis=1), y - np.roll(y, 1, axis=1)).mean(axis=1)
    measured = log(gaps[2000] / gaps[1000]) / 100
    assert measured == pytest.approx(growth_rate(n, 0.1, ratio), rel=0.03)
    (check,) = checks.values()
    assert (check.predicted, check.ok) == (sign, True)


def test_at_the_critical_ratio_they_keep_a_circle_that_depends_on_the_start():
    critical = 12 / pi * sin(pi / 6)
    sizes = []
    for gap in (1.5, 2.0):
        record, _ = predicted("cyclic_pursuit", stop_time=300, ratio=critical, speed=9.0, gap=gap)
        away = np.hypot(*about(record))
        assert np.ptp(away) < 0.01 * away.mean()
        sizes.append(away.mean())
    assert sizes[1] / sizes[0] == pytest.approx(2.0 / 1.5, rel=0.01)


# -- collective circular motion -----------------------------------------------------------------


def gaps_of(x, y):
    angles = np.sort(np.degrees(np.arctan2(y, x)))
    return np.diff(angles, append=angles[0] + 360)


def test_robots_circle_a_beacon_that_has_moved_evenly_and_to_the_left():
    record, checks = predicted("circular_motion")
    speed, k_b, rho_0 = record.command[-1, 0, 0], 0.63, 0.42
    radius = brentq(  # plain theory, for the speed that they have
        lambda rho: speed / rho - k_b * log((rho + rho_0) / (2 * rho_0)) * pi / 2, rho_0, 10
    )
    assert np.all(record.command[1000:, 0] == speed)  # at first wheels are at their bounds
    x, y = about(record, (1.3, 1.3))
    assert np.hypot(x, y) == pytest.approx(radius, rel=0.03)
    assert gaps_of(x, y) == pytest.approx(90, abs=2)
    turning = record.command[-200:, 1].mean()
    assert turning == pytest.approx(speed / radius, rel=0.03)
    assert record.collisions == 0
    assert all(check.ok for check in checks.values())
    assert all(robot.sees == "sensors" for robot in record.scenario.robots)


@pytest.mark.parametrize(("gains", "hold"), [({"radius": 0.6}, 1), ({"k_v": 1.3}, 1), ({}, 2)])
def test_the_conditions_of_the_theorem_are_those_of_the_paper(gains, hold):
    base = open_module("circular_motion")
    record = mars2d.run(base.scenario(**gains), 1.0)
    _, k_b, k_v = record.scenario.robots[0].controller.args
    rho = np.linspace(0, 1, 10001)
    least = np.min(rho * np.log((rho + base.RHO_0) / (2 * base.RHO_0)))
    speed = record.command[0, 0, 0]
    assert int(least > -2 * speed / (3 * pi * k_b)) + int(k_v <= 2 * k_b) == hold
    found = list(base.checks(record))  # after 1 s it says nothing, or why it will not
    assert [bool(each.reason) for each in found] == [True] * (hold < 2)


def test_a_neighbour_is_in_view_when_it_is_near_or_ahead():
    base = open_module("circular_motion")
    robot = base.scenario().robots[0]
    for place, seen in [
        ((0.3, pi), {"near"}), ((0.5, pi), set()), ((1.3, 0.7), {"ahead"}), ((1.3, 0.9), set()),
        ((1.45, 0.0), set()), ((0.3, 0.2), {"near", "ahead"}),
    ]:  # fmt: skip
        rho, bearing = place
        there = (rho * np.cos(bearing), rho * np.sin(bearing))
        lamp = mars2d.addons.Beacon(at=(0, 2), name="lamp")
        world = World(
            Scenario(robots=[robot.at(0, 0), Robot(pose=there, diameter=0.1)], addons=[lamp])
        )
        world.observe()
        sense = world.robots[0].sense
        assert {name for name in ("near", "ahead") if getattr(sense, name)} == seen, place


# -- formation ----------------------------------------------------------------------------------


@pytest.mark.parametrize("options", [{"shape": "circle"}, {"shape": "row", "gain": 0.3}])
def test_what_is_off_the_formation_fades_at_the_rate_of_the_second_eigenvalue(options):
    record, checks = predicted("formation", **options)
    (check,) = checks.values()
    left = 1 - options.get("gain", 0.15) * 0.1  # of what is off, after 0.1 s; l = 1, a ring of six
    assert check.predicted == pytest.approx(-np.log(left) / 0.1)
    assert check.ok
    assert record.collisions == 0
    ahead = open_module("formation").aim(record.pose.swapaxes(0, 1), 0.0).mean(axis=2)
    assert ahead[:, -1] - ahead[:, 0] == pytest.approx(
        [60 * 0.05, 0], abs=0.2
    )  # drives are bounded
    shape = open_module("formation").SHAPES[options.get("shape", "wedge")]
    x, y = about(record)
    assert x == pytest.approx(shape[0] - np.mean(shape[0]), abs=0.01)
    assert y == pytest.approx(shape[1] - np.mean(shape[1]), abs=0.01)


def test_a_ring_that_is_cut_open_is_slower_to_form():
    base = open_module("formation")
    base.RING[0, 5] = base.RING[5, 0] = 0
    (check,) = base.checks(mars2d.run(base.scenario().replace(stop_time=100)))
    gone = 0.15 * (2 - 2 * np.cos(pi / 6)) * 0.1  # of what is off, after 0.1 s
    assert check.predicted == pytest.approx(-np.log(1 - gone) / 0.1)
    assert check.ok
