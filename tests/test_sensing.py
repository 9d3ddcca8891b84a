"""What makes a sensor imperfect, when it measures, and when its reading arrives."""

from __future__ import annotations

from math import inf, nan, pi
from typing import ClassVar

import numpy as np
import pytest

import mars2d
from mars2d import InputError, LawError, Robot, Scenario, World
from mars2d.addons import Map
from mars2d.sensors import Proximity, RangeFinder, Sensor, SonarRing
from mars2d.sensors.base import ANGLE, COLOR, DISTANCE, FLAG, NUMBER

MANY = 40_000


class Constant(Sensor):
    """Reads `value` again and again."""

    value: float = 1.0
    count: int = MANY

    def read(self, robot, world, rng):
        return np.full(self.count, self.value)


class Distances(Constant):
    quantities: ClassVar = (DISTANCE,)
    range: float = 4.0


class Angles(Constant):
    quantities: ClassVar = (ANGLE,)


class Colors(Constant):
    quantities: ClassVar = (COLOR,)


class Flags(Constant):
    quantities: ClassVar = (FLAG,)

    def read(self, robot, world, rng):
        return np.arange(self.count) % 2 == 0


class RangeBearings(Constant):
    """Rows of range and bearing."""

    quantities: ClassVar = (DISTANCE, ANGLE)
    range: float = 4.0

    def read(self, robot, world, rng):
        return np.full((self.count, 2), (self.value, 0.5))


def measured(sensor: Sensor, steps: int = 0):
    """What the sensor reads on a robot that stands still, after some steps."""
    world = World(Scenario(robots=[Robot(sensors=[sensor])]), seed=3)
    for _ in range(steps):
        world.step([[0], [0]])
    world.observe()
    return getattr(world.robots[0].sense, sensor.key)


# -- what becomes of a perfect reading -----------------------------------------------------------


def test_without_imperfections_a_reading_is_what_was_read():
    assert np.array_equal(measured(Distances(count=3)), [1, 1, 1])
    assert np.array_equal(measured(RangeBearings(count=2)), [(1, 0.5)] * 2)


@pytest.mark.parametrize("kind", [Constant, Distances, Angles, Colors])
def test_noise_is_normal_with_the_given_deviation(kind):
    values = measured(kind(noise=0.05, value=0.5)) - 0.5
    assert abs(values.mean()) < 4 * 0.05 / np.sqrt(MANY)
    assert values.std() == pytest.approx(0.05, rel=0.02)
    assert (np.abs(values) < 0.05).mean() == pytest.approx(0.683, abs=0.01)


def test_noise_is_given_for_each_quantity_or_for_all():
    each = measured(RangeBearings(noise=(0.2, 0.01)))
    assert each.std(axis=0) == pytest.approx([0.2, 0.01], rel=0.03)
    assert abs(np.corrcoef(each.T)[0, 1]) < 0.03
    assert measured(RangeBearings(noise=0.1)).std(axis=0) == pytest.approx([0.1, 0.1], rel=0.03)


def test_a_distance_is_never_negative_and_inf_beyond_the_range():
    low, high = measured(Distances(value=0.0, noise=0.1)), measured(Distances(value=4.0, noise=0.1))
    assert low.min() == 0
    assert (low == 0).mean() == pytest.approx(0.5, abs=0.02)
    assert np.isinf(high).mean() == pytest.approx(0.5, abs=0.02)
    assert high[np.isfinite(high)].max() <= 4.0


def test_an_angle_is_wrapped_and_a_colour_stays_between_black_and_white():
    angles = measured(Angles(value=pi, noise=0.1))
    assert angles.min() > -pi
    assert angles.max() <= pi
    assert (angles < 0).mean() == pytest.approx(0.5, abs=0.02)
    colors = measured(Colors(value=1.0, noise=0.1))
    assert (colors.max(), (colors == 1).mean()) == (1.0, pytest.approx(0.5, abs=0.02))


def test_what_is_not_there_stays_so_under_noise():
    assert np.isinf(measured(Distances(value=5.0, noise=0.1, resolution=0.5))).all()

    class Nowhere(Sensor):
        def read(self, robot, world, rng):
            return np.full(3, nan)

    assert np.isnan(measured(Nowhere(noise=0.1, resolution=0.5))).all()


