"""The verb ``check``."""

from __future__ import annotations

import argparse
import inspect
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType

from mars2d.addons import maps
from mars2d.addons.map import Map
from mars2d.cli import remarks
from mars2d.cli.arguments import MANY, option, refuse
from mars2d.cli.runs import run_headless
from mars2d.core.deadline import PATIENCE, Deadline
from mars2d.core.errors import InputError, Late, Mars2dError, counted, nearest, one_line
from mars2d.core.progress import progress
from mars2d.core.terminal import tell, warn
from mars2d.output import formats
from mars2d.scenario.experiment import Experiment, open_experiment, open_module
from mars2d.scenario.options import options_in_words, parse_option
from mars2d.scenario.policy import SUFFIX as LEARNED
from mars2d.scenario.policy import Policy
from mars2d.scenario.robot import Robot
from mars2d.testing.file import trials
from mars2d.testing.subject import Finding
from mars2d.tournaments.isolation.limits import LIMITS
from mars2d.tournaments.match import play
from mars2d.tournaments.schedule import trial_matches
from mars2d.world.record import load
from mars2d.world.verify import other_versions, rerun

TRIAL_STEPS = 10
"""Control steps of a trial run: some mistakes only show when laws and sensors are called."""

MAX_ROBOTS_LISTED = 8

BAD_INPUT = 2

LOADING = 60.0
"""The time that loading a file may take, seconds."""

_FILES = (
    "an experiment, sensors, add-ons, laws (.py or an example's name), a learned law "
    f"({LEARNED}), a scenario (.toml), a record ({', '.join(formats.SUFFIXES)}), or a map"
)
_SET = "how a map is read; with --for, a field of the experiment"

ARGUMENTS = {
    "file": option("FILE", _FILES),
    "--set": option("KEY=VALUE", _SET, **MANY),
    "--for": option("GAME", "with a law: play it in this game, with --role", dest="game"),
    "--role": option("ROLE", "with --for: the role that the law plays"),
}


def execute(arguments: argparse.Namespace) -> None:
    """Describe a file and check it for mistakes: code, a scenario, a record or a map."""
    path = Path(arguments.file)
    if arguments.game is not None or arguments.role is not None:
        _check_in_game(path, arguments)
        return
    options = dict(map(parse_option, arguments.set))
    suffix = path.suffix.lower()
    if suffix not in maps.SUFFIXES:
        refuse(arguments, "set", f"is for maps: {', '.join(maps.SUFFIXES)}")
    if suffix in maps.SUFFIXES:
        known = [name for name in inspect.signature(Map.from_file).parameters if name != "path"]
        if unknown := [name for name in options if name not in known]:
            raise InputError(f"--set {unknown[0]}: no option{nearest(unknown[0], known)}")
        drawing = maps.read(path, **options)
        _tell_all(maps.described(drawing, maps.obstacles(drawing)))
    elif suffix in formats.SUFFIXES:
        _check_record(path)
    elif path.suffix in ("", ".py", ".toml", LEARNED):
        _check_code(arguments.file)
    else:
        raise InputError(
            f"{path}: expected a Python file (.py), a learned law ({LEARNED}), a scenario (.toml), "
            f"a record ({', '.join(formats.SUFFIXES)}) or a map ({', '.join(maps.SUFFIXES)})"
            f"{maps.advice(path)}"
        )


def _check_in_game(path: Path, arguments: argparse.Namespace) -> None:
    """Let a law play a few matches of a game, as a tournament does; refuse one that forfeits."""
    if arguments.game is None:
        refuse(arguments, "role", "needs --for GAME: the game in which the law plays this role")
    if arguments.role is None:
        refuse(arguments, "for", "needs --role ROLE: the role that the law plays in the game")
    options = dict(map(parse_option, arguments.set))
    matches = trial_matches(arguments.game, arguments.role, path, options)
    won, role_of = 0, f"{arguments.role} of {arguments.game}"
    for match in matches:
        played = play(match, LIMITS, replays=False)
        law = match.laws[arguments.role]
        tell(f"{law}, seed {match.seed}: {one_line(played.message)}")
        for role, text in played.output.items():
            tell(f"{match.laws[role]} printed:\n{text.rstrip()}")
        if played.error:
            raise InputError(f"{arguments.game}: {played.error}")
        for verdict in played.verdicts.values():
            forfeits = f"as {role_of} it would forfeit its matches ({verdict.kind})"
            raise InputError(f"{verdict.text}: {forfeits}")
        won += played.winner == arguments.role
    tell(f"sound: won {won} of {len(matches)} matches as {role_of}, and forfeited none")


