"""The unicycle, also called differential drive with (v, omega) as its command."""

from __future__ import annotations

import numpy as np

from mars2d.bodies.base import ROUNDING, Drive, Float
from mars2d.description import number

__all__ = ["Unicycle"]


class Unicycle(Drive):
    """Two wheels on one axle, commanded by (v [m/s], omega [rad/s]).

    x' = v cos(theta), y' = v sin(theta), theta' = omega. `max_linear_speed` bounds the speed of
    each wheel, v -+ wheel_semiaxis * omega (m/s), as MARS does.
    """

    wheel_semiaxis: float = number(
        default=0.1, low=1e-3, high=1e3, unit="m", doc="half the distance between the wheels"
    )

    def saturate(self, command: Float) -> Float:
        """Return commands (2, n) with each wheel's speed clipped to +-max_linear_speed."""
        v, rim = command[0], self.wheel_semiaxis * command[1]
        left, right = v - rim, v + rim
        limit = self.max_linear_speed
        over = np.maximum(np.abs(left), np.abs(right)) > limit * (1 + ROUNDING)
        if not over.any():
            return command
        left, right = np.clip(left, -limit, limit), np.clip(right, -limit, limit)
        v = np.where(over, (left + right) / 2, v)
        omega = np.where(over, (right - left) / (2 * self.wheel_semiaxis), command[1])
        return np.array([v, omega])

    def twist(self, command: Float) -> Float:
        """Return (v, 0, omega)."""
        return np.array([command[0], np.zeros(command.shape[1]), command[1]])
