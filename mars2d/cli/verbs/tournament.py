"""The verb ``tournament``."""

from __future__ import annotations

import argparse
from dataclasses import replace
from math import dist
from pathlib import Path

from mars2d.cli.arguments import add_preferences, add_workers, preferences_of, workers_of
from mars2d.cli.outputs import check_outputs
from mars2d.cli.runs import has_display
from mars2d.core.errors import InputError, counted, one_line
from mars2d.core.files import atomic_write
from mars2d.core.scene import NAMED, rgb
from mars2d.core.terminal import tell
from mars2d.output import formats
from mars2d.output.raster import require_pygame
from mars2d.scenario.examples import experiment_name
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.roles import contest_of
from mars2d.study.isolation.limits import Limits
from mars2d.study.plan import Plan, parse_all, settings_of
from mars2d.study.tournament.folder import played_before
from mars2d.study.tournament.league import Tournament
from mars2d.study.tournament.league_text import league_text, matches
from mars2d.study.tournament.match import Match, Played, replayed
from mars2d.study.tournament.page.rules import rules_page
from mars2d.study.tournament.rules import Rules
from mars2d.study.tournament.schedule import Schedule, schedule
from mars2d.study.tournament.tournament import LIMITS, PAGE, TournamentInterrupted, play_schedule
from mars2d.study.work import worker_count
from mars2d.world.record import Record


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add = parser.add_argument
    add("scenario", metavar="SCENARIO", help="a file with a contest, or the name of an example")
    add(
        "--role",
        action="append",
        nargs="+",
        default=[],
        metavar="ROLE=FILES",
        help="the laws of a role: files, a folder, or a pattern such as pursuers/*.py",
    )
    add(
        "--players",
        action="append",
        nargs="+",
        default=[],
        metavar="FILES",
        help="laws of all roles",
    )
    add("--seeds", type=int, default=10, metavar="N", help="matches of each pairing (default: 10)")
    add("--first-seed", type=int, default=0, metavar="K", help="the seeds are K to K + N - 1")
    add("--stop-time", type=float, metavar="S", help="seconds to simulate")
    add(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUES",
        help="an option; several values make rounds: mu=0.8,0.9 or mu=0.8:1.0:5",
    )
    add("--tick-limit", type=float, metavar="S", help="seconds that a law may take for a step")
    add("--match-limit", type=float, metavar="S", help="seconds that a law may take for a match")
    add("--memory", type=float, metavar="MB", help="memory that a law may use")
    add(
        "--out",
        type=Path,
        metavar="FOLDER",
        help="folder of the tables and the page (default: tournament_SCENARIO)",
    )
    add("--no-replays", action="store_true", help="a small page, for very many matches")
    add("--rules", type=Path, metavar="OUT.html", help="write the game's rules as a page")
    add("--match", type=int, metavar="N", help="play only this match, again")
    add("--view", action="store_true", help="with --match: show it in a window")
    add("--record", type=Path, metavar="OUT", help="with --match: save all its data")
    add_workers(parser)
    add_preferences(parser)


def execute(arguments: argparse.Namespace) -> None:
    """Let the laws of files play each other; print the league, and write a page with replays."""
    _check(arguments)
    limits, roles = _limits(arguments), _roles(arguments)
    if arguments.rules is not None:
        _write_rules(arguments, limits)
        if not (roles or arguments.players):
            return
    planned = schedule(
        arguments.scenario,
        roles,
        [file for files in arguments.players for file in files],
        seeds=arguments.seeds,
        first_seed=arguments.first_seed,
        settings=parse_all(arguments.set),
        stop_time=arguments.stop_time,
    )
    path = arguments.out or Path(f"tournament_{experiment_name(Path(planned.experiment))}")
    if arguments.match is not None:
        _play_one(arguments, planned, path, limits)
    else:
        _play_all(arguments, planned, path, limits)


def _check(arguments: argparse.Namespace) -> None:
    """Raise InputError at the start for requests that can't be met."""
    for name in ("view", "record"):
        if getattr(arguments, name) and arguments.match is None:
            raise InputError(f"--{name} needs --match N")
    check_outputs(arguments, {"record": tuple(formats.FORMATS), "rules": (".html", ".htm")})
    worker_count(arguments.workers)
    if arguments.view and not has_display():
        require_pygame("a window")
        raise InputError("--view: there is no display; save the match with --record OUT.npz")


def _limits(arguments: argparse.Namespace) -> Limits:
    given = {
        "tick": arguments.tick_limit,
        "match": arguments.match_limit,
        "memory": arguments.memory,
    }
    return replace(LIMITS, **{name: value for name, value in given.items() if value is not None})


