"""Drives: their motion in closed form, their limits, their noise, their dead time."""

from __future__ import annotations

from math import atan, pi, sqrt, tan

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import mars2d
from mars2d import (
    Car,
    Differential,
    Drive,
    Dubins,
    Holonomic,
    InputError,
    LawError,
    Robot,
    Scenario,
    Unicycle,
    World,
)
from tests.cases import each_case
from tests.worlds import arc

START = (0.0, 0.0, 0.0)


def free(*drives: Drive, **fields) -> Scenario:
    """Return a scenario of robots with these drives, far from each other."""
    robots = [Robot(pose=(100.0 * i, 0, 0), drive=drive) for i, drive in enumerate(drives)]
    return Scenario(**({"workspace": None, "stop_time": 1e6, "robots": robots} | fields))


def driven(scenario: Scenario, commands, seed: int = 0) -> mars2d.Record:
    """Return the record of a run under these commands, (2,) or (2, n) each."""
    world = World(scenario, seed=seed)
    for command in commands:
        world.step(np.broadcast_to(np.reshape(command, (2, -1)), world.command.shape))
    world.stop("done")
    return world.record


# -- motion ---------------------------------------------------------------------------------

speeds = st.floats(-1, 1)
periods = st.sampled_from([0.01, 0.1, 1.0, 7.0])


@given(left=speeds, right=speeds, radius=st.floats(0.01, 1), axis=st.floats(0.05, 1), dt=periods)
def test_wheels_that_turn_bring_a_differential_drive_along_its_arc(left, right, radius, axis, dt):
    drive = Differential(wheel_radius=radius, wheel_semiaxis=axis, max_linear_speed=2)
    record = driven(free(drive, sampling_time=dt), [(left, right)] * 20)
    v, omega = radius * (right + left) / 2, radius * (right - left) / (2 * axis)
    assert record.pose[-1, :, 0] == pytest.approx(arc(START, v, omega, 20 * dt), abs=1e-9)


@given(v=speeds, omega=speeds, radius=st.floats(0.01, 1), dt=periods)
def test_commanded_by_v_and_omega_it_is_a_unicycle_whatever_its_wheels(v, omega, radius, dt):
    twist = Differential(command="twist", wheel_radius=radius, max_linear_speed=2)
    drives = [twist, Unicycle(max_linear_speed=2)]
    record = driven(free(*drives, sampling_time=dt), [(v, omega)] * 20)
    assert record.pose[-1, :, 0] == pytest.approx(arc(START, v, omega, 20 * dt), abs=1e-9)
    shifted = record.pose[:, :, 1] - np.array([100.0, 0, 0])
    assert np.abs(record.pose[:, :, 0] - shifted).max() < 1e-9


@given(v=speeds, delta=st.floats(-1.2, 1.2), wheelbase=st.floats(0.1, 3), dt=periods)
def test_a_car_goes_round_a_circle_of_wheelbase_over_tan_delta(v, delta, wheelbase, dt):
    drive = Car(wheelbase=wheelbase, max_steering=1.3, max_linear_speed=2)
    pose = driven(free(drive, sampling_time=dt), [(v, delta)] * 20).pose[:, :, 0]
    assert pose[-1] == pytest.approx(arc(START, v, v * tan(delta) / wheelbase, 20 * dt), abs=1e-9)
    if abs(delta) > 0.01:
        radius = wheelbase / tan(delta)
        assert np.hypot(pose[:, 0], pose[:, 1] - radius) == pytest.approx(abs(radius), abs=1e-9)


# -- a drive of one's own -------------------------------------------------------------------


class Crab(Drive):
    """Slides to the left as fast as it goes ahead; commanded by (v, omega)."""

    def twist(self, command):
        v, omega = command
        return np.array([v, v, omega])


