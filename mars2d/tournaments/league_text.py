"""A tournament as text for a terminal: standings, who beat whom, faults."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from mars2d.core.errors import counted
from mars2d.core.terminal import aligned
from mars2d.tournaments.league import (
    UNPROTECTED,
    Tournament,
    league,
    league_tables,
    matches_of,
)
from mars2d.tournaments.match import Played

MAX_WIDTH = 100
"""The greatest width of the tables of pairings and rounds; wider ones are only on the page."""

MAX_FAULT_LENGTH = 160
"""The greatest length of the text about a law's faults."""


def league_text(tournament: Tournament) -> str:
    """Return the league tables, the table of who beat whom, and notes on faults."""
    told = []
    for standings, rows in league_tables(tournament):
        header = ["", standings[0].role or "law", *[*rows[0]][2:]]
        told.append("\n".join(aligned([header, *([*row.values()] for row in rows)], left=2)))
    told += [part(tournament) for part in (_pairings, _rounds, _faults, _same_matches)]
    told.append(f"Isolation: {UNPROTECTED}" if tournament.unprotected else "")
    return "\n\n".join(filter(None, told))


def _fitting(lines: Sequence[Sequence[str]]) -> str:
    """Return a table whose first column are names; empty if it is wider than `MAX_WIDTH`."""
    table = aligned(lines, left=1)
    return "\n".join(table) if max(map(len, table)) <= MAX_WIDTH else ""


def _pairings(tournament: Tournament) -> str:
    """Return the points that laws took from each other, if there is more than one pairing."""
    points = tournament.head_to_head()
    columns = [*next(iter(points.values()), ())]
    if sum(bool(taken) for rivals in points.values() for taken in rivals.values()) < 2:
        return ""
    first, second = tournament.schedule.roles
    title = f"Points of each {first} against each {second}:"
    if {*points} & {*columns}:
        first, second, title = "law", "rival", "Points of each law against each other:"
    rows = [
        (law, *(f"{sum(taken):g}" if taken else "-" for taken in rivals.values()))
        for law, rivals in points.items()
    ]
    table = _fitting([(f"{first} \\ {second}", *columns), *rows])
    return f"{title}\n{table}" if table else ""


def _rounds(tournament: Tournament) -> str:
    """Return each law's points in each round, if there are several rounds."""
    rounds = tournament.rounds()
    if len(rounds) < 2:
        return ""
    tables = [league(found, tournament.schedule.roles) for found in rounds.values()]
    points = [{(each.role, each.law): f"{each.points:g}" for each in table} for table in tables]
    rows = [
        (each.law, *(table.get((each.role, each.law), "-") for table in points))
        for each in tournament.standings
    ]
    return _fitting([("points with", *rounds), *rows])


def _faults(tournament: Tournament) -> str:
    """Return a line for each law's kind of fault: how often it occurred, and its first text."""
    faults: dict[tuple[str, str, str], list[tuple[Played, str]]] = {}
    for played in tournament.matches:
        for role, verdict in played.verdicts.items():
            kind = (f"{played.match.laws[role]}: ", "forfeited", f"{verdict.kind}: ")
            faults.setdefault(kind, []).append((played, verdict.text))
    for played in tournament.matches:
        if played.error:
            kind = ("", "without a result", "")
            faults.setdefault(kind, []).append((played, played.error))
    return "\n".join(
        f"{law}{matches_of(len(found))} {what}: {kind}{_cut(found[0][1])}"
        f" ({_numbers(played for played, _ in found)})"
        for (law, what, kind), found in faults.items()
    )


def _cut(text: str) -> str:
    return text if len(text) <= MAX_FAULT_LENGTH else text[: MAX_FAULT_LENGTH - 3] + "..."


def _numbers(matches: Iterable[Played]) -> str:
    first, *others = (played.match.number for played in matches)
    return f"match {first}" + (f" and {counted(len(others), 'other')}" if others else "")


def _same_matches(tournament: Tournament) -> str:
    """Return a note on pairings that played the same match with every seed."""
    pairings: dict[tuple[object, ...], list[Played]] = {}
    for played in tournament.matches:
        if played.digest and not played.verdicts:
            match = played.match
            key = (*match.laws.values(), *map(repr, match.options.values()))
            pairings.setdefault(key, []).append(played)
    several = [found for found in pairings.values() if len(found) > 1]
    same = [found for found in several if len({played.digest for played in found}) == 1]
    if not same:
        return ""
    which = "each pairing" if len(same) == len(several) else f"{len(same)} pairings"
    seeds = counted(len(same[0]), "seed")
    return f"The {seeds} gave the same match in {which}: nothing in it is random."
