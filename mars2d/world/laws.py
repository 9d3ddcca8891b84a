"""Control laws: how a law is called, and what it may return."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import LawError, shown
from mars2d.core.usercode import called, definition, name_of

__all__ = ["Law", "commands", "robot_command", "team_command"]

Float = NDArray[np.float64]

LARGEST = 1e300
"""No entry of a command is larger, in whatever unit: what drives make of it stays a float."""

BOUNDED = "a command must be finite"

PLAIN = frozenset({int, float, np.float64})
"""Numbers that need not be looked at twice; most laws return a pair of them."""


class Law:
    """A control law: a function, or a generator that yields commands and keeps its own memory.

    A generator is started at the first step. When it returns, its robots stand still.
    """

    def __init__(
        self, function: Callable[[Any], Any], subject: Any, still: Any = (0.0, 0.0)
    ) -> None:
        """Take the user's function, what it is called with, and the command to stand still."""
        self.function = function
        self._subject = subject
        self._still = still
        self._running: Iterator[Any] | None = None
        self.name = name_of(function)
        self._calling = called(self.name, function)

    def command(self) -> Any:
        """Return what the law commands now, unchecked. Raises LawError where the law raises."""
        with self._calling:
            if self._running is None:
                result = self.function(self._subject)
                if not inspect.isgenerator(result):
                    return result
                self._running = result
            return next(self._running, self._still)

    def refuse(self, message: str) -> NoReturn:
        """Raise the error that the law's command can't be used; it points at the law."""
        error = LawError(f"{self.name} {message}")
        error.where = definition(self.function)
        raise error


def robot_command(law: Law, value: Any) -> tuple[float, float]:
    """Check the command of one robot: two finite numbers."""
    if value is None:
        law.refuse("returned nothing: a law returns its command, as `return v, omega`")
    if type(value) is tuple and len(value) == 2 and {*map(type, value)} <= PLAIN:
        first, second = value
        if abs(first) <= LARGEST and abs(second) <= LARGEST:
            return first, second
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


def commands(central: Law | None, own: Sequence[tuple[int, Law]], idle: Float) -> Float:
    """Ask all laws for their commands and return them as one array (2, n).

    central: the law of the whole team, if there is one; own: robots with laws of their own, which
    override their columns; idle: zeros (2, n), for robots without a law.
    """
    if central is None:
        command = idle.copy()
    else:
        command = team_command(central.command(), idle.shape[1], central.refuse)
    for i, law in own:
        command[0, i], command[1, i] = robot_command(law, law.command())
    return command
