"""A tournament as text for a terminal: standings, who beat whom, faults."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import groupby
from math import isnan

from mars2d.core.errors import counted
from mars2d.core.terminal import aligned
from mars2d.tournaments.league import (
    COUNTS,
    UNPROTECTED,
    Standing,
    Tournament,
    head_to_head,
    league,
    matches_of,
)
from mars2d.tournaments.match import Played

MAX_WIDTH = 100
"""The greatest width of the table of who beat whom; a wider one is only on the page."""

MAX_FAULT_LENGTH = 160
"""The greatest length of the text about a law's faults."""


def league_text(tournament: Tournament) -> str:
    """Return the league tables, the table of who beat whom, and notes on faults."""
    parts = (_tables, _matrix, _rounds, _faults, _notes)
    told = [part(tournament) for part in parts]
    told.append(f"Isolation: {UNPROTECTED}" if tournament.unprotected else "")
    return "\n\n".join(filter(None, told))


# -- the league ------------------------------------------------------------------------------------

ALWAYS_SHOWN = 5
"""The number of first columns that are always shown; others without any values are left out."""

COLUMNS = ("points", "share (95 %)", *COUNTS, "caught after")


def _tables(tournament: Tournament) -> str:
    tables = []
    for role, standings in groupby(tournament.standings, key=lambda standing: standing.role):
        rows: list[tuple[str, ...]] = [("", role or "law", *COLUMNS)]
        rows += [(f"{standing.place}", *_row(standing)) for standing in standings]
        shown = [
            k
            for k in range(len(rows[0]))
            if k < ALWAYS_SHOWN or any(row[k] not in ("", "0", "-") for row in rows[1:])
        ]
        tables.append("\n".join(aligned([[row[k] for k in shown] for row in rows], left=2)))
    return "\n\n".join(tables)


def _row(standing: Standing) -> tuple[str, ...]:
    share = standing.share
    shares = "-" if isnan(share.mean) else f"{share.mean:.2f} ({share.low:.2f} to {share.high:.2f})"
    time = standing.capture_time
    return (
        standing.law,
        f"{standing.points:g}",
        shares,
        *(str(getattr(standing, name)) for name in COUNTS),
        "-" if time is None else f"{time:.1f} s",
    )


def _matrix(tournament: Tournament) -> str:
    """Return the points that laws took from each other, if there is more than one pairing."""
    points = head_to_head(tournament.matches, tournament.roles)
    ranked = dict.fromkeys(standing.law for standing in tournament.standings)
    rows, columns = ([law for law in ranked if any(p[k] == law for p in points)] for k in (0, 1))
    if len(rows) * len(columns) < 2:
        return ""
    first, second = tournament.roles
    table = [(f"{first} \\ {second}", *columns)]
    table += [(row, *(_points(points.get((row, column))) for column in columns)) for row in rows]
    lines = aligned(table, left=1)
    if max(map(len, lines)) > MAX_WIDTH:
        return ""
    return "\n".join([f"Points of each {first} against each {second}:", *lines])


def _rounds(tournament: Tournament) -> str:
    """Return each law's points in each round, if there are several rounds."""
    rounds: dict[str, list[Played]] = {}
    for played in tournament.matches:
        options = played.match.options
        name = ", ".join(f"{key} = {options[key]}" for key in tournament.settings)
        rounds.setdefault(name, []).append(played)
    if len(rounds) < 2:
        return ""
    table = [("points with", *rounds)]
    tables = [league(found, tournament.roles) for found in rounds.values()]
    points = [{(each.role, each.law): each.points for each in standings} for standings in tables]
    for standing in tournament.standings:
        key = (standing.role, standing.law)
        table.append((standing.law, *(_points(each.get(key)) for each in points)))
    lines = aligned(table, left=1)
    return "" if max(map(len, lines)) > MAX_WIDTH else "\n".join(lines)


def _points(points: float | None) -> str:
    return "-" if points is None else f"{points:g}"


# -- faults and notes ------------------------------------------------------------------------------


def _faults(tournament: Tournament) -> str:
    """Return a line for each law's kind of fault: how often it occurred, and its first text."""
    faults: dict[tuple[str, str], list[tuple[Played, str]]] = {}
    for played in tournament.matches:
        for role, verdict in played.verdicts.items():
            law = played.match.laws[role]
            faults.setdefault((law, verdict.kind), []).append((played, verdict.text))
    lines = [
        f"{law}: {matches_of(len(found))} forfeited: {kind}: {_cut(found[0][1])}"
        f" ({_numbers(played for played, _ in found)})"
        for (law, kind), found in faults.items()
    ]
    errors: dict[str, list[Played]] = {}
    for played in tournament.matches:
        if played.error:
            errors.setdefault(played.error, []).append(played)
    lines += [
        f"{matches_of(len(found))} without a result: {_cut(error)} ({_numbers(found)})"
        for error, found in errors.items()
    ]
    return "\n".join(lines)


def _cut(text: str) -> str:
    return text if len(text) <= MAX_FAULT_LENGTH else text[: MAX_FAULT_LENGTH - 3] + "..."


def _numbers(matches: Iterable[Played]) -> str:
    first, *others = (played.match.number for played in matches)
    return f"match {first}" + (f" and {counted(len(others), 'other')}" if others else "")


def _notes(tournament: Tournament) -> str:
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
    seeds = counted(len(same[0]), "seed")
    if len(same) == len(several):
        return f"The {seeds} gave the same match in each pairing: nothing in it is random."
    which = [" against ".join(found[0].match.laws.values()) for found in same[:3]]
    more = f" and {counted(len(same) - 3, 'other')}" if len(same) > 3 else ""
    return (
        f"The {seeds} gave the same match, since nothing in it is random: {', '.join(which)}{more}."
    )
