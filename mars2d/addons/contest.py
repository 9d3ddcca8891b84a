"""Contests between two roles, the base of all games; and those that robots leave one by one."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.base import Addon
from mars2d.core import checks
from mars2d.core.description import accepts, entry, wrong
from mars2d.core.errors import InputError
from mars2d.core.interfaces import Contacts, FrameLike, ScenarioLike, WorldLike
from mars2d.core.scene import Scene

Float = NDArray[np.float64]
Role = tuple[str, tuple[str | int, ...]]
Teams = tuple[tuple[int, ...], tuple[int, ...]]
"""The indices of the robots of the first role, in a pursuit the hunters, and of the second."""

ROLES = "two roles, hunters first if any, such as {'pursuer': ['red'], 'evader': ['blue']}"

MARK = "#222222"
"""The colour of the mark on a robot that is out of the game."""


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


class Span(NamedTuple):
    """Some control steps of a run: times (T,), poses (T, 3, n), and all contacts, in order.

    carrier: the index of the robot that carries the flag at first.
    """

    scenario: ScenarioLike
    time: Float
    pose: Float
    contacts: Contacts
    carrier: int | None = None


class Exit(NamedTuple):
    """A robot that leaves: when [s], its index, its result, and the index of who caught it.

    The result is -1 for one that is caught or shoved out, and 1 for one that is safe. It is 0 for
    one that takes the flag, and plays on.
    """

    time: float
    robot: int
    result: float
    hunter: int | None = None


class Elimination(Contest):
    """The base of contests in which robots leave, and stand still from then on.

    A class says in `exits` who leaves, in `judged` how it stands, and in `ending` why it is over;
    all else follows, in a running world and of a record.
    """

    holds_last: ClassVar[bool] = True
    """Whether who leaves in the last control step stands still in it."""

    @abstractmethod
    def exits(self, teams: Teams, span: Span) -> list[Exit]:
        """Return which robots of two teams leave, each once, or take the flag, in a span."""

    @abstractmethod
    def judged(self, teams: Teams, exits: Sequence[Exit], time_is_over: bool) -> Outcome:
        """Return how it stands after exits."""

    @abstractmethod
    def ending(self, world: WorldLike) -> str:
        """Return why it is over now, in words; "" while it goes on."""

    def time_is_over(self, scenario: ScenarioLike, row: int) -> bool:
        """Return whether time is over for the contest at a row of a run."""
        return row >= scenario.last_iteration

    def on_start(self, world: WorldLike) -> None:
        """Find the robots; raise InputError if one is not there, or has two roles."""
        self._teams, self._time_is_over = self.players(world.scenario), False
        self._exits: tuple[Exit, ...] = ()
        self._before: tuple[float, Float] | None = None  # the last control step

    def on_step(self, world: WorldLike) -> None:
        """Note who leaves; end the experiment when it is decided, or when time is over."""
        one, other, out, time = *self._teams, self.results, world.time
        if out:
            one, other = (tuple(r for r in team if r not in out) for team in self._teams)
        before = self._before or (time, world.pose)
        times, poses = map(np.array, zip(before, (time, world.pose), strict=True))
        self._before = time, world.pose
        span = Span(world.scenario, times, poses, world.contacts, carrier_after(self._exits))
        now = self.exits((one, other), span)
        self._exits += tuple(now)
        self._time_is_over = self.time_is_over(world.scenario, world.iteration)
        changes = now or self._time_is_over or not world.iteration  # else it stands as before
        why = self.ending(world) if changes else ""
        if why:
            world.stop(why)
        for leaving in now if self.holds_last or not why else ():
            if leaving.result:
                world.hold(leaving.robot)

    @property
    def results(self) -> dict[int, float]:
        """The results of robots that are out: -1 if caught or shoved out, 1 if safe."""
        return {leaving.robot: leaving.result for leaving in self._exits if leaving.result}

    @property
    def score(self) -> dict[str, int]:
        """The score of each role."""
        return self.judged(self._teams, self._exits, self._time_is_over).score

    @property
    def winner(self) -> str | None:
        """The role that has won, or None."""
        return self.judged(self._teams, self._exits, self._time_is_over).winner

    def outcome(self, record: Any) -> Outcome:
        """Return captures, score and winner of a record, loaded or just made."""
        teams = self.players(record.scenario)
        contacts = record.contacts[record.contact_rows < len(record)]  # before its last row
        exits = self.exits(teams, Span(record.scenario, record.time, record.pose, contacts))
        return self.judged(teams, exits, self.time_is_over(record.scenario, len(record) - 1))

    def exits_at(self, frame: FrameLike) -> list[Exit]:
        """Return who has left at a frame."""
        time = np.arange(len(frame.path)) * frame.scenario.sampling_time
        pose = np.concatenate([frame.path, frame.pose[None]])
        span = Span(frame.scenario, np.append(time, frame.time), pose, frame.contact_log())
        return self.exits(self.players(frame.scenario), span)


def carrier_after(exits: Sequence[Exit]) -> int | None:
    """Return the index of the robot that carries the flag after exits; None: it is in its place."""
    out = {leaving.robot for leaving in exits if leaving.result}
    return next((e.robot for e in exits if not e.result and e.robot not in out), None)


def firsts(time: Float, there: NDArray[np.bool_], robots: Sequence[int]) -> list[tuple[float, int]]:
    """Return when robots are first there, and their indices, in order. there: (T, n)."""
    found = [(float(time[there[:, r]][0]), r) for r in robots if there[:, r].any()]
    return sorted(found, key=lambda first: first[0])


def mark(scene: Scene, frame: FrameLike, leaving: Exit, *, above: bool) -> None:
    """Ring a robot that is out, cross it out if it lost; write the time above or below it."""
    arm = 1.25 * frame.scenario.robots[leaving.robot].radius
    x, y = frame.pose[:2, leaving.robot].tolist()
    scene.circle((x, y), arm, stroke=MARK, width=1.2)
    if leaving.result < 0:
        scene.cross((x, y), arm, stroke=MARK, width=1.2)
    label = f"{round(leaving.time, 1):g} s"
    place, lines = (y + arm, f"{label}\n") if above else (y - arm, f"\n{label}")
    scene.text((x, place), lines, color=MARK, size=10.0, halo="#ffffff")