def test_a_drive_of_ones_own_needs_only_its_twist():
    record = driven(free(Crab()), [(0.2, 0.0)] * 10)
    assert record.pose[-1].ravel() == pytest.approx([0.2, 0.2, 0])


def test_it_has_acceleration_noise_and_dead_time_for_nothing():
    drives = [Crab(max_acceleration=0.5), Crab(noise=0.1 * ROOT), Crab(dead_time=0.25), Crab()]
    record = driven(free(*drives), [(0.2, 0.1)] * 400)
    assert record.command[:3, :, 0] == pytest.approx(
        np.array([[0.05, 0.05], [0.1, 0.1], [0.15, 0.1]])
    )
    speed, spin = moved(record, 1)
    assert spin.std() == pytest.approx(0.01, rel=0.15)
    assert speed.std() == pytest.approx(0.02 * sqrt(2), rel=0.15)
    assert record.pose[10, 2, 2] == pytest.approx(0.1 * (1 - 0.25))
    assert record.pose[10, 2, 3] == pytest.approx(0.1)


def moved(record: mars2d.Record, robot: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Return the speed ahead, or along its path, and the spin in each control step."""
    change = np.diff(record.pose[:, :, robot], axis=0) / record.scenario.sampling_time
    return np.hypot(change[:, 0], change[:, 1]), change[:, 2]


# -- limits ---------------------------------------------------------------------------------


def rims(drive: Differential, command: np.ndarray) -> np.ndarray:
    """Return the speeds of the wheels' rims, left and right, from the definition."""
    first, second = command
    if drive.command == "wheels":
        return drive.wheel_radius * np.array([first, second])
    side = drive.wheel_semiaxis * second
    return np.array([first - side, first + side])


anything = st.floats(-1e3, 1e3)
limits = st.floats(0.05, 5)


@given(first=anything, second=anything, mode=st.sampled_from(["wheels", "twist"]), limit=limits)
def test_each_wheels_rim_is_clipped_by_itself(first, second, mode, limit):
    drive = Differential(command=mode, wheel_radius=0.03, max_linear_speed=limit)
    wanted = np.array([[first], [second]])
    found = rims(drive, drive.saturate(wanted.copy()))
    assert found == pytest.approx(rims(drive, wanted).clip(-limit, limit), rel=1e-9, abs=1e-9)


@given(v=anything, delta=anything, limit=limits, steering=st.floats(0.1, 1.5))
def test_a_cars_speed_and_steering_are_clipped_each_by_itself(v, delta, limit, steering):
    drive = Car(max_linear_speed=limit, max_steering=steering)
    found = drive.saturate(np.array([[v], [delta]])).ravel()
    assert found == pytest.approx([np.clip(v, -limit, limit), np.clip(delta, -steering, steering)])


spins = st.floats(0.05, 5)


@given(v=anything, omega=anything, limit=limits, most=spins)
def test_omega_is_clipped_first_and_then_each_rim(v, omega, limit, most):
    drive = Unicycle(max_linear_speed=limit, max_angular_speed=most)
    wheels = Differential(max_linear_speed=limit, max_angular_speed=most, wheel_radius=0.03)
    slow = np.array([[v], [np.clip(omega, -most, most)]])
    expected = Unicycle(max_linear_speed=limit).saturate(slow)
    found = drive.saturate(np.array([[v], [omega]]))
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-9)
    assert abs(found[1, 0]) <= most * (1 + 1e-9)
    turned = wheels.saturate(np.array([[v - 0.1 * omega], [v + 0.1 * omega]]) / 0.03)
    assert wheels.twist(turned)[::2] == pytest.approx(expected, rel=1e-9, abs=1e-9)


