"""The car: it steers with its front wheels."""

from __future__ import annotations

import numpy as np

from mars2d.bodies.drives.base import ROUNDING, Float, Turning
from mars2d.core.arithmetic import angles_of, cosine_sine, cosines_sines
from mars2d.core.description import number
from mars2d.core.quantity import Quantity


class Car(Turning):
    """A car with steered front wheels, commanded by (v [m/s], steering angle delta [rad]).

    x' = v cos(theta), y' = v sin(theta), theta' = v tan(delta) / wheelbase: the bicycle model. The
    pose is that of the middle of the rear axle, v its speed; it turns about a point wheelbase /
    tan(delta) to the left. Speed and steering are limited each by itself, so a car that is told to
    go too fast keeps its curvature; `max_angular_speed` cuts the steering angle, and the speed
    stays. `noise` is that of the speed in shares of the speed, and that of tan(delta) in shares of
    max_steering: straight ahead, that of the steering angle.

    Source: K. M. Lynch and F. C. Park, Modern Robotics (2017), section 13.3.1.
    """

    wheelbase: float = number(
        default=0.2, low=1e-3, high=1e3, unit="m", doc="distance between the axles"
    )
    max_steering: float = number(
        default=0.6, low=1e-3, high=1.5, unit="rad", doc="bound of the steering angle"
    )
    max_steering_rate: float | None = number(
        default=None, low=1e-6, high=1e6, unit="rad/s", optional=True,
        doc="bound of the rate of the steering angle; None: no bound",
    )  # fmt: skip

    inputs = (Quantity("v", "m/s"), Quantity("delta", "rad", "angle"))
    """V [m/s] and the steering angle delta [rad]."""

    @property
    def rates(self) -> tuple[float | None, float | None]:
        """The bounds of the acceleration [m/s^2] and of the steering rate [rad/s]."""
        return self.max_acceleration, self.max_steering_rate

    def steered(self, across: float, ahead: float) -> tuple[float, ...]:
        """Return the command that a stick asks for: across, it steers."""
        return self.max_linear_speed * ahead, -self.max_steering * across

    def saturate(self, command: Float) -> Float:
        """Return commands (2, n), the speed clipped to +-max_linear_speed, the angle likewise.

        Then the angle is cut to that at which this speed turns it at max_angular_speed.
        """
        limit = np.array([[self.max_linear_speed], [self.max_steering]])
        over = np.abs(command) > limit * (1 + ROUNDING)
        if np.count_nonzero(over):
            command = np.where(over, command.clip(-limit, limit), command)
        return self._turning_slowly(command)

    def ramp(self, command: Float, last: Float, start: float, end: float) -> Float:
        """Return the commands (2, n) of `Drive.ramp`, none of which turns too quickly."""
        return self._turning_slowly(super().ramp(command, last, start, end))

    def _turning_slowly(self, command: Float) -> Float:
        """Return commands (2, n) that turn it at max_angular_speed at most; v stays."""
        if self.max_angular_speed is None:
            return command
        v, delta = command
        most = angles_of(np.full(v.shape, self.max_angular_speed * self.wheelbase), np.abs(v))
        over = np.abs(delta) > most * (1 + ROUNDING)
        if not np.count_nonzero(over):
            return command
        return np.array([v, np.where(over, delta.clip(-most, most), delta)])

    def turning_radius(self, speed: float) -> float:
        """Return the least radius of its arcs at a speed [m/s], metres: that of the steering."""
        c, s = cosine_sine(self.max_steering)
        return max(self.wheelbase * c / s, super().turning_radius(speed))

    def disturb(self, command: Float, normal: Float) -> Float:
        """Return commands (2, n), the speed off by a share of itself.

        normal: (2, n), as in `Drive.disturb`.
        """
        return np.array([command[0] * (1.0 + self.noise * normal[0]), command[1]])

    def noisy_twist(self, command: Float, normal: Float) -> Float:
        """Return (v, 0, omega), v off by a share of itself, omega by that of the steering, too.

        The spin is off by v noise max_steering / wheelbase, with the v of the command: it is linear
        in the noise, so that turns add up to a random walk that does not depend on how long
        a control step is. normal: (2, n), as in `Drive.disturb`.
        """
        twist = np.array(self.twist(self.disturb(command, normal)), dtype=float)
        twist[2] += self.noise * self.max_steering / self.wheelbase * command[0] * normal[1]
        return twist

    def twist(self, command: Float) -> Float:
        """Return (v, 0, v tan(delta) / wheelbase)."""
        v, delta = command
        c, s = cosines_sines(delta)
        tangent = s / c
        return np.array([v, np.zeros(command.shape[1]), v * tangent / self.wheelbase])
