"""A box: a rectangle that can be pushed."""

from __future__ import annotations

from functools import cached_property

from mars2d.description import number
from mars2d.props.base import Prop
from mars2d.shapes import Polygon, Shape

__all__ = ["Box"]


class Box(Prop):
    """A rectangle, `length` along its heading and `width` across.

    >>> round(Box(length=0.4, width=0.2, material="wood").inertia.mass, 6)
    4.8
    """

    length: float = number(default=0.4, low=1e-3, high=1e3, unit="m", doc="side along its heading")
    width: float = number(default=0.4, low=1e-3, high=1e3, unit="m", doc="side across")

    @cached_property
    def shape(self) -> Shape:
        """The rectangle."""
        x, y = self.length / 2, self.width / 2
        return Polygon([(-x, -y), (x, -y), (x, y), (-x, y)])
