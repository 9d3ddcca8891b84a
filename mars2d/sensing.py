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

    __slots__ = ("_due", "_names", "_robot")

    def __init__(self, robot: str) -> None:
        super().__init__()
        self._robot = robot
        self._names: list[str] = []  # of all sensors
        self._due: dict[str, Callable[[], Any]] = {}  # what measures when it is asked for

    def _expect(self, name: str, measure: Callable[[], Any]) -> None:
        """Let a reading be measured when it is asked for."""
        vars(self).pop(name, None)
        self._due[name] = measure

    def __getattr__(self, name: str) -> Any:
        if name not in self._due:
            self._refuse(name)
        vars(self)[name] = self._due[name]()
        del self._due[name]
        return vars(self)[name]

    def __dir__(self) -> list[str]:
        return [*vars(self), *self._due]

    def _refuse(self, name: str) -> NoReturn:
        if name in self._names:
            raise UnknownNameError(
                f"sensor {name!r} has no reading now: at each control step sensors are read after "
                "the add-ons' on_step and before their on_sensed; between steps World.observe() "
                "reads them"
            )
        known = nearest(name, self._names) if self._names else "; it carries none"
        raise UnknownNameError(f"{self._robot} has no sensor {name!r}{known}")


class Device:
    """One sensor on one robot.

    reading: what is recorded and drawn at this control step; None if nothing was measured.
    """

    def __init__(
        self,
        sensor: Sensor,
        robot: RobotView,
        world: Surroundings,
        stream: Callable[[str], np.random.Generator],
    ) -> None:
        """Take the sensor, its robot and world, and what makes a random stream of a name."""
        self.sensor = sensor.live()
        self.key, self.robot = sensor.key, robot.index
        self.reading: Any = None
        self._shown: Any = None  # what a law gets of it
        self._robot, self._world = robot, world
        self._stream, self._name = stream, f"sensor {robot.name} {sensor.key}"
        self._rng = stream(self._name)
        self._sense: Sense = robot.sense
        self._sense._names.append(self.key)
        self._period = sensor.period(world.sampling_time)
        self._age = sensor.age(world.sampling_time)
        self._on_its_way: deque[tuple[int, Any]] = deque()
        self.when_asked = not sensor.recorded and self._period == 1 and self._age == 0
        self.follows = type(sensor).on_step is not Sensor.on_step
        with called(f"sensor {self.key!r}", self.sensor.on_start):
            self.sensor.on_start(robot, world, self._rng)

    def follow(self) -> None:
        """Do what the sensor does at each control step, whether it is read or not."""
        with called(f"sensor {self.key!r}", self.sensor.on_step):
            self.sensor.on_step(self._robot, self._world, self._rng)

    def step(self, iteration: int) -> None:
        """Measure, if it is time, and show what has arrived."""
        if self.when_asked:
            self.reading = None
            self._sense._expect(self.key, lambda: self._measured_when_asked(iteration))
            return
        if self._age > 0:
            self._wait(iteration)
        elif iteration % self._period == 0:
            self._take(self._measured(self._rng))
        vars(self._sense)[self.key] = self._shown

    def hide(self) -> None:
        """Let nobody take the reading of the control step before for that of this one."""
        vars(self._sense).pop(self.key, None)

    def close(self) -> None:
        """Let nothing of this control step be measured any more, since things begin to move."""
        self._sense._due.pop(self.key, None)

    def _wait(self, iteration: int) -> None:
        """Measure, if it is time, for later, and take what arrives now."""
        if iteration % self._period == 0:
            measured = self._measured(self._rng)
            if self.reading is None:
                with called(f"sensor {self.key!r}", self.sensor.read):
                    self._take(self.sensor.lost(measured))
            self._on_its_way.append((iteration + self._age, measured))
        if self._on_its_way and self._on_its_way[0][0] <= iteration:
            self._take(self._on_its_way.popleft()[1])

    def _measured_when_asked(self, iteration: int) -> Any:
        """Measure with random numbers of this control step's own: asking changes nothing later."""
        self._take(self._measured(self._stream(f"{self._name} {iteration}")))
        return self._shown

    def _measured(self, rng: np.random.Generator) -> Any:
        with called(f"sensor {self.key!r}", self.sensor.read):
            reading = self.sensor.read(self._robot, self._world, rng)
            return _kept(self.sensor.measured(reading, rng))

    def _take(self, reading: Any) -> None:
        """Let this be the reading from now on."""
        self.reading = reading
        with called(f"sensor {self.key!r}", self.sensor.shown):
            self._shown = self.sensor.shown(reading)


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
