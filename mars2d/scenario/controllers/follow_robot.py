"""After another robot."""

from __future__ import annotations

from typing import Any, ClassVar

from mars2d.core.arithmetic import angle_of, norm
from mars2d.core.description import number, text
from mars2d.core.interfaces import ScenarioLike
from mars2d.scenario.controllers.base import Command, Paced, steered, still


class FollowRobot(Paced):
    """Follows another robot at a distance, and waits where it is nearer.

    With d the distance of the centres, its speed is min(gain (d - distance), speed). So behind a
    leader that goes straight at v it stays v / gain farther back than `distance`. It needs to see
    the other as a neighbour.
    """

    title: ClassVar[str] = "after another robot"

    leader: str | None = text(
        default=None, optional=True, doc="the name of the other robot; None: its nearest neighbour",
        names="robot",
    )  # fmt: skip
    distance: float = number(
        default=0.6,
        above=0,
        high=1e3,
        unit="m",
        doc="distance from the other's centre at which it stops",
    )
    gain: float = number(
        default=2.0, above=0, high=100, unit="1/s", doc="speed per metre beyond the distance"
    )

    def __call__(self, robot: Any) -> Command:
        """Return the command that goes to the leader."""
        x, y, theta = robot.pose.tolist()
        seen = [
            each.position - (x, y)
            for each in robot.neighbours
            if self.leader is None or each.name == self.leader
        ]
        if not seen:
            return still(robot.drive)
        dx, dy = min((place.tolist() for place in seen), key=lambda place: norm(*place))
        speed = min(self.gain * (norm(dx, dy) - self.distance), self.speed)
        if speed <= 0:
            return still(robot.drive)
        return steered(robot.drive, theta, angle_of(dy, dx), speed)

    def want(self, scenario: ScenarioLike, index: int) -> str:
        """Return what a robot lacks to be moved by this law: a robot to follow."""
        others = [robot.name for i, robot in enumerate(scenario.robots) if i != index]
        if self.leader is None:
            return "" if others else "another robot"
        return "" if self.leader in others else f"a robot called {self.leader}"
