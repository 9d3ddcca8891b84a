"""The verb ``tournament``."""

from __future__ import annotations

import argparse
from dataclasses import replace
from math import dist
from pathlib import Path
from typing import Any

from mars2d.cli.arguments import MANY, Output, option, preferences_of, shared
from mars2d.cli.runs import has_display
from mars2d.core.errors import InputError, Mars2dError, counted, one_line
from mars2d.core.scene import NAMED, rgb
from mars2d.core.terminal import tell
from mars2d.output.raster import require_pygame
from mars2d.scenario.examples import experiment_name
from mars2d.scenario.experiment import open_experiment
from mars2d.study.plan import parse_all
from mars2d.study.work import worker_count
from mars2d.tournaments.folder import played_before
from mars2d.tournaments.isolation.limits import LIMITS, Limits
from mars2d.tournaments.league import matches_of
from mars2d.tournaments.league_text import league_text
from mars2d.tournaments.match import Match, Played, replayed
from mars2d.tournaments.page import rules_page, save_page
from mars2d.tournaments.rules import Rules
from mars2d.tournaments.schedule import Schedule, schedule
from mars2d.tournaments.tournament import PAGE, TournamentInterrupted, missing, play_schedule

EACH: dict[str, Any] = {**MANY, "nargs": "+"}
_LAWS = "the laws of a role: files, a folder, or a pattern such as pursuers/*.py"
_ROUNDS = "an option; several values make rounds: mu=0.8,0.9 or mu=0.8:1.0:5"
_FOLDER = "folder of the tables and the page (default: tournament_SCENARIO)"

ARGUMENTS = {
    "scenario": option("SCENARIO", "a file with a contest, or the name of an example"),
    "--role": option("ROLE=FILES", _LAWS, **EACH),
    "--players": option("FILES", "laws of all roles", **EACH),
    "--seeds": option("N", "matches of each pairing (default: 10)", int, default=10),
    "--first-seed": option("K", "the seeds are K to K + N - 1", int, default=0),
    **shared("stop-time"),
    "--set": option("KEY=VALUES", _ROUNDS, **MANY),
    "--tick-limit": option("S", "a law's seconds for a step", float, default=LIMITS.tick),
    "--match-limit": option("S", "its seconds for a match", float, default=LIMITS.match),
    "--memory": option("MB", "memory that a law may use", float, default=LIMITS.memory),
    "--reads": option("FILES", "files and folders that laws may read", **EACH),
    "--out": option("FOLDER", _FOLDER, Path),
    "--no-replays": option(None, "a small page, for very many matches"),
    "--rules": option("OUT.html", "write the game's rules as a page", Path, action=Output),
    "--match": option("N", "play only this match, again", int),
    "--view": option(None, "with --match: show it in a window"),
    "--record": option("OUT", "with --match: save all its data", Path, action=Output),
    **shared("workers dark text"),
}


def execute(arguments: argparse.Namespace) -> None:
    """Let the laws of files play each other; print the league, and write a page with replays."""
    for name in ("view", "record"):
        if getattr(arguments, name) and arguments.match is None:
            raise InputError(f"--{name} needs --match N")
    worker_count(arguments.workers)
    if arguments.view and not has_display():
        require_pygame("a window")
        raise InputError("--view: there is no display; save the match with --record OUT.npz")
    limits = Limits(
        tick=arguments.tick_limit,
        match=arguments.match_limit,
        memory=arguments.memory,
        reads=[file for files in arguments.reads for file in files],
    )
    roles, settings = _roles(arguments.role), parse_all(arguments.set)
    game, first, stop_time = arguments.scenario, arguments.first_seed, arguments.stop_time
    if arguments.rules is not None:
        options = {name: values[0] for name, values in settings.items()}
        always = {} if stop_time is None else {"stop_time": stop_time}
        opened = open_experiment(game, options | always, seed=first)
        save_page(rules_page(Rules.of(opened, limits)), arguments.rules)
        tell(f"rules: {arguments.rules}")
        if not (roles or arguments.players):
            return
    planned = schedule(
        game,
        roles,
        [file for files in arguments.players for file in files],
        seeds=arguments.seeds,
        first_seed=first,
        settings=settings,
        stop_time=stop_time,
        limits=limits,
    )
    path = arguments.out or Path(f"tournament_{experiment_name(Path(planned.experiment))}")
    play = _play_all if arguments.match is None else _play_one
    play(arguments, planned, path)


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


