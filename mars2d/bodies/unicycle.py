"""The unicycle, also called differential drive with (v, omega) as its command."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from mars2d.bodies.base import Drive, Float, saturate_wheels
from mars2d.description import number

__all__ = ["Unicycle"]


class Unicycle(Drive):
    """Two wheels on one axle, commanded by (v [m/s], omega [rad/s]).

    x' = v cos(theta), y' = v sin(theta), theta' = omega. `max_linear_speed` bounds the speed of
    each wheel, v -+ wheel_semiaxis * omega (m/s), as MARS does, and `max_acceleration` its change;
    so neither keeps the curvature of the path. Each wheel has `noise` of its own.
    """

    wheel_semiaxis: float = number(
        default=0.1, low=1e-3, high=1e3, unit="m", doc="half the distance between the wheels"
    )

    @cached_property
    def _arms(self) -> Float:
        return np.array([[-self.wheel_semiaxis], [self.wheel_semiaxis]])

    def actuators(self, command: Float) -> Float:
        """Return the speeds (2, n) of the left and the right wheel, m/s."""
        return command[0] + self._arms * command[1]

    def command_for(self, actuators: Float) -> Float:
        """Return (v, omega), (2, n), of wheels with these speeds."""
        left, right = actuators
        return np.array([(left + right) / 2, (right - left) / (2 * self.wheel_semiaxis)])

    def saturate(self, command: Float) -> Float:
        """Return commands (2, n) with each wheel's speed clipped to +-max_linear_speed."""
        return saturate_wheels(self, command)

    def twist(self, command: Float) -> Float:
        """Return (v, 0, omega)."""
        return np.array([command[0], np.zeros(command.shape[1]), command[1]])
