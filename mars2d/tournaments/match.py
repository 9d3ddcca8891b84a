"""Matches: laws from files play against each other in the roles of an experiment's contest."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
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
from mars2d.world.record import Record
from mars2d.world.verify import rerun

TIME_OUTS = 2
"""In how many matches a law may run out of time, before it forfeits the rest."""


@dataclass(frozen=True)
class Match:
    """A match to be played: the experiment, its options and seed, and each role's law.

    number: in the tournament, from 1. experiment: a file, or the name of an example. options: those
    of its round, as for `mars2d.run`. laws: the name of each role's law, as tables show it. files:
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
    capture_time: the time at which the last evader was caught, seconds, or None. message: how the
    match ended, one line. verdicts: on laws that failed and so forfeited the match, by role.
    output: printed by each role's law. digest: of the record, or empty. steps: the number of
    control steps. replay: data for a page, or empty. error: why there is no result, or empty.
    protected: whether the system kept the laws from everything that could harm others.
    """

    match: Match
    winner: str | None = None
    score: Mapping[str, float] = field(default_factory=dict)
    capture_time: float | None = None
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
    def not_played(cls, match: Match, roles: Sequence[str]) -> Played:
        """Return a match that some roles forfeit without playing, since they ran out of time."""
        told = f"ran out of time in {TIME_OUTS} matches before, and forfeits the rest"
        verdicts = {role: Verdict("late", told, 0.0) for role in roles}
        winner = _left(verdicts, tuple(match.laws))
        message = _forfeits(match, verdicts, winner)
        return cls(match, winner=winner, message=message, verdicts=verdicts)


def settled(planned: Iterable[Match], played: Iterable[Played]) -> list[Played]:
    """Return the results of the planned matches, in order, as far as they are known.

    A law that has run out of time in `TIME_OUTS` matches forfeits those that follow, whether they
    were played or not: so the results depend on no order in which matches are done.
    """
    known = {each.match.number: each for each in played}
    time_outs: Counter[str] = Counter()
    results = []
    for match in planned:
        late = [role for role, law in match.laws.items() if time_outs[law] >= TIME_OUTS]
        if late:
            results.append(Played.not_played(match, late))
        elif result := known.get(match.number):
            results.append(result)
            slow = [role for role, v in result.verdicts.items() if v.kind in OUT_OF_TIME]
            time_outs.update(match.laws[role] for role in slow)
    return results


def play(match: Match, limits: Limits, replays: bool) -> Played:
    """Play a match, with each law in a process of its own, and return its result.

    replays: whether to keep data for a page. Raises InputError if the experiment itself fails,
    which is not a law's fault.
    """
    return replayed(match, limits, replays)[0]


def replayed(match: Match, limits: Limits, replays: bool = False) -> tuple[Played, Record]:
    """Play a match, and return its result and record. Raises InputError as `play` does.

    The match is run again from its recorded commands: if that leads elsewhere, it has no result.
    """
    experiment = open_experiment(match.experiment, match.options, seed=match.seed)
    contest = contest_of(experiment.scenario, match.experiment)
    teams = roles_of(experiment.scenario)
    roles = tuple(teams)
    laws = {role: (Path(file), teams[role]) for role, file in match.files.items()}
    record, verdicts, output = run_isolated(experiment, laws, limits, match.code)
    if len(record) and (departure := rerun(record)):
        error = f"run again from its recorded commands, it departs at {departure}"
        return Played.without_result(match, error), record
    outcome = contest.outcome(record) if len(record) else Outcome((), {}, None)
    caught = bool(outcome.captures) and not verdicts and not isnan(outcome.capture_time)
    winner = _left(verdicts, roles) if verdicts else outcome.winner
    played = Played(
        match,
        winner=winner,
        score={role: float(score) for role, score in outcome.score.items()},
        capture_time=outcome.capture_time if caught else None,
        message=_forfeits(match, verdicts, winner) if verdicts else record.over_message,
        verdicts=verdicts,
        output=output,
        digest=record.digest,
        steps=max(len(record) - 1, 0),
        replay=_replay(record) if replays else "",
        protected=is_protected(),
    )
    return played, record


def _left(verdicts: Mapping[str, Verdict], roles: tuple[str, ...]) -> str | None:
    """Return the only role whose law has not failed, or None."""
    left = [role for role in roles if role not in verdicts]
    return left[0] if len(left) == 1 else None


def _forfeits(match: Match, verdicts: Mapping[str, Verdict], winner: str | None) -> str:
    """Say which laws have forfeited a match, and why."""
    faults = []
    for role, verdict in verdicts.items():
        when = "" if verdict.kind == "late" else f" after {verdict.time:g} s"
        faults.append(
            f"{match.laws[role]} forfeits as {role}{when}: {verdict.kind}: {verdict.text}"
        )
    return "; ".join([*faults, f"{winner} wins" if winner else "nobody wins"])


def _replay(record: Record) -> str:
    """Return the data of a record's replay, or empty if the record is."""
    from mars2d.output.pages.replay import replay_data

    return replay_data(record) if len(record) else ""
