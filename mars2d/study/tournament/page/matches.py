"""The matches of a tournament's page: a table of all, and what is told beside a replay."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from mars2d.core.errors import counted
from mars2d.study.tournament.page.facts import laws_of, round_of, rounds_of
from mars2d.study.tournament.page.standings import header
from mars2d.study.tournament.page.text import clean, escaped, named, time_cell

if TYPE_CHECKING:
    from mars2d.study.tournament.match import Played
    from mars2d.study.tournament.tournament import Tournament

__all__ = ["choices", "details", "match_table"]

WATCH = '<button class="watch" aria-haspopup="dialog">'

PRINTED = 2000
"""So many characters of what a law printed are shown from its beginning, and from its end."""


def match_table(tournament: Tournament, kept: int) -> str:
    """Return the table of all matches, each with a button for its replay.

    kept: of how many matches, from the first, the page has replays.
    """
    roles, rounds = tournament.roles, rounds_of(tournament)
    laws = {law: k for k, law in enumerate(laws_of(tournament, *roles))}
    rows = []
    for at, played in enumerate(tournament.matches):
        which = rounds.index(round_of(tournament, played.match))
        rivals = " ".join(str(laws[played.match.laws[role]]) for role in roles)
        start = ", ".join(filter(None, (f"seed {played.match.seed}", rounds[which])))
        rows.append(
            f'<tr data-match="{played.match.number}" data-laws="{rivals}" data-round="{which}" '
            f'data-start="{escaped(start)}" data-without="{_without(played, at < kept)}"'
            f"{' data-forfeit' if played.verdicts else ''}>"
            f'<th scope="row">{WATCH}{played.match.number}</button></th>'
            f'<td data-value="{which}">{escaped(rounds[which])}</td>{_cells(played, roles)}</tr>'
        )
    names = [role[:1].upper() + role[1:] for role in roles]
    columns = ("Match", "Round", "Seed", *names, "Winner", "Capture time", "How it ended")
    kind = "matches" if len(rounds) > 1 else "matches one-round"
    body = "\n".join(rows)
    return (
        f'<table class="{kind}"><caption class="unseen">All matches</caption>\n'
        f"{header(columns)}\n<tbody>\n{body}\n</tbody></table>"
    )


def choices(tournament: Tournament) -> str:
    """Return the lists that choose matches by their laws and rounds."""
    laws, rounds = laws_of(tournament, *tournament.roles), rounds_of(tournament)
    lists = [("law", "Law", "all", laws), ("rival", "against", "all", laws)]
    if len(rounds) > 1:
        lists.append(("round", "Round", "all", rounds))
    return "\n".join(
        f'<label>{words} <select id="{name}"><option value="">{every}</option>'
        + "".join(f'<option value="{k}">{escaped(each)}</option>' for k, each in enumerate(values))
        + "</select></label>"
        for name, words, every, values in lists
    )


def details(tournament: Tournament) -> str:
    """Return what laws that have forfeited printed, to be shown beside the replay."""
    found = []
    for played in tournament.matches:
        for role in played.verdicts:
            printed = played.output.get(role, "")
            if printed:
                law = named(played.match.laws[role])
                found.append(
                    f'<template data-match="{played.match.number}"><h3>What {law} printed</h3>'
                    f'<pre tabindex="0">{escaped(_excerpt(printed))}</pre></template>'
                )
    return "\n".join(found)


def _cells(played: Played, roles: Sequence[str]) -> str:
    """Return the cells of a match from its seed on."""
    cells = [f"<td>{played.match.seed}</td>"]
    for role in roles:
        won = ' class="won"' if played.winner == role else ""
        cells.append(f'<td{won} data-role="{escaped(role)}">{named(played.match.laws[role])}</td>')
    cells.append(f"<td>{_winner(played)}</td>")
    cells.append(time_cell(played.capture_time, 2))
    cells.append(f'<td class="ending">{_ending(played)}</td>')
    return "".join(cells)


def _without(played: Played, kept: bool) -> str:
    """Return why there is no replay, if there is none."""
    if played.replay:
        return "" if kept else "This replay is left out: with it this page would be too large."
    if played.error or not played.steps:
        return "There is no replay: the match was over before it began."
    return "There is no replay: none was kept of this match."


def _winner(played: Played) -> str:
    if played.winner is not None:
        return named(played.match.laws[played.winner])
    if played.error:
        return "no result"
    return "nobody" if played.verdicts else "draw"


def _ending(played: Played) -> str:
    badge = '<b class="forfeit">forfeit</b> ' if played.verdicts else ""
    return badge + escaped(played.message)


def _excerpt(printed: str) -> str:
    """Return the beginning and the end of a long text."""
    left = len(printed) - 2 * PRINTED
    if left <= 0:
        return printed
    between = f"\n[... {counted(left, 'character')} left out ...]\n"
    return clean(printed[:PRINTED]) + between + printed[-PRINTED:]
