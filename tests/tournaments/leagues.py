"""Tournaments whose matches went as is said."""

from collections.abc import Sequence
from dataclasses import replace

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
    title: str = "Chase",
    experiment: str = "chase.py",
) -> Tournament:
    """A tournament with these matches, of a red pursuer and a blue evader."""
    robots = [Robot(name="red", pose=(-1, 0, 0)), Robot(name="blue", pose=(1, 0, 0))]
    game = Game({"pursuer": ["red"], "evader": ["blue"]})
    rules = replace(rules_of(Scenario(robots=robots, addons=[game])), title=title)
    planned = tuple(each.match for each in matches)
    schedule = Schedule(experiment, ROLES, LIMITS, planned, frozenset(), rules)
    return Tournament(schedule, tuple(matches))
