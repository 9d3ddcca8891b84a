"""Rectangles that can be pushed: a box, and a long, thin bar."""

from __future__ import annotations

from typing import ClassVar

from mars2d.bodies.props.base import Prop
from mars2d.core.description import number


class Box(Prop):
    """A rectangle, `length` along its heading and `width` across.

    >>> round(Box(length=0.4, width=0.2, material="wood").inertia.mass, 6)
    4.8
    """

    sides: ClassVar[tuple[str, ...]] = ("length", "width")

    length: float = number(default=0.4, low=1e-3, high=1e3, unit="m", doc="side along its heading")
    width: float = number(default=0.4, low=1e-3, high=1e3, unit="m", doc="side across")


class Bar(Prop):
    """A long, thin rectangle along its heading."""

    sides: ClassVar[tuple[str, ...]] = ("length", "thickness")

    length: float = number(default=1.0, low=1e-3, high=1e3, unit="m", doc="its length")
    thickness: float = number(default=0.06, low=1e-3, high=1e3, unit="m", doc="its thickness")