def test_an_outlier_has_nothing_to_do_with_the_truth():
    values = measured(Distances(outliers=0.1, value=1.0))
    struck = values[values != 1.0]
    assert len(struck) / MANY == pytest.approx(0.1, abs=0.01)
    assert (struck.min(), struck.max()) == (pytest.approx(0, abs=0.01), pytest.approx(4, abs=0.01))
    assert struck.mean() == pytest.approx(2.0, abs=0.1)
    assert struck.std() == pytest.approx(4 / np.sqrt(12), rel=0.05)
    everywhere = measured(Distances(outliers=1.0, value=9.0))
    assert np.isfinite(everywhere).all()  # where there is nothing, too
    angles = measured(Angles(outliers=1.0))
    assert angles.std() == pytest.approx(2 * pi / np.sqrt(12), rel=0.02)
    colors = measured(Colors(outliers=1.0))
    assert colors.mean() == pytest.approx(0.5, abs=0.02)
    numbers = measured(Constant(outliers=1.0, noise=0.1))
    assert numbers.std() == pytest.approx(1.0, rel=0.02)  # ten times the noise


def test_an_outlier_of_a_flag_is_its_opposite():
    flags = measured(Flags(outliers=0.25))
    assert flags.dtype == bool
    assert (flags != (np.arange(MANY) % 2 == 0)).mean() == pytest.approx(0.25, abs=0.01)
    assert measured(Proximity(range=1, outliers=1.0)) is True


def test_a_drop_out_loses_a_row():
    alone = measured(Distances(dropouts=0.2))
    assert np.isinf(alone).mean() == pytest.approx(0.2, abs=0.01)
    rows = measured(RangeBearings(dropouts=0.2))
    lost = np.isinf(rows[:, 0])
    assert lost.mean() == pytest.approx(0.2, abs=0.01)
    assert np.array_equal(np.isnan(rows[:, 1]), lost)
    flags = measured(Flags(dropouts=0.5))
    assert flags.mean() == pytest.approx(0.25, abs=0.01)
    assert np.isnan(measured(Constant(dropouts=1.0))).all()


def test_a_single_value_stays_one():
    class One(Sensor):
        def read(self, robot, world, rng):
            return 2.0

    assert isinstance(measured(One(noise=0.1)), float)
    assert np.isnan(measured(One(dropouts=1.0)))
    assert measured(Proximity(range=1, dropouts=1.0)) is False


def test_values_are_rounded_to_multiples_of_the_resolution():
    values = measured(Distances(noise=0.3, resolution=0.25))
    assert np.array_equal(values[np.isfinite(values)] % 0.25, np.zeros(np.isfinite(values).sum()))
    assert len(np.unique(values)) > 5
    rows = measured(RangeBearings(value=1.13, resolution=(0.1, 0.0), count=1))
    assert rows.tolist() == [[pytest.approx(1.1), 0.5]]


def test_imperfections_come_in_the_documented_order():
    # Clipped after the noise, rounded after that, lost last.
    values = measured(Distances(value=0.0, noise=0.5, resolution=1.0, dropouts=0.3))
    assert set(np.unique(values[np.isfinite(values)])) <= {0.0, 1.0, 2.0, 3.0}
    assert np.isinf(values).mean() == pytest.approx(0.3, abs=0.01)


# -- when it measures ----------------------------------------------------------------------------


class Clock(Sensor):
    """Reads the time, and counts how often."""

    calls: ClassVar[list[float]] = []

    def read(self, robot, world, rng):
        self.calls.append(world.time)
        return world.time


@pytest.fixture(autouse=True)
def _wind_up():
    Clock.calls.clear()


def times(sensor: Sensor, steps: int = 8):
    """What is read in each of some control steps of 0.1 s."""
    world = World(Scenario(robots=[Robot(sensors=[sensor])]))
    seen = []
    for _ in range(steps):
        world.observe()
        seen.append(round(world.robots[0].sense.clock, 9))
        world.step()
    return seen


def test_a_sensor_measures_at_each_control_step():
    assert times(Clock()) == [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]


def test_a_slower_sensor_holds_its_reading():
    assert times(Clock(rate=10 / 3)) == [0, 0, 0, 0.3, 0.3, 0.3, 0.6, 0.6]
    assert len(Clock.calls) == 3
    record = mars2d.run(Scenario(robots=[Robot(sensors=[Clock(rate=5)])], stop_time=0.5))
    assert record.sensors["clock"][:, 0] == pytest.approx([0, 0, 0.2, 0.2, 0.4, 0.4])