def _play_all(arguments: argparse.Namespace, planned: Schedule, path: Path) -> None:
    """Play the matches not played yet, and print the league, also after Ctrl-C."""
    laws = {role: {match.laws[role] for match in planned.matches} for role in planned.roles}
    who = ", ".join(f"{len(names)} as {role}" for role, names in laws.items())
    count = len(planned.matches)
    before = count - len(missing(planned, played_before(path, planned)))
    known = f", {before} of them played before" if before else ""
    tell(f"{planned.rules.title}: {who}: {matches_of(count)}{known}")
    replays = not arguments.no_replays
    interrupt = None
    try:
        result = play_schedule(planned, path, workers=arguments.workers, replays=replays)
    except TournamentInterrupted as error:
        result, interrupt = error.tournament, error
    if result.matches:
        tell(f"\n{league_text(result)}\n\npage: {path / PAGE}")
    if interrupt is not None:
        raise interrupt
    if failed := sum(bool(played.error) for played in result.matches):
        raise Mars2dError(f"{matches_of(failed)} without a result: play again by the same command")


def _play_one(arguments: argparse.Namespace, planned: Schedule, path: Path) -> None:
    """Play one match again; print its outcome, and whether it is the same as before."""
    count = len(planned.matches)
    if not 1 <= arguments.match <= count:
        raise InputError(f"--match {arguments.match}: expected a number from 1 to {count}")
    match = planned.matches[arguments.match - 1]
    options = "".join(f", {name} = {value}" for name, value in match.options.items())
    tell(f"match {match.number}: {_who(match, planned, ', ')}, seed {match.seed}{options}")
    played, record = replayed(match, planned.limits)
    steps = counted(played.steps, "step")
    tell(f"{one_line(played.message)}. {steps}, digest {played.digest[:16]}")
    tell(_compared(played, played_before(path, planned), path))
    for role, text in played.output.items():
        tell(f"{match.laws[role]} printed:\n{text.rstrip()}")
    if arguments.record is not None:
        record.save(arguments.record)
    if arguments.view:
        from mars2d.window.show import show_record

        title = _who(match, planned, " against ")
        titled = replace(record, scenario=record.scenario.replace(title=title))
        show_record(titled, record.scenario.animation.playback_speed, preferences_of(arguments))


def _who(match: Match, planned: Schedule, between: str) -> str:
    """Return which law plays which role, and the colours of its robots."""
    told = []
    for role, law in match.laws.items():
        colors = planned.rules.roles[role].colors
        words = ", ".join(dict.fromkeys(map(_color_word, colors)))
        told.append(f"{role} {law}" + (f" ({words})" if words not in ("", role) else ""))
    return between.join(told)


def _compared(played: Played, known: tuple[Played, ...], path: Path) -> str:
    """Return a line that compares a match with the same one in the tournament's folder."""
    before = next((each for each in known if each.match == played.match), None)
    if before is None:
        return f"it was not played before with these files, as far as {path} says"
    if before.digest == played.digest:
        return "the same as before, to the last bit"
    return f"not as before: {before.message}. Digest {before.digest[:16]}"


def _color_word(value: str) -> str:
    """Return the word for a colour ``#rrggbb``: the nearest named one."""
    return min(
        (word for word in NAMED if len(word) > 1),
        key=lambda word: dist(rgb(NAMED[word]), rgb(value)),
    )
