"""Tables on a tournament's page: the standings, the grades, who beat whom, and all matches."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from mars2d.tournaments.league import Standing, Tournament, league_tables, matches_of
from mars2d.tournaments.match import Played
from mars2d.tournaments.page.words import dots, escaped, named

NONE = "-"
"""Shown in place of missing values."""


def table(
    kind: str,
    label: str,
    columns: Mapping[str, str],
    rows: Iterable[Sequence[str]],
    title: str = "",
) -> str:
    """Return a table that can be sorted by its columns; it is by the first.

    columns: the kinds of each column's cells, by its heading: "head" names the row, "number" is
    flush right. rows: their cells, HTML. title: above it, HTML.
    """
    by_first = iter([' aria-sort="ascending"'])
    head = "".join(
        f'<th scope="col" class="{each}"{next(by_first, "")}>'
        f'<button class="sort">{escaped(heading)}</button></th>'
        for heading, each in columns.items()
    )
    lines = []
    for row in rows:
        cells = (
            f'<th scope="row" class="{each}">{text}</th>'
            if each == "head"
            else f'<td class="{each}">{text}</td>'
            for text, each in zip(row, columns.values(), strict=True)
        )
        lines.append(f"<tr>{''.join(cells)}</tr>")
    body = "\n".join(lines)
    caption = f"<caption>{title}</caption>" if title else ""
    return (
        f'<div class="wide" role="region" tabindex="0" aria-label="{label}">'
        f'<table class="{kind}" aria-label="{label}">{caption}\n'
        f"<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody></table></div>"
    )


def standing_tables(tournament: Tournament) -> str:
    """Return a league table for each role, or one for all laws."""
    kinds = {"law": "head", "points": "number points", "share (95 %)": "share"}
    tables = []
    for standings, rows in league_tables(tournament):
        for standing, cells in zip(standings, rows, strict=True):
            cells["law"] = named(standing.law)
            cells["share (95 %)"] = f"{_bar(standing)} {cells['share (95 %)']}"
            if standing.forfeits:
                cells["forfeits"] = _forfeits(standing.forfeits)
        role, columns = standings[0].role, {name: kinds.get(name, "number") for name in rows[0]}
        label = f"As {escaped(role)}" if role else "All laws"
        title = dots(tournament.schedule.colors[role]) + label if role else label
        lines = [[*row.values()] for row in rows]
        tables.append(table("league", label, columns, lines, title))
    return "\n".join(tables)


def _forfeits(count: int) -> str:
    return f'<b class="bad">{count}</b>' if count else "0"


def _bar(standing: Standing) -> str:
    """Return a law's share of the points with its interval as a small bar."""
    if not standing.played:
        return ""
    low, high = 100 * standing.share_low, 100 * standing.share_high
    middle = min(max(100 * standing.share - 1, 0.0), 98.0)
    return (
        '<svg viewBox="0 0 100 12" preserveAspectRatio="none" aria-hidden="true">'
        '<rect class="track" x="0" y="5" width="100" height="2"/>'
        '<rect class="half" x="49.75" y="1" width="0.5" height="10"/>'
        f'<rect class="interval" x="{low:.1f}" y="3" width="{high - low:.1f}" height="6"/>'
        f'<rect class="mean" x="{middle:.1f}" y="0" width="2" height="12"/></svg>'
    )


def grades(tournament: Tournament) -> str:
    """Return the table of all groups, with what each needs for its grade."""
    columns = {
        "group": "head", "matches": "number", "points": "number points", "Elo": "number",
        "forfeits": "number", "reasons": "ending",
    }  # fmt: skip
    rows = [
        (
            named(row["group"]),
            f"{row['matches']}",
            f"{row['points']:g}",
            f"{row['elo']}",
            _forfeits(row["forfeits"]),
            escaped(row["reasons"]),
        )
        for row in tournament.table("grades")
    ]
    return table("grades", "Grading sheet", columns, rows)


# -- who beat whom ---------------------------------------------------------------------------------

STRENGTH = 110
"""How strong colours are, per cent for a share that is 1 from a half."""


