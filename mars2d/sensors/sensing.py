"""Sensors at work: when each measures, and when its reading arrives under ``robot.sense``."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from copy import deepcopy
from types import SimpleNamespace
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arrays import sealed
from mars2d.core.errors import LawError, UnknownNameError, nearest, shown
from mars2d.core.interfaces import RobotLike
from mars2d.core.usercode import called
from mars2d.sensors.base import Sensor
from mars2d.sensors.surroundings import Surroundings


class Sense(SimpleNamespace):
    """The readings of one robot's sensors now, as attributes: ``robot.sense.proximity``."""

    __slots__ = ("_names", "_robot")

    def __init__(self, robot: str) -> None:
        super().__init__()
        self._robot = robot
        self._names: list[str] = []  # of all sensors

    def __deepcopy__(self, memo: dict[int, Any]) -> Sense:
        copied = memo[id(self)] = Sense(self._robot)
        memo[id(vars(self))] = vars(copied)  # in which devices write
        copied._names = [*self._names]
        vars(copied).update({name: deepcopy(value, memo) for name, value in vars(self).items()})
        return copied

    def __getattr__(self, name: str) -> NoReturn:
        if name in self._names:
            raise UnknownNameError(
                f"sensor {name!r} has no reading now: at each control step sensors are read after "
                "the add-ons' on_step and before their on_sensed; between steps World.observe() "
                "reads them"
            )
        known = nearest(name, self._names) if self._names else "; it carries none"
        raise UnknownNameError(f"{self._robot} has no sensor {name!r}{known}")

    def __getitem__(self, name: Any) -> NoReturn:
        raise LawError(f"robot.sense[{shown(name)}]: write robot.sense.{name}")

    def __call__(self, *names: Any) -> NoReturn:
        """Raise LawError: readings are attributes."""
        name = names[0] if names else "NAME"
        raise LawError(f"robot.sense({shown(name)}): write robot.sense.{name}")


class Device:
    """One sensor on one robot.

    reading: the one that is recorded and drawn at this control step; None if none was measured.
    readings: those that the robot's law finds now, by the sensors' names.
    """

    def __init__(
        self,
        sensor: Sensor,
        robot: RobotLike,
        world: Surroundings,
        stream: Callable[[str], np.random.Generator],
    ) -> None:
        """Take the sensor, its robot and surroundings; stream: makes a random stream of a name."""
        self.described = sensor
        self.period = sensor.period(world.sampling_time)
        self.sensor = sensor.live(_interval=self.period * world.sampling_time)
        self.key, self.robot = sensor.key, robot.index
        self.reading: Any = None
        self._shown: Any = None  # the value that a law finds
        self.view, self.world = robot, world
        self.rng = stream(f"sensor {robot.name} {sensor.key}")
        sense: Sense = robot.sense
        sense._names.append(self.key)
        self.readings = vars(sense)
        self.age = sensor.age(world.sampling_time)
        self._on_its_way: deque[tuple[int, Any]] = deque()
        self.follows = type(sensor).on_step is not Sensor.on_step
        self._shows_more = type(sensor).shown is not Sensor.shown
        self._robot_name = str(robot.name)
        self.reading_it = called(f"sensor {self.key!r}", self.sensor.read, self._robot_name)
        with called(f"sensor {self.key!r}", self.sensor.on_start, self._robot_name):
            self.sensor.on_start(robot, world, self.rng)

    def follow(self) -> None:
        """Call the sensor's `on_step`."""
        with called(f"sensor {self.key!r}", self.sensor.on_step, self._robot_name):
            self.sensor.on_step(self.view, self.world, self.rng)

    def send(self, measured: Any, iteration: int) -> None:
        """Send a measurement of this control step on its way, and show the latest reading."""
        if self.age == 0:
            self._take(measured)
            return
        if self.reading is None:
            with self.reading_it:
                self._take(self.sensor.lost(measured))
        self._on_its_way.append((iteration + self.age, measured))
        self.show(iteration)

    def show(self, iteration: int) -> None:
        """Show the latest reading that has arrived by this control step."""
        if self._on_its_way and self._on_its_way[0][0] <= iteration:
            self._take(self._on_its_way.popleft()[1])
        else:
            self.readings[self.key] = self._shown

    def _take(self, reading: Any) -> None:
        """Keep a reading as the latest one, and show it."""
        self.reading = self._shown = reading
        if self._shows_more:
            with called(f"sensor {self.key!r}", self.sensor.shown, self._robot_name):
                self._shown = self.sensor.shown(reading)
        self.readings[self.key] = self._shown


