"""What was played: the lines under the title of a tournament's page."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import compress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mars2d.core.errors import counted
from mars2d.study.tournament.page.text import escaped

if TYPE_CHECKING:
    from mars2d.study.tournament.match import Match
    from mars2d.study.tournament.tournament import Tournament

__all__ = ["facts", "laws_of", "round_of", "rounds_of"]


def facts(tournament: Tournament, kept: int) -> str:
    """Return what was played, as terms and what they are.

    kept: of how many matches, from the first, the page has replays.
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
    """Return the laws that play one of these roles, best first."""
    playing = {played.match.laws[role] for played in tournament.matches for role in roles}
    ranked = dict.fromkeys(standing.law for standing in tournament.standings)
    return tuple(law for law in ranked if law in playing)


def rounds_of(tournament: Tournament) -> tuple[str, ...]:
    """Return the names of the rounds, in order."""
    return tuple(dict.fromkeys(round_of(tournament, played.match) for played in tournament.matches))


def round_of(tournament: Tournament, match: Match) -> str:
    """Return what the round of a match is called, by the settings that rounds differ in."""
    return _said({name: match.options.get(name) for name in tournament.settings})


def _always(tournament: Tournament) -> str:
    """Return the options that all rounds have."""
    options = tournament.matches[0].match.options if tournament.matches else {}
    return _said({name: options[name] for name in options if name not in tournament.settings})


def _said(options: Mapping[str, Any]) -> str:
    r"""Return options in words, each on one line.

    >>> _said({"mu": 0.9, "n": 2})
    'mu\xa0=\xa00.9, n\xa0=\xa02'
    """
    return ", ".join(f"{name}\xa0=\xa0{value}" for name, value in options.items())


def _laws(tournament: Tournament) -> str:
    """Return how many laws play each role."""
    groups = [laws_of(tournament, role) for role in tournament.roles]
    if set(groups[0]) == set(groups[1]):
        return f"{len(groups[0])}, each as {' and as '.join(tournament.roles)}"
    counts = (f"{len(laws)} as {role}" for laws, role in zip(groups, tournament.roles, strict=True))
    return ", ".join(counts)


def _numbers(values: Iterable[int]) -> str:
    """Return whole numbers in words, those without a gap by the first and the last.

    >>> _numbers([3, 1, 2, 7, 1])
    '1 to 3, 7'
    """
    runs: list[list[int]] = []
    for value in sorted(set(values)):
        if runs and value == runs[-1][-1] + 1:
            runs[-1].append(value)
        else:
            runs.append([value])
    return ", ".join(_run(run) for run in runs)


def _run(run: Sequence[int]) -> str:
    return f"{run[0]} to {run[-1]}" if len(run) > 2 else ", ".join(map(str, run))
