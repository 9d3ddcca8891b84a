"""Bodies: drives that move them, props that robots push, joints that tie them together."""

from mars2d.bodies.drives import Car, Differential, Drive, Holonomic, Unicycle
from mars2d.bodies.joints import Hinge, Joint, Rod, Rope, Spring
from mars2d.bodies.props import Ball, Bar, Box, Gate, Prop, Puck, Solid

__all__ = [
    "Ball",
    "Bar",
    "Box",
    "Car",
    "Differential",
    "Drive",
    "Gate",
    "Hinge",
    "Holonomic",
    "Joint",
    "Prop",
    "Puck",
    "Rod",
    "Rope",
    "Solid",
    "Spring",
    "Unicycle",
]
