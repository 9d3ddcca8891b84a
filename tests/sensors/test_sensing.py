"""What makes a sensor imperfect, when it measures, and when its reading arrives."""

from __future__ import annotations

from math import inf, nan, pi
from typing import ClassVar

import numpy as np
import pytest

import mars2d
from mars2d import InputError, LawError, Robot, Scenario, World, addons
from mars2d.addons import Map
from mars2d.core.quantity import ANGLE, COLOR, DISTANCE, FLAG
from mars2d.sensors import (
    Beacon,
    LineCamera,
    Proximity,
    RangeBearing,
    RangeFinder,
    Sensor,
    SonarRing,
)
from tests.cases import each_case

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


@each_case("kind", [Constant, Distances, Angles, Colors])
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


def test_values_are_rounded_to_multiples_of_the_resolution():
    values = measured(Distances(noise=0.3, resolution=0.25))
    assert np.array_equal(values[np.isfinite(values)] % 0.25, np.zeros(np.isfinite(values).sum()))
    assert len(np.unique(values)) > 5
    rows = measured(RangeBearings(value=1.13, resolution=(0.1, 0.0), count=1))
    assert rows.tolist() == [[pytest.approx(1.1), 0.5]]


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


def test_a_slower_sensor_holds_its_reading():
    assert times(Clock(rate=10 / 3)) == [0, 0, 0, 0.3, 0.3, 0.3, 0.6, 0.6]
    assert len(Clock.calls) == 3
    record = mars2d.run(Scenario(robots=[Robot(sensors=[Clock(rate=5)])], stop_time=0.5))
    assert record.sensors["clock"][:, 0] == pytest.approx([0, 0, 0.2, 0.2, 0.4, 0.4])


@each_case(("latency", "steps"), [(0.1, 1), (0.2, 2), (0.3, 3), (0.05, 1), (0.15, 2), (0.201, 3)])
def test_a_reading_arrives_at_the_first_control_step_after_its_latency(latency, steps):
    seen = times(Clock(latency=latency))
    assert np.isnan(seen[:steps]).all()
    assert seen[steps:] == [round(0.1 * k, 9) for k in range(8 - steps)]


def test_before_the_first_arrival_nothing_is_there():
    late = {"latency": 10.0, "count": 2}
    assert measured(Distances(**late)).tolist() == [inf, inf]
    assert measured(Flags(**late)).tolist() == [False, False]
    assert np.isnan(measured(Colors(**late))).all()
    assert measured(RangeBearings(**late))[:, 0].tolist() == [inf, inf]
    assert np.isnan(measured(RangeBearings(**late))[:, 1]).all()
    assert measured(Proximity(range=9, latency=1)) is False
    assert np.isinf(measured(RangeFinder(beams=5, latency=0.5))).all()


def test_what_is_not_recorded_is_measured_all_the_same():
    robot = Robot(sensors=[Clock(recorded=False)], controller=lambda r: (r.sense.clock, 0))
    record = mars2d.run(Scenario(robots=[robot], workspace=None, stop_time=0.3))
    assert record.command[:, 0, 0] == pytest.approx([0, 0.1, 0.2, 0.3])
    assert "clock" not in record.sensors
    assert "clock" not in record.sensor_robots


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


@each_case(
    ("make", "message"),
    [
        (lambda: RangeFinder(beams=0), r"RangeFinder.beams = 0: expected a whole number from 1"),
        (
            lambda: RangeFinder(field_of_view=6.3),
            r"RangeFinder.field_of_view = 6.3: .*<= 2 pi, in radians; 6.3 degrees are",
        ),
        (lambda: RangeFinder(range=0), r"RangeFinder.range = 0: expected a number > 0"),
        (lambda: RangeFinder(noise=(1, 2)), r"RangeFinder.noise = .*: expected one number \[m\]$"),
        (lambda: RangeBearings(noise=(1, 2, 3)), r"RangeBearings.noise.*2: distance .*angle"),
        (lambda: RangeFinder(dropouts=nan), r"RangeFinder.dropouts = nan"),
        (lambda: RangeFinder(rate=0), r"RangeFinder.rate = 0: expected a number > 0"),
        (lambda: Proximity(range=1, noise=0.1), r"Proximity.noise = 0.1: .*True or False"),
        (lambda: Constant(outliers=0.1), r"Constant.outliers = 0.1: .*or Constant.noise, too"),
        (lambda: SonarRing(cone=7), r"SonarRing.cone = 7: .*<= 2 pi, in radians"),
    ],
)
def test_what_can_not_be_is_refused_by_name(make, message):
    with pytest.raises(InputError, match=message):
        make()


@each_case("rate", [3, 7, 20, 10.5])
def test_a_rate_divides_the_sampling_rate(rate):
    robot = Robot(sensors=[RangeFinder(rate=rate)], name="scout")
    with pytest.raises(InputError, match=rf"RangeFinder of scout: rate = {rate:g} Hz: .*10 Hz"):
        Scenario(robots=[robot], sampling_time=0.1)


