"""Words on a tournament's page: its facts, and text that may come from anybody.

Names of files, messages and everything that a law prints must not break the page, so they are
cleaned and escaped here.
"""

from __future__ import annotations

import html
import re
from collections.abc import Iterable, Mapping
from functools import cache
from importlib.resources import files
from itertools import compress
from math import isfinite
from pathlib import Path
from typing import Any

from mars2d.core.errors import counted
from mars2d.tournaments.league import UNPROTECTED, Tournament
from mars2d.tournaments.match import Match

DASH = "\N{EN DASH}"
"""Shown in place of missing values."""

UNFIT = re.compile("[\0-\x08\x0b-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")
"""Characters that a page can't hold or show: control characters and lone surrogates."""


@cache
def read(name: str) -> str:
    """Return a template, script or style of this folder."""
    return files(__package__).joinpath(name).read_text(encoding="utf-8")


def clean(text: object) -> str:
    r"""Return text with a replacement character for each one that a page can't show.

    >>> clean("a\x00b\r\n")
    'a\ufffdb\n'
    """
    return UNFIT.sub("\ufffd", str(text).replace("\r\n", "\n"))


def escaped(text: object) -> str:
    """Return text that a page shows as it is, also inside quoted attributes.

    >>> escaped("<script>")
    '&lt;script&gt;'
    """
    return html.escape(clean(text))


def named(name: object) -> str:
    """Return a name as an element with a writing direction of its own."""
    return f"<bdi>{escaped(name)}</bdi>"


def time_cell(value: float | None, digits: int) -> str:
    """Return a table cell with a time in seconds, or with a dash if there is none.

    >>> time_cell(2.5, 1)
    '<td data-value="2.5">2.5 s</td>'
    """
    if value is None or not isfinite(value):
        return f"<td>{DASH}</td>"
    return f'<td data-value="{value:.9g}">{value:.{digits}f} s</td>'


# -- facts -----------------------------------------------------------------------------------------


def facts(tournament: Tournament, kept: int) -> str:
    """Return the facts about a tournament as a list of terms and descriptions.

    kept: how many matches, from the first, have replays on the page.
    """
    matches = tournament.matches
    rounds, always = rounds_of(tournament), _always(tournament)
    forfeits = sum(bool(played.verdicts) for played in matches)
    failed = sum(bool(played.error) for played in matches)
    counts = [str(len(matches)), counted(forfeits, "forfeit"), f"{failed} without a result"]
    found = {
        "Experiment": Path(tournament.experiment).name,
        "Laws": _laws(tournament),
        "Rounds": "; ".join(rounds) if len(rounds) > 1 else "",
        "Settings": always if len(rounds) > 1 else ", ".join(filter(None, (*rounds, always))),
        "Seeds": _numbers(played.match.seed for played in matches),
        "Matches": ", ".join(compress(counts, (True, forfeits, failed))),
    }
    if tournament.unprotected:
        found["Isolation"] = UNPROTECTED
    left = sum(bool(played.replay) for played in matches[kept:])
    if left:
        found["Replays"] = (
            f"{left} are left out, from match {matches[kept].match.number} on: with them this page "
            "would be too large"
        )
    return "\n".join(
        f"<div><dt>{term}</dt><dd>{escaped(what)}</dd></div>"
        for term, what in found.items()
        if what
    )


def laws_of(tournament: Tournament, *roles: str) -> tuple[str, ...]:
    """Return the laws that play any of these roles, best first."""
    playing = {played.match.laws[role] for played in tournament.matches for role in roles}
    ranked = dict.fromkeys(standing.law for standing in tournament.standings)
    return tuple(law for law in ranked if law in playing)


def rounds_of(tournament: Tournament) -> tuple[str, ...]:
    """Return the names of the rounds, in order."""
    return tuple(dict.fromkeys(round_of(tournament, played.match) for played in tournament.matches))


def round_of(tournament: Tournament, match: Match) -> str:
    """Return the name of a match's round: the settings in which rounds differ."""
    return _said({name: match.options.get(name) for name in tournament.settings})


def _always(tournament: Tournament) -> str:
    """Return the options that all rounds share."""
    options = tournament.matches[0].match.options if tournament.matches else {}
    return _said({name: options[name] for name in options if name not in tournament.settings})


def _said(options: Mapping[str, Any]) -> str:
    r"""Return options as text, without line breaks inside of one.

    >>> _said({"mu": 0.9, "n": 2})
    'mu\xa0=\xa00.9, n\xa0=\xa02'
    """
    return ", ".join(f"{name}\xa0=\xa0{value}" for name, value in options.items())


def _laws(tournament: Tournament) -> str:
    """Say how many laws play each role."""
    groups = [laws_of(tournament, role) for role in tournament.roles]
    if set(groups[0]) == set(groups[1]):
        return f"{len(groups[0])}, each as {' and as '.join(tournament.roles)}"
    counts = (f"{len(laws)} as {role}" for laws, role in zip(groups, tournament.roles, strict=True))
    return ", ".join(counts)


def _numbers(values: Iterable[int]) -> str:
    """Return whole numbers as text; consecutive ones are given by the first and the last.

    >>> _numbers([3, 1, 2, 1])
    '1 to 3'
    """
    numbers = sorted(set(values))
    if len(numbers) > 2 and numbers[-1] - numbers[0] == len(numbers) - 1:
        return f"{numbers[0]} to {numbers[-1]}"
    return ", ".join(map(str, numbers))
