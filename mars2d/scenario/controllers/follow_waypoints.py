"""Along the waypoints of the add-on Waypoints."""

from __future__ import annotations

from typing import Any, ClassVar

from mars2d.core.arithmetic import angle_of, norm
from mars2d.core.description import number
from mars2d.core.interfaces import ScenarioLike
from mars2d.scenario.controllers.base import Command, Paced, steered, still


class FollowWaypoints(Paced):
    """Goes along its waypoints, one after the other, and stops at the last.

    The waypoints are those of the add-on `Waypoints`, which also says how near is there. With d the
    distance to the next one, its speed is min(gain d, speed): before the last one it slows down. A
    robot without waypoints stands still.
    """

    title: ClassVar[str] = "along its waypoints"

    gain: float = number(
        default=1.0, above=0, high=100, unit="1/s", doc="speed per metre to the last waypoint"
    )

    def __call__(self, robot: Any) -> Command:
        """Return the command that goes to the next waypoint."""
        ways = getattr(robot.world.addons, "waypoints", None)
        if ways is None or ways.arrived(robot.index):
            return still(robot.drive)
        (gx, gy), (x, y, theta) = ways.goal(robot.index), robot.pose.tolist()
        last = len(ways.routes[robot.index]) - ways.reached[robot.index] == 1
        speed = min(self.gain * norm(gx - x, gy - y), self.speed) if last else self.speed
        return steered(robot.drive, theta, angle_of(gy - y, gx - x), speed)

    def want(self, scenario: ScenarioLike, index: int) -> str:
        """Return what a robot lacks to be moved by this law: waypoints."""
        ways = next((addon for addon in scenario.addons if addon.key == "waypoints"), None)
        routes = () if ways is None else ways.routes
        return "" if index < len(routes) and len(routes[index]) else "a waypoint"
