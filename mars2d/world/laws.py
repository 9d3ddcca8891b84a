"""Control laws: how they are called, and the commands that they may return."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from types import GeneratorType, MappingProxyType
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from mars2d.core import checks
from mars2d.core.arrays import within
from mars2d.core.errors import InputError, LawError, shown
from mars2d.core.quantity import Quantity
from mars2d.core.usercode import called, definition, name_of

Float = NDArray[np.float64]

LARGEST = 1e300
"""The largest entry of a command, in any unit, so that the drives' results stay floats."""

NONE: Mapping[int, tuple[float, ...]] = MappingProxyType({})
"""No commands."""

BOUNDED = "a command must be finite"

COUNTS = ("no", "one", "two", "three", "four")
"""The numbers of inputs, in words."""

PLAIN = frozenset({int, float, np.float64})
"""The types of numbers that need no conversion; most laws return a pair of them."""


class Law:
    """A control law: a function, or a generator that yields commands and keeps its own memory.

    A generator is started at the first step. When it returns, its robots stand still.
    """

    def __init__(self, function: Callable[[Any], Any], subject: Any, still: Any) -> None:
        """Take the user's function, its argument, and the command to stand still."""
        self.function = function
        self._subject = subject
        self._still = still
        self._running: Iterator[Any] | None = None
        self.name = name_of(function)
        self.calls = 0
        self._robot = str(getattr(subject, "name", ""))
        self._calling = called(self.name, function, self._robot)

    @property
    def started(self) -> bool:
        """Whether it is a generator that runs."""
        return self._running is not None

    def command(self) -> Any:
        """Return the law's command now, unchecked. Raises LawError where the law raises."""
        self.calls += 1
        try:
            if self._running is None:
                result = self.function(self._subject)
                if not isinstance(result, GeneratorType):
                    return result
                self._running = result
            return next(self._running, self._still)
        except BaseException as error:
            self._calling.blame(error)
            raise

    def refuse(self, message: str) -> NoReturn:
        """Raise the error that the law's command can't be used; it points at the law."""
        error = LawError(f"{self.name} {message}")
        error.where, error.robot = definition(self.function), self._robot
        raise error


def refuse(given: str, message: str) -> NoReturn:
    """Raise the error that a command can't be used that a program has given."""
    raise InputError(f"{given} {message.replace('returned', 'was given', 1)}")


def robot_command(
    value: Any, inputs: Sequence[Quantity], refuse: Callable[[str], NoReturn]
) -> tuple[float, ...]:
    """Check the command of one robot: a finite number for each input of its drive.

    refuse: raises the error.
    """
    if type(value) is tuple and len(value) == len(inputs):
        for number in value:
            if type(number) not in PLAIN or not abs(number) <= LARGEST:
                break
        else:
            return value
    names = ", ".join(each.name for each in inputs)
    if value is None:
        refuse(f"returned nothing: a law returns its command, such as `return {names}`")
    command = _numbers(value)
    if command is None or command.shape not in ((len(inputs),), (len(inputs), 1)):
        expected = f"expected {COUNTS[len(inputs)]} number{'s' * (len(inputs) > 1)}, ({names})"
        refuse(f"returned {shown(value)}: {expected}")
    found = tuple(command.ravel().tolist())
    if not within(LARGEST, command):  # neither for NaN
        refuse(f"returned {shown(found)}: {BOUNDED}")
    return found


