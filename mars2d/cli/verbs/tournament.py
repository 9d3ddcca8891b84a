"""The verb ``tournament``."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from mars2d.cli.arguments import MANY, option, options_of, shared
from mars2d.core.errors import InputError, Mars2dError
from mars2d.core.terminal import tell
from mars2d.scenario.examples import experiment_name
from mars2d.study.work import worker_count
from mars2d.tournaments.folder import played_before
from mars2d.tournaments.isolation.limits import LIMITS, Limits
from mars2d.tournaments.league import matches_of
from mars2d.tournaments.league_text import league_text
from mars2d.tournaments.schedule import Schedule, schedule
from mars2d.tournaments.tournament import PAGE, TournamentInterrupted, missing, play_schedule

EACH: dict[str, Any] = {**MANY, "nargs": "+"}
_LAWS = "the laws of a role: files, a folder, or a pattern such as pursuers/*.py"
_FOLDER = "folder of the tables and the page (default: tournament_SCENARIO)"

ARGUMENTS = {
    "scenario": option("SCENARIO", "a file with a contest, or the name of an example"),
    "--role": option("ROLE=FILES", _LAWS, **EACH),
    "--players": option("FILES", "laws of all roles", **EACH),
    "--seeds": option("N", "matches of each pairing (default: 10)", int, default=10),
    "--first-seed": option("K", "the seeds are K to K + N - 1", int, default=0),
    **shared("stop-time set"),
    "--tick-limit": option("S", "a law's seconds for a step", float, default=LIMITS.tick),
    "--match-limit": option("S", "its seconds for a match", float, default=LIMITS.match),
    "--memory": option("MB", "memory that a law may use", float, default=LIMITS.memory),
    "--reads": option("FILES", "files and folders that laws may read", **EACH),
    "--out": option("FOLDER", _FOLDER, Path),
    **shared("workers"),
}


def execute(arguments: argparse.Namespace) -> None:
    """Let the laws of files play each other; print the league, and write a page with replays."""
    worker_count(arguments.workers)
    limits = Limits(
        tick=arguments.tick_limit,
        match=arguments.match_limit,
        memory=arguments.memory,
        reads=[file for files in arguments.reads for file in files],
    )
    planned = schedule(
        arguments.scenario,
        _roles(arguments.role),
        [file for files in arguments.players for file in files],
        seeds=arguments.seeds,
        first_seed=arguments.first_seed,
        options=options_of(arguments),
        limits=limits,
    )
    path = arguments.out or Path(f"tournament_{experiment_name(Path(planned.experiment))}")
    _play(arguments, planned, path)


def _roles(given: list[list[str]]) -> dict[str, list[str]]:
    """Return the files of each role; the shell may have expanded a pattern into several words."""
    roles: dict[str, list[str]] = {}
    for words in given:
        role = ""
        for word in words:
            name, equals, file = word.partition("=")
            if role and (not equals or Path(word).exists()):
                file = word
            elif name and file:
                role = name
            else:
                expected = "expected ROLE=FILES, such as --role pursuer=laws/*.py"
                raise InputError(f"--role {word}: {expected}")
            roles.setdefault(role, []).append(file)
    return roles


def _play(arguments: argparse.Namespace, planned: Schedule, path: Path) -> None:
    """Play the matches not played yet, and print the league, also after Ctrl-C."""
    laws = {role: {match.laws[role] for match in planned.matches} for role in planned.roles}
    who = ", ".join(f"{len(names)} as {role}" for role, names in laws.items())
    count = len(planned.matches)
    before = count - len(missing(planned, played_before(path, planned)))
    known = f", {before} of them played before" if before else ""
    tell(f"{planned.title}: {who}: {matches_of(count)}{known}")
    interrupt = None
    try:
        result = play_schedule(planned, path, workers=arguments.workers)
    except TournamentInterrupted as error:
        result, interrupt = error.tournament, error
    if result.matches:
        tell(f"\n{league_text(result)}\n\npage: {path / PAGE}")
    if interrupt is not None:
        raise interrupt
    if failed := sum(bool(played.error) for played in result.matches):
        raise Mars2dError(f"{matches_of(failed)} without a result: play again by the same command")
