"""A match: laws of their own files against each other in the roles of an experiment's contest."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isnan
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mars2d.addons.contest import Contest, Outcome
from mars2d.core.errors import InputError, LawError
from mars2d.record.record import Record
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.scenario.scenario import Scenario
from mars2d.study.isolation.limits import Limits, Verdict
from mars2d.world.loop import simulate

if TYPE_CHECKING:
    from mars2d.study.isolation import Guard

__all__ = ["Match", "Played", "contest_of", "play", "replayed"]


@dataclass(frozen=True)
class Match:
    """What is played: the experiment, with which options and seed, and each role's law.

    number: in the tournament, from 1. experiment: a file, or the name of an example. options: those
    of its round, as `mars2d.run` takes them. laws: the name of each role's law, as tables show it.
    files: where these laws are.
    """

    number: int
    experiment: str
    options: Mapping[str, Any]
    seed: int
    laws: Mapping[str, str]
    files: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Played:
    """How a match went.

    winner: a role, or None for a draw, and where both laws failed. score: of each role, when it was
    over. capture_time: when the last one was caught, seconds, or None. message: how it ended, one
    line. verdicts: on the laws that failed, by role: these have forfeited the match. output: what
    each role's law printed. digest: of the record, or empty. steps: how many control steps it took.
    replay: data for a page, or empty. error: why there is no result, or empty.
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

    @classmethod
    def without_result(cls, match: Match, error: str) -> Played:
        """Return a match that nobody could play to its end: it counts for nobody."""
        return cls(match, message=f"no result: {error}", error=error)


def contest_of(scenario: Scenario, name: str) -> Contest:
    """Return the one contest of a scenario. Raises InputError if there is none, or several.

    name: what messages call the experiment.
    """
    contests = [addon for addon in scenario.addons if isinstance(addon, Contest)]
    if len(contests) != 1:
        found = "has none" if not contests else f"has {len(contests)}"
        raise InputError(
            f"{name}: a tournament needs one add-on that says who has won, as "
            f"Game({{'pursuer': ['red'], 'evader': ['blue']}}); this experiment {found}"
        )
    return contests[0]


def play(match: Match, limits: Limits, replays: bool) -> Played:
    """Play a match, each law in a process of its own, and return how it went.

    replays: whether to keep data for a page. Raises InputError where the experiment itself fails,
    which is no law's fault.
    """
    return _played(match, limits, replays)[0]


def replayed(match: Match, limits: Limits) -> tuple[Played, Record]:
    """Play a match, and return its record as well. Raises InputError as `play` does."""
    return _played(match, limits, replays=False)


def _played(match: Match, limits: Limits, replays: bool) -> tuple[Played, Record]:
    from mars2d.study.isolation import Guard

    experiment = open_experiment(match.experiment, match.options, seed=match.seed)
    contest = contest_of(experiment.scenario, match.experiment)
    teams = dict(zip(_roles(contest), contest.teams(experiment.scenario), strict=True))
    laws = {role: (Path(match.files[role]), team) for role, team in teams.items()}
    with Guard(experiment.scenario, laws, match.seed, limits) as guard:
        record = _record(experiment, guard, match.seed)
    verdicts = dict(guard.verdicts)
    outcome = contest.outcome(record) if len(record) else Outcome((), {}, None)
    caught = bool(outcome.captures) and not verdicts and not isnan(outcome.capture_time)
    winner = _left(verdicts, _roles(contest)) if verdicts else outcome.winner
    played = Played(
        match,
        winner=winner,
        score={role: float(score) for role, score in outcome.score.items()},
        capture_time=outcome.capture_time if caught else None,
        message=_forfeits(match, verdicts, winner) if verdicts else record.over_message,
        verdicts=verdicts,
        output={role: text for role, text in guard.output.items() if text},
        digest=record.digest,
        steps=max(len(record) - 1, 0),
        replay=_replay(record) if replays else "",
    )
    return played, record


def _record(experiment: Experiment, guard: Guard, seed: int) -> Record:
    """Return the record of a match, also of one that the failure of a guarded law broke off."""
    guarded = Experiment(guard.scenario, experiment.control, experiment.filename)
    try:
        return simulate(guarded, seed).record
    except LawError as error:
        if not guard.verdicts or error.record is None:
            raise
        record: Record = error.record
        return record


def _roles(contest: Contest) -> tuple[str, ...]:
    return tuple(role for role, _ in contest.roles)


def _left(verdicts: Mapping[str, Verdict], roles: tuple[str, ...]) -> str | None:
    """Return the one role whose law has not failed, or None."""
    left = [role for role in roles if role not in verdicts]
    return left[0] if len(left) == 1 else None


def _forfeits(match: Match, verdicts: Mapping[str, Verdict], winner: str | None) -> str:
    """Return in words who has forfeited a match, and why."""
    faults = [
        f"{match.laws[role]} forfeits as {role} after {verdict.time:g} s: "
        f"{verdict.kind}: {verdict.text}"
        for role, verdict in verdicts.items()
    ]
    return "; ".join([*faults, f"{winner} wins" if winner else "nobody wins"])


def _replay(record: Record) -> str:
    """Return the data of a record's replay, if there is anything to be seen."""
    from mars2d.study.tournament.page import replay_data

    return replay_data(record) if len(record) else ""
