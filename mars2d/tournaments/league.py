"""Leagues: how each law stands after the matches of a tournament, and the tournament as a whole."""

from __future__ import annotations

import csv
import html
import io
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import inf
from pathlib import Path
from statistics import fmean
from typing import TYPE_CHECKING, Any

from mars2d.core.errors import InputError, one_line
from mars2d.core.extras import extra
from mars2d.core.files import atomic_write
from mars2d.study.statistics import Interval, proportion
from mars2d.study.table import cell, word_cell
from mars2d.tournaments.match import Played, settled
from mars2d.tournaments.rules import Rules
from mars2d.tournaments.schedule import Schedule

if TYPE_CHECKING:
    from pandas import DataFrame

UNPROTECTED = (
    "not protected on this system: a law that means to could have harmed other laws and files"
)

WIN, DRAW = 1.0, 0.5
"""The points for a match; a loss gives none."""

COUNTS = ("played", "won", "drawn", "lost", "forfeits")
"""The numbers of matches in a standing, as all tables name and order them."""


@dataclass(frozen=True)
class Standing:
    """A law's place in the league.

    law: its name. role: the one it played, or empty if laws play all roles. played: matches with a
    result. forfeits: matches lost because the law failed. points: 1 for a win, 1/2 for a draw.
    share: of all points that it could have won, with Wilson's confidence interval. capture_time:
    the mean over matches in which the evaders were caught, seconds; if laws play all roles, only
    over those in which it was the hunter. None if there are none. place: in its table, from 1;
    laws with equal points per match share a place, and the next ones come after all of them.
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
    place: int = 0


def league(played: Sequence[Played], roles: Sequence[str]) -> list[Standing]:
    """Return the standings, best first: the laws of the first role, then those of the second.

    If a law plays more than one role, there is one table for all laws. Laws are ordered by points
    per match, then by mean capture time (short for hunters, long for evaders), then by name; their
    place is that of their points.
    """
    laws = {role: {each.match.laws[role] for each in played} for role in roles}
    tables: list[tuple[str, Sequence[str]]] = [(role, (role,)) for role in roles]
    if not set.isdisjoint(*laws.values()):
        tables = [("", roles)]
    standings = []
    for title, within in tables:
        every = {law for role in within for law in laws[role]}
        table = [_standing(law, title, within, roles, played) for law in every]
        table.sort(key=lambda standing: _order(standing, roles))
        rates = [_rate(standing) for standing in table]
        standings += [replace(each, place=rates.index(_rate(each)) + 1) for each in table]
    return standings


def _rate(standing: Standing) -> float:
    return standing.points / max(standing.played, 1)


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


def matches_of(count: int) -> str:
    """Return a number of matches as text."""
    return "1 match" if count == 1 else f"{count} matches"


def group_of(law: str) -> str:
    """Return the group that a law is of: the name of its file, without folders."""
    return law.rpartition("/")[2]


def _grade(group: str, matches: Sequence[tuple[str, Played]]) -> dict[str, Any]:
    """Return a group's row in the grading sheet, from its roles and matches."""
    reasons = [each.verdicts[role] for role, each in matches if role in each.verdicts]
    firsts = {verdict.kind: verdict.text for verdict in reversed(reasons)}
    kinds = Counter(verdict.kind for verdict in reasons)
    return {
        "group": group,
        "matches": len(matches),
        "points": sum(points_of(each, role) for role, each in matches),
        "forfeits": len(reasons),
        "reasons": "; ".join(
            f"{matches_of(count)}: {kind}: {firsts[kind]}" for kind, count in kinds.items()
        ),
    }


def points_of(played: Played, role: str) -> float:
    """Return the points that the law of a role took in a match."""
    return WIN * (played.winner == role) + DRAW * is_draw(played)


def is_draw(played: Played) -> bool:
    """Return whether a match has no winner although no law failed."""
    return played.winner is None and not played.verdicts and not played.error


def _order(standing: Standing, roles: Sequence[str]) -> tuple[float, float, str]:
    time = inf if standing.capture_time is None else standing.capture_time
    evades = standing.role in roles[1:]
    return -_rate(standing), -time if evades else time, standing.law


def head_to_head(played: Iterable[Played], roles: Sequence[str]) -> Mapping[tuple[str, str], float]:
    """Return the points that each law of the first role took from each law of the second."""
    points: dict[tuple[str, str], float] = {}
    for each in played:
        if not each.error:
            first, second = (each.match.laws[role] for role in roles)
            won = points_of(each, roles[0])
            points[first, second] = points.get((first, second), 0.0) + won
    return points


# -- the tournament --------------------------------------------------------------------------------


