"""Obstacles from lists of vertices."""

from __future__ import annotations

from mars2d.addons.base import Addon
from mars2d.checks import outlines
from mars2d.description import entry, number
from mars2d.geometry import Outline

__all__ = ["Map"]


class Map(Addon):
    """Obstacles from lists of vertices [m]: two vertices make a wall, more a closed polygon.

    >>> Map([[(0, 0), (1, 0)], [(2, 2), (3, 2), (3, 3)]]).obstacles()[0]
    ((0.0, 0.0), (1.0, 0.0))

    Concave outlines stay concave. friction and restitution are those of the surface; a contact has
    the product of both surfaces' values.
    """

    outlines: tuple[Outline, ...] = entry(check=outlines, unit="m", kw_only=False, doc="the obstacles")
    friction: float = number(0.5, low=0, high=1e3, doc="coefficient of friction")
    restitution: float = number(0.0, low=0, high=1, doc="0 stops, 1 bounces back")

    def obstacles(self) -> tuple[Outline, ...]:
        """Return the outlines."""
        return self.outlines
