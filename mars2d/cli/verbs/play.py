"""The verb ``play``."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from mars2d.cli.arguments import (
    add_options,
    add_preferences,
    add_speed,
    add_theory,
    options_of,
    preferences_of,
    theory_of,
)
from mars2d.cli.runs import has_display, print_table, show
from mars2d.core.errors import InputError, nearest
from mars2d.core.terminal import tell
from mars2d.output.raster import require_pygame
from mars2d.scenario.examples import games, title_of
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.scenario.roles import contest_of, contests_of, robots_named
from mars2d.scenario.scenario import Scenario

MOST_NAMES = 5
"""How many robots a message names."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add = parser.add_argument
    add("game", nargs="?", metavar="GAME", help="an example or a file (default: list the games)")
    add(
        "--role",
        action="append",
        default=[],
        metavar="ROLE",
        help="the role to play; for two people twice; without it, the window asks",
    )
    add("--seed", type=int, default=0, metavar="N", help="of all random streams")
    add_speed(parser)
    add_options(parser)
    add_theory(parser)
    add_preferences(parser)


def execute(arguments: argparse.Namespace) -> None:
    """Play a game against a law or another person; without a game, list all."""
    if arguments.game is None:
        _list()
        return
    options = options_of(arguments) | theory_of(arguments)
    experiment = open_experiment(arguments.game, options, seed=arguments.seed)
    people = _people(arguments, experiment)
    if not has_display():
        require_pygame("a window")
        raise InputError(f"play {arguments.game}: people need a window, and there is no display")
    look = preferences_of(arguments)
    show(experiment, arguments.speed, look, people, kept=True, play=True)


def _list() -> None:
    print_table("Games", {name: title_of(name)[1] for name in games()})
    tell(f"\nPlay one:  mars2d play {games()[0]}")


def _people(arguments: argparse.Namespace, experiment: Experiment) -> tuple[int, ...]:
    """Return the robots, by index, that people play.

    Where nobody wins, a robot may stand for a role. Raises InputError for roles that are none.
    """
    scenario = experiment.scenario
    wanted = [part.strip() for text in arguments.role for part in text.split(",")]
    if not contests_of(scenario):
        return _driven(arguments.game, scenario, wanted)
    contest = contest_of(scenario, arguments.game)
    roles = [role for role, _ in contest.roles]
    for role in wanted:
        if role not in roles:
            raise InputError(
                f"--role {role}: {arguments.game} has no such role{nearest(role, roles)}"
            )
    return robots_named(scenario, wanted, "--role")


def _driven(game: str, scenario: Scenario, wanted: Sequence[str]) -> tuple[int, ...]:
    """Return the robots that people drive where nobody wins."""
    if wanted:
        return robots_named(scenario, wanted, "--role")
    names = [str(robot.name) for robot in scenario.robots]
    shown = ", ".join(names[:MOST_NAMES]) + (", ..." if len(names) > MOST_NAMES else "")
    raise InputError(
        f"{game}: it has no roles, as no add-on says who has won: name the robot to drive, "
        f"--role ROBOT; there are {shown}"
    )
