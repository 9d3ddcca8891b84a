"""What a joint is: something between two bodies, or between one and the world."""

from __future__ import annotations

from mars2d.core import checks
from mars2d.core.description import Description, entry, text
from mars2d.core.plane import Point

__all__ = ["Joint"]


class Joint(Description):
    """The base of all joints.

    A joint holds on to a point of body `a` and to one of body `b`, or of the world. Joints act
    where ``Scenario.physics`` is "contact".
    """

    a: str = text(doc="the name of a robot or prop")
    b: str | None = text(default=None, optional=True, doc="the name of another; None: the world")
    anchor_a: Point = entry(
        default=(0.0, 0.0), check=checks.point, unit="m", doc="where it holds a, in a's frame"
    )
    anchor_b: Point = entry(
        default=(0.0, 0.0), check=checks.point, unit="m",
        doc="where it holds b, in b's frame; without b, the point of the world",
    )  # fmt: skip
