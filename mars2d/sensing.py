"""Sensors at work: when each measures, when its reading arrives, and what a law finds of it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from mars2d.errors import UnknownNameError, nearest
from mars2d.sensors.base import Sensor, Surroundings
from mars2d.usercode import called

if TYPE_CHECKING:
    from mars2d.views import RobotView

__all__ = ["Device", "Sense"]


class Sense(SimpleNamespace):
    """The readings of one robot's sensors now, as attributes: ``robot.sense.proximity``."""

    def __init__(self) -> None:
        super().__init__(_due={})

    def expect(self, name: str, measure: Callable[[], Any]) -> None:
        """Let a reading be measured when it is asked for."""
        vars(self).pop(name, None)
        self._due[name] = measure

    def __getattr__(self, name: str) -> Any:
        due = vars(self).get("_due", {})
        if name not in due:
            self._refuse(name)
        due.pop(name)()
        return vars(self)[name]

    def _refuse(self, name: str) -> NoReturn:
        known = [key for key in (*vars(self), *self._due) if key != "_due"]
        raise UnknownNameError(f"this robot has no sensor {name!r}{nearest(name, known)}")


class Device:
    """One sensor on one robot.

    reading: what is recorded and drawn at this control step; None if nothing was measured.
    """

    def __init__(
        self, sensor: Sensor, robot: RobotView, world: Surroundings, rng: np.random.Generator
    ) -> None:
        self.sensor = sensor.live()
        self.key, self.robot = sensor.key, robot.index
        self.reading: Any = None
        self._robot, self._world, self._rng = robot, world, rng
        self._sense: Sense = robot.sense
        self._period = sensor.period(world.sampling_time)
        self._age = sensor.age(world.sampling_time)
        self._on_its_way: deque[tuple[int, Any]] = deque()
        self._when_asked = not sensor.recorded and self._period == 1 and self._age == 0
        self._follows = type(sensor).on_step is not Sensor.on_step
        with called(f"sensor {self.key!r}", self.sensor.on_start):
            self.sensor.on_start(robot, world, rng)

    def step(self, iteration: int) -> None:
        """Do what a control step asks for: measure, if it is time, and show what has arrived."""
        if self._follows:
            with called(f"sensor {self.key!r}", self.sensor.on_step):
                self.sensor.on_step(self._robot, self._world, self._rng)
        if self._when_asked:
            self.reading = None
            self._sense.expect(self.key, self._measure_now)
        elif self._age == 0:
            if iteration % self._period == 0:
                self._measure_now()
        else:
            self._wait(iteration)

    def _wait(self, iteration: int) -> None:
        """Measure, if it is time, for later, and take what arrives now."""
        if iteration % self._period == 0:
            measured = self._measured()
            if self.reading is None:
                self._take(self.sensor.lost(measured))
            self._on_its_way.append((iteration + self._age, measured))
        if self._on_its_way and self._on_its_way[0][0] <= iteration:
            self._take(self._on_its_way.popleft()[1])

    def _measure_now(self) -> None:
        self._take(self._measured())

    def _measured(self) -> Any:
        with called(f"sensor {self.key!r}", self.sensor.read):
            reading = self.sensor.read(self._robot, self._world, self._rng)
            return _kept(self.sensor.measured(reading, self._rng))

    def _take(self, reading: Any) -> None:
        """Let this be the reading from now on."""
        self.reading = reading
        with called(f"sensor {self.key!r}", self.sensor.shown):
            vars(self._sense)[self.key] = self.sensor.shown(reading)


def _kept(reading: Any) -> Any:
    """Return a reading as an array that can't be written, if it is one at all."""
    if not isinstance(reading, (np.ndarray, list, tuple)):
        return reading
    try:
        kept: NDArray[Any] = np.array(reading)
    except ValueError:  # rows of different lengths: the recorder refuses it
        return reading
    kept.flags.writeable = False
    return kept
