"""The differential drive, commanded by the speeds of its wheels."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from mars2d.bodies.base import Drive, Float, saturate_wheels
from mars2d.description import choice, number

__all__ = ["Differential"]


class Differential(Drive):
    """Two wheels on one axle, commanded by their speeds (left, right) [rad/s], or (v, omega).

    With wheels of radius r at +-b beside the centre, v = r (right + left) / 2 and
    omega = r (right - left) / (2 b); then x' = v cos(theta), y' = v sin(theta), theta' = omega.
    `max_linear_speed` bounds the speed of each wheel's rim and `max_acceleration` its change, so
    neither keeps the curvature of the path. Each wheel has `noise` of its own.
    """

    command: str = choice(
        default="wheels", of=("wheels", "twist"),
        doc="what commands are: the wheels' speeds (left, right) [rad/s], "
        "or (v [m/s], omega [rad/s])",
    )  # fmt: skip
    wheel_radius: float = number(
        default=0.05, low=1e-3, high=1e3, unit="m", doc="radius of the wheels"
    )
    wheel_semiaxis: float = number(
        default=0.1, low=1e-3, high=1e3, unit="m", doc="half the distance between the wheels"
    )

    @cached_property
    def _arms(self) -> Float:
        return np.array([[-self.wheel_semiaxis], [self.wheel_semiaxis]])

    def actuators(self, command: Float) -> Float:
        """Return the speeds (2, n) of the left and the right wheel's rim, m/s."""
        if self.command == "wheels":
            return command * self.wheel_radius
        return command[0] + self._arms * command[1]

    def command_for(self, actuators: Float) -> Float:
        """Return the commands (2, n) for rims with these speeds."""
        if self.command == "wheels":
            return actuators / self.wheel_radius
        return self._motion(actuators)

    def saturate(self, command: Float) -> Float:
        """Return commands (2, n) with each rim's speed clipped to +-max_linear_speed."""
        return saturate_wheels(self, command)

    def twist(self, command: Float) -> Float:
        """Return (v, 0, omega)."""
        v, omega = self._motion(self.actuators(command)) if self.command == "wheels" else command
        return np.array([v, np.zeros(command.shape[1]), omega])

    def _motion(self, rims: Float) -> Float:
        """Return (v, omega), (2, n), of rims with these speeds."""
        left, right = rims
        return np.array([(left + right) / 2, (right - left) / (2 * self.wheel_semiaxis)])
