"""A tournament as one HTML page: its table, who beat whom, and a replay of each match."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Sequence
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING

from mars2d.output.pages.replay import page_script, page_style, player, replay_data
from mars2d.output.pages.replay.template import colors, filled, policy
from mars2d.study.tournament.page.facts import facts
from mars2d.study.tournament.page.matches import choices, details, match_table
from mars2d.study.tournament.page.matrix import matrix, shades
from mars2d.study.tournament.page.standings import standing_tables
from mars2d.study.tournament.page.text import clean, escaped

if TYPE_CHECKING:
    from mars2d.study.tournament.match import Played
    from mars2d.study.tournament.tournament import Tournament

__all__ = ["LARGEST", "league_page", "replay_data"]

LARGEST = 40_000_000
"""Characters of all replays of a page at most: a larger one is slow to load."""


def league_page(tournament: Tournament) -> str:
    """Return a tournament as the text of an HTML file, the same text for the same tournament.

    Replays are left out from the first one on that makes it larger than `LARGEST`, and it says so.
    """
    matches = tournament.matches
    kept = _kept(matches)
    script, style, inside = _read("league.js"), _style(), _read("inside.js")
    words = {
        "policy": policy([script, inside + page_script()], [style, page_style()]),
        "title": escaped(tournament.title),
        "style": style,
        "script": script,
        "facts": facts(tournament, kept),
        "standings": standing_tables(tournament),
        "matrix": matrix(tournament),
        "choices": choices(tournament),
        "matches": match_table(tournament, kept),
        "details": details(tournament),
        "player": _player(clean(tournament.title), inside),
        "replays": "\n".join(
            f'<script id="replay-{played.match.number}" type="text/plain">'
            f"{escaped(played.replay)}</script>"
            for played in matches[:kept]
            if played.replay
        ),
    }
    return filled(_read("league.html"), words)


def _kept(matches: Sequence[Played]) -> int:
    """Return the number of the first matches whose replays fit into a page."""
    size = 0
    for count, played in enumerate(matches):
        size += len(played.replay)
        if size > LARGEST:
            return count
    return len(matches)


def _player(title: str, inside: str) -> str:
    """Return the page that plays a replay, packed: what stands before its data, and what after."""
    parts = player(title, "\0", inside).split("\0")
    return " ".join(base64.b64encode(zlib.compress(part.encode(), 9)).decode() for part in parts)


def _style() -> str:
    return colors() + shades() + _read("league.css")


@cache
def _read(name: str) -> str:
    return files(__package__).joinpath(name).read_text(encoding="utf-8")