def _write_rules(arguments: argparse.Namespace, limits: Limits) -> None:
    """Write the page of the game's rules, and print its path."""
    points = Plan(settings_of(parse_all(arguments.set)), (arguments.first_seed,)).points()
    options = dict(next(iter(points)))
    if arguments.stop_time is not None:
        options["stop_time"] = arguments.stop_time
    experiment = open_experiment(arguments.scenario, options, seed=arguments.first_seed)
    contest = contest_of(experiment.scenario, arguments.scenario)
    rules = replace(Rules.of(experiment, contest), limits=limits)
    with atomic_write(arguments.rules) as file:
        file.write(rules_page(rules).encode("utf-8", errors="replace"))
    tell(f"rules: {arguments.rules}")


def _roles(arguments: argparse.Namespace) -> dict[str, list[str]]:
    """Return the files of each role; the shell may have expanded a pattern into several words."""
    roles: dict[str, list[str]] = {}
    for words in arguments.role:
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


# -- all matches -----------------------------------------------------------------------------------


def _play_all(arguments: argparse.Namespace, planned: Schedule, path: Path, limits: Limits) -> None:
    """Play the matches not played yet, and print the league, also after Ctrl-C."""
    tell(_announced(planned, len(played_before(path, planned, limits))))
    with workers_of(arguments) as (executor, workers):
        try:
            result = play_schedule(
                planned,
                limits,
                path,
                executor=executor,
                workers=workers,
                replays=not arguments.no_replays,
            )
        except TournamentInterrupted as interrupt:
            _report(interrupt.tournament, path)
            raise
    _report(result, path)


def _announced(planned: Schedule, before: int) -> str:
    """Return a line on the matches, `before` of which were played before."""
    laws = {role: {match.laws[role] for match in planned.matches} for role in planned.roles}
    who = ", ".join(f"{len(names)} as {role}" for role, names in laws.items())
    known = f", {before} of them played before" if before else ""
    return f"{planned.title}: {who}: {matches(len(planned.matches))}{known}"


def _report(result: Tournament, path: Path) -> None:
    """Print the league, and the path of the page."""
    if result.matches:
        tell(f"\n{league_text(result)}\n")
        tell(f"page: {path / PAGE}")


# -- one match -------------------------------------------------------------------------------------


def _play_one(arguments: argparse.Namespace, planned: Schedule, path: Path, limits: Limits) -> None:
    """Play one match again; print its outcome, and whether it is the same as before."""
    count = len(planned.matches)
    if not 1 <= arguments.match <= count:
        raise InputError(f"--match {arguments.match}: expected a number from 1 to {count}")
    match = planned.matches[arguments.match - 1]
    tell(f"match {match.number}: {_described(match, planned.rules)}")
    played, record = replayed(match, limits)
    steps = counted(played.steps, "step")
    tell(f"{one_line(played.message)}. {steps}, digest {played.digest[:16]}")
    tell(_compared(played, planned, path, limits))
    for role, text in played.output.items():
        tell(f"{match.laws[role]} printed:\n{text.rstrip()}")
    if arguments.record is not None:
        record.save(arguments.record)
    if arguments.view:
        _view(arguments, record, _who(match, planned.rules, " against "))


def _described(match: Match, rules: Rules | None) -> str:
    options = "".join(f", {name} = {value}" for name, value in match.options.items())
    return f"{_who(match, rules, ', ')}, seed {match.seed}{options}"


def _who(match: Match, rules: Rules | None, between: str) -> str:
    """Return which law plays which role, and the colours of its robots."""
    colors = {} if rules is None else rules.colors
    words = {role: ", ".join(dict.fromkeys(map(_color_word, of))) for role, of in colors.items()}
    return between.join(
        f"{role} {law}" + (f" ({words[role]})" if words.get(role, role) != role else "")
        for role, law in match.laws.items()
    )


def _compared(played: Played, planned: Schedule, path: Path, limits: Limits) -> str:
    """Return a line that compares a match with the same one in the tournament's folder."""
    found = played_before(path, planned, limits)
    before = next((each for each in found if each.match == played.match), None)
    if before is None:
        return f"it was not played before with these files, as far as {path} says"
    if before.digest == played.digest:
        return "the same as before, to the last bit"
    return f"not as before: {before.message}. Digest {before.digest[:16]}"


def _view(arguments: argparse.Namespace, record: Record, title: str) -> None:
    from mars2d.window.show import show_record

    speed = record.scenario.animation.playback_speed
    titled = replace(record, scenario=record.scenario.replace(title=title))
    show_record(titled, speed, preferences_of(arguments))


def _color_word(value: str) -> str:
    """Return the word for a colour ``#rrggbb``: the nearest named one."""
    words = (word for word in NAMED if len(word) > 1)
    return min(words, key=lambda word: dist(rgb(NAMED[word]), rgb(value)))
