"""Check a sensor: its arguments, readings, seeds, purity and drawing."""

from __future__ import annotations

import copy
from functools import partial
from math import inf, pi
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
from mars2d.testing.subject import KEEP, Subject
from mars2d.testing.trial import ControlLaw, Placed, looker, small_world
from mars2d.world.world import World

VALID = {
    "distance": (0.0, inf, "a distance is not negative, and inf to nothing"),
    "angle": (-pi, pi, "an angle lies in (-pi, pi]; mars2d.core.plane has wrap"),
    "color": (0.0, 1.0, "a colour lies in 0 to 1"),
}
"""The least and the largest value of a quantity of each kind, and what it is."""


def check_sensor(
    sensor: Sensor,
    *,
    scenario: Scenario | None = None,
    control: ControlLaw | None = None,
    deadline: Deadline | None = None,
) -> None:
    """Try a sensor; raise CheckError, which lists all that is wrong with it.

    The sensor runs for 50 control steps on the robots of a small world with walls, an obstacle and
    a box, or on those of a `scenario`, whose team has the law `control`. The check reports invalid
    readings, random numbers from shared generators, and readings that differ with the same seed.
    deadline: the limit of each control step.

    >>> from mars2d.sensors import Proximity
    >>> check_sensor(Proximity(range=1.0))
    """
    checks.instance(Sensor, "Proximity(range=1)")("check_sensor(sensor)", sensor)
    subject = Subject("sensor", sensor, "rng, the sensor's own stream", KEEP)
    if type(sensor).read is Sensor.read:
        subject.wrong(
            f"{subject.name} has no method read: write read(self, robot, world, rng), which "
            "returns the perfect reading"
        )
    elif subject.check_part(sensor, Sensor):
        subject.check_runs(
            lambda: _placed(sensor, scenario, control),
            deadline,
            small=scenario is None,
            looker=looker("on_step", partial(_look, sensor, subject)),
            own=(f"sensor {sensor.key} ",),
        )
    subject.conclude()


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


def _look(sensor: Sensor, subject: Subject, world: World) -> None:
    """Call `read` just before the world does, and draw as figures do, by the frozen sensor."""
    devices = [d for d in world.simulation.sensing.devices if type(d.described) is type(sensor)]
    for device in devices:
        with called(f"{subject.name}.read", sensor.read):
            reading = device.sensor.read(device.view, device.world, copy.deepcopy(device.rng))
        _check_reading(sensor, subject, reading)
        i, reading = device.robot, device.reading
        if reading is not None:
            with called(f"{subject.name}.draw", sensor.draw):
                sensor.draw(Scene(), world.pose[:, i], reading, world.scenario.colors[i])


def _check_reading(sensor: Sensor, subject: Subject, reading: Any) -> None:
    """Report a value that the sensor's quantities can't have; the recorder refuses the rest."""
    try:
        values = np.asarray(reading)
    except ValueError:  # rows of different lengths
        return
    name, quantities = subject.name, sensor.quantities
    if values.dtype.kind not in "bifu" or not values.size:
        return
    if len(quantities) > 1 and (not values.ndim or values.shape[-1] != len(quantities)):
        names = ", ".join(quantity.name for quantity in quantities)
        subject.wrong(
            f"{name}.read returned numbers of shape {values.shape}, but {name}.quantities has "
            f"{len(quantities)} ({names}): the last axis must have one entry for each"
        )
        return
    for k, quantity in enumerate(quantities):
        column = values if len(quantities) == 1 else values[..., k]
        problem = _out_of_range(column, quantity, getattr(sensor, "range", None))
        if problem:
            subject.wrong(f"{name}.read returned {problem}")


def _out_of_range(values: NDArray[Any], quantity: Quantity, top: Any) -> str:
    """Return an invalid value of a quantity and what is expected, or "" if all are valid.

    top: the range of the sensor, metres, if it has one.
    """
    kind, of = quantity.kind, f"of {quantity.name}" + f" [{quantity.unit}]" * bool(quantity.unit)
    if kind != "number" and (values.dtype == bool) != (kind == "flag"):
        expected = "True or False" if kind == "flag" else "numbers, or quantities = (FLAG,)"
        return f"{shown(values.flat[0].item())} {of}: expected {expected}"
    low, high, why = VALID.get(kind, (-inf, inf, "a missing value is nan; only a distance is inf"))
    if kind == "distance" and isinstance(top, float):
        high, why = top, f"{why}, or beyond the range, {top:g} {quantity.unit}"
    missing = np.isinf(values) if kind == "distance" else np.isnan(values)
    bad = values[~missing & ~(np.isfinite(values) & (values >= low) & (values <= high))]
    return f"{bad.flat[0]:.6g} {of}: {why}" if bad.size else ""
