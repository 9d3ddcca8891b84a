"""Leagues: how each law stands after the matches of a tournament, and the tournament as a whole."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from itertools import groupby
from math import inf
from operator import itemgetter
from pathlib import Path
from statistics import fmean
from typing import Any

from mars2d.core.errors import InputError, one_line
from mars2d.core.files import atomic_write
from mars2d.study.statistics import proportion
from mars2d.study.table import cell
from mars2d.tournaments.match import Played
from mars2d.tournaments.rating import MIDDLE, ratings
from mars2d.tournaments.schedule import Schedule

UNPROTECTED = (
    "not protected on this system: a law that means to could have harmed other laws and files"
)

WIN, DRAW = 1.0, 0.5
"""The points for a match; a loss gives none."""


@dataclass(frozen=True)
class Standing:
    """A law's place in the league: a row of its table.

    role: the one it played, or empty if laws play all roles. place: in its table, from 1; laws with
    equal points per match share a place, and the next ones come after all of them. law: its name.
    played: matches with a result. forfeits: matches lost because the law failed. points: 1 for a
    win, 1/2 for a draw. share: of all points that it could have won, with Wilson's 95 % confidence
    interval from share_low to share_high. elo: its rating, with 95 % confidence within elo_half,
    see `ratings`; what a role is better by does not count. payoff: the mean of its matches', in a
    pursuit how long the evaders were free, seconds; if laws play all roles, only over those in
    which it played the first. None if there is none.
    """

    role: str
    place: int
    law: str
    played: int
    won: int
    drawn: int
    lost: int
    forfeits: int
    points: float
    share: float
    share_low: float
    share_high: float
    elo: float
    elo_half: float
    payoff: float | None


def league(played: Sequence[Played], roles: Sequence[str]) -> list[Standing]:
    """Return the standings, best first: the laws of the first role, then those of the second.

    If a law plays more than one role, there is one table for all laws. Laws are ordered by points
    per match, then by payoff (little for the first role, much for the second), then by name; their
    place is that of their points.
    """
    laws = {role: {each.match.laws[role] for each in played} for role in roles}
    if not set.isdisjoint(*laws.values()):
        laws = {"": set.union(*laws.values())}

    def order(standing: Standing) -> tuple[float, float, str]:
        payoff = inf if standing.payoff is None else standing.payoff
        evades = standing.role in roles[1:]
        return -_rate(standing), -payoff if evades else payoff, standing.law

    first, second = roles
    games = [
        ((first, each.match.laws[first]), (second, each.match.laws[second]), balance(each, roles))
        for each in played
        if not each.error
    ]
    if "" in laws:
        games = [(("", one), ("", other), points) for (_, one), (_, other), points in games]
    elo = ratings(games)
    standings = []
    for role, every in laws.items():
        table = sorted((_standing(law, role, roles, played, elo) for law in every), key=order)
        rates = [_rate(each) for each in table]
        standings += [replace(each, place=rates.index(_rate(each)) + 1) for each in table]
    return standings


def _rate(standing: Standing) -> float:
    return standing.points / max(standing.played, 1)


def _standing(
    law: str,
    role: str,
    roles: Sequence[str],
    played: Sequence[Played],
    elo: Mapping[tuple[str, str], tuple[float, float]],
) -> Standing:
    counted = [
        (own, each)
        for each in played
        for own in ([role] if role else roles)
        if each.match.laws[own] == law and not each.error
    ]
    points = [points_of(each, own) for own, each in counted]
    payoffs = [
        each.payoff
        for own, each in counted
        if each.payoff is not None and (role or own == roles[0])
    ]
    won, drawn = points.count(WIN), points.count(DRAW)
    lost = len(points) - won - drawn
    forfeits = sum(own in each.verdicts for own, each in counted)
    counts = (len(points), won, drawn, lost, forfeits)
    share = proportion(sum(points), len(points))
    of_all = (share.mean, share.low, share.high)
    payoff = fmean(payoffs) if payoffs else None
    rating = elo.get((role, law), (MIDDLE, inf))
    return Standing(role, 0, law, *counts, sum(points), *of_all, *rating, payoff)


def points_of(played: Played, role: str) -> float:
    """Return the points that the law of a role took in a match."""
    drawn = played.winner is None and not played.verdicts and not played.error
    return WIN * (played.winner == role) + DRAW * drawn


def balance(played: Played, roles: Sequence[str]) -> float:
    """Return the points of the first role, from 0 to 1; 1/2 if neither or both have lost."""
    one, other = (points_of(played, role) for role in roles)
    return (1 + one - other) / 2


def matches_of(count: int) -> str:
    """Return a number of matches as text."""
    return "1 match" if count == 1 else f"{count} matches"


# -- the tournament --------------------------------------------------------------------------------


@dataclass(frozen=True)
class Tournament:
    """The results of a tournament: of the matches of its schedule, in order."""

    schedule: Schedule
    matches: tuple[Played, ...] = field(repr=False)

    @cached_property
    def standings(self) -> tuple[Standing, ...]:
        """How each law stands, best first, role by role if each law plays only one."""
        return tuple(league(self.matches, self.schedule.roles))

    @property
    def unprotected(self) -> bool:
        """Whether a match was played where the system does not keep laws from harming others."""
        return any(not played.protected for played in self.matches)

    def laws(self, *roles: str) -> list[str]:
        """Return the laws that play any of these roles, best first."""
        playing = {played.match.laws[role] for played in self.matches for role in roles}
        return [law for law in dict.fromkeys(s.law for s in self.standings) if law in playing]

    def head_to_head(self) -> dict[str, dict[str, list[float]]]:
        """Return the points that each law took from each other, match by match.

        From the laws of the first role to those of the second; if a law plays both, from all to
        all. Laws that did not meet have an empty list.
        """
        first, second = self.schedule.roles
        rows, columns = self.laws(first), self.laws(second)
        swapped = not set(rows).isdisjoint(columns)
        if swapped:
            rows = columns = self.laws(first, second)
        points: dict[str, dict[str, list[float]]] = {
            row: {column: [] for column in columns} for row in rows
        }
        for played in self.matches:
            if not played.error:
                one, other = (played.match.laws[role] for role in (first, second))
                points[one][other].append(points_of(played, first))
                if swapped:
                    points[other][one].append(points_of(played, second))
        return points

    # -- tables --------------------------------------------------------------------------------

    def table(self, name: str = "matches") -> tuple[dict[str, Any], ...]:
        """Return the rows of a table: "matches", "league" with a row a law, or "grades".

        In matches, ``verdict`` names the role and fault of each law that failed, such as
        ``pursuer: slow``. A row of grades is that of a group, which is the name of its files;
        ``elo`` is its rating over both roles, and ``reasons`` says in words why it has forfeited.
        Raises InputError for another name.
        """
        if name == "matches":
            return tuple(map(self._match, self.matches))
        if name == "league":
            return tuple(map(asdict, self.standings))
        if name != "grades":
            raise InputError(f"table={name!r}: expected 'matches', 'league' or 'grades'")
        groups: dict[str, list[tuple[str, Played]]] = {}
        games, roles = [], self.schedule.roles
        for played in self.matches:
            if not played.error:
                names = {role: law.rpartition("/")[2] for role, law in played.match.laws.items()}
                games.append((names[roles[0]], names[roles[1]], balance(played, roles)))
                for role, group in names.items():
                    groups.setdefault(group, []).append((role, played))
        elo = ratings(games)
        return tuple(_grade(group, groups[group], elo[group][0]) for group in sorted(groups))

    def _match(self, played: Played) -> dict[str, Any]:
        """Return a match's row: its number, seed, laws and result."""
        roles, match = self.schedule.roles, played.match
        return {
            "match": match.number,
            "seed": match.seed,
            **{role: match.laws[role] for role in roles},
            "winner": played.winner,
            **{f"{role}_score": played.score.get(role) for role in roles},
            "payoff": played.payoff,
            "steps": played.steps,
            "verdict": "; ".join(f"{role}: {v.kind}" for role, v in played.verdicts.items()),
            "message": played.message,
            "digest": played.digest,
        }

    def save_csv(self, path: str | Path, table: str = "matches") -> Path:
        """Write a table, see `table`, and return the path."""
        rows = self.table(table)
        text = io.StringIO(newline="")
        writer = csv.writer(text)
        writer.writerow(rows[0] if rows else [])
        writer.writerows([_cell(value) for value in row.values()] for row in rows)
        target = Path(path)
        with atomic_write(target) as file:
            file.write(text.getvalue().encode("utf-8", errors="replace"))
        return target


