"""The rules of a game in words, written from its file: roles, referee, arena, time."""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from mars2d.addons.contest import Contest
from mars2d.core.errors import counted
from mars2d.scenario.examples import examples, experiment_name
from mars2d.scenario.experiment import Experiment
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.tournaments.isolation.limits import Limits

SEES = {
    "full": "everything, as robot.world",
    "partial": "its own pose and velocity, and the poses of its neighbours",
    "positions": "its own pose and velocity, and the positions of its neighbours",
    "sensors": "only the readings of its sensors",
}
BOUNDS = {
    "max_linear_speed": "at most {:g} m/s",
    "max_angular_speed": "turns with {:g} rad/s at most",
    "max_steering": "steers by {:g} rad at most",
    "max_acceleration": "changes its speed by {:g} m/s² at most",
}
"""The bounds of drives that rules state, in words."""
PHYSICS = {
    "contact": "Bodies push, slip and block each other.",
    "stop": "Robots that would overlap stop where they touch; nobody pushes anybody.",
    "ideal": "Robots go through each other: no forces act.",
}
EDGE = {
    "wall": "Walls stand round it.",
    "stop": "Whoever leaves it ends the game.",
    "ignore": "It may be left.",
}


@dataclass(frozen=True)
class Role:
    """A role in words.

    colors: of its robots, each once. robots: their names. aim: how it wins, or "". drive: how they
    move. command: of which two numbers. sees: what its law may know.
    """

    name: str
    colors: tuple[str, ...]
    robots: tuple[str, ...]
    aim: str
    drive: str
    command: str
    sees: str

    @classmethod
    def of(cls, name: str, team: Sequence[int], contest: Contest, scenario: Scenario) -> Role:
        """Return a role of a contest; team: its robots, by index."""
        robots = [scenario.robots[index] for index in team]
        return cls(
            name,
            tuple(dict.fromkeys(scenario.colors[index] for index in team)),
            tuple(str(robot.name) for robot in robots),
            contest.aim(name, scenario),
            " or ".join(dict.fromkeys(map(_drive, robots))),
            " or ".join(dict.fromkeys(map(_command, robots))),
            " or ".join(dict.fromkeys(map(_sees, robots))),
        )


@dataclass(frozen=True)
class Rules:
    """The rules of a game in words.

    game: as commands name it. title: of the scenario. story: the docstring of its file. counts:
    what the referee counts. arena, time, steps: where, for how long, and how often laws are asked.
    start: a picture of the start, SVG. limits: of each law.
    """

    game: str
    title: str
    story: str
    roles: tuple[Role, ...]
    counts: str
    arena: str
    time: str
    start: str
    limits: Limits = field(default_factory=Limits)

    @classmethod
    def of(cls, experiment: Experiment, contest: Contest) -> Rules:
        """Return the rules of an experiment with a contest."""
        scenario, path = experiment.scenario, experiment.source.path
        game = experiment.source.name or scenario.title
        if path is not None and path in examples().values():
            game = experiment_name(path)
        teams = zip(contest.roles, contest.teams(scenario), strict=True)
        return cls(
            game=game,
            title=scenario.title or experiment_name(Path(game)),
            story=_docstring(path),
            roles=tuple(Role.of(name, team, contest, scenario) for (name, _), team in teams),
            counts=contest.counts,
            arena=_arena(scenario),
            time=f"{scenario.stop_time:g} s at most; a law is asked every "
            f"{scenario.sampling_time:g} s.",
            start=scenario._repr_svg_(),
        )

    @property
    def colors(self) -> Mapping[str, tuple[str, ...]]:
        """The colours of each role's robots."""
        return {role.name: role.colors for role in self.roles}


def _docstring(path: Path | None) -> str:
    """Return the docstring of a Python file, or ""."""
    if path is None or path.suffix != ".py":
        return ""
    try:
        return ast.get_docstring(ast.parse(path.read_bytes())) or ""
    except (OSError, SyntaxError, ValueError):
        return ""


def _drive(robot: Robot) -> str:
    drive = robot.drive
    bounds = [
        words.format(bound)
        for name, words in BOUNDS.items()
        if (bound := getattr(drive, name, None)) is not None and bound < 1e3
    ]
    return ", ".join([type(drive).__name__, *bounds])


def _command(robot: Robot) -> str:
    names = [f"{each.name} [{each.unit}]" for each in robot.drive.quantities]
    return f"({', '.join(names)})" if names else "two numbers"


def _sees(robot: Robot) -> str:
    sensors = ", ".join(sensor.key for sensor in robot.sensors)
    return SEES[robot.sees] + (f"; it senses {sensors}" if sensors else "")


def _arena(scenario: Scenario) -> str:
    xmin, xmax, ymin, ymax = scenario.bounds
    parts = [f"x from {xmin:g} m to {xmax:g} m, y from {ymin:g} m to {ymax:g} m."]
    if scenario.workspace is None:
        parts = ["The plane, without limits."]
    else:
        parts.append(EDGE[scenario.on_exit])
    if scenario.obstacles:
        parts.append(f"{counted(len(scenario.obstacles), 'obstacle')} in it.")
    return " ".join([*parts, PHYSICS[scenario.physics]])