@dataclass(frozen=True)
class Tournament:
    """The results of a tournament.

    title, experiment: those of the scenario. roles: those of its contest. matches: their results,
    in order. standings: best first, role by role if each law plays only one. settings: the options
    in which rounds differ. rules: of the game, for people.
    """

    title: str
    experiment: str
    roles: tuple[str, ...]
    matches: tuple[Played, ...] = field(repr=False)
    standings: tuple[Standing, ...]
    settings: tuple[str, ...] = ()
    rules: Rules | None = field(default=None, repr=False)

    @classmethod
    def of(cls, schedule: Schedule, matches: Iterable[Played]) -> Tournament:
        """Return the tournament of a schedule from the matches that were played, in any order."""
        done = tuple(settled(schedule.matches, matches))
        return cls(
            title=schedule.title,
            experiment=schedule.experiment,
            roles=schedule.roles,
            matches=done,
            standings=tuple(league(done, schedule.roles)),
            settings=schedule.settings,
            rules=schedule.rules,
        )

    @property
    def unprotected(self) -> bool:
        """Whether a match was played where the system does not keep laws from harming others."""
        return any(not played.protected for played in self.matches)

    def rows(self) -> tuple[dict[str, Any], ...]:
        """Return a row for each match: its number, settings, seed, laws and result.

        ``verdict`` names the role and fault of each law that failed, such as ``pursuer: slow``.
        """
        return tuple(self._row(played) for played in self.matches)

    def _row(self, played: Played) -> dict[str, Any]:
        match = played.match
        settings = {name: match.options.get(name) for name in self.settings}
        verdicts = [f"{role}: {verdict.kind}" for role, verdict in played.verdicts.items()]
        return {
            "match": match.number,
            **settings,
            "seed": match.seed,
            **{role: match.laws[role] for role in self.roles},
            "winner": played.winner,
            **{f"{role}_score": played.score.get(role) for role in self.roles},
            "capture_time": played.capture_time,
            "steps": played.steps,
            "verdict": "; ".join(verdicts),
            "message": played.message,
            "digest": played.digest,
        }

    def standing_rows(self) -> tuple[dict[str, Any], ...]:
        """Return a row for each law: its place in its table, and its results."""
        return tuple(
            {
                "role": standing.role,
                "place": standing.place,
                "law": standing.law,
                **{name: getattr(standing, name) for name in COUNTS},
                "points": standing.points,
                "share": standing.share.mean,
                "share_low": standing.share.low,
                "share_high": standing.share.high,
                "capture_time": standing.capture_time,
            }
            for standing in self.standings
        )

    def grade_rows(self) -> tuple[dict[str, Any], ...]:
        """Return a row for each group, which is the name of its files: matches, points, forfeits.

        ``reasons`` says in words why it has forfeited.
        """
        groups: dict[str, list[tuple[str, Played]]] = {}
        for played in self.matches:
            if not played.error:
                for role, law in played.match.laws.items():
                    groups.setdefault(group_of(law), []).append((role, played))
        return tuple(_grade(group, groups[group]) for group in sorted(groups))

    def _table(self, name: str) -> tuple[dict[str, Any], ...]:
        tables = {
            "matches": self.rows, "league": self.standing_rows, "grades": self.grade_rows,
        }  # fmt: skip
        if name not in tables:
            raise InputError(f"table={name!r}: expected {', '.join(map(repr, tables))}")
        return tables[name]()

    def to_frame(self, table: str = "matches") -> DataFrame:
        """Return a table of pandas: "matches", "league", one row a law, or "grades", a group."""
        rows = self._table(table)
        with extra("data", "tables need pandas"):
            import pandas as pd
        return pd.DataFrame(rows)

    def save_csv(self, path: str | Path, table: str = "matches") -> Path:
        """Write a table, see `to_frame`, and return the path."""
        rows = self._table(table)
        text = io.StringIO(newline="")
        writer = csv.writer(text)
        writer.writerow(rows[0] if rows else [])
        writer.writerows([_cell(value) for value in row.values()] for row in rows)
        target = Path(path)
        with atomic_write(target) as file:
            file.write(text.getvalue().encode("utf-8", errors="replace"))
        return target

    def _repr_html_(self) -> str:
        """Return the league as a table, for a notebook."""
        rows = self.standing_rows()
        lines = [[*rows[0]] if rows else [], *([_shown(v) for v in row.values()] for row in rows)]
        cells = ("".join(f"<td>{html.escape(cell)}</td>" for cell in line) for line in lines)
        body = "".join(f"<tr>{row}</tr>" for row in cells)
        return f"<table><caption>{html.escape(self.title)}</caption>{body}</table>"


def _shown(value: Any) -> str:
    return f"{value:.3g}" if isinstance(value, float) else "" if value is None else str(value)


def _cell(value: Any) -> str:
    """Return a value as a cell of a table; words that look like formulas are quoted."""
    if value is None or value != value:  # noqa: PLR0124 - nan
        return ""
    return word_cell(one_line(" ".join(value.split()))) if isinstance(value, str) else cell(value)
