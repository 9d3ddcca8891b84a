"""The base of all sensors."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from math import inf, pi, sqrt
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.core import checks
from mars2d.core.arithmetic import cosines_sines, steps_until
from mars2d.core.description import (
    Check,
    Schema,
    Stateful,
    accepts,
    entry,
    flag,
    number,
    real,
    snake_case,
    wrong,
)
from mars2d.core.errors import InputError
from mars2d.core.quantity import NUMBER, Quantity
from mars2d.core.scene import Scene
from mars2d.core.streams import Random, Streams
from mars2d.sensors.error_model import Imperfection
from mars2d.sensors.surroundings import Surroundings

Float = NDArray[np.float64]

MAX_STEPS = 100_000
"""The most control steps between two measurements, and from a measurement to its arrival."""


class Sighting(NamedTuple):
    """A thing that is seen: range [m], bearing [rad] from ahead, and the robot's index if known."""

    range: float
    bearing: float
    robot: int | None = None


class Fan(NamedTuple):
    """Beams or cones along which a sensor reads distances, one number of the reading each.

    angles: radians from the sensor's heading, evenly spaced. range: metres. cone: the angle in
    which each one hears, radians; 0 for beams. closed: whether the last beam is the neighbour of
    the first, so that together they sweep a full circle.
    """

    angles: Float
    range: float
    cone: float = 0.0
    closed: bool = False


FULL = 2 * pi

ROUNDED = 1e-5
"""The relative error that a value written by hand may have: a full circle, or a rate."""


def sight_angle(*, default: float, doc: str) -> Any:
    """Declare a field that holds an angle of view, 0 < angle <= 2 pi."""

    @accepts({"type": "number", "exclusiveMinimum": 0, "maximum": FULL * (1 + ROUNDED)})
    def check(name: str, value: object) -> float:
        expected = "a number > 0 and <= 2 pi"
        given = real(name, value, expected)
        if 0 < given <= FULL * (1 + ROUNDED):
            return min(given, FULL)
        if given > FULL:
            expected += f", in radians; {given:g} degrees are math.radians({given:g})"
        raise wrong(name, value, expected)

    return entry(default=default, check=check, unit="rad", doc=doc)


SPREAD: Schema = {"type": "number", "minimum": 0, "maximum": 1e6}


def spread(what: str) -> Check:
    """Return a check for 0 or a number from 1e-12 to 1e6, or one for each quantity."""
    expected = f"{what}: 0, or from 1e-12 to 1e6"
    or_several = f"{expected}; one number, or one for each quantity"

    def one(name: str, value: object, expected: str) -> float:
        result = real(name, value, expected)
        if result and not 1e-12 <= result <= 1e6:
            raise wrong(name, value, expected)
        return result

    @accepts({"anyOf": [SPREAD, {"type": "array", "items": SPREAD, "minItems": 1}]})
    def check(name: str, value: Any) -> float | tuple[float, ...]:
        if not isinstance(value, (tuple, list)) and not np.ndim(value):
            return one(name, value, or_several)
        each = tuple(one(f"{name}[{i}]", item, expected) for i, item in enumerate(value))
        if not each:
            raise wrong(name, value, or_several)
        return each

    return check


