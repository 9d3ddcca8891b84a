"""The differential drive, commanded by the speeds of its wheels."""

from __future__ import annotations

from mars2d.bodies.drives.base import Float, Wheeled
from mars2d.core.description import choice, number
from mars2d.core.quantity import Quantity


class Differential(Wheeled):
    """Two wheels on one axle, commanded by their speeds (left, right) [rad/s], or by (v, omega).

    With wheels of radius r, b to the left and right of the centre, v = r (right + left) / 2 and
    omega = r (right - left) / (2 b); then x' = v cos(theta), y' = v sin(theta), theta' = omega.
    `max_linear_speed` bounds the speed of each wheel's rim and `max_acceleration` its change; so
    neither keeps the curvature of the path. Each wheel has `noise` of its own.

    >>> import numpy as np
    >>> Differential(wheel_radius=0.05).twist(np.array([[3.0], [5.0]])).T.round(12).tolist()
    [[0.2, 0.0, 0.5]]
    """

    command: str = choice(
        default="wheels", of=("wheels", "twist"),
        doc="the speeds of the left and the right wheel [rad/s], or v [m/s] and omega [rad/s]",
    )  # fmt: skip
    wheel_radius: float = number(
        default=0.05, low=1e-3, high=1e3, unit="m", doc="radius of the wheels"
    )

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """The speeds of the left and the right wheel [rad/s], or v [m/s] and omega [rad/s]."""
        if self.command == "wheels":
            return Quantity("left", "rad/s"), Quantity("right", "rad/s")
        return super().inputs

    def actuators(self, command: Float) -> Float:
        """Return the speeds (2, n) of the left and the right wheel's rim, m/s."""
        if self.command == "wheels":
            return command * self.wheel_radius
        return super().actuators(command)

    def command_for(self, actuators: Float) -> Float:
        """Return the commands (2, n) for rims with these speeds."""
        if self.command == "wheels":
            return actuators / self.wheel_radius
        return super().command_for(actuators)

    def twist(self, command: Float) -> Float:
        """Return (v, 0, omega)."""
        if self.command == "wheels":
            command = super().command_for(self.actuators(command))
        return super().twist(command)
