"""A tournament as one HTML page: league table, who beat whom, and a replay of each match."""

from __future__ import annotations

import json
from itertools import accumulate
from pathlib import Path

from mars2d.core.errors import one_line
from mars2d.core.files import atomic_write
from mars2d.output.pages.replay import filled, look, player
from mars2d.scenario.options import options_in_words
from mars2d.tournaments.league import UNPROTECTED, Tournament
from mars2d.tournaments.page.tables import (
    choices,
    grades,
    match_table,
    matrix,
    standing_tables,
)
from mars2d.tournaments.page.words import escaped, read, terms

__all__ = ["MAX_REPLAYS_SIZE", "league_page", "save_page"]

MAX_REPLAYS_SIZE = 40_000_000
"""How many characters the replays of a page may have; a larger page is slow to load."""


def league_page(tournament: Tournament) -> str:
    """Return a tournament as the text of an HTML file; equal tournaments give equal texts.

    From the first replay on that would exceed `MAX_REPLAYS_SIZE`, replays are left out; the page
    says so.
    """
    replays = {each.match.number: each.replay for each in tournament.matches if each.replay}
    sizes = accumulate(len(replay) for replay in replays.values())
    kept = sum(size <= MAX_REPLAYS_SIZE for size in sizes)
    inside, title = read("inside.js"), tournament.schedule.title
    words = {
        "title": escaped(title),
        "style": look() + read("page.css"),
        "script": f"(() => {{\n{read('league.js')}}})();",
        "facts": terms(_facts(tournament, [*replays][kept:])),
        "standings": standing_tables(tournament),
        "grades": grades(tournament),
        "matrix": matrix(tournament),
        "choices": choices(tournament),
        "matches": match_table(tournament),
        "player": _player(one_line(title), inside),
        "replays": "\n".join(
            f'<script id="replay-{number}" type="text/plain">{escaped(replay)}</script>'
            for number, replay in [*replays.items()][:kept]
        ),
    }
    return filled(read("league.html"), words)


def save_page(page: str, path: Path) -> None:
    """Write a page to a file. Raises InputError if it can't be written."""
    with atomic_write(path) as file:
        file.write(page.encode("utf-8", errors="replace"))


def _player(title: str, inside: str) -> str:
    """Return the page that plays a replay, as JSON: the parts before and after its data."""
    return json.dumps(player(title, "\0", inside).split("\0")).replace("<", "\\u003c")


def _facts(tournament: Tournament, left_out: list[int]) -> dict[str, str]:
    """Return the facts about a tournament; left_out: the matches without their replays."""
    schedule, matches = tournament.schedule, tournament.matches
    laws = [tournament.laws(role) for role in schedule.roles]
    playing = [f"{len(each)} as {role}" for each, role in zip(laws, schedule.roles, strict=True)]
    seeds = sorted({played.match.seed for played in matches})
    in_a_row = len(seeds) > 2 and seeds[-1] - seeds[0] == len(seeds) - 1
    failed = {
        "forfeited": sum(bool(played.verdicts) for played in matches),
        "without a result": sum(bool(played.error) for played in matches),
    }
    first = f"from match {left_out[0]} on: with them this page would be" if left_out else ""
    return {
        "Experiment": Path(schedule.experiment).name,
        "Laws": ", ".join(playing),
        "Options": options_in_words(schedule.matches[0].options),
        "Seeds": f"{seeds[0]} to {seeds[-1]}" if in_a_row else ", ".join(map(str, seeds)),
        "Matches": ", ".join(
            [str(len(matches)), *(f"{count} {what}" for what, count in failed.items() if count)]
        ),
        "Isolation": UNPROTECTED if tournament.unprotected else "",
        "Replays": f"{len(left_out)} are left out, {first} too large" if left_out else "",
    }
