"""Check a sensor: its arguments, readings, seeds, purity and drawing."""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core import checks
from mars2d.core.deadline import Deadline
from mars2d.core.errors import shown
from mars2d.core.quantity import Quantity
from mars2d.core.scene import Scene
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.base import Sensor
from mars2d.testing.common import (
    KEEP,
    check_fields,
    check_finite,
    check_methods,
    check_places,
    check_repeatable,
    first_run,
    is_own,
    with_methods,
)
from mars2d.testing.finding import Finding, Noted, Notes, Report, at, judge
from mars2d.testing.state import Places, fingerprint
from mars2d.testing.trial import Run, Trial, changes, difference, prints, shepherd, small_world
from mars2d.world.world import World

METHODS = {
    "read": ("robot", "world", "rng"),
    "on_start": ("robot", "world", "rng"),
    "on_step": ("robot", "world", "rng"),
    "shown": ("reading",),
    "draw": ("scene", "pose", "reading", "color"),
}
"""The methods that a sensor can define, with their arguments."""


def check_sensor(sensor: Sensor, *, scenario: Scenario | None = None) -> None:
    """Try a sensor, and raise CheckError, which lists everything that is wrong with it.

    The sensor runs for 50 control steps on the robots of a small world with walls, an obstacle and
    a box, or on those of a `scenario`. The check reports invalid readings, random numbers from
    shared generators, changes to the world, and readings that differ with the same seed.

    >>> from mars2d.sensors import Proximity
    >>> check_sensor(Proximity(range=1.0))
    """
    judge(f"sensor {type(sensor).__name__}", sensor_findings(sensor, scenario=scenario))


def sensor_findings(
    sensor: Sensor,
    *,
    scenario: Scenario | None = None,
    control: Callable[[Any], Any] | None = None,
    deadline: Deadline | None = None,
) -> tuple[Finding, ...]:
    """Return the findings of `check_sensor`, including hints.

    control: the law of the scenario's team. deadline: the limit of each control step.
    """
    checks.instance(Sensor, "Proximity(range=1)")("check_sensor(sensor)", sensor)
    subject = _Subject(sensor)
    places = Places(type(sensor))
    copies = check_fields(sensor, Sensor, subject.notes)
    if subject.can_be_called() and copies:
        with deadline or Deadline() as limit:
            done = first_run(subject.placed, scenario, control, subject.draw, limit, subject.notes)
            if done is not None:
                check_repeatable(*done, places, subject.notes, (f"sensor {sensor.key} ",))
                subject.check_mount(*done)
                subject.conclude()
    check_places(places, subject.notes)
    return subject.report.findings


