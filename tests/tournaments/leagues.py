"""Tournaments whose matches went as is said."""

from collections.abc import Sequence

from mars2d import Robot, Scenario
from mars2d.addons import Game
from mars2d.scenario.experiment import open_experiment
from mars2d.tournaments.isolation.limits import LIMITS
from mars2d.tournaments.league import Tournament
from mars2d.tournaments.match import Played
from mars2d.tournaments.rules import Rules
from mars2d.tournaments.schedule import Schedule

ROLES = ("pursuer", "evader")


def rules_of(game, **options) -> Rules:
    """The rules of an experiment."""
    return Rules.of(open_experiment(game, options), LIMITS)


def tournament_of(
    matches: Sequence[Played],
    settings: tuple[str, ...] = (),
    title: str = "Chase",
    experiment: str = "chase.py",
) -> Tournament:
    """A tournament with these matches, of a red pursuer and a blue evader."""
    robots = [Robot(name="red", pose=(-1, 0, 0)), Robot(name="blue", pose=(1, 0, 0))]
    game = Game({"pursuer": ["red"], "evader": ["blue"]})
    rules = rules_of(Scenario(title="Chase", robots=robots, addons=[game]))
    planned = tuple(each.match for each in matches)
    schedule = Schedule(title, experiment, ROLES, settings, LIMITS, planned, frozenset(), rules)
    return Tournament(schedule, tuple(matches))
