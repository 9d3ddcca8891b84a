"""The holonomic drive: it can move in any direction at once."""

from __future__ import annotations

from math import inf
from typing import ClassVar, Literal

import numpy as np

from mars2d.bodies.drives.base import ROUNDING, Drive, Float, reached
from mars2d.core.arithmetic import norms
from mars2d.core.quantity import Quantity


class Holonomic(Drive):
    """Moves in any direction and keeps its heading, commanded by (vx, vy) [m/s].

    x' = vx, y' = vy, in the world's frame. `max_linear_speed` bounds the length of (vx, vy) and
    keeps its direction, `max_acceleration` the length of its change. `noise` is that of each
    component in shares of the speed, so that it is the same in all directions.
    """

    frame: ClassVar[Literal["robot", "world"]] = "world"
    holonomic: ClassVar[bool] = True

    inputs = (Quantity("vx", "m/s"), Quantity("vy", "m/s"))
    """Vx and vy [m/s]."""

    def saturate(self, command: Float) -> Float:
        """Return commands (2, n) shortened to max_linear_speed where they are faster."""
        speed = norms(command[0], command[1])
        over = speed > self.max_linear_speed * (1 + ROUNDING)
        if not np.count_nonzero(over):
            return command
        return command * np.where(over, self.max_linear_speed / np.where(over, speed, 1.0), 1.0)

    def accelerate(self, command: Float, last: Float, duration: float) -> Float:
        """Return commands (2, n) that have changed by max_acceleration x duration at most.

        last: (2, n), the commands issued `duration` seconds before.
        """
        if self.max_acceleration is None:
            return command
        change = command - last
        size = norms(change[0], change[1])
        most = self.max_acceleration * duration
        over = size > most + ROUNDING * (most + norms(last[0], last[1]))
        if not np.count_nonzero(over):
            return command
        return np.where(over, last + change * (most / np.where(over, size, 1.0)), command)

    def ramp(self, command: Float, last: Float, start: float, end: float) -> Float:
        """Return the commands (2, n) that it follows in the mean from `start` to `end` seconds.

        last: (2, n), those that it followed at 0 s. The velocity goes straight to the new one.
        """
        change = command - last
        most = inf if self.max_acceleration is None else self.max_acceleration
        takes = norms(change[0], change[1]) / most
        return np.asarray(last + reached(takes, start, end) * change)

    def disturb(self, command: Float, normal: Float) -> Float:
        """Return commands (2, n), each component off by a share of the speed.

        normal: (2, n), as in `Drive.disturb`.
        """
        return np.asarray(command + self.noise * norms(command[0], command[1]) * normal)

    def twist(self, command: Float) -> Float:
        """Return (vx, vy, 0)."""
        return np.array([command[0], command[1], np.zeros(command.shape[1])])
