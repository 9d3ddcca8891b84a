"""The league table of a tournament's page, one for each role that has laws of its own."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from math import isfinite
from typing import TYPE_CHECKING

from mars2d.study.tournament.page.text import DASH, escaped, named, time_cell

if TYPE_CHECKING:
    from mars2d.study.tournament.league import Standing
    from mars2d.study.tournament.tournament import Tournament

__all__ = ["header", "standing_tables"]

SORTED = ' aria-sort="ascending"'
COLUMNS = (
    "Place", "Law", "Points", "Share of points", "Played", "Won", "Drawn", "Lost", "Forfeits",
    "Mean capture time",
)  # fmt: skip


def standing_tables(tournament: Tournament) -> str:
    """Return a table for each role, or one for all laws."""
    return "\n".join(
        _table(role, list(standings))
        for role, standings in groupby(tournament.standings, key=lambda standing: standing.role)
    )


def header(columns: Sequence[str]) -> str:
    """Return the first row of a table, whose columns can be sorted by; it is by the first."""
    cells = "".join(
        f'<th scope="col"{SORTED if at == 0 else ""}>'
        f'<button class="sort">{escaped(column)}</button></th>'
        for at, column in enumerate(columns)
    )
    return f"<thead><tr>{cells}</tr></thead>"


def _table(role: str, standings: list[Standing]) -> str:
    caption = f"As {escaped(role)}" if role else "All laws"
    rows = "\n".join(_row(place, standing) for place, standing in enumerate(standings, 1))
    return (
        f'<div class="wide" role="region" tabindex="0" aria-label="League table: {caption}">\n'
        f'<table class="league"><caption>{caption}</caption>\n{header(COLUMNS)}\n'
        f"<tbody>\n{rows}\n</tbody></table></div>"
    )


def _row(place: int, standing: Standing) -> str:
    mean = standing.share.mean
    cells = [
        f"<td>{place}</td>",
        f'<th scope="row">{named(standing.law)}</th>',
        f'<td class="points">{standing.points:g}</td>',
        f'<td data-value="{mean:.9g}" class="share">{_share(standing)}</td>',
        f"<td>{standing.played}</td>",
        f"<td>{standing.won}</td>",
        f"<td>{standing.drawn}</td>",
        f"<td>{standing.lost}</td>",
        f"<td{' class=bad' if standing.forfeits else ''}>{standing.forfeits}</td>",
        time_cell(standing.capture_time, 1),
    ]
    return f"<tr>{''.join(cells)}</tr>"


def _share(standing: Standing) -> str:
    """Return a share with its interval, as a small bar and in words."""
    share = standing.share
    mean, low, high = (100 * value for value in (share.mean, share.low, share.high))
    if not isfinite(mean):
        return DASH
    words = f"{mean:.0f}&nbsp;%"
    if not isfinite(low + high):
        return f"<span>{words}</span>"
    low, high = max(low, 0.0), min(high, 100.0)
    middle = min(max(mean - 1, 0.0), 98.0)
    bar = (
        '<svg viewBox="0 0 100 12" preserveAspectRatio="none" aria-hidden="true">'
        '<rect class="track" x="0" y="5" width="100" height="2"/>'
        '<rect class="half" x="49.75" y="1" width="0.5" height="10"/>'
        f'<rect class="interval" x="{low:.1f}" y="3" width="{high - low:.1f}" height="6"/>'
        f'<rect class="mean" x="{middle:.1f}" y="0" width="2" height="12"/></svg>'
    )
    return f"{bar}<span>{words}</span> <small>{low:.0f} to {high:.0f}</small>"
