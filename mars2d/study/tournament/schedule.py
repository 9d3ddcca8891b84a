"""Schedules: the matches of a tournament, in order."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mars2d.core.errors import InputError, shown
from mars2d.scenario.experiment import examples, open_experiment
from mars2d.study.plan import MAX_RUNS, Plan, seeds_of, settings_of
from mars2d.study.tournament.entrants import Files, entrants, names_of
from mars2d.study.tournament.match import Match, contest_of

__all__ = ["Schedule", "schedule"]


@dataclass(frozen=True)
class Schedule:
    """All matches of a tournament, in order: round by round, pairing by pairing, seed by seed.

    title, experiment: those of the scenario. roles: those of its contest, in order. settings: the
    options in which rounds differ. files: those that were read for the experiment itself.
    """

    title: str
    experiment: str
    roles: tuple[str, ...]
    settings: tuple[str, ...]
    matches: tuple[Match, ...]
    files: frozenset[Path] = frozenset()


def schedule(
    experiment: str | Path,
    roles: Mapping[str, Files] | None = None,
    players: Files | None = None,
    *,
    seeds: int | Iterable[int] = 10,
    first_seed: int = 0,
    settings: Mapping[str, Any] | None = None,
    stop_time: float | None = None,
) -> Schedule:
    """Return the schedule in which each law of a role plays each of the other, with all seeds.

    The arguments are those of `mars2d.tournament`. Only the experiment is read, and no law. Raises
    InputError for anything that can't be played.
    """
    if not isinstance(experiment, (str, Path)):
        raise InputError(
            f"experiment = {shown(experiment)}: expected a file, or the name of an example"
        )
    plan = Plan(settings_of(settings), seeds_of(seeds, first_seed))
    always = {} if stop_time is None else {"stop_time": stop_time}
    rounds = [{**point, **always} for point in plan.points()]
    opened = open_experiment(experiment, rounds[0], seed=plan.seeds[0])
    parts = contest_of(opened.scenario, str(experiment)).roles
    names = tuple(role for role, _ in parts)
    for options in (probe | always for probe in plan.probes()):  # before any match, not after many
        scenario = open_experiment(experiment, options, seed=plan.seeds[0]).scenario
        contest = contest_of(scenario, str(experiment))
        contest.teams(scenario)
        if tuple(role for role, _ in contest.roles) != names:
            raise InputError(f"{experiment}: each round needs the roles {' and '.join(names)}")
    _check_names(plan.settings, names)
    beside = None if opened.path is None else opened.path.parent
    taking_part = entrants(names, roles or {}, players or (), beside)
    pairings = list(pairings_of(taking_part))
    if not pairings:
        raise InputError("there is nobody to play against: a law does not play itself")
    count = len(rounds) * len(pairings) * len(plan.seeds)
    if count > MAX_RUNS:
        raise InputError(f"these are {count:,} matches: {MAX_RUNS:,} at most")
    named = str(experiment) if str(experiment) in examples() else str(opened.path)
    law_names = names_of(law for laws in taking_part.values() for law in laws)
    matches = tuple(
        Match(
            number=number,
            experiment=named,
            options=options,
            seed=seed,
            laws={role: law_names[law] for role, law in files.items()},
            files=files,
        )
        for number, (options, files, seed) in enumerate(
            itertools.product(rounds, pairings, plan.seeds), 1
        )
    )
    return Schedule(
        title=opened.scenario.title or Path(named).stem,
        experiment=named,
        roles=names,
        settings=tuple(plan.settings),
        matches=matches,
        files=opened.files,
    )


def _check_names(settings: Iterable[str], roles: Sequence[str]) -> None:
    """Refuse settings whose column would be twice in the table of matches."""
    for name in settings:
        if name == "seed":
            raise InputError("setting 'seed': say how many there are, with --seeds N")
        if name in roles:
            raise InputError(
                f"setting {name!r}: this is a role; name its laws by --role {name}=FILES"
            )


def pairings_of(entrants: Mapping[str, Sequence[Path]]) -> Iterator[dict[str, str]]:
    """Yield each role's law in each pairing; a law does not play itself."""
    for laws in itertools.product(*entrants.values()):
        if len({*laws}) == len(laws):
            yield {role: str(law) for role, law in zip(entrants, laws, strict=True)}
