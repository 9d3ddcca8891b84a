"""A tournament as text for a terminal: standings, who beat whom, faults."""

from __future__ import annotations

from mars2d.core.errors import one_line
from mars2d.core.terminal import aligned
from mars2d.tournaments.league import UNPROTECTED, Tournament, league_tables, matches_of

MAX_WIDTH = 100
"""The greatest width of the table of pairings; a wider one is only on the page."""

MAX_FAULT_LENGTH = 400
"""The greatest length of the text about a group's faults."""


def league_text(tournament: Tournament) -> str:
    """Return the league tables, the table of who beat whom, and notes on faults."""
    told = []
    for standings, rows in league_tables(tournament):
        header = ["", standings[0].role or "law", *[*rows[0]][2:]]
        told.append("\n".join(aligned([header, *([*row.values()] for row in rows)], left=2)))
    told += [part(tournament) for part in (_pairings, _faults)]
    told.append(f"Isolation: {UNPROTECTED}" if tournament.unprotected else "")
    return "\n\n".join(filter(None, told))


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
    table = aligned([(f"{first} \\ {second}", *columns), *rows], left=1)
    return "\n".join([title, *table]) if max(map(len, table)) <= MAX_WIDTH else ""


def _faults(tournament: Tournament) -> str:
    """Return a line for each group that has forfeited matches, and one if some have no result."""
    lines = [
        f"{row['group']} forfeits: {row['reasons']}"
        for row in tournament.table("grades")
        if row["forfeits"]
    ]
    if failed := [played for played in tournament.matches if played.error]:
        first = f"first match {failed[0].match.number}: {failed[0].error}"
        lines.append(f"{matches_of(len(failed))} without a result, {first}")
    return "\n".join(one_line(line, MAX_FAULT_LENGTH) for line in lines)
