"""Games of shoving: robots push each other out of a ring."""

from __future__ import annotations

from math import inf
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.contest import MARK, Contest, Outcome, Teams, listed, mark
from mars2d.core import checks
from mars2d.core.arithmetic import norms
from mars2d.core.description import entry, number
from mars2d.core.interfaces import FrameLike, ScenarioLike, WorldLike
from mars2d.core.plane import Outline, Point
from mars2d.core.scene import Scene

Float = NDArray[np.float64]
CLAY = "#f3ead8"
"""The colour of the floor of a ring."""


class Ring(Contest):
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

    # -- how it stands, in a world -----------------------------------------------------------------

    def on_start(self, world: WorldLike) -> None:
        """Find the robots; raise InputError if one is not there, or has two roles."""
        self._teams = self.teams(world.scenario)
        self._left: dict[int, float] = {}

    def on_step(self, world: WorldLike) -> None:
        """Note who has left; end the experiment when one role has lost, or when time is over."""
        found = self._found(self._teams, np.array([world.time]), world.pose[None])
        now = {robot: time for robot, time in found.items() if robot not in self._left}
        self._left |= now
        if not all(self.score.values()):
            world.stop(self._message(world))
        elif world.iteration >= world.scenario.last_iteration:
            world.stop("a draw")
        else:
            for robot in now:
                world.hold(robot)

    @property
    def out(self) -> tuple[int, ...]:
        """The indices of the robots that have left the ring, in order."""
        return tuple(self._left)

    @property
    def results(self) -> dict[int, float]:
        """The results of robots that have left the ring: -1."""
        return dict.fromkeys(self.out, -1.0)

    @property
    def score(self) -> dict[str, int]:
        """The number of robots in the ring, by role."""
        return self._outcome(self._teams, self._left).score

    @property
    def winner(self) -> str | None:
        """The role that has won, or None."""
        return self._outcome(self._teams, self._left).winner

    def _message(self, world: WorldLike) -> str:
        """Return why it is over, in words."""
        winner = self.winner
        if winner is None:
            return "a draw"
        loser, count = next((r, len(robots)) for r, robots in self.roles if r != winner)
        who = "the other has" if count == 1 else f"all {count} of {loser} have"
        return f"{winner} wins: {who} left the ring after {world.time:.2f} s"

    # -- how it stands, by a record ----------------------------------------------------------------

    def outcome(self, record: Any) -> Outcome:
        """Return score and winner of a record, loaded or just made; there are no captures."""
        teams = self.teams(record.scenario)
        return self._outcome(teams, self._found(teams, record.time, record.pose))

    def _outcome(self, teams: Teams, left: dict[int, float]) -> Outcome:
        names = [role for role, _ in self.roles]
        lost = [max(left.get(robot, inf) for robot in team) for team in teams]
        score = [sum(robot not in left for robot in team) for team in teams]
        winner = None if lost[0] == lost[1] else names[lost[0] < lost[1]]
        return Outcome((), dict(zip(names, score, strict=True)), winner)

    def _found(self, teams: Teams, time: Float, pose: Float) -> dict[int, float]:
        """Return the times [s] at which robots were first outside, in order, by index.

        time: (T,). pose: (T, 3, n).
        """
        x, y = (pose[:, k] - self.center[k] for k in (0, 1))
        outside = norms(x, y) > self.radius
        if not len(time):
            return {}  # the run was over before its first row
        first = {robot: outside[:, robot].argmax() for team in teams for robot in team}
        left = {robot: float(time[row]) for robot, row in first.items() if outside[row, robot]}
        return dict(sorted(left.items(), key=lambda robot_time: robot_time[1]))

    # -- how it is explained -----------------------------------------------------------------------

    scored: ClassVar[tuple[str, str]] = ("in the ring", "in the ring")

    def aim(self, role: str, scenario: ScenarioLike) -> str:
        """Return how a role wins, in a few words."""
        (first, _), _ = self.roles
        return f"shove {listed(scenario, self.teams(scenario)[role == first])} out of the ring"

    @property
    def counts(self) -> str:
        """Who is out, and who has won, in a few sentences."""
        several = any(len(robots) > 1 for _, robots in self.roles)
        lost = "the role whose robots are all out has lost" if several else "who is out has lost"
        return (
            f"A robot is out when its middle is more than {self.radius:g} m from the middle of the "
            f"ring: {lost}. It is a draw if both leave in the same control step, and when time is "
            "over."
        )

    # -- how it looks ------------------------------------------------------------------------------

    def paint(self, scene: Scene, area: Outline) -> None:  # noqa: ARG002
        """Paint the floor of the ring."""
        scene.circle(self.center, self.radius, fill=CLAY)

    def draw(self, scene: Scene, frame: FrameLike) -> None:
        """Draw the rim; cross out the robots that have left the ring, with the time."""
        scene.circle(self.center, self.radius, stroke=MARK, width=2.0)
        pose = np.concatenate([frame.path, frame.pose[None]])
        time = np.append(np.arange(len(frame.path)) * frame.scenario.sampling_time, frame.time)
        for robot, when in self._found(self.teams(frame.scenario), time, pose).items():
            above = bool(frame.pose[1, robot] > self.center[1])
            mark(scene, frame, robot, f"{round(when, 1):g} s", above)
