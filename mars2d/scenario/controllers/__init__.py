"""The ready-made laws of robots. A new one is a class in `laws.py`, and a name below."""

from mars2d.scenario.controllers.base import Controller, standing_still
from mars2d.scenario.controllers.laws import (
    ByHand,
    FollowRobot,
    FollowWall,
    FollowWaypoints,
    Wander,
)

__all__ = [
    "ByHand",
    "Controller",
    "FollowRobot",
    "FollowWall",
    "FollowWaypoints",
    "Wander",
    "standing_still",
]