class Sensor(Stateful):
    """The base of all sensors: derive, declare fields, and write `read`.

    >>> from mars2d.sensors import ANGLE
    >>> class Compass(Sensor):
    ...     quantities = (ANGLE,)
    ...
    ...     def read(self, robot, world, rng):
    ...         return robot.pose[2]
    >>> Compass(noise=0.02).key
    'compass'

    `read` measures perfectly. The base then adds the errors of a device, in this order: noise,
    outliers, limits and wrapping, resolution, drop-outs, latency. `quantities` says what is
    measured: one `Quantity`, and the reading may have any shape; or several, and the last axis of
    the reading has one entry for each.

    A thing that is not there, a lost value, and a value that has not arrived yet read inf as a
    distance, False as a flag, and nan otherwise.

    Each robot of each world has its own copy, so methods may set attributes of self.
    """

    quantities: ClassVar[tuple[Quantity, ...]] = (NUMBER,)

    averages: ClassVar[bool] = False
    """Whether a reading is the mean over the time since the one before, as a gyroscope's is.

    Then `noise` is a density, in the reading's unit / sqrt(Hz): the mean over t seconds is off by
    the deviation noise / sqrt(t). So the sum over time does not depend on how often it is read.
    """

    _interval: ClassVar[float] = 1.0  # of one at work, seconds from one measurement to the next

    stays: ClassVar[bool] = False
    """Whether its drawing shows where things are, such as the points that a laser has hit.

    Between control steps it is then drawn at the pose of the measurement, not of the robot now. A
    late or slow reading is so in any case.
    """

    name: str | None = entry(
        default=None,
        check=checks.identifier("robot.sense."),
        optional=True,
        doc="the name of the reading",
    )
    mount: tuple[float, float, float] = entry(
        default=(0.0, 0.0, 0.0), check=checks.pose, unit="m, m, rad",
        doc="its pose on the robot: ahead, left, angle",
    )  # fmt: skip
    rate: float | None = number(
        default=None, above=0, high=1e6, unit="Hz", optional=True,
        doc="measurements per second; None: one per control step",
    )  # fmt: skip
    latency: float = number(
        default=0.0, low=0, high=1e4, unit="s", doc="from a measurement to its arrival"
    )
    noise: float | tuple[float, ...] = entry(
        default=0.0, check=spread("a standard deviation"),
        doc="standard deviation of each reading, in its unit",
    )  # fmt: skip
    outliers: float = number(
        default=0.0, low=0, high=1, doc="probability that a value is replaced by a random one"
    )
    dropouts: float = number(default=0.0, low=0, high=1, doc="probability that a value is lost")
    resolution: float | tuple[float, ...] = entry(
        default=0.0, check=spread("a step"),
        doc="values are rounded to multiples of it",
    )  # fmt: skip
    recorded: bool = flag(default=True, doc="whether its readings are kept in the record")

    @property
    def key(self) -> str:
        """The name of the reading: `name`, or that of the class in snake case."""
        return self.name or snake_case(type(self).__name__)

    def _validate(self) -> None:
        kind = type(self).__name__
        known = isinstance(self.quantities, tuple) and self.quantities
        if not (known and all(isinstance(quantity, Quantity) for quantity in self.quantities)):
            expected = "a tuple of quantities, such as (DISTANCE,); a single one needs the comma"
            raise wrong(f"{kind}.quantities", self.quantities, expected)
        for field, given in (("noise", self.noise), ("resolution", self.resolution)):
            if isinstance(given, tuple) and len(given) != len(self.quantities):
                names = [f"{q.name} [{q.unit}]" for q in self.quantities]
                several = f", or {len(names)}: {', '.join(names)}" if len(names) > 1 else ""
                unit = self.quantities[0].unit if not several else ""
                expected = f"one number{f' [{unit}]' if unit else ''}{several}"
                raise wrong(f"{kind}.{field}", given, expected)
        for quantity, noise, step in zip(self.quantities, *self._spreads, strict=True):
            if quantity.kind == "flag" and (noise or step):
                field, given = ("noise", noise) if noise else ("resolution", step)
                raise wrong(f"{kind}.{field}", given, f"0: {quantity.name} is True or False")
            far = {"distance": hasattr(self, "range"), "number": noise > 0}.get(quantity.kind, True)
            if self.outliers and not far:
                raise InputError(
                    f"{kind}.outliers = {self.outliers:g}: an outlier of {quantity.name} lies "
                    f"anywhere within the range, or is ten times as far off as the noise: give "
                    f"{kind} a field range, or {kind}.noise, too"
                )

    # -- methods to override -------------------------------------------------------------------

    def on_start(self, robot: Any, world: Surroundings, rng: np.random.Generator) -> None:
        """Prepare, once, before the first reading."""

    def on_step(self, robot: Any, world: Surroundings, rng: np.random.Generator) -> None:
        """Follow the robot: called at each control step, whether a reading is due or not."""

    def read(self, robot: Any, world: Surroundings, rng: np.random.Generator) -> Any:
        """Return the perfect reading now: a number, a bool, or an array of a shape that stays.

        robot: the robot that carries the sensor, a `RobotLike`. rng: this sensor's random stream.
        """
        raise NotImplementedError(
            f"{type(self).__name__} needs a method read(self, robot, world, rng)"
        )

    def read_all(
        self,
        robots: Sequence[Any],
        world: Surroundings,
        rngs: Sequence[np.random.Generator],
    ) -> Sequence[Any] | NDArray[Any]:
        """Return the perfect readings of several robots that carry such a sensor, one each.

        By default this calls `read` for each. Where a sensor class overrides it, robots with equal
        sensors are read in one call: it must not depend on attributes that methods have set, and
        must return a new array or list each time. rngs: one for each robot.
        """
        return [self.read(robot, world, rng) for robot, rng in zip(robots, rngs, strict=True)]

    def shown(self, reading: Any) -> Any:
        """Return the value that a law finds under ``robot.sense``; by default the reading."""
        return reading

    def draw(self, scene: Scene, pose: Float, reading: Any, color: str) -> None:
        """Draw the field of view and the reading for a robot at `pose` (3,); by default nothing."""

    def limits(self, extent: float) -> tuple[Float, Float]:
        """Return the least and the largest value of each of its quantities, (q,) each.

        extent: how far a position may be from the origin, m. A number of another unit than m is not
        bounded: +-inf.
        """
        ranges = {
            "distance": (0.0, getattr(self, "range", 2 * extent)),
            "angle": (-pi, pi), "color": (0.0, 1.0), "flag": (0.0, 1.0),
        }  # fmt: skip
        free = {"m": (-extent, extent)}
        each = [
            ranges.get(quantity.kind) or free.get(quantity.unit, (-inf, inf))
            for quantity in self.quantities
        ]
        low, high = np.array(each, dtype=float).T
        return low, high

    @property
    def fan(self) -> Fan | None:
        """The beams that it reads distances along; None for other sensors."""
        return None

    # -- when it measures --------------------------------------------------------------------

    def period(self, sampling_time: float) -> int:
        """Return how many control steps lie between two measurements."""
        return 1 if self.rate is None else round(1 / (self.rate * sampling_time))

    def age(self, sampling_time: float) -> int:
        """Return how many control steps a measurement needs to arrive."""
        return steps_until(self.latency, sampling_time)

    def measured_at(self, row: int, sampling_time: float) -> int:
        """Return the row at which the reading that is shown at a row was measured; 0 if none was.

        sampling_time: seconds.
        """
        period = self.period(sampling_time)
        return max(0, row - self.age(sampling_time)) // period * period

    def check_timing(self, name: str, sampling_time: float) -> None:
        """Raise InputError if it would measure between control steps, or too rarely, or too late.

        name: of the sensor, for the message. sampling_time: between control steps, seconds.
        """
        if self.rate is not None:
            if self.rate * sampling_time * MAX_STEPS < 1:
                raise wrong(
                    f"{name}: rate", self.rate,
                    f"one measurement in at most {MAX_STEPS} x {sampling_time:g} s",
                )  # fmt: skip
            exact = 1 / (self.rate * sampling_time)
            if abs(exact - round(exact)) > ROUNDED * exact or round(exact) < 1:
                sampling_rate = f"{1 / sampling_time:g}"
                raise InputError(
                    f"{name}: rate = {self.rate:g} Hz: expected the sampling rate, "
                    f"{sampling_rate} Hz, divided by a whole number, as "
                    f"{sampling_rate} / {max(round(exact), 1)}"
                )
        if self.latency / sampling_time > MAX_STEPS:
            raise wrong(
                f"{name}: latency", self.latency,
                f"at most {MAX_STEPS} sampling times of {sampling_time:g} s",
            )  # fmt: skip

    # -- where it sits, and its errors ---------------------------------------------------------

    def placed(self, pose: Float) -> Float:
        """Return the pose (3,) of the sensor on a robot at `pose`; of many, (3, m)."""
        ahead, left, turned = self.mount
        if self.mount == (0.0, 0.0, 0.0):
            return pose
        x, y, theta = pose
        c, s = cosines_sines(theta)
        return np.array([x + c * ahead - s * left, y + s * ahead + c * left, theta + turned])

    @cached_property
    def _spreads(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Noise and resolution, one for each quantity."""
        each = [
            value if isinstance(value, tuple) else (value,) * len(self.quantities)
            for value in (self.noise, self.resolution)
        ]
        return each[0], each[1]

    @cached_property
    def _imperfection(self) -> Imperfection:
        noise, resolution = self._spreads
        if self.averages:
            noise = tuple(density / sqrt(self._interval) for density in noise)
        top = float(getattr(self, "range", inf))
        return Imperfection(
            self.key, self.quantities, noise, resolution, self.outliers, self.dropouts, top
        )

    def measured(self, reading: Any, rng: Random) -> Any:
        """Return a perfect reading with the errors of the device, all but the latency.

        reading: or those of many devices as one array, whose first axis has one entry for each;
        then `rng` is their `Streams`.
        """
        return self._imperfection.of(reading, rng)

    def measured_all(
        self, readings: Sequence[Any] | NDArray[Any], rngs: Sequence[np.random.Generator]
    ) -> Any:
        """Return the perfect readings of several robots with errors; arrays in one stay so."""
        if isinstance(readings, np.ndarray):
            if readings.ndim > 1:
                return self.measured(readings, Streams(rngs))
            each = zip(readings.tolist(), rngs, strict=True)
            return np.array([self.measured(reading, rng) for reading, rng in each])
        return [self.measured(each, rng) for each, rng in zip(readings, rngs, strict=True)]

    def lost(self, reading: Any) -> Any:
        """Return the reading in place of one that has not arrived."""
        return self._imperfection.lost(reading)


class Scanner(Sensor):
    """The base of sensors that read a team at once: they write `scan` in place of `read`."""

    stays: ClassVar[bool] = True

    def scan(self, poses: Float, robots: list[int], world: Surroundings) -> NDArray[Any]:
        """Return the perfect readings (m, ...) of robots whose sensors are at poses (3, m).

        robots: their indices.
        """
        raise NotImplementedError(
            f"{type(self).__name__} needs a method scan(poses, robots, world)"
        )

    def read(self, robot: Any, world: Surroundings, rng: np.random.Generator) -> Any:
        """Return the perfect reading now."""
        return self.read_all([robot], world, [rng])[0]

    def read_all(
        self,
        robots: Sequence[Any],
        world: Surroundings,
        rngs: Sequence[np.random.Generator],  # noqa: ARG002
    ) -> NDArray[Any]:
        """Return the perfect readings of robots that carry such a sensor, one each."""
        mine = [robot.index for robot in robots]
        return self.scan(self.placed(world.pose.take(mine, axis=1)), mine, world)
