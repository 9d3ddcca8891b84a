"""Who beat whom: the share of each law's points against each other one, as a coloured table."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mars2d.output.raster.theme import DARK, LIGHT, mixed
from mars2d.study.tournament.league import DRAW, WIN, is_draw
from mars2d.study.tournament.page.facts import laws_of
from mars2d.study.tournament.page.text import DASH, escaped, named

if TYPE_CHECKING:
    from mars2d.study.tournament.match import Played
    from mars2d.study.tournament.tournament import Tournament

__all__ = ["matrix", "shades"]

LOST, WON = "#d55e00", "#0072b2"
"""The colours of no point and of all points, which the colour-blind tell apart as well."""

STEPS, STRENGTH = 10, 0.55
"""How many colours lie between them, and how far they are from that of paper."""


def matrix(tournament: Tournament) -> str:
    """Return the table of shares; each cell is a button that picks its matches."""
    first, second = tournament.roles
    every = laws_of(tournament, first, second)
    rows, columns = laws_of(tournament, first), laws_of(tournament, second)
    swapped = not set(rows).isdisjoint(columns)
    if swapped:
        rows = columns = every
    shares = _shares(tournament, swapped=swapped)
    head = "".join(f'<th scope="col">{_cut(law)}</th>' for law in columns)
    lines = []
    for row in rows:
        cells = [_cell(row, column, shares.get((row, column)), every) for column in columns]
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
        for step in range(STEPS + 1):
            share = 2 * step / STEPS - 1
            color = mixed(WON if share > 0 else LOST, theme.paper, STRENGTH * abs(share))
            lines.append(f"{root} .s{step} {{ background: {color}; }}")
    return "\n".join(lines) + "\n"


def _shares(tournament: Tournament, *, swapped: bool) -> dict[tuple[str, str], list[float]]:
    """Return the points of each match between two laws, by the one whose they are and the other."""
    first, second = tournament.roles
    found: dict[tuple[str, str], list[float]] = {}
    for played in tournament.matches:
        if played.error:
            continue
        one, other = (played.match.laws[role] for role in (first, second))
        found.setdefault((one, other), []).append(_points(played, first))
        if swapped:
            found.setdefault((other, one), []).append(_points(played, second))
    return found


def _points(played: Played, role: str) -> float:
    return WIN * (played.winner == role) + DRAW * is_draw(played)


def _cut(law: str) -> str:
    """Return a name whose end is left out where it is long, until it is pointed at."""
    return f'<span title="{escaped(law)}">{named(law)}</span>'


def _cell(row: str, column: str, points: list[float] | None, laws: tuple[str, ...]) -> str:
    if not points:
        return f'<td class="none">{DASH}</td>'
    share = sum(points) / len(points) / WIN
    title = f"{row} against {column}: {100 * share:.0f} % of the points in {len(points)}"
    title += " match" if len(points) == 1 else " matches"
    return (
        f'<td><button class="s{round(share * STEPS)}" data-law="{laws.index(row)}" '
        f'data-rival="{laws.index(column)}" title="{escaped(title)}" '
        f'aria-label="{escaped(title)}">{100 * share:.0f}</button></td>'
    )
