"""Things that robots meet and move: boxes, balls, gates."""

from mars2d.bodies.props.ball import Ball
from mars2d.bodies.props.bar import Bar
from mars2d.bodies.props.base import Prop
from mars2d.bodies.props.box import Box
from mars2d.bodies.props.gate import Gate
from mars2d.bodies.props.puck import Puck
from mars2d.bodies.props.solid import Solid

__all__ = ["Ball", "Bar", "Box", "Gate", "Prop", "Puck", "Solid"]
