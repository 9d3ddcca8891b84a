"""What ties bodies together: ropes, rods, springs, hinges."""

from mars2d.bodies.joints.base import Joint
from mars2d.bodies.joints.hinge import Hinge
from mars2d.bodies.joints.rope import Rod, Rope
from mars2d.bodies.joints.spring import Spring

__all__ = ["Hinge", "Joint", "Rod", "Rope", "Spring"]
