"""Discs: a puck slides, a ball rolls."""

from __future__ import annotations

from functools import cached_property

from mars2d.bodies.props.base import Prop
from mars2d.core.description import number
from mars2d.geometry.shapes import Disc, Shape


class Puck(Prop):
    """A disc that slides and is slowed down by the floor, like a puck on a table."""

    diameter: float = number(default=0.2, low=1e-3, high=1e3, unit="m", doc="its diameter")
    ground_friction = 0.1

    @property
    def radius(self) -> float:
        """Half the diameter, metres."""
        return self.diameter / 2

    @cached_property
    def shape(self) -> Shape:
        """The disc."""
        return Disc(self.diameter)


class Ball(Puck):
    """A disc that rolls freely: the floor does not hold it, so it never stops by itself.

    Its `ground_friction` is 0 by default; 0.01 stands for rolling resistance.
    """

    ground_friction = 0.0
    friction = 0.0
    restitution = 1.0
