"""Leagues: how each law stands after the matches that were played."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from statistics import fmean

from mars2d.study.statistics import Interval, proportion
from mars2d.study.tournament.match import Played

__all__ = ["DRAW", "WIN", "Standing", "head_to_head", "is_draw", "league", "one_table"]

WIN, DRAW = 1.0, 0.5
"""The points of a match; who lost has none."""


@dataclass(frozen=True)
class Standing:
    """How a law stands.

    law: its name. role: the one it played, or empty where laws play all roles. played: matches that
    have a result. forfeits: of those lost, how many because the law failed. points: 1 for a match
    won, 1/2 for one drawn. share: of all points that it could have, with its confidence interval
    (Wilson's). capture_time: the mean, seconds, of those matches in which the evaders were caught;
    for laws that play all roles, of those that it hunted in. None if there are none.
    """

    law: str
    role: str
    played: int
    won: int
    drawn: int
    lost: int
    forfeits: int
    points: float
    share: Interval
    capture_time: float | None


def one_table(played: Iterable[Played], roles: Sequence[str]) -> bool:
    """Return whether some law plays more than one role, so that all are compared in one table."""
    taken: dict[str, set[str]] = {role: set() for role in roles}
    for each in played:
        for role, law in each.match.laws.items():
            taken[role].add(law)
    return len(set.union(*taken.values())) < sum(map(len, taken.values()))


def league(played: Sequence[Played], roles: Sequence[str]) -> list[Standing]:
    """Return how all laws stand, best first; first those of the first role, then of the second.

    Where a law plays more than one role, there is one table for all. The order is by points, those
    of a match where some played more of them than others, then by the mean time of capture, since
    hunters should be quick and evaders last long, then by the name.
    """
    if one_table(played, roles):
        tables = [("", tuple(roles))]
    else:
        tables = [(role, (role,)) for role in roles]
    standings = []
    for title, within in tables:
        laws = dict.fromkeys(each.match.laws[role] for each in played for role in within)
        table = [_standing(law, title, within, roles, played) for law in laws]
        standings += sorted(table, key=lambda standing: _order(standing, roles))
    return standings


def _standing(
    law: str,
    title: str,
    within: Sequence[str],
    roles: Sequence[str],
    played: Sequence[Played],
) -> Standing:
    counted = [
        (role, each)
        for each in played
        for role in within
        if each.match.laws[role] == law and not each.error
    ]
    won = sum(each.winner == role for role, each in counted)
    drawn = sum(is_draw(each) for _, each in counted)
    points = WIN * won + DRAW * drawn
    times = [
        each.capture_time
        for role, each in counted
        if each.capture_time is not None and (title or role == roles[0])
    ]
    return Standing(
        law=law,
        role=title,
        played=len(counted),
        won=won,
        drawn=drawn,
        lost=len(counted) - won - drawn,
        forfeits=sum(role in each.verdicts for role, each in counted),
        points=points,
        share=proportion(points, len(counted)),
        capture_time=fmean(times) if times else None,
    )


def is_draw(played: Played) -> bool:
    """Return whether nobody has won, and nobody's law has failed."""
    return played.winner is None and not played.verdicts and not played.error


def _order(standing: Standing, roles: Sequence[str]) -> tuple[float, float, str]:
    time = inf if standing.capture_time is None else standing.capture_time
    evades = standing.role in roles[1:]
    return -standing.points / max(standing.played, 1), -time if evades else time, standing.law


def head_to_head(played: Iterable[Played], roles: Sequence[str]) -> Mapping[tuple[str, str], float]:
    """Return the points that a law of the first role took from each of the second."""
    points: dict[tuple[str, str], float] = {}
    for each in played:
        if not each.error:
            first, second = (each.match.laws[role] for role in roles)
            won = WIN * (each.winner == roles[0]) + DRAW * is_draw(each)
            points[first, second] = points.get((first, second), 0.0) + won
    return points