def _check_code(source: str) -> None:
    """Check a file of parts, laws, an experiment, or several of these."""
    with _limited(source, LOADING) as limit, limit:
        module, experiment = _opened(source)
    if experiment is not None:
        _tell_all(_description(experiment))
        for remark in remarks.before(experiment):
            tell(f"hint        {remark}")
    with _limited(source, PATIENCE) as limit:
        wrong = _try_all(module, experiment, limit)
        if len(wrong) == 1:
            name = Path(source).name
            place = "" if wrong[0].text.startswith(f"{name}, line") else f"{name}: "
            raise InputError(place + wrong[0].text)
        if wrong:
            raise InputError(f"{source}: {len(wrong)} things are wrong, as said above")
    if experiment is not None:
        scenario = experiment.scenario
        stop_time = min(TRIAL_STEPS * scenario.sampling_time, scenario.stop_time)
        trial = Experiment(scenario.replace(stop_time=stop_time), experiment.control)
        with _limited(source, PATIENCE) as limit, limit:
            rows = len(run_headless(trial, [lambda _: limit.alive()]).history)
        tell(f"sound: {counted(rows, 'control step')} done")


@contextmanager
def _limited(source: str, seconds: float) -> Iterator[Deadline]:
    """Yield a limit of time; code that it breaks off is named, or ends the process."""

    def give_up(where: str) -> None:
        tell()  # ends the line of what is tried
        warn(f"{source}: does not come to an end{f' at {where}' if where else ''}")
        os._exit(BAD_INPUT)

    limit = Deadline(seconds, give_up)
    try:
        yield limit
    except Late:
        where = f" at {limit.where}" if limit.where else ""
        raise InputError(f"{source}: did not come to an end within {seconds:g} s{where}") from None


def _opened(source: str) -> tuple[ModuleType, Experiment | None]:
    """Return a file as a module, and its experiment; None if it has only parts or laws."""
    if Path(source).suffix == ".toml":
        return ModuleType(source), open_experiment(source)
    if Path(source).suffix == LEARNED:
        law = Policy(Path(source))
        if not law.experiment:
            raise InputError(
                f"{source}: does not say in which experiment it was learned: try it in a game, by "
                "--for GAME --role ROLE"
            )
        learner = {f"robots.{law.robot}.controller": law}
        return ModuleType(source), open_experiment(law.experiment, learner)
    module = open_module(source)
    if not hasattr(module, "scenario") and any(True for _ in trials(module, None)):
        return module, None
    return module, open_experiment(module)


def _try_all(module: ModuleType, experiment: Experiment | None, limit: Deadline) -> list[Finding]:
    """Try all parts and laws, print the findings, and return those that are wrong."""
    wrong: list[Finding] = []
    said: set[Finding] = set()
    for trial in trials(module, experiment, limit):
        tell(f"{trial.name} {trial.where}".rstrip(), end=": ")
        found = trial.findings()
        findings = [finding for finding in found if finding not in said]
        said |= {*findings}
        faults = [finding for finding in findings if not finding.untried]
        hints = len(findings) - len(faults)
        verdict = "not tried to the end" if any(f.untried for f in found) else "sound"
        if faults:
            verdict = f"{counted(len(faults), 'thing')} wrong"
        tell(trial.untried or ", ".join([verdict, *([counted(hints, "hint")] if hints else [])]))
        for finding in findings:
            tell(f"  {'wrong' if finding in faults else 'hint':<6}{finding.text}")
        wrong += faults
    return wrong


