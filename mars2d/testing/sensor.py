"""Check a sensor: its arguments, readings, seeds, purity and drawing."""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
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
from mars2d.core.usercode import called
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.base import Sensor
from mars2d.testing.finding import Finding, judge
from mars2d.testing.subject import ControlLaw, Placed, Subject, own_methods, with_methods
from mars2d.testing.trial import changed, contents, shepherd, small_world, untouchable
from mars2d.world.world import World


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
    control: ControlLaw | None = None,
    deadline: Deadline | None = None,
) -> tuple[Finding, ...]:
    """Return the findings of `check_sensor`, including hints.

    control: the law of the scenario's team. deadline: the limit of each control step.
    """
    checks.instance(Sensor, "Proximity(range=1)")("check_sensor(sensor)", sensor)
    subject = _Subject(sensor)
    if type(sensor).read is Sensor.read:
        subject.report.wrong(
            f"{subject.name} has no method read: write read(self, robot, world, rng), which "
            "returns the perfect reading"
        )
    elif subject.check_methods(sensor, Sensor) and subject.check_fields(sensor, Sensor):
        with deadline or Deadline() as limit:
            place = partial(subject.placed, scenario, control)
            done = subject.first_run(place, limit, subject.draw, small=scenario is None)
            if done is not None:
                subject.check_repeatable(*done, (f"sensor {sensor.key} ",))
                subject.conclude()
    return subject.report.findings


class _Subject(Subject):
    """The sensor on trial, and the observations so far."""

    def __init__(self, sensor: Sensor) -> None:
        self.sensor, self.kind = sensor, type(sensor)
        stream, label = "rng, the sensor's own stream", f"sensor {sensor.key!r}"
        super().__init__(self.kind.__name__, stream, label=label)
        self._drawn = 0
        self._unstable = False

    def placed(self, scenario: Scenario | None, control: ControlLaw | None) -> Placed:
        """Return the scenario for the trial, and the law of its team."""
        key, witness = self.sensor.key, self._witness()
        if scenario is None:
            rate = self.sensor.rate
            tick = 0.1 if rate is None else 1 / (rate * max(1, round(10 / rate)))
            return small_world([witness], sampling_time=tick), shepherd
        carried = any(self.sensor in robot.sensors for robot in scenario.robots)
        robots = [
            robot.replace(sensors=[*(s for s in robot.sensors if s.key != key), witness])
            if self.sensor in robot.sensors or not carried
            else robot
            for robot in scenario.robots
        ]
        return scenario.replace(robots=robots), control

    def _witness(self) -> Sensor:
        """Return the sensor with methods that check what they do."""

        def read(live: Sensor, robot: Any, world: Any, rng: np.random.Generator) -> Any:
            if self.tried:
                return self.kind.read(live, robot, world, rng)
            before, stream = untouchable(robot.world), copy.deepcopy(rng)
            with self.calling(f"{self.name}.read"):
                reading = self.kind.read(live, robot, world, rng)
            self._unchanged("read", before, robot.world)
            self._acceptable(reading)
            try:
                twin = copy.deepcopy(live)
            except Exception:  # whatever a user's object raises
                return reading
            again = self.kind.read(twin, robot, world, stream)
            self._unstable |= contents(again) != contents(reading)
            return reading

        def follow(method: str) -> Callable[..., None]:
            def following(live: Sensor, robot: Any, world: Any, rng: np.random.Generator) -> None:
                before = untouchable(robot.world)
                with self.calling(f"{self.name}.{method}"):
                    getattr(self.kind, method)(live, robot, world, rng)
                self._unchanged(method, before, robot.world)

            return following

        own = {"on_start", "on_step"}.intersection(own_methods(self.sensor, Sensor))
        methods = {"read": read} | {name: follow(name) for name in own}
        witness = with_methods(self.sensor, methods)
        witness.__dict__["recorded"] = True  # so that it is read even if no law asks
        return witness

    def draw(self, world: World) -> None:
        """Draw as window and figures do, by the frozen sensor of the scenario."""
        if self.kind.draw is Sensor.draw:
            return
        for i, reading in world.frame.readings.get(self.sensor.key, ()):
            if any(isinstance(s, self.kind) for s in world.scenario.robots[i].sensors):
                scene, before = Scene(), untouchable(world)
                where, color = f"{self.name}.draw", world.scenario.colors[i]
                with self.calling(where), called(where, self.kind.draw):
                    self.kind.draw(self.sensor, scene, world.pose[:, i], reading, color)
                self._unchanged("draw", before, world)
                self.check_finite(scene, where)
                self._drawn += len(scene.shapes)

    def _unchanged(self, method: str, before: dict[str, bytes], world: World) -> None:
        what = changed(before, world)
        if what:
            self.report.wrong(
                f"{self.name}.{method} changes {what} (at {world.time:g} s): a sensor only looks. "
                f"{self.keep}, and draw from rng"
            )

    def _acceptable(self, reading: Any) -> None:
        """Report a value that the sensor's quantities can't have; the recorder refuses the rest."""
        try:
            values = np.asarray(reading)
        except ValueError:  # rows of different lengths
            return
        quantities: Sequence[Quantity] = self.kind.quantities
        if values.dtype.kind not in "bifu" or not values.size:
            return
        if len(quantities) > 1 and (not values.ndim or values.shape[-1] != len(quantities)):
            names = ", ".join(quantity.name for quantity in quantities)
            self.report.wrong(
                f"{self.name}.read returned numbers of shape {values.shape}, but {self.name}"
                f".quantities has {len(quantities)} ({names}): the last axis must have one entry "
                "for each"
            )
            return
        for k, quantity in enumerate(quantities):
            column = values if len(quantities) == 1 else values[..., k]
            problem = _out_of_range(column, quantity, getattr(self.sensor, "range", None))
            if problem:
                self.report.wrong(f"{self.name}.read returned {problem}")

    def conclude(self) -> None:
        """Report findings that need the whole run."""
        if self._unstable and not self.shares:
            self.report.wrong(
                f"{self.name}.read gives another reading when it is called twice at the same "
                "instant: how often it is called depends on the rate and on the laws. Changes over "
                "time belong in on_step, which is called once a control step"
            )
        if self.kind.draw is not Sensor.draw and not self._drawn:
            self.report.hint(f"{self.name}.draw drew nothing in the whole trial")