class _Subject:
    """The sensor on trial, and the observations so far."""

    def __init__(self, sensor: Sensor) -> None:
        self.sensor, self.kind = sensor, type(sensor)
        self.report = Report()
        self.notes = Notes(self.kind.__name__, self.report, "rng, the sensor's own stream", KEEP)
        self._first: tuple[tuple[int, ...], str] | None = None  # shape and kind of its readings
        self._drawn = 0
        self._unstable: set[str] = set()

    def can_be_called(self) -> bool:
        """Report methods that are missing or can't be called; return whether it can be tried."""
        name = self.notes.name
        if not is_own(self.sensor, "read", Sensor):
            self.report.wrong(
                f"{name} has no method read: write read(self, robot, world, rng), which returns "
                "the perfect reading"
            )
            return False
        return check_methods(self.sensor, Sensor, METHODS, self.notes)

    def placed(
        self, scenario: Scenario | None, control: Callable[[Any], Any] | None
    ) -> tuple[Scenario, Callable[[Any], Any] | None]:
        """Return the scenario for the trial, and the law of its team."""
        witness = self._witness(self.sensor)
        if scenario is None:
            tick = 0.1 if self.sensor.rate is None else _tick(self.sensor.rate)
            return small_world([witness], sampling_time=tick), shepherd
        carried = any(self.sensor in robot.sensors for robot in scenario.robots)
        robots = [
            robot.replace(sensors=_exchanged(robot.sensors, self.sensor.key, witness))
            if self.sensor in robot.sensors or not carried
            else robot
            for robot in scenario.robots
        ]
        return scenario.replace(robots=robots), control

    def _witness(self, sensor: Sensor) -> Sensor:
        """Return the sensor with methods that report to this object."""
        methods: dict[str, Callable[..., Any]] = {
            "read": self.read,
            "on_start": partial(self.follow, "on_start"),
            "on_step": partial(self.follow, "on_step"),
            "shown": self.show,
        }
        own = {name: method for name, method in methods.items() if is_own(sensor, name, Sensor)}
        witness = with_methods(sensor, own)
        witness.__dict__["recorded"] = True  # so that it is read even if no law asks
        return witness

    # -- called by the witness ------------------------------------------------------------------

    def read(self, live: Sensor, robot: Any, world: Any, rng: np.random.Generator) -> Any:
        """Read, and check the reading, its side effects and its repeatability."""
        state, before = rng.bit_generator.state, prints(robot.world)
        untouched = _copy_of(live)
        with self.notes.calling("read", self.kind.read, world.time, robot.name):
            reading = self.kind.read(live, robot, world, rng)
        self._unchanged("read", before, robot.world)
        self._acceptable(reading, robot.name, world.time)
        now = _copy_of(live)
        if untouched is not None and now is not None:
            with self.notes.calling("read", self.kind.read, world.time, robot.name):
                if not _alike(self.kind.read(now, robot, world, _generator(state)), reading):
                    third = self.kind.read(untouched, robot, world, _generator(state))
                    self._unstable.add("counts" if _alike(third, reading) else "wavers")
        return reading

    def follow(
        self, method: str, live: Sensor, robot: Any, world: Any, rng: np.random.Generator
    ) -> None:
        """Call on_start or on_step, and check that the world is unchanged."""
        before, function = prints(robot.world), getattr(self.kind, method)
        with self.notes.calling(method, function, world.time, robot.name):
            function(live, robot, world, rng)
        self._unchanged(method, before, robot.world)

    def show(self, live: Sensor, reading: Any) -> Any:
        """Convert a reading to the form that laws get."""
        with self.notes.calling("shown", self.kind.shown, None):
            return self.kind.shown(live, reading)

    def draw(self, world: World) -> None:
        """Draw as window and figures do, by the frozen sensor of the scenario."""
        if not is_own(self.sensor, "draw", Sensor):
            return
        for i, reading in world.frame.readings.get(self.sensor.key, ()):
            if not any(isinstance(s, self.kind) for s in world.scenario.robots[i].sensors):
                continue  # another one of the same name
            scene, before, color = Scene(), prints(world), world.scenario.colors[i]
            with self.notes.calling("draw", self.kind.draw, world.time):
                self.kind.draw(self.sensor, scene, world.pose[:, i], reading, color)
            self._unchanged("draw", before, world)
            check_finite(scene, f"{self.notes.name}.draw", at(world.time), self.report)
            self._drawn += len(scene.shapes)

    def _unchanged(self, method: str, before: dict[str, str], world: World) -> None:
        changed = changes(before, world)
        if changed:
            self.report.wrong(
                f"{self.notes.name}.{method} changes {changed}{at(world.time)}: a sensor only "
                f"looks. {KEEP}, and draw from rng"
            )

    def _acceptable(self, reading: Any, robot: str, time: float) -> None:
        """Report an invalid reading; one that can't be recorded ends the run."""
        name, expected = f"{self.notes.name}.read", "a number, True or False, or an array of them"
        if reading is None:
            self._refuse(f"{name} returned nothing{at(time)}: expected {expected}; no `return`?")
        values = _as_array(reading)
        if values.dtype.kind not in "bifu":
            self._refuse(f"{name} returned {shown(reading)}{at(time)}: expected {expected}")
        kind = "True or False" if values.dtype == bool else "numbers"
        if self._first is None:
            self._first = values.shape, kind
        elif self._first != (values.shape, kind):
            self._refuse(
                f"{name} returned {_described(values.shape, kind)} on {robot}{at(time)}, and "
                f"{_described(*self._first)} before: shape and kind must stay the same, over time "
                "and on all robots; a missing value is inf for a distance, False for a flag, "
                "otherwise nan"
            )
        quantities = self.kind.quantities
        if len(quantities) > 1 and (not values.ndim or values.shape[-1] != len(quantities)):
            names = ", ".join(quantity.name for quantity in quantities)
            self._refuse(
                f"{name} returned {_described(values.shape, kind)}{at(time)}, but {self.notes.name}"
                f".quantities has {len(quantities)} ({names}): the last axis must have one entry "
                "for each"
            )
        for k, quantity in enumerate(quantities):
            column = values if len(quantities) == 1 else values[..., k]
            problem = _out_of_range(column, quantity, getattr(self.sensor, "range", None))
            if problem:
                found, why = problem
                self.report.wrong(f"{name} returned {found}{at(time)}: {why}")

    def _refuse(self, text: str) -> None:
        self.report.wrong(text)
        raise Noted(text)

    # -- after the runs -------------------------------------------------------------------------

    def check_mount(self, trial: Trial, first: Run) -> None:
        """Hint at a mount that makes no difference to the readings."""
        if self.sensor.mount == (0.0, 0.0, 0.0):
            return
        ahead = self._witness(self.sensor.replace(mount=(0, 0, 0)))
        robots = [
            robot.replace(sensors=_exchanged(robot.sensors, self.sensor.key, ahead, add=False))
            for robot in trial.scenario.robots
        ]
        scenario = trial.scenario.replace(robots=robots)
        run = replace(trial.shortened(first), scenario=scenario, looked=None).run()
        if not run.failed and difference(first, run, scenario.sampling_time) is None:
            self.report.hint(
                f"{self.notes.name} reads the same with mount={self.sensor.mount} and without: "
                "measure from self.placed(robot.pose), which is where the sensor is"
            )

    def conclude(self) -> None:
        """Report findings that need all runs."""
        if "counts" in self._unstable:
            self.report.wrong(
                f"{self.notes.name}.read gives another reading when it is called twice at the same "
                "instant: how often it is called depends on the rate and on the laws. Changes over "
                "time belong in on_step, which is called once a control step"
            )
        elif "wavers" in self._unstable and self.report.sound:
            self.report.wrong(
                f"{self.notes.name}.read gives different readings for the same robot, world and "
                "rng. Is there a clock, or a generator without a seed?"
            )
        if is_own(self.sensor, "draw", Sensor) and not self._drawn:
            self.report.hint(f"{self.notes.name}.draw drew nothing in the whole trial")