def _tell_all(rows: Iterable[tuple[str, str]]) -> None:
    for name, text in rows:
        tell(f"{name:<12}{text}")


def _description(experiment: Experiment) -> list[tuple[str, str]]:
    """Return a description of an experiment as names and texts."""
    scenario = experiment.scenario
    xmin, xmax, ymin, ymax = scenario.bounds
    more = len(scenario.robots) - MAX_ROBOTS_LISTED
    limits = "no limits"
    if scenario.workspace is not None:
        limits = f"{len(scenario.workspace)} corners, on_exit {scenario.on_exit!r}"
    law = getattr(experiment.control, "__name__", "")
    own = sum(robot.controller is not None for robot in scenario.robots)
    laws = [f"{law}(world) of the team"] * bool(law) + [f"{own} of robots' own"] * bool(own)
    joints = (
        f"{type(tie.joint).__name__} of {tie.joint.a} and {tie.joint.b or 'the world'}"
        for tie in scenario.ties
    )
    checks = "checks(record), made after a whole run"
    rows = [
        ("title", scenario.title),
        *((str(robot.name), _robot(robot)) for robot in scenario.robots[:MAX_ROBOTS_LISTED]),
        ("", f"and {counted(more, 'robot')} more" if more > 0 else ""),
        ("workspace", f"{xmax - xmin:g} m x {ymax - ymin:g} m, {limits}"),
        ("obstacles", str(len(scenario.obstacles))),
        ("props", ", ".join(str(prop.name) for prop in scenario.props)),
        ("joints", ", ".join(joints)),
        ("physics", "" if scenario.physics == "contact" else scenario.physics),
        ("add-ons", ", ".join(addon.key for addon in scenario.addons) or "none"),
        ("time", f"{scenario.stop_time:g} s in steps of {scenario.sampling_time:g} s"),
        ("laws", ", ".join(laws) or "none: all robots stand still"),
        ("checks", "" if experiment.source.checks is None else checks),
    ]
    return [(name, text) for name, text in rows if text]


def _robot(robot: Robot) -> str:
    x, y, theta = robot.pose
    parts = [type(robot.drive).__name__, *(sensor.key for sensor in robot.sensors)]
    if robot.controller is not None:
        parts.append(f"law {getattr(robot.controller, '__name__', 'of its own')}")
    return f"at ({x:g}, {y:g}, {theta:.4g}): {', '.join(parts)}"


def _check_record(path: Path) -> None:
    """Describe a record, and run it again from its recorded commands."""
    record = load(path)
    versions = ", ".join(f"{name} {version}" for name, version in record.versions.items())
    source = one_line(record.filename) or "a Scenario"
    rows = [
        ("record of", f"{record.scenario.title} ({source})"),
        ("seed", str(record.seed)),
        ("rows", f"{len(record)}, up to {record.time[-1] if len(record) else 0:g} s"),
        ("ended", one_line(record.over_message)),
        ("made with", one_line(versions)),
        ("digest", record.digest),
    ]
    if record.options:
        rows.append(("options", options_in_words(record.options)))
    for change in record.changes:
        if change.options:
            when = change.row * record.scenario.sampling_time
            rows.append(("set", f"at {when:g} s: {options_in_words(dict(change.options))}"))
    if record.missing:
        what = f"{', '.join(record.missing)}: of the user's own, not in the file"
        rows.append(("without", what))
    _tell_all(rows)
    if not len(record):
        tell("run again   nothing: it has no rows")
        return
    with progress(len(record), "row") as update:
        try:
            departure = rerun(record, update)
        except InputError as error:
            raise InputError(f"{path}: {error}") from error
    if departure is not None:
        others = [f"{k} {a}, here {b}" for k, (a, b) in other_versions(record).items()]
        reason = f"; it was made with {', '.join(others)}" if others else ""
        raise Mars2dError(
            f"{path}: run again from its recorded commands, it departs at {departure}{reason}"
        )
    tell("run again   from its recorded commands: bit-identical")
