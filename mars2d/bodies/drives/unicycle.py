"""The unicycle, also called differential drive with (v, omega) as its command."""

from __future__ import annotations

from mars2d.bodies.drives.base import Wheeled


class Unicycle(Wheeled):
    """Two wheels on one axle, commanded by (v [m/s], omega [rad/s]).

    x' = v cos(theta), y' = v sin(theta), theta' = omega. `max_linear_speed` bounds the speed of
    each wheel, v -+ wheel_semiaxis * omega (m/s), as MARS does, and `max_acceleration` its change;
    so neither keeps the curvature of the path. Each wheel has `noise` of its own.
    """