def _out_of_range(values: NDArray[Any], quantity: Quantity, top: Any) -> str:
    """Return an invalid value of a quantity and what is expected, or "" if all are valid."""
    of = f"of {quantity.name}" + (f" [{quantity.unit}]" if quantity.unit else "")
    flags = values.dtype == bool
    if quantity.kind == "flag":
        return "" if flags else f"{shown(values.flat[0].item())} {of}: expected True or False"
    if flags:
        undeclared = quantity.kind == "number"  # of which nothing was said: it is taken for a flag
        wanted = "expected numbers, or quantities = (FLAG,)"
        return "" if undeclared else f"True or False {of}: {wanted}"
    problems = [(np.isinf(values), "a missing value is nan; only a distance is inf")]
    if quantity.kind == "distance":
        problems = [
            (np.isnan(values), "a distance to nothing is inf"),
            (values < 0, "a distance is not negative"),
        ]
        if isinstance(top, float):
            beyond = f"beyond the range, {top:g} {quantity.unit}, a distance is inf"
            problems.append(((values > top) & np.isfinite(values), beyond))
    elif quantity.kind == "angle":
        why = "an angle lies in (-pi, pi]; mars2d.core.plane has wrap"
        problems.append((np.abs(values) > pi, why))
    elif quantity.kind == "color":
        problems.append(((values < 0) | (values > 1), "a colour lies in 0 to 1"))
    found = ((values[bad].flat[0], why) for bad, why in problems if bad.any())
    return next((f"{value:.6g} {of}: {why}" for value, why in found), "")
