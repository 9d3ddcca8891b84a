"""Things that robots meet and move: boxes, balls, gates."""

from mars2d.props.ball import Ball
from mars2d.props.bar import Bar
from mars2d.props.base import Prop
from mars2d.props.box import Box
from mars2d.props.gate import Gate
from mars2d.props.puck import Puck
from mars2d.props.solid import Solid

__all__ = ["Ball", "Bar", "Box", "Gate", "Prop", "Puck", "Solid"]