@pytest.mark.parametrize(
    ("latency", "steps"), [(0.1, 1), (0.2, 2), (0.3, 3), (0.05, 1), (0.15, 2), (0.201, 3)]
)
def test_a_reading_arrives_at_the_first_control_step_after_its_latency(latency, steps):
    seen = times(Clock(latency=latency))
    assert np.isnan(seen[:steps]).all()
    assert seen[steps:] == [round(0.1 * k, 9) for k in range(8 - steps)]


def test_rate_and_latency_together():
    seen = times(Clock(rate=5, latency=0.3), 9)
    assert np.isnan(seen[:3]).all()
    assert seen[3:] == [0, 0, 0.2, 0.2, 0.4, 0.4]


def test_before_the_first_arrival_nothing_is_there():
    late = {"latency": 10.0, "count": 2}
    assert measured(Distances(**late)).tolist() == [inf, inf]
    assert measured(Flags(**late)).tolist() == [False, False]
    assert np.isnan(measured(Colors(**late))).all()
    assert measured(RangeBearings(**late))[:, 0].tolist() == [inf, inf]
    assert np.isnan(measured(RangeBearings(**late))[:, 1]).all()
    assert measured(Proximity(range=9, latency=1)) is False
    assert np.isinf(measured(RangeFinder(beams=5, latency=0.5))).all()


# -- what is not recorded ------------------------------------------------------------------------


def test_what_is_not_recorded_is_measured_only_when_a_law_asks():
    def law(robot):
        if robot.time > 0.35:
            return robot.sense.clock, robot.sense.clock
        return 0, 0

    robot = Robot(sensors=[Clock(recorded=False)], controller=law)
    record = mars2d.run(Scenario(robots=[robot], workspace=None, stop_time=0.6))
    assert Clock.calls == pytest.approx([0.4, 0.5, 0.6])  # once each
    assert "clock" not in record.sensors
    assert "clock" not in record.sensor_robots
    Clock.calls.clear()
    mars2d.run(Scenario(robots=[robot.replace(sensors=[Clock()])], workspace=None, stop_time=0.6))
    assert len(Clock.calls) == 7


def test_what_is_not_recorded_but_slow_measures_at_its_times():
    assert times(Clock(recorded=False, rate=5)) == [0, 0, 0.2, 0.2, 0.4, 0.4, 0.6, 0.6]
    assert np.isnan(times(Clock(recorded=False, latency=0.2))[:2]).all()


# -- random streams and state of one's own -------------------------------------------------------


def test_a_sensors_noise_does_not_depend_on_other_sensors():
    def read(*others):
        robots = [Robot(sensors=[Distances(count=5, noise=0.1), *others])]
        return mars2d.run(Scenario(robots=robots, stop_time=0.5), seed=8).sensors["distances"]

    alone = read()
    assert np.array_equal(read(RangeFinder(noise=0.1, dropouts=0.1), SonarRing(noise=1)), alone)
    assert not np.array_equal(alone[0], alone[1])


def test_robots_that_share_a_sensor_have_their_own_state():
    class Counter(Sensor):
        def on_start(self, robot, world, rng):
            self.total = 10 * robot.index

        def on_step(self, robot, world, rng):
            self.total += 1

        def read(self, robot, world, rng):
            return self.total

    sensor = Counter(rate=5)
    robots = [Robot(pose=(k, 0, 0), sensors=[sensor]) for k in range(2)]
    scenario = Scenario(robots=robots, stop_time=0.4)
    for _ in range(2):  # nor does anything stay from one run to the next
        record = mars2d.run(scenario)
        assert record.sensors["counter"].tolist() == [[1, 11], [1, 11], [3, 13], [3, 13], [5, 15]]
    assert not hasattr(sensor, "total")


# -- where it sits -------------------------------------------------------------------------------


def test_a_sensor_measures_from_its_mount():
    wall = Map([[(3, -9), (3, 9)]])
    sensor = RangeFinder(beams=1, mount=(0.5, 0.0, 0.3))
    robot = Robot(pose=(0, 0, 0), sensors=[sensor, RangeFinder(beams=1, name="plain")])
    world = World(Scenario(robots=[robot], addons=[wall]))
    world.observe()
    assert world.robots[0].sense.plain.tolist() == [pytest.approx(3)]
    assert world.robots[0].sense.range_finder.tolist() == [pytest.approx(2.5 / np.cos(0.3))]
    pose = sensor.placed(np.array([1.0, 2.0, pi / 2]))
    assert pose.tolist() == pytest.approx([1.0, 2.5, pi / 2 + 0.3])


