"""Contests between two roles: the base of all games."""

from __future__ import annotations

from abc import abstractmethod
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np

from mars2d.addons.base import Addon
from mars2d.core import checks
from mars2d.core.description import accepts, entry, wrong
from mars2d.core.errors import InputError
from mars2d.core.interfaces import ScenarioLike

Role = tuple[str, tuple[str | int, ...]]
Teams = tuple[tuple[int, ...], tuple[int, ...]]
"""The indices of the robots of the first role, in a pursuit the hunters, and of the second."""

ROLES = "two roles, hunters first if any, such as {'pursuer': ['red'], 'evader': ['blue']}"


class Capture(NamedTuple):
    """One capture: when [s], and the indices of the robot that caught and of the caught one."""

    time: float
    hunter: int
    evader: int


class Outcome(NamedTuple):
    """The state of a contest: its captures in order, each role's score, and the winner or None.

    In a pursuit the hunters' score is how many they have caught, that of the evaders how many are
    free. In a ring, where nobody is captured, it is how many are still in it. payoff: what the
    second role wants much of and the first one little; in a pursuit how long the evaders were free,
    on average [s]; nan if nothing is counted so.
    """

    captures: tuple[Capture, ...]
    score: dict[str, int]
    winner: str | None
    payoff: float = float("nan")

    @property
    def capture_time(self) -> float:
        """The time of the last capture, seconds; nan if an evader is free, or nobody was caught."""
        caught = bool(self.captures) and list(self.score.values())[1] == 0
        return self.captures[-1].time if caught else float("nan")


@accepts({"type": "array", "minItems": 2, "maxItems": 2})
def _roles(name: str, value: object) -> tuple[Role, ...]:
    """Check two roles with their robots, a dict or, as in a file, pairs; keep them as pairs."""
    try:
        roles = dict(value)  # type: ignore[call-overload]
    except (TypeError, ValueError):
        raise wrong(name, value, ROLES) from None
    if len(roles) != 2 or not all(isinstance(role, str) for role in roles):
        raise wrong(name, value, ROLES)
    return tuple((role, robots_of(f"{name}[{role!r}]", team)) for role, team in roles.items())


@accepts({"type": "array", "items": {"type": ["string", "integer"]}, "minItems": 1})
def robots_of(name: str, value: object) -> tuple[str | int, ...]:
    """Check a list of robots, by their names or indices."""
    expected = "a list of robots, by their names or indices, such as ['red', 'blue']"
    items = checks.items_of(name, value, expected)
    if not items:
        raise wrong(name, value, f"{expected}; nobody has this role")
    for item in items:
        if isinstance(item, bool) or not isinstance(item, (str, int, np.integer)):
            raise wrong(name, value, expected)
    return tuple(item if isinstance(item, str) else int(item) for item in items)


class Contest(Addon):
    """The base of add-ons with a winner: two roles, the robots of each, an outcome.

    A tournament finds the roles that laws are played in by the one contest of its scenario.
    """

    roles: tuple[Role, ...] = entry(
        check=_roles, kw_only=False,
        doc="the robots of both roles",
    )  # fmt: skip

    scored: ClassVar[tuple[str, str]] = ("", "")
    """What the score of each role counts, in a word for people."""

    def renamed(self, old: str, new: str) -> Self:
        """Return a copy in which a robot has another name; roles keep theirs."""
        roles = [
            (role, tuple(new if robot == old else robot for robot in robots))
            for role, robots in self.roles
        ]
        return super().renamed(old, new).replace(roles=roles)

    @abstractmethod
    def outcome(self, record: Any) -> Outcome:
        """Return captures, score and winner of a record, loaded or just made."""

    def aim(self, role: str, scenario: Any) -> str:  # noqa: ARG002
        """Return how a role wins, in a few words for people, such as ``"catch blue"``.

        scenario: of the game. By default empty.
        """
        return ""

    @property
    def winner(self) -> str | None:
        """The role that has won by now, in a running world; by default an InputError."""
        raise InputError(
            f"{type(self).__name__} says who has won of a record alone: give it a property "
            "`winner`, or the learner a reward"
        )

    @property
    def results(self) -> dict[int, float]:
        """The results of robots that have left the contest, by index.

        It is -1 for one that has been caught or shoved out, and 1 for one that is safe.
        """
        return {}

    def players(self, scenario: ScenarioLike) -> Teams:
        """Return the indices of the robots that may leave, or let others leave, by role."""
        return self.teams(scenario)

    def teams(self, scenario: ScenarioLike) -> Teams:
        """Return the indices of the first role's robots in a scenario, and of the second role's.

        Raises InputError for a robot that is not there, or that stands in the roles twice.
        """
        names = [str(robot.name) for robot in scenario.robots]
        taken: dict[int, str] = {}
        teams = []
        for role, robots in self.roles:
            team = []
            for robot in robots:
                index = scenario.index_of(f"{type(self).__name__}.roles[{role!r}]", robot)
                if index in taken:
                    twice = f"is {taken[index]} and {role}"
                    twice = f"stands twice as {role}" if taken[index] == role else twice
                    raise InputError(f"{type(self).__name__}.roles: {names[index]} {twice}")
                taken[index] = role
                team.append(index)
            teams.append(tuple(team))
        return teams[0], teams[1]


def wins(role: str) -> str:
    """Return the words for a role's victory, such as "evader wins" and "hunters win".

    >>> wins("hunters")
    'hunters win'
    """
    return f"{role} {'win' if role.endswith('s') else 'wins'}"


def listed(scenario: ScenarioLike, team: tuple[int, ...]) -> str:
    """Return the names of a team, by its indices, or how many they are if they are many."""
    names = [str(scenario.robots[robot].name) for robot in team]
    if len(names) > 3:
        return f"all {len(names)}"
    return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))
