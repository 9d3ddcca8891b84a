"""Tables on a tournament's page: the standings, who beat whom, and all matches."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from math import isfinite

from mars2d.core.errors import counted
from mars2d.output.raster.theme import DARK, LIGHT, mixed
from mars2d.tournaments.league import COUNTS, WIN, Standing, Tournament, matches_of, points_of
from mars2d.tournaments.match import Played
from mars2d.tournaments.page.rules import dots
from mars2d.tournaments.page.words import (
    DASH,
    clean,
    escaped,
    laws_of,
    named,
    round_of,
    rounds_of,
    time_cell,
)
from mars2d.tournaments.rules import Rules

SORTED_BY = ' aria-sort="ascending"'
STANDING_COLUMNS = (
    *("Place", "Law", "Points", "Share of points"),
    *map(str.capitalize, COUNTS),
    "Mean capture time",
)


def standing_tables(tournament: Tournament) -> str:
    """Return a league table for each role, or one for all laws."""
    return "\n".join(
        _standing_table(role, list(standings), tournament.rules)
        for role, standings in groupby(tournament.standings, key=lambda standing: standing.role)
    )


def header(columns: Sequence[str]) -> str:
    """Return the header of a table that can be sorted by its columns; it is by the first."""
    cells = "".join(
        f'<th scope="col"{SORTED_BY if at == 0 else ""}>'
        f'<button class="sort">{escaped(column)}</button></th>'
        for at, column in enumerate(columns)
    )
    return f"<thead><tr>{cells}</tr></thead>"


def _standing_table(role: str, standings: list[Standing], rules: Rules | None) -> str:
    caption = f"As {escaped(role)}" if role else "All laws"
    colored = f"{dots(rules, role)} {caption}" if role else caption
    rows = "\n".join(_standing_row(standing) for standing in standings)
    return (
        f'<div class="wide" role="region" tabindex="0" aria-label="League table: {caption}">\n'
        f'<table class="league"><caption>{colored}</caption>\n{header(STANDING_COLUMNS)}\n'
        f"<tbody>\n{rows}\n</tbody></table></div>"
    )


def _standing_row(standing: Standing) -> str:
    mean = standing.share.mean
    cells = [
        f"<td>{standing.place}</td>",
        f'<th scope="row">{named(standing.law)}</th>',
        f'<td class="points">{standing.points:g}</td>',
        f'<td data-value="{mean:.9g}" class="share">{_share(standing)}</td>',
        *(f"<td>{getattr(standing, name)}</td>" for name in COUNTS[:-1]),
        _forfeits(standing.forfeits),
        time_cell(standing.capture_time, 1),
    ]
    return f"<tr>{''.join(cells)}</tr>"


def _forfeits(count: int) -> str:
    return f"<td{' class=bad' if count else ''}>{count}</td>"


def _share(standing: Standing) -> str:
    """Return a share with its interval, as a small bar and as text."""
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


def grades(tournament: Tournament) -> str:
    """Return the table of all groups, with what each needs for its grade."""
    rows = "\n".join(
        f'<tr><th scope="row">{named(row["group"])}</th><td>{row["matches"]}</td>'
        f'<td class="points">{row["points"]:g}</td>{_forfeits(row["forfeits"])}'
        f'<td class="ending">{escaped(row["reasons"])}</td></tr>'
        for row in tournament.grade_rows()
    )
    columns = ("Group", "Matches", "Points", "Forfeits", "Reasons")
    return (
        f'<table class="grades"><caption class="unseen">Grading sheet</caption>\n'
        f"{header(columns)}\n<tbody>\n{rows}\n</tbody></table>"
    )


# -- who beat whom ---------------------------------------------------------------------------------

LOST_COLOR, WON_COLOR = "#d55e00", "#0072b2"
"""The colours for no points and all points, which colour-blind people can distinguish."""

COLOR_STEPS, COLOR_STRENGTH = 10, 0.55
"""The number of steps between these colours, and their distance from the paper's colour."""


