"""A rod: two points keep their distance."""

from __future__ import annotations

from mars2d.bodies.constraints import Constraint, FixedDistance
from mars2d.bodies.joints.base import Joint
from mars2d.core.description import number


class Rod(Joint):
    """A rigid rod without weight: it keeps two points at a distance, and turns freely at both."""

    length: float | None = number(
        default=None, above=0, high=1e6, unit="m", optional=True,
        doc="its length; None: the distance of its ends at the start",
    )  # fmt: skip

    def constraints(self, apart: float) -> tuple[Constraint, ...]:
        """Return the distance of its ends."""
        return (FixedDistance(apart if self.length is None else self.length),)
