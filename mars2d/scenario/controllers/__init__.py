"""The ready-made laws of robots. A new one is a file here, and a line below."""

from mars2d.scenario.controllers.base import Controller, standing_still
from mars2d.scenario.controllers.by_hand import ByHand
from mars2d.scenario.controllers.follow_robot import FollowRobot
from mars2d.scenario.controllers.follow_wall import FollowWall
from mars2d.scenario.controllers.follow_waypoints import FollowWaypoints
from mars2d.scenario.controllers.wander import Wander

__all__ = [
    "ByHand",
    "Controller",
    "FollowRobot",
    "FollowWall",
    "FollowWaypoints",
    "Wander",
    "standing_still",
]
