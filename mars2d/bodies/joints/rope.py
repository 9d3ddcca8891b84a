"""A rope: it pulls, and never pushes."""

from __future__ import annotations

from mars2d.bodies.joints.base import Joint
from mars2d.core.description import number

__all__ = ["Rope"]


class Rope(Joint):
    """A rope that does not stretch: it holds two points no further apart than its length.

    It weighs nothing, and lets other things pass. A jerk on it is inelastic.
    """

    length: float | None = number(
        default=None, above=0, high=1e6, unit="m", optional=True,
        doc="how long it is; None: as far as its ends are apart at the start",
    )  # fmt: skip
