"""Two wheels on one axle: the unicycle, and the differential drive by the speeds of its wheels."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from mars2d.bodies.drives.base import ROUNDING, STICK_TURN, TWIST, Float, Turning
from mars2d.core.description import choice, number
from mars2d.core.quantity import Quantity


class Wheeled(Turning):
    """The base of drives of two wheels on one axle, each of them an actuator.

    Commands are (v [m/s], omega [rad/s]), and actuators the speeds of the wheels' rims,
    v -+ wheel_semiaxis * omega [m/s]. `max_angular_speed` cuts omega and leaves v; then each rim is
    cut by itself, which never makes omega larger.

    With `noise` s, the semiaxis b and p = s^2 / T, v and omega are in a control step of T seconds
    off by the variances p (v^2 + b^2 omega^2) / 2 and p (v^2 + b^2 omega^2) / (2 b^2): the velocity
    motion model with alpha_1 = alpha_4 = p / 2, alpha_2 = p b^2 / 2, alpha_3 = p / (2 b^2).

    Source of the model: Thrun, Burgard and Fox, Probabilistic Robotics (2005), section 5.3.
    """

    wheel_semiaxis: float = number(
        default=0.1, low=1e-3, high=1e3, unit="m", doc="half the distance between the wheels"
    )
    wheel_names: ClassVar[tuple[str, str] | None] = ("left", "right")

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """V [m/s] and omega [rad/s]."""
        return TWIST

    def actuators(self, command: Float) -> Float:
        """Return the speeds (2, n) of the left and the right wheel's rim, m/s."""
        rims = np.empty(command.shape)
        speed, turn = command[0], np.multiply(command[1], self.wheel_semiaxis, out=rims[1])
        np.subtract(speed, turn, out=rims[0])
        np.add(speed, turn, out=turn)
        return rims

    def command_for(self, actuators: Float) -> Float:
        """Return (v, omega), (2, n), of rims with these speeds."""
        left, right = actuators
        return np.array([(left + right) / 2, (right - left) / (2 * self.wheel_semiaxis)])

    def steered(self, across: float, ahead: float) -> tuple[float, ...]:
        """Return the command that a stick asks for; it slows down as far as it needs to turn."""
        most, spin = self.max_linear_speed, min(STICK_TURN, self.max_angular_speed or STICK_TURN)
        rim = min(spin * self.wheel_semiaxis, most)
        side, way = -rim * across, ahead * (most - rim * abs(across))
        first, second = self.command_for(np.array([[way - side], [way + side]])).ravel().tolist()
        return first, second

    def saturate(self, command: Float) -> Float:
        """Return commands (2, n) with omega, then each rim's speed, clipped to its bound."""
        if self.max_angular_speed is not None:
            command = self._turning_slowly(command, self.max_angular_speed)
        rims, limit = self.actuators(command), self.max_linear_speed
        over = np.abs(rims) > limit * (1 + ROUNDING)
        if not np.count_nonzero(over):
            return command
        return np.where(over.any(axis=0), self.command_for(rims.clip(-limit, limit)), command)

    def _turning_slowly(self, command: Float, most: float) -> Float:
        """Return commands (2, n) with omega clipped to +-most [rad/s]."""
        rims = self.actuators(command)
        middle, half = (rims[0] + rims[1]) / 2, (rims[1] - rims[0]) / 2
        limit = most * self.wheel_semiaxis
        over = np.abs(half) > limit + ROUNDING * (limit + self.max_linear_speed)
        if not np.count_nonzero(over):
            return command
        half = half.clip(-limit, limit)
        return np.where(over, self.command_for(np.array([middle - half, middle + half])), command)

    def twist(self, command: Float) -> Float:
        """Return (v, 0, omega)."""
        twist = np.zeros((3, command.shape[1]))
        twist[::2] = command
        return twist


class Unicycle(Wheeled):
    """Two wheels on one axle, commanded by (v [m/s], omega [rad/s]).

    x' = v cos(theta), y' = v sin(theta), theta' = omega. `max_linear_speed` bounds the speed of
    each wheel, v -+ wheel_semiaxis * omega (m/s), as MARS does, and `max_acceleration` its change;
    so neither keeps the curvature of the path. Each wheel has `noise` of its own.
    """


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
