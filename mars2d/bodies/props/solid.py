"""A solid: a prop of any shape."""

from __future__ import annotations

from mars2d.bodies.props.base import Prop
from mars2d.core.arithmetic import norm
from mars2d.core.description import entry
from mars2d.geometry.shapes import Shape, known_shape

CENTRED = 1e-9
"""The largest distance from a shape's origin to its centre of mass, in parts of its size."""


def _centred(name: str, value: object) -> Shape:
    shape = known_shape(name, value, "Polygon([(0, 0), (0.4, 0), (0.2, 0.3)])")
    for _ in range(2):  # after the first move, rounding is left of a shape that was far away
        x, y = shape.centroid
        if norm(x, y) <= CENTRED * shape.reach:
            break
        shape = shape.moved(-x, -y)
    return shape


class Solid(Prop):
    """A prop of any shape: a polygon, which may be concave, or several shapes in one.

    Its centre of mass is moved to its pose, wherever the shape's own origin lies.
    """

    shape: Shape = entry(check=_centred, kw_only=False, doc="a Polygon, Disc or Compound")