def matrix(tournament: Tournament) -> str:
    """Return the table of shares; each cell is a button that selects its matches."""
    first, second = tournament.roles
    every = laws_of(tournament, first, second)
    rows, columns = laws_of(tournament, first), laws_of(tournament, second)
    swapped = not set(rows).isdisjoint(columns)
    if swapped:
        rows = columns = every
    shares = _match_points(tournament, swapped=swapped)
    head = "".join(f'<th scope="col">{_cut(law)}</th>' for law in columns)
    lines = []
    for row in rows:
        cells = [_share_cell(row, column, shares.get((row, column)), every) for column in columns]
        lines.append(f'<tr><th scope="row">{_cut(row)}</th>{"".join(cells)}</tr>')
    of, to = ("", "") if swapped else (f" as {escaped(first)}", f" as {escaped(second)}")
    body = "\n".join(lines)
    return (
        f'<p class="note" id="shares">Share of the points that the row\'s law{of} took from the '
        f"column's{to}, in %. Pick one to see its matches.</p>\n"
        '<div class="wide" role="region" tabindex="0" aria-labelledby="matrixTitle">\n'
        '<table class="matrix" aria-describedby="shares">'
        '<caption class="unseen">Who beat whom</caption>\n'
        f"<thead><tr><td></td>{head}</tr></thead>\n<tbody>\n{body}\n</tbody></table></div>"
    )


def shades() -> str:
    """Return the colours of the shares as CSS, for the light and the dark theme."""
    lines = []
    for root, theme in ((":root", LIGHT), (":root.dark", DARK)):
        for step in range(COLOR_STEPS + 1):
            share = 2 * step / COLOR_STEPS - 1
            color = mixed(
                WON_COLOR if share > 0 else LOST_COLOR, theme.paper, COLOR_STRENGTH * abs(share)
            )
            lines.append(f"{root} .s{step} {{ background: {color}; }}")
    return "\n".join(lines) + "\n"


def _match_points(tournament: Tournament, *, swapped: bool) -> dict[tuple[str, str], list[float]]:
    """Return the points that a law took in each match, by (law, opponent)."""
    first, second = tournament.roles
    found: dict[tuple[str, str], list[float]] = {}
    for played in tournament.matches:
        if played.error:
            continue
        one, other = (played.match.laws[role] for role in (first, second))
        found.setdefault((one, other), []).append(points_of(played, first))
        if swapped:
            found.setdefault((other, one), []).append(points_of(played, second))
    return found


def _cut(law: str) -> str:
    """Return a name that the page shortens if it is long; its title shows all of it."""
    return f'<span title="{escaped(law)}">{named(law)}</span>'


def _share_cell(row: str, column: str, points: list[float] | None, laws: tuple[str, ...]) -> str:
    if not points:
        return f'<td class="none">{DASH}</td>'
    share = sum(points) / len(points) / WIN
    title = f"{row} against {column}: {100 * share:.0f} % of the points in "
    title += matches_of(len(points))
    return (
        f'<td><button class="s{round(share * COLOR_STEPS)}" data-law="{laws.index(row)}" '
        f'data-rival="{laws.index(column)}" title="{escaped(title)}" '
        f'aria-label="{escaped(title)}">{100 * share:.0f}</button></td>'
    )


# -- matches ---------------------------------------------------------------------------------------

WATCH = '<button class="watch" aria-haspopup="dialog">'

MAX_EXCERPT = 2000
"""How many characters of a law's output are shown from its beginning, and from its end."""


def match_table(tournament: Tournament, kept: int) -> str:
    """Return the table of all matches, each with a button for its replay.

    kept: how many matches, from the first, have replays on the page.
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
            f'<td data-value="{which}">{escaped(rounds[which])}</td>'
            f"{_cells(played, tournament.rules, roles)}</tr>"
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
    """Return the lists for choosing matches by laws and rounds."""
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
    """Return the output of laws that forfeited, to be shown beside the replay."""
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


def _cells(played: Played, rules: Rules | None, roles: Sequence[str]) -> str:
    """Return the cells of a match from its seed on."""
    cells = [f"<td>{played.match.seed}</td>"]
    for role in roles:
        law = named(played.match.laws[role])
        won = ' class="won"' if played.winner == role else ""
        cells.append(f'<td{won} data-role="{escaped(role)}">{dots(rules, role)}{law}</td>')
    cells.append(f"<td>{_winner(played)}</td>")
    cells.append(time_cell(played.capture_time, 2))
    badge = '<b class="forfeit">forfeit</b> ' if played.verdicts else ""
    cells.append(f'<td class="ending">{badge}{escaped(played.message)}</td>')
    return "".join(cells)


def _without(played: Played, kept: bool) -> str:
    """Say why a match has no replay; empty if it has one."""
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


def _excerpt(printed: str) -> str:
    """Return the beginning and the end of a long text."""
    left = len(printed) - 2 * MAX_EXCERPT
    if left <= 0:
        return printed
    between = f"\n[... {counted(left, 'character')} left out ...]\n"
    return clean(printed[:MAX_EXCERPT]) + between + printed[-MAX_EXCERPT:]
