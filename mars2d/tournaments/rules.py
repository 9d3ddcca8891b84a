"""The rules of a game in words, written from its file: roles, referee, arena, time."""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from mars2d.addons.contest import Contest
from mars2d.core.errors import counted
from mars2d.scenario.examples import examples, experiment_name
from mars2d.scenario.experiment import Experiment
from mars2d.scenario.robot import Robot
from mars2d.scenario.roles import contest_of, roles_of
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

    colors: of its robots, each once. aim: how it wins, or "". facts: about its robots and what its
    law may do, by term.
    """

    name: str
    colors: tuple[str, ...]
    aim: str
    facts: Mapping[str, str]

    @classmethod
    def of(cls, name: str, team: Sequence[int], contest: Contest, scenario: Scenario) -> Role:
        """Return a role of a contest; team: its robots, by index."""
        robots = [scenario.robots[index] for index in team]
        each = [_facts(robot) for robot in robots]
        facts = {
            "Robots": ", ".join(str(robot.name) for robot in robots),
            **{term: " or ".join(dict.fromkeys(one[term] for one in each)) for term in each[0]},
        }
        colors = dict.fromkeys(scenario.colors[index] for index in team)
        return cls(name, tuple(colors), contest.aim(name, scenario), facts)


@dataclass(frozen=True)
class Rules:
    """The rules of a game in words.

    game: as commands name it. title: of the scenario. story: the docstring of its file. roles: by
    their names. facts: on the referee, the arena and the limits, by term. start: a picture of the
    start, SVG.
    """

    game: str
    title: str
    story: str
    roles: Mapping[str, Role]
    facts: Mapping[str, str]
    start: str

    @classmethod
    def of(cls, experiment: Experiment, limits: Limits) -> Rules:
        """Return the rules of an experiment with a contest; limits: of each law."""
        scenario, path = experiment.scenario, experiment.source.path
        contest = contest_of(scenario, experiment.source.name)
        game = experiment.source.name or scenario.title
        if path is not None and path in examples().values():
            game = experiment_name(path)
        facts = {
            "What is counted": contest.counts,
            "Arena": _arena(scenario),
            "Time": f"{scenario.stop_time:g} s at most; a law is asked every "
            f"{scenario.sampling_time:g} s.",
            "Points": "A match won gives 1 point, a draw ½.",
            "Forfeit": f"A law forfeits the match by an error, by a command that is not two "
            f"finite numbers, by more than {limits.tick:g} s for one step or {limits.match:g} s "
            f"for all of a match, or by more than {limits.memory:g} MB.",
        }
        return cls(
            game=game,
            title=scenario.title or experiment_name(Path(game)),
            story=_docstring(path),
            roles={
                name: Role.of(name, team, contest, scenario)
                for name, team in roles_of(scenario).items()
            },
            facts=facts,
            start=scenario._repr_svg_(),
        )


def _docstring(path: Path | None) -> str:
    """Return the docstring of a Python file, or ""."""
    with suppress(OSError, SyntaxError, ValueError):
        if path is not None and path.suffix == ".py":
            return ast.get_docstring(ast.parse(path.read_bytes())) or ""
    return ""


def _facts(robot: Robot) -> dict[str, str]:
    """Return what a robot can do, and what its law knows."""
    bounds = {words: getattr(robot.drive, name, None) for name, words in BOUNDS.items()}
    told = [words.format(bound) for words, bound in bounds.items() if bound and bound < 1e3]
    names = ", ".join(f"{each.name} [{each.unit}]" for each in robot.drive.inputs)
    sensors = ", ".join(sensor.key for sensor in robot.sensors)
    return {
        "Drive": ", ".join([type(robot.drive).__name__, *told]),
        "A law returns": f"({names})",
        "It sees": SEES[robot.sees] + (f"; it senses {sensors}" if sensors else ""),
    }


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
