"""The holonomic drive: it can move in any direction at once."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np

from mars2d.bodies.base import ROUNDING, Drive, Float

__all__ = ["Holonomic"]


class Holonomic(Drive):
    """Moves in any direction and keeps its heading, commanded by (vx, vy) [m/s].

    x' = vx, y' = vy, in the world's frame. `max_linear_speed` bounds the length of (vx, vy) and
    keeps its direction.
    """

    frame: ClassVar[Literal["robot", "world"]] = "world"

    def saturate(self, command: Float) -> Float:
        """Return commands (2, n) shortened to max_linear_speed where they are faster."""
        speed = np.hypot(command[0], command[1])
        over = speed > self.max_linear_speed * (1 + ROUNDING)
        if not over.any():
            return command
        return command * np.where(over, self.max_linear_speed / np.where(over, speed, 1.0), 1.0)

    def twist(self, command: Float) -> Float:
        """Return (vx, vy, 0)."""
        return np.array([command[0], command[1], np.zeros(command.shape[1])])