def _exchanged(
    sensors: Sequence[Sensor], key: str, sensor: Sensor, *, add: bool = True
) -> list[Sensor]:
    """Return a robot's sensors with one replaced by name, or else added."""
    if any(each.key == key for each in sensors):
        return [sensor if each.key == key else each for each in sensors]
    return [*sensors, sensor] if add else [*sensors]


def _tick(rate: float) -> float:
    """Return a sampling time of about 0.1 s that divides a sensor's period."""
    return 1 / (rate * max(1, round(10 / rate)))


def _copy_of(live: Sensor) -> Sensor | None:
    """Return a copy, or None if its attributes can't be copied."""
    try:
        return copy.deepcopy(live)
    except Exception:  # whatever a user's object raises
        return None


def _generator(state: Any) -> np.random.Generator:
    """Return a random generator in a given state."""
    generator = np.random.Generator(np.random.PCG64(0))
    generator.bit_generator.state = state
    return generator


def _alike(one: Any, other: Any) -> bool:
    return fingerprint(one) == fingerprint(other)


def _as_array(reading: Any) -> NDArray[Any]:
    try:
        return np.asarray(reading)
    except (TypeError, ValueError):  # rows of different lengths
        return np.empty(0, dtype=object)


def _described(shape: tuple[int, ...], kind: str) -> str:
    one = {"numbers": "a number"}.get(kind, kind)
    return f"{kind} of shape {shape}" if shape else one


def _out_of_range(values: NDArray[Any], quantity: Quantity, top: Any) -> tuple[str, str] | None:
    """Return (invalid value of a quantity, expected value), or None if all are valid."""
    of = f"of {quantity.name}" + (f" [{quantity.unit}]" if quantity.unit else "")
    flags = values.dtype == bool
    if quantity.kind == "flag":
        return None if flags else (f"{shown(_one(values))} {of}", "expected True or False")
    if flags:
        only = quantity.kind == "number"  # of which nothing was said: it is taken for a flag
        return (
            None if only else (f"True or False {of}", "expected numbers, or quantities = (FLAG,)")
        )
    bad, why = np.isinf(values), "a missing value is nan; only a distance is inf"
    if quantity.kind == "distance":
        bad, why = np.isnan(values), "a distance to nothing is inf"
        if not bad.any():
            bad, why = values < 0, "a distance is not negative"
        if not bad.any() and isinstance(top, float):
            bad = (values > top) & np.isfinite(values)
            why = f"beyond the range, {top:g} {quantity.unit}, a distance is inf"
    elif quantity.kind == "angle" and not bad.any():
        bad, why = np.abs(values) > pi, "an angle lies in (-pi, pi]; mars2d.core.plane has wrap"
    elif quantity.kind == "color" and not bad.any():
        bad, why = (values < 0) | (values > 1), "a colour lies in 0 to 1"
    return (f"{values[bad].flat[0]:.6g} {of}", why) if bad.any() else None


def _one(values: NDArray[Any]) -> Any:
    return values.flat[0].item() if values.size else values
