"""What a drive is: from a command to the motion it asks for, and the force it can use."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mars2d.description import Description, number

__all__ = ["Drive"]

Float = NDArray[np.float64]

ROUNDING = 1e-12
"""By how much, relatively, a command may exceed its limit: saturating twice changes nothing."""


class Drive(Description):
    """The base of all drives.

    A drive says how a command (2,) becomes a motion. `saturate` limits commands to what the
    actuators can do, `twist` gives the velocity they ask for. Both work on the columns of many
    robots at once.
    """

    max_linear_speed: float = number(
        default=0.5, above=0, high=1e3, unit="m/s", doc="bound of the speed"
    )
    max_force: float = number(
        default=5.0, above=0, high=1e6, unit="N", doc="what the drive can push with"
    )
    max_torque: float = number(
        default=0.5, above=0, high=1e6, unit="N m", doc="what it can turn with"
    )

    frame: ClassVar[Literal["robot", "world"]] = "robot"
    """The frame that `twist` gives linear velocities in."""

    def saturate(self, command: Float) -> Float:
        """Return commands (2, n) within the actuators' limits."""
        raise NotImplementedError(f"{type(self).__name__} must say how it saturates commands")

    def twist(self, command: Float) -> Float:
        """Return (3, n): two components of velocity [m/s], in `frame`, and spin [rad/s]."""
        raise NotImplementedError(f"{type(self).__name__} must say how it moves")
