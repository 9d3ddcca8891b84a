"""What ties bodies together: ropes, rods, springs, hinges."""

from mars2d.joints.base import Joint
from mars2d.joints.hinge import Hinge
from mars2d.joints.rod import Rod
from mars2d.joints.rope import Rope
from mars2d.joints.spring import Spring

__all__ = ["Hinge", "Joint", "Rod", "Rope", "Spring"]
