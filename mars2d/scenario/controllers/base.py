"""The base of ready-made laws, which steer any drive as a stick does."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from typing import Any, ClassVar

import numpy as np

from mars2d.bodies.drives.base import Drive
from mars2d.core.arithmetic import cosine_sine
from mars2d.core.description import Description, number
from mars2d.core.interfaces import ScenarioLike
from mars2d.core.plane import wrap
from mars2d.sensors.base import Sensor

Command = tuple[float, ...]

TURN_GAIN = 1.5
"""The deflection of the stick to the side for each radian that the heading is off."""

SLOW = 0.3
"""The share of its speed at which a drive that can't turn on the spot goes round bends."""


class Controller(Description):
    """The base of ready-made laws: a robot's own law, with fields, that a file can name.

    >>> class Ahead(Controller):
    ...     def __call__(self, robot):
    ...         return robot.drive.steered(0.0, 1.0)

    It is called with the robot, as any law is, and returns a command, or yields one at each step.
    What it remembers belongs into a generator or `robot.memory`: all runs share the object.
    """

    title: ClassVar[str] = "a law of its own"
    """What the robot does, in words, as a menu lists it."""

    needs: ClassVar[tuple[Sensor, ...]] = ()
    """The sensors that it reads; the editor gives them to a robot that gets this law."""

    def __call__(self, robot: Any) -> Command | Generator[Command]:
        """Return the command (2,) of a robot's drive, or a generator of commands."""
        raise NotImplementedError(f"{type(self).__name__} must say what the robot does")

    def want(self, scenario: ScenarioLike, index: int) -> str:
        """Return what a robot lacks to be moved by this law, such as "a waypoint", or "".

        index: of the robot in `scenario.robots`.
        """
        carried = {sensor.key for sensor in scenario.robots[index].sensors}
        missing = [key for key in self.reads if key not in carried]
        return f"a sensor called {missing[0]}" if missing else ""

    @property
    def reads(self) -> Sequence[str]:
        """The names of the sensors that it reads."""
        return ()


class Paced(Controller):
    """The base of laws with a speed."""

    speed: float = number(
        default=0.3, above=0, high=1e3, unit="m/s", doc="its speed, within the drive's bounds"
    )


def standing_still(scenario: ScenarioLike, control: object = None) -> dict[int, str]:
    """Return what each robot lacks to be moved, such as "a law", by its index.

    control: the law of the team, or None. A law of the user's own may stand still, too.
    """
    found = {}
    for i, robot in enumerate(scenario.robots):
        law = robot.controller
        if law is None:
            want = "a law" if control is None else ""
        else:
            want = law.want(scenario, i) if isinstance(law, Controller) else ""
        if want:
            found[i] = want
    return found


def still(drive: Drive) -> Command:
    """Return the command (m,) to stand still."""
    return (0.0,) * len(drive.inputs)


def gone(drive: Drive, direction: float, speed: float) -> Command:
    """Return the command (m,) of a drive that moves in any direction; speed: m/s.

    direction: radians, of the world where the drive moves in its frame, else from the heading.
    """
    share = min(speed / drive.max_linear_speed, 1.0)
    c, s = cosine_sine(direction)
    return (
        drive.steered(share * c, share * s)
        if drive.frame == "world"
        else drive.steered(-share * s, share * c)
    )


def steered(drive: Drive, heading: float, direction: float, speed: float) -> Command:
    """Return the command (m,) that takes a robot towards a direction of the world.

    heading, direction: radians. speed: m/s. A drive that moves in any direction goes straight
    there. One that can turn on the spot does so first, the slower ahead the more its heading is
    off. A car backs where the direction lies behind it, and turns as it goes.
    """
    if drive.frame == "world":
        return gone(drive, direction, speed)
    off = float(wrap(direction - heading))
    if drive.holonomic:
        return gone(drive, off, speed)
    share = min(speed / drive.max_linear_speed, 1.0)
    across, ahead = min(max(-TURN_GAIN * off, -1.0), 1.0), cosine_sine(off)[0]
    if not np.any(drive.twist(np.array([drive.steered(1.0, 0.0)]).T)[2]):  # nor on the spot
        sign = 1.0 if ahead >= 0 else -1.0
        return drive.steered(sign * across, sign * share * max(abs(ahead), SLOW))
    return drive.steered(across, share * max(ahead, 0.0))
