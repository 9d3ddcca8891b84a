"""Obstacles from lists of vertices."""

from __future__ import annotations

from collections.abc import Sequence

from mars2d.addons.base import Addon
from mars2d.checks import outlines
from mars2d.description import entry
from mars2d.geometry import Outline

__all__ = ["Map"]


class Map(Addon):
    """Obstacles from lists of vertices [m]: two vertices make a wall, more a closed polygon.

    >>> Map([[(0, 0), (1, 0)], [(2, 2), (3, 2), (3, 3)]]).obstacles()[0]
    ((0.0, 0.0), (1.0, 0.0))

    Concave outlines stay concave. A contact has the product of both surfaces' friction and
    restitution: with 1 and 1 here, those of the robot decide.
    """

    outlines: Sequence[Outline] = entry(
        check=outlines, unit="m", kw_only=False, doc="the obstacles"
    )

    def obstacles(self) -> tuple[Outline, ...]:
        """Return the outlines."""
        return tuple(self.outlines)
