"""A game that people play in a window: the roles, the countdown, and the winner."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pygame

from mars2d.addons.contest import Contest, wins
from mars2d.bodies.drives.base import Drive
from mars2d.record.frame import Frame
from mars2d.record.interventions import Steer
from mars2d.scenario.code_file import Reference
from mars2d.scenario.roles import contests_of, role_of, roles_of
from mars2d.scenario.scenario import Scenario
from mars2d.window.run.director import Director
from mars2d.window.run.driver import Driver
from mars2d.window.screen.player import Player
from mars2d.world.teleop import Stick

WAYS = (Stick(0, 1), Stick(-1, 0), Stick(0, -1), Stick(1, 0))
"""What the keys of a person stand for, in the order of their labels."""
FASTER = 1.25
"""By how much a game goes faster after it was won, and slower after it was lost."""
NEXT = 0
"""The number that begins with the next start, at the end of a game."""
COUNTDOWN = 3.0
"""The time to find one's keys, seconds of the clock."""
LONGEST_PICTURE = 0.1
"""The most that one picture counts down, seconds: a file may take longer to be read."""


@dataclass(frozen=True, slots=True)
class Seat:
    """A person's place: the robot, by its index, its role or "", and its keys that do something."""

    robot: int
    role: str
    keys: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Choice:
    """Roles that can be chosen: the key that chooses them, a number, and the robots."""

    number: int
    title: str
    robots: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Result:
    """How a game has ended, in a few words; faster: by how much the next one is played faster."""

    words: str
    faster: float = 1.0