def _grade(group: str, matches: Sequence[tuple[str, Played]], elo: float) -> dict[str, Any]:
    """Return a group's row in the grading sheet, from its roles and matches."""
    lost = [(each.verdicts[role], each) for role, each in matches if role in each.verdicts]
    kinds = Counter(verdict.kind for verdict, _ in lost)
    firsts = {verdict.kind: (each.match.number, verdict.text) for verdict, each in reversed(lost)}
    reasons = [
        f"{kind} in {matches_of(kinds[kind])}, first in match {number}: {text}"
        for kind, (number, text) in sorted(firsts.items(), key=itemgetter(1))
    ]
    return {
        "group": group,
        "matches": len(matches),
        "points": sum(points_of(each, role) for role, each in matches),
        "elo": round(elo),
        "forfeits": len(lost),
        "reasons": "; ".join(reasons),
    }


def _cell(value: Any) -> str:
    """Return a value as a cell of a table."""
    if value is None or value != value:  # noqa: PLR0124 - nan
        return ""
    return one_line(" ".join(value.split())) if isinstance(value, str) else cell(value)


# -- the league as text ----------------------------------------------------------------------------

ALWAYS_SHOWN = ("place", "law", "points", "share (95 %)", "played")
"""The columns that are always shown; others are left out if they have no values."""


def league_tables(tournament: Tournament) -> Iterator[tuple[list[Standing], list[dict[str, str]]]]:
    """Yield each league table: its standings, and their rows as text, by the columns' headings."""
    for _, group in groupby(tournament.standings, key=lambda standing: standing.role):
        standings = [*group]
        rows = [_texts(standing) for standing in standings]
        shown = {k for row in rows for k in row if k in ALWAYS_SHOWN or row[k] not in ("0", "-")}
        yield standings, [{k: text for k, text in row.items() if k in shown} for row in rows]


def _texts(standing: Standing) -> dict[str, str]:
    """Return a standing as text, by the headings of its columns."""
    share = f"{standing.share:.2f} ({standing.share_low:.2f} to {standing.share_high:.2f})"
    payoff = standing.payoff
    counts = ("played", "won", "drawn", "lost", "forfeits")
    return {
        "place": f"{standing.place}",
        "law": standing.law,
        "points": f"{standing.points:g}",
        "share (95 %)": share if standing.played else "-",
        **{name: f"{getattr(standing, name)}" for name in counts},
        "Elo": f"{standing.elo:.0f} ± {standing.elo_half:.0f}" if standing.played else "-",
        "free for": "-" if payoff is None else f"{payoff:.1f} s",
    }