# -- bad input -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: RangeFinder(beams=0), r"RangeFinder.beams = 0: expected a whole number from 1"),
        (lambda: RangeFinder(beams=2.5), r"RangeFinder.beams = 2.5: expected a whole number"),
        (lambda: RangeFinder(field_of_view=6.3), r"RangeFinder.field_of_view = 6.3: .*<= 6.28319"),
        (lambda: RangeFinder(field_of_view=0), r"RangeFinder.field_of_view = 0: .*> 0"),
        (lambda: RangeFinder(range=0), r"RangeFinder.range = 0: expected a number > 0"),
        (lambda: RangeFinder(noise=-1), r"RangeFinder.noise = -1: expected a standard deviation"),
        (lambda: RangeFinder(noise=(1, 2)), r"RangeFinder.noise = .*: expected one number, or 1"),
        (lambda: RangeBearings(noise=(1, 2, 3)), r"RangeBearings.noise.*2: distance .*angle"),
        (lambda: RangeBearings(resolution=(1,)), r"RangeBearings.resolution.*one number, or 2"),
        (lambda: RangeFinder(outliers=1.1), r"RangeFinder.outliers = 1.1: .*<= 1"),
        (lambda: RangeFinder(dropouts=nan), r"RangeFinder.dropouts = nan"),
        (lambda: RangeFinder(latency=-0.1), r"RangeFinder.latency = -0.1: expected a number >= 0"),
        (lambda: RangeFinder(rate=0), r"RangeFinder.rate = 0: expected a number > 0"),
        (lambda: RangeFinder(mount=(1, 2, 3, 4)), r"RangeFinder.mount = .*expected a pose"),
        (lambda: Proximity(range=1, noise=0.1), r"Proximity.noise = 0.1: .*True or False"),
        (lambda: Proximity(range=1, resolution=1), r"Proximity.resolution = 1.0: .*True or False"),
        (lambda: Constant(outliers=0.1), r"Constant.outliers = 0.1: .*give Constant.noise, too"),
        (lambda: SonarRing(sonars=0), r"SonarRing.sonars = 0: expected a whole number from 1"),
        (lambda: SonarRing(cone=7), r"SonarRing.cone = 7: .*<= 6.28319"),
    ],
)
def test_what_can_not_be_is_refused_by_name(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_outliers_of_a_distance_need_a_range():
    class Tape(Sensor):
        quantities: ClassVar = (DISTANCE,)

    with pytest.raises(InputError, match="Tape has no field range"):
        Tape(outliers=0.1)


@pytest.mark.parametrize("rate", [3, 7, 20, 10.5])
def test_a_rate_divides_the_sampling_rate(rate):
    robot = Robot(sensors=[RangeFinder(rate=rate)], name="scout")
    with pytest.raises(InputError, match=rf"RangeFinder of scout: rate = {rate:g} Hz: .*10 Hz"):
        Scenario(robots=[robot], sampling_time=0.1)


@pytest.mark.parametrize("rate", [10, 5, 2.5, 10 / 3, 1, 0.1])
def test_a_rate_that_divides_the_sampling_rate_is_accepted(rate):
    sensor = RangeFinder(rate=rate)
    Scenario(robots=[Robot(sensors=[sensor])], sampling_time=0.1)
    assert sensor.period(0.1) == round(10 / rate)


def test_a_latency_of_very_many_steps_is_refused():
    robot = Robot(sensors=[RangeFinder(latency=1000)])
    with pytest.raises(InputError, match=r"latency = 1000.*: expected at most 100000 sampling"):
        Scenario(robots=[robot], sampling_time=1e-3, stop_time=1)


def test_a_reading_without_its_quantities_is_refused():
    class Flat(Sensor):
        quantities: ClassVar = (DISTANCE, NUMBER)

        def read(self, robot, world, rng):
            return np.zeros(3)

    with pytest.raises(LawError, match="it measures 2 quantities, so the last axis"):
        measured(Flat(noise=0.1))
