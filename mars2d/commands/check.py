"""The verb ``check``."""

from __future__ import annotations

import argparse
from pathlib import Path

from mars2d.commands.base import run_headless
from mars2d.errors import InputError, Mars2dError, counted
from mars2d.files import Experiment, open_experiment
from mars2d.joints import Joint
from mars2d.record import load
from mars2d.rerun import rerun
from mars2d.robot import Robot
from mars2d.scenario import Scenario

NAME = "check"

TRIAL = 10
"""Control steps that a check does: some mistakes only show when laws and sensors are called."""

SHOWN = 8


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument(
        "file", metavar="FILE", help="an experiment (.py or an example's name), a record (.npz)"
    )


def execute(arguments: argparse.Namespace) -> None:
    """Say what a file holds and whether it is sound."""
    path = Path(arguments.file)
    if path.suffix == ".npz":
        _check_record(path)
    elif path.suffix in ("", ".py"):
        _check_experiment(arguments.file)
    else:
        raise InputError(f"{path}: expected an experiment (.py) or a record (.npz)")


def _check_experiment(source: str) -> None:
    experiment = open_experiment(source)
    for name, text in _description(experiment):
        print(f"{name:<12}{text}")
    scenario = experiment.scenario
    stop_time = min(TRIAL * scenario.sampling_time, scenario.stop_time)
    trial = Experiment(scenario.replace(stop_time=stop_time), experiment.control)
    world = run_headless(trial, seed=0)
    print(f"sound: {counted(len(world.history), 'control step')} done")


def _description(experiment: Experiment) -> list[tuple[str, str]]:
    """Return what was read of an experiment, as names and texts."""
    scenario = experiment.scenario
    xmin, xmax, ymin, ymax = scenario.bounds
    rows = [("title", scenario.title)]
    rows += [(str(robot.name), _robot(robot)) for robot in scenario.robots[:SHOWN]]
    if len(scenario.robots) > SHOWN:
        rows.append(("", f"and {counted(len(scenario.robots) - SHOWN, 'robot')} more"))
    corners = "no limits"
    if scenario.workspace is not None:
        corners = f"{len(scenario.workspace)} corners, on_exit {scenario.on_exit!r}"
    law = getattr(experiment.control, "__name__", "")
    own = sum(robot.controller is not None for robot in scenario.robots)
    laws = [f"{law}(world) of the team"] if law else []
    laws += [f"{own} of robots' own"] if own else []
    rows += [
        ("workspace", f"{xmax - xmin:g} m x {ymax - ymin:g} m, {corners}"),
        ("obstacles", str(len(scenario.obstacles))),
        *_things(scenario),
        ("add-ons", ", ".join(addon.key for addon in scenario.addons) or "none"),
        ("time", f"{scenario.stop_time:g} s in steps of {scenario.sampling_time:g} s"),
        ("laws", ", ".join(laws) or "none: all robots stand still"),
    ]
    if experiment.checks is not None:
        rows.append(("checks", "checks(record), made after a whole run"))
    return rows


def _things(scenario: Scenario) -> list[tuple[str, str]]:
    """Return what is to be said of props and joints, and of physics without forces."""
    rows = [
        ("props", ", ".join(str(prop.name) for prop in scenario.props)),
        ("joints", ", ".join(_joint(tie.joint) for tie in scenario.ties)),
        ("physics", "" if scenario.physics == "contact" else scenario.physics),
    ]
    return [(name, text) for name, text in rows if text]


def _joint(joint: Joint) -> str:
    return f"{type(joint).__name__} of {joint.a} and {joint.b or 'the world'}"


def _robot(robot: Robot) -> str:
    x, y, theta = robot.pose
    parts = [type(robot.drive).__name__, *(sensor.key for sensor in robot.sensors)]
    if robot.controller is not None:
        parts.append(f"law {getattr(robot.controller, '__name__', 'of its own')}")
    return f"at ({x:g}, {y:g}, {theta:.4g}): {', '.join(parts)}"


def _check_record(path: Path) -> None:
    record = load(path)
    versions = ", ".join(f"{name} {version}" for name, version in record.versions.items())
    print(f"record of   {record.scenario.title} ({record.filename or 'a Scenario'})")
    print(f"seed        {record.seed}")
    print(f"rows        {len(record)}, up to {record.time[-1] if len(record) else 0:g} s")
    print(f"ended       {record.over_message}")
    print(f"made with   {versions}")
    print(f"digest      {record.digest}")
    if record.missing:
        print(f"without     {', '.join(record.missing)}: of the user's own, not in the file")
    departure = rerun(record)
    if departure is not None:
        where = f"row {departure.row}, by {departure.distance:.3g} m or rad"
        raise Mars2dError(f"{path}: run again, it departs at {where}")
    print("run again   bit-identical")