@given(v=anything, delta=anything, most=spins)
def test_a_car_steers_less_the_faster_it_goes_and_keeps_its_speed(v, delta, most):
    drive = Car(max_linear_speed=2, max_steering=1.2, max_angular_speed=most, wheelbase=0.3)
    command = drive.saturate(np.array([[v], [delta]]))
    speed, _, omega = drive.twist(command).ravel()
    free = Car(max_linear_speed=2, max_steering=1.2, wheelbase=0.3)
    wanted = free.twist(free.saturate(np.array([[v], [delta]]))).ravel()
    assert speed == wanted[0]
    assert omega == pytest.approx(np.clip(wanted[2], -most, most), rel=1e-9, abs=1e-12)


@given(v=anything, omega=anything)
def test_a_dubins_vehicle_goes_at_its_speed_whatever_it_is_told(v, omega):
    drive = Dubins(max_linear_speed=0.4, max_angular_speed=0.8)
    found = drive.saturate(np.array([[v], [omega]]))
    assert found.ravel().tolist() == [0.4, pytest.approx(np.clip(omega, -0.8, 0.8))]


@each_case(
    ("drive", "command", "radius"),
    [
        (Unicycle(max_linear_speed=1, max_angular_speed=0.5), (0.4, 9.0), 0.8),
        (Differential(command="twist", max_linear_speed=1, max_angular_speed=0.5), (0.4, 9), 0.8),
        (Car(max_angular_speed=0.5), (0.4, 9.0), 0.8),
        (Car(max_steering=0.1), (0.4, 9.0), 0.2 / tan(0.1)),
        (Car(max_steering=0.1, max_angular_speed=0.1), (0.4, 9.0), 4.0),
        (Dubins(max_linear_speed=0.4, max_angular_speed=0.5), (0.0, 9.0), 0.8),
    ],
)
def test_the_tightest_circle_has_the_turning_radius(drive, command, radius):
    record = driven(free(drive, sampling_time=0.05), [command] * 200)
    x, y = record.pose[:, :2, 0].T
    assert drive.turning_radius(0.4) == pytest.approx(radius, rel=1e-12)
    assert np.hypot(x, y - radius) == pytest.approx(radius, rel=1e-9)


def test_a_ramp_turns_a_car_no_quicker_than_it_may():
    drive = Car(max_angular_speed=0.3, max_acceleration=0.5, max_steering_rate=1.0)
    record = driven(free(drive, sampling_time=0.5), [(0.5, 0.0), (0.0, 0.6), (0.5, 0.6)] * 5)
    turned = np.abs(np.diff(record.pose[:, 2, 0])) / 0.5
    assert turned.max() <= 0.3 + 1e-9
    assert turned.max() > 0.2


DRIVES = [
    Unicycle(max_acceleration=0.7),
    Unicycle(max_acceleration=0.7, max_angular_speed=1.3),
    Differential(max_angular_speed=1.3),
    Car(max_acceleration=0.7, max_steering_rate=0.9, max_angular_speed=0.8),
    Dubins(max_angular_speed=1.3),
    Differential(max_acceleration=0.7),
    Differential(command="twist", max_acceleration=0.7, wheel_semiaxis=0.13),
    Holonomic(max_acceleration=0.7),
    Car(max_acceleration=0.7, max_steering_rate=0.9),
    Car(max_steering_rate=0.9),
    Crab(max_acceleration=0.7),
]


AT_A_LIMIT = [
    (sign * first * (1 + excess), second * (1 - excess))
    for first, second in ((0.5, 0.0), (0.25, 2.5), (10.0, 10.0), (0.5, 0.6), (0.4, 0.3))
    for excess in (-1e-15, 0.0, 3e-16, 9.99e-13, 1.0001e-12)
    for sign in (-1, 1)
]
"""Commands about as large as the drives allow, or a little beyond, within rounding or not."""


