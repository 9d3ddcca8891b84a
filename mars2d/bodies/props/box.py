"""A box: a rectangle that can be pushed."""

from __future__ import annotations

from functools import cached_property
from typing import Self

from mars2d.bodies.props.base import Prop
from mars2d.core.description import number
from mars2d.geometry.shapes import Shape, rectangle


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
        return rectangle(self.length, self.width)

    @property
    def side_lengths(self) -> tuple[float, float]:
        """Its length and width, metres."""
        return self.length, self.width

    def with_side_lengths(self, length: float, width: float) -> Self:
        """Return a copy with another length and width, metres."""
        return self.replace(length=length, width=width)