class _Team:
    """Devices with equal sensors, which are read together, or a single one.

    readings: those that are recorded at this control step as one array, or None.
    """

    def __init__(self, devices: list[Device]) -> None:
        """Take the devices, in the order of their robots."""
        self.devices = devices
        self._first = devices[0]
        self._robots = [device.view for device in devices]
        self._rngs = [device.rng for device in devices]
        self.readings: NDArray[Any] | None = None

    def step(self, iteration: int) -> None:
        """Measure, if it is time, and show the latest reading that has arrived."""
        if iteration % self._first.period == 0:
            for device, measured in zip(self.devices, self._measured(), strict=True):
                device.send(measured, iteration)
        else:
            for device in self.devices:
                device.show(iteration)

    def _measured(self) -> Sequence[Any]:
        first = self._first
        found: Sequence[Any] | NDArray[Any]
        try:
            if len(self.devices) == 1:  # its class may have only `read` of its own
                found = [first.sensor.read(first.view, first.world, first.rng)]
            else:
                found = first.sensor.read_all(self._robots, first.world, self._rngs)
            measured = first.sensor.measured_all(found, self._rngs)
            if not isinstance(measured, np.ndarray):
                return [_kept(reading) for reading in measured]
        except BaseException as error:
            first.reading_it.blame(error)
            raise
        block = sealed(np.array(measured))
        self.readings = block if first.age == 0 else None
        return block.tolist() if block.ndim == 1 else [*block]  # numbers are Python's own


class Sensing:
    """All devices of a world; equal ones are read together.

    devices: robot by robot.
    """

    def __init__(self, devices: Sequence[Device]) -> None:
        """Take all devices, robot by robot."""
        self.devices = devices
        self._following = [device for device in devices if device.follows]
        groups = _grouped(devices)
        self._parts = [_Team(group) for group in groups]
        self._recorded: dict[str, list[Device]] = {}
        for device in devices:
            if device.sensor.recorded:
                self._recorded.setdefault(device.key, []).append(device)
        self._whole = {
            part.devices[0].key: part
            for part in self._parts
            if part.devices == self._recorded.get(part.devices[0].key)
        }

    def hide(self) -> None:
        """Remove the readings of the last control step, so that nobody takes them for new ones."""
        for device in self.devices:
            device.readings.pop(device.key, None)

    def step(self, iteration: int) -> None:
        """Call each `on_step`, then read all sensors that are due and show readings that arrive."""
        for device in self._following:
            device.follow()
        for part in self._parts:
            part.step(iteration)

    def recorded(self) -> dict[str, Sequence[Any] | NDArray[Any]]:
        """Return the readings to be recorded, robot by robot, by the sensors' names."""
        readings: dict[str, Sequence[Any] | NDArray[Any]] = {}
        for key, devices in self._recorded.items():
            block = self._whole[key].readings if key in self._whole else None
            readings[key] = [device.reading for device in devices] if block is None else block
        return readings


def _grouped(devices: Sequence[Device]) -> list[list[Device]]:
    """Return groups of devices that are read together, in the order of their first ones."""
    groups: dict[Device | Sensor, list[Device]] = {}
    for device in devices:
        groups.setdefault(device.described if _may_join(device) else device, []).append(device)
    return list(groups.values())


def _may_join(device: Device) -> bool:
    """Return whether a device is read together with those whose sensors are equal."""
    if not {"read_all", "scan"} & vars(type(device.sensor)).keys():
        return False
    try:
        hash(device.described)
    except TypeError:  # it has a field that can't be hashed, such as a list
        return False
    return True


def _kept(reading: Any) -> Any:
    """Return a reading as an array that can't be written, if it is one at all."""
    if not isinstance(reading, (np.ndarray, list, tuple)):
        return reading
    try:
        kept: NDArray[Any] = np.array(reading)
    except ValueError:  # rows of different lengths: the recorder refuses it
        return reading
    return sealed(kept)
