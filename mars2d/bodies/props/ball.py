"""A ball: a disc that rolls."""

from __future__ import annotations

from functools import cached_property

from mars2d.bodies.props.base import Prop
from mars2d.core.description import number
from mars2d.geometry.shapes import Disc, Shape


class Ball(Prop):
    """A disc that rolls freely: the floor does not hold it, so it never stops by itself.

    Its `ground_friction` is 0 by default; 0.01 stands for rolling resistance.
    """

    diameter: float = number(default=0.2, low=1e-3, high=1e3, unit="m", doc="its diameter")
    ground_friction = 0.0
    friction = 0.0
    restitution = 1.0

    @property
    def radius(self) -> float:
        """Half the diameter, metres."""
        return self.diameter / 2

    @cached_property
    def shape(self) -> Shape:
        """The disc."""
        return Disc(self.diameter)
