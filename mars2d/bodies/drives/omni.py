"""The omnidirectional drive: three or four wheels whose rims have rollers."""

from __future__ import annotations

from functools import cached_property
from typing import ClassVar

import numpy as np

from mars2d.bodies.drives.base import ROUNDING, STICK_TURN, Drive, Float
from mars2d.core.arithmetic import cosines_sines
from mars2d.core.description import integer, number, wrong
from mars2d.core.quantity import Quantity


class Omni(Drive):
    """Moves in any direction and turns at once, commanded by (vx, vy [m/s], omega [rad/s]).

    vx is ahead and vy to the left, in the robot's frame. The wheels stand on a circle about the
    pose, evenly, at angles b of pi / wheels, 3 pi / wheels and so on from ahead; each drives along
    the circle, counter-clockwise, and rolls freely across that. The speeds of their rims are

        s_i = -sin(b_i) vx + cos(b_i) vy + wheel_distance omega.

    `max_linear_speed` bounds each of these: a command that asks for more is shortened as a whole,
    so that its direction and its arc stay. `max_acceleration` bounds the change of each. `noise` is
    that of each wheel.

    A wheel skids beyond grip m g / wheels along its circle. With three wheels and with four these
    bear grip m g / 2 together in every direction, more in some, and the torque grip m g
    wheel_distance; the drive gives no more than that, nor than `max_force` and `max_torque`.

    Source: K. M. Lynch and F. C. Park, Modern Robotics (2017), section 13.2.1, with rollers at
    right angles (gamma = 0); the force is the dual of the same matrix, F = sum of f_i u_i.

    >>> import numpy as np
    >>> Omni(wheels=4).actuators(np.array([[0.2], [0.0], [0.0]])).ravel().round(3).tolist()
    [-0.141, -0.141, 0.141, 0.141]
    """

    wheels: int = integer(default=3, low=3, high=4, doc="the number of wheels")
    wheel_distance: float = number(
        default=0.1, low=1e-3, high=1e3, unit="m", doc="from the pose to each wheel"
    )

    holonomic: ClassVar[bool] = True
    second_stick: ClassVar[bool] = True

    def _validate(self) -> None:
        super()._validate()
        for name in ("side_grip", "no_load_speed"):
            if getattr(self, name) is not None:
                expected = "None: its wheels drive and hold alike in all directions"
                raise wrong(f"Omni.{name}", getattr(self, name), expected)

    inputs = (Quantity("vx", "m/s"), Quantity("vy", "m/s"), Quantity("omega", "rad/s"))
    """Vx, vy [m/s] and omega [rad/s]."""

    @property
    def rates(self) -> tuple[float | None, ...]:
        """The bound of each wheel's acceleration [m/s^2]."""
        return (self.max_acceleration,) * self.wheels

    @property
    def grips(self) -> tuple[None, None]:
        """None: what its wheels bear is in `strength`."""
        return None, None

    def strength(self, weight: float) -> tuple[float, float]:
        """Return the largest force [N] in every direction, and torque [N m]; weight: N."""
        if self.grip is None:
            return self.max_force, self.max_torque
        held = self.grip * weight
        return min(self.max_force, held / 2), min(self.max_torque, held * self.wheel_distance)

    @cached_property
    def _ways(self) -> Float:
        """The direction (2, wheels) in which each wheel drives."""
        c, s = cosines_sines(np.pi / self.wheels * np.arange(1.0, 2 * self.wheels, 2))
        return np.array([-s, c])

    def actuators(self, command: Float) -> Float:
        """Return the speeds (wheels, n) of the rims, m/s, that commands (3, n) ask for."""
        x, y = self._ways[:, :, None]
        return np.asarray(x * command[0] + y * command[1] + self.wheel_distance * command[2])

    def command_for(self, actuators: Float) -> Float:
        """Return the commands (3, n) nearest to these speeds (wheels, n) of the rims."""
        x, y = self._ways[:, :, None]
        mean = 2.0 * np.array([(x * actuators).sum(axis=0), (y * actuators).sum(axis=0)])
        turn = actuators.sum(axis=0) / self.wheel_distance
        return np.vstack([mean, turn[None]]) / self.wheels

    def steered(self, across: float, ahead: float, turn: float = 0.0) -> tuple[float, ...]:
        """Return the command that sticks ask for: one for the way, a second one turns."""
        most = self.max_linear_speed
        return most * ahead, -most * across, -STICK_TURN * turn

    def saturate(self, command: Float) -> Float:
        """Return commands (3, n), shortened where a rim would be faster than max_linear_speed."""
        fastest = np.abs(self.actuators(command)).max(axis=0)
        over = fastest > self.max_linear_speed * (1 + ROUNDING)
        if not np.count_nonzero(over):
            return command
        return command * np.where(over, self.max_linear_speed / np.where(over, fastest, 1.0), 1.0)

    def twist(self, command: Float) -> Float:
        """Return (vx, vy, omega)."""
        return command
