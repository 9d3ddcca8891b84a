"""Games of shoving: robots push each other out of a ring."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import ClassVar

from mars2d.addons.contest import (
    MARK,
    Elimination,
    Exit,
    Outcome,
    Span,
    Teams,
    firsts,
    listed,
    mark,
)  # fmt: skip
from mars2d.core import checks
from mars2d.core.arithmetic import norms
from mars2d.core.description import entry, number
from mars2d.core.interfaces import FrameLike, ScenarioLike, WorldLike
from mars2d.core.plane import Outline, Point
from mars2d.core.scene import Scene

CLAY = "#f3ead8"
"""The colour of the floor of a ring."""


class Ring(Elimination):
    """A ring, and two roles whose robots shove each other out of it, as in sumo.

    >>> ring = Ring({"red": ["red"], "blue": ["blue"]}, radius=1.5)
    >>> ring.roles
    (('red', ('red',)), ('blue', ('blue',)))

    A robot is out for good when its middle has left the ring; this is checked once a control
    step. It stands still from then on, where it is, and the others go on. A role has lost when all
    its robots are out, which ends the experiment. It is a draw when the last robots of both roles
    leave in the same control step, and when time is over.

    Laws find how it stands in `score`, how many robots of each role are in the ring, `winner` and
    `out`. Of a record, `outcome` says the same, also of a loaded one.
    """

    radius: float = number(default=1.5, above=0, high=1e6, unit="m", doc="of the ring")
    center: Point = entry(
        default=(0.0, 0.0), check=checks.point, unit="m", doc="the middle of the ring, (x, y)"
    )

    holds_last: ClassVar[bool] = False

    # -- how it stands -----------------------------------------------------------------------------

    def exits(self, teams: Teams, span: Span) -> list[Exit]:
        """Return the robots that leave the ring, in order."""
        x, y = (span.pose[:, k] - self.center[k] for k in (0, 1))
        left = firsts(span.time, norms(x, y) > self.radius, (*teams[0], *teams[1]))
        return [Exit(when, robot, -1.0) for when, robot in left]

    def judged(self, teams: Teams, exits: Sequence[Exit], time_is_over: bool) -> Outcome:  # noqa: ARG002
        """Return how many robots of each role are in the ring, and who has won."""
        left = {leaving.robot: leaving.time for leaving in exits}
        names = [role for role, _ in self.roles]
        lost = [max(left.get(robot, inf) for robot in team) for team in teams]
        score = [sum(robot not in left for robot in team) for team in teams]
        winner = None if lost[0] == lost[1] else names[lost[0] < lost[1]]
        return Outcome((), dict(zip(names, score, strict=True)), winner)

    def ending(self, world: WorldLike) -> str:
        """Return why it is over now, in words; "" while it goes on."""
        winner = self.winner
        if winner is None:
            over = self._time_is_over or not any(self.score.values())
            return "a draw" if over else ""
        loser, count = next((r, len(robots)) for r, robots in self.roles if r != winner)
        who = "the other has" if count == 1 else f"all {count} of {loser} have"
        return f"{winner} wins: {who} left the ring after {world.time:.2f} s"

    @property
    def out(self) -> tuple[int, ...]:
        """The indices of the robots that have left the ring, in order."""
        return tuple(self.results)

    # -- how it is explained -----------------------------------------------------------------------

    scored: ClassVar[tuple[str, str]] = ("in the ring", "in the ring")

    def aim(self, role: str, scenario: ScenarioLike) -> str:
        """Return how a role wins, in a few words."""
        (first, _), _ = self.roles
        return f"shove {listed(scenario, self.teams(scenario)[role == first])} out of the ring"

    # -- how it looks ------------------------------------------------------------------------------

    def paint(self, scene: Scene, area: Outline) -> None:  # noqa: ARG002
        """Paint the floor of the ring."""
        scene.circle(self.center, self.radius, fill=CLAY)

    def draw(self, scene: Scene, frame: FrameLike) -> None:
        """Draw the rim; cross out the robots that have left the ring, with the time."""
        scene.circle(self.center, self.radius, stroke=MARK, width=2.0)
        for leaving in self.exits_at(frame):
            mark(scene, frame, leaving, above=bool(frame.pose[1, leaving.robot] > self.center[1]))
