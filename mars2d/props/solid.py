"""A thing of any shape."""

from __future__ import annotations

from mars2d.description import entry
from mars2d.props.base import Prop
from mars2d.shapes import Shape, known_shape

__all__ = ["Solid"]


def _centred(name: str, value: object) -> Shape:
    shape = known_shape(name, value, "Polygon([(0, 0), (0.4, 0), (0.2, 0.3)])")
    x, y = shape.centroid
    return shape if abs(x) + abs(y) < 1e-12 else shape.moved(-x, -y)


class Solid(Prop):
    """A thing of any shape: a polygon, concave too, or several shapes in one.

    Its centre of mass is put at its pose, wherever the shape's own origin lies.
    """

    shape: Shape = entry(check=_centred, kw_only=False, doc="a Polygon, Disc or Compound")
