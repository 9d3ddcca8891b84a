"""Control laws: what a law may see, how it is called, and what it may return."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from mars2d.errors import LawError, UnknownNameError, nearest, shown
from mars2d.usercode import called, definition

if TYPE_CHECKING:
    from mars2d.world import World

__all__ = ["Law", "Mind", "Neighbour", "PropView", "RobotView", "Sense", "SensorsOnlyView"]

Float = NDArray[np.float64]

LARGEST = 1e300
"""No entry of a command is larger, in whatever unit: what drives make of it stays a float."""

BOUNDED = "a command must be finite"


class Sense(SimpleNamespace):
    """The readings of one robot's sensors now, as attributes: ``robot.sense.proximity``."""

    def __getattr__(self, name: str) -> NoReturn:
        raise UnknownNameError(f"this robot has no sensor {name!r}{nearest(name, vars(self))}")


class Mind:
    """What a robot keeps for itself: its readings, its memory between steps, its random stream."""

    def __init__(self, world: World, name: str) -> None:
        self.sense = Sense()
        self.memory = SimpleNamespace()
        self._world, self._name = world, name

    @cached_property
    def rng(self) -> np.random.Generator:
        """The robot's own random stream."""
        return self._world.stream(f"robot {self._name}")


class Neighbour:
    """Another robot, as far as it is seen: its index, name and pose (3,)."""

    def __init__(self, world: World, index: int) -> None:
        self._world = world
        self.index = index

    @property
    def name(self) -> str:
        """The other robot's name."""
        return str(self._world.scenario.robots[self.index].name)

    @property
    def pose(self) -> Float:
        """The other robot's pose (3,): x, y [m], theta [rad]."""
        return self._world.pose[:, self.index]


class PropView:
    """A prop as laws and add-ons see it: its index in ``scenario.props``, name, pose, velocity."""

    def __init__(self, world: World, index: int) -> None:
        self._world = world
        self.index = index

    def __getattr__(self, name: str) -> NoReturn:
        known = [item for item in dir(type(self)) if not item.startswith("_")]
        raise UnknownNameError(f"a prop has no {name!r}{nearest(name, [*known, 'index'])}")

    @property
    def name(self) -> str:
        """The prop's name."""
        return str(self._world.scenario.props[self.index].name)

    @property
    def pose(self) -> Float:
        """The pose (3,) of its centre of mass: x, y [m], theta [rad, not wrapped]."""
        return self._world.prop_pose[:, self.index]

    @property
    def velocity(self) -> Float:
        """Its velocity (3,): x', y' [m/s], theta' [rad/s]."""
        return self._world.prop_velocity[:, self.index]


class RobotView:
    """What the law of one robot may see and use, with full information.

    index: its column in poses and commands. sense: the readings of its sensors. memory: a place to
    keep things between steps. rng: its own random stream.
    """

    def __init__(self, world: World, index: int, mind: Mind) -> None:
        self._world = world
        self._mind = mind
        self.index = index
        self.sense = mind.sense
        self.memory = mind.memory
        self._neighbours: tuple[Neighbour, ...] | None = None

    def __getattr__(self, name: str) -> NoReturn:
        known = [item for item in dir(type(self)) if not item.startswith("_")]
        raise UnknownNameError(
            f"a robot has no {name!r}{nearest(name, [*known, 'index', 'sense', 'memory'])}"
        )

    @property
    def name(self) -> str:
        """The robot's name."""
        return str(self._world.scenario.robots[self.index].name)

    @property
    def time(self) -> float:
        """The simulated time, seconds."""
        return self._world.time

    @property
    def pose(self) -> Float:
        """The robot's own pose (3,): x, y [m], theta [rad, not wrapped]."""
        return self._world.pose[:, self.index]

    @property
    def velocity(self) -> Float:
        """The robot's own velocity (3,): x', y' [m/s], theta' [rad/s]."""
        return self._world.velocity[:, self.index]

    @property
    def effort(self) -> float:
        """The largest share of its bounds that its drive used in the last step, 0 to 1: slip."""
        return float(self._world.effort[self.index])

    @property
    def command(self) -> Float:
        """The last command (2,) that was issued, after saturation; zeros at first."""
        return self._world.command[:, self.index]

    @property
    def neighbours(self) -> tuple[Neighbour, ...]:
        """The other robots."""
        if self._neighbours is None:
            others = (i for i in range(len(self._world.scenario.robots)) if i != self.index)
            self._neighbours = tuple(Neighbour(self._world, i) for i in others)
        return self._neighbours

    @property
    def contacts(self) -> NDArray[np.void]:
        """The contacts of this robot since the last step: rows as in ``record.contacts``.

        Normals and tangential impulses are those on b, which may be this robot or the other body.
        """
        rows = self._world.contacts
        return np.asarray(rows[(rows["a"] == self.index) | (rows["b"] == self.index)])

    @property
    def rng(self) -> np.random.Generator:
        """The robot's own random stream."""
        return self._mind.rng


