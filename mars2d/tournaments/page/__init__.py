"""A tournament as one HTML page: league table, who beat whom, and a replay of each match."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Sequence
from pathlib import Path

from mars2d.core.files import atomic_write
from mars2d.output.pages.replay import colors, filled, page_script, page_style, player, policy
from mars2d.tournaments.league import Tournament
from mars2d.tournaments.match import Played
from mars2d.tournaments.page.rules import dot_style, rules_section
from mars2d.tournaments.page.tables import (
    choices,
    details,
    grades,
    match_table,
    matrix,
    shades,
    standing_tables,
)
from mars2d.tournaments.page.words import clean, escaped, facts, read

__all__ = ["MAX_REPLAYS_SIZE", "league_page", "save_html"]

MAX_REPLAYS_SIZE = 40_000_000
"""How many characters the replays of a page may have; a larger page is slow to load."""


def league_page(tournament: Tournament) -> str:
    """Return a tournament as the text of an HTML file; equal tournaments give equal texts.

    From the first replay on that would exceed `MAX_REPLAYS_SIZE`, replays are left out; the page
    says so.
    """
    matches = tournament.matches
    kept = _kept(matches)
    script, style, inside = read("league.js"), _style(tournament), read("inside.js")
    words = {
        "policy": policy([script, inside + page_script()], [style, page_style()]),
        "title": escaped(tournament.title),
        "style": style,
        "script": script,
        "facts": facts(tournament, kept),
        "standings": standing_tables(tournament),
        "grades": grades(tournament),
        "matrix": matrix(tournament),
        "choices": choices(tournament),
        "matches": match_table(tournament, kept),
        "details": details(tournament),
        "rules": "" if tournament.rules is None else rules_section(tournament.rules),
        "player": _player(clean(tournament.title), inside),
        "replays": "\n".join(
            f'<script id="replay-{played.match.number}" type="text/plain">'
            f"{escaped(played.replay)}</script>"
            for played in matches[:kept]
            if played.replay
        ),
    }
    return filled(read("league.html"), words)


def save_html(tournament: Tournament, path: Path) -> Path:
    """Write a tournament's page and return its path. Raises InputError if it can't be written."""
    with atomic_write(path) as file:
        file.write(league_page(tournament).encode("utf-8", errors="replace"))
    return path


def _kept(matches: Sequence[Played]) -> int:
    """Return how many matches, from the first, have replays that fit into a page."""
    size = 0
    for count, played in enumerate(matches):
        size += len(played.replay)
        if size > MAX_REPLAYS_SIZE:
            return count
    return len(matches)


def _player(title: str, inside: str) -> str:
    """Return the page that plays a replay, packed: the parts before and after its data."""
    parts = player(title, "\0", inside).split("\0")
    return " ".join(base64.b64encode(zlib.compress(part.encode(), 9)).decode() for part in parts)


def _style(tournament: Tournament) -> str:
    return colors() + shades() + dot_style(tournament.rules) + read("league.css")