def matrix(tournament: Tournament) -> str:
    """Return the table of shares; each cell is a button that selects its matches."""
    points = tournament.head_to_head()
    columns = [*next(iter(points.values()), ())]
    of, to = (f" as {escaped(role)}" for role in tournament.schedule.roles)
    if {*points} & {*columns}:
        of = to = ""
    head = "".join(f'<th scope="col">{_cut(law)}</th>' for law in columns)
    body = "\n".join(
        f'<tr><th scope="row">{_cut(law)}</th>'
        + "".join(_share_cell(law, rival, taken) for rival, taken in rivals.items())
        + "</tr>"
        for law, rivals in points.items()
    )
    return (
        f'<p class="note">Share of the points that the row\'s law{of} took from the '
        f"column's{to}, in %. Pick one to see its matches.</p>\n"
        '<div class="wide" role="region" tabindex="0" aria-label="Who beat whom">'
        '<table class="matrix" aria-label="Who beat whom">\n'
        f"<thead><tr><td></td>{head}</tr></thead>\n<tbody>\n{body}\n</tbody></table></div>"
    )


def _cut(law: str) -> str:
    """Return a name that the page shortens if it is long; its title shows all of it."""
    return f'<span title="{escaped(law)}">{named(law)}</span>'


def _share_cell(law: str, rival: str, points: Sequence[float]) -> str:
    if not points:
        return f'<td class="none">{NONE}</td>'
    share = sum(points) / len(points)
    title = f"{law} against {rival}: {100 * share:.0f} % of the points in {matches_of(len(points))}"
    return (
        f'<td><button style="--side: var(--{"won" if share > 0.5 else "lost"}); '
        f'--strength: {STRENGTH * abs(share - 0.5):.0f}%" data-law="{escaped(law)}" '
        f'data-rival="{escaped(rival)}" title="{escaped(title)}" aria-label="{escaped(title)}">'
        f"{100 * share:.0f}</button></td>"
    )


# -- matches ---------------------------------------------------------------------------------------

WATCH = '<button class="watch" aria-haspopup="dialog">{}</button>'

MAX_PRINTED = 4000
"""How many characters of a law's output are shown, from its end."""


def match_table(tournament: Tournament) -> str:
    """Return the table of all matches, each with a button for its replay."""
    schedule = tournament.schedule
    columns = {
        "match": "head", "seed": "seed number", **dict.fromkeys(schedule.roles, "player"),
        "winner": "winner", "free for": "time number", "how it ended": "ending",
    }  # fmt: skip
    rows = []
    for played in tournament.matches:
        cells = {
            "match": WATCH.format(played.match.number),
            "seed": str(played.match.seed),
            "winner": _winner(played),
            "free for": NONE if (t := played.payoff) is None else f"{t:.2f} s",
            "how it ended": _ending(played),
        }
        for role, law in played.match.laws.items():
            won = f"<b>{named(law)}</b>" if role == played.winner else named(law)
            cells[role] = dots(schedule.colors[role]) + won
        rows.append([cells[name] for name in columns])
    return table("matches", "All matches", columns, rows)


def choices(tournament: Tournament) -> str:
    """Return the lists for choosing matches by laws."""
    laws = tournament.laws(*tournament.schedule.roles)
    every = "".join(f'<option value="{escaped(e)}">{escaped(e)}</option>' for e in laws)
    return "\n".join(
        f'<label>{words} <select id="{words.lower()}"><option value="">all</option>{every}'
        "</select></label>"
        for words in ("Law", "against")
    )


def _winner(played: Played) -> str:
    if played.winner is not None:
        return named(played.match.laws[played.winner])
    if played.error:
        return "no result"
    return "nobody" if played.verdicts else "draw"


def _ending(played: Played) -> str:
    """Return how a match ended, with what laws printed that forfeited it."""
    badge = '<b class="forfeit">forfeit</b> ' if played.verdicts else ""
    printed = {role: played.output[role] for role in played.verdicts if role in played.output}
    return f"{badge}{escaped(played.message)}" + "".join(
        f"<template><h3>What {named(played.match.laws[role])} printed</h3>"
        f'<pre tabindex="0">{escaped(text[-MAX_PRINTED:])}</pre></template>'
        for role, text in printed.items()
    )