@each_case("drive", DRIVES)
@settings(max_examples=10)
@given(
    commands=st.lists(
        st.tuples(st.floats(-30, 30), st.floats(-30, 30)) | st.sampled_from(AT_A_LIMIT),
        min_size=1, max_size=20,
    ),
    dt=st.sampled_from([1e-6, 1e-3, 0.1, 0.3]),
)  # fmt: skip
def test_limited_commands_given_again_are_the_same_to_the_bit(drive, commands, dt):
    scenario = free(drive, sampling_time=dt, stop_time=10)
    first, second = World(scenario), World(scenario)
    for command in commands:
        first.step(np.array([command]).T)
        second.step(first.command)
        assert np.array_equal(first.command, second.command)
    assert np.array_equal(first.pose, second.pose)


@each_case("drive", DRIVES)
@given(
    wanted=st.tuples(anything, anything), last=st.tuples(anything, anything), dt=st.floats(1e-6, 10)
)
def test_actuators_change_no_quicker_than_they_can_and_towards_what_is_wanted(
    drive, wanted, last, dt
):
    wanted, last = (np.array([pair]).T for pair in (wanted, last))
    had = drive.actuators(last)
    change = drive.actuators(drive.accelerate(wanted, last, dt)) - had
    aim = drive.actuators(wanted) - had
    if isinstance(drive, Holonomic):
        change, aim = np.hypot(*change), np.hypot(*aim)
    slack = 1e-9 * (1 + np.abs(had).max())
    for k, rate in enumerate(drive.rates):
        limit = np.inf if rate is None else rate * dt
        size = np.ravel(change)[k % change.size]
        goal = np.ravel(aim)[k % aim.size]
        assert abs(size) <= limit + slack
        assert size == pytest.approx(np.clip(goal, -limit, limit), abs=slack)


# -- noise ----------------------------------------------------------------------------------

ROOT = sqrt(0.1)
"""The root of the default sampling time: noise of a x ROOT is off by a share a each step."""


def noisy(*names: str) -> Scenario:
    robots = [
        Robot(name=name, pose=(10.0 * i, 0, 0), drive=Unicycle(noise=0.2))
        for i, name in enumerate(names)
    ]
    return Scenario(robots=robots, workspace=None)


def test_noise_follows_the_seed_and_the_robots_name_and_nothing_else():
    commands = [(0.2, 0.3)] * 300
    one = driven(noisy("anna"), commands, seed=5)
    assert one.digest == driven(noisy("anna"), commands, seed=5).digest
    assert one.digest != driven(noisy("anna"), commands, seed=6).digest
    two = driven(noisy("bert", "anna"), commands, seed=5)
    assert np.abs(two.pose[:, 2, 1] - one.pose[:, 2, 0]).max() == 0
    assert np.abs(two.pose[:, 2, 0] - one.pose[:, 2, 0]).max() > 0.01


# -- dead time ------------------------------------------------------------------------------


@each_case("delay", [0.0, 0.1, 0.13])
@each_case("dead_times", [(0.0, 0.25), (0.3, 0.04), (0.07, 0.33), (0.2, 0.2)])
def test_robots_move_by_what_was_commanded_their_dead_time_and_the_delay_ago(dead_times, delay):
    drives = [Holonomic(max_linear_speed=10, dead_time=dead) for dead in dead_times]
    speeds = np.random.default_rng(0).uniform(-1, 1, (40, 2))
    record = driven(free(*drives, command_delay=delay), [[pair, np.zeros(2)] for pair in speeds])
    for robot, dead in enumerate(dead_times):
        for k, time in enumerate(record.time):
            begun = np.clip(time - delay - dead - 0.1 * np.arange(40), 0, 0.1)
            way = record.pose[k, 0, robot] - 100 * robot
            assert way == pytest.approx(speeds[:, robot] @ begun, abs=1e-9)


# -- bad input ------------------------------------------------------------------------------


