"""Dubins' vehicle: it goes ahead at one speed, and turns within a bound."""

from __future__ import annotations

import numpy as np

from mars2d.bodies.drives.base import ROUNDING, TWIST, Float, Turning
from mars2d.core.description import number, wrong


class Dubins(Turning):
    """Goes ahead at `max_linear_speed`, commanded by (v [m/s], omega [rad/s]), v without effect.

    x' = V cos(theta), y' = V sin(theta), theta' = omega with abs(omega) <= `max_angular_speed`: its
    arcs have the radius V / max_angular_speed at least. It neither stops nor backs, also not when a
    game holds it.

    Source: L. E. Dubins, On curves of minimal length with a constraint on average curvature, and
    with prescribed initial and terminal positions and tangents, American Journal of Mathematics 79
    (1957); the vehicle as in S. M. LaValle, Planning Algorithms (2006), section 15.3.1.

    >>> Dubins(max_linear_speed=0.5, max_angular_speed=1.0).turning_radius(0.5)
    0.5
    """

    max_angular_speed: float | None = number(
        default=1.0, low=1e-3, high=1e3, unit="rad/s",
        doc="bound of its angular speed, left and right",
    )  # fmt: skip

    def _validate(self) -> None:
        super()._validate()
        if self.max_acceleration is not None:
            raise wrong(
                "Dubins.max_acceleration", self.max_acceleration, "None: its speed never changes"
            )

    inputs = TWIST
    """V [m/s] and omega [rad/s]."""

    @property
    def _most(self) -> float:
        assert self.max_angular_speed is not None
        return self.max_angular_speed

    def steered(self, across: float, ahead: float) -> tuple[float, ...]:  # noqa: ARG002
        """Return the command that a stick asks for: across, it turns."""
        return self.max_linear_speed, -self._most * across

    def saturate(self, command: Float) -> Float:
        """Return commands (2, n): v is its speed, and omega is clipped to +-max_angular_speed."""
        omega = command[1]
        over = np.abs(omega) > self._most * (1 + ROUNDING)
        omega = np.where(over, omega.clip(-self._most, self._most), omega)
        return np.array([np.full(omega.shape, self.max_linear_speed), omega])

    def twist(self, command: Float) -> Float:
        """Return (v, 0, omega)."""
        return np.array([command[0], np.zeros(command.shape[1]), command[1]])
