"""Things that robots meet and move: boxes, balls, gates."""

from mars2d.bodies.props.base import Prop
from mars2d.bodies.props.discs import Ball, Puck
from mars2d.bodies.props.gate import Gate
from mars2d.bodies.props.rectangles import Bar, Box
from mars2d.bodies.props.solid import Solid

__all__ = ["Ball", "Bar", "Box", "Gate", "Prop", "Puck", "Solid"]