class Play:
    """A game in a window. Without seats, people still choose their roles."""

    def __init__(self, player: Player, director: Director) -> None:
        """Start with nobody seated; `begin` seats people and counts down."""
        assert director.timeline is not None  # a recording is not played
        self._player, self._director, self._timeline = player, director, director.timeline
        self._slowest = player.speed
        self.seats: tuple[Seat, ...] = ()
        self.counting = 0.0  # seconds to go
        self.result: Result | None = None
        self.tally: dict[str, list[bool]] = {}  # of each role that people have played: their wins

    # -- who plays ----------------------------------------------------------------------------

    @property
    def scenario(self) -> Scenario:
        """What is played."""
        return self._player.source.scenario

    @property
    def contest(self) -> Contest | None:
        """What decides who has won; None where nobody does."""
        return next(iter(contests_of(self.scenario)), None)

    @property
    def choices(self) -> list[Choice]:
        """The roles that one person may play, and then both for two people."""
        roles = roles_of(self.scenario)
        alone = [Choice(k, role, team[:1]) for k, (role, team) in enumerate(roles.items(), 1)]
        if len(alone) != 2:
            return alone
        both = tuple(team[0] for team in roles.values())
        return [*alone, Choice(3, "two people", both)]

    def handle(self, event: pygame.Event) -> bool:
        """Handle the key of a number at the end; return whether it was taken."""
        number = event.type == pygame.KEYDOWN and self.result is not None
        return number and event.unicode.isdecimal() and self.choose(int(event.unicode))

    def choose(self, number: int) -> bool:
        """Begin with the roles of a number, or `NEXT`; return whether there is such a number."""
        robots = {each.number: each.robots for each in self.choices}.get(number, ())
        if not robots and number != NEXT:
            return False
        if number == NEXT:
            self._director.next_start()
        elif self._player.source.newest:
            self._player.restart()
        self.begin(robots)
        return True

    def begin(self, robots: Sequence[int] = ()) -> None:
        """Seat people at robots, or where they sat before, and count down."""
        robots = robots or [seat.robot for seat in self.seats]
        scenario = self.scenario
        self._director.seat(robots)
        self.seats = tuple(
            Seat(robot, role_of(scenario, robot), _live_keys(scenario.robots[robot].drive, driver))
            for robot, driver in zip(robots, self._director.drivers, strict=False)
        )
        if self.result is not None and self.result.faster != 1:
            speed = self._player.speed * self.result.faster
            self._player.set_speed(max(speed, self._slowest))
        self.result = None
        self.counting = COUNTDOWN if self.seats and not self._player.manual else 0.0
        self._player.pause()

    # -- time ---------------------------------------------------------------------------------

    def pass_time(self, seconds: float) -> bool:
        """Count down for seconds of the clock, then let the game go on; notice its end.

        Return whether it has just ended.
        """
        player = self._player
        if not self.seats and (player.playing or player.busy):
            player.pause()  # nobody has chosen yet
        elif self.counting:
            started = player.playing  # somebody could not wait
            left = max(0.0, self.counting - min(seconds, LONGEST_PICTURE))
            self.counting = 0.0 if started else left
            player.paused = self.counting > 0
        elif self.result is None and self.seats and player.over and not player.failed:
            self.result = self._ended()
            return True
        elif self.result is not None and not self._timeline.world.over:
            self.result = None  # somebody went back, and something else has happened
        return False

    def _ended(self) -> Result:
        """Return how the game has ended."""
        timeline, contest = self._timeline, self.contest
        record = timeline.record
        if contest is None or not len(record):
            return Result(record.over_message)
        winner = contest.outcome(record).winner
        mine = [seat for seat in self.seats if seat.role]
        seated = all(isinstance(act, Steer) and not act.row for act in record.interventions)
        for seat in mine if seated and not timeline.branches else ():  # else hands have changed it
            self.tally.setdefault(seat.role, []).append(winner == seat.role)
        if winner is None:
            return Result("A draw")
        if len(self.seats) > 1 or not mine:
            words = wins(winner)
            return Result(words[:1].upper() + words[1:])
        if winner == mine[0].role:
            return Result("You win", FASTER)
        return Result("You lose", 1 / FASTER)

    # -- how it stands ------------------------------------------------------------------------

    def score(self) -> Mapping[str, str]:
        """Return the score of each role at the newest instant, in words.

        Where nobody plays with more than one robot, it says nothing before the end. It is empty,
        too, of a referee that does not tell its `score` while a world runs.
        """
        contest = self.contest
        if contest is None or all(len(team) < 2 for _, team in contest.roles):
            return {}
        score = getattr(getattr(self._timeline.world.addons, contest.key, None), "score", None)
        if not isinstance(score, dict):
            return {}
        pairs = zip(score.items(), contest.scored, strict=False)
        return {role: f"{points:g} {what}".strip() for (role, points), what in pairs}

    def distance(self, frame: Frame) -> float | None:
        """Return the distance [m] of the nearest hunter and hunted one, middle to middle.

        Robots that are out of the game do not count, and of those in a single person's role only
        the person's own, if it hunts or is hunted. None if there are no two.
        """
        contest = self.contest
        if contest is None:
            return None
        own = [seat.robot for seat in self.seats if len(self.seats) == 1]
        players = contest.players(frame.scenario)
        teams = [[robot for robot in team if robot in own] or [*team] for team in players]
        held = self._timeline.world.operator.held
        free = [[robot for robot in team if robot not in held] for team in teams]
        one, other = free if all(free) else teams
        apart = frame.pose[:2, one, None] - frame.pose[:2, None, other]
        return float(np.hypot(*apart).min())

    @property
    def task(self) -> str:
        """What there is to do where nobody wins: the first line of the experiment's docstring."""
        return self._timeline.experiment.source.summary

    def played_by(self, role: str) -> str:
        """Return who plays a role, in words: a person, or the name of a law."""
        team = roles_of(self.scenario)[role]
        people = [seat for seat in self.seats if seat.robot in team]
        if people:
            return "you" if len(self.seats) == 1 else f"person {self.seats.index(people[0]) + 1}"
        laws = {Reference.of(self.scenario.robots[robot].controller) for robot in team}
        found = [Path(law.file).stem for law in laws if law is not None]
        return found[0] if len(found) == 1 else "its law"


def _live_keys(drive: Drive, driver: Driver) -> tuple[str, ...]:
    """Return the labels of the keys that change a drive's command."""
    rest = Stick().command(drive)
    pairs = zip(driver.keys.labels, WAYS, strict=True)
    return tuple(label for label, way in pairs if way.command(drive) != rest)