# -- what a review has found ---------------------------------------------------------------------


@each_case("faults", [{}, {"latency": 0.2}, {"dropouts": 0.5}, {"noise": 0.1}])
@each_case("reading", [[[1], [2, 3]], "near", None])
def test_what_is_no_reading_is_a_named_error_whatever_is_done_to_it(faults, reading):
    class Odd(Sensor):
        def read(self, robot, world, rng):
            return reading

    with pytest.raises(LawError, match=r"sensor 'odd' read .*: a reading is a number"):
        mars2d.run(Scenario(robots=[Robot(sensors=[Odd(**faults)])], stop_time=1))


# -- equal sensors are read together -------------------------------------------------------------


class Roll(Sensor):
    """Reads all robots that carry such a one at once, and says of how many it was asked."""

    asked: ClassVar[list[tuple[int, ...]]] = []
    fault: bool = False

    def read(self, robot, world, rng):
        return float(robot.index)

    def read_all(self, robots, world, rngs):
        self.asked.append(tuple(robot.index for robot in robots))
        if self.fault:
            raise RuntimeError("no")
        return [self.read(robot, world, rng) for robot, rng in zip(robots, rngs, strict=True)]


@pytest.fixture(autouse=True)
def _roll_up():
    Roll.asked.clear()


def team(*sensors, **fields):
    """A world of robots in a room, one with each list of sensors."""
    robots = [
        Robot(pose=(k % 3 - 1, k // 3 - 1, 0.7 * k), sensors=list(mine))
        for k, mine in enumerate(sensors)
    ]
    fields = {"addons": [Map([[(2, -2), (2, 2)]])]} | fields
    return World(Scenario(robots=robots, **fields), seed=2)


def test_equal_sensors_are_read_at_once():
    world = team([Roll()], [Roll(name="other")], [Roll(), Roll(rate=5, name="slow")], [Roll()])
    for _ in range(2):
        world.step(np.zeros((2, 4)))
    assert Roll.asked == [(0, 2, 3)] * 2  # who is alone is asked to read
    assert world.record.sensors["roll"].tolist() == [[0, 2, 3]] * 2
    assert world.record.sensors["other"].tolist() == [[1]] * 2


def test_a_fault_in_reading_many_is_named():
    world = team([Roll(fault=True)], [Roll(fault=True)])
    with pytest.raises(LawError, match="sensor 'roll' raised RuntimeError: no") as caught:
        world.step(np.zeros((2, 2)))
    assert "test_sensing.py, line" in str(caught.value.where)


def test_who_reads_in_another_way_is_asked_one_by_one():
    """A class that inherits how many are read at once may keep things, or measure otherwise."""

    class Nodding(RangeFinder):
        def on_step(self, robot, world, rng):
            self.tilt = 0.1 * robot.index

        def read(self, robot, world, rng):
            return super().read(robot, world, rng) + self.tilt

    world = team([Nodding(beams=3)], [Nodding(beams=3)])
    world.observe()
    for robot in world.robots:
        plain = RangeFinder(beams=3).read(robot, world.surroundings, robot.rng)
        assert np.array_equal(robot.sense.nodding, plain + 0.1 * robot.index)


@each_case(
    ("kind", "fields"),
    [
        (RangeBearing, {"range": 2.5, "mount": (0.1, 0.0, 0.5), "noise": (0.1, 0.02)}),
        (RangeBearing, {"identity": False, "field_of_view": 4.0, "noise": (0.1, 0.02)}),
        (RangeBearing, {"through_walls": True}),
        (Beacon, {"noise": (0.1, 0.02), "mount": (0.1, 0.1, 0.5)}),
        (RangeFinder, {"beams": 7, "noise": 0.1}),
        (SonarRing, {"noise": 0.1}),
        (LineCamera, {"pixels": 5, "noise": 0.1}),
    ],
)
@each_case("errors", [{}, {"outliers": 0.2, "dropouts": 0.2, "resolution": 0.01}])
def test_with_a_team_a_sensor_reads_what_it_reads_alone_to_the_last_bit(kind, fields, errors):
    class Alone(kind):
        """It does not say itself how many are read at once."""

    together = kind(**fields, **errors)
    alone = Alone(**fields, **errors, name=together.key)
    lamps = [addons.Beacon(at=(1, 0.4), name="a"), addons.Beacon(at=(-3, 1), name="b")]
    rows = []
    for sensor in (together, alone):
        world = team(*[[sensor]] * 5, addons=[*lamps, Map([[(0.5, -2), (0.5, 0.5)]])])
        for _ in range(20):
            world.step(np.full((2, 5), 0.1))
        rows.append(world.record.sensors[together.key].tobytes())
    assert rows[0] == rows[1]
