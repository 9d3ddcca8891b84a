"""A spring with a damper."""

from __future__ import annotations

from mars2d.bodies.joints.base import Joint
from mars2d.core.description import number

__all__ = ["Spring"]


class Spring(Joint):
    """A spring with a damper beside it: the force k (length - rest length) + c (length)'."""

    rest_length: float | None = number(
        default=None, low=0, high=1e6, unit="m", optional=True,
        doc="at which it neither pulls nor pushes; None: as at the start",
    )  # fmt: skip
    stiffness: float = number(default=20.0, above=0, high=1e6, unit="N/m", doc="k")
    damping: float = number(default=0.0, low=0, high=1e6, unit="N s/m", doc="c")