@each_case(
    ("kind", "field", "values"),
    [
        (Differential, "wheel_radius", [0, -0.1, 1e9]),
        (Differential, "command", ["wheel", "", None, 3]),
        (Car, "max_steering", [0, -0.3, pi / 2, 2]),
        (Unicycle, "noise", [-0.1, 1.5]),
        (Crab, "max_linear_speed", [0, -1]),
    ],
)
def test_a_wrong_value_is_refused_by_the_name_of_its_field(kind, field, values):
    for value in [*values, float("nan"), float("inf"), "0.1", True, [1]]:
        with pytest.raises(InputError, match=rf"^{kind.__name__}\.{field} = .*: expected "):
            kind(**{field: value})


def test_a_dead_time_of_more_sampling_times_than_can_be_kept_is_refused():
    scenario = Scenario(robots=[Robot(drive=Car(dead_time=2))], sampling_time=1e-6, stop_time=1)
    with pytest.raises(InputError, match=r"Car.dead_time = 2.0: expected at most a million"):
        World(scenario)


@each_case("method", ["saturate", "accelerate", "twist"])
def test_what_fails_in_a_drive_of_ones_own_is_said_with_its_name(method):
    def fail(self, *arguments):
        raise ZeroDivisionError("no wheels")

    broken = type("Broken", (Unicycle,), {method: fail})
    world = World(Scenario(robots=[Robot(drive=broken(max_acceleration=1.0))]))
    with pytest.raises(LawError, match=r", line \d+: drive Broken raised ZeroDivisionError: no"):
        world.step([[0.1], [0.0]])


def test_a_drive_that_asks_for_more_than_can_be_reckoned_with_is_told_so():
    class Wild(Unicycle):
        def twist(self, command):
            return np.full((3, command.shape[1]), 1e7)

    world = World(Scenario(robots=[Robot(drive=Wild())]))
    told = r"twist returned \[\[10000000.0\].*: expected finite numbers, 1e\+06 at most"
    with pytest.raises(LawError, match=told):
        world.step([[0.1], [0.0]])


LIMITED = [
    Unicycle(max_acceleration=0.7, noise=0.1),
    Differential(max_acceleration=0.7, noise=0.1),
    Car(max_acceleration=0.7, max_steering_rate=0.9, noise=0.1),
    Holonomic(max_acceleration=0.7, noise=0.1),
]


@each_case("drive", LIMITED)
def test_many_robots_are_driven_as_each_of_them_by_itself(drive):
    rng = np.random.default_rng(1)
    command, last, normal = (drive.command_for(rng.uniform(-1, 1, (2, 40))) for _ in range(3))
    command[:, :5] = last[:, 5:10] = 0.0
    kept = (drive.saturate(command) == command).all(axis=0)
    assert 8 < kept.sum() < 32
    for done in (
        lambda columns: drive.saturate(command[:, columns]),
        lambda columns: drive.accelerate(command[:, columns], last[:, columns], 0.3),
        lambda columns: drive.disturb(command[:, columns], normal[:, columns]),
        lambda columns: drive.noisy_twist(command[:, columns], normal[:, columns]),
        lambda columns: drive.twist(command[:, columns]),
    ):
        each = np.hstack([done(slice(k, k + 1)) for k in range(40)])
        assert np.array_equal(done(slice(None)), each)


@each_case(
    ("drive", "command", "expected"),
    [
        (Unicycle(noise=0.1, wheel_semiaxis=0.1), (0.3, 1.0), (0.33, 0, 1.5)),  # rims 0.2, 0.4
        (Differential(noise=0.1), (2.0, 4.0), (0.165, 0, 0.75)),  # rims 0.09, 0.24
        (Car(noise=0.1, max_steering=0.5), (0.3, atan(0.2)), (0.27, 0, 0.27 + 0.15)),
        (Holonomic(noise=0.1), (0.3, 0.4), (0.25, 0.5, 0)),
    ],
)
def test_noise_is_added_to_what_each_actuator_does(drive, command, expected):
    normal = np.array([[-1.0], [2.0]])
    twist = drive.noisy_twist(np.array(command)[:, None], normal)
    assert twist[:, 0] == pytest.approx(expected)