class SensorsOnlyView(RobotView):
    """What a law may use that sees sensors only: no pose, no other robots, no points of contact."""

    @property
    def pose(self) -> Float:
        """Refuse: a pose is not sensed."""
        raise LawError("this law sees sensors only: robot.pose is not available")

    @property
    def velocity(self) -> Float:
        """Refuse: a velocity is not sensed."""
        raise LawError("this law sees sensors only: robot.velocity is not available")

    @property
    def neighbours(self) -> tuple[Neighbour, ...]:
        """Refuse: neighbours are not sensed."""
        raise LawError("this law sees sensors only: robot.neighbours is not available")

    @property
    def contacts(self) -> NDArray[np.void]:
        """Refuse: where a contact is would tell the pose."""
        raise LawError("this law sees sensors only: robot.contacts is not available")


class Law:
    """A control law: a function, or a generator that yields commands and keeps its own memory.

    A generator is started at the first step. When it returns, its robots stand still.
    """

    def __init__(
        self, function: Callable[[Any], Any], subject: World | RobotView, still: Any = (0.0, 0.0)
    ) -> None:
        """Take the user's function, what it is called with, and the command to stand still."""
        self._function = function
        self._subject = subject
        self._still = still
        self._running: Iterator[Any] | None = None
        self.name = getattr(function, "__name__", type(function).__name__)

    def command(self) -> Any:
        """Return what the law commands now, unchecked. Raises LawError where the law raises."""
        with called(self.name, self._function):
            if self._running is None:
                result = self._function(self._subject)
                if not inspect.isgenerator(result):
                    return result
                self._running = result
            return next(self._running, self._still)

    def refuse(self, message: str) -> NoReturn:
        """Raise the error that the law's command can't be used; it points at the law."""
        error = LawError(f"{self.name} {message}")
        error.where = definition(self._function)
        raise error


def robot_command(law: Law, value: Any) -> tuple[float, float]:
    """Check the command of one robot: two finite numbers."""
    if value is None:
        law.refuse("returned nothing: a law returns its command, as `return v, omega`")
    command = _numbers(value)
    if command is None or command.shape not in ((2,), (2, 1)):
        law.refuse(f"returned {shown(value)}: expected two numbers, as (v, omega) or (vx, vy)")
    first, second = command.ravel().tolist()
    if not (abs(first) <= LARGEST and abs(second) <= LARGEST):  # neither for NaN
        law.refuse(f"returned {shown((first, second))}: {BOUNDED}")
    return first, second


def team_command(value: Any, robots: int, refuse: Callable[[str], NoReturn]) -> Float:
    """Check the command of all robots: a finite array (2, n); for one robot also (2,)."""
    if value is None:
        refuse("returned nothing: a law returns its command, an array (2, n)")
    expected = f"expected two rows and a column for each robot, shape (2, {robots})"
    command = _numbers(value)
    if command is None:
        refuse(f"returned {shown(value)}: {expected}")
    if command.shape == (2,) and robots == 1:
        command = command.reshape(2, 1)
    if command.shape != (2, robots):
        turned = "; transpose it" if command.shape == (robots, 2) else ""
        refuse(f"returned an array of shape {command.shape}: {expected}{turned}")
    within = np.abs(command) <= LARGEST  # false for NaN
    if not within.all():
        row, column = np.argwhere(~within)[0]
        refuse(f"returned {command[row, column]} for robot {column}: {BOUNDED}")
    return command


def _numbers(value: Any) -> Float | None:
    """Return a new array of floats, or None if `value` holds anything but real numbers.

    Text, truth values, complex numbers and integers beyond a float are none.
    """
    try:
        found = np.asarray(value)
    except (TypeError, ValueError):  # such as rows of different lengths
        return None
    return found.astype(float) if found.dtype.kind in "iuf" else None


def commands(central: Law | None, own: Sequence[Law | None], idle: Float) -> Float:
    """Ask all laws for their commands and return them as one array (2, n).

    central: the law of the whole team, if there is one; own: each robot's own law, which overrides
    its column; idle: zeros (2, n), for robots without a law.
    """
    if central is None:
        command = idle.copy()
    else:
        command = team_command(central.command(), idle.shape[1], central.refuse)
    for i, law in enumerate(own):
        if law is not None:
            command[:, i] = robot_command(law, law.command())
    return command
