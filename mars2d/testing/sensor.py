"""Check a sensor: its arguments, readings, seeds, purity and drawing."""

from __future__ import annotations

import copy
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
from mars2d.sensors.sensing import Device
from mars2d.testing.finding import Finding
from mars2d.testing.subject import KEEP, Subject
from mars2d.testing.trial import ControlLaw, Placed, looker, small_world
from mars2d.world.world import World


def check_sensor(
    sensor: Sensor,
    *,
    scenario: Scenario | None = None,
    control: ControlLaw | None = None,
    deadline: Deadline | None = None,
) -> tuple[Finding, ...]:
    """Try a sensor; return hints, and raise CheckError, which lists all that is wrong with it.

    The sensor runs for 50 control steps on the robots of a small world with walls, an obstacle and
    a box, or on those of a `scenario`, whose team has the law `control`. The check reports invalid
    readings, random numbers from shared generators, changes to the world, and readings that differ
    with the same seed. deadline: the limit of each control step.

    >>> from mars2d.sensors import Proximity
    >>> check_sensor(Proximity(range=1.0))
    ()
    """
    checks.instance(Sensor, "Proximity(range=1)")("check_sensor(sensor)", sensor)
    subject = Subject("sensor", sensor, "rng, the sensor's own stream", KEEP)
    if type(sensor).read is Sensor.read:
        subject.wrong(
            f"{subject.name} has no method read: write read(self, robot, world, rng), which "
            "returns the perfect reading"
        )
    elif subject.check_part(sensor, Sensor):
        looks = _Looks(sensor, subject)
        subject.check_runs(
            lambda: _placed(sensor, scenario, control),
            deadline,
            small=scenario is None,
            looker=looker(on_step=looks.read, on_sensed=looks.draw),
            own=(f"sensor {sensor.key} ",),
        )
    return subject.hints()


def _placed(sensor: Sensor, scenario: Scenario | None, control: ControlLaw | None) -> Placed:
    """Return the scenario for the trial, and the law of its team."""
    read = sensor.replace(recorded=True)  # so that it is read even if no law asks
    if scenario is None:
        return small_world([read], sampling_time=1 / (sensor.rate or 10)), None
    carried = any(sensor in robot.sensors for robot in scenario.robots)
    robots = [
        robot.replace(sensors=[*(s for s in robot.sensors if s.key != sensor.key), read])
        if sensor in robot.sensors or not carried
        else robot
        for robot in scenario.robots
    ]
    return scenario.replace(robots=robots), control


class _Looks:
    """Looks at the answers of a sensor's methods during a run."""

    def __init__(self, sensor: Sensor, subject: Subject) -> None:
        self._sensor, self._kind, self._subject = sensor, type(sensor), subject

    def _devices(self, world: World) -> list[Device]:
        devices = world.simulation.sensing.devices
        return [each for each in devices if type(each.described) is self._kind]

    def read(self, world: World) -> None:
        """Call `read` once more, just before the world does, and look at what it returns."""
        with self._subject.looking(self._sensor, "read", world):
            for device in self._devices(world):
                rng = copy.deepcopy(device.rng)
                self._check_reading(device.sensor.read(device.view, device.world, rng))

    def draw(self, world: World) -> None:
        """Draw as window and figures do, by the frozen sensor of the scenario."""
        if self._kind.draw is Sensor.draw:
            return
        scene = Scene()
        with self._subject.looking(self._sensor, "draw", world):
            for each in self._devices(world):
                if each.reading is not None:
                    color = world.scenario.colors[each.robot]
                    self._sensor.draw(scene, world.pose[:, each.robot], each.reading, color)
        self._subject.check_finite(scene, "draw")

    def _check_reading(self, reading: Any) -> None:
        """Report a value that the sensor's quantities can't have; the recorder refuses the rest."""
        try:
            values = np.asarray(reading)
        except ValueError:  # rows of different lengths
            return
        name, quantities = self._subject.name, self._kind.quantities
        if values.dtype.kind not in "bifu" or not values.size:
            return
        if len(quantities) > 1 and (not values.ndim or values.shape[-1] != len(quantities)):
            names = ", ".join(quantity.name for quantity in quantities)
            self._subject.wrong(
                f"{name}.read returned numbers of shape {values.shape}, but {name}.quantities has "
                f"{len(quantities)} ({names}): the last axis must have one entry for each"
            )
            return
        for k, quantity in enumerate(quantities):
            column = values if len(quantities) == 1 else values[..., k]
            problem = _out_of_range(column, quantity, getattr(self._sensor, "range", None))
            if problem:
                self._subject.wrong(f"{name}.read returned {problem}")


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
