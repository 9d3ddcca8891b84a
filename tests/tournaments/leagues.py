"""Tournaments whose matches went as is said."""

from collections.abc import Sequence

from mars2d.tournaments.isolation.limits import LIMITS
from mars2d.tournaments.league import Tournament
from mars2d.tournaments.match import Played
from mars2d.tournaments.schedule import Schedule

ROLES = ("pursuer", "evader")
COLORS = {"pursuer": ("#d62728",), "evader": ("#1f77b4",)}


def tournament_of(
    matches: Sequence[Played],
    title: str = "Chase",
    experiment: str = "chase.py",
) -> Tournament:
    """A tournament with these matches, of a red pursuer and a blue evader."""
    planned = tuple(each.match for each in matches)
    schedule = Schedule(experiment, ROLES, LIMITS, planned, frozenset(), title, COLORS)
    return Tournament(schedule, tuple(matches))