def team_command(value: Any, still: Float, refuse: Callable[[str], NoReturn]) -> Float:
    """Check the command of all robots: a finite array (m, n); for one robot also (m,).

    still: the command (m, n) of robots that stand still.
    """
    inputs, robots = still.shape
    if value is None:
        refuse(f"returned nothing: a law returns its command, an array ({inputs}, n)")
    square = inputs == robots > 1 and isinstance(value, (list, tuple))
    if square and all(type(row) is tuple for row in value):
        hint = "write np.transpose(...) of them, or a list for each row"
        refuse(f"returned {shown(value)}: is each tuple a robot's command? Then {hint}")
    rows = f"{COUNTS[inputs]} row{'s' * (inputs > 1)}"
    expected = f"expected {rows} and a column for each robot, shape {still.shape}"
    command = _numbers(value)
    if command is None:
        refuse(f"returned {shown(value)}: {expected}{_unequal(value)}")
    if command.shape == (inputs,) and robots == 1:
        command = command.reshape(inputs, 1)
    if command.shape != still.shape:
        turned = "; transpose it" if command.shape == still.shape[::-1] else ""
        refuse(f"returned an array of shape {command.shape}: {expected}{turned}")
    if not within(LARGEST, command):
        row, column = np.argwhere(~(np.abs(command) <= LARGEST))[0]  # also NaN
        refuse(f"returned {command[row, column]} for robot {column}: {BOUNDED}")
    return command


def _unequal(value: Any) -> str:
    """Return how many numbers each row of a command has, where these are not equal."""
    if not isinstance(value, (list, tuple)) or not all(hasattr(row, "__len__") for row in value):
        return ""
    lengths = [len(row) for row in value]
    if len(set(lengths)) < 2:
        return ""
    return f"; its rows have {' and '.join(map(str, lengths))} numbers"


def _numbers(value: Any) -> Float | None:
    """Return a new array of floats, or None if `value` holds anything but real numbers.

    Text, truth values, complex numbers and integers beyond a float are none.
    """
    try:
        found = np.asarray(value)
    except Exception:  # such as for rows of different lengths, or a tensor that is being learned
        return None
    return found.astype(float) if found.dtype.kind in "iuf" else None


class Laws:
    """All laws of a world: that of the whole team, and those of single robots.

    A robot's own law overrides its column of the team's command.
    """

    def __init__(self, still: Float, inputs: Sequence[Sequence[Quantity]]) -> None:
        """Take the command (m, n) of robots that stand still, and the inputs of their drives."""
        self._still, self._inputs = still, inputs
        self._central: Law | None = None
        self._own: list[tuple[int, Law]] = []

    def silent(self) -> Laws:
        """Return none, for the same robots."""
        return Laws(self._still, self._inputs)

    @property
    def function(self) -> Callable[[Any], Any] | None:
        """The team's law as the user gave it, or None."""
        return None if self._central is None else self._central.function

    def __iter__(self) -> Iterator[Law]:
        return iter([*filter(None, [self._central]), *(law for _, law in self._own)])

    @property
    def calls(self) -> int:
        """How often laws were asked."""
        central = 0 if self._central is None else self._central.calls
        return central + sum(law.calls for _, law in self._own)

    def renew(
        self,
        control: Callable[[Any], Any] | None,
        team_view: Any,
        controllers: Sequence[Callable[[Any], Any] | None],
        robot_view: Callable[[int], Any],
    ) -> None:
        """Take the team's law and each robot's; a law that is there already goes on.

        team_view: what a new law of the team is called with. robot_view: returns the same for a
        robot's own law, by the robot's index. Raises InputError where
        `control` is no law.
        """
        if control is None:
            self._central = None
        elif self.function is not control:
            checks.function("control", control, "the world")
            self._central = Law(control, team_view, self._still)
        before = dict(self._own)
        self._own = []
        for i, controller in enumerate(controllers):
            if controller is not None:
                law = before.get(i)
                if law is None or law.function is not controller:
                    law = Law(controller, robot_view(i), (0.0,) * len(self._inputs[i]))
                self._own.append((i, law))

    def commands(self, given: Mapping[int, tuple[float, ...]] = NONE) -> Float:
        """Ask the laws for their commands and return them as one array (m, n).

        given: commands of robots, by index, in place of those of the laws. Their own laws are not
        asked.
        """
        central = self._central
        if central is None:
            command = self._still.copy()
        else:
            command = team_command(central.command(), self._still, central.refuse)
        for i, law in self._own:
            if i not in given:
                numbers = robot_command(law.command(), self._inputs[i], law.refuse)
                command[: len(numbers), i] = numbers
        for i, numbers in given.items():
            command[: len(numbers), i] = numbers
        return command
