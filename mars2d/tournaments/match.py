"""Matches: laws from files play against each other in the roles of an experiment's contest."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from math import isnan
from pathlib import Path
from typing import Any

from mars2d.addons.contest import Outcome
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.roles import contest_of, roles_of
from mars2d.tournaments.isolation import run_isolated
from mars2d.tournaments.isolation.jail import is_protected
from mars2d.tournaments.isolation.limits import OUT_OF_TIME, Limits, Verdict
from mars2d.world.verify import rerun

TIME_OUTS = 2
"""In how many matches a law may run out of time, before it forfeits the rest."""

LATE = Verdict(
    "late", f"ran out of time in {TIME_OUTS} matches before, and forfeits the rest", time=0.0
)
"""On a law in a match that is not played any more."""


@dataclass(frozen=True)
class Match:
    """A match to be played: the experiment, its options and seed, and each role's law.

    number: in the tournament, from 1. experiment: a file, or the name of an example. options: as
    for `mars2d.run`. laws: the name of each role's law, as tables show it. files:
    the paths of these laws; a role without one is played by the experiment's own law. code: what
    these files held when the match was planned, and so what is played; see `law_code`.
    """

    number: int
    experiment: str
    options: Mapping[str, Any]
    seed: int
    laws: Mapping[str, str]
    files: Mapping[str, str] = field(default_factory=dict)
    code: Mapping[str, Mapping[Path, bytes]] = field(default_factory=dict, repr=False)


@dataclass(frozen=True)
class Played:
    """The result of a match.

    winner: a role, or None for a draw or if both laws failed. score: each role's, at the end.
    payoff: how long the evaders were free, seconds, or what else the contest counts, or None.
    message: how the match ended, one line. verdicts: on laws that failed and so forfeited the
    match, by role. output: printed by each role's law. digest: of the record, or empty. steps: the
    number of control steps. replay: data for a page, or empty. error: why there is no result, or
    empty. protected: whether the system kept the laws from everything that could harm others.
    """

    match: Match
    winner: str | None = None
    score: Mapping[str, float] = field(default_factory=dict)
    payoff: float | None = None
    message: str = ""
    verdicts: Mapping[str, Verdict] = field(default_factory=dict)
    output: Mapping[str, str] = field(default_factory=dict, repr=False)
    digest: str = ""
    steps: int = 0
    replay: str = field(default="", repr=False)
    error: str = ""
    protected: bool = True

    @classmethod
    def without_result(cls, match: Match, error: str) -> Played:
        """Return a match that could not be played to its end, and counts for no law."""
        return cls(match, message=f"no result: {error}", error=error)

    @classmethod
    def forfeited(
        cls, match: Match, verdicts: Mapping[str, Verdict], roles: Iterable[str], **more: Any
    ) -> Played:
        """Return a match that the laws with verdicts have lost; the other one, if any, has won."""
        faults = []
        for role, verdict in verdicts.items():
            when = "" if verdict.kind == "late" else f" after {verdict.time:g} s"
            faults.append(
                f"{match.laws[role]} forfeits as {role}{when}: {verdict.kind}: {verdict.text}"
            )
        winner = next((role for role in roles if role not in verdicts), None)
        message = "; ".join([*faults, f"{winner or 'nobody'} wins"])
        return cls(match, winner=winner, message=message, verdicts=verdicts, **more)


def settled(planned: Iterable[Match], played: Iterable[Played]) -> list[Played]:
    """Return the results of the planned matches, in order, as far as they are known.

    A law that has run out of time in `TIME_OUTS` matches forfeits those that follow, whether they
    were played or not: so the results depend on no order in which matches are done.
    """
    known = {each.match.number: each for each in played}
    time_outs: Counter[str] = Counter()
    results = []
    for match in planned:
        late = {role: LATE for role, law in match.laws.items() if time_outs[law] >= TIME_OUTS}
        if late:
            results.append(Played.forfeited(match, late, match.laws))
        elif result := known.get(match.number):
            results.append(result)
            slow = [role for role, v in result.verdicts.items() if v.kind in OUT_OF_TIME]
            time_outs.update(match.laws[role] for role in slow)
    return results


def play(match: Match, limits: Limits, replays: bool = True) -> Played:
    """Play a match, with each law in a process of its own, and return its result.

    replays: whether to keep data for a page. The match is run again from its recorded commands: if
    that leads elsewhere, it has no result. Raises InputError if the experiment itself fails, which
    is not a law's fault.
    """
    from mars2d.output.pages.replay import replay_data

    experiment = open_experiment(match.experiment, match.options, seed=match.seed)
    contest = contest_of(experiment.scenario, match.experiment)
    teams = roles_of(experiment.scenario)
    laws = {role: (Path(file), teams[role]) for role, file in match.files.items()}
    record, verdicts, output = run_isolated(experiment, laws, limits, match.code)
    if len(record) and (departure := rerun(record)):
        error = f"run again from its recorded commands, it departs at {departure}"
        return Played.without_result(match, error)
    outcome = contest.outcome(record) if len(record) else Outcome((), {}, None)
    result: dict[str, Any] = {
        "score": {role: float(score) for role, score in outcome.score.items()},
        "output": output,
        "digest": record.digest,
        "steps": max(len(record) - 1, 0),
        "replay": replay_data(record) if replays and len(record) else "",
        "protected": is_protected(),
    }
    if verdicts:
        return Played.forfeited(match, verdicts, teams, **result)
    payoff = None if isnan(outcome.payoff) else outcome.payoff
    message = record.over_message
    return Played(match, outcome.winner, payoff=payoff, message=message, **result)
